# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What must not change a result: `python tests/programs/adversarial/invariances.py [--seeds N] [CASE ...]`.

The same deck runs in other units, with other node and element numbers, a second time, and with other numbers of BLAS
threads. The program compares the histories, the last displacements and the iterations of each increment; the table has
the largest difference, relative to the largest value of the same kind. The exit code is 1 if one exceeds its limit.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rewriting import (
    ENERGY,
    FORCE,
    FREQUENCY,
    LENGTH,
    ONE,
    POWER,
    SAME,
    SPEED,
    STIFFNESS,
    STRESS,
    TIME,
    TOUGHNESS,
    Dimension,
    Labels,
    Units,
    permuted,
    rewrite,
)

from uel.deck import read_deck
from uel.output import Result
from uel.running import job
from uel.usersub.layout import element_layouts

ROOT = Path(__file__).parents[3]
UNITS = (Units("m, kg, s (Pa)", 1e-3, 1e3, 1.0), Units("mm, kg, ms (GPa)", 1.0, 1e3, 1e3))
"""The decks are in mm, t, s (MPa)."""
UNIT_LIMIT, LABEL_LIMIT = 1e-9, 1e-11
THREADS = (1, 2, 4)

_DIMENSIONS: Mapping[str, Dimension] = {
    **{"length": LENGTH, "stress/length": STIFFNESS, "stress": STRESS, "energy/area": TOUGHNESS, "time": TIME},
    **{"1": ONE, "": ONE, "temperature": ONE, "length/time": SPEED},
}
"""By the unit that a property has in fortran/properties.toml."""
_U2 = element_layouts()[2]
_INTERFACE = tuple(_DIMENSIONS[item.unit] for item in (*_U2.reals, *_U2.integers))
"""Properties of U2."""
_CONDUCTANCE: Dimension = POWER
_MESH = """\
*NODE
{nodes}
*ELEMENT, TYPE={type}, ELSET=ALL
{elements}
*NSET, NSET=LEFT
{left}
*NSET, NSET=END
{end}
*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL
2.
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*DENSITY
7.8e-9
*CONDUCTIVITY
50.
*SPECIFIC HEAT
4.6e8
*AMPLITUDE, NAME=RISE
0., 0., 5e-5, 1., 1., 1.
"""
_STEPS = {
    "dynamic": "*STEP, NLGEOM, INC=500\n*DYNAMIC\n1e-5, 4e-4\n*CLOAD, AMPLITUDE=RISE\nEND, 2, 200.\n",
    "frequency": "*STEP\n*FREQUENCY\n5,\n",
    "large displacements": "*STEP, NLGEOM\n*STATIC\n0.1, 1.\n*BOUNDARY\nEND, 2, 2, 4.\n",
    "coupled": (
        "*STEP, UNSYMM=YES\n*COUPLED TEMPERATURE-DISPLACEMENT, DELTMX=20.\n0.01, 2.\n"
        "*BOUNDARY\nEND, 11, 11, 150.\nEND, 1, 1\n"
    ),
}
_REQUESTS = {
    "dynamic": (
        "*NODE OUTPUT, NSET=END\nU, V, A\n*NODE OUTPUT, NSET=LEFT_ONE\nRF\n*ENERGY OUTPUT\nALLIE, ALLKE, ALLWK\n"
    ),
    "frequency": "",
    "large displacements": "*NODE OUTPUT, NSET=END\nU, RF\n*ENERGY OUTPUT\nALLIE, ALLWK\n",
    "coupled": "*NODE OUTPUT, NSET=END\nU, RF, NT, RFL\n",
}
_RODS = """\
*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=2, PROPERTIES=3, I PROPERTIES=1, VARIABLES=1
11
*ELEMENT, TYPE=U1, ELSET=RODS
1, 1, 2
2, 2, 3
3, 3, 4
*UEL PROPERTY, ELSET=RODS
2., 0.5, 0.01, 0
*NSET, NSET=END
4
*NSET, NSET=MIDDLE
2
*STEP, INC=1000
*HEAT TRANSFER, DELTMX=5.
0.01, 2.
*BOUNDARY
1, 11, 11, 100.
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
NT
*NODE OUTPUT, NSET=MIDDLE
NT, RFL
*END STEP
"""


