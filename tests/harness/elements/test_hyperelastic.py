# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*HYPERELASTIC: closed forms of homogeneous deformations, forces as derivatives of the energy, decks, errors."""

import re
from pathlib import Path

import numpy as np
import pytest
from differences import check_energy
from moving_element import CUBE, EIGHT, NODES, SQUARE, MovingElement, turn
from scipy.optimize import brentq
from small_decks import body_lines

from uel.deck import read_deck
from uel.elements import build_blocks
from uel.elements.materials.hyperelastic import initial_moduli
from uel.errors import DeckError, Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import Elastic, ElasticType, Hyperelastic, Material, Potential, SectionControls, SolidSection
from uel.report import report

SOURCE = Source("test.inp", 1)
D = 0.4


def law(potential, *coefficients, order=1, compliances=(D,)):
    return Hyperelastic(potential, order, coefficients, compliances, SOURCE)


NEO_HOOKE = law(Potential.NEO_HOOKE, 0.7)
MOONEY = law(Potential.MOONEY_RIVLIN, 0.5, 0.2)
YEOH = law(Potential.YEOH, 0.6, -0.02, 0.003, order=3, compliances=(D, 0.9, 0.0))
POLYNOMIAL = law(Potential.POLYNOMIAL, 0.5, 0.2, 0.03, 0.02, 0.01, order=2, compliances=(D, 0.7))
# three terms as those of R.W. Ogden, Proceedings of the Royal Society A 326 (1972) 565, whose mu alpha / 2 is mu here
OGDEN = law(Potential.OGDEN, 0.4095, 1.3, 0.003, 5.0, 0.01, -2.0, order=3, compliances=(D, 0.0, 0.0))
CHAINS = law(Potential.ARRUDA_BOYCE, 0.9, 2.3)
LAWS = {str(one.potential): one for one in (NEO_HOOKE, MOONEY, YEOH, POLYNOMIAL, OGDEN, CHAINS)}


def slopes(one, i1, i2):
    """Derivatives of W by I1 and I2, of laws in invariants."""
    x, y, c = i1 - 3, i2 - 3, one.coefficients
    match one.potential:
        case Potential.NEO_HOOKE:
            return c[0], 0.0
        case Potential.MOONEY_RIVLIN:
            return c
        case Potential.YEOH:
            return c[0] + 2 * c[1] * x + 3 * c[2] * x**2, 0.0
        case Potential.POLYNOMIAL:
            return c[0] + 2 * c[2] * x + c[3] * y, c[1] + c[3] * x + 2 * c[4] * y
        case _:
            # Arruda and Boyce 1993, equation (14)
            chain = (1 / 2, 1 / 10, 33 / 1050, 76 / 7000, 2595 / 673750)
            return c[0] * sum(a * (i1 / c[1] ** 2) ** k for k, a in enumerate(chain)), 0.0


def powers(one):
    return list(zip(one.coefficients[::2], one.coefficients[1::2], strict=True))


@pytest.fixture
def element(bound, load, call):
    def element(one, element_type="C3D8", nodes=None, *, material=None, **options):
        nodes = NODES.get(element_type, SQUARE) if nodes is None else nodes
        material = material or Material("M", SOURCE, hyperelastic=one)
        if element_type in ("C3D8R", "CAX4R", "CPE4R"):
            options.setdefault("hourglass", 0.01)
        section = SolidSection("ALL", material, None, 1.0, SOURCE, **options)
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        return MovingElement(*bound(group, nodes, load(None)), nodes, call)

    return element


def stress_of(solid):
    """Stress (3, 3) of the first point, after all points are found to have the same."""
    values = solid.values()
    n = values.shape[1] // 2
    np.testing.assert_allclose(values[:, n:], values[[0] * len(values), n:], atol=1e-12)
    xx, yy, zz, xy, *rest = values[0, n:]
    xz, yz = rest or (0.0, 0.0)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("stretch", [0.6, 1.3, 2.5])
