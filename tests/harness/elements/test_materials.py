# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""MATERIAL_LIB_MECH: stiffness of every *ELASTIC type, and the return mapping of *PLASTIC."""

import math

import numpy as np
import pytest
from material_point import COMPONENTS

from uel.errors import DeckError, KernelError, Source
from uel.model.properties import Elastic, ElasticType, Material, Orientation, Plastic

ELASTIC_LINE = Source("deck.inp", 12)
SECTION_LINE = Source("test.inp", 7)
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
E, NU, G = 200e3, 0.3, 200e3 / 2.6
ISOTROPIC = Elastic(ElasticType.ISOTROPIC, (E, NU), ELASTIC_LINE)
PLY = Elastic(
    ElasticType.ENGINEERING_CONSTANTS, (1.2e5, 1.05e4, 9e3, 0.3, 0.28, 0.5, 5.5e3, 5.2e3, 3.4e3), ELASTIC_LINE
)
TABLE = np.array([[250.0, 0.0], [300.0, 0.01], [330.0, 0.05]])
RNG = np.random.default_rng(3)


@pytest.fixture
def point(material_point):
    def point(elastic, tensor, *, table=None, axes=None, **options):
        plastic = None if table is None else Plastic(table, Source("deck.inp", 15))
        orientation = None if axes is None else Orientation("TURNED", axes, SECTION_LINE)
        material = Material("M", Source("deck.inp", 10), elastic, plastic)
        return material_point(material, tensor, orientation=orientation, **options)

    return point


def uniaxial(stress, direction, elastic):
    """Strains of a stress in one material direction, from the definition of engineering constants."""
    e, nu = elastic.constants[0:3], elastic.constants[3:6]
    ratio = {(0, 1): nu[0], (0, 2): nu[1], (1, 2): nu[2]}
    strain = np.zeros(6)
    for other in range(3):
        if other == direction:
            strain[other] = stress / e[direction]
        elif (direction, other) in ratio:
            strain[other] = -ratio[direction, other] * stress / e[direction]
        else:
            # nu_ji/E_j = nu_ij/E_i
            strain[other] = -ratio[other, direction] * stress / e[other]
    return strain


def test_engineering_constants_in_three_dimensions(point):
    respond = point(PLY, "THREED")
    for direction in range(3):
        stress, _ = respond(uniaxial(100.0, direction, PLY))
        np.testing.assert_allclose(stress, 100.0 * np.eye(6)[direction], atol=1e-11)
    for shear in range(3):
        stress, tangent = respond(0.01 * np.eye(6)[3 + shear])
        np.testing.assert_allclose(stress, 0.01 * PLY.constants[6 + shear] * np.eye(6)[3 + shear], atol=1e-11)
        np.testing.assert_allclose(tangent[:, 3 + shear], stress / 0.01)


def test_engineering_constants_in_plane_stress(point):
    respond = point(PLY, "PSTRESS")
    for direction in range(2):
        stress, _ = respond(uniaxial(100.0, direction, PLY)[[0, 1, 3]])
        np.testing.assert_allclose(stress, 100.0 * np.eye(3)[direction], atol=1e-11)


@pytest.mark.parametrize("tensor", ["PSTRAIN", "TWOD"])
def test_plane_strain_is_a_part_of_three_dimensions(point, tensor):
    _, solid = point(PLY, "THREED")(np.zeros(6))
    _, plane = point(PLY, tensor)(np.zeros(4))
    np.testing.assert_allclose(plane, solid[:4, :4], rtol=1e-12)


def test_lamina(point):
    """E1, E2, nu12, G12, G13, G23, and the stiffness of a ply (Jones, Mechanics of Composite Materials)."""
    e1, e2, nu12, g12 = 1.2e5, 1.05e4, 0.3, 5.5e3
    _, tangent = point(Elastic(ElasticType.LAMINA, (e1, e2, nu12, g12, 5e3, 4e3), ELASTIC_LINE), "PSTRESS")(np.zeros(3))
    nu21 = nu12 * e2 / e1
    q = np.array([[e1, nu12 * e2, 0], [nu21 * e1, e2, 0], [0, 0, g12 * (1 - nu12 * nu21)]]) / (1 - nu12 * nu21)
    np.testing.assert_allclose(tangent, q, rtol=1e-12, atol=1e-9)


