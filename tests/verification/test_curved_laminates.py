# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A quarter of a ring of orthotropic plies, bent and sheared, with a bonded interface in its middle.

The normal passes through x, where a direction s that is the projection of x would turn round. Bent by moments at its
ends in plane strain, with the displacements

    u_theta = C r theta,    u_r = A r^k + B r^-k + C (c_tt - c_rt)/(c_rr - c_tt) r,    k^2 = c_tt/c_rr,

of S. G. Lekhnitskii, Anisotropic Plates, 1968, chapter 3 (pure bending of a curved bar with cylindrical anisotropy), by
his stress functions; c is the stiffness in the plane, and A and B leave no stress on the inner and the outer surface.
Sheared along the axis, u_z grows with ln r, and tau_rz = G_rz du_z/dr is the same all around. The ring is one layer of
solids, whose nodes in front move as those behind them.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import quad
from solid_grids import grid, inserted

from uel.deck.reader import read_deck
from uel.running.job import run

INNER, OUTER = 4.0, 6.0
MIDDLE = 0.5 * (INNER + OUTER)
BENT, SHEARED = 1e-3, 2e-3
"""C, and displacement of the outer surface along the axis, of the inner one."""
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
PLIES = {
    "around": (9.0e3, 138.0e3, 10.5e3, 0.3 * 9.0 / 138.0, 0.4, 0.3, 6.3e3, 3.2e3, 5.9e3),
    "axial": (9.0e3, 10.5e3, 138.0e3, 0.4, 0.3 * 9.0 / 138.0, 0.3 * 10.5 / 138.0, 3.2e3, 6.3e3, 5.9e3),
}
"""E_r, E_theta, E_z, nu_rt, nu_rz, nu_tz, G_rt, G_rz, G_tz by the direction of the fibres."""


@dataclass(frozen=True)
class Ring:
    """The solution in a ring of one ply.

    stiffness  (3, 3) of the strains r, theta and z
    powers     exponents of r in u_r and their factors
    """

    stiffness: np.ndarray
    powers: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, ply):
        """Find A and B of a ply."""
        e_r, e_t, e_z, nu_rt, nu_rz, nu_tz = ply[:6]
        compliance = np.diag([1 / e_r, 1 / e_t, 1 / e_z])
        for i, j, value in ((0, 1, nu_rt / e_r), (0, 2, nu_rz / e_r), (1, 2, nu_tz / e_t)):
            compliance[i, j] = compliance[j, i] = -value
        c = np.linalg.inv(compliance)
        k = np.sqrt(c[1, 1] / c[0, 0])
        straight = BENT * (c[1, 1] - c[0, 1]) / (c[0, 0] - c[1, 1])
        free = [[(c[0, 0] * p + c[0, 1]) * r ** (p - 1) for p in (k, -k)] for r in (INNER, OUTER)]
        given = (c[0, 0] + c[0, 1]) * straight + c[0, 1] * BENT
        a, b = np.linalg.solve(free, [-given, -given])
        return cls(c, ((k, a), (-k, b), (1.0, straight)))

    def displacement(self, r):
        """Displacement along r."""
        return sum(factor * r**p for p, factor in self.powers)

    def strains(self, r):
        """Strains r and theta."""
        return (
            sum(p * factor * r ** (p - 1) for p, factor in self.powers),
            sum(factor * r ** (p - 1) for p, factor in self.powers) + BENT,
        )

    def stress(self, r):
        """Stresses r, theta and z."""
        first, second = self.strains(r)
        return self.stiffness[:, 0] * first + self.stiffness[:, 1] * second


@pytest.mark.parametrize("ply", PLIES.values(), ids=PLIES)
def test_the_solution_is_that_of_lekhnitskii(ply):
    """His radial stress by the moment per width, as ASTM D6415 has it, with kappa of plane strain."""
    ring = Ring.of(ply)
    moment = quad(lambda r: ring.stress(r)[1] * r, INNER, OUTER)[0]
    assert abs(quad(lambda r: ring.stress(r)[1], INNER, OUTER)[0]) < 1e-10 * abs(moment)
    k, rho = np.sqrt(ring.stiffness[1, 1] / ring.stiffness[0, 0]), INNER / OUTER
    more, less = 1 - rho ** (k + 1), 1 - rho ** (k - 1)
    whole = 1 - rho ** (2 * k)
    g = (1 - rho**2) / 2 - k / (k + 1) * more**2 / whole + k * rho**2 / (k - 1) * less**2 / whole
    for r in np.linspace(INNER, OUTER, 7):
        share = 1 - more / whole * (r / OUTER) ** (k - 1) - less / whole * rho ** (k + 1) * (OUTER / r) ** (k + 1)
        assert ring.stress(r)[0] == pytest.approx(moment / (OUTER**2 * g) * share, abs=1e-9 * abs(moment))