def test_uniaxial_tension(element, name, stretch):
    """Differences at constant volume (R.S. Rivlin, Philosophical Transactions A 241 (1948) 379; Ogden 1972)."""
    one, solid = LAWS[name], element(LAWS[name])
    solid.move(np.diag([stretch, stretch**-0.5, stretch**-0.5]))
    found = stress_of(solid)
    if name == "OGDEN":
        expected = sum(2 * mu / a * (stretch**a - stretch ** (-a / 2)) for mu, a in powers(one))
    else:
        first, second = slopes(one, stretch**2 + 2 / stretch, 2 * stretch + stretch**-2)
        expected = 2 * (stretch**2 - 1 / stretch) * (first + second / stretch)
    assert found[0, 0] - found[1, 1] == pytest.approx(expected, rel=1e-10)
    assert np.trace(found) == pytest.approx(0, abs=1e-10)


@pytest.mark.parametrize("name", LAWS)
def test_equibiaxial_tension(element, name):
    """The same in two directions."""
    one, solid, stretch = LAWS[name], element(LAWS[name]), 1.6
    solid.move(np.diag([stretch, stretch, stretch**-2]))
    found = stress_of(solid)
    if name == "OGDEN":
        expected = sum(2 * mu / a * (stretch**a - stretch ** (-2 * a)) for mu, a in powers(one))
    else:
        first, second = slopes(one, 2 * stretch**2 + stretch**-4, 2 * stretch**-2 + stretch**4)
        expected = 2 * (stretch**2 - stretch**-4) * (first + stretch**2 * second)
    assert found[0, 0] - found[2, 2] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8R", "C3D10", "CPE4", "CPE8R"])
@pytest.mark.parametrize("name", LAWS)
def test_simple_shear(element, name, element_type):
    """S12 = 2 (W1 + W2) gamma with I1 = I2 = 3 + gamma^2, and S11 - S22 = gamma S12 (Rivlin 1948)."""
    nodes = EIGHT if element_type == "CPE8R" else None
    one, solid, shear = LAWS[name], element(LAWS[name], element_type, nodes), 0.8
    solid.move(np.array([[1, shear, 0], [0, 1, 0], [0, 0, 1.0]]))
    found = stress_of(solid)
    if name == "OGDEN":
        # stretches l and 1/l with l - 1/l = gamma; their dyads have s12 = l/(l^2 + 1)
        stretch = shear / 2 + np.sqrt(1 + shear**2 / 4)
        modulus = sum(2 * mu / a * (stretch**a - stretch**-a) for mu, a in powers(one)) * stretch / (stretch**2 + 1)
    else:
        modulus = 2 * sum(slopes(one, 3 + shear**2, 3 + shear**2)) * shear
    assert found[0, 1] == pytest.approx(modulus, rel=1e-10)
    assert found[0, 0] - found[1, 1] == pytest.approx(shear * modulus, rel=1e-10)


@pytest.mark.parametrize("element_type", ["C3D8", "C3D4", "CAX4", "CPE4"])
def test_confined_compression(element, element_type):
    """neo-Hooke, F = diag(1, l, 1): dev B is (l^2 - 1) diag(-1, 2, -1)/3 (Abaqus Theory Guide)."""
    j = 0.7
    solid = element(NEO_HOOKE, element_type)
    solid.move(np.diag([1, j, 1]))
    shape = 2 * 0.7 * j ** (-5 / 3) * (j**2 - 1) / 3
    expected = np.diag([-shape, 2 * shape, -shape]) + 2 / D * (j - 1) * np.eye(3)
    np.testing.assert_allclose(stress_of(solid), expected, atol=1e-12)


@pytest.mark.parametrize(
    ("one", "pressure"),
    [
        (YEOH, lambda j: 2 / D * (j - 1) + 4 / 0.9 * (j - 1) ** 3),
        (CHAINS, lambda j: (j - 1 / j) / D),
        (OGDEN, lambda j: 2 / D * (j - 1)),
    ],
)
def test_change_of_volume(element, one, pressure):
    """U' of the potentials of Abaqus; a D of zero after the first has no term."""
    for j in (0.6, 1.7):
        solid = element(one)
        solid.move(np.eye(3) * j ** (1 / 3))
        np.testing.assert_allclose(stress_of(solid), pressure(j) * np.eye(3), atol=1e-12)