def test_orthotropic_and_anisotropic_constants(point):
    """Data lines as in the Abaqus manual: D1111, D1122, D2222, D1133, D2233, D3333, ...; pairs 11 22 33 12 13 23."""
    _, d = point(PLY, "THREED")(np.zeros(6))
    orthotropic = (d[0, 0], d[0, 1], d[1, 1], d[0, 2], d[1, 2], d[2, 2], d[3, 3], d[4, 4], d[5, 5])
    _, found = point(Elastic(ElasticType.ORTHOTROPIC, orthotropic, ELASTIC_LINE), "THREED")(np.zeros(6))
    np.testing.assert_allclose(found, d, rtol=1e-10, atol=1e-8)
    root = RNG.normal(size=(6, 6))
    d = root @ root.T + np.eye(6)
    order = "1111 1122 2222 1133 2233 3333 1112 2212 3312 1212 1113 2213 3313 1213 1313 1123 2223 3323 1223 1323 2323"
    index = {"11": 0, "22": 1, "33": 2, "12": 3, "13": 4, "23": 5}
    constants = tuple(d[index[name[:2]], index[name[2:]]] for name in order.split())
    _, found = point(Elastic(ElasticType.ANISOTROPIC, constants, ELASTIC_LINE), "THREED")(np.zeros(6))
    np.testing.assert_allclose(found, d, rtol=1e-9)


def test_orientation_in_three_dimensions(point):
    """Against the rotation of the stiffness as a tensor of fourth order."""
    axes, _ = np.linalg.qr(RNG.normal(size=(3, 3)))
    _, local = point(PLY, "THREED")(np.zeros(6))
    tensor = np.zeros((3, 3, 3, 3))
    for a, (i, j) in enumerate(PAIRS):
        for b, (k, m) in enumerate(PAIRS):
            for p, q in ((i, j), (j, i)):
                for r, s in ((k, m), (m, k)):
                    tensor[p, q, r, s] = local[a, b]
    turned = np.einsum("ai,bj,ck,dl,abcd->ijkl", axes, axes, axes, axes, tensor)
    expected = np.array([[turned[i, j, k, m] for k, m in PAIRS] for i, j in PAIRS])
    _, found = point(PLY, "THREED", axes=axes)(np.zeros(6))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-6)


def test_orientation_of_90_degrees_exchanges_the_directions(point):
    axes = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    _, straight = point(PLY, "PSTRESS")(np.zeros(3))
    _, turned = point(PLY, "PSTRESS", axes=axes)(np.zeros(3))
    np.testing.assert_allclose(turned, straight[np.ix_([1, 0, 2], [1, 0, 2])], rtol=1e-12, atol=1e-9)


def test_orientation_out_of_the_plane(point):
    axes = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    with pytest.raises(
        DeckError, match=r"test\.inp:7: \*ORIENTATION, NAME=TURNED: direction 3 must be normal to the plane"
    ):
        point(PLY, "PSTRAIN", axes=axes)


def test_young_modulus_alone(point):
    _, tangent = point(Elastic(ElasticType.ISOTROPIC, (E,), ELASTIC_LINE), "PSTRESS")(np.zeros(3))
    np.testing.assert_allclose(tangent, np.diag([E, E, E / 2]), rtol=1e-14)


@pytest.mark.parametrize(
    "elastic_type, constants, tensor, message",
    [
        (ElasticType.ISOTROPIC, (0.0, 0.3), "THREED", "E = 0, nu = 0.3: expected E > 0 and -1 < nu <= 0.5"),
        (
            ElasticType.ISOTROPIC,
            (1.0, 0.5),
            "PSTRAIN",
            "nu = 0.5 is not supported for user elements .*; supported: hybrid elements",
        ),
        (ElasticType.ISOTROPIC, (1.0, 0.3, 5.0), "THREED", "TYPE=ISOTROPIC needs 2 constants, found 3"),
        (ElasticType.LAMINA, (1.0, 1.0, 0.3, 1.0, 1.0, 1.0), "PSTRAIN", "TYPE=LAMINA is for plane stress only"),
        (ElasticType.LAMINA, (1.0, 1.0, 1.3, 1.0, 1.0, 1.0), "PSTRESS", "TYPE=LAMINA: the stiffness is not positive"),
        (
            ElasticType.ENGINEERING_CONSTANTS,
            (1.0,) * 8,
            "THREED",
            "TYPE=ENGINEERING CONSTANTS needs 9 constants, found 8",
        ),
        (
            ElasticType.ENGINEERING_CONSTANTS,
            (1.0, 1, 1, 0.9, 0.9, 0.9, 1, 1, 1),
            "PSTRESS",
            "TYPE=ENGINEERING CONSTANTS: the stiffness is not positive definite",
        ),
        (
            ElasticType.ENGINEERING_CONSTANTS,
            (1.0, 1, 1, 0.3, 0.3, 0.3, 1, -2, 1),
            "PSTRESS",
            "TYPE=ENGINEERING CONSTANTS: moduli must be positive, found -2",
        ),
        (
            ElasticType.ORTHOTROPIC,
            (1.0, 2, 1, 0, 0, 1, 1, 1, 1),
            "THREED",
            "TYPE=ORTHOTROPIC: the stiffness is not pos",
        ),
        (
            ElasticType.ENGINEERING_CONSTANTS,
            (9e18, 100.0, 100.0, 0.3, 0.0, 0.0, 50.0, 50.0, 50.0),
            "PSTRESS",
            r": the stiffest response is 2e\+17 times the softest; the largest usable ratio is 1e\+13",
        ),
        (ElasticType.ANISOTROPIC, (1.0,) * 21, "THREED", "TYPE=ANISOTROPIC: the stiffness is not positive definite"),
    ],
)
def test_bad_constants_name_the_line(point, elastic_type, constants, tensor, message):
    with pytest.raises(DeckError, match=rf"deck\.inp:12: \*ELASTIC.*{message}"):
        point(Elastic(elastic_type, constants, ELASTIC_LINE), tensor)


