# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parallel rheological framework: tangents, relaxation against other integrations, arguments of its user routines."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from moving_element import CUBE, NODES, SQUARE, MovingElement, turn
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from small_decks import body_lines

import uel
from uel.elements import Flags
from uel.errors import DeckError, KernelError, Source
from uel.model.mesh import ElementGroup
from uel.model.properties import CreepLaw, Hyperelastic, Material, Network, Orientation, Potential, SolidSection

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
STATIC, VISCO = 1, 21
NEO = Hyperelastic(Potential.NEO_HOOKE, 1, (0.5,), (0.4,), SOURCE, instantaneous=True)
QUARTIC = Hyperelastic(Potential.POLYNOMIAL, 2, (0.5, 0.2, 0.03, 0.02, 0.01), (0.4, 0.7), SOURCE, instantaneous=True)
POWER = Network(0.3, CreepLaw.POWER, (0.8, 1.5, -0.4, 0.0, 0.6), SOURCE)
PRESSED = Network(0.3, CreepLaw.POWER, (0.8, 1.5, -0.4, 0.5, 0.6), SOURCE)
HYPERBOLIC = Network(0.4, CreepLaw.HYPERBOLIC, (0.3, 2.0, 1.2), SOURCE)
CHAINS = Network(0.5, CreepLaw.BERGSTROM_BOYCE, (0.5, 2.0, -0.7, 0.05), SOURCE)
USER = Network(
    0.3,
    CreepLaw.USER,
    (),
    SOURCE,
    user=np.array([0.4, 1.3, -0.3, 0.5, 0.2, -0.1, 0.4, 0.3]),
    shift=np.array([0.5, 0.7]),
)
LAWS = {
    "power": (POWER,),
    "pressed": (PRESSED,),
    "hyperbolic": (HYPERBOLIC,),
    "chains": (CHAINS,),
    "user": (USER,),
    "several": (POWER, HYPERBOLIC, USER),
}


@pytest.fixture
def element(bound, load, call):
    def element(networks, element_type="C3D8", potential=NEO, *, orientation=None, **options):
        nodes = NODES.get(element_type, SQUARE)
        if element_type.startswith("CAX"):
            nodes = nodes + np.array([1.0, 0, 0])
        material = Material("RUBBER", SOURCE, hyperelastic=potential, networks=networks, **options)
        section = SolidSection(
            "ALL", material, orientation, 1.0, SOURCE, hourglass=0.1 if element_type.endswith("R") else 0.0
        )
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        solid = MovingElement(*bound(group, nodes, load("networks.f90")), nodes, call)
        solid.call = replace(call, flags=Flags(VISCO, nlgeom=True))
        return solid

    return element


def check_tangent(solid):
    """In an increment after another, in which networks have flowed."""
    random = np.random.default_rng(3)
    u = 0.1 * random.standard_normal(solid.u.size)
    solid.evaluate(u)
    solid.block.commit()
    solid.u = u
    u = u + 0.05 * random.standard_normal(u.size)
    solid.evaluate(u)
    tangent, step = solid.matrix.toarray(), 1e-6
    for _ in range(3):
        d = random.standard_normal(u.size)
        (down, _), (up, _) = solid.evaluate(u - step * d), solid.evaluate(u + step * d)
        np.testing.assert_allclose((down - up) / (2 * step), tangent @ d, atol=1e-7 * abs(tangent).max())


@pytest.mark.parametrize("potential", [NEO, QUARTIC])
@pytest.mark.parametrize("law", LAWS)
def test_tangent(element, law, potential):
    check_tangent(element(LAWS[law], potential=potential))


@pytest.mark.parametrize("element_type", ["C3D10", "C3D4", "CPE4", "CPE3", "CAX4", "CAX8R"])
def test_tangent_of_elements(element, element_type):
    check_tangent(element(LAWS["several"], element_type))


