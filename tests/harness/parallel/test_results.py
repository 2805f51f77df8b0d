# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks on two ranks: the results of one process, and one set of files."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpiexec import NEEDED, PETSC_NEEDED, run
from small_decks import body_lines

import uel
from uel.output import Result
from uel.paper.bricks import BRICKS, CONSISTENT, STABILISED_BRICKS, STANDARD, dcb_of_bricks

pytestmark = NEEDED

INPUTS = Path(__file__).parents[3] / "abaqus_inputs"
SPRINGS = Path(__file__).parents[1] / "procedures" / "springs.f"
HEAD = Path(__file__).parents[1] / "umat.inc"
SAME = 1e-10
"""Of the largest value: sums over two ranks differ from those of one in rounding, 1e-16 of their terms."""

UMAT = """\
      include '{head}'
      ddsdde = 0
      do k = 1, ndi
        ddsdde(k,1:ndi) = props(1)*(1 + 0.1*kinc)
        ddsdde(k,k) = 3*props(1)*(1 + 0.1*kinc)
      end do
      do k = ndi + 1, ntens
        ddsdde(k,k) = props(1)
      end do
      stress = stress + matmul(ddsdde, dstran)
      statev(1) = statev(1) + noel*dstran(1)
      if (kinc .eq. 2 .and. npt .eq. 1 .and. noel .eq. 30) call stdb_abqerr(-1, 'element %I', noel, 0d0, ' ')
      end
"""
ELASTIC = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n2.\n"
RUBBER = "*MATERIAL, NAME=M\n*HYPERELASTIC, NEO HOOKE\n100., 0.\n*DENSITY\n2.\n"
USER = "*MATERIAL, NAME=M\n*USER MATERIAL, CONSTANTS=1\n300.\n*DEPVAR\n1\n"
OUTPUT = (
    "*OUTPUT, FIELD, FREQUENCY=1\n*NODE OUTPUT\nU, RF\n*ELEMENT OUTPUT\nS, E\n"
    "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU1, RF1\n*ENERGY OUTPUT\nALLSE, ALLWK, ALLKE, ALLIE, ETOTAL\n*END STEP\n"
)


def block(kind: str, material: str, step: str, before: str = "", cells: tuple[int, int] = (8, 4)) -> str:
    """Rectangle of squares with a clamped left edge."""
    nx, ny = cells
    nodes = [(x, y) for y in range(ny + 1) for x in range(nx + 1)]
    corner = [x + y * (nx + 1) for y in range(ny) for x in range(nx)]
    lines = body_lines(kind, nodes, [(k, k + 1, k + nx + 2, k + nx + 1) for k in corner])
    left = ", ".join(str(1 + y * (nx + 1)) for y in range(ny + 1))
    right = ", ".join(str(1 + nx + y * (nx + 1)) for y in range(ny + 1))
    return (
        "\n".join(lines) + f"\n*NSET, NSET=LEFT\n{left}\n*NSET, NSET=RIGHT\n{right}\n"
        f"*SOLID SECTION, ELSET=BODY, MATERIAL=M\n1.\n{before}{material}*BOUNDARY\nLEFT, 1, 2\n{step}{OUTPUT}"
    )


def springs(kinds: str, static: str, end: str) -> str:
    """A chain of springs; kinds gives the type of each by a digit."""
    count = len(kinds)
    properties = {"1": "0.5, 0.1, 0., 0.", "6": "10., 0.1, 1., 0.", "7": "1., 0.2, 0., 0."}
    text = "*NODE\n" + "".join(f"{k}, {k}.\n" for k in range(1, count + 2)) + f"*NSET, NSET=END\n{count + 1}\n"
    for kind in sorted(set(kinds)):
        text += f"*USER ELEMENT, TYPE=U{kind}, NODES=2, COORDINATES=1, PROPERTIES=4, I PROPERTIES=1, VARIABLES=1\n1\n"
        text += f"*ELEMENT, TYPE=U{kind}, ELSET=E{kind}\n"
        text += "".join(f"{k}, {k}, {k + 1}\n" for k, one in enumerate(kinds, start=1) if one == kind)
        text += f"*UEL PROPERTY, ELSET=E{kind}\n{properties[kind]}, 0\n"
    return text + (
        f"*STEP, INC=60\n{static}*BOUNDARY\n1, 1\n{end}*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=END\nU1, RF1\n"
        "*ENERGY OUTPUT\nALLSE\n*END STEP\n"
    )


def shortened(deck: str, end: float) -> str:
    """A deck of bricks that ends at a step time."""
    return re.sub(r"(\*STATIC\n.*?), 2\.5,", rf"\1, {end},", deck)


