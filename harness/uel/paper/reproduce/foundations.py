# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that decide on what the paper says about its law and the two weak forms (sections 2 and 3.2).

They need no runs: the law is driven point by point, and the matrices are those of the horizontal patch, 10 x 10 quads,
at rest. See findings.py.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import closing
from functools import cache
from pathlib import Path

import numpy as np

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.delamination import law
from uel.delamination.materials import TABLE_2
from uel.elements import Call, Flags
from uel.model.arrays import FloatArray
from uel.paper.patches import PLIES, plane_stress, stabilisation
from uel.paper.reproduce.basics import swing
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.patch_cases import PatchCase, uniform_cases
from uel.usersub import Library

INCREMENTS = 4000
RIGID = 1.0e12
"""Stiffness at which the interface is practically bonded (N/mm^3)."""
QUAD = 0.1
"""Edge of the patch's quads (mm)."""


def law_area(_: Evidence, angle: float) -> float:
    """Return the area under the law's curve over the toughness (11) on a straight path, 0 opening, 90 sliding."""
    return float(_straight(angle)["WORK"][-1]) / _toughness(angle)


def law_strength(_: Evidence, angle: float) -> float:
    """Return the left side of the quadratic criterion (10) at the largest traction: 1."""
    curve = _straight(angle)
    normal, shear = curve["TN"] / TABLE_2.strength_normal, curve["TT"] / TABLE_2.strength_shear
    return float(np.sqrt(np.max(normal**2 + shear**2)))


def law_closing(_: Evidence) -> float:
    """Return the largest damage of an interface that is pressed together by as much as opens it to the end: 0."""
    return float(_drive(np.linspace([0.0, 0.0], [-2.0 * _end(0.0), 0.0], 50))["DAMAGE"].max())


def law_contact(_: Evidence) -> float:
    """Return the stiffness of a half damaged interface that is closed again, over its first stiffness: 1."""
    half = 0.5 * _end(0.0)
    curve = _drive(law.along(np.array([[half, 0.0], [-half, 0.0]]), 50))
    stiffness = _values()["ALPHAN"]
    return float(curve["TN"][-1] / (stiffness * curve["SEPN"][-1]))


def law_isotropy(_: Evidence) -> float:
    """Spread of the area under the curves at 0, 30, 60 and 90 degrees when both modes have the values of mode I."""
    alike = {"ALPHAT": "ALPHAN", "TAUMAX": "SIGMAMAX", "GIIC": "GIC"}
    same = _values() | {name: _values()[other] for name, other in alike.items()}
    areas = [_drive(law.opening(angle, _end(0.0), INCREMENTS), same)["WORK"][-1] for angle in (0.0, 30.0, 60.0, 90.0)]
    return float(np.ptp(areas) / np.mean(areas))


def law_slope(_: Evidence, angle: float) -> float:
    """Return the diagonal term of the tangent (23) in mid-softening, over the stiffness of the secant (24) there."""
    curve = _straight(angle)
    name = "N" if angle == 0.0 else "T"
    separation, traction = curve[f"SEP{name}"], curve[f"T{name}"]
    middle = int(np.searchsorted(separation, 0.5 * separation[-1]))
    tangent = (traction[middle + 1] - traction[middle]) / (separation[middle + 1] - separation[middle])
    return float(tangent / (traction[middle] / separation[middle]))


def _straight(angle: float) -> dict[str, FloatArray]:
    return _drive(law.opening(angle, _end(angle), INCREMENTS))


@cache
def _values() -> dict[str, float]:
    return law.standard_properties()


def _end(angle: float) -> float:
    with closing(_own_elements()) as library:
        return law.reach_of(library, _values(), angle)


def _drive(path: FloatArray, values: law.Properties | None = None) -> dict[str, FloatArray]:
    with closing(_own_elements()) as library:
        return law.drive(law.LawElement(library, law.STANDARD, values or _values()), "", path, 1.0).columns


