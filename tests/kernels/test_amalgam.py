# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The single file for Abaqus: its form, and that compilers take it at every width Abaqus may use."""

import re
import shutil
import subprocess

import pytest

from uel.usersub.layout import element_layouts
from uel.usersub.own_kernels import path_of_amalgam


@pytest.fixture(scope="module")
def amalgamate(program):
    """Module fortran/amalgamate.py."""
    return program("amalgamate")


def test_header_has_every_type():
    header = path_of_amalgam().read_text().split("! Written from")[0]
    found = re.findall(r"^!   U(\d+)( \(UELMAT\))?: (\w+)", header, re.MULTILINE)
    assert [int(number) for number, _, _ in found] == list(element_layouts())
    assert [int(number) for number, uelmat, _ in found if uelmat] == [1, 9]
    for (_, _, word), layout in zip(found, element_layouts().values(), strict=True):
        assert layout.meaning.startswith(word)


def test_form():
    text = path_of_amalgam().read_text()
    assert text.isascii()
    lines = text.splitlines()
    assert max(map(len, lines)) <= 72
    assert all(not line or line[0] == "!" or line.startswith("      ") or line.startswith("     &") for line in lines)
    # comments hold no quotes, for which a preprocessor would look for a partner
    assert not [line for line in lines if line.startswith("!") and re.search(r"['\"]", line)]
    # character constants end on their line
    assert not [line for line in lines if not line.startswith("!") and line.count("'") % 2]
    assert len({name for name in re.findall(r"\w+", text) if len(name) > 63}) == 0
    for routine in ("uel", "uelmat", "uexternaldb"):
        assert len(re.findall(rf"^      subroutine {routine}\(", text, re.MULTILINE)) == 1


@pytest.mark.parametrize("columns", [72, 132])
def test_gfortran(tmp_path, columns):
    options = ["-cpp", f"-ffixed-line-length-{columns}", "-Wall", "-Wextra", "-Werror", "-Wno-unused-dummy-argument"]
    command = ["gfortran", "-fsyntax-only", "-J", str(tmp_path), *options, str(path_of_amalgam())]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_flang(tmp_path):
    names = ["flang", "flang-new", *(f"flang-new-{n}" for n in range(25, 15, -1)), "flang-21", "flang-20"]
    flang = next(filter(None, map(shutil.which, names)), None)
    if flang is None:
        pytest.skip("flang is not installed")
    command = [flang, "-fsyntax-only", "-cpp", "-module-dir", str(tmp_path), str(path_of_amalgam())]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_long_statements_are_broken_outside_constants(amalgamate):
    source = "x = first_name + second_name + &\n  & third_name + fourth_name + fifth_name * (1.0_dp - sixth)\n"
    lines = list(amalgamate.fixed_form(source))
    assert len(lines) == 2 and lines[1].startswith("     &") and max(map(len, lines)) <= 72
    assert " ".join(line[6:].strip() for line in lines) == (
        "x = first_name + second_name + third_name + fourth_name + fifth_name * (1.0_dp - sixth)"
    )


def test_long_constants_become_concatenations(amalgamate):
    text = "a sentence with, commas (brackets), and ! an exclamation mark that is far too long for a line of 72 columns"
    lines = list(amalgamate.fixed_form(f"call tell(code, '{text}', [1, 2])\n"))
    assert max(map(len, lines)) <= 72
    joined = "".join(line[6:] for line in lines)
    assert "".join(re.findall(r"'([^']*)'", joined)) == text
    assert (
        re.sub(r"'[^']*'( // )?", "*", joined.replace("\n", ""))
        .replace(" ", "")
        .strip("*")
        .startswith("calltell(code,")
    )


def test_comments(amalgamate):
    source = "!> What isn't short enough: " + "word " * 20 + "\nx = '!' !< a mark\n! SPDX-License-Identifier: none\n"
    lines = list(amalgamate.fixed_form(source))
    assert lines[0].startswith("! What isn`t short") and max(map(len, lines)) <= 72
    assert lines[-2:] == ["! a mark", "      x = '!'"]


def test_order_follows_use(amalgamate):
    a, b, c = "module a\nuse b, only: x\nend module a\n", "module b\nend module b\n", "subroutine c\nuse a\nend\n"
    assert amalgamate.in_order([c, a, b]) == [b, a, c]
    with pytest.raises(ValueError, match="circle"):
        amalgamate.in_order([a, b.replace("module b\n", "module b\nuse a\n", 1)])


@pytest.mark.parametrize(
    ("source", "message"),
    [("x = 'open\n", "character constant without end"), ("x = " + "a" * 90 + "\n", "cannot be broken to 72 columns")],
)
def test_what_cannot_be_converted(amalgamate, source, message):
    with pytest.raises(ValueError, match=message):
        list(amalgamate.fixed_form(source))
