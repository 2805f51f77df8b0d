# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*ANISOTROPIC HYPERELASTIC: HOLZAPFEL and UANISOHYPER_INV against energies in Python, directions, mistakes."""

from pathlib import Path

import numpy as np
import pytest
from differences import check_energy
from moving_element import CUBE, NODES, SQUARE, MovingElement, turn
from small_decks import body_lines

from uel.errors import DeckError, KernelError, Source
from uel.model.mesh import ElementGroup
from uel.model.procedures import Static
from uel.model.properties import Holzapfel, Material, Orientation, SolidSection, UserPotential
from uel.model.steps import Step

HERE = Path(__file__).parent
SOURCE = Source("test.inp", 1)
STEP = Step(1, "Step-1", Static(), SOURCE, nlgeom=True)
C10, D, K1, K2, KAPPA = 0.5, 0.4, 0.8, 0.6, 0.1
DIRECTIONS = np.array([[0.6, 0.8, 0.0], [-0.36, 0.48, 0.8]])
# two families of fibers at 45 degrees about axis 3, and axes of the material that are not the global ones
AXES = turn(0.4).T @ np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
HOLZAPFEL = Holzapfel((C10, D, K1, K2, KAPPA), 2, SOURCE)
GENERAL = UserPotential(np.array([0.5, 0.4, 0.3, 0.7]), SOURCE, directions=2)
LAWS = {"HOLZAPFEL": HOLZAPFEL, "USER": GENERAL}


def energy(law, f, directions):
    """Strain energy per initial volume at F, which may be complex, with the directions in global axes."""
    c = f.T @ f
    j = np.sqrt(np.linalg.det(c)) if np.isrealobj(c) else np.sqrt(determinant(c))
    shape = c * j ** (-2 / 3)
    i1 = np.trace(shape)
    pairs = [(i, k) for k in range(len(directions)) for i in range(k + 1)]
    if law is HOLZAPFEL:
        found = C10 * (i1 - 3) + ((j**2 - 1) / 2 - np.log(j)) / D
        for a in directions:
            strain = KAPPA * (i1 - 3) + (1 - 3 * KAPPA) * (a @ shape @ a - 1)
            if strain.real > 0:
                found += K1 / (2 * K2) * (np.exp(K2 * strain**2) - 1)
        return found
    own, d, mixed, q = law.constants[:4]
    i2 = (i1**2 - np.trace(shape @ shape)) / 2
    found = own * (i1 - 3 + (i2 - 3) / 2) + (j - 1) ** 2 / d
    found += mixed * (i1 - 4 + directions[0] @ shape @ directions[0]) * (j - 1)
    for i, k in pairs:
        a, b = directions[i], directions[k]
        found += q / 2 * ((a @ shape @ b - a @ b) ** 2 + (a @ shape @ shape @ b - a @ b) ** 2)
    return found


def determinant(a):
    """Of a complex matrix, without a factorization."""
    return a[0] @ np.array(
        [
            a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1],
            a[1, 2] * a[2, 0] - a[1, 0] * a[2, 2],
            a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0],
        ]
    )


def nominal_stress(law, f, directions):
    """(3, 3) derivatives of the energy by F, by a complex step."""
    found = np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            moved = f.astype(complex)
            moved[i, k] += 1e-30j
            found[i, k] = energy(law, moved, directions).imag / 1e-30
    return found


@pytest.fixture
def element(bound, load, call):
    def element(law, element_type="C3D8", *, axes=AXES, local=DIRECTIONS):
        nodes = NODES.get(element_type, SQUARE)
        if element_type.startswith("CAX"):
            nodes = nodes + np.array([1.0, 0, 0])
        orientation = None if axes is None else Orientation("O", axes, SOURCE, local=local)
        section = SolidSection("ALL", Material("TISSUE", SOURCE, hyperelastic=law), orientation, 1.0, SOURCE)
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        user = load("fibres.f90") if isinstance(law, UserPotential) else load(None)
        return MovingElement(*bound(group, nodes, user, (STEP,)), nodes, call)

    return element


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("element_type", ["C3D8", "C3D10", "CPE4", "CPE3", "CAX4"])
def test_forces_are_derivatives_of_the_energy(element, law, element_type):
    """And the tangent theirs; in plane elements axis 3 of the material is normal to the plane."""
    axes = AXES if element_type.startswith("C3D") else turn(0.4).T
    check_energy(element(law, element_type, axes=axes))


F = np.array([[1.2, 0.3, -0.1], [0.1, 0.9, 0.2], [-0.2, 0.1, 1.15]])


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_uniform_deformation(element, law):
    """On a path with rotations by 200 degrees: the forces on a face are those of the energy in Python."""
    solid = element(law)
    for share in np.linspace(0.1, 1.0, 10):
        forces, report = solid.move(turn(3.5 * share) @ (np.eye(3) + share * (F - np.eye(3))))
    f, directions = turn(3.5) @ F, DIRECTIONS @ AXES
    stress = nominal_stress(law, f, directions)
    for axis in range(3):
        face = CUBE[:, axis] == 1
        # the residual is minus the force
        np.testing.assert_allclose(-forces[face].sum(axis=0), stress[:, axis], atol=1e-10)
    assert report.energy[1] == pytest.approx(energy(law, f, directions), rel=1e-10)


