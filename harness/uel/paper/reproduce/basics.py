# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that decide on the paper's statements: patch tests and parameters. See findings.py."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from uel.delamination.blocks import BY_EQUATION_21
from uel.delamination.materials import PLY_0, PLY_90
from uel.model.arrays import FloatArray
from uel.paper.patches import BETAS, COLLINEAR, PLIES, inclined_mesh, stabilisation
from uel.paper.reproduce.findings import Evidence
from uel.paper.reproduce.patch_cases import STIFF, PatchCase

FLAT = PatchCase("horizontal", "0/0", "standard", moved=False)
SWING = 0.01
"""Standard deviation over mean from which a traction that should be constant is said to oscillate."""


def swing(traction: FloatArray) -> float:
    """Return the standard deviation over the mean's size."""
    return float(np.std(traction) / abs(np.mean(traction)))


def patch_swing(
    evidence: Evidence, shape: str, layups: Sequence[str], element: str, *, moved: bool, decimals: int = COLLINEAR
) -> float:
    """Return the standard deviation of the normal traction over its mean; the largest of the layups."""
    cases = (PatchCase(shape, layup, element, moved, decimals) for layup in layups)
    return max(swing(evidence.runs.patch(case).traction) for case in cases)


def patch_gain(
    evidence: Evidence, shape: str, layups: Sequence[str], *, moved: bool = True, decimals: int = COLLINEAR
) -> float:
    """Return the traction's standard deviation, paper's element over the standard one; the largest of the layups."""
    found = []
    for layup in layups:
        spread = [
            float(np.std(evidence.runs.patch(PatchCase(shape, layup, element, moved, decimals)).traction))
            for element in ("paper", "standard")
        ]
        found.append(spread[0] / spread[1])
    return max(found)


def patch_beta_gain(evidence: Evidence) -> float:
    """Return the standard deviation of the paper's traction on moved nodes, beta by (21) over the paper's beta."""
    case = PatchCase("horizontal", "0/0", "paper", moved=True)
    spread = [float(np.std(evidence.runs.patch(replace(case, beta=beta)).traction)) for beta in (BY_EQUATION_21, None)]
    return spread[0] / spread[1]


def patch_slip(evidence: Evidence) -> float:
    """Return the slip along the inclined interface over the length of its elements."""
    profile = evidence.runs.patch(PatchCase("inclined", "0/0", "paper", moved=True)).profile
    mesh = inclined_mesh()
    length = float(np.hypot(1.0, mesh.slope) * (mesh.x[1] - mesh.x[0]))
    return float(np.abs(profile["SEPT"]).mean()) / length


def flat_swing(evidence: Evidence, element: str, stiffness: float) -> float:
    """Return the standard deviation over mean on the straight interface, stiffness in both directions (N/mm^3)."""
    return swing(evidence.runs.patch(_stiff(element, stiffness)).traction)


def flat_onset(evidence: Evidence, element: str) -> float:
    """Return the exponent of the first stiffness at which the straight interface's traction oscillates; or infinity."""
    for stiffness in STIFF:
        if flat_swing(evidence, element, stiffness) > SWING:
            return float(np.log10(stiffness))
    return float("inf")


def flat_onset_single(evidence: Evidence) -> float:
    """Find the `flat_onset` of the standard element, with displacements rounded to single precision."""
    for stiffness in STIFF:
        places, moved = evidence.runs.patch(_stiff("standard", stiffness)).displacements()
        rounded = moved.astype(np.float32).astype(float)
        on_line = np.flatnonzero(np.isclose(places[:, 1], 0.5))
        # the lower line's nodes come first
        low, high = on_line[: len(on_line) // 2], on_line[len(on_line) // 2 :]
        if swing(stiffness * (rounded[high, 1] - rounded[low, 1])) > SWING:
            return float(np.log10(stiffness))
    return float("inf")


def _stiff(element: str, stiffness: float) -> PatchCase:
    return replace(FLAT, element=element, normal=stiffness, shear=stiffness)


def identity_with_standard(evidence: Evidence) -> float:
    """Return the largest difference of both elements' tractions on moved nodes, beta = 3e12, over the mean traction."""
    standard = evidence.runs.patch(PatchCase("horizontal", "0/0", "standard", moved=True)).traction
    stiff = evidence.runs.patch(PatchCase("horizontal", "0/0", "paper", moved=True, beta=3.0e12)).traction
    return float(np.abs(stiff - standard).max() / abs(standard.mean()))


def horizontal_beta(_: Evidence) -> float:
    """Evaluate equation (21) for the 10 x 10 patch (N/mm^3)."""
    return stabilisation(PLY_0, PLY_0, (0.01, 0.01), 0.1)


def inclined_beta(_: Evidence, layup: str) -> float:
    """Evaluate equation (21) for the inclined patch at the middle of the interface over the paper's value."""
    mesh = inclined_mesh()
    step = float(mesh.x[1] - mesh.x[0])
    heights = float(mesh.lower[-1] - mesh.lower[-2]), float(mesh.upper[1] - mesh.upper[0])
    top, bottom = PLIES[layup]
    length = float(np.hypot(1.0, mesh.slope)) * step
    return stabilisation(bottom, top, (heights[0] * step, heights[1] * step), length) / BETAS[layup]


def turon_stiffness(_: Evidence, thickness: float) -> float:
    """Evaluate equation (25) with M = 100 and E22 (N/mm^3)."""
    return 100.0 * PLY_0.e2 / thickness


def modulus_contrast(_: Evidence) -> float:
    """Return E11/E22."""
    return PLY_0.e1 / PLY_0.e2


def isotropy(_: Evidence) -> float:
    """Return the shear modulus of the 90-degree ply over E/(2(1 + nu)), 1 where X1-X2 is a plane of isotropy."""
    return PLY_90.g12 / (PLY_90.e1 / (2.0 * (1.0 + PLY_90.nu12)))


MEASURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(patch_swing, patch_gain, patch_beta_gain, patch_slip, flat_swing, flat_onset, flat_onset_single),
        *(identity_with_standard, horizontal_beta, inclined_beta, turon_stiffness, modulus_contrast, isotropy),
    )
}
