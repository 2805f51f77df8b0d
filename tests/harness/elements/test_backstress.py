# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*PLASTIC with HARDENING=KINEMATIC and COMBINED at a point: closed forms, tangent, plane stress, rotation."""

import math

import numpy as np
import pytest
from material_point import COMPONENTS
from moving_element import NODES, SQUARE, MovingElement, turn

from uel.errors import DeckError, Source
from uel.model.properties import Elastic, ElasticType, Material, Plastic

SOURCE = Source("deck.inp", 15)
E, NU, SIZE = 200e3, 0.3, 250.0
ELASTIC = Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE)
CONSTANT = np.array([[SIZE, 0.0]])
TABLE = np.array([[250.0, 0.0], [300.0, 0.01], [330.0, 0.05]])
TENSORS = ["PSTRESS", "PSTRAIN", "THREED"]
TWO = np.array([[60e3, 300.0], [5e3, 0.0]])
"""A backstress that saturates and one that does not."""


@pytest.fixture
def point(material_point):
    def point(tensor, backstresses, *, table=CONSTANT, growth=(0.0, 0.0)):
        plastic = Plastic(table, SOURCE, np.array(backstresses, dtype=float), growth, combined=True)
        return material_point(Material("M", SOURCE, ELASTIC, plastic), tensor, unsymmetric=True)

    return point


def pull(respond, axial):
    """The axial stresses at axial strains, one increment each, without other stresses."""
    strain, found = np.zeros(respond.n), []
    for value in axial:
        strain, stress = respond.free({0: value}, strain)
        respond.block.commit()
        found.append(stress[0])
    return np.array(found)


@pytest.mark.parametrize("tensor", ["PSTRESS", "THREED"])
def test_linear_kinematic_loop(point, tensor):
    """Bilinear, with an elastic range of twice the yield stress: W. Prager, J. Applied Mechanics 23 (1956) 493."""
    modulus = 10e3
    hard = E * modulus / (E + modulus)
    tip = SIZE + hard * (0.01 - SIZE / E)
    reverse = 0.01 - 2 * SIZE / E
    found = pull(point(tensor, [[modulus, 0]]), [0.01, reverse, -0.01, -0.01 + 2 * SIZE / E, 0.01])
    bottom = tip - 2 * SIZE - hard * (reverse + 0.01)
    expected = [tip, tip - 2 * SIZE, bottom, bottom + 2 * SIZE]
    np.testing.assert_allclose(found, [*expected, tip], rtol=1e-9)


@pytest.mark.parametrize("tensor", TENSORS)
def test_an_increment_begins_elastically_after_one_with_plastic_strain(point, tensor):
    """Its stress is on the yield surface but for rounding, which would choose the tangent otherwise."""
    n = len(COMPONENTS[tensor])
    elastic = point(tensor, TWO)(np.zeros(n))[1]
    for strain in 0.02 * np.random.default_rng(4).normal(size=(50, n)):
        respond = point(tensor, TWO, table=TABLE)
        assert abs(respond(strain)[1] - elastic).max() > 0.1 * abs(elastic).max()
        respond.block.commit()
        tangent = respond(strain, np.zeros(n))[1]
        np.testing.assert_allclose(tangent, elastic, rtol=1e-9, atol=1e-9 * abs(elastic).max())


@pytest.mark.parametrize("tensor", TENSORS)
def test_backstress_saturates(point, tensor):
    """In shear tau = (yield stress + C/gamma)/sqrt(3): P.J. Armstrong, C.O. Frederick, CEGB report RD/B/N731 (1966)."""
    shear = COMPONENTS[tensor].index(3)
    respond = point(tensor, [[60e3, 300.0], [8e3, 80.0]])
    # backward Euler leaves 1/(gamma p) of the backstress to go
    stress, _ = respond(1e4 * np.eye(respond.n)[shear])
    assert stress[shear] == pytest.approx((SIZE + 60e3 / 300 + 8e3 / 80) / math.sqrt(3), rel=1e-5)
    np.testing.assert_allclose(np.delete(stress, shear), 0, atol=1e-6)