@pytest.mark.parametrize("element_type", ["C3D8R", "CPE4R", "CAX4R"])
def test_tangent_of_elements_of_one_point(element, element_type):
    """Of uniform strains: they leave out how hourglass modes change their mean strain."""
    solid = element(LAWS["several"], element_type)
    solid.move(F_HELD if element_type == "C3D8R" else np.diag([1.3, 0.9, 1.0]))
    solid.evaluate(solid.u)
    tangent, step = solid.matrix.toarray(), 1e-6
    now = solid.nodes[:, : solid.dimension] + solid.u.reshape(-1, solid.dimension)
    for a in np.eye(solid.dimension**2).reshape(-1, solid.dimension, solid.dimension):
        if element_type == "CAX4R" and a[0, 1]:
            # its strain around the axis is not uniform
            continue
        d = (now @ a.T).ravel()
        slope = (solid.evaluate(solid.u - step * d)[0] - solid.evaluate(solid.u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, tangent @ d, atol=1e-7 * abs(tangent).max())


def pass_time(solid, begin, end, procedure=VISCO):
    """The next calls are those of an increment between these times."""
    solid.call = replace(
        solid.call, flags=Flags(procedure, nlgeom=True), step_time=end, total_time=end, time_increment=end - begin
    )


def rate(network, q, creep, creep_stretch):
    """Equivalent creep strain rate (Abaqus Analysis User's Guide, Parallel rheological framework)."""
    match network.law:
        case CreepLaw.POWER:
            q0, n, m, _, start = network.constants
            return start * ((q / q0) ** n * ((m + 1) * creep) ** m) ** (1 / (m + 1))
        case CreepLaw.HYPERBOLIC:
            a, b, n = network.constants
            return a * np.sinh(b * q) ** n
        case _:
            a, m, c, e = network.constants
            return a * (creep_stretch - 1 + e) ** c * q**m


def stress_of_path(network, path, end):
    """Cauchy stress (3, 3) of neo-Hooke at the end of a path F(t): the inverse of Ccr and the creep strain by an ODE.

    The rate of the inverse of Ccr at a constant F is that of be, -2 D be, pulled back.
    """

    def state(time, values):
        f = path(time)
        volume = np.linalg.det(f)
        inverse_creep = values[:9].reshape(3, 3)
        elastic = f @ inverse_creep @ f.T / volume ** (2 / 3)
        deviator = network.ratio * 2 * NEO.coefficients[0] * (elastic - np.trace(elastic) / 3 * np.eye(3))
        return f, volume, elastic, deviator, np.sqrt(1.5 * (deviator**2).sum())

    def slope(time, values):
        f, volume, elastic, deviator, q = state(time, values)
        if q == 0:
            return np.zeros(10)
        stretch = np.sqrt(np.trace(np.linalg.inv(values[:9].reshape(3, 3))) / 3)
        grown = rate(network, q, max(values[9], 1e-30), stretch)
        back = np.linalg.inv(f) * volume ** (1 / 3)
        return np.append(-2 * 1.5 * grown / q * back @ deviator @ elastic @ back.T, grown)

    # the power law begins with a rate that is infinite: a creep strain that is too small to matter
    start = np.append(np.eye(3), 1e-14)
    found = solve_ivp(slope, (0, end), start, method="LSODA", rtol=1e-10, atol=1e-12)
    f, volume, _, deviator, _ = state(end, found.y[:, -1])
    total = f @ f.T / volume ** (2 / 3)
    equilibrium = (1 - network.ratio) * 2 * NEO.coefficients[0] * (total - np.trace(total) / 3 * np.eye(3))
    pressure = 2 / NEO.compliances[0] * (volume - 1)
    return (deviator + equilibrium) / volume + pressure * np.eye(3)


F_HELD = np.array([[1.5, 0.4, 0.1], [-0.2, 0.9, 0.0], [0.1, -0.1, 1.1]])


def to_held(time):
    """To F_HELD within one second, then held."""
    return np.eye(3) + min(time, 1.0) * (F_HELD - np.eye(3))


@pytest.mark.parametrize("network", [POWER, HYPERBOLIC, CHAINS], ids=lambda network: network.law.name)
@pytest.mark.parametrize("end", [1.0, 2.5])
def test_relaxation(element, network, end):
    """Under a path that turns the principal directions: backward Euler, extrapolated to no increments."""
    wanted = stress_of_path(network, to_held, end)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    found = []
    for count in (50, 100, 200):
        solid = element((network,), "C3D4")
        for k in range(count):
            pass_time(solid, k * end / count, (k + 1) * end / count)
            solid.move(to_held((k + 1) * end / count))
        found.append(solid.values()[0, 6:12])
    # the change of volume has no part in it
    size = abs(wanted - wanted[:3].mean() * np.array([1, 1, 1, 0, 0, 0])).max()
    errors = [abs(stress - wanted).max() / size for stress in found]
    assert errors[2] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2, rel=0.1)
    extrapolated = 2 * np.asarray(found[2]) - found[1]
    np.testing.assert_allclose(extrapolated, wanted, atol=2e-5 * size)


