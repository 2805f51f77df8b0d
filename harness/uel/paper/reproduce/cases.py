# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's delamination tests: one deck for each specimen, layup, element, stiffness and mesh."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from uel.delamination import flexure, specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen
from uel.delamination.materials import TABLE_2, Cohesive
from uel.delamination.mesh import TwoArmMesh
from uel.delamination.specimens import ARM_HEIGHT, ARMS, CRACK
from uel.delamination.steps import Increments
from uel.paper.patches import PLIES, stabilisation
from uel.paper.study.cases import BUMP, KINDS, STIFFNESSES, MeshedSpecimen

PARTS = 25
"""Profiles are written at the end of so many equal parts of the displacement: the same moments for all runs."""
PRINT_EVERY = 10
START = 60.0
"""The start of a run takes as long as so many quads of a delamination test."""
ROWS = 4
"""Rows of quads over the height of an arm in the paper's cases."""

ENDS = {"dcb": {"0/0": 3.0, "0/90": 8.0}, "enf": {"0/0": 5.0, "0/90": 8.0}, "frmm": {"0/0": 5.0, "0/90": 6.0}}
"""Displacement at the end (mm), beyond the softening branch."""
PROBLEMS = {name: KINDS[name]._replace(displacement=ends) for name, ends in ENDS.items()}
"""The specimens, on the meshes of the study."""


def _longer(crack: float) -> MeshedSpecimen:
    """Lengthen the crack of the fixed-ratio specimen, displaced as much as its growth takes by beam theory."""
    base = PROBLEMS["frmm"]
    reach = ((crack + ARMS.correction) / (CRACK + ARMS.correction)) ** 2
    ends = {layup: end * reach for layup, end in base.displacement.items()}
    return base._replace(displacement=ends, mesh=partial(flexure.frmm_mesh, crack=crack))


LONGER = {"frmm70": 70.0, "frmm140": 140.0}
"""Length of the crack (mm) of fixed-ratio specimens beside the paper's, whose short arms are not plain beams."""
_SPECIMENS = PROBLEMS | {name: _longer(crack) for name, crack in LONGER.items()}
QUICK_SIZES = {"dcb": 1.0 / 6.0, "enf": 1.0 / 3.0, "frmm": 1.0 / 6.0} | dict.fromkeys(LONGER, 1.0 / 6.0)
"""Length of the elements with --quick (mm). Twice the full mesh's takes longer: with fewer elements in the process
zone each failing point is a snap, and at the peak of the [0/90] end-notched flexure the search does not end."""
INCREMENTS = {False: 100, True: 50}
"""Number of increments, if none is cut: full, and with --quick."""
MOMENTS = {
    ("dcb", "0/0"): 1.8,
    ("dcb", "0/90"): 5.12,
    ("enf", "0/0"): 3.0,
    ("enf", "0/90"): 5.12,
    ("frmm", "0/0"): 3.0,
    ("frmm", "0/90"): 4.32,
} | {(name, "0/0"): 0.6 * kind.displacement["0/0"] for name, kind in _SPECIMENS.items() if name in LONGER}
"""Displacement at which the profiles are drawn (mm), a multiple of 1/PARTS of the last one. The paper gives none; in
its figure 9 the traction of the DCB [0/0] changes its sign at X1 = 44 mm, which is at 1.8 mm."""
AROUND = {"dcb": (-6.0, 8.0), "enf": (-10.0, 14.0), "frmm": (-6.0, 14.0)}
"""Stretch about the front of the damage that the profiles show (mm)."""
SECANT_INCREMENTS = 500
SECANT_TOLERANCE = 0.5
"""R_n a hundred times Abaqus' default."""
LAYUPS = tuple(PLIES)
SHOWN = ("1e4", "1e6", "1e8")
"""Stiffnesses of the paper's runs."""
ELEMENTS = {
    "standard": Interface("U2", TABLE_2),
    "paper": Interface("U4", TABLE_2, consistent=False),
    "consistent": Interface("U4", TABLE_2),
}
"""The paper's two elements, and the one whose law has a separation of its own; beta by (21)."""
BK = 2.0
"""Exponent of Benzeggagh and Kenane's criterion; the paper gives none."""
PEAK_STEP = 0.002
"""Increments in which a run passes its peak, over the displacement there: the load then misses less of the peak."""
COMPARATORS = {
    "COH2D4": Interface("COH2D4", TABLE_2, law=2, eta=BK),
    "standard_bk": Interface("U2", TABLE_2, law=2, eta=BK, newton_cotes=True),
    "consistent_bk": Interface("U4", TABLE_2, law=2, eta=BK),
}
"""Abaqus' built-in element, and ours with its criterion."""