def deck(folder, kind, ply, fine):
    """The deck of the ring: elements through its thickness, times six around it."""
    mesh = grid(kind, (fine, 6 * fine, 1), (1.0, 1.0, 1.0))
    radius = INNER + (OUTER - INNER) * mesh.nodes[:, 0]
    angle = np.pi / 2 * (mesh.nodes[:, 1] - 0.5)
    height = (OUTER - INNER) / fine * mesh.nodes[:, 2]
    front = np.isclose(mesh.nodes[:, 2], 1.0)
    ends = [np.isclose(mesh.nodes[:, 1], y) for y in (0.0, 1.0)]
    surfaces = [np.isclose(mesh.nodes[:, 0], x) for x in (0.0, 1.0)]
    opposite = {tuple(place): k for k, place in enumerate(mesh.nodes.round(9).tolist(), 1)}
    ties = []
    for k in np.flatnonzero(front).tolist():
        other = opposite[(*mesh.nodes[k, :2].round(9).tolist(), 0.0)]
        ties += [line for d in (1, 2, 3) for line in ("2", f"{k + 1}, {d}, 1., {other}, {d}, -1.")]
    bent = []
    for k in np.flatnonzero((ends[0] | ends[1]) & ~front).tolist():
        c, s = np.cos(angle[k]), np.sin(angle[k])
        outward, around = Ring.of(ply).displacement(radius[k]), BENT * radius[k] * angle[k]
        moved = (outward * c - around * s, outward * s + around * c)
        bent += [f"{k + 1}, {d}, {d}, {float(value)!r}" for d, value in enumerate(moved, 1)]
    sheared = [f"{k + 1}, 3, 3, {SHEARED}" for k in np.flatnonzero(surfaces[1] & ~front).tolist()]
    sheared += [f"{k + 1}, 3" for k in np.flatnonzero(surfaces[0] & ~front).tolist()]
    mesh.nodes = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
    mesh.sets = {"INSIDE": mesh.cell[:, 0] < fine // 2, "OUTSIDE": mesh.cell[:, 0] >= fine // 2}
    words = list(map(repr, map(float, ply)))
    lines = [
        *mesh.lines(),
        *["*ORIENTATION, NAME=AROUND, SYSTEM=CYLINDRICAL", "0., 0., 0., 0., 0., 1."],
        "*SOLID SECTION, ELSET=BODY, MATERIAL=PLY, ORIENTATION=AROUND",
        *["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=ENGINEERING CONSTANTS", ", ".join(words[:8]), words[8]],
        *["*EQUATION", *ties, "*STEP, UNSYMM=YES", "*STATIC", "1., 1.", "*BOUNDARY", *bent, *sheared],
        *["*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"],
    ]
    path = folder / f"ring{fine}.inp"
    path.write_text("\n".join(lines) + "\n")
    return path


def cut_and_run(folder, kind, ply, fine):
    """Interface profile of the ring, and displacements of the nodes that it has uncut, of both."""
    path = deck(folder, kind, ply, fine)
    done = inserted(path, folder / f"cut{fine}.inp", STRONG, between=[("INSIDE", "OUTSIDE")])
    assert done.warnings == ()
    model = read_deck(folder / f"cut{fine}.inp")
    assert len([group for group in model.groups if group.definition is not None]) == 1
    bonded = run(path, output_dir=folder, quiet=True).field("U")
    result = run(folder / f"cut{fine}.inp", output_dir=folder, quiet=True)
    return result.interface(), bonded, result.field("U")[: len(bonded)]


@pytest.mark.parametrize("ply", PLIES)
@pytest.mark.parametrize("kind", ["C3D8I", "C3D20"])
def test_tractions_converge_to_the_solution(tmp_path, kind, ply):
    """Within 3 % with one element on each side of the interface, within 1 % with two: errors are of second order.

    At points more than 15 degrees from the ends, where displacements are prescribed that the mesh does not have. The
    bonded ring without an interface is as stiff. Shears do not jump where the normal is x: along the axis they are the
    same all around, and around it there are none, to the errors of the normal traction.
    """
    ring = Ring.of(PLIES[ply])
    normal = ring.stress(MIDDLE)[0]
    shear = PLIES[ply][7] * SHEARED / (MIDDLE * np.log(OUTER / INNER))
    for fine, error in ((2, 0.03), (4, 0.01)):
        profile, bonded, found = cut_and_run(tmp_path, kind, PLIES[ply], fine)
        within = abs(np.arctan2(profile["Y"], profile["X"])) < np.radians(30.0)
        assert within.sum() >= len(within) / 2
        np.testing.assert_allclose(profile["TN"][within], normal, rtol=error)
        np.testing.assert_allclose(profile["TS"], shear, rtol=error)
        assert abs(profile["TT"]).max() < error * max(abs(normal), shear)
        assert abs(found - bonded).max() < error * abs(bonded).max()