@pytest.mark.parametrize("element_type", ["C3D8", "CPE4", "CAX4"])
def test_small_strains(element, element_type):
    """A Maxwell chain, 1/tau = 3 G ratio A, by backward Euler; instantaneous in *STATIC, and with no time.

    Parameters and relaxation times of OlafHesebeck/UTRSNETWORK, parameter-prf-reduced.inp, are in this relation.
    """
    ratio, factor, small = 0.4, 2.0, 1e-6
    solid = element((Network(ratio, CreepLaw.POWER, (1 / factor, 1.0, 0.0, 0.0, 1.0), SOURCE),), element_type)
    strain = np.zeros((3, 3))
    strain[0, 0] = small
    if element_type == "CAX4":
        strain[2, 2] = small
    else:
        strain[0, 1] = strain[1, 0] = small
    deviator = (strain - np.trace(strain) / 3 * np.eye(3))[[0, 1, 2, 0], [0, 1, 2, 1]]
    shear = 2 * NEO.coefficients[0]
    tau, step = 1 / (3 * shear * ratio * factor), 0.05
    pass_time(solid, 0.0, 1.0, STATIC)
    for k in range(6):
        solid.move(np.eye(3) + strain)
        stress = solid.values()[0, len(solid.values()[0]) // 2 :][:4]
        stress[:3] -= stress[:3].mean()
        left = 1 - ratio + ratio * (1 + step / tau) ** -k
        np.testing.assert_allclose(stress, 2 * shear * left * deviator, atol=1e-5 * small)
        pass_time(solid, 1 + k * step, 1 + (k + 1) * step)


RUBBER = "*HYPERELASTIC, NEO HOOKE, MODULI=INSTANTANEOUS\n0.5, 0.4"
NETWORK = "*VISCOELASTIC, NONLINEAR, NETWORKID=1, SRATIO=0.4, LAW=STRAIN\n2., 1., 0."
BY_USER = (
    "*VISCOELASTIC, NONLINEAR, NETWORKID=1, SRATIO=0.4, LAW=USER, PROPERTIES=9\n2., 1., 0., 0., 0., 0., 0., 0.\n{way}"
)
FREE = ["1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2", "2, 3", "3, 3", "4, 3"]
PULLED = [f"{node}, 1, 1, 0.5" for node in (2, 3, 6, 7)]


def deck(*material, visco="*VISCO\n0.1, 1., , 0.1", element_type="C3D8", section="", before=(), more=(), start=()):
    """A unit cube that is pulled in a static step and held in another."""
    lines = body_lines(element_type, CUBE, [range(8)])
    lines += [
        f"*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER{section}",
        *before,
        "*MATERIAL, NAME=RUBBER",
        *material,
        *start,
    ]
    lines += [
        "*STEP, NLGEOM",
        "*STATIC",
        "0.5, 1.",
        "*CONTROLS, PARAMETERS=FIELD",
        "1e-9, 1e-9",
        "*BOUNDARY",
        *FREE,
        *PULLED,
        "*OUTPUT, HISTORY",
    ]
    lines += [
        "*NODE OUTPUT, NSET=ALL",
        "RF",
        "*ENERGY OUTPUT",
        "*END STEP",
        "*STEP, NLGEOM, INC=1000, AMPLITUDE=RAMP",
        visco,
        *more,
    ]
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "SDV, S", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "RF"]
    return "\n".join([*lines, "*ENERGY OUTPUT", "*END STEP"]) + "\n"