def single_elements() -> str:
    """One element of each kind that keeps directions or takes an initial stress: a rank has none of most of them."""
    square, cube = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    middles = [(0.5, 0, 0), (1, 0.5, 0), (0.5, 1, 0), (0, 0.5, 0)]
    kinds = {
        "C3D8": [*square, *cube],
        "SC8R": [*square, *cube],
        "S4": square,
        "S8R": [*square, *middles],
        "M3D4": square,
        "B31": square[:2],
        "B32": [square[0], middles[0], square[1]],
        "C3D4": [*square[:2], square[3], cube[0]],
    }
    sections = {
        "B": "*BEAM SECTION, ELSET={0}, MATERIAL=M, SECTION=RECT\n0.1, 0.1\n",
        "M": "*MEMBRANE SECTION, ELSET={0}, MATERIAL=M\n0.1\n",
        "S": "*SHELL SECTION, ELSET={0}, MATERIAL=M\n0.1, 5\n",
        "C": "*SOLID SECTION, ELSET={0}, MATERIAL=M\n",
    }
    text, held = "", ""
    for place, (kind, cell) in enumerate(kinds.items()):
        first = 100 * place + 1
        text += "*NODE, NSET=ALL\n"
        text += "".join(f"{first + k}, {x + 10 * place}, {y}, {z}\n" for k, (x, y, z) in enumerate(cell))
        nodes = ", ".join(str(first + k) for k in range(len(cell)))
        text += f"*ELEMENT, TYPE={kind}, ELSET=E{kind}\n{place + 1}, {nodes}\n" + sections[kind[0]].format(f"E{kind}")
        last = 6 if kind[0] in "BS" and kind != "SC8R" else 3
        held += f"{first}, 1, {last}\n" + "".join(f"{first + k}, 2, 3\n" for k in range(1, len(cell)))
    ends = "".join(f"{100 * place + 2}, 1, 0.01\n" for place in range(len(kinds)))
    stress = "*INITIAL CONDITIONS, TYPE=STRESS\nEC3D8, 1., 1.\nEC3D4, 2.\n"
    step = f"*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CLOAD\n{ends}"
    return f"{text}{ELASTIC}{stress}*BOUNDARY\n{held}{step}{OUTPUT}"


TIE = "*EQUATION\n2\n45, 1, 1., 36, 1, -1.\n*EQUATION\n3\n9, 1, 1., 18, 1, -0.5, 27, 1, -0.5\n"
FACE = "*ELSET, ELSET=TOP, GENERATE\n25, 32, 1\n*SURFACE, NAME=TOP\nTOP, S3\n"
CASES = {
    "large displacements, pressure, equations": (
        block("CPS4", ELASTIC, "*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*DSLOAD\nTOP, P, 1.\n", TIE + FACE),
        {},
    ),
    "loads on elements, stabilized": (
        block("CPE4", ELASTIC, "*STEP\n*STATIC, STABILIZE\n0.25, 1.\n*DLOAD\nBODY, BX, 0.5\nTOP, P3, 1.\n", FACE),
        {},
    ),
    "user material": (
        block("CPE4", USER, "*STEP\n*STATIC\n0.25, 1., 0.01, 0.25\n*BOUNDARY\nRIGHT, 1, 1, 0.1\n"),
        {"user": "umat.f"},
    ),
    "dynamic": (
        block("CPE4I", ELASTIC, "*STEP, NLGEOM\n*DYNAMIC\n0.02, 0.1\n*BOUNDARY\nRIGHT, 2, 2, 0.1\n"),
        {},
    ),
    "dynamic, pressures of elements": (
        block("CPE4H", RUBBER, "*STEP, NLGEOM\n*DYNAMIC\n0.2, 1.\n*DSLOAD\nTOP, P, 1.\n", FACE),
        {},
    ),
    "arc length": (
        springs("1" * 5 + "7", "*STATIC, RIKS\n0.05, 1., 1e-5, 0.1, 0.8\n", "*CLOAD\n7, 1, 0.1\n"),
        {"user": SPRINGS},
    ),
    "fall-back": (
        springs("1116111", "*STATIC\n0.1, 1.\n", "8, 1, 1, 3.15\n"),
        {"user": SPRINGS, "solver": {"fallback": True}},
    ),
    "more ranks than elements": (
        block("CPE4", ELASTIC, "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\nRIGHT, 2, 2, 0.1\n", cells=(1, 1)),
        {},
    ),
    "ranks without elements of a type": (single_elements(), {}),
    "U1 and U2": (INPUTS / "patch_horizontal" / "perturbed_u2.inp", {}),
    "substructures": (
        block("CPE4", ELASTIC, "*STEP\n*STATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 2, 2, 0.1\n", TIE),
        {"solver": {"linear_solver": "substructures"}},
    ),
    "all ranks factorise": (
        block("CPE4", ELASTIC, "*STEP\n*STATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 2, 2, 0.1\n"),
        {"solver": {"linear_solver": "cluster"}},
    ),
    "U8": (shortened(dcb_of_bricks("C3D8I", CONSISTENT, STABILISED_BRICKS), 0.05), {}),
    "COH3D8": (shortened(dcb_of_bricks("C3D8", replace(STANDARD, type="COH3D8"), BRICKS), 0.02), {}),
}