DEFORMED = {
    "none": np.eye(3),
    "three": np.array([[1.3, 0.2, 0.1], [0.05, 0.8, -0.1], [0.0, 0.3, 1.1]]),
    "equal": turn(0.4) @ np.diag([1.2, 0.9, 1.2]) @ turn(0.3),
    "close": np.diag([1.2, 1.2 + 1e-6, 0.9]) @ turn(0.3),
    "near": np.diag([1.2, 1.2 + 1e-3, 0.9]) @ turn(0.3),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("shape", DEFORMED)
def test_tangent_is_the_derivative_of_the_forces(element, name, shape):
    """Along x -> A x, also where stretches are equal or nearly so."""
    solid = element(LAWS[name])
    solid.move(DEFORMED[shape])
    solid.evaluate(solid.u)
    tangent, step = solid.matrix.toarray(), 1e-6
    now = solid.nodes + solid.u.reshape(-1, 3)
    for a in np.eye(9).reshape(-1, 3, 3):
        d = (now @ a.T).ravel()
        slope = (solid.evaluate(solid.u - step * d)[0] - solid.evaluate(solid.u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, tangent @ d, atol=1e-7 * abs(tangent).max())


@pytest.mark.parametrize(
    "element_type", ["C3D8", "C3D10", "C3D20R", "C3D6", "CPE4", "CPE8", "CPE3", "CAX4", "CAX8", "CAX3"]
)
def test_forces_and_tangent_of_any_displacements(element, element_type):
    """Forces are derivatives of ENERGY(2), and the tangent theirs."""
    nodes = EIGHT if element_type == "CPE8" else NODES.get(element_type, SQUARE)
    if element_type.startswith("CAX"):
        nodes = nodes + np.array([1.0, 0, 0])
    solid = element(POLYNOMIAL, element_type, nodes)
    assert check_energy(solid).energy[3] == 0


@pytest.mark.parametrize("element_type", ["C3D8R", "CAX4R", "CPE4R"])
@pytest.mark.parametrize("shape", [[1.5, 0.9, 1], [0.9, 0.9, 0.9]])
def test_tangent_of_one_point_has_the_change_of_the_mean_volume(element, element_type, shape):
    """For any displacements, hourglass modes too, from a uniform deformation."""
    f = np.diag(shape)
    if element_type.startswith("CAX"):
        f[2, 2] = f[0, 0]
    nodes = NODES.get(element_type, SQUARE) + np.array([1.0, 0, 0])
    solid = element(NEO_HOOKE, element_type, nodes)
    solid.move(f)
    solid.evaluate(solid.u)
    tangent, step = solid.matrix.toarray(), 1e-6
    for d in np.eye(solid.u.size):
        slope = (solid.evaluate(solid.u - step * d)[0] - solid.evaluate(solid.u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, tangent @ d, atol=1e-7 * abs(tangent).max())


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8R", "C3D10", "CPE4"])
def test_rotation_turns_stress_and_forces(element, element_type):
    stretch = np.array([[1.3, 0.2, 0], [0.1, 0.8, 0], [0, 0, 1]])
    straight, turned, rotation = element(MOONEY, element_type), element(MOONEY, element_type), turn(2.0)
    forces, before = straight.move(stretch)
    found, after = turned.move(rotation @ stretch)
    np.testing.assert_allclose(stress_of(turned), rotation @ stress_of(straight) @ rotation.T, atol=1e-11)
    np.testing.assert_allclose(found, forces @ rotation[: forces.shape[1], : forces.shape[1]].T, atol=1e-11)
    np.testing.assert_allclose(after.energy, before.energy, atol=1e-12)
    none, _ = element(MOONEY, element_type).move(rotation)
    np.testing.assert_allclose(none, 0, atol=1e-12)


def test_energy_is_that_of_the_initial_volume(element):
    """neo-Hooke: V (C10 (I1 - 3) + (J - 1)^2/D) with the invariant less the change of volume; nothing is dissipated."""
    f = np.array([[1.3, 0.2, 0.1], [0.1, 0.8, 0], [0, 0.2, 1]])
    solid, j = element(NEO_HOOKE, "C3D8", 2 * CUBE), np.linalg.det(f)
    _, report = solid.move(f)
    w = 0.7 * (np.trace(f @ f.T) * j ** (-2 / 3) - 3) + (j - 1) ** 2 / D
    assert report.energy[1] == pytest.approx(8 * w, rel=1e-12)
    assert report.energy[3] == 0


@pytest.mark.parametrize("element_type", ["C3D8R", "CPE4R"])
def test_enhanced_hourglass_control_has_the_initial_moduli(element, element_type):
    """It is that of an elastic element with the same moduli, for a small hourglass mode."""
    shear, bulk = initial_moduli(MOONEY)
    young, nu = 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    elastic = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (young, nu), SOURCE))
    nodes, controls = NODES.get(element_type, SQUARE), SectionControls(enhanced=True)
    mode = np.zeros((len(nodes), 2 if element_type == "CPE4R" else 3))
    mode[:, 0] = 1e-7 * np.array([1, -1, 1, -1, -1, 1, -1, 1])[: len(nodes)]
    found, _ = element(MOONEY, element_type, controls=controls, hourglass=0.0).evaluate(mode.ravel())
    options = {"material": elastic, "controls": controls, "hourglass": 0.0}
    expected, _ = element(None, element_type, **options).evaluate(mode.ravel())
    assert abs(expected).max() > 0
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5 * abs(expected).max())
    # the default with these materials (Abaqus Keywords Guide, *SECTION CONTROLS)
    by_default, _ = element(MOONEY, element_type, hourglass=0.0).evaluate(mode.ravel())
    np.testing.assert_array_equal(by_default, found)


