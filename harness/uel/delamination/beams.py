# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Load over displacement of the specimens by beam theory and linear elastic fracture mechanics, for [0/0]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from uel.delamination import theory
from uel.delamination.flexure import FRMM_LENGTH, SPAN
from uel.delamination.materials import TABLE_2
from uel.delamination.specimens import ARMS, CRACK
from uel.delamination.theory import Arms
from uel.model.arrays import FloatArray

LONGEST = {"dcb": 60.0, "enf": 0.5 * SPAN, "frmm": FRMM_LENGTH}
"""Crack lengths up to which the formulas hold: the load at mid-span, the clamp (mm)."""
BRANCH = {"dcb": (36.0, 60.0), "enf": (38.0, 48.5), "frmm": (36.0, 44.0)}
"""Lengths of a sharp crack between which the growth branch is compared (mm): before, the process zone forms, which
rounds the peak, and is longest in mode II; after, it meets the load at mid-span or the clamp."""
# the arms as beams on a rigid ligament: chi goes to zero with 1/sqrt(G12) as the shear stiffness grows
RIGID_ROOT = replace(ARMS, g12=1.0e12)


@dataclass(frozen=True, slots=True)
class BeamCurve:
    """Load (N) over displacement (mm) as a crack (mm) grows from its initial length; the first point is the onset."""

    crack: FloatArray
    displacement: FloatArray
    load: FloatArray

    def between(self, first: float, last: float) -> BeamCurve:
        """Return the part of it between two lengths of the crack."""
        inside = (self.crack >= first) & (self.crack <= last)
        return BeamCurve(self.crack[inside], self.displacement[inside], self.load[inside])

    def with_origin(self) -> tuple[FloatArray, FloatArray]:
        """Return the displacements and loads with the linear branch from the origin."""
        return np.concatenate([[0.0], self.displacement]), np.concatenate([[0.0], self.load])

    def deviation(self, displacement: FloatArray, load: FloatArray) -> FloatArray:
        """Return the relative distance of a load from the growth branch, at the displacements (n,) within it."""
        inside = (displacement >= self.displacement[0]) & (displacement <= self.displacement[-1])
        return np.asarray(load[inside] / np.interp(displacement[inside], self.displacement, self.load) - 1.0)


def growth(problem: str, arms: Arms = ARMS) -> BeamCurve:
    """Return the growth branch of 'dcb' (displacement of one arm), 'enf' or 'frmm' of table 2; growth is stable."""
    load, compliance = _formulas(problem, arms)
    cracks = np.linspace(CRACK, LONGEST[problem], 300)
    loads = np.array([load(crack) for crack in cracks])
    return BeamCurve(cracks, loads * np.array([compliance(crack) for crack in cracks]), loads)


def branch_deviation(problem: str, displacement: FloatArray, load: FloatArray) -> FloatArray:
    """Return relative distances of a load (N) from corrected beam theory at the displacements (mm) within BRANCH."""
    return growth(problem).between(*BRANCH[problem]).deviation(displacement, load)


def _formulas(problem: str, arms: Arms) -> tuple[Callable[[float], float], Callable[[float], float]]:
    """Load (N) and compliance (mm/N) as functions of the crack's length (mm)."""
    tough_1, tough_2 = TABLE_2.toughness_1, TABLE_2.toughness_2
    if problem == "dcb":
        return (lambda a: theory.dcb_load(arms, a, tough_1)), (lambda a: theory.dcb_compliance(arms, a))
    if problem == "enf":
        return (lambda a: theory.enf_load(arms, a, tough_2)), (lambda a: theory.enf_compliance(arms, a, 0.5 * SPAN))
    return (
        lambda a: theory.frmm_load(arms, a, tough_1, tough_2),
        lambda a: theory.frmm_compliance(arms, a, FRMM_LENGTH),
    )
