# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elements with incompatible modes in large displacements: finite strains, materials, bending far from small strains.

What they share with all continuum elements, as patches that are stretched and turned, is in the tests of those.
"""

from pathlib import Path

import numpy as np
import pytest
from differences import check_energy
from hybrid_bodies import grid
from moving_element import CUBE, SQUARE, MovingElement
from reference_cells import patch_of
from small_decks import body_lines

from uel.errors import Source
from uel.model.element_types import CONTINUUM
from uel.model.mesh import ElementGroup
from uel.model.properties import Hyperelastic, Material, Potential, SolidSection

SOURCE = Source("test.inp", 1)
YOUNG, POISSON = 1000.0, 0.3
INCREMENTS = 25
PULLED = ("C3D8I", "CPS4I", "CPE4I", "C3D8IH")


def pulled(element_type, material, stretch, *, more=""):
    """Deck of a distorted patch, on rollers at its low sides and pulled along 1 by its high one."""
    kind = CONTINUUM[element_type]
    nodes, elements = patch_of(kind.family.cell)
    lines = [*body_lines(element_type, nodes, elements), more]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", material]
    for direction in range(kind.dimension):
        low = np.flatnonzero(np.isclose(nodes[:, direction], 0.0)) + 1
        lines += [f"*NSET, NSET=LOW{direction + 1}", *map(str, low)]
    high = np.flatnonzero(np.isclose(nodes[:, 0], 1.0)) + 1
    lines += ["*NSET, NSET=HIGH", *map(str, high), f"*STEP, NLGEOM, INC={INCREMENTS}", "*STATIC, DIRECT"]
    lines += [f"{1 / INCREMENTS}, 1.", "*CONTROLS, PARAMETERS=FIELD", "1e-9, 1.", "*BOUNDARY"]
    lines += [f"LOW{d + 1}, {d + 1}" for d in range(kind.dimension)] + [f"HIGH, 1, 1, {stretch - 1}"]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=HIGH", "RF1", "*OUTPUT, FIELD", "*ELEMENT OUTPUT", "S, LE"]
    return "\n".join([line for line in lines if line] + ["*END STEP", ""])


def force_of(result):
    """Sum of the reactions along 1."""
    return sum(values[-1] for name, values in result.history.items() if name.startswith("RF1["))


@pytest.mark.parametrize("element_type", PULLED)
def test_elements_that_hardly_move(run_deck, element_type):
    """Beside an element of size 1 a strain of 1e-9 is rounded to 1e-7 of itself: no force on modes is left of it."""
    text = pulled(element_type, f"*ELASTIC\n{YOUNG}, {POISSON}", 1 + 1e-9).replace("1e-9, 1.", "5e-3, 1e-2")
    modulus = YOUNG / (1 - POISSON**2) if element_type.startswith("CPE") else YOUNG
    assert force_of(run_deck(text)) == pytest.approx(1e-9 * modulus, rel=1e-5)


@pytest.mark.parametrize("stretch", [1.3, 0.8])
@pytest.mark.parametrize("element_type", PULLED)
def test_force_of_a_large_stretch(run_deck, element_type, stretch):
    """Uniaxial stress E ln l, in plane strain with E/(1 - nu^2) and nu/(1 - nu), on the area l^(-2 nu).

    Strains add up by the lengths in the middle of the increments: 25 of them differ from the logarithm by a twelfth of
    the square of the largest, 2e-5. Plane stress has the thickness by its strain, as in Abaqus.
    """
    result = run_deck(pulled(element_type, f"*ELASTIC\n{YOUNG}, {POISSON}", stretch))
    area, modulus, ratio = 2, YOUNG, POISSON
    if element_type == "CPE4I":
        area, modulus, ratio = 1, YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)
    expected = modulus * np.log(stretch) * stretch ** (-area * ratio)
    assert force_of(result) == pytest.approx(expected, rel=1e-4)
    np.testing.assert_allclose(result.field("S11"), modulus * np.log(stretch), rtol=1e-4)


@pytest.mark.parametrize(
    ("element_type", "plain"), [("CPS4I", "CPS4"), ("CPE4I", "CPE4"), ("C3D8I", "C3D8"), ("C3D8IH", "C3D8H")]
)
@pytest.mark.parametrize("material", ["plastic", "orthotropic"])
def test_uniform_states_need_no_mode(run_deck, element_type, plain, material):
    """The same force as elements without modes, whose tests have theories."""
    laws = {
        "plastic": f"*ELASTIC\n{YOUNG}, {POISSON}\n*PLASTIC\n20., 0.\n60., 1.",
        "orthotropic": "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n900., 300., 200., 0.2, 0.25, 0.3, 150., 120.\n90.",
    }
    turned = "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0." if material == "orthotropic" else ""
    section = "MATERIAL=M, ORIENTATION=O" if turned else "MATERIAL=M"
    forces = [
        force_of(run_deck(pulled(name, laws[material], 1.2, more=turned).replace("MATERIAL=M\n", f"{section}\n", 1)))
        for name in (element_type, plain)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-8)
    assert abs(forces[0]) > 10.0


@pytest.fixture
def rubber(bound, load, call):
    """Element of the neo-Hookean material C10 = 150, D1 = 0.002, distorted."""

    def rubber(element_type):
        material = Material("M", SOURCE, hyperelastic=Hyperelastic(Potential.NEO_HOOKE, 1, (150.0,), (0.002,), SOURCE))
        nodes = (SQUARE if CONTINUUM[element_type].dimension == 2 else CUBE).copy()
        section = SolidSection("ALL", material, None, 1.0, SOURCE)
        group = ElementGroup(element_type, np.array([1]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        return MovingElement(*bound(group, nodes, load(None)), nodes, call)

    return rubber


@pytest.mark.parametrize("element_type", ["CPE4I", "C3D8I"])
def test_hyperelastic_forces_are_derivatives(rubber, element_type):
    """Forces are derivatives of the energy where the modes are in equilibrium; the matrix is theirs."""
    check_energy(rubber(element_type))


# compressible neo-Hookean material by UMAT: J stress = mu (B - 1) + lame ln J
NEO_HOOKE = """      include '{include}'
      dimension b(3,3)
      b = matmul(dfgrd1, transpose(dfgrd1))
      det = dfgrd1(1,1)*(dfgrd1(2,2)*dfgrd1(3,3) - dfgrd1(2,3)*dfgrd1(3,2))
     & - dfgrd1(1,2)*(dfgrd1(2,1)*dfgrd1(3,3) - dfgrd1(2,3)*dfgrd1(3,1))
     & + dfgrd1(1,3)*(dfgrd1(2,1)*dfgrd1(3,2) - dfgrd1(2,2)*dfgrd1(3,1))
      stress = 0
      ddsdde = 0
      do i = 1, 3
        stress(i) = (props(1)*(b(i,i) - 1) + props(2)*log(det))/det
        ddsdde(i,1:3) = props(2)/det
        ddsdde(i,i) = (props(2) + 2*props(1))/det
      end do
      do i = 4, ntens
        ddsdde(i,i) = props(1)/det
      end do
      stress(4) = props(1)*b(1,2)/det
      if (ntens == 6) then
        stress(5) = props(1)*b(1,3)/det
        stress(6) = props(1)*b(2,3)/det
      end if
      end