@dataclass(frozen=True)
class Case:
    """A deck with a user file, and the dimensions of its *UEL PROPERTY by element set.

    modes  the results are mode shapes, whose largest displacement is 1, and there is no time
    """

    name: str
    deck: Path
    user: Path | None = None
    properties: Mapping[str, Sequence[Dimension]] = field(default_factory=dict)
    modes: bool = False


@dataclass(frozen=True)
class Answer:
    """Results of a run: histories by column, displacements (nodes, 3) by number, iterations of all increments."""

    history: Mapping[str, np.ndarray]
    displacement: np.ndarray
    labels: np.ndarray
    iterations: tuple[int, ...]


def beam(name: str, columns: int = 10, rows: int = 2) -> str:
    """A cantilever of quads, 10 mm by 1 mm."""
    label = {(i, j): 1 + i * (rows + 1) + j for i in range(columns + 1) for j in range(rows + 1)}
    nodes = [f"{label[i, j]}, {10.0 * i / columns!r}, {1.0 * j / rows!r}" for i, j in label]
    corners = [
        (label[i, j], label[i + 1, j], label[i + 1, j + 1], label[i, j + 1])
        for i in range(columns)
        for j in range(rows)
    ]
    elements = [f"{k}, {', '.join(map(str, quad))}" for k, quad in enumerate(corners, start=1)]
    mesh = _MESH.format(
        nodes="\n".join(nodes),
        type="CPE4T" if name == "coupled" else "CPE4",
        elements="\n".join(elements),
        left=", ".join(str(label[0, j]) for j in range(rows + 1)),
        end=label[columns, 0],
    )
    held = "*NSET, NSET=LEFT_ONE\n1\n*BOUNDARY\nLEFT, 1, 2\n"
    requests = f"*OUTPUT, HISTORY\n{_REQUESTS[name]}" if _REQUESTS[name] else ""
    return f"{mesh}{held}{_STEPS[name]}*OUTPUT, FIELD\n*NODE OUTPUT\nU\n{requests}*END STEP\n"


def cases(folder: Path) -> Iterator[Case]:
    """All cases; generated decks go to the folder."""
    inputs = ROOT / "abaqus_inputs"
    interface = {"INTERFACE": _INTERFACE, **dict.fromkeys(("BOTTOM", "TOP"), (LENGTH, ONE, ONE))}
    yield Case("delamination, user elements", inputs / "cohesive" / "frmm_u2.inp", None, interface)
    yield Case("delamination, COH2D4", inputs / "cohesive" / "frmm_coh2d4.inp")
    yield Case("double cantilever beam", inputs / "dcb" / "dcb_u2_1e6.inp", None, interface)
    for name in _STEPS:
        deck = folder / f"{name.replace(' ', '_')}.inp"
        deck.write_text(beam(name))
        yield Case(name, deck, modes=name == "frequency")
    (folder / "rods.inp").write_text(_RODS)
    user = ROOT / "tests" / "harness" / "procedures" / "rods.f"
    yield Case("heat, user elements", folder / "rods.inp", user, {"RODS": (_CONDUCTANCE, ENERGY, _CONDUCTANCE, ONE)})


def solve(case: Case, folder: Path, units: Units = SAME, labels: Labels | None = None) -> Answer:
    """Run a rewritten case and read its results."""
    folder.mkdir(parents=True)
    deck = folder / "job.inp"
    deck.write_text(rewrite(case.deck, units, labels, case.properties))
    return answer(job.run(deck, case.user, output_dir=folder), deck)


def answer(result: Result, deck: Path) -> Answer:
    """Results that a run has written."""
    displacement = result.field("U") if result.frames else np.zeros((0, 3))
    labels = read_deck(deck).mesh.labels
    return Answer(result.history, displacement, labels, tuple(row.iterations for row in result.status))