def called(element: str) -> str:
    """Return the name of an element in the title of a deck."""
    return "the paper's element" if element == "paper" else f"{element.replace('_', ' ')} element"


@dataclass(frozen=True, slots=True)
class PaperCase:
    """Case of a delamination test.

    problem, layup, element, stiffness   keys of PROBLEMS or LONGER, LAYUPS, ELEMENTS or COMPARATORS, STIFFNESSES
    perturbed     the interface nodes are moved
    coarse        the mesh of --quick
    size          length of the elements in place of the problem's (mm)
    increments    number of increments, if none is cut, in place of that of INCREMENTS
    rows          rows of quads over the height of an arm
    strength      factor of both strengths
    beta          factor of the stabilisation by equation (21)
    weight        of the bulk stress below, in place of that of equation (22)
    sampling      of the bulk stress: 0 middle of the face, 1 face, 2 Gauss point
    newton_cotes  integration points at the nodes
    secant, tolerance  AMATRX by equation (24), and the residual R_n that is let pass
    window        part of the load curve (mm) that is run in small increments: start, end, increment; the run ends there
    """

    problem: str
    layup: str
    element: str
    stiffness: str
    perturbed: bool = False
    coarse: bool = False
    size: float | None = None
    increments: int | None = None
    rows: int = ROWS
    strength: float = 1.0
    beta: float = 1.0
    weight: float = 0.0
    sampling: int = 0
    newton_cotes: bool = False
    secant: bool = False
    tolerance: float | None = None
    window: tuple[float, float, float] | None = None

    @property
    def name(self) -> str:
        """Name of the deck."""
        words = [self.problem, self.layup.replace("/", "_"), self.element, self.stiffness]
        words += ["perturbed"] * self.perturbed + ["coarse"] * self.coarse
        words += [f"size{self.size:g}"] if self.size is not None else []
        words += [f"inc{self.increments}"] if self.increments is not None else []
        numbers = {"rows": (self.rows, ROWS), "strength": (self.strength, 1.0), "beta": (self.beta, 1.0)}
        numbers["weight"] = (self.weight, 0.0)
        words += [f"{word}{value:g}" for word, (value, usual) in numbers.items() if value != usual]
        words += [f"sampling{self.sampling}"] if self.sampling else []
        words += ["newtoncotes"] * self.newton_cotes + ["secant"] * self.secant
        words += [f"tol{self.tolerance:g}"] if self.tolerance is not None else []
        words += ["peak"] if self.window is not None else []
        return "_".join(words).replace(".", "p")

    @property
    def kind(self) -> MeshedSpecimen:
        """Specimen."""
        return _SPECIMENS[self.problem]

    @property
    def fallback(self) -> bool:
        """True to search downhill where Newton's method fails; the paper's own method, by secant, does without."""
        return not self.secant

    @property
    def element_size(self) -> float:
        """Length of the elements along the crack's way (mm)."""
        if self.size is not None:
            return self.size
        return QUICK_SIZES[self.problem] if self.coarse else self.kind.size

    def sized(self, size: float) -> PaperCase:
        """Return the case with another length of the elements; itself if it has that length."""
        return self if size == self.element_size else replace(self, size=size)

    @property
    def displacement(self) -> float:
        """Displacement at the end (mm)."""
        return self.kind.displacement[self.layup]

    @property
    def own_separation(self) -> bool:
        """True if the law has a separation of its own, so that the element writes D for its damage (damage.py)."""
        interface = (ELEMENTS | COMPARATORS)[self.element]
        return not interface.built_in and interface.type == "U4" and interface.consistent

    @property
    def law(self) -> Cohesive:
        """Parameters of the law."""
        stiffness, factor = STIFFNESSES[self.stiffness], self.strength
        return Cohesive(stiffness, stiffness, factor * TABLE_2.strength_normal, factor * TABLE_2.strength_shear)

    @property
    def increment_count(self) -> int:
        """Number of increments, if none is cut."""
        if self.increments is not None:
            return self.increments
        # in each of them the crack passes as many elements as in the paper's specimen
        longer = round(LONGER.get(self.problem, CRACK) / CRACK)
        return INCREMENTS[self.coarse] * longer

    @property
    def work(self) -> float:
        """Cost of the run, in quads; with more increments each takes fewer iterations, so that they hardly count."""
        mesh = self.mesh()
        return START + mesh.columns * sum(mesh.rows)

    def mesh(self) -> TwoArmMesh:
        """Build the mesh."""
        mesh = self.kind.mesh(self.element_size, BUMP * self.element_size * self.perturbed)
        heights = np.linspace(0.0, ARM_HEIGHT, self.rows + 1)
        return replace(mesh, lower=heights, upper=ARM_HEIGHT + heights)

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        mesh_name = f"{self.problem}_{'perturbed' if self.perturbed else 'structured'}"
        mesh = self.mesh()
        interface = self._interface(mesh)
        return specimens.mesh_files(mesh_name, mesh, (interface.nodes,)) | {
            f"{self.name}.inp": self._deck(mesh_name, mesh, interface)
        }

    def _interface(self, mesh: TwoArmMesh) -> Interface:
        base = (ELEMENTS | COMPARATORS)[self.element]
        beta = BY_EQUATION_21
        if self.beta != 1.0:
            top, bottom = PLIES[self.layup]
            heights = float(mesh.lower[-1] - mesh.lower[-2]), float(mesh.upper[1] - mesh.upper[0])
            beta = self.beta * stabilisation(bottom, top, heights, 1.0)
        return replace(
            base,
            cohesive=self.law,
            beta=beta,
            weight=self.weight,
            sampling=self.sampling,
            newton_cotes=base.newton_cotes or self.newton_cotes,
            secant=self.secant,
        )

    def _deck(self, mesh_name: str, mesh: TwoArmMesh, interface: Interface) -> str:
        top, bottom = PLIES[self.layup]
        specimen = Specimen(mesh_name, mesh, interface, specimens.WIDTH, bottom, top)
        title = f"{self.kind.title.capitalize()}, [{self.layup}], {called(self.element)}, {self.stiffness} N/mm^3"
        title += ", perturbed mesh" * self.perturbed

        def deck(displacement: float, step: float) -> str:
            increments = Increments(
                step, 1e-7, step, limit=20 * self.increment_count, residual=self.tolerance, field_parts=PARTS
            )
            return self.kind.deck(title, specimen, displacement, increments, PRINT_EVERY)

        if self.window is None:
            return deck(self.displacement, 1.0 / self.increment_count)
        start, end, increment = self.window
        approach = deck(start, self.displacement / (self.increment_count * start))
        # a second step goes on from the displacement of the first
        passage = deck(end, increment / (end - start))
        return approach + passage[passage.index("*STEP") :]