def test_initial_moduli_of_arruda_and_boyce():
    """Analysis User's Guide: mu0 = mu (1 + 3/5 a + 99/175 a^2 + 513/875 a^3 + 42039/67375 a^4), a = 1/lambda_m^2."""
    a = 2.3**-2
    shear = 0.9 * (1 + 3 / 5 * a + 99 / 175 * a**2 + 513 / 875 * a**3 + 42039 / 67375 * a**4)
    assert initial_moduli(CHAINS) == pytest.approx((shear, 2 / D), rel=1e-12)


def test_too_large_stretches_ask_for_a_smaller_increment(bound, load, call):
    library = load(None)
    material = Material("M", SOURCE, hyperelastic=law(Potential.OGDEN, 1.0, 200.0))
    section = SolidSection("ALL", material, None, 1.0, SOURCE)
    group = ElementGroup("C3D8", np.array([1]), np.arange(8)[None], "", section, None, SOURCE)
    solid = MovingElement(*bound(group, CUBE, library), CUBE, call)
    u = (CUBE @ (np.diag([5.0, 1, 1]) - np.eye(3))).ravel()
    _, report = solid.evaluate(u)
    assert report.pnewdt == 0.25
    texts = [message.text for message in library.messages()]
    assert any(
        "*HYPERELASTIC: the stretches are too large for numbers at integration point 1" in text for text in texts
    )


RUBBER = "*HYPERELASTIC, NEO HOOKE\n0.7, 0.05"


def deck(keyword, *, element_type="C3D8", step="*STEP, NLGEOM", more="", section=""):
    """A unit cube that is pulled to twice its length and free to the sides; plane types have one of its faces."""
    lines = body_lines(element_type, CUBE, [range(8 if element_type.startswith("C3D") else 4)])
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{section}", "1.", "*MATERIAL, NAME=M", keyword, more, step]
    lines += ["*STATIC", "0.25, 1., 1e-4, 0.25", "*CONTROLS, PARAMETERS=FIELD", "1e-9, 1e-9"]
    lines += ["*BOUNDARY", "1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2", "2, 3", "3, 3", "4, 3"]
    lines += [f"{node}, 1, 1, 1." for node in (2, 3, 6, 7)]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF", "*ENERGY OUTPUT", "*END STEP"]
    return "\n".join(line for line in lines if line) + "\n"


@pytest.mark.parametrize("element_type", ["C3D8", "C3D8R", "oriented"])
def test_a_pulled_cube(run_deck, element_type):
    """neo-Hooke with free sides: the side stretch t makes S22 = 0; the force is S11 t^2 and ALLSE is W."""
    more, section = "", ""
    if element_type == "C3D8R":
        section, more = ", CONTROLS=C", "*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED"
    elif element_type == "oriented":
        element_type, section = "C3D8", ", ORIENTATION=O"
        more = "*ORIENTATION, NAME=O\n0.6, 0.8, 0., -0.8, 0.6, 0."
    history = run_deck(deck(RUBBER, element_type=element_type, more=more, section=section)).history
    c, d, stretch = 0.7, 0.05, 2.0

    def stresses(side):
        j = stretch * side**2
        shape = 2 * c * j ** (-5 / 3) * (stretch**2 - side**2) / 3
        return 2 * shape + 2 / d * (j - 1), -shape + 2 / d * (j - 1)

    side = brentq(lambda t: stresses(t)[1], 0.5, 1.0, xtol=1e-14)
    j = stretch * side**2
    force = sum(history[f"RF1[ALL:{k}]"][-1] for k in (2, 3, 6, 7))
    assert force == pytest.approx(stresses(side)[0] * side**2, rel=1e-6)
    assert history["U2[ALL:3]"][-1] == pytest.approx(side - 1, rel=1e-6)
    energy = c * ((stretch**2 + 2 * side**2) * j ** (-2 / 3) - 3) + (j - 1) ** 2 / d
    assert history["ALLSE"][-1] == pytest.approx(energy, rel=1e-6)
    assert history["ALLPD"][-1] == 0