def dimension(column: str, case: Case) -> Dimension:
    """Dimension of a column of the history."""
    if case.modes and column == "time":
        return FREQUENCY
    name = column.partition("[")[0]
    kinds: dict[str, Dimension] = {"U": LENGTH, "RF": FORCE, "V": (1, 0, -1), "A": (1, 0, -2), "NT": ONE, "RFL": POWER}
    if name in ("step", "increment"):
        return ONE
    if name in ("time", "EIGFREQ", "EIGVAL", "GM"):
        return {"time": TIME, "EIGFREQ": FREQUENCY, "EIGVAL": (0, 0, -2), "GM": (0, 1, 0)}[name]
    return ENERGY if name.startswith(("ALL", "ETOTAL")) else kinds[name.rstrip("0123456789")]


def difference(case: Case, one: Answer, other: Answer, units: Units = SAME, labels: Labels | None = None) -> float:
    """Largest difference, relative to the largest value of its kind; infinity where the increments differ."""
    if one.iterations != other.iterations or one.history.keys() != other.history.keys():
        return float("inf")
    pairs: dict[Dimension, list[tuple[np.ndarray, np.ndarray]]] = {}
    for column, values in one.history.items():
        kind = dimension(column, case)
        pairs.setdefault(kind, []).append((values * units.factor(kind), other.history[column]))
    names = [labels.nodes[label] if labels else label for label in one.labels.tolist()]
    place = {label: row for row, label in enumerate(other.labels.tolist())}
    if len(one.displacement):
        moved = other.displacement[[place[name] for name in names]]
        kind = ONE if case.modes else LENGTH
        pairs.setdefault(kind, []).append((one.displacement * units.factor(kind), moved))
    found = 0.0
    for values_of_kind in pairs.values():
        size = max(float(np.nanmax(np.abs(values), initial=0.0)) for values, _ in values_of_kind)
        apart = max(float(np.nanmax(np.abs(values - new), initial=0.0)) for values, new in values_of_kind)
        found = max(found, apart / size if size else apart)
    return found


def same_bits(one: Answer, other: Answer) -> bool:
    """Whether two runs agree in every bit."""
    columns = all(np.array_equal(one.history[name], other.history[name], equal_nan=True) for name in one.history)
    return columns and one.iterations == other.iterations and np.array_equal(one.displacement, other.displacement)


def threaded(case: Case, folder: Path, threads: int) -> Answer:
    """Run the case in a process whose BLAS uses this many threads."""
    folder.mkdir(parents=True)
    deck = folder / "job.inp"
    deck.write_text(rewrite(case.deck, properties=case.properties))
    names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
    command = [sys.executable, "-m", "uel.cli", "run", str(deck), "--quiet", "--output-dir", str(folder)]
    user = ["--user", str(case.user)] if case.user else []
    subprocess.run([*command, *user], env=os.environ | dict.fromkeys(names, str(threads)), check=True)
    return answer(Result(folder / "job"), deck)


def examine(
    case: Case, folder: Path, seeds: int, threads: Sequence[int] = THREADS
) -> Iterator[tuple[str, float, float]]:
    """What is changed, the difference that it makes, and its limit."""
    reference = solve(case, folder / "reference")
    yield "again", 0.0 if same_bits(reference, solve(case, folder / "again")) else 1.0, 0.0
    for count in threads:
        same = same_bits(reference, threaded(case, folder / f"threads{count}", count))
        yield f"{count} threads", 0.0 if same else 1.0, 0.0
    for number, units in enumerate(UNITS):
        found = difference(case, reference, solve(case, folder / f"units{number}", units), units)
        yield f"in {units.name}", found, UNIT_LIMIT
    for seed in range(seeds):
        labels = permuted(case.deck, seed)
        found = difference(case, reference, solve(case, folder / f"labels{seed}", labels=labels), labels=labels)
        yield f"numbers {seed}", found, LABEL_LIMIT


def main(arguments: Any = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="names of cases, or beginnings of them (all)")
    parser.add_argument("--seeds", type=int, default=3, metavar="N", help="orders of the numbers (3)")
    options = parser.parse_args(arguments)
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        for number, case in enumerate(cases(Path(name))):
            if options.cases and not case.name.startswith(tuple(options.cases)):
                continue
            for what, found, limit in examine(case, Path(name) / str(number), options.seeds):
                bad += found > limit
                print(
                    f"{case.name:30s} {what:24s} {found:9.1e} {'' if found <= limit else f'above {limit:g}'}",
                    flush=True,
                )
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
