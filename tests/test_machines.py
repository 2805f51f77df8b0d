# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Other machines: what machine.py makes of this one, and the runs and rows of matrix.py."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import machine
import matrix
import pytest

HERE = Path(__file__).parent
SEEN = """\
import json, os, numpy
found = numpy.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
print(json.dumps([len(os.sched_getaffinity(0)), os.environ.get("OPENBLAS_CORETYPE"), found]))
"""


def on(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, machine.__file__, *words], capture_output=True, text=True, check=False)


def test_an_older_processor_with_one_core() -> None:
    found = on("--processor", "Nehalem", "--cores", "1", sys.executable, "-c", SEEN)
    assert json.loads(found.stdout) == [1, "Nehalem", []], found.stderr


@pytest.mark.long
def test_one_core_for_each_worker(tmp_path) -> None:
    count = max(len(os.sched_getaffinity(0)), 2)
    tests = "".join(
        f"def test_{k}():\n    print(os.getpid(), *os.sched_getaffinity(0))\n    time.sleep(0.1)\n" for k in range(8)
    )
    (tmp_path / "test_seen.py").write_text(f"import os, time\n{tests}")
    (tmp_path / "conftest.py").write_text((HERE / "conftest.py").read_text())
    words = ["-m", "pytest", "-n", str(count), "-rP", "-p", "no:cacheprovider", "-c", os.devnull, str(tmp_path)]
    found = on("--cores", "each", sys.executable, *words)
    seen = dict(re.findall(r"^(\d+) (\d+)$", found.stdout, re.MULTILINE))
    assert found.returncode == 0, found.stdout
    assert seen
    assert set(seen.values()) <= set(map(str, os.sched_getaffinity(0)))
    assert len(set(seen.values())) == min(len(seen), len(os.sched_getaffinity(0)))


def test_a_share_of_the_tests(tmp_path) -> None:
    """Another seed takes other ones; that one takes the same is what workers of pytest-xdist compare."""
    (tmp_path / "test_seen.py").write_text("".join(f"def test_{k}():\n    pass\n" for k in range(40)))
    (tmp_path / "conftest.py").write_text((HERE / "conftest.py").read_text())
    taken = []
    for seed in (1, 2):
        words = f"-q --collect-only --share 2 -p randomly --randomly-seed {seed} -c {os.devnull} --rootdir . ."
        command = [sys.executable, "-m", "pytest", *words.split()]
        printed = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False).stdout
        taken.append(set(re.findall(r"::(test_\d+)", printed)))
        assert f"{len(taken[-1])}/40 tests collected ({40 - len(taken[-1])} deselected)" in printed
    assert 0 < len(taken[0]) < 40
    assert taken[0] != taken[1]


def test_this_machine_is_left_as_it_is() -> None:
    command = [sys.executable, "-c", SEEN]
    assert on(*command).stdout == subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_without_a_command() -> None:
    found = on("--processor", "Haswell")
    assert found.returncode == 2
    assert "no command" in found.stderr


def test_every_value_occurs_in_each_target() -> None:
    given = (["3.11", "3.12"], ["this", "Haswell", "Nehalem"], ["all", "1"], ["1", "2", "3"])
    found = matrix.configurations(["test-all", "test-debug"], *given)
    assert len(found) == 6
    for target in ("test-all", "test-debug"):
        of_target = [c for c in found if c.target == target]
        for name, values in zip(("python", "processor", "cores", "seed"), given, strict=True):
            assert {getattr(c, name) for c in of_target} == set(values)
    assert len({(c.python, c.processor, c.cores) for c in found}) == 6


def test_commands_have_no_folder_of_this_machine() -> None:
    command = matrix.Configuration("test-all", sys.executable, "this", "1", "2").command
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    assert command == f"make test-all PYTHON=python{version} PROCESSOR=this CORES=1 WORKERS=1 SEED=2"


@pytest.mark.parametrize(
    ("output", "code", "expected"),
    [
        ("...\n7 passed, 1 skipped in 429.30s (0:07:09)\n", 0, ("7 passed, 1 skipped", "7 min 9 s")),
        ("=== 1 failed, 6 passed in 9.10s ===\nmake: *** Error 1\n", 2, ("**1 failed, 6 passed**", "0 min 9 s")),
        # of the process that stops before the tests, or behind them
        ("make: *** No rule\n", 2, ("**no tests ran**", "")),
        ("7 passed in 1.00s\nSegmentation fault\n", 139, ("**7 passed**", "0 min 1 s")),
    ],
)
def test_outcome(output: str, code: int, expected: tuple[str, str]) -> None:
    assert matrix.outcome(output, code) == expected


def test_a_row_replaces_that_of_its_command() -> None:
    page = f"before\n{matrix.BEGIN}\n{matrix.END}\nafter\n"
    for row in ("| 1 | `make a` |", "| 2 | `make ab` |", "| 3 | `make a` |"):
        page = matrix.written(page, row)
    assert page == f"before\n{matrix.BEGIN}\n| 3 | `make a` |\n| 2 | `make ab` |\n{matrix.END}\nafter\n"


def test_the_page_takes_rows() -> None:
    page = (HERE.parent / "docs/testing.md").read_text(encoding="utf-8")
    columns = next(line for line in page.split(matrix.BEGIN)[0].splitlines() if line.startswith("| Python"))
    assert columns.count("|") == 9
    assert "| 1 | `make a` |" in matrix.written(page, "| 1 | `make a` |")


def test_in_the_background_interrupts_are_taken() -> None:
    """Of a shell, or behind nohup, where SIGINT and SIGHUP come ignored: runs that tests interrupt would never end."""
    code = "import conftest, signal as s; print(*(s.getsignal(n) is s.SIG_IGN for n in (s.SIGINT, s.SIGHUP)))"
    ignoring = ["sh", "-c", 'trap "" INT HUP; exec "$@"', "sh", sys.executable, "-c", code]
    assert subprocess.run(ignoring, cwd=HERE, capture_output=True, text=True, check=True).stdout == "False False\n"
