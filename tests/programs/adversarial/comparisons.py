# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compare decks that must give the same result: `python tests/programs/adversarial/comparisons.py [BODY ...]`.

Every built-in element type with every kind of material, and two blocks with every kind of joint, run as they are and in
other forms: turned in space, as a part, in a turned instance, with loads of zero, in several increments, with NLGEOM
under loads of 1e-6, on two ranks (where MPI is installed); frequencies are compared as well. The matrix that stands for
linear elements is compared with their own RHS. A row for each comparison that differs, is refused, or is explained; the
exit code is 1 if a difference is not explained.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np

ROOT = Path(__file__).parents[3]
sys.path.extend(str(ROOT / "tests" / folder) for folder in ("harness", "programs/benchmarks"))

import mpiexec  # noqa: E402
from bodies import ANGLE, Body, Frame, Lines, bodies, numbers, rotation  # noqa: E402

from uel import usersub  # noqa: E402
from uel.assembly import Contributors, LinearShortcut, System  # noqa: E402
from uel.deck import read_deck  # noqa: E402
from uel.elements import Call, Flags  # noqa: E402
from uel.errors import UelError  # noqa: E402
from uel.output import Result  # noqa: E402
from uel.parallel.launch import launched  # noqa: E402
from uel.running import job  # noqa: E402

History = Mapping[str, np.ndarray]
"""Values (increments, nodes, components) by the name of the variable."""

ROUNDING: Final = 1e-9
"""Sums in another order, amplified by the condition of the matrix (1e4 to 1e6 here)."""
SLENDER: Final = 1e-8
"""The same where nodes rotate: thin plates bend 1e3 times easier than they stretch, so that the condition is 1e7; the
same load in four increments, summed, differs by 1e-9.
"""
NONLINEAR: Final = 1e-6
"""The same after iterations, which end at residuals and corrections of 1e-9."""
SMALL: Final = 1e-6
"""Factor of the loads with NLGEOM."""
GEOMETRIC: Final = 2e-4
"""Second-order terms at loads of 1e-6: strains of 1e-8, rotations of slender bodies up to 1e-5."""
OWN: Final = 1e-12
"""The matrix of an element times displacements, and its RHS: rounding alone."""
NOTHING: Final = 1e-12
"""Largest value of a variable that is zero but for rounding, such as moments where nothing bends."""

EXPLAINED: Final = (
    (
        "turned",
        ("C3D8R",),
        "Abaqus' hourglass stiffness of C3D8R differs along the global directions (host/elements/solid/hourglass.f90)",
    ),
    ("both", ("C3D8R",), "as turned"),
    ("frequencies turned", ("C3D8R",), "as turned"),
)
"""Comparisons that differ for a reason: the beginnings of their name and of the body's, and the reason."""


@dataclass(frozen=True)
class Variant:
    """A form of a deck.

    frame       its axes
    zero        lines of the step that change nothing
    increments  of the step
    factor      of the loads
    nlgeom      with NLGEOM
    output      element output as well
    modes       *FREQUENCY in place of the step
    limit       of the difference; None for the limit of the body
    """

    name: str
    frame: Frame = field(default_factory=Frame)
    zero: Callable[[Body, Frame], Lines] = lambda body, frame: []
    increments: int = 1
    factor: float = 1.0
    nlgeom: bool = False
    output: bool = False
    modes: bool = False
    limit: float | None = None


