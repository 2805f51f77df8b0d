# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A wheel, in an environment of its own, outside the repository and without a compiler."""

import os
import re
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DECKS = ROOT / "abaqus_inputs"
LINK = re.compile(r"\]\(([^)#:]+\.(?:md|png|inp))[)#]")
"""To a page, a picture or a deck."""

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """Folder of the programs of an environment with the wheel; it takes dependencies from that of the tests."""
    folder = tmp_path_factory.mktemp("wheel")
    tools = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    wheel = [*pip, "wheel", "--no-deps", "--no-build-isolation", "--no-index", f"--wheel-dir={folder}", str(ROOT)]
    subprocess.run(wheel, check=True, env=tools, cwd=folder)
    venv.create(folder / "env", with_pip=False)
    programs = folder / "env" / "bin"
    install = [*pip, f"--python={programs / 'python'}", "install", "--no-deps", "--no-index"]
    subprocess.run([*install, *map(str, folder.glob("*.whl"))], check=True, cwd=folder)
    packages = subprocess.run(
        [programs / "python", "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    # a path in such a file is searched, but the files of this kind there, such as that of an editable install, are not
    (Path(packages) / "dependencies.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    return programs


@pytest.fixture
def uel(environment, tmp_path):
    """Run the command of the wheel; no other program is on the path."""
    variables = {"PATH": str(environment), "HOME": str(tmp_path), "MPLBACKEND": "Agg"}

    def run_command(*words: str) -> subprocess.CompletedProcess[str]:
        command = [str(environment / "uel"), *words]
        return subprocess.run(command, cwd=tmp_path, env=variables, capture_output=True, text=True, check=False)

    return run_command


def test_it_is_the_wheel(environment, tmp_path):
    command = [str(environment / "python"), "-c", "import uel.cli; print(uel.cli.__file__)"]
    variables = {"PATH": str(environment)}
    done = subprocess.run(command, cwd=tmp_path, env=variables, capture_output=True, text=True, check=True)
    assert Path(done.stdout.strip()).is_relative_to(environment.parent)


def test_doctor(uel):
    done = uel("doctor")
    assert done.returncode == 0, done.stdout
    assert "absent  gfortran: not found" in done.stdout


def test_decks_and_manual(uel, tmp_path):
    """`uel doctor` names their folder; links between pages hold there, and a deck runs."""
    place = re.search(r"^ok +decks and manual: (.+)$", uel("doctor").stdout, re.MULTILINE)
    folder = Path(place[1])
    assert not folder.is_relative_to(ROOT)
    pages = [page for page in folder.rglob("*.md") if page.name != "CHANGELOG.md"]
    links = [
        (page, target) for page in pages for target in LINK.findall(page.read_text()) if "generated/" not in target
    ]
    assert len(links) > 100
    assert [link for link in links if not (link[0].parent / link[1]).exists()] == []
    done = uel("run", str(folder / "abaqus_inputs" / "patch_horizontal" / "flat_u4.inp"))
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("words", "written"),
    [
        (["--version"], []),
        (["run", f"{DECKS}/patch_horizontal/flat_u4.inp"], ["flat_u4.sta", "flat_u4_interface.csv"]),
        (["batch", f"{DECKS}/patch_horizontal/flat_u2.inp"], ["batch/results.csv"]),
        (["law", "CLOSURE=1", "--element", "U4", "--angles", "0"], ["law.csv", "law.png"]),
        (["check", f"{DECKS}/patch_horizontal/flat_u2.inp", "--increments", "1"], []),
        (["new", "my_uel"], ["my_uel/my_uel.for"]),
        (["amalgamate", "-o", "delamination.for"], ["delamination.for"]),
        (["reproduce", "law", "--quick"], ["reproduce/quick/index.html"]),
        (["solvers"], []),
        (["completion", "bash"], []),
    ],
    ids=lambda value: value[0] if value else "",
)
def test_command(uel, tmp_path, words, written):
    done = uel(*words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert [name for name in written if not (tmp_path / name).exists()] == []


def test_commands_from_a_mesh_to_results(uel, tmp_path):
    """The plate of the manual, which the wheel has; the others of the command are above."""
    manual = Path(re.search(r"^ok +decks and manual: (.+)$", uel("doctor").stdout, re.MULTILINE)[1]) / "docs"
    page = (manual / "plate.md").read_text()
    (tmp_path / "plate.inp").write_text(re.search(r"^```abaqus laminate\.inp\n(.*?)^```$", page, re.M | re.S)[1])
    (tmp_path / "measured.csv").write_text("U2[END], RF2[END]\n0.04, 1380\n0.1, 3400\n0.16, 5400\n0.2, 6720\n")
    for words, written in (
        (
            f"insert {manual}/plate.msh plate.inp --plies SIGMAMAX=20 TAUMAX=60 GIC=0.1 GIIC=0.4 -o model.inp",
            "model.inp",
        ),
        ("run model.inp", "model.pvd"),
        ("plot model", "model_load.png"),
        ("report model", "model.html"),
        ("front model", "model_front.csv"),
        ("fit model.inp measured.csv GIIC=0.1:0.5:1 --runs 2", "fit/model_fit.csv"),
    ):
        done = uel(*words.split())
        # the fit ends at the limit of its runs
        assert done.returncode == int(words.startswith("fit")), done.stdout + done.stderr
        assert (tmp_path / written).exists()


def test_no_command_is_left_out(uel):
    listed = re.findall(r"^    ([a-z]+)\b", uel("--help").stdout, re.MULTILINE)
    tried = re.findall(r"\[\"(\w+)\"|uel\(\"(\w+)\"|^ +\(?f?\"(\w+) ", Path(__file__).read_text(), re.MULTILINE)
    assert len(listed) > 10
    assert set(listed) <= {word for words in tried for word in words}


def test_user_routines_need_a_compiler(uel):
    assert uel("new", "my_uel").returncode == 0
    done = uel("run", "my_uel/my_uel.inp", "--user", "my_uel/my_uel.for")
    assert done.returncode == 1
    assert "compiling it needs gfortran, which is not installed (apt install gfortran" in done.stderr