def test_tension_converges_to_the_exponential(point):
    """Stress = size + C/gamma (1 - exp(-gamma p)), p the plastic strain; backward Euler errs by the first order."""
    c, gamma = 60e3, 300.0
    errors = []
    for count in (20, 40):
        (stress,) = pull(point("PSTRESS", [[c, gamma]]), np.linspace(0, 0.008, count + 1)[1:])[-1:]
        plastic = 0.008 - stress / E
        errors.append(stress - SIZE - c / gamma * (1 - math.exp(-gamma * plastic)))
    assert abs(errors[1]) < 0.01 * SIZE
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)


def test_stabilised_cycle(point):
    """Amplitude size + C/gamma tanh(gamma (plastic strain amplitude)): J. Lemaitre, J.-L. Chaboche, Mechanics of Solid
    Materials, Cambridge 1990, section 5.4.4; the error of backward Euler is of first order."""
    c, gamma, amplitude = 60e3, 150.0, 0.005
    errors = []
    for count in (10, 20):
        down, up = np.linspace(amplitude, -amplitude, count + 1)[1:], np.linspace(-amplitude, amplitude, count + 1)[1:]
        stress = pull(point("PSTRESS", [[c, gamma]]), np.concatenate([up[count // 2 :], *[down, up] * 6]))
        high, low = stress[-1], stress[-1 - count]
        assert high == pytest.approx(-low, rel=1e-4)
        errors.append(high - SIZE - c / gamma * math.tanh(gamma * (amplitude - high / E)))
    assert abs(errors[1]) < 0.05 * SIZE
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.15)


def test_size_grows_exponentially(point):
    """Size + Q (1 - exp(-b p)), exact in every increment while the surface does not move."""
    growth, rate = 80.0, 20.0
    found = pull(point("THREED", [[0, 0]], growth=(growth, rate)), [0.003, 0.02, 0.1])
    plastic = np.array([0.003, 0.02, 0.1]) - found / E
    np.testing.assert_allclose(found, SIZE + growth * (1 - np.exp(-rate * plastic)), rtol=1e-9)


@pytest.mark.parametrize("tensor", TENSORS)
def test_without_backstress_it_is_isotropic_hardening(point, material_point, tensor):
    """Two implementations, in plane stress two algorithms: with C = 0 the return is that of host_mises."""
    combined = point(tensor, [[0, 0]], table=TABLE)
    isotropic = material_point(Material("M", SOURCE, ELASTIC, Plastic(TABLE, SOURCE)), tensor)
    strain, random = np.zeros(combined.n), np.random.default_rng(1)
    for _ in range(10):
        strain = strain + 0.01 * random.normal(size=combined.n)
        (one, one_tangent), (two, two_tangent) = combined(strain), isotropic(strain)
        np.testing.assert_allclose(one, two, atol=1e-8 * abs(two).max())
        np.testing.assert_allclose(one_tangent, two_tangent, atol=1e-8 * abs(two_tangent).max())
        combined.block.commit()
        isotropic.block.commit()


@pytest.mark.parametrize("tensor", TENSORS)
@pytest.mark.parametrize("growth", [(0.0, 0.0), (90.0, 30.0), (-90.0, 30.0)])
def test_consistent_tangent(point, tensor, growth):
    """Against central differences, on a path that turns."""
    respond = point(tensor, TWO, growth=growth)
    strain, random, step = np.zeros(respond.n), np.random.default_rng(2), 1e-8
    for _ in range(12):
        strain = strain + 0.005 * random.normal(size=respond.n)
        _, tangent = respond(strain)
        slopes = [(respond(strain + h)[0] - respond(strain - h)[0]) / (2 * step) for h in step * np.eye(respond.n)]
        np.testing.assert_allclose(tangent, np.array(slopes).T, atol=2e-6 * abs(tangent).max())
        respond(strain)
        respond.block.commit()


def test_plane_stress_is_the_solid_with_a_free_thickness(point):
    """Also for the strain 33 that the history keeps: the paths stay together over several increments."""
    plane, solid = point("PSTRESS", TWO, growth=(50.0, 10.0)), point("PSTRAIN", TWO, growth=(50.0, 10.0))
    strain, random, full = np.zeros(3), np.random.default_rng(3), np.zeros(4)
    for _ in range(8):
        strain = strain + 0.006 * random.normal(size=3)
        stress, _ = plane(strain)
        for _ in range(50):
            full[[0, 1, 3]] = strain
            expected, tangent = solid(full)
            full[2] -= expected[2] / tangent[2, 2]
        np.testing.assert_allclose(stress, expected[[0, 1, 3]], atol=1e-8 * abs(stress).max())
        plane.block.commit()
        solid.block.commit()


def test_the_yield_condition_holds_with_a_symmetric_stiffness_without_gamma(point):
    respond = point("THREED", [[5e3, 0]])
    strain, random = np.zeros(6), np.random.default_rng(4)
    for _ in range(5):
        strain = strain + 0.01 * random.normal(size=6)
        stress, tangent = respond(strain)
        np.testing.assert_allclose(tangent, tangent.T, atol=1e-11 * abs(tangent).max())
        respond.block.commit()
        # the backstress is 2/3 C times the plastic strain, which is the strain less the elastic strain
        deviator = stress - stress[:3].mean() * np.array([1, 1, 1, 0, 0, 0])
        shear = E / (2 * (1 + NU))
        halves = np.array([1, 1, 1, 0.5, 0.5, 0.5])
        plastic = (strain - strain[:3].mean() * np.array([1, 1, 1, 0, 0, 0])) * halves - deviator / (2 * shear)
        moved = deviator - 2 / 3 * 5e3 * plastic
        mises = math.sqrt(1.5 * (moved**2 @ np.array([1, 1, 1, 2, 2, 2])))
        assert mises == pytest.approx(SIZE, rel=1e-9)


@pytest.mark.parametrize("element_type", ["CPS4", "CPE4", "C3D8"])
def test_backstress_turns_with_the_body(solid_group, bound, load, call, element_type):
    """Yielded, turned by 90 degrees and yielded back along the turned direction: the same stresses, turned."""
    plastic = Plastic(np.array([[5.0, 0.0]]), SOURCE, np.array([[500.0, 20.0]]), combined=True)
    nodes = NODES.get(element_type, SQUARE)

    def element():
        group = solid_group(element_type, np.arange(len(nodes))[None], 1.0, plastic=plastic)
        return MovingElement(*bound(group, nodes, load(None)), nodes, call)

    straight, turned = element(), element()
    quarter = turn(np.pi / 2)
    for body in (straight, turned):
        _, before = body.move(np.diag([1.03, 1, 1]))
    turned.move(quarter @ np.diag([1.03, 1, 1]))
    _, one = straight.move(np.diag([1.005, 1, 1]))
    _, two = turned.move(quarter @ np.diag([1.005, 1, 1]))
    a, b = straight.values()[0], turned.values()[0]
    n = len(a) // 2
    np.testing.assert_allclose(b[[n + 1, n, n + 2]], a[n : n + 3], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(two.energy, one.energy, rtol=1e-9, atol=1e-12)
    # it yields on the way back, where work comes back too: the backstress is larger than the yield stress
    assert before.energy[3] - one.energy[3] > 0.05 * before.energy[3]


def test_history_is_kept_only_on_commit(point):
    respond = point("PSTRESS", TWO)
    first, _ = respond([0.01, 0, 0])
    respond([0.02, 0.01, 0.005])
    np.testing.assert_array_equal(respond([0.01, 0, 0])[0], first)


def test_trusses_support_isotropic_hardening_only(solid_group, bound, load):
    group = solid_group("T2D2", np.array([[0, 1]]), 1.0, plastic=Plastic(CONSTANT, SOURCE, TWO))
    message = r"deck\.inp:15: \*PLASTIC with kinematic or combined hardening is not supported for .* T2D2 \(material M"
    with pytest.raises(DeckError, match=message):
        bound(group, np.array([[0.0, 0, 0], [1, 0, 0]]), load(None))


@pytest.mark.nan
@pytest.mark.parametrize("tensor", TENSORS)
def test_a_return_that_is_not_solved_asks_for_a_smaller_increment(point, tensor):
    """The trial stress of such a strain overflows when it is squared."""
    respond = point(tensor, TWO)
    respond(1e200 * np.eye(respond.n)[0])
    assert respond.report.pnewdt == 0.25
    (message,) = respond.library.messages()
    assert message.text == "*PLASTIC: the return to the yield surface does not converge at integration point 1"