def text(body: Body, variant: Variant) -> str:
    """Deck of a body in one of its forms."""
    frame = variant.frame
    lines = [*body.part(frame), *body.data, *body.joint(frame)]
    if frame.part:
        place = ["0., 0., 0."]
        if frame.angle:
            place.append(f"0., 0., 0., {numbers(frame.axis)}, {float(np.degrees(frame.angle))!r}")
        lines = ["*PART, NAME=BODY", *body.part(frame), "*END PART", "*ASSEMBLY, NAME=A"]
        lines += ["*INSTANCE, NAME=I, PART=BODY", *place, "*END INSTANCE"]
        joint = body.joint(frame)
        inside = joint and joint[0].startswith("*TIE")
        lines += [*(joint if inside else []), "*END ASSEMBLY", *body.data, *([] if inside else joint)]
    lines += [*body.supports(frame), f"*STEP, INC=100{', NLGEOM' if variant.nlgeom else ''}"]
    if variant.modes:
        return "\n".join([*lines, "*FREQUENCY", "4", "*END STEP", ""])
    share = 1.0 / (variant.increments if body.linear else 4)
    lines.append(body.procedure.replace("1., 1.", f"{share!r}, 1., 1e-5, {share!r}"))
    if not body.linear:
        lines += ["*CONTROLS, PARAMETERS=FIELD", "1e-9, 1e-9"]
    lines += [*scaled(body.loads(frame), variant.factor), *variant.zero(body, frame)]
    if variant.output:
        lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S, E" if body.vectors else "HFL"]
    lines += ["*OUTPUT, HISTORY", f"*NODE OUTPUT, NSET={frame.set('ALL')}", ", ".join([*body.vectors, *body.scalars])]
    return "\n".join([*lines, "*END STEP", ""])


def scaled(loads: Lines, factor: float) -> Lines:
    """Multiply loads, the third fields of lines; of temperatures the second, of *BOUNDARY the last."""
    keyword, done = "", []
    for line in loads:
        if line.startswith("*"):
            keyword = line
            done.append(line)
            continue
        fields = line.split(", ")
        magnitude = {"*TEMPERATURE": 1, "*BOUNDARY": len(fields) - 1}.get(keyword.split(",")[0], 2)
        fields[magnitude] = repr(factor * float(fields[magnitude]))
        done.append(", ".join(fields))
    return done


def values(result: Result, body: Body, variant: Variant) -> dict[str, np.ndarray]:
    """Histories of all nodes, vectors in the axes of the body; or the frequencies."""
    if variant.modes:
        return {"EIGFREQ": result.history["EIGFREQ"][None, :, None]}
    columns: dict[str, list[np.ndarray]] = {}
    for column, array in result.history.items():
        columns.setdefault(column.partition("[")[0], []).append(array)
    found = {}
    for name in body.vectors:
        names = [f"{name}{k}" for k in range(1, body.dimension + 1)]
        components = np.stack([np.stack(columns[each], axis=1) for each in names], axis=2)
        found[name] = components @ variant.frame.world[: body.dimension, : body.dimension]
    for name in body.scalars:
        found[name] = np.stack(columns[name], axis=1)[:, :, None]
    return found


def difference(one: History, other: History, factor: float = 1.0) -> float:
    """Largest difference of the last values, relative to the largest value of the variable."""
    worst = 0.0
    for name, expected in one.items():
        size = np.abs(expected[-1]).max()
        apart = np.abs(expected[-1] - other[name][-1] / factor).max()
        worst = max(worst, float(apart / size) if size > NOTHING else float(apart))
    return worst


def zero_forces(body: Body, frame: Frame) -> Lines:
    """Forces and pressures of zero on all nodes and elements."""
    if not body.vectors:
        return ["*CFLUX", f"{frame.set('ALL')}, 11, 0."]
    lines = ["*CLOAD", f"{frame.set('ALL')}, 1, 0."]
    return lines + (["*DLOAD", f"{frame.set('BODY')}, {body.pressure}, 0."] if body.pressure else [])


def zero_temperature(body: Body, frame: Frame) -> Lines:
    """A temperature of zero at all nodes."""
    return ["*TEMPERATURE", f"{frame.set('ALL')}, 0."]


def zero_field(body: Body, frame: Frame) -> Lines:
    """A field variable of zero at all nodes."""
    return ["*FIELD, VARIABLE=1", f"{frame.set('ALL')}, 0."]