def test_material_without_elasticity(point):
    with pytest.raises(DeckError, match=r"deck\.inp:10: material M has no \*ELASTIC .*\(section at test\.inp:7\)"):
        point(None, "PSTRESS")


def test_plasticity_needs_isotropic_elasticity(point):
    with pytest.raises(DeckError, match=r"deck\.inp:15: \*PLASTIC beside .*; expected \*ELASTIC, TYPE=ISOTROPIC"):
        point(PLY, "PSTRESS", table=TABLE)


@pytest.mark.parametrize("tensor", ["", "SHELL"])
def test_tensor_is_needed(point, tensor):
    with pytest.raises(
        DeckError, match=r"test\.inp:7: \*USER ELEMENT, TYPE=U1 needs TENSOR=PSTRESS\|PSTRAIN\|TWOD\|THREED"
    ):
        point(ISOTROPIC, tensor)


def hardened(plastic):
    """Yield stress of TABLE at an equivalent plastic strain."""
    return np.interp(plastic, TABLE[:, 1], TABLE[:, 0])


@pytest.mark.parametrize("plastic", [0.002, 0.01, 0.03, 0.2])
@pytest.mark.parametrize("tensor", list(COMPONENTS)[:4])
def test_uniaxial_tension(point, tensor, plastic):
    """One backward Euler step along a uniaxial state is exact: strain = stress/E + plastic strain."""
    stress = hardened(plastic)
    along, across = stress / E + plastic, -NU * stress / E - plastic / 2
    strain = np.array([along, across, across, 0, 0, 0])[COMPONENTS[tensor]]
    found, _ = point(ISOTROPIC, tensor, table=TABLE)(strain)
    np.testing.assert_allclose(found, stress * np.eye(len(strain))[0], atol=1e-9 * stress)


@pytest.mark.parametrize("plastic", [0.002, 0.01, 0.03, 0.2])
@pytest.mark.parametrize("tensor", list(COMPONENTS)[:4])
def test_simple_shear(point, tensor, plastic):
    """Mises: tau = yield/sqrt(3), and the plastic shear strain is sqrt(3) times the equivalent plastic strain."""
    shear = COMPONENTS[tensor].index(3)
    tau = hardened(plastic) / math.sqrt(3)
    strain = (tau / G + math.sqrt(3) * plastic) * np.eye(len(COMPONENTS[tensor]))[shear]
    found, _ = point(ISOTROPIC, tensor, table=TABLE)(strain)
    np.testing.assert_allclose(found, tau * np.eye(len(strain))[shear], atol=1e-10 * tau)


