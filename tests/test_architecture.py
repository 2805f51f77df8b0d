# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rules of the layout that import-linter cannot see."""

import ast
import inspect
import os
import re
import subprocess
import sys
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from uel.model import perturbations, procedures

ROOT = Path(__file__).parents[1]
TRACKED = [
    Path(line)
    for line in subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    if (ROOT / line).exists()
]
PURE_FOLDERS = ("core", "materials", "cohesive", "elements")
FORTRAN_RANK = {"core": 0, "materials": 1, "cohesive": 1, "elements": 2, "abaqus": 3, "host": 1}


def fortran_files() -> list[Path]:
    return [path for path in TRACKED if path.suffix == ".f90" and path.parts[0] == "fortran"]


def code_lines(path: Path) -> list[str]:
    """Lines of a free-form Fortran file without comments and character constants, in lower case."""
    text = re.sub(r"'[^'\n]*'|\"[^\"\n]*\"", "''", (ROOT / path).read_text())
    return [line.split("!")[0].lower() for line in text.splitlines()]


def test_import_order() -> None:
    """The contracts of pyproject.toml, checked by import-linter on the source tree.

    The finder of the editable install answers with a path that is no folder, so it steps aside here.
    """
    linter = (
        "import sys; sys.meta_path = [f for f in sys.meta_path if type(f).__name__ != 'MesonpyMetaFinder'];"
        "from importlinter.cli import lint_imports;"
        "sys.exit(lint_imports(no_cache=True))"
    )
    tree = os.environ | {"PYTHONPATH": str(ROOT / "harness")}
    words = [sys.executable, "-c", linter]
    result = subprocess.run(words, cwd=ROOT, env=tree, capture_output=True, text=True, check=False)
    assert "1 kept, 0 broken" in result.stdout, result.stdout + result.stderr


def imported(code: str, modules: set[str]) -> set[str]:
    """Modules that code imports anywhere: in functions, for types alone, and by name with import_module."""
    words: list[str] = []
    for node in ast.walk(ast.parse(code)):
        match node:
            case ast.Import(names=names):
                words += [alias.name for alias in names]
            case ast.ImportFrom(module=base, names=names, level=level):
                assert level == 0, f"a relative import: {ast.unparse(node)}"
                full = {alias.name: f"{base}.{alias.name}" for alias in names}
                words += [word if word in modules else str(base) for word in full.values()]
            case ast.Call(func=ast.Name(id="import_module"), args=[ast.Constant(value=str(word))]):
                words.append(word)
    return modules & set(words)


def circle(files: dict[str, str]) -> list[str]:
    """One circle of imports among modules, if there is any; files: code by module."""
    try:
        TopologicalSorter({name: imported(code, set(files)) for name, code in files.items()}).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_modules_import_each_other_in_no_circle() -> None:
    """The layers are between packages, and this holds within them too. The stub stands for the extension."""
    paths = [path for path in TRACKED if path.parts[0] == "harness" and path.suffix in {".py", ".pyi"}]
    names = [".".join(path.with_suffix("").parts[1:]).removesuffix(".__init__") for path in paths]
    files = {name: (ROOT / path).read_text() for name, path in zip(names, paths, strict=True)}
    assert len(files) > 400
    assert circle(files) == []


@pytest.mark.parametrize(
    "code",
    [
        "import p.b",
        "from p import b",
        "from p.b import f",
        "def g():\n  from p import b",
        "if TYPE_CHECKING:\n  from p.b import F",
        "import_module('p.b')",
    ],
)
def test_circles_of_imports_are_found(code: str) -> None:
    files = {"p": "", "p.a": code, "p.b": "import p.a", "p.c": "import p.a"}
    assert set(circle(files)) == {"p.a", "p.b"}
    assert circle(files | {"p.b": "from p import f"}) == []


def test_a_folder_has_one_topic() -> None:
    """A folder of the product has at most 25 sources."""
    product = [path for path in TRACKED if path.parts[0] in ("fortran", "harness")]
    sources = [path for path in product if path.suffix in {".py", ".f90", ".c"}]
    files = Counter(str(path.parent) for path in sources)
    assert not {folder for folder, count in files.items() if count > 25}


def test_one_module_imports_the_extension() -> None:
    importing = re.compile(r"^\s*(from|import)\b.*\b_host\b", re.MULTILINE)
    users = [
        path
        for path in TRACKED
        if path.parts[0] == "harness" and path.suffix == ".py" and importing.search((ROOT / path).read_text())
    ]
    assert users == [Path("harness/uel/usersub/_extension.py")]


