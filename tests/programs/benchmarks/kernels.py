# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Time of one call of every element: `python tests/programs/benchmarks/kernels.py`.

The measure is a plain quad of four nodes, K = sum w B^T D B and R = -K u, a user element that is compiled in the same
run: times on different machines compare by their ratio to it. Every element is called by the driver's loop over a block
of like elements, without the scatter of AMATRX. What is compared takes turns: the plain quad, calls for RHS and AMATRX,
calls for RHS alone, and first calls, in which self-contained elements find their beta. States are elastic, as those of
most elements of a model are. `--before` takes kernels.so of another commit, whose elements must have the same
properties: its calls take turns with those of the installed one. `--write` writes the table into fortran/speed.md.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from bench import in_turns, least_of_turns
from rich.console import Console
from rich.table import Table

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.delamination import markdown
from uel.elements import Call, ElementBlock, Flags, Request
from uel.model.arrays import FloatArray
from uel.solver.linear import measured
from uel.solver.threads import one_blas_thread
from uel.usersub.layout import element_layouts

sys.path.extend(str(Path(__file__).parents[2] / folder) for folder in ("kernels", "harness"))

from conftest import Element
from reference_cells import unit_cell
from solid_pairs import MEAN, MODES, OWNING, REDUCED, geometry

PAGE = Path(__file__).parents[3] / "fortran" / "speed.md"
BEGIN = "<!-- rows of tests/programs/benchmarks/kernels.py -->"
REQUESTS = ("RHS and AMATRX", "RHS alone", "first call")
COPIES = 400
"""Elements of a block: so many that a pass over them takes longer than its Python, and few enough for the caches."""
SECONDS = 1.0
"""Time of the turns of a row."""
DISPLACEMENT = 1e-5
"""Displacements of the nodes, at random; elements have edges of about 1."""

PLAIN_QUAD = """\
subroutine uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u)
  implicit none
  integer, parameter :: dp = kind(1d0)
  integer, intent(in) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode
  real(dp), intent(out) :: rhs(8), amatrx(8, 8)
  real(dp), intent(in) :: svars(*), energy(8), props(2), coords(2, 4), u(8)
  real(dp), parameter :: xi(4) = [-1, 1, 1, -1], eta(4) = [-1, -1, 1, 1], gauss = sqrt(1/3d0)
  real(dp) :: d(3, 3), b(3, 8), db(3, 8), by_xi(4), by_eta(4), j(2, 2), det
  integer :: k, i, l
  d = 0
  d(1, 1) = props(1)/(1 - props(2)**2)
  d(2, 2) = d(1, 1)
  d(1, 2) = props(2)*d(1, 1)
  d(2, 1) = d(1, 2)
  d(3, 3) = props(1)/(2 + 2*props(2))
  amatrx = 0
  b = 0
  do k = 1, 4
    by_xi = xi*(1 + eta*eta(k)*gauss)/4
    by_eta = eta*(1 + xi*xi(k)*gauss)/4
    do i = 1, 2
      j(1, i) = sum(by_xi*coords(i, :))
      j(2, i) = sum(by_eta*coords(i, :))
    end do
    det = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
    do i = 1, 4
      b(1, 2*i - 1) = (j(2, 2)*by_xi(i) - j(1, 2)*by_eta(i))/det
      b(2, 2*i) = (j(1, 1)*by_eta(i) - j(2, 1)*by_xi(i))/det
      b(3, 2*i - 1) = b(2, 2*i)
      b(3, 2*i) = b(1, 2*i - 1)
    end do
    do i = 1, 8
      db(:, i) = det*(d(:, 1)*b(1, i) + d(:, 2)*b(2, i) + d(:, 3)*b(3, i))
    end do
    do l = 1, 8
      amatrx(:, l) = amatrx(:, l) + b(1, :)*db(1, l) + b(2, :)*db(2, l) + b(3, :)*db(3, l)
    end do
  end do
  rhs = 0
  do l = 1, 8
    rhs = rhs - amatrx(:, l)*u(l)
  end do
end subroutine uel
"""

