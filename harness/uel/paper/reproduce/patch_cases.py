# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's patch tests, section 4.1."""

from __future__ import annotations

from dataclasses import dataclass, replace

from uel.delamination import specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface
from uel.delamination.mesh import TwoArmMesh
from uel.delamination.steps import Increments
from uel.paper.patches import BETAS, COLLINEAR, PLIES, inclined_mesh, inclined_specimen
from uel.paper.reproduce.cases import START, called

# Sliding is soft and never gets near its strength. With the consistent law beta has to exceed the softening slope,
# in units of each direction, which a contrast of 1e7 in stiffness makes enormous: a tougher law has a flatter slope.
LAW = replace(specimens.PATCH_LAW, toughness_2=1.0e6)
MOVED = -0.03
"""Distance of the moved nodes from the straight line over the length of an element, to both sides in turns."""
PRINTED = 7
"""Decimals of coordinates in single precision, as mesh generators write them: off the line by up to 5e-8 mm."""
DISPLACEMENT = -0.1
# one increment if it converges; where slip over bumps opens and closes points, smaller ones
INCREMENTS = Increments(initial=1.0, smallest=1e-6, largest=1.0, limit=500)
METHODS = {"standard": ("U2", False), "paper": ("U4", False), "consistent": ("U4", True)}


@dataclass(frozen=True, slots=True)
class PatchCase:
    """Case of a patch test.

    shape    'horizontal' or 'inclined'
    layup    '0/0' or '0/90'
    element  'standard', 'paper', 'consistent'
    moved    the interface nodes are moved by 3 % of an element
    decimals  of the coordinates of an inclined interface's nodes
    normal, shear  stiffnesses of the interface (N/mm^3)
    beta     stabilisation (N/mm^3): None takes the paper's, in the consistent element that of the local eigenvalues,
             BY_EQUATION_21 that of equation (21)
    slide    the bottom edge may contract sideways, so that the stress is uniform
    """

    shape: str
    layup: str
    element: str
    moved: bool
    decimals: int = COLLINEAR
    normal: float = LAW.stiffness_normal
    shear: float = LAW.stiffness_shear
    beta: float | None = None
    slide: bool = False

    @property
    def name(self) -> str:
        """Name of the deck."""
        words = [self.shape, self.layup.replace("/", "_"), self.element, self._nodes]
        if (self.normal, self.shear) != (LAW.stiffness_normal, LAW.stiffness_shear):
            words.append(f"{self.normal:.0e}_{self.shear:.0e}".replace("+", ""))
        if self.beta is not None:
            words.append(f"beta{self.beta:.0e}".replace("+", "") if self.beta > 0 else "beta21")
        return "_".join(words + ["free"] * self.slide)

    @property
    def _nodes(self) -> str:
        straight = "straight" if self.decimals == COLLINEAR else f"decimals{self.decimals}"
        return "moved" if self.moved else straight

    @property
    def fallback(self) -> bool:
        """True to search downhill where Newton's method fails."""
        return True

    @property
    def work(self) -> float:
        """Cost of the run, little more than its start, as for a `PaperCase`."""
        return START

    def mesh(self) -> TwoArmMesh:
        """Build the mesh."""
        if self.shape == "inclined":
            return inclined_mesh(MOVED * self.moved, self.decimals)
        return specimens.patch_mesh(specimens.PATCH_BUMP * self.moved)

    def files(self) -> dict[str, str]:
        """Return the deck `NAME.inp` and the files that it includes."""
        mesh, mesh_name = self.mesh(), self._nodes
        kind, consistent = METHODS[self.element]
        paper = BETAS[self.layup] if self.shape == "inclined" else specimens.PATCH_BETA
        # the complete form needs more than the paper's element: its own local eigenvalues
        own = kind == "U2" or consistent
        beta = self.beta if self.beta is not None else 0.0 if own else paper
        law = replace(LAW, stiffness_normal=self.normal, stiffness_shear=self.shear)
        if self.shear == self.normal:
            # both directions are stiff: out of reach of the strengths
            law = replace(law, strength_normal=1.0e6, strength_shear=1.0e6, toughness_1=1.0e9, toughness_2=1.0e9)
        interface = Interface(kind, law, beta=beta, consistent=consistent)
        specimen = inclined_specimen(mesh_name, mesh, self.layup, interface)
        title = f"Patch test, {self.shape} interface, [{self.layup}], {called(self.element)}" + ", moved" * self.moved
        deck = specimens.patch_deck(title, specimen, DISPLACEMENT, INCREMENTS, slide=self.slide)
        nodes = 8 if kind == "U4" else 4
        return specimens.mesh_files(mesh_name, mesh, (nodes,)) | {f"{self.name}.inp": deck}


STIFF = tuple(10.0**exponent for exponent in range(6, 19))
"""Equal stiffnesses in both directions at which the flat patch is run (N/mm^3)."""


def uniform_cases() -> list[PatchCase]:
    """List the cases of the flat patch under uniform stress, paper's element, from soft to nearly rigid."""
    return [
        PatchCase("horizontal", "0/0", "paper", False, normal=a, shear=a, slide=True) for a in (1e4, 1e6, 1e8, 1e10)
    ]


NODES = ((False, COLLINEAR), (False, PRINTED), (True, COLLINEAR))
"""Variants of the nodes of the inclined interface: `moved` and `decimals`."""


def inclined_cases() -> list[PatchCase]:
    """List the cases of figure 6: beta of the paper on straight, rounded and moved nodes, and beta by (21)."""
    cases = [
        PatchCase("inclined", layup, element, moved, decimals)
        for layup in PLIES
        for element in METHODS
        for moved, decimals in NODES
    ]
    return cases + [PatchCase("inclined", layup, "paper", True, beta=BY_EQUATION_21) for layup in PLIES]


def patch_cases() -> list[PatchCase]:
    """List all patch tests of the paper."""
    horizontal = [PatchCase("horizontal", "0/0", element, moved) for element in METHODS for moved in (False, True)]
    horizontal += [PatchCase("horizontal", "0/0", "paper", True, beta=beta) for beta in (BY_EQUATION_21, 3.0e8, 3.0e12)]
    horizontal.append(PatchCase("horizontal", "0/0", "standard", True, shear=LAW.stiffness_normal))
    flat = [PatchCase("horizontal", "0/0", element, False, normal=a, shear=a) for element in METHODS for a in STIFF]
    return [*horizontal, *inclined_cases(), *flat, *uniform_cases()]
