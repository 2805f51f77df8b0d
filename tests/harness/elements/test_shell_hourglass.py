# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hourglass control and drilling of S4R, against what a public job of Abaqus computed.

jrHoss/Abaqus-Scrypting, Job-1.odb (Abaqus 6.14): a frame of 600 S4R, all of them plane rectangles.
"""

import numpy as np
import pytest

from uel.errors import Source
from uel.model.mesh import ElementGroup
from uel.model.properties import Elastic, ElasticType, Material, SectionControls, ShellLayer, ShellSection

SOURCE = Source("test.inp", 7)
E, NU = 210000.0, 0.3
G = E / (2 * (1 + NU))
STEEL = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE), density=5.0)


def section(thickness, **options):
    return ShellSection("ALL", (ShellLayer(thickness, 5, STEEL),), None, 0.0, False, SOURCE, **options)


def group(of_section, nodes):
    return ElementGroup("S4R", 1 + np.arange(len(nodes)), np.array(nodes), "", of_section, None, SOURCE)


PLACES = [[0.0, 0, 0], [21, 0, 0], [0, 0, 440], [0, 0, 220], [21, 0, 220], [21, 0, 440]]
MOVED = [
    [-40.6305923, -312.295776, 15.6257868, -0.094283551, 0.0128589356, 0.00972612016],
    [-40.6484222, -312.092377, 15.3325968, -0.0936981663, 0.0134843467, 0.0088432245],
    [-34.9847755, -270.828003, 15.6046562, -0.0939003453, 0.0128010837, 0.00956395362],
    [-37.8046608, -291.549408, 15.6042862, -0.0943967029, 0.012831971, 0.00953487493],
    [-37.7868271, -291.34848, 15.3547144, -0.0948076025, 0.0123589635, 0.010405167],
    [-35.001667, -270.627991, 15.3179579, -0.0936339349, 0.0132220974, 0.00867512729],
]
"""Nodes 10, 20, 120, 121, 195, 196 at the free edge of a flange 5.9 thick: displacements and rotations of the .odb."""


def test_forces_at_the_free_edge_of_a_flange_of_abaqus_balance(response):
    """At node 195, which has no load and two elements, 359 and 360.

    In the plane membrane strains alone leave 114 and 272 there, which the hourglass control takes, and the drilling
    moments of the two elements, 558, cancel. The .odb has single precision: displacements to 2e-6 (x), 5e-7 (z), on
    stiffnesses of up to 2e6 and 1e6.
    """
    evaluate = response(group(section(5.9), [[5, 2, 3, 4], [4, 3, 0, 1]]), np.array(PLACES))
    force = evaluate(np.array(MOVED).ravel())[0].reshape(6, 6)[4]
    assert abs(force[[0, 2, 4]]).max() < 1.5


@pytest.mark.parametrize("thickness", [0.2, 1.0, 5.0])
def test_stiffness_of_the_patterns_of_a_rectangle(response, thickness):
    """Fitted to the forces of that frame: membrane 0.005 G t, rotations 0.18 G t^3/12, transverse shear 2/3 K, each
    with A sum(B^2)/16 per squared pattern, and drilling G t/6 / (1 + A/(10 t^2)).

    The fits, over sides of 220 and 21 to 140 with thicknesses of 2.3 to 15: 0.00499 to 0.00501; 0.17 to 0.185;
    0.65 to 0.668 of K without its slenderness factor; drilling to 1e-3.
    """
    a, b = 4.0, 3.0
    x = np.array([[0.0, 0, 0], [a, 0, 0], [a, b, 0], [0, b, 0]])
    h, area = np.array([1.0, -1, 1, -1]), a * b
    spread = area * (1 / a**2 + 1 / b**2) / 16
    k = response(group(section(thickness), [[0, 1, 2, 3]]), x)(np.zeros(24))[1]

    def twice_the_energy(**entries):
        u = np.zeros((4, 6))
        for name, values in entries.items():
            u[:, "uvwpqr".index(name)] = values
        return u.ravel() @ k @ u.ravel()

    shear = 5 / 6 * G * thickness / (1 + 0.25e-4 * area / thickness**2)
    # the nodes turn with the surface: no drilling
    along, across = x[:, 0] - a / 2, x[:, 1] - b / 2
    membrane = 0.005 * G * thickness * spread * 16
    assert twice_the_energy(u=h, r=-2 * along / (a * b)) == pytest.approx(membrane, rel=1e-9)
    assert twice_the_energy(v=h, r=2 * across / (a * b)) == pytest.approx(membrane, rel=1e-9)
    for name in "pq":
        rotations = twice_the_energy(**{name: h})
        assert rotations == pytest.approx(0.18 * G * thickness**3 / 12 * spread * 16, rel=1e-9)
    assert twice_the_energy(w=h) == pytest.approx(2 / 3 * shear * spread * 16, rel=1e-9)
    drilling = G * thickness / 6 / (1 + area / (10 * thickness**2))
    assert twice_the_energy(r=np.ones(4)) == pytest.approx(drilling * area, rel=1e-9)
    assert twice_the_energy(r=h) == pytest.approx(drilling * area, rel=1e-9)


def test_an_offset_counts_in_the_rotations(response):
    """About the surface of the nodes, as the fit for plates with OFFSET=SNEG has it: 0.72 G t^3/12, four times 0.18."""
    x = np.array([[0.0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]])
    u = np.zeros((4, 6))
    u[:, 3] = [1, -1, 1, -1]
    plain, offset = (
        ShellSection("ALL", (ShellLayer(1.0, 5, STEEL),), None, place, False, SOURCE) for place in (0.0, -0.5)
    )
    found = [
        u.ravel() @ response(group(way, [[0, 1, 2, 3]]), x)(np.zeros(24))[1] @ u.ravel() for way in (plain, offset)
    ]
    assert found[1] == pytest.approx(4 * found[0], rel=1e-9)


def test_enhanced_control_bends_in_its_plane_as_a_beam(response):
    """HOURGLASS=ENHANCED: u = x y, v = -x^2/2 - nu y^2/2 stores E/2 t times the integral of y^2, not the default."""
    x = np.array([[-2.0, -0.5, 0], [2, -0.5, 0], [2, 0.5, 0], [-2, 0.5, 0]])
    u = np.zeros((4, 6))
    u[:, 0], u[:, 1], u[:, 5] = x[:, 0] * x[:, 1], -(x[:, 0] ** 2 + NU * x[:, 1] ** 2) / 2, -x[:, 0]
    exact = E * 0.2 * 4 / 12
    found = []
    for controls in (SectionControls(enhanced=True), SectionControls()):
        k = response(group(section(0.2, controls=controls, drilling=0.0), [[0, 1, 2, 3]]), x)(np.zeros(24))[1]
        found.append(u.ravel() @ k @ u.ravel() / exact)
    assert found[0] == pytest.approx(1.0, rel=1e-9)
    assert found[1] < 0.1
