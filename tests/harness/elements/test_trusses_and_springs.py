# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in trusses and springs, element by element, and a mass on a spring in a deck."""

from dataclasses import replace

import numpy as np
import pytest

from uel.elements import Flags, Request
from uel.errors import DeckError, KernelError, Source
from uel.model.mesh import ElementGroup
from uel.model.properties import Elastic, ElasticType, MassSection, Material, Plastic, SolidSection, SpringSection

SOURCE = Source("test.inp", 1)
E, AREA, DENSITY = 200.0, 3.0, 5.0
LINE = np.array([[0.0, 0, 0], [1, 2, 2]])
ALONG, LENGTH = np.array([1, 2, 2]) / 3, 3.0


@pytest.fixture
def element(bound, load):
    def element(element_type, section, nodes=LINE):
        group = ElementGroup(
            element_type, np.array([7]), np.arange(len(nodes))[None], "", section, None, Source("test.inp", 7)
        )
        return bound(group, nodes, load(None))

    return element


def truss(plastic=None, poisson=0.3):
    material = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (E, poisson), SOURCE), plastic, density=DENSITY)
    return SolidSection("ALL", material, None, AREA, SOURCE)


def pull(block, matrix, call, elongation, along=ALONG):
    """Force on the second node, and AMATRX, where it moves along a line."""
    n = len(along)
    u, residual = np.concatenate([np.zeros(n), elongation * along]), np.zeros(2 * n)
    matrix.data[:] = 0
    report = block.evaluate(call, u, u, residual, matrix.data)
    return -residual[n:], matrix.toarray(), report


@pytest.mark.parametrize("poisson", [0.3, 0.5])
def test_truss(element, call, poisson):
    block, matrix = element("T3D2", truss(poisson=poisson))
    force, k, report = pull(block, matrix, call, 0.03)
    np.testing.assert_allclose(force, E * AREA * 0.01 * ALONG, rtol=1e-12)
    one = E * AREA / LENGTH * np.outer(ALONG, ALONG)
    np.testing.assert_allclose(k, np.block([[one, -one], [-one, one]]), atol=1e-12)
    assert report.energy[1] == pytest.approx(0.5 * E * 0.01**2 * AREA * LENGTH)


def test_truss_with_large_displacements(element, call):
    """Stress E ln(l/L) on the area A L/l; tangent against differences."""
    block, matrix = element("T3D2", truss())
    call = replace(call, flags=Flags(1, nlgeom=True))
    u, residual = np.array([0, 0, 0, 0.9, -0.4, 1.3]), np.zeros(6)
    block.evaluate(call, u, u, residual, matrix.data)
    now = LINE[1] + u[3:]
    length = np.linalg.norm(now)
    expected = E * np.log(length / LENGTH) * AREA * LENGTH / length * now / length
    np.testing.assert_allclose(-residual[3:], expected, rtol=1e-12)
    tangent, step = matrix.toarray(), 1e-6
    for k, d in enumerate(step * np.eye(6)):
        ends = [np.zeros(6), np.zeros(6)]
        for sign, r in zip((-1, 1), ends, strict=True):
            block.evaluate(call, u + sign * d, u, r, None)
        np.testing.assert_allclose(tangent[:, k], (ends[0] - ends[1]) / (2 * step), atol=1e-6)


def test_truss_yields_and_unloads(element, call):
    """Yield stress 2 and hardening 20: at strain e the stress is 2 + (E H/(E + H)) (e - 2/E), then elastic again."""
    block, matrix = element("T3D2", truss(Plastic(np.array([[2.0, 0.0], [22.0, 1.0]]), SOURCE)))
    modulus = E * 20 / (E + 20)
    force, k, _ = pull(block, matrix, call, 0.05 * LENGTH)
    stress = 2 + modulus * (0.05 - 2 / E)
    np.testing.assert_allclose(force, stress * AREA * ALONG, rtol=1e-12)
    np.testing.assert_allclose(k[3:, 3:], modulus * AREA / LENGTH * np.outer(ALONG, ALONG), rtol=1e-12)
    block.commit()
    force, _, report = pull(block, matrix, call, 0.045 * LENGTH)
    np.testing.assert_allclose(force, (stress - 0.005 * E) * AREA * ALONG, rtol=1e-12)
    # work: to yield, beyond it, and back
    work = 0.5 * 2 * 2 / E + 0.5 * (2 + stress) * (0.05 - 2 / E) - 0.5 * (2 * stress - 0.005 * E) * 0.005
    assert report.energy[1] == pytest.approx(0.5 * (stress - 0.005 * E) ** 2 / E * AREA * LENGTH)
    # a single increment over the kink takes the trapezoid from zero
    first = 0.5 * stress * 0.05
    assert report.energy[1] + report.energy[3] == pytest.approx(
        (work - 0.5 * 2 * 2 / E - 0.5 * (2 + stress) * (0.05 - 2 / E) + first) * AREA * LENGTH
    )


