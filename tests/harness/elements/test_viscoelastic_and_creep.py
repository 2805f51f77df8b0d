# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*VISCOELASTIC and *CREEP at a point: closed forms, tangent, plane stress, energies, rotation."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from differences import asymmetry_along_a_path
from material_point import COMPONENTS
from moving_element import NODES, SQUARE, MovingElement, turn

from uel.elements import Flags
from uel.errors import DeckError, Source
from uel.model.properties import Creep, Elastic, ElasticType, Material, Viscoelastic

SOURCE = Source("deck.inp", 15)
E, NU = 1000.0, 0.3
STATIC, VISCO, DYNAMIC = 1, 21, 11
TENSORS = ["PSTRESS", "PSTRAIN", "THREED"]
SERIES = np.array([[0.3, 0.1, 0.5], [0.2, 0.0, 4.0], [0.0, 0.25, 2.0]])
NORTON = Creep(False, 1e-6, 3.0, 0.0, SOURCE)


def elastic(*, instantaneous=True):
    return Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE, instantaneous=instantaneous)


@pytest.fixture
def point(material_point):
    def point(tensor, law, *, instantaneous=True):
        laws = {"creep": law} if isinstance(law, Creep) else {"viscoelastic": Viscoelastic(np.array(law), SOURCE)}
        return material_point(Material("M", SOURCE, elastic(instantaneous=instantaneous), **laws), tensor)

    return point


def pass_time(respond, begin, end, procedure=VISCO):
    """The next calls are those of an increment between these times."""
    respond.call = replace(
        respond.call, flags=Flags(procedure), step_time=end, total_time=end, time_increment=end - begin
    )


def moduli(series, time, *, instantaneous=True):
    """Shear and bulk relaxation moduli: Abaqus Analysis User's Guide, Time domain viscoelasticity."""
    start = np.array([E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU))])
    left = 1 - series[:, :2].sum(axis=0)
    start = start if instantaneous else start / left
    return start * (left + (series[:, :2] * np.exp(-time / series[:, 2:])).sum(axis=0))


@pytest.mark.parametrize("instantaneous", [True, False])
@pytest.mark.parametrize("tensor", TENSORS)
def test_relaxation(point, tensor, instantaneous):
    """A strain at once in a static step, then held: exact for any increments."""
    respond = point(tensor, SERIES, instantaneous=instantaneous)
    strain = np.array([0.01, -0.002, 0.004, 0.003, 0.005, -0.006])[COMPONENTS[tensor]]
    direct = 2 if tensor == "PSTRESS" else 3
    times = [0.0, 1e-5, 0.4, 3.0, 50.0]
    pass_time(respond, 0.0, 1.0, STATIC)
    for k, time in enumerate(times):
        if k:
            pass_time(respond, times[k - 1], time)
        stress, _ = respond(strain)
        respond.block.commit()
        shear, bulk = moduli(SERIES, time, instantaneous=instantaneous)
        assert stress[direct] == pytest.approx(shear * strain[direct], rel=1e-12)
        if tensor == "PSTRESS":
            # with k = 0 in all terms there is a closed form; here the difference of the direct stresses has one
            assert stress[0] - stress[1] == pytest.approx(2 * shear * (strain[0] - strain[1]), rel=1e-12)
        else:
            assert stress[:3].sum() == pytest.approx(3 * bulk * strain[:3].sum(), rel=1e-12)
            deviator = 2 * shear * (strain[:3] - strain[:3].mean())
            np.testing.assert_allclose(stress[:3] - stress[:3].mean(), deviator, atol=1e-12)


def test_constant_rate_is_exact(point):
    """tau = integral of G(s) times the rate, in increments of any lengths."""
    respond, rate, times = point("THREED", SERIES), 0.01, [0.0, 0.2, 0.3, 4.0, 9.0]
    for begin, end in pairwise(times):
        pass_time(respond, begin, end)
        stress, _ = respond(rate * end * np.eye(6)[3])
        respond.block.commit()
    shear = moduli(SERIES, 1e9)[0]
    g, tau = SERIES[:2, 0], SERIES[:2, 2]
    expected = shear * end + E / (2 * (1 + NU)) * (g * tau * (1 - np.exp(-end / tau))).sum()
    assert stress[3] == pytest.approx(rate * expected, rel=1e-12)