def variants(body: Body) -> Iterator[Variant]:
    """Forms of a body whose results are those of the first one."""
    if body.turns is not None:
        yield Variant("turned", Frame(world=rotation(body.turns, ANGLE)))
        yield Variant("turned far", Frame(world=rotation(body.turns, 5.0 * ANGLE)))
    yield Variant("as a part", Frame(part=True))
    if body.turns is not None:
        yield Variant("in a turned instance", Frame(part=True, axis=body.turns, angle=ANGLE))
        world = rotation(body.turns, 2.0 * ANGLE)
        yield Variant("both", Frame(world=world, part=True, axis=body.turns, angle=-ANGLE))
    yield Variant("zero forces", zero=zero_forces)
    if body.takes_temperature:
        yield Variant("zero temperature", zero=zero_temperature)
    yield Variant("zero field", zero=zero_field)
    yield Variant("element output", output=True)
    if body.linear:
        yield Variant("four increments", increments=4)
        yield Variant("twice the load", factor=2.0)
    if body.linear and body.vectors and body.large:
        yield Variant("NLGEOM at 1e-6", factor=SMALL, nlgeom=True, limit=GEOMETRIC)


def modal_variants(body: Body) -> Iterator[Variant]:
    """Forms of a body whose frequencies are those of the first one."""
    if not (body.mass and body.linear and body.vectors):
        return
    yield Variant("frequencies", modes=True)
    if body.turns is not None:
        yield Variant("frequencies turned", Frame(world=rotation(body.turns, ANGLE)), modes=True)
        turned = Frame(part=True, axis=body.turns, angle=ANGLE)
        yield Variant("frequencies in an instance", turned, modes=True)


@dataclass(frozen=True)
class Row:
    """A comparison: its difference and limit, and what it was refused with or the reason why it differs."""

    body: str
    variant: str
    difference: float = np.nan
    limit: float = 0.0
    refused: str = ""

    @property
    def explained(self) -> str:
        """The reason why the results differ, if there is one."""
        names = ((self.variant.startswith(name) and self.body.startswith(of), why) for name, of, why in EXPLAINED)
        return next((why for holds, why in names if holds), "")

    @property
    def verdict(self) -> str:
        """Equal, refused, explained or differs."""
        if self.refused:
            return "refused"
        if self.difference <= self.limit:
            return "equal"
        return "explained" if self.explained else "differs"

    def __str__(self) -> str:
        text = self.refused or f"{self.difference:.1e} above {self.limit:g} {self.explained}"
        return f"{self.body:34s} {self.variant:26s} {self.verdict:9s} {text}"


def run(body: Body, variant: Variant, folder: Path) -> History:
    """Run a body in one of its forms."""
    deck = folder / "job.inp"
    deck.write_text(text(body, variant))
    return values(job.run(deck, output_dir=folder), body, variant)


def limit_of(body: Body) -> float:
    """Largest difference between two forms of a body that is rounding."""
    if not body.linear:
        return NONLINEAR
    return SLENDER if "UR" in body.vectors else ROUNDING


def compare(body: Body, folder: Path) -> Iterator[Row]:
    """Compare the forms of a body; a body that is refused as it is gives one row."""
    for first, *forms in (
        [Variant("as it is", nlgeom=body.nlgeom), *variants(body)],
        list(modal_variants(body)) or [None],
    ):
        if first is None:
            continue
        try:
            expected = run(body, first, folder)
        except UelError as error:
            yield Row(body.name, first.name, refused=_first_line(error))
            continue
        for variant in forms:
            form = replace(variant, nlgeom=variant.nlgeom or first.nlgeom)
            limit = variant.limit or limit_of(body)
            try:
                found = run(body, form, folder)
            except UelError as error:
                yield Row(body.name, variant.name, refused=_first_line(error))
                continue
            yield Row(body.name, variant.name, difference(expected, found, form.factor), limit)


def _first_line(error: UelError) -> str:
    return str(error).splitlines()[0].rpartition("/")[2]