def paper_cases(problem: str, *, coarse: bool = False) -> list[PaperCase]:
    """List the runs of a specimen: both layups, paper's and consistent elements, three stiffnesses, both meshes.

    With `coarse`, the perturbed mesh where the paper shows it: [0/0] at 1e8.
    """
    return [
        PaperCase(problem, layup, element, stiffness, perturbed, coarse)
        for layup, element, perturbed, stiffness in itertools.product(LAYUPS, ELEMENTS, (False, True), SHOWN)
        if not (coarse and perturbed) or (layup, stiffness) == ("0/0", "1e8")
    ]


def comparator_cases(problem: str, *, coarse: bool = False) -> list[PaperCase]:
    """List the runs with the built-in element and with its criterion; the built-in one also at the softest stiffness.

    With `coarse`, its criterion in the consistent element alone, and where the layup mixes the modes.
    """
    few = (("0/0", "COH2D4"), ("0/90", "COH2D4"), ("0/90", "consistent_bk"))
    pairs = few if coarse else itertools.product(LAYUPS, COMPARATORS)
    cases = [PaperCase(problem, layup, element, "1e6", coarse=coarse) for layup, element in pairs]
    return [*cases, PaperCase(problem, "0/0", "COH2D4", "1e4", coarse=coarse)]


def longer_cases(*, coarse: bool = False) -> list[PaperCase]:
    """Return the fixed-ratio specimens with longer cracks, whose mode ratio comes near to that of plain beams.

    With `coarse`, the shorter one alone.
    """
    cases = [PaperCase(problem, "0/0", "consistent", "1e6", coarse=coarse) for problem in LONGER]
    return cases[:1] if coarse else cases


def secant_cases(*, coarse: bool = False) -> list[PaperCase]:
    """List the runs by the paper's way, section 3.2: secant, small increments; default and hundredfold residual.

    The latter also with as many increments as the other runs.
    """
    bases = [
        PaperCase("dcb", "0/0", "paper", stiffness, coarse=coarse, secant=True, increments=SECANT_INCREMENTS)
        for stiffness in ("1e6", "1e8")
    ]
    relaxed = [replace(base, tolerance=SECANT_TOLERANCE) for base in bases]
    return [*bases, *relaxed, *(replace(case, increments=None) for case in relaxed)]