def test_creep_of_a_standard_solid(point):
    """Shear stress at once, then constant: J(t) = 1/G_long - (1/G_long - 1/G) exp(-G_long t/(G tau)): R.M. Christensen,
    Theory of Viscoelasticity, Academic Press 1982, section 1.4. The error is of second order."""
    g, tau, stress = 0.6, 2.0, 5.0
    shear = E / (2 * (1 + NU))
    errors = []
    for count in (20, 40):
        respond, strain = point("THREED", [[g, 0.0, tau]]), 0.0
        times = np.linspace(0, 5, count + 1)
        pass_time(respond, 0.0, 1.0, STATIC)
        for begin, end in zip([None, *times[:-1]], times, strict=True):
            if begin is not None:
                pass_time(respond, begin, end)
            found, tangent = respond(strain * np.eye(6)[3])
            strain += (stress - found[3]) / tangent[3, 3]
            respond(strain * np.eye(6)[3])
            respond.block.commit()
        long = shear * (1 - g)
        errors.append(strain - stress * (1 / long - (1 / long - 1 / shear) * math.exp(-(1 - g) * 5 / tau)))
    assert abs(errors[1]) < 1e-3 * stress / shear
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize("procedure", [STATIC, DYNAMIC])
def test_procedures(point, procedure):
    """*STATIC takes the instantaneous moduli, in *DYNAMIC stresses relax; creep is in *VISCO only."""
    strain, time = 0.01 * np.eye(6)[3], 3.0
    relaxing, creeping = point("THREED", SERIES), point("THREED", NORTON)
    for respond in (relaxing, creeping):
        for begin, end in ((0.0, 1e-9), (1e-9, time)):
            pass_time(respond, begin, end, procedure)
            stress, _ = respond(strain)
            respond.block.commit()
        shear = moduli(SERIES, time)[0] if procedure == DYNAMIC and respond is relaxing else E / (2 * (1 + NU))
        assert stress[3] == pytest.approx(shear * 0.01, rel=1e-8)


@pytest.mark.parametrize(
    "law", [Creep(by_time, 1e-6, 3.0, m, SOURCE) for by_time in (True, False) for m in (0.0, -0.4)]
)
@pytest.mark.parametrize("tensor", ["PSTRESS", "THREED"])
def test_creep_under_constant_stress(point, tensor, law):
    """A stress^n t^(m + 1)/(m + 1) by both laws, whatever the increments; the volume stays."""
    respond, stress = point(tensor, law), 20.0
    elastic_part = np.array([1, -NU, -NU, 0, 0, 0])[COMPONENTS[tensor]] * stress / E
    plastic_part = np.array([1, -0.5, -0.5, 0, 0, 0])[COMPONENTS[tensor]]
    times = [0.0, 0.1, 2.0, 2.5]
    for begin, end in pairwise(times):
        pass_time(respond, begin, end)
        creep = 1e-6 * stress**3 * end ** (1 + law.time_power) / (1 + law.time_power)
        found, _ = respond(elastic_part + creep * plastic_part)
        np.testing.assert_allclose(found, stress * np.eye(respond.n)[0], rtol=1e-9, atol=1e-8)
        respond.block.commit()


def test_relaxation_by_creep(point):
    """Norton, at constant uniaxial strain: stress^(1 - n) = start^(1 - n) + (n - 1) A E t; first order."""
    errors = []
    for count in (20, 40):
        respond = point("PSTRESS", NORTON)
        pass_time(respond, 0.0, 1.0, STATIC)
        strain, _ = respond.free({0: 0.03}, np.zeros(3))
        respond.block.commit()
        times = np.linspace(0, 2, count + 1)
        for begin, end in pairwise(times):
            pass_time(respond, begin, end)
            strain, stress = respond.free({0: 0.03}, strain)
            respond.block.commit()
        errors.append(stress[0] - (30.0**-2 + 2 * 1e-6 * E * 2) ** -0.5)
    assert 0 < errors[1] < 0.5
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)


LAWS = {"prony": SERIES, "strain": Creep(False, 1e-5, 3.0, -0.3, SOURCE), "time": Creep(True, 1e-5, 2.5, -0.2, SOURCE)}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("tensor", TENSORS)
def test_consistent_tangent(point, tensor, law):
    """It is symmetric."""
    assert asymmetry_along_a_path(point(tensor, LAWS[law]), pass_time) < 1e-11


@pytest.mark.parametrize("law", LAWS)
def test_plane_stress_is_the_solid_with_a_free_thickness(point, law):
    plane, solid = point("PSTRESS", LAWS[law]), point("PSTRAIN", LAWS[law])
    strain, random, full = np.zeros(3), np.random.default_rng(3), np.zeros(4)
    for k in range(6):
        strain = strain + 0.02 * random.normal(size=3)
        full[[0, 1, 3]] = strain
        for respond in (plane, solid):
            pass_time(respond, 0.5 * k, 0.5 * (k + 1))
        stress, _ = plane(strain)
        for _ in range(50):
            expected, tangent = solid(full)
            full[2] -= expected[2] / tangent[2, 2]
        np.testing.assert_allclose(stress, expected[[0, 1, 3]], atol=1e-8 * abs(stress).max())
        plane.block.commit()
        solid.block.commit()


def test_creep_rate_is_bounded_by_the_trial_stress(point):
    """An increment much longer than the time of relaxation: the stress falls to what the law still allows."""
    respond = point("THREED", NORTON)
    pass_time(respond, 0.0, 1e12)
    stress, _ = respond(0.1 * np.eye(6)[3])
    mises = math.sqrt(3) * stress[3]
    creep = (0.1 - stress[3] * 2 * (1 + NU) / E) / math.sqrt(3)
    assert creep == pytest.approx(1e-6 * mises**3 * 1e12, rel=1e-6)