def test_without_local_directions_they_are_the_axes(element):
    f = turn(0.7) @ F
    forces = {}
    for name, axes, local in (
        ("axes", AXES, np.zeros((0, 3))),
        ("given", AXES, np.eye(3)[:2]),
        ("global", None, None),
        ("turned", np.eye(3), np.eye(3)),
    ):
        forces[name], _ = element(HOLZAPFEL, axes=axes, local=local).move(f)
    np.testing.assert_allclose(forces["axes"], forces["given"], atol=1e-12)
    np.testing.assert_allclose(forces["global"], forces["turned"], atol=1e-12)
    assert abs(forces["axes"] - forces["global"]).max() > 0.01


def test_fibers_take_no_pressure(element):
    """Shortened along both families and kappa = 0: the response of the matrix alone."""
    alone = Holzapfel((C10, D, 0.0, K2, 0.0), 2, SOURCE)
    fibres = Holzapfel((C10, D, K1, K2, 0.0), 2, SOURCE)
    local = np.array([[1.0, 0, 0], [0.8, 0.6, 0]])
    for stretch, same in ((0.8, True), (1.2, False)):
        f = np.diag([stretch, stretch, stretch**-2])
        forces = [element(law, axes=np.eye(3), local=local).move(f)[0] for law in (alone, fibres)]
        assert np.allclose(*forces, atol=1e-12) == same


def deck(keyword, *, element_type="C3D8", more="", orientation="", step="*STEP, NLGEOM", loads=""):
    """A unit cube in four increments."""
    lines = body_lines(element_type, CUBE, [range(8)])
    lines += ["*ORIENTATION, NAME=O" + (orientation or f", LOCAL DIRECTIONS=2\n{POINTS}\n{FIBRES}")]
    lines += [
        "*SOLID SECTION, ELSET=BODY, MATERIAL=TISSUE, ORIENTATION=O",
        "*MATERIAL, NAME=TISSUE",
        keyword,
        more,
        step,
    ]
    lines += ["*STATIC, DIRECT", "0.25, 1.", "*BOUNDARY", "1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2"]
    lines += ["2, 3", "3, 3", "4, 3", *(f"{node}, 1, 1, 0.2" for node in (2, 3, 6, 7)), loads]
    lines += ["*OUTPUT, FIELD", "*ELEMENT OUTPUT", "SDV, S", "*END STEP"]
    return "\n".join(line for line in lines if line) + "\n"


POINTS = "1., 0., 0., 0., 1., 0.\n3, 0."
FIBRES = "3., 4., 0.\n-3., 4., 0."
USER = "*ANISOTROPIC HYPERELASTIC, USER, FORMULATION=INVARIANT, LOCAL DIRECTIONS=2, TYPE=COMPRESSIBLE, PROPERTIES=4\n"
TISSUE = "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL, LOCAL DIRECTIONS=2\n0.5, 0.4, 0.8, 0.6, 0.1"


def test_a_pulled_cube(run_deck):
    """Stress along the pull where the other sides are free: that of the energy in Python."""
    result = run_deck(deck(TISSUE))
    stress = np.array([result.field(f"S{k}")[0] for k in ("11", "22", "33", "12", "13", "23")])
    np.testing.assert_allclose(stress[1:], 0, atol=1e-3 * stress[0])
    _, side, height = 1 + result.field("U")[6]
    f = np.diag([1.2, side, height])
    expected = nominal_stress(HOLZAPFEL, f, np.array([[0.6, 0.8, 0], [-0.6, 0.8, 0]])) @ f.T / np.linalg.det(f)
    np.testing.assert_allclose(stress[:3], np.diag(expected), atol=1e-9)
    assert stress[0] > 0.3


def test_nearly_incompressible_and_incompressible_in_hybrid_elements(run_deck):
    """C3D8H with D = 0 is the limit of small D, whose volume stays in the mean."""
    found = []
    for d in ("0.", "1e-5"):
        result = run_deck(deck(TISSUE.replace("0.4,", f"{d},"), element_type="C3D8H"))
        found.append(result.field("S11")[0])
        _, side, height = 1 + result.field("U")[6]
        assert 1.2 * side * height == pytest.approx(1, abs=1e-4)
    assert found[0] == pytest.approx(found[1], rel=1e-4)


def test_arguments(run_deck):
    """STATEV of the last increment begins with that of the one before; TEMP and FIELDV at the end, FIELDVINC."""
    initial = "*INITIAL CONDITIONS, TYPE="
    more = f"*DEPVAR\n12\n{initial}TEMPERATURE\nALL, 20.\n{initial}FIELD, VARIABLE=1\nALL, 1."
    loads = "*TEMPERATURE\nALL, 60.\n*FIELD, VARIABLE=1\nALL, 3."
    result = run_deck(deck(USER + "0.5, 0.4, 0., 0.7", more=more, loads=loads), HERE / "fibres.f90")
    assert len(result.status) == 4
    found = np.array([result.field(f"SDV{k}")[0] for k in range(1, 13)])
    # one call of each converged increment is kept; two families of fibers have nine invariants
    np.testing.assert_allclose(found, [4, 60, 1, 0, 0, 1, 4, 2, 9, 3, 0.5, 1], rtol=1e-12)