def pull(result):
    return sum(result.history[f"RF1[ALL:{node}]"] for node in (2, 3, 6, 7))


def test_long_term_moduli(run_deck):
    """The default: the coefficients are those of what is left in the end, D too: ratios scale all of the energy."""
    scaled = "*HYPERELASTIC, NEO HOOKE\n0.3, 0.666666666666666667"
    found, wanted = (pull(run_deck(deck(law, NETWORK), HERE / "networks.f90")) for law in (scaled, RUBBER))
    np.testing.assert_allclose(found, wanted, rtol=1e-12)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8R", "C3D8H", "C3D8RH"])
def test_a_pulled_cube(run_deck, element_type):
    """At first the whole elasticity, in the end what is left; the linear law has the time 1/(3 G ratio A)."""
    quick = NETWORK.replace("2., 1.", "200., 1.")
    force = pull(run_deck(deck(RUBBER, quick, element_type=element_type), HERE / "networks.f90"))
    whole = pull(run_deck(deck(RUBBER, element_type=element_type, visco="*STATIC\n1., 1."), HERE / "networks.f90"))
    left = "*HYPERELASTIC, NEO HOOKE\n0.3, 0.4"
    assert force[1] == pytest.approx(whole[-1], rel=1e-9)
    # the change of volume does not relax
    wanted = pull(run_deck(deck(left, element_type=element_type, visco="*STATIC\n1., 1."), HERE / "networks.f90"))[-1]
    assert force[-1] == pytest.approx(wanted, rel=1e-7)


def test_energies(run_deck):
    """What is held does no work: strain energy is dissipated, up to an error of the integration of first order."""
    errors = []
    for size in (0.05, 0.025):
        history = run_deck(deck(RUBBER, NETWORK, visco=f"*VISCO\n{size}, 1., , {size}"), HERE / "networks.f90").history
        held = history["step"] == 2
        lost, stored, at_first = history["ALLCD"][held], history["ALLSE"][held], history["ALLSE"][~held][-1]
        assert lost[-1] > 0.05 * at_first
        assert (np.diff(lost) > 0).all()
        errors.append(abs(lost[-1] + stored[-1] - at_first) / lost[-1])
    assert errors[1] < 0.05
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)


def test_largest_change_of_the_rate(run_deck):
    """CETOL bounds the change of the creep rate times the increment: the first increment is cut."""
    fine, coarse = (
        len(run_deck(deck(RUBBER, NETWORK, visco=f"*VISCO, CETOL={limit}\n1., 1."), HERE / "networks.f90").status)
        for limit in ("1e-3", "10.")
    )
    assert coarse == 3
    assert fine > 10