FACES_OF = {2: 4, 3: 4, 5: 6, 7: 8, 10: 8, 11: 12, 13: 404, 14: 1010}
"""Self-contained element whose faces an interface element without solids has."""
RECOMMENDED = {"CLOSURE": 0, "BETAN": 0, "BETAT": 0}
BESIDE = {3: (1, 3, 1), 10: (9, 2, 1)}
"""Continuum element below and above an interface that takes its stress, with their faces."""
CONTINUUM = {1: "quad", 9: "hexahedron"}


def on_faces(jtype: int, values: FloatArray) -> FloatArray:
    """Return values (..., nodes, dim) of an interface element from those of the self-contained one around it."""
    layouts, whole = element_layouts(), FACES_OF.get(jtype, jtype)
    if whole == jtype:
        return values
    found = np.empty((*values.shape[:-2], layouts[jtype].nodes, values.shape[-1]))
    for mine, other in zip(layouts[jtype].faces, layouts[whole].faces, strict=True):
        found[..., list(mine), :] = values[..., list(other), :]
    return found


def random_displacements(nodes: FloatArray) -> FloatArray:
    """Return displacements (copies, nodes, dim)."""
    return DISPLACEMENT * np.random.default_rng(1).normal(size=(COPIES, *nodes.shape))


def own_block(
    library: usersub.Library, jtype: int, values: dict[str, float], *, nlgeom: bool
) -> tuple[ElementBlock, FloatArray]:
    """Return elements of the project and displacements; those beside them, if they take a stress, have stored it."""
    if jtype in CONTINUUM:
        nodes = unit_cell(CONTINUUM[jtype])[0]
    else:
        nodes = geometry(FACES_OF.get(jtype, jtype), np.random.default_rng(1), random=0.05)
    u, label, values = random_displacements(nodes), 1, (RECOMMENDED if jtype in OWNING else {}) | values
    if jtype in BESIDE:
        continuum, *faces = BESIDE[jtype]
        solids = zip(np.split(nodes, 2), np.split(u, 2, axis=1), faces, strict=True)
        for solid, moved, face in solids:
            neighbour = Element(library, continuum, solid, label=label, copies=COPIES, FACE=face)
            neighbour.evaluate(moved, flags=(1, int(nlgeom), 0, 0))
            label += COPIES
        values |= {"OFFSETBOTTOM": -2 * COPIES, "OFFSETTOP": -COPIES}
    block = Element(library, jtype, on_faces(jtype, nodes), label=label, copies=COPIES, **values).block
    return block, on_faces(jtype, u)


ELASTIC = "*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n"
RUBBER = "*MATERIAL, NAME=M\n*HYPERELASTIC, NEO HOOKE\n1., 0.01\n"
LAW = """\
*MATERIAL, NAME=M
*ELASTIC, TYPE=TRACTION
2.E4, 3.E4, 3.E4
*DAMAGE INITIATION, CRITERION=MAXS
30., 60., 60.
*DAMAGE EVOLUTION, TYPE=ENERGY
0.26,
"""
CELLS = {"CPS4": "quad", "C3D20": "hexahedron20", "C3D20R": "hexahedron20", "S4R": "quad", "COH2D4": "quad"}
"""Cells of built-in elements other than bricks of eight nodes."""
SECTIONS = {"S4R": "SHELL SECTION", "COH2D4": "COHESIVE SECTION", "COH3D8": "COHESIVE SECTION"}


def block_of_deck(
    library: usersub.Library, name: str, nodes: FloatArray, cards: str, folder: Path
) -> tuple[ElementBlock, FloatArray]:
    """Return elements of a deck, and displacements; `cards` are their sections and materials."""
    deck, count = folder / f"{name}.inp", len(nodes)
    lines = ["*NODE"]
    lines += [f"{k}, " + ", ".join(map(str, xyz)) for k, xyz in enumerate(np.tile(nodes, (COPIES, 1)), start=1)]
    lines += [f"*ELEMENT, TYPE={name}, ELSET=ALL"]
    for k in range(COPIES):
        numbers = [str(number) for number in range(k * count + 1, (k + 1) * count + 1)]
        lines.append(f"{k + 1}, " + ",\n".join(", ".join(part) for part in (numbers[:12], numbers[12:]) if part))
    deck.write_text("\n".join(lines) + "\n" + cards)
    (block,) = system_of(read_deck(deck), library).blocks
    unknowns = len(block.unknowns) // count
    return block, random_displacements(np.zeros((count, unknowns)))