@pytest.mark.parametrize("path", [path for path in fortran_files() if path.parts[1] in PURE_FOLDERS], ids=str)
def test_below_abaqus_everything_is_pure(path: Path) -> None:
    forbidden = re.compile(r"^\s*(save\b|print\b|write\s*\(|stop\b|error\s+stop\b|call\s+xit\b)|,\s*save\b")
    bad = [line for line in code_lines(path) if forbidden.search(line)]
    assert not bad
    procedures = [
        line for line in code_lines(path) if re.match(r"^(?!\s*end\b)[\w\s()=*,]*\b(subroutine|function)\b", line)
    ]
    assert [line for line in procedures if not re.search(r"\b(pure|elemental)\b", line)] == []


REGISTRY = Path("harness/uel/procedures/registry.py")
PROCEDURES = {
    name
    for module in (procedures, perturbations)
    for name, kind in inspect.getmembers(module, inspect.isclass)
    if issubclass(kind, procedures.Procedure)
}


def asked_for(code: str) -> set[str]:
    """Procedures by whose class a file decides something: isinstance, issubclass, type(...) ==, and case patterns."""
    asking: list[ast.AST] = []
    for node in ast.walk(ast.parse(code)):
        match node:
            case ast.Call(func=ast.Name(id="isinstance" | "issubclass"), args=[_, kinds]):
                asking.append(kinds)
            case ast.Compare(left=ast.Call(func=ast.Name(id="type")), comparators=kinds):
                asking += kinds
            case ast.MatchClass(cls=kind):
                asking.append(kind)
    words = {word for part in asking for word in re.findall(r"\w+", ast.unparse(part))}
    return words & PROCEDURES


@pytest.mark.parametrize(
    "code, found",
    [
        ("isinstance(step.procedure, Dynamic)", {"Dynamic"}),
        ("isinstance(p, Frequency | procedures.Static)", {"Frequency", "Static"}),
        ("if type(p) in (Visco, int): pass", {"Visco"}),
        ("match p:\n  case SteadyState(): pass", {"SteadyState"}),
        ("Dynamic(); isinstance(p, int); p.inertia", set()),
    ],
)
def test_questions_for_a_procedure_are_found(code: str, found: set[str]) -> None:
    assert asked_for(code) == found


def test_the_registry_alone_asks_which_procedure_a_step_has() -> None:
    """Elsewhere a procedure says of itself what it is: inertia, linear, harmonic and so on."""
    files = [path for path in TRACKED if path.parts[0] == "harness" and path.suffix == ".py" and path != REGISTRY]
    asking = {str(path): asked_for((ROOT / path).read_text()) for path in files}
    assert {path: names for path, names in asking.items() if names} == {}


def written_to_state(code: str) -> set[str]:
    """Attributes that code writes of an object called `state`."""
    targets: list[ast.expr] = []
    for node in ast.walk(ast.parse(code)):
        match node:
            case ast.Assign(targets=several):
                targets += several
            case ast.AugAssign(target=one) | ast.AnnAssign(target=one):
                targets.append(one)
            case ast.Call(func=ast.Name(id="setattr"), args=[whose, *_]):
                targets.append(ast.Attribute(whose, "setattr"))
    single = [one for target in targets for one in (target.elts if isinstance(target, ast.Tuple) else [target])]
    return {
        one.attr
        for one in single
        if isinstance(one, ast.Attribute) and re.search(r"(^|\.)_?state$", ast.unparse(one.value))
    }


@pytest.mark.parametrize(
    ("code", "names"),
    [
        ("state.flux = a", {"flux"}),
        ("self._state.work += 1", {"work"}),
        ("context.state.velocity, b = c", {"velocity"}),
        ("state.unbalanced = state.external = c", {"unbalanced", "external"}),
        ("setattr(state, name, c)", {"setattr"}),
        ("a = state.flux; course.state = a; self.state = b", set()),
    ],
)
def test_writing_to_a_state_is_found(code: str, names: set[str]) -> None:
    assert written_to_state(code) == names


def test_the_converged_state_is_written_in_one_file() -> None:
    """Steps and their parts return what follows from them."""
    files = [path for path in TRACKED if path.is_relative_to("harness/uel/procedures") and path.suffix == ".py"]
    writing = {str(path): written_to_state((ROOT / path).read_text()) for path in files}
    assert {path: names for path, names in writing.items() if names} == {}