@pytest.mark.parametrize("procedure", ["*VISCO", "*DYNAMIC, DIRECT, NOHAF"])
def test_arguments(run_deck, procedure):
    """Of UCREEPNETWORK at the end of the last increment, and of UTRSNETWORK: User Subroutines Guide; means."""
    initial = "*INITIAL CONDITIONS, TYPE="
    start = [f"{initial}TEMPERATURE", "ALL, 20.", f"{initial}FIELD, VARIABLE=1", "ALL, 1."]
    more = ["*TEMPERATURE", "ALL, 60.", "*FIELD, VARIABLE=1", "ALL, 3."]
    shift = "*TRS, DEFINITION=USER, PROPERTIES=3\n2., 2., 7."
    result = run_deck(
        deck(
            *(
                "*DENSITY\n1e-6",
                RUBBER,
                NETWORK,
                BY_USER.format(way="0.").replace("ID=1", "ID=2"),
                shift,
                "*DEPVAR\n64",
            ),
            start=start,
            more=more,
            visco=f"{procedure}\n0.25, 1.",
        ),
        HERE / "networks.f90",
    )
    assert result.completed
    found = np.array([0.0, *(result.field(f"SDV{k}")[0] for k in range(1, 65))])
    step = [k for k, number in enumerate(result.history["step"]) if number == 2]
    # one call of each converged increment is kept; none in *STATIC
    assert found[1] == len(step)
    # NOUTPUT, NSTATV, NETWORKID, NFIELD, NPROPS, NIARRAY, NRARRAY, NCARRAY, TEMP, DTEMP
    np.testing.assert_allclose(found[2:12], [8, 64, 2, 1, 9, 7, 11, 1, 60, 10], rtol=1e-12)
    # PREDEF, DPRED; KSTEP, KINC, NOEL, NPT, LAYER, KSPT, LEND
    np.testing.assert_allclose(found[15:24], [3, 0.5, 2, len(step), 1, 4.5, 1, 1, 1], rtol=1e-12)
    # step time, total time, creep time, reduced time increment
    np.testing.assert_allclose(found[24:28], [1, 2, 1, 0.125], rtol=1e-12)
    assert found[35] == 1
    # NOUTPUT, NETWORKID, NFIELD, NPROPS, NIARRAY, NRARRAY, NCARRAY, TEMP, DTEMP
    np.testing.assert_allclose(found[41:50], [2, 2, 1, 3, 6, 4, 1, 60, 10], rtol=1e-12)
    np.testing.assert_allclose(found[53:61], [3, 0.5, 2, len(step), 1, 4.5, 1, 1], rtol=1e-12)
    np.testing.assert_allclose(found[61:65], [1, 2, 1, 0.25], rtol=1e-12)
    # current coordinates of both
    np.testing.assert_allclose(found[12:15], found[50:53], rtol=1e-12)
    assert found[12] == pytest.approx(0.75, rel=1e-9)