@pytest.mark.parametrize(
    "elongation, force, slope", [(-2.0, -4.0, 0.0), (-0.5, -2.0, 4.0), (0.25, 2.5, 10.0), (1.5, 10.0, 0.0)]
)
def test_axial_spring_along_a_table(element, call, elongation, force, slope):
    table = np.array([-4.0, -1.0, 0.0, 0.0, 10.0, 1.0])
    block, matrix = element("SPRINGA", SpringSection("ALL", (), table, SOURCE))
    found, k, _ = pull(block, matrix, call, elongation)
    np.testing.assert_allclose(found, force * ALONG, atol=1e-12)
    np.testing.assert_allclose(k[3:, 3:], slope * np.outer(ALONG, ALONG), atol=1e-12)


def test_spring_between_dofs(element, call):
    block, matrix = element("SPRING2", SpringSection("ALL", (2, 2), np.array([8.0]), SOURCE))
    u, residual = np.array([0, 0.5, 0, 0.2]), np.zeros(4)
    report = block.evaluate(call, u, u, residual, matrix.data)
    np.testing.assert_allclose(residual, [0, -2.4, 0, 2.4])
    assert report.energy[1] == pytest.approx(0.5 * 8 * 0.3**2)


def test_kind_that_the_host_does_not_know(element, call):
    block, matrix = element("SPRINGA", SpringSection("ALL", (), np.array([1.0]), SOURCE))
    block._routine = replace(block._routine, jtype=99)
    with pytest.raises(KernelError, match=r"element 7 \(type SPRINGA\): .*of this kind are not known to the host"):
        block.evaluate(call, np.zeros(6), np.zeros(6), np.zeros(6), matrix.data)


def test_nodes_in_the_same_place(element, call):
    block, matrix = element("SPRINGA", SpringSection("ALL", (), np.array([1.0]), SOURCE), np.ones((2, 3)))
    with pytest.raises(KernelError, match=r"element 7 \(type SPRINGA\): .*both nodes are at the same position"):
        pull(block, matrix, call, 0.1, np.array([1.0, 0]))


def test_truss_needs_isotropic_elasticity(element):
    elastic = Elastic(ElasticType.LAMINA, (1.0, 1.0, 0.0, 1.0, 1.0, 1.0), SOURCE)
    section = replace(truss(), material=Material("M", SOURCE, elastic))
    with pytest.raises(DeckError, match=r"\*ELASTIC, TYPE=LAMINA is not supported for elements of type T2D2 "):
        element("T2D2", section)


def test_mass_call(element, call):
    block, matrix = element("MASS", MassSection("ALL", 2.5, SOURCE), np.array([[0.0, 0, 0]]))
    block.evaluate(call.asking(Request.MASS), np.zeros(2), np.zeros(2), np.zeros(2), matrix.data)
    np.testing.assert_allclose(matrix.toarray(), 2.5 * np.eye(2))


DECK = """*NODE
1, 0., 0.
*NSET, NSET=N
1
*ELEMENT, TYPE=MASS, ELSET=M
1, 1
*ELEMENT, TYPE=SPRING1, ELSET=S
2, 1
*MASS, ELSET=M
0.25
*SPRING, ELSET=S
1
4.
*BOUNDARY
1, 2
*INITIAL CONDITIONS, TYPE=VELOCITY
1, 1, 3.
*STEP
*DYNAMIC, ALPHA=0., DIRECT
0.1, 4.
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=N
U1, V1
*ENERGY OUTPUT
ETOTAL
*END STEP
"""


def test_mass_on_a_spring(run_deck):
    """omega = 4: the average acceleration method turns (u, v/omega) by 2 atan(omega h/2) in each increment."""
    history = run_deck(DECK).history
    angle = 2 * np.arctan(4 * 0.1 / 2) * np.arange(1, 41)
    assert history["U1[N]"] == pytest.approx(3 / 4 * np.sin(angle), abs=1e-9)
    assert history["V1[N]"] == pytest.approx(3 * np.cos(angle), abs=1e-8)
    assert history["ETOTAL"] == pytest.approx(0.5 * 0.25 * 9, rel=1e-9)


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("0.25\n", "-1.\n", r":10: \*MASS: mass -1 must not be negative"),
        ("*SPRING, ELSET=S\n1\n4.\n", "*SPRING, ELSET=S\n4.\n", r":11: \*SPRING: needs a line with dofs"),
        ("*SPRING, ELSET=S", "*SPRING, ELSET=S, NONLINEAR", r":13: \*SPRING: elongation is missing"),
        ("*SPRING, ELSET=S\n1\n4.", "*SPRING, ELSET=S, NONLINEAR\n1\n4., 1.", "NONLINEAR needs two or more lines"),
        ("*SPRING, ELSET=S\n1\n", "*SPRING, ELSET=S\n77\n", r":12: \*SPRING: a dof is a number from 1 to 30"),
        ("*MASS, ELSET=M\n0.25\n", "", r":6: element 1 has no section: no \*MASS refers to it"),
    ],
)
def test_what_is_wrong_with_springs_and_masses(run_deck, old, new, message):
    assert old in DECK
    with pytest.raises(DeckError, match=message):
        run_deck(DECK.replace(old, new))