def test_fortran_order() -> None:
    module_of = {}
    for path in fortran_files():
        for line in code_lines(path):
            if match := re.match(r"^\s*module\s+(?!procedure\b)(\w+)\s*$", line):
                module_of[match[1]] = path
    for path in fortran_files():
        for line in code_lines(path):
            if match := re.match(r"^\s*use\s*(?:,\s*\w+\s*)?(?:::)?\s*(\w+)", line):
                used = module_of.get(match[1])
                if used is None or used.parts[1] == path.parts[1]:
                    continue
                assert FORTRAN_RANK[used.parts[1]] < FORTRAN_RANK[path.parts[1]], f"{path} uses {used}"
                # the host shares mathematics with the kernels, and is to know nothing else of them
                assert used.parts[1] != "host", f"{path} uses {used}"
                assert path.parts[1] != "host" or used.parts[1] == "core", f"{path} uses {used}"


def test_fortran_without_ieee_modules() -> None:
    """With one of them gfortran saves the floating-point environment in each call of what uses the module, a third of
    the time of an element."""
    users = [path for path in fortran_files() for line in code_lines(path) if re.match(r"^\s*use\b.*\bieee_", line)]
    assert users == []


def test_every_source_carries_the_licence() -> None:
    sources = [path for path in TRACKED if path.suffix in {".py", ".f90", ".c", ".build"} or path.name == "Makefile"]
    assert [path for path in sources if "SPDX-License-Identifier: BSD-3-Clause" not in (ROOT / path).read_text()] == []


def test_programs_have_their_place() -> None:
    """What a person runs stands in tests/programs; pytest's configuration alone says where shared modules are."""
    tests = [path for path in TRACKED if path.parts[0] == "tests" and path.suffix == ".py"]
    programs = [path for path in tests if re.search(r"^if __name__ ==", (ROOT / path).read_text(), re.MULTILINE)]
    assert len(programs) > 5
    assert [path for path in programs if path.parts[1] != "programs"] == []
    changed = re.compile(r"\bsys\.path\.(insert|append|remove)\(|\bsys\.path *[+=]")
    assert [path for path in tests if changed.search((ROOT / path).read_text())] == []


def test_top_level_holds_only_these() -> None:
    allowed = {
        *("fortran", "harness", "tests", "abaqus_inputs", "meson.build", "README.md", "Makefile", "pyproject.toml"),
        *("fortitude.toml", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff", "LICENSE", ".ci", ".gitignore"),
        *(".gitattributes", "meson.options", "docs"),
    }
    assert {path.parts[0] for path in TRACKED} <= allowed


NAMED = re.compile(
    r"(?<![\w/.{}-])(?:harness|fortran|docs|abaqus_inputs|tests|host|uel)/[\w./-]+\.(?:py|pyi|f90|c|h|md|toml)\b"
)
"""Paths from the repository, from fortran, or from the package."""


def test_files_that_pages_and_comments_name_exist() -> None:
    tracked = {str(path) for path in TRACKED}
    pages = [path for path in TRACKED if path.suffix in {".py", ".f90", ".c", ".h", ".md", ".toml", ".build"}]
    named = {
        (name, str(page))
        for page in pages
        if page.name != "CHANGELOG.md"
        for name in NAMED.findall((ROOT / page).read_text())
    }
    assert len(named) > 250
    missing = {name for name, _ in named if not tracked & {name, f"fortran/{name}", f"harness/{name}"}}
    # of a law that is still to be written
    assert missing == {"fortran/cohesive/LAW.f90"}


def test_documents_name_tests_that_exist() -> None:
    tests = [ROOT / path for path in TRACKED if path.parts[0] == "tests" and path.suffix == ".py"]
    known = {name for path in tests for name in re.findall(r"def (test_\w+)", path.read_text())}
    documents = [ROOT / path for path in TRACKED if path.parts[0] in ("fortran", "harness") and path.suffix == ".md"]
    named = {name for path in documents for name in re.findall(r"`(test_\w+)`", path.read_text())}
    assert len(named) > 5
    assert named <= known


def test_equations_are_where_the_page_says() -> None:
    text = (ROOT / "docs/equations.md").read_text()
    rows = re.findall(r"^\| .* \| `(\w+/\w+\.f90)` \| (.*) \|$", text, re.MULTILINE)
    assert len(rows) > 15
    for file, names in rows:
        code = "\n".join(code_lines(Path("fortran", file)))
        for name in re.findall(r"`(\w+)`", names):
            assert re.search(rf"^ *(pure )?(subroutine|function) {name}\(", code, re.MULTILINE), f"{name} in {file}"