def test_invariants_of_arguments(element):
    """Of a stretch in one increment: equivalent creep strain, q, tr Ccr, I1, I2, J, pressure, from F and the stress."""
    solid = element((USER,), "C3D4", state_variables=40)
    solid.move(F_HELD)
    values = solid.values()[0]
    stress = values[6:12][[0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(3, 3)
    creep, q, i1_creep, i1, i2, j, pressure = values[12:][27:34]
    volume = np.linalg.det(F_HELD)
    bar = F_HELD / volume ** (1 / 3)
    total = bar @ bar.T
    np.testing.assert_allclose([i1, i2, j], [np.trace(total), np.trace(np.linalg.inv(total)), volume], rtol=1e-12)
    mean = volume * 2 / NEO.compliances[0] * (volume - 1)
    assert pressure == pytest.approx(-USER.ratio * mean, rel=1e-12)
    c = 2 * NEO.coefficients[0]
    deviator = volume * stress - mean * np.eye(3) - (1 - USER.ratio) * c * (total - np.trace(total) / 3 * np.eye(3))
    assert q == pytest.approx(np.sqrt(1.5 * (deviator**2).sum()), rel=1e-9)
    part = deviator / (USER.ratio * c)
    trace = brentq(lambda x: np.linalg.det(part + x * np.eye(3)) - 1, -np.linalg.eigvalsh(part)[0], 10.0, xtol=1e-14)
    elastic = part + trace * np.eye(3)
    assert i1_creep == pytest.approx(np.trace(bar.T @ np.linalg.inv(elastic) @ bar), rel=1e-9)
    # a linear logarithm of the shift
    reduced = (0.7 / 0.5 - 1) / np.log(0.7 / 0.5) / 0.7
    assert values[12:][26] == pytest.approx(reduced, rel=1e-12)
    a, n, *factors = USER.user
    grown = a * q**n * np.exp(np.dot(factors, [creep, i1_creep - 3, i1 - 3, i2 - 3, j - 1, pressure])) * reduced
    assert creep == pytest.approx(grown, rel=1e-9)


def test_rotation(element):
    """A rotation over many increments turns the stress, with directions of the material too."""
    axes = Orientation("O", turn(0.7) @ np.eye(3), SOURCE)
    solids = [element((HYPERBOLIC, POWER), "C3D4", orientation=one) for one in (None, None, axes)]
    for k in range(1, 6):
        stretch, rotation = np.eye(3) + 0.2 * k * (F_HELD - np.eye(3)), turn(0.3 * k)
        solids[0].move(stretch)
        for solid in solids[1:]:
            solid.move(rotation @ stretch)
    straight, turned, oriented = (
        solid.values()[0][6:12][[0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(3, 3) for solid in solids
    )
    np.testing.assert_allclose(turned, rotation @ straight @ rotation.T, atol=1e-10)
    np.testing.assert_allclose(np.linalg.eigvalsh(oriented), np.linalg.eigvalsh(straight), atol=1e-10)


def test_nothing_relaxes_in_no_time(element):
    """Relaxed to the end, in many and long increments, the network has no stress, and its tangent numbers."""
    solid = element((HYPERBOLIC, replace(POWER, constants=(1.0, 1.0, 0.0, 0.0, 1.0))))
    for size in np.geomspace(1e-3, 1e12, 40):
        pass_time(solid, 0.0, size)
        solid.move(F_HELD)
    solid.evaluate(solid.u)
    elastic = element((), potential=replace(NEO, coefficients=(0.3 * NEO.coefficients[0],)))
    elastic.move(F_HELD)
    assert np.isfinite(solid.matrix.toarray()).all()
    np.testing.assert_allclose(solid.values(), elastic.values(), atol=1e-9)


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ([NETWORK], r"material RUBBER has no \*ELASTIC, \*HYPERELASTIC, "),
        (
            ["*HYPERELASTIC, USER, TYPE=COMPRESSIBLE", NETWORK],
            r"\*VISCOELASTIC, NONLINEAR beside .*, USER, .*; expected \*HYPERELASTIC by coefficients",
        ),
        (
            [RUBBER.replace(", MODULI=INSTANTANEOUS", ""), NETWORK.replace("0.4", "1.")],
            "the sum of SRATIO is 1, so that there is no long-term elasticity; expected MODULI=INSTANTANEOUS",
        ),
        ([RUBBER, NETWORK.replace(", SRATIO=0.4", "")], "NONLINEAR needs SRATIO"),
        ([RUBBER, NETWORK.replace("0.4", "1.5")], "SRATIO=1.5: expected 0 < SRATIO <= 1"),
        ([RUBBER, NETWORK.replace("ID=1", "ID=2")], "NETWORKID=2: expected 1, networks in ascending order"),
        (
            [RUBBER, NETWORK, NETWORK.replace("ID=1", "ID=2").replace("0.4", "0.7")],
            "the sum of SRATIO is 1.1, expected at most 1",
        ),
        ([RUBBER, NETWORK.replace(", NONLINEAR", "")], "LAW: expected with NONLINEAR only"),
        ([RUBBER, "*VISCOELASTIC"], "expected TIME=PRONY or NONLINEAR"),
        ([RUBBER, NETWORK.replace("STRAIN\n2., 1., 0.", "STRAIN")], "needs a data line with A, n, m"),
        ([RUBBER, NETWORK + ", 20."], "expected only A, n, m; dependence on temperature is not supported"),
        (
            [RUBBER, NETWORK.replace("2., 1., 0.", "2., 1., -1.")],
            "A = 2, n = 1, m = -1: expected A > 0, n > 0 and -1 < m",
        ),
        ([RUBBER, NETWORK.replace("STRAIN", "HYPERB")], "A = 2, B = 1, n = 0: expected A > 0, B > 0 and n > 0"),
        (
            [RUBBER, NETWORK.replace("STRAIN\n2., 1., 0.", "POWER LAW\n2., 1., 0., -1., 1.")],
            "a = -1, rate = 1: expected q0 > 0, n > 0, -1 < m <= 0, a >= 0 and rate > 0",
        ),
        (
            [RUBBER, NETWORK.replace("STRAIN\n2., 1., 0.", "BERGSTROM-BOYCE\n2., 1., -0.5")],
            "C = -0.5, E = 0: expected A > 0, m > 0, -1 <= C <= 0, and E > 0 with C < 0",
        ),
        ([RUBBER, NETWORK.replace("STRAIN", "TIME")], "LAW=TIME"),
        ([RUBBER, "*TRS, DEFINITION=USER"], r"\*TRS: expected \*VISCOELASTIC, NONLINEAR before it"),
        ([RUBBER, NETWORK, "*TRS, DEFINITION=ARRHENIUS\n1., 2."], "DEFINITION=ARRHENIUS is not supported"),
    ],
)
def test_errors_of_decks(run_deck, material, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_deck(deck(*material), HERE / "networks.f90")


@pytest.mark.parametrize(
    ("material", "message"),
    [
        (BY_USER.format(way="0."), r"\*VISCOELASTIC, NONLINEAR, LAW=USER: material RUBBER needs UCREEPNETWORK"),
        (NETWORK + "\n*TRS, DEFINITION=USER", r"\*TRS, DEFINITION=USER: material RUBBER needs UTRSNETWORK"),
    ],
)
def test_a_file_without_them(run_deck, material, message):
    with pytest.raises(DeckError, match=message):
        run_deck(deck(RUBBER, material), HERE / "points.f")


def test_linear_perturbations_are_refused(run_deck):
    with pytest.raises(
        DeckError, match=r"\*STATIC, PERTURBATION is not supported for material RUBBER .*: its stresses depend on time"
    ):
        run_deck(
            deck(RUBBER, NETWORK)
            .replace("*STEP, NLGEOM, INC", "*STEP, NLGEOM, PERTURBATION, INC")
            .replace("*VISCO\n0.1, 1., , 0.1", "*STATIC"),
            HERE / "networks.f90",
        )


def test_it_ends_the_analysis(run_deck):
    with pytest.raises(KernelError, match=r"UCREEPNETWORK at integration point 1 stopped the analysis"):
        run_deck(deck(RUBBER, BY_USER.format(way="1.")), HERE / "networks.f90")


def test_a_shift_that_is_not_positive(run_deck):
    message = r"element 1 \(type C3D8\): .*UTRSNETWORK gives the shifts  2\.000E\+00 and +0\.000E\+00; expected"
    with pytest.raises(KernelError, match=message):
        run_deck(deck(RUBBER, NETWORK, "*TRS, DEFINITION=USER, PROPERTIES=2\n2., 0."), HERE / "networks.f90")


@pytest.mark.parametrize(
    ("way", "text"),
    [
        (2, "element 1: UCREEPNETWORK writes outside OUTPUTDATA: entry 9 of 8 (NOUTPUT) at integration point 1"),
        pytest.param(
            3,
            "element 1: UCREEPNETWORK sets an entry of OUTPUTDATA to NaN or infinity, entry 1,",
            marks=pytest.mark.nan,
        ),
    ],
)
def test_warnings_of_mistakes(run_deck, tmp_path, way, text):
    try:
        run_deck(deck(RUBBER, BY_USER.format(way=f"{way}.")), HERE / "networks.f90")
    except uel.errors.UelError:
        assert way == 3
    assert text in " ".join((tmp_path / "deck.msg").read_text().split())