def test_page_of_the_job_has_the_coefficients(run_deck, tmp_path):
    run_deck(deck("*HYPERELASTIC, MOONEY-RIVLIN\n0.5, 0.25, 0.125"))
    page = report(tmp_path / "deck").read_text("utf-8")
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", page)
    rows = [cells[k : k + 3] for k, cell in enumerate(cells) if cell in ("coefficient 1", "coefficient 2", "D1")]
    kind = "*HYPERELASTIC, MOONEY-RIVLIN, N=1"
    assert rows == [["coefficient 1", "0.5", kind], ["coefficient 2", "0.25", ""], ["D1", "0.125", ""]]


def constants(path, keyword):
    path.write_text(deck(keyword))
    (group,) = read_deck(path).groups
    return group.section.material.hyperelastic


@pytest.mark.parametrize(
    ("keyword", "potential", "coefficients", "compliances"),
    [
        ("*HYPERELASTIC\n1., 2., 3.", "POLYNOMIAL", (1, 2), (3,)),
        ("*Hyperelastic, neo hooke\n1., 2.", "NEO HOOKE", (1,), (2,)),
        ("*HYPERELASTIC, MOONEY-RIVLIN\n1., 2., 3., 20.", "MOONEY-RIVLIN", (1, 2), (3,)),
        ("*HYPERELASTIC, YEOH, MODULI=LONG TERM\n1., 2., 3., 4.", "YEOH", (1, 2, 3), (4, 0, 0)),
        ("*HYPERELASTIC, REDUCED POLYNOMIAL, N=2\n1., , 3., 4.", "REDUCED POLYNOMIAL", (1, 0), (3, 4)),
        ("*HYPERELASTIC, ARRUDA-BOYCE\n1., 2., 3.", "ARRUDA-BOYCE", (1, 2), (3,)),
        ("*HYPERELASTIC, OGDEN, N=3\n1., 2., 3., 4., 5., 6., 7., 8.\n9.", "OGDEN", (1, 2, 3, 4, 5, 6), (7, 8, 9)),
        (
            "*HYPERELASTIC, N=3\n1., 2., 3., 4., 5., 6., 7., 8.\n9., 10., 11., 12., 20.",
            "POLYNOMIAL",
            tuple(range(1, 10)),
            (10, 11, 12),
        ),
    ],
)
def test_data_lines(tmp_path, keyword, potential, coefficients, compliances):
    """Abaqus Keywords Guide, *HYPERELASTIC; a temperature after the only set is none of the constants."""
    found = constants(tmp_path / "deck.inp", keyword)
    assert (found.potential, found.coefficients, found.compliances) == (potential, coefficients, compliances)