def _own_elements() -> Library:
    return usersub.load(None, job="foundations", output_dir=Path(tempfile.gettempdir()))


def _toughness(angle: float) -> float:
    """Return G_I + G_II at failure by (11), for stiffnesses that are equal: the direction fixes G_I/G_II."""
    share = np.sin(np.radians(angle)) ** 2
    return float(1.0 / ((1.0 - share) / TABLE_2.toughness_1 + share / TABLE_2.toughness_2))


def asymmetry(_: Evidence, element: str) -> float:
    """Return the largest entry of the skew part of the stiffness over the largest entry; the interface is rigid."""
    matrix = _stiffness(_patch(element, RIGID))
    return float(np.abs(matrix - matrix.T).max() / (2.0 * np.abs(matrix).max()))


def coercivity(_: Evidence, factor: float) -> float:
    """Return the smallest eigenvalue of the symmetric part of the paper's stiffness over the standard one's.

    Positive definite where it is above 0. The interface is rigid; beta is that of (21) times a factor.
    """
    beta = factor * stabilisation(*PLIES["0/0"], (QUAD**2, QUAD**2), QUAD)
    lowest = []
    for case in (_patch("paper", RIGID, beta), _patch("standard", RIGID)):
        matrix = _stiffness(case)
        lowest.append(float(np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[0]))
    return lowest[0] / lowest[1]


def condition_growth(_: Evidence, element: str) -> float:
    """Return the condition number of the stiffness at 1e12 N/mm^3 over that at 1e6."""
    stiff, soft = (float(np.linalg.cond(_stiffness(_patch(element, value, 0.0)))) for value in (RIGID, 1.0e6))
    return stiff / soft


def consistency(evidence: Evidence) -> float:
    """Return the standard deviation of t_n over its mean under uniform exact stress, the largest of the stiffnesses."""
    return max(swing(evidence.runs.patch(case).traction) for case in uniform_cases())


def weight_of_least_beta(_: Evidence) -> float:
    """Return the weight at which (21) is least, less that of (22); [0/90], equal quads."""
    weights = np.linspace(0.001, 0.999, 999)
    first, second = _norms()
    least = weights[np.argmin(first * weights**2 + second * (1.0 - weights) ** 2)]
    return float(abs(least - second / (first + second)))


def equal_weights(_: Evidence) -> float:
    """Return beta that (21) asks for with equal weights over that with the weights (22); [0/90], equal quads."""
    first, second = _norms()
    return 0.25 * (first + second) * (1.0 / first + 1.0 / second)


def _norms() -> list[float]:
    return [float(np.linalg.norm(plane_stress(ply), 2)) for ply in PLIES["0/90"]]


def _patch(element: str, stiffness: float, beta: float | None = None) -> PatchCase:
    return PatchCase("horizontal", "0/0", element, False, normal=stiffness, shear=stiffness, beta=beta)


@cache
def _stiffness(case: PatchCase) -> FloatArray:
    """Return the matrix (n, n) of the free displacements, at rest."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in case.files().items():
            Path(folder, name).write_text(content, encoding="ascii")
        model = read_deck(Path(folder, f"{case.name}.inp"))
    with closing(_own_elements()) as library:
        system = system_of(model, library, strict=False)
        rest = np.zeros(len(system))
        data = system.evaluate(Call(Flags(1), 1, 1, 0.0, 0.0, 0.0, 1.0), rest, rest).data
        assert data is not None
        matrix = system.matrix(data).toarray()
    held = [system.dofs.find(entry.nodes, entry.dof) for entry in (*model.boundaries, *model.steps[0].boundaries)]
    free = np.setdiff1d(np.arange(len(system)), np.concatenate(held))
    return np.asarray(matrix[np.ix_(free, free)])


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(law_area, law_strength, law_closing, law_contact, law_isotropy, law_slope, asymmetry, coercivity),
        *(condition_growth, consistency, weight_of_least_beta, equal_weights),
    )
}