def compare_matrices(body: Body, folder: Path) -> Iterator[Row]:
    """Compare the matrices that stand for the linear elements of a body with what the elements return."""
    if not body.procedure.startswith("*STATIC"):
        # matrices stand for elements in static steps alone
        return
    deck = folder / "own.inp"
    deck.write_text(text(body, Variant("own", nlgeom=body.nlgeom)))
    try:
        model = read_deck(deck)
        library = usersub.load(None, job="own", output_dir=folder)
        spared, called = (
            kind(model.mesh, Contributors.of(model, library), model.equations) for kind in (LinearShortcut, System)
        )
    except UelError:
        return
    if not any(block.linear for block in spared.blocks):
        return
    call = Call(Flags(1), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)
    zero = np.zeros(len(spared))
    spared.evaluate(call, zero, zero)
    # a second state: the elements are not called in the second pass, and must be where they are
    u = np.random.default_rng(1).uniform(-1e-3, 1e-3, len(spared))
    one, other = spared.evaluate(call, u, u), called.evaluate(call, u, u)
    size = np.abs(other.residual).max()
    yield Row(body.name, "own RHS", float(np.abs(one.residual - other.residual).max() / size), OWN)
    library.close()


def compare_ranks(chosen: Sequence[Body], folder: Path) -> Iterator[Row]:
    """Compare runs on two ranks with runs in one process, all in one start of MPI."""
    if not mpiexec.MPIEXEC.exists():
        return
    variant = Variant("two ranks")
    expected: dict[str, History] = {}
    for number, body in enumerate(chosen):
        form = replace(variant, nlgeom=body.nlgeom)
        try:
            expected[f"r{number}"] = run(body, form, folder)
        except UelError:
            continue
        (folder / f"r{number}.inp").write_text(text(body, form))
    names = sorted(expected, key=lambda name: int(name[1:]))
    command = [str(mpiexec.MPIEXEC), "-n", "2", sys.executable, __file__, "--decks", *names]
    subprocess.run(command, cwd=folder, env=mpiexec.variables(), check=False)
    for name in names:
        body = chosen[int(name[1:])]
        limit = limit_of(body)
        refused = folder / f"{name}.refused"
        if refused.exists():
            yield Row(body.name, variant.name, refused=refused.read_text())
        elif (folder / f"{name}.done").exists():
            found = values(Result(folder / name), body, variant)
            yield Row(body.name, variant.name, difference(expected[name], found), limit)
        else:
            # a traceback has ended the ranks
            yield Row(body.name, variant.name)


def run_decks(names: Sequence[str]) -> None:
    """Run decks of the current folder on the ranks of this process; what one is refused with goes to a file."""
    from uel.parallel.mpi import MpiRanks  # noqa: PLC0415 (starts MPI)

    class Staying(MpiRanks):
        """Ranks that stay together after a job."""

        def close(self) -> None:
            """Leave MPI as it is for the next job."""
            self._together = None

    ranks = Staying(launched())
    for name in names:
        try:
            job.run(f"{name}.inp", ranks=ranks)
        except UelError as error:
            if ranks.rank == 0:
                Path(f"{name}.refused").write_text(_first_line(error))
        else:
            if ranks.rank == 0:
                Path(f"{name}.done").touch()


def examine(chosen: Sequence[Body], folder: Path) -> Iterator[Row]:
    """All comparisons of the chosen bodies."""
    for body in chosen:
        yield from compare(body, folder)
        yield from compare_matrices(body, folder)
    yield from compare_ranks(chosen, folder)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="BODY", help="beginnings of names of bodies (all)")
    parser.add_argument("--decks", nargs="+", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.decks:
        run_decks(options.decks)
        return 0
    chosen = [body for body in bodies() if not options.names or body.name.startswith(tuple(options.names))]
    counts = Counter[str]()
    with tempfile.TemporaryDirectory() as name:
        for row in examine(chosen, Path(name)):
            counts[row.verdict] += 1
            if row.verdict != "equal":
                print(row, flush=True)
    print(", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    return int(counts["differs"] > 0)


if __name__ == "__main__":
    sys.exit(main())