@pytest.mark.parametrize("tensor", list(COMPONENTS)[:4])
def test_below_yield_the_response_is_elastic(point, tensor):
    strain = 1e-4 * RNG.normal(size=len(COMPONENTS[tensor]))
    elastic, plastic = point(ISOTROPIC, tensor)(strain), point(ISOTROPIC, tensor, table=TABLE)(strain)
    np.testing.assert_allclose(plastic[0], elastic[0], rtol=1e-12)
    np.testing.assert_allclose(plastic[1], elastic[1], rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("tensor", list(COMPONENTS)[:4])
def test_consistent_tangent(point, tensor):
    """Against central differences, on a path that is loaded once and turned."""
    respond = point(ISOTROPIC, tensor, table=TABLE)
    n = respond.n
    for _ in range(20):
        first, second = 0.02 * RNG.normal(size=(2, n))
        respond(first)
        respond.block.commit()
        end = first + second
        _, tangent = respond(end, second)
        step = 1e-7
        differences = np.array(
            [(respond(end + h, second + h)[0] - respond(end - h, second - h)[0]) / (2 * step) for h in step * np.eye(n)]
        ).T
        np.testing.assert_allclose(tangent, differences, atol=2e-7 * abs(tangent).max())
        np.testing.assert_allclose(tangent, tangent.T, atol=1e-12 * abs(tangent).max())
        respond.block.commit()


def test_plane_stress_agrees_with_three_dimensions(point):
    """The plane stress return is the solid one at the strain 33 that leaves no stress 33."""
    plane, solid = point(ISOTROPIC, "PSTRESS", table=TABLE), point(ISOTROPIC, "PSTRAIN", table=TABLE)
    for _ in range(10):
        strain = 0.01 * RNG.normal(size=3)
        stress, _ = plane(strain)
        e33 = 0.0
        for _ in range(50):
            found, tangent = solid([strain[0], strain[1], e33, strain[2]])
            e33 -= found[2] / tangent[2, 2]
        np.testing.assert_allclose(found, [stress[0], stress[1], 0, stress[2]], atol=1e-8 * abs(stress).max())


def test_history_is_kept_only_on_commit(point):
    """A cutback forgets the plastic strain; an accepted increment unloads from it elastically."""
    respond = point(ISOTROPIC, "PSTRESS", table=TABLE)
    stress = hardened(0.01)
    loaded = np.array([stress / E + 0.01, -NU * stress / E - 0.005, 0])
    respond(loaded)
    np.testing.assert_allclose(respond([0.5e-3, 0, 0])[0], respond([0.5e-3, 0, 0])[1] @ [0.5e-3, 0, 0], rtol=1e-12)
    respond(loaded)
    respond.block.commit()
    unloaded = np.array([0.01, -0.005, 0])
    np.testing.assert_allclose(respond(unloaded, unloaded - loaded)[0], 0, atol=1e-9 * stress)


@pytest.mark.parametrize("tensor", list(COMPONENTS)[:4])
def test_an_increment_begins_elastically_after_one_with_plastic_strain(point, tensor):
    """Its stress is the yield stress but for rounding, which would choose the tangent otherwise."""
    n = len(COMPONENTS[tensor])
    elastic = point(ISOTROPIC, tensor)(np.zeros(n))[1]
    for strain in 0.02 * np.random.default_rng(4).normal(size=(100, n)):
        respond = point(ISOTROPIC, tensor, table=TABLE)
        stress, tangent = respond(strain)
        assert abs(tangent - elastic).max() > 0.1 * abs(elastic).max()
        respond.block.commit()
        again, tangent = respond(strain, np.zeros(n))
        np.testing.assert_allclose(again, stress, rtol=1e-9, atol=1e-9 * abs(stress).max())
        np.testing.assert_allclose(tangent, elastic, rtol=1e-12, atol=1e-12 * abs(elastic).max())


def test_points_are_counted(point):
    with pytest.raises(KernelError, match=r"element 101 .* NPT = 5 is outside the points that INTEGRATION= declares"):
        point(ISOTROPIC, "PSTRESS", table=TABLE, integers=(5, 0), integration=4)([0, 0, 0])
    point(ISOTROPIC, "PSTRESS", table=TABLE, integers=(4, 0), integration=4)([0, 0, 0])


def test_materiallib_is_passed_on(point):
    with pytest.raises(KernelError, match="the first argument is not the MATERIALLIB that was passed to UELMAT"):
        point(ISOTROPIC, "PSTRESS", integers=(1, 1))([0, 0, 0])


@pytest.mark.nan
def test_a_return_that_is_not_solved_asks_for_a_smaller_increment(point):
    """The trial stress of such a strain overflows when it is squared."""
    respond = point(ISOTROPIC, "PSTRESS", table=TABLE)
    respond([1e200, 0, 0])
    assert respond.report.pnewdt == 0.25
    (message,) = respond.library.messages()
    assert (message.kind, message.element) == ("warning", 101)
    assert message.text == "*PLASTIC: the return to the yield surface does not converge at integration point 1"