@pytest.mark.parametrize(
    ("keyword", "options", "message"),
    [
        ("*ANISOTROPIC HYPERELASTIC\n1.", {}, "expected either HOLZAPFEL or USER"),
        ("*ANISOTROPIC HYPERELASTIC, USER", {}, "USER needs FORMULATION=INVARIANT"),
        ("*ANISOTROPIC HYPERELASTIC, USER, FORMULATION=STRAIN", {}, "FORMULATION=STRAIN is not supported"),
        (TISSUE.replace("=2", "=4"), {}, "LOCAL DIRECTIONS=4: expected a number from 0 to 3"),
        (
            TISSUE.replace(", LOCAL DIRECTIONS=2", ""),
            {},
            "HOLZAPFEL needs LOCAL DIRECTIONS, the number of fiber families",
        ),
        (TISSUE.replace("=2", "=3"), {}, r"LOCAL DIRECTIONS=3, but \*ORIENTATION O \(.*:\d+\) has 2"),
        (TISSUE.replace("HOLZAPFEL", "HOLZAPFEL, TYPE=COMPRESSIBLE"), {}, "TYPE: expected with USER only"),
        (TISSUE.replace("0.5", "0."), {}, "C10 = 0 must be positive"),
        (TISSUE.replace("0.8", "-1."), {}, "k1 = -1 must not be negative"),
        (TISSUE.replace("0.1", "0.4"), {}, "kappa = 0.4 must be from 0 to 1/3"),
        (TISSUE + ", 20., 1.", {}, "7 values, expected C10, D, k1, k2, kappa; dependence on temperature"),
        (
            TISSUE.replace("0.4", "0."),
            {},
            "with D = 0 is not supported for elements of type C3D8 .*; supported: hybrid elements",
        ),
        (
            USER.replace("TYPE=COMPRESSIBLE, ", "") + "1.",
            {},
            "USER without TYPE=COMPRESSIBLE is not supported for .* C3D8 ",
        ),
        (TISSUE, {"step": "*STEP"}, r"material TISSUE with \*ANISOTROPIC HYPERELASTIC .*; supported with NLGEOM"),
        (
            TISSUE,
            {"more": "*ELASTIC\n1., 0.3"},
            r"\*ANISOTROPIC HYPERELASTIC beside \*ELASTIC, TYPE=ISOTROPIC is not supported",
        ),
        (
            TISSUE,
            {"element_type": "C3D8IH"},
            r"\*ANISOTROPIC HYPERELASTIC .* not supported for elements of type C3D8IH",
        ),
        (TISSUE, {"orientation": f", LOCAL DIRECTIONS=2\n{POINTS}"}, "2 data lines; expected points, a rotation and 2"),
        (
            TISSUE,
            {"orientation": f", LOCAL DIRECTIONS=1\n{POINTS}\n0., 0., 0."},
            "a local direction of length zero",
        ),
    ],
)
def test_errors_of_decks(run_deck, keyword, options, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_deck(deck(keyword, **options), HERE / "fibres.f90")


def test_a_file_without_it(run_deck):
    with pytest.raises(DeckError, match=r"USER: material TISSUE needs UANISOHYPER_INV; .* has UHYPER"):
        run_deck(deck(USER + "1., 1."), HERE / "potential.f90")


def wrong(way):
    return USER.replace("=4", "=5") + f"0.5, 0.4, 0., 0.7, {way}"


def test_it_ends_the_analysis(run_deck):
    message = r"element 1 \(type C3D8\): UANISOHYPER_INV at integration point 1 stopped the analysis"
    with pytest.raises(KernelError, match=message):
        run_deck(deck(wrong(1)), HERE / "fibres.f90")


@pytest.mark.parametrize(
    ("way", "text"),
    [
        (2, "element 1: UANISOHYPER_INV writes outside UI1: entry 10 of 9 (NINV) at integration point 1"),
        pytest.param(
            3, "element 1: UANISOHYPER_INV sets an entry of UA to NaN or infinity, entry 1,", marks=pytest.mark.nan
        ),
    ],
)
def test_its_mistakes_are_told(run_deck, way, text):
    result = run_deck(deck(wrong(way)), HERE / "fibres.f90")
    assert any(text in " ".join(warning.split()) for warning in result.warnings), result.warnings


def test_too_large_for_numbers(run_deck):
    """Stiff fibers in one increment: a smaller one is taken."""
    result = run_deck(deck(TISSUE.replace("0.6, 0.1", "1e6, 0.")).replace("*STATIC, DIRECT\n0.25", "*STATIC\n1."))
    assert "THE STRETCHES ARE TOO LARGE" in result.file(".msg").read_text().upper()