def built_in_block(
    library: usersub.Library, name: str, material: str, folder: Path, *, nlgeom: bool
) -> tuple[ElementBlock, FloatArray]:
    """Return built-in elements and displacements."""
    nodes, section = unit_cell(CELLS.get(name, "hexahedron"))[0], SECTIONS.get(name, "SOLID SECTION")
    if "COH" in name:
        section += ", RESPONSE=TRACTION SEPARATION, THICKNESS=SPECIFIED"
    data = "0.1, 5\n" if name == "S4R" else "1.,\n" if nodes.shape[1] == 2 or "COH" in name else ""
    cards = f"*{section}, ELSET=ALL, MATERIAL=M\n{data}{material}"
    cards += f"*STEP, NLGEOM={'YES' if nlgeom else 'NO'}\n*STATIC\n1., 1.\n*END STEP\n"
    return block_of_deck(library, name, nodes, cards, folder)


def plain_quads(folder: Path) -> tuple[usersub.Library, tuple[ElementBlock, FloatArray]]:
    """Return the library of the plain quads, these, and displacements."""
    source = folder / "plain_quad.f90"
    source.write_text(PLAIN_QUAD)
    options = ("-O3", "-ffp-contract=off", "-shared", "-fPIC", "-w")
    subprocess.run(["gfortran", *options, "-o", source.with_suffix(".so"), source], check=True)
    library = usersub.load(source.with_suffix(".so"), job="plain", output_dir=folder)
    cards = "*USER ELEMENT, TYPE=U99, NODES=4, COORDINATES=2, PROPERTIES=2, VARIABLES=1\n1, 2\n"
    cards += "*UEL PROPERTY, ELSET=ALL\n210000., 0.3\n*STEP\n*STATIC\n1., 1.\n*END STEP\n"
    return library, block_of_deck(library, "U99", unit_cell("quad")[0], cards, folder)


@dataclass(frozen=True)
class Case:
    """A row of the table; `values` are properties of an element of the project."""

    title: str
    type: str
    values: dict[str, float] = field(default_factory=dict)
    material: str = ELASTIC
    nlgeom: bool = False

    def block(self, library: usersub.Library, folder: Path) -> tuple[ElementBlock, FloatArray]:
        """Make its elements, and displacements."""
        if self.type.startswith("U"):
            return own_block(library, int(self.type[1:]), self.values, nlgeom=self.nlgeom)
        material = LAW if "COH" in self.type else self.material
        return built_in_block(library, self.type, material, folder, nlgeom=self.nlgeom)


def cases() -> Iterator[Case]:
    """Return the rows in order."""
    for jtype in element_layouts():
        if jtype <= 14 or jtype in (33, 404, 608, 1010):
            yield Case(f"U{jtype}", f"U{jtype}")
    for name, formulation in (("incompatible modes", MODES), ("mean volume", MEAN), ("reduced", REDUCED)):
        yield Case(f"U8, {name}", "U8", {f"FORMULATION {side}": formulation for side in ("BOTTOM", "TOP")})
    yield Case("U8, closure of the paper", "U8", {"CLOSURE": 2, "BETAN": -2, "BETAT": -2})
    yield Case("U9, incompatible modes", "U9", {"FORMULATION": MODES})
    for name in ("U1", "U2", "U4", "U7", "U8", "U9"):
        yield Case(f"{name}, NLGEOM", name, nlgeom=True)
    for name in ("CPS4", "C3D8", "C3D8R", "C3D8I", "C3D20", "C3D20R", "S4R", "COH2D4", "COH3D8"):
        yield Case(name, name)
    yield Case("C3D8, NLGEOM", "C3D8", nlgeom=True)
    yield Case("C3D8, neo-Hookean, NLGEOM", "C3D8", material=RUBBER, nlgeom=True)


def call_of(request: Request, *, nlgeom: bool) -> Call:
    """Return the arguments of a call."""
    return Call(Flags(1, nlgeom=nlgeom, request=request), 1, 1, 1.0, 1.0, 0.01, 1.0)