"""


@pytest.mark.parametrize("element_type", ["CPE4I", "C3D8I"])
def test_umat_gets_the_deformation_gradient(run_deck, tmp_path, element_type):
    """mu (B - 1) + lame ln J, in uniaxial stress: the stretch across is the root of mu (b^2 - 1) + lame ln(l b^k)."""
    user = tmp_path / "neo.f"
    user.write_text(NEO_HOOKE.format(include=Path(__file__).parents[1] / "umat.inc"))
    mu, lame, stretch = 300.0, 500.0, 1.25
    text = pulled(element_type, f"*USER MATERIAL, CONSTANTS=2\n{mu}, {lame}", stretch)
    result = run_deck(text, user=user)
    across = 1 if element_type == "CPE4I" else 2
    b = 1.0
    for _ in range(50):
        slope = 2 * mu * b + lame * across / b
        b -= (mu * (b**2 - 1) + lame * np.log(stretch * b**across)) / slope
    kirchhoff = mu * (stretch**2 - 1) + lame * np.log(stretch * b**across)
    assert force_of(result) == pytest.approx(kirchhoff / stretch, rel=1e-6)


def bent(element_type, count):
    """Deck of a block 8 x 1 of rubber-like elasticity, held at its left end, whose right end moves up by 4."""
    nodes, elements = grid(element_type, (count, lambda s, t: [8.0 * s, t]))
    lines = body_lines(element_type, nodes, elements)
    ends = {"LEFT": np.isclose(nodes[:, 0], 0.0), "RIGHT": np.isclose(nodes[:, 0], 8.0)}
    for name, chosen in ends.items():
        lines += [f"*NSET, NSET={name}", *map(str, np.flatnonzero(chosen) + 1)]
    lines += [
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
        "1.",
        "*MATERIAL, NAME=M",
        "*HYPERELASTIC, NEO HOOKE",
        "150., 0.002",
    ]
    lines += ["*STEP, NLGEOM, INC=50", "*STATIC", "0.1, 1.", "*BOUNDARY", "LEFT, 1, 2", "RIGHT, 1", "RIGHT, 2, 2, 4."]
    return "\n".join([*lines, "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=RIGHT", "RF2", "*END STEP", ""])


def test_bending_with_large_strains(run_deck):
    """Both ends keep their directions, strains reach 0.3: the force is that of quadratic elements to 1 %."""
    forces = {}
    for element_type in ("CPE8", "CPE4I"):
        result = run_deck(bent(element_type, (16, 2)))
        forces[element_type] = sum(values[-1] for values in result.history.values())
    assert forces["CPE4I"] == pytest.approx(forces["CPE8"], rel=1e-2)