ERRORS = [
    ("*HYPERELASTIC, YEOH, OGDEN\n1.", {}, r"OGDEN and YEOH: expected one strain energy potential"),
    ("*HYPERELASTIC, YEOH, N=2\n1.", {}, r"N=2: YEOH has N=3"),
    ("*HYPERELASTIC, OGDEN, N=7\n1.", {}, r"N=7: expected a number from 1 to 6"),
    ("*HYPERELASTIC", {}, r"needs a data line with the coefficients"),
    ("*HYPERELASTIC, NEO HOOKE\n1., 2., 20.\n1., 2., 30.", {}, r"11 values, but NEO HOOKE, N=1 has 2; dependence on"),
    ("*HYPERELASTIC, NEO HOOKE\n1.", {}, r"D1 = 0 is not supported .*; supported: hybrid elements"),
    ("*HYPERELASTIC, NEO HOOKE\n1., -1.", {}, r"D = -1 must not be negative"),
    ("*HYPERELASTIC, NEO HOOKE\n-1., 1.", {}, r"the initial shear modulus -2 must be positive"),
    ("*HYPERELASTIC, OGDEN\n1., 0., 1.", {}, r"alpha = 0: expected another number"),
    ("*HYPERELASTIC, ARRUDA-BOYCE\n1., 0., 1.", {}, r"lambda_m = 0 must be positive"),
    ("*HYPERELASTIC, MARLOW", {}, r"option MARLOW is not supported"),
    (
        RUBBER,
        {"step": "*STEP"},
        r"\*STATIC is not supported for material M with \*HYPERELASTIC .*; supported with NLGEOM",
    ),
    (RUBBER, {"element_type": "CPS4"}, r"\*HYPERELASTIC is not supported for elements of type CPS4"),
    (
        RUBBER,
        {"element_type": "C3D8R", "section": ", CONTROLS=C", "more": "*SECTION CONTROLS, NAME=C, HOURGLASS=STIFFNESS"},
        r"C3D8R with \*HYPERELASTIC need HOURGLASS=ENHANCED of \*SECTION CONTROLS, or \*HOURGLASS STIFFNESS",
    ),
    (RUBBER, {"element_type": "CPS4I"}, r"\*HYPERELASTIC is not supported for elements of type CPS4I"),
    (
        RUBBER,
        {"more": "*INITIAL CONDITIONS, TYPE=STRESS\nBODY, 1., 0., 0., 0., 0., 0."},
        r"TYPE=STRESS beside \*HYPERELASTIC is not supported .*\(material M",
    ),
    (
        RUBBER,
        {"more": "*ELASTIC\n1., 0."},
        r"\*HYPERELASTIC beside \*ELASTIC.* is not supported .*; expected only one of them",
    ),
    (
        RUBBER,
        {"more": "*EXPANSION, TYPE=ORTHO\n1e-5, 0., 0."},
        r"\*HYPERELASTIC beside \*EXPANSION .*expected TYPE=ISO",
    ),
    (
        RUBBER,
        {"more": "*VISCOELASTIC, NONLINEAR, NETWORKID=1, SRATIO=0.5, LAW=STRAIN\n0.1, 1., 0.\n*EXPANSION\n1e-5"},
        r"\*VISCOELASTIC, NONLINEAR beside \*EXPANSION is not supported",
    ),
]


@pytest.mark.parametrize(("keyword", "options", "message"), ERRORS)
def test_errors_of_decks(run_deck, keyword, options, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_deck(deck(keyword, **options))


def test_user_elements_do_not_have_it(user_group, bound, load):
    """They need the deformation gradient, which MATERIAL_LIB_MECH does not take."""
    material = Material("M", SOURCE, hyperelastic=NEO_HOOKE)
    dofs = tuple((node, dof) for node in range(4) for dof in (1, 2))
    group = user_group(np.arange(4)[None], dofs, material=material, tensor="PSTRAIN", integration=4)
    with pytest.raises(DeckError, match=r"test\.inp:1: \*HYPERELASTIC is not supported for user elements"):
        bound(group, SQUARE, load("point.f"))


@pytest.mark.parametrize(("one", "count"), [(law(Potential.NEO_HOOKE, 0.5, compliances=(0.01,)), 1), (NEO_HOOKE, 0)])
def test_a_stiff_volume_gives_a_warning(load, one, count):
    """Abaqus Materials Guide: K0/mu0 above 100 needs hybrid elements."""
    library = load(None)
    section = SolidSection("ALL", Material("M", SOURCE, hyperelastic=one), None, 1.0, SOURCE)
    group = ElementGroup("C3D8", np.array([1]), np.arange(8)[None], "", section, None, SOURCE)
    build_blocks(Model(Path("test.inp"), "", Mesh(np.arange(1, 9), CUBE, ("",) * 8), (group,), ()), library)
    texts = [message.text for message in library.messages()]
    assert len(texts) == count
    wanted = (
        "test.inp:1: *HYPERELASTIC: the initial bulk modulus is 200 times the shear modulus; Abaqus stops above 100"
    )
    assert all(wanted in text for text in texts)