def loops(block: ElementBlock, u: FloatArray, *, nlgeom: bool) -> tuple[Callable[[], object], ...]:
    """Return loops over the elements: first calls, later ones, and later ones for RHS alone."""
    both, alone = (call_of(request, nlgeom=nlgeom) for request in (Request.NORMAL, Request.RESIDUAL))
    later = block.part(np.arange(COPIES))
    unknowns = np.arange(COPIES * len(block.unknowns), dtype=np.int32).reshape(COPIES, -1)
    u = u.ravel()
    residual = np.zeros_like(u)
    for each in (block, later):
        each.bind(unknowns, np.zeros((*unknowns.shape, unknowns.shape[1]), dtype=np.int32))
    later.evaluate(both, u, u, residual, None)
    later.commit()
    return (
        lambda: block.evaluate(both, u, u, residual, None),
        lambda: later.evaluate(both, u, u, residual, None),
        lambda: later.evaluate(alone, u, u, residual, None),
    )


def measure(case: Case, plain: Callable[[], object], libraries: list[usersub.Library], folder: Path) -> FloatArray:
    """Return times in ns per element, (1 + 3 libraries,): the plain quad, then the loops of each library."""
    # twice: the second call has the caches of its own
    functions = [plain, plain]
    for library in libraries:
        functions += loops(*case.block(library, folder), nlgeom=case.nlgeom)
    in_turns(*functions, repetitions=2)
    once = 1e-3 * in_turns(*functions, repetitions=1).sum()
    times = least_of_turns(in_turns(*functions, repetitions=5 * max(1, min(10, round(SECONDS / once / 5)))))[:, 1:]
    return 1e6 / COPIES * np.median(times, axis=0)


def cells(times: FloatArray, *, beside: bool) -> list[str]:
    """Return the cells of a row from the times of `measure`."""
    plain, now, before = times[0], times[1:4], times[4:]
    found = []
    for k in (1, 2, 0):
        found += [f"{before[k]:,.0f}"] if beside else []
        found += [f"{now[k]:,.0f}", *([f"{now[k] / before[k]:.2f}"] if beside else []), f"{now[k] / plain:.1f}"]
    return found


def write(rows: list[list[str]], plain: str) -> None:
    """Write the rows into the page."""
    head = ["element", *(cell for name in REQUESTS for cell in (name, "x"))]
    lines = [f"{measured.machine()}; {plain}:", "", *markdown.head(head), *map(markdown.line, rows)]
    text = measured.replaced(PAGE.read_text(encoding="utf-8"), BEGIN, "\n".join(lines))
    PAGE.write_text(text, encoding="utf-8")


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="kernels.so of another commit, to compare with")
    parser.add_argument("--only", default="", help="rows whose names contain this text")
    parser.add_argument("--write", action="store_true", help=f"write the table into {PAGE.name}")
    options = parser.parse_args()
    beside = options.before is not None
    if options.write and (beside or options.only):
        parser.error("--write takes all rows, of the installed kernels alone")
    table = Table("element", title="ns per element; x: over the plain quad", title_justify="left")
    for name in REQUESTS:
        for column in (*(["before"] if beside else []), name, *(["of before"] if beside else []), "x"):
            table.add_column(column, justify="right")
    rows, of_plain = [], []
    with tempfile.TemporaryDirectory() as name, one_blas_thread():
        folder = Path(name)
        own, quads = plain_quads(folder)
        plain = loops(*quads, nlgeom=False)[1]
        files = [None, options.before] if beside else [None]
        libraries = [usersub.load(file, job="kernels", output_dir=folder) for file in files]
        for case in cases():
            if options.only in case.title:
                times = measure(case, plain, libraries, folder)
                of_plain.append(times[0])
                rows.append([case.title, *cells(times, beside=beside)])
                table.add_row(*rows[-1])
        for library in (own, *libraries):
            library.close()
    console, title = Console(width=140), f"the plain quad takes {np.median(of_plain):.0f} ns"
    console.print(table)
    console.print(title)
    if options.write:
        write(rows, title)
    return 0


if __name__ == "__main__":
    sys.exit(main())