@pytest.fixture
def element(solid_group, bound, load, call):
    """An element that moves in *VISCO."""

    def element(element_type, law, size=0.5):
        nodes = NODES.get(element_type, SQUARE)
        group = solid_group(element_type, np.arange(len(nodes))[None], 1.0, elastic=elastic())
        laws = {"creep": law} if isinstance(law, Creep) else {"viscoelastic": Viscoelastic(law, SOURCE)}
        material = replace(group.section.material, **laws)
        group = replace(group, section=replace(group.section, material=material))
        solid = MovingElement(*bound(group, nodes, load(None)), nodes, call)
        solid.call = replace(solid.call, flags=Flags(VISCO, nlgeom=True), time_increment=size, total_time=1.0)
        return solid

    return element


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("element_type", ["CPS4", "CPE4", "C3D8"])
def test_history_turns_with_the_body(element, element_type, law):
    """Stretched, turned by 90 degrees at once, held: the same stresses, turned."""
    straight, turned = element(element_type, LAWS[law]), element(element_type, LAWS[law])
    stretch, quarter = np.diag([1.03, 0.99, 1]), turn(np.pi / 2)
    for body in (straight, turned):
        body.move(stretch)
    straight.move(stretch)
    turned.move(quarter @ stretch)
    _, one = straight.move(np.diag([1.02, 1.0, 1]))
    _, two = turned.move(quarter @ np.diag([1.02, 1.0, 1]))
    a, b = straight.values()[0], turned.values()[0]
    n = len(a) // 2
    np.testing.assert_allclose(b[[n + 1, n, n + 2]], a[n : n + 3], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(two.energy, one.energy, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_dissipation_is_that_of_creep(element, law):
    """ENERGY(3), ALLCD, grows, whatever the element does, and ENERGY(4) is zero; at rest stored energy goes."""
    solid, dissipated, random = element("C3D8", LAWS[law]), 0.0, np.random.default_rng(5)
    for _ in range(8):
        _, report = solid.move(np.eye(3) + 0.01 * random.normal(size=(3, 3)))
        assert report.energy[2] > dissipated
        assert report.energy[3] == 0
        dissipated = report.energy[2]
    _, later = solid.move(solid_shape(solid))
    assert later.energy[2] - dissipated == pytest.approx(report.energy[1] - later.energy[1], rel=1e-9)


def solid_shape(solid):
    """The deformation gradient of a uniform element."""
    corners = solid.nodes[:, :3]
    found, *_ = np.linalg.lstsq(corners - corners[0], solid.u.reshape(-1, 3) - solid.u[:3], rcond=None)
    return np.eye(3) + found.T


def test_change_of_the_viscous_strain_rate(element):
    """Norton, at constant strain: A (q^n at the end - q^n at the start) times the length of the increment."""
    solid = element("C3D8", NORTON, size=0.1)
    solid.move(np.array([[1, 0.05, 0], [0.05, 1, 0], [0, 0, 1]]))
    q = [mises(solid)]
    solid.evaluate(solid.u)
    change = solid.block.viscous_change
    solid.block.commit()
    q.append(mises(solid))
    assert change == pytest.approx(1e-6 * (q[0] ** 3 - q[1] ** 3) * 0.1, rel=1e-9)


def mises(solid):
    s = solid.values()[0][6:]
    direct = s[:3] - s[:3].mean()
    return math.sqrt(1.5 * (direct @ direct + 2 * s[3:] @ s[3:]))


@pytest.mark.parametrize("law", ["prony", "strain"])
def test_only_isotropic_elasticity(material_point, law):
    ply = Elastic(ElasticType.LAMINA, (1e5, 1e4, 0.3, 5e3, 5e3, 5e3), SOURCE)
    laws = {"creep": NORTON} if law == "strain" else {"viscoelastic": Viscoelastic(SERIES, SOURCE)}
    message = r"deck\.inp:15: \*(CREEP|VISCOELASTIC) beside .*; expected \*ELASTIC, TYPE=ISOTROPIC with constant values"
    with pytest.raises(DeckError, match=message):
        material_point(Material("M", SOURCE, ply, **laws), "PSTRESS")


def test_trusses_do_not_creep(solid_group, bound, load):
    group = solid_group("T2D2", np.array([[0, 1]]), 1.0)
    group = replace(group, section=replace(group.section, material=replace(group.section.material, creep=NORTON)))
    with pytest.raises(DeckError, match=r"deck\.inp:15: \*CREEP is not supported for elements of type T2D2"):
        bound(group, np.array([[0.0, 0, 0], [1, 0, 0]]), load(None))


@pytest.mark.nan
@pytest.mark.parametrize("tensor", TENSORS)
def test_creep_that_is_not_found_asks_for_a_smaller_increment(point, tensor):
    """The trial stress of such a strain overflows when it is squared."""
    respond = point(tensor, NORTON)
    pass_time(respond, 0.0, 1.0)
    respond(1e200 * np.eye(respond.n)[0])
    assert respond.report.pnewdt == 0.25
    (message,) = respond.library.messages()
    assert message.text == "*CREEP or *VISCOELASTIC: the stress is not found at integration point 1"