@pytest.fixture(scope="module")
def pairs(tmp_path_factory):
    """Results of all cases in one process and on two ranks, by their names."""
    folder = tmp_path_factory.mktemp("cases")
    (folder / "umat.f").write_text(UMAT.format(head=HEAD))
    jobs = []
    for number, (deck, options) in enumerate(CASES.values()):
        file = deck if isinstance(deck, Path) else folder / f"case{number}.inp"
        if not isinstance(deck, Path):
            file.write_text(deck)
        user = {"user": str(folder / options["user"])} if "user" in options else {}
        jobs.append({"deck": str(file), "job": f"case{number}", **options, **user})
    (folder / "jobs.json").write_text(json.dumps([job | {"output_dir": "two"} for job in jobs]))
    code, output, errors = run(2, [Path(__file__).with_name("on_ranks.py"), "jobs.json"], folder)
    assert (errors, code) == ("", 0)
    assert [json.loads(line) for line in output.splitlines()] == ["completed"] * len(jobs)
    found = {}
    for name, job in zip(CASES, jobs, strict=True):
        # the one process has the solvers of any installation
        solver = uel.SolverOptions(**{**job.pop("solver", {}), "linear_solver": "auto"})
        one = uel.run(**job, solver=solver, output_dir=folder / "one")
        found[name] = one, Result(folder / "two" / job["job"])
    return found


def differs(one: dict[str, np.ndarray], two: dict[str, np.ndarray], kind) -> dict[str, float]:
    """Quantities that differ, relative to the largest value of their kind."""
    assert list(one) == list(two)
    largest: dict[str, float] = {}
    for name, values in one.items():
        largest[kind(name)] = max(largest.get(kind(name), 0.0), np.abs(np.nan_to_num(values)).max(initial=0.0))
    found = {name: np.abs(np.nan_to_num(two[name] - one[name])).max(initial=0.0) for name in one}
    for name, values in one.items():
        np.testing.assert_array_equal(np.isnan(values), np.isnan(two[name]))
    return {name: change for name, change in found.items() if change > SAME * largest[kind(name)]}


def vector_of(field: str) -> str:
    """What a field on cells is a part of: a vector, a tensor, the dissipated energy. Some are zero but for rounding."""
    return re.sub("^(E|S|SEP|T|W|DISS)([1-3]{2}|[NSTVF]|I+) ", r"\1 ", field)


def compare(one: Result, two: Result) -> None:
    """The same increments and iterations, and the same results."""
    rows = [
        [(row.step, row.increment, row.attempt, row.cutback, row.iterations) for row in result.status]
        for result in (one, two)
    ]
    assert rows[0] == rows[1]
    # energies are sums of one another
    kind = lambda column: "energy" if column.startswith(("ALL", "ETOTAL")) else column.partition("[")[0]  # noqa: E731
    assert differs(one.history, two.history, kind) == {}
    for frame in one.frames:
        meshes = [result.mesh(frame.increment, frame.step) for result in (one, two)]
        points, cells = ([getattr(mesh, data) for mesh in meshes] for data in ("point_data", "cell_data_dict"))
        assert differs(*points, lambda quantity: quantity) == {}
        of_cells = [{f"{name} {kind}": part[name][kind] for name in part for kind in part[name]} for part in cells]
        assert differs(*of_cells, vector_of) == {}


@pytest.mark.parametrize("name", CASES)
def test_results_of_one_process(pairs, name):
    compare(*pairs[name])


def test_one_set_of_files(pairs):
    for one, two in pairs.values():
        folders = [result.file(".sta").parent for result in (one, two)]
        names = [sorted(file.name for file in folder.glob(f"{one.job}[._-]*")) for folder in folders]
        assert names[0] == names[1]


def test_messages_of_all_ranks_are_in_the_files(pairs):
    one, two = (result.file(".msg").read_text() for result in pairs["user material"])
    assert one.count("element 30") == two.count("element 30") > 0


def test_who_factorises(pairs):
    solvers = {
        "substructures": "SOLVER SUBSTRUCTURES: ",
        "all ranks factorise": "SOLVER CLUSTER: ",
        "COH3D8": ": on rank 0, half bandwidth ",
    }
    for name, words in solvers.items():
        assert words in pairs[name][1].file(".msg").read_text()


# at a stiffness of 1e8 the damage of a point at its onset, alpha g/strength, multiplies the rounding of g by 1e7
LONG = {
    "U4": (INPUTS / "dcb" / "dcb_u4_1e6.inp", []),
    "U4, substructures": (INPUTS / "dcb" / "dcb_u4_1e6.inp", ["--solver", "substructures"]),
    "U4, all ranks factorise": (INPUTS / "dcb" / "dcb_u4_1e6.inp", ["--solver", "cluster"]),
    "U4, PETSc": (INPUTS / "dcb" / "dcb_u4_1e6.inp", ["--solver", "petsc"]),
    "BK": (INPUTS / "cohesive" / "coh3d8_bk.inp", []),
}


@pytest.mark.long
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=PETSC_NEEDED if name.endswith("PETSc") else []) for name in LONG]
)
def test_decks_of_the_folder(tmp_path, name):
    deck, words = LONG[name]
    one = uel.run(deck, output_dir=tmp_path / "one")
    code, _, errors = run(2, ["-m", "uel", "run", deck, "--output-dir", "two", "--quiet", *words], tmp_path)
    assert (errors, code) == ("", 0)
    compare(one, Result(tmp_path / "two" / deck.stem))
