# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a model is said before the first call, with the place in the deck."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.elements import FIELD_NAMES, build_blocks, field_of
from uel.errors import DeckError, Source
from uel.model.mesh import Mesh
from uel.model.model import Model
from uel.model.orientation_axes import LocalSystem, SystemKind
from uel.model.procedures import Dynamic, Static
from uel.model.properties import Elastic, ElasticType, Material, Orientation, UserMaterial
from uel.model.steps import Step

HERE = Path(__file__).parent
SPRING = ((0, 1), (1, 1))
NODES = np.array([[0, 1]])
STEP = Step(1, "Step-1", Static(), Source("test.inp", 40))


@pytest.fixture
def build(load):
    def build(group, file="spring.f", steps=()):
        mesh = Mesh(np.arange(1, 5), np.eye(4, 3), ("",) * 4)
        return build_blocks(Model(Path("test.inp"), "", mesh, (group,), steps), load(file))

    return build


def test_elements_beyond_the_memory(build, user_group):
    group = user_group(NODES, SPRING, properties=(1.0,))
    group = replace(group, definition=replace(group.definition, variables=10**14, source=Source("test.inp", 5)))
    message = r"test.inp:5: not enough memory for 1 elements of type U1 \(VARIABLES=100000000000000\)"
    with pytest.raises(DeckError, match=message):
        build(group)


def test_number_of_properties(build, user_group):
    group = user_group(NODES, SPRING, properties=(1.0, 2.0))
    group = replace(group, definition=replace(group.definition, properties=3, source=Source("test.inp", 5)))
    message = (
        r"test.inp:7: \*UEL PROPERTY for ALL gives 2 real properties, but .*TYPE=U1 \(test.inp:5\) has PROPERTIES=3"
    )
    with pytest.raises(DeckError, match=message):
        build(group)


def test_number_of_integer_properties(build, user_group):
    group = user_group(NODES, SPRING, integers=(1,))
    group = replace(group, definition=replace(group.definition, integer_properties=0))
    with pytest.raises(DeckError, match=r"gives 1 integer properties, but .* has I PROPERTIES=0"):
        build(group)


def test_number_of_nodes(build, user_group):
    group = user_group(NODES, SPRING)
    group = replace(group, definition=replace(group.definition, nodes=3))
    with pytest.raises(DeckError, match=r"test.inp:7: elements of type U1 have 2 nodes, but .* has NODES=3"):
        build(group)


def test_missing_uel(build, user_group):
    with pytest.raises(DeckError, match=r"elements of type U1 need UEL; .*point.f has UELMAT"):
        build(user_group(NODES, SPRING), "point.f")


def test_missing_uelmat(build, user_group):
    material = Material("M", Source("test.inp", 3), Elastic(ElasticType.ISOTROPIC, (1.0, 0.3), Source("test.inp", 4)))
    group = user_group(NODES, SPRING, material=material, tensor="PSTRESS")
    message = r"need UELMAT, because \*UEL PROPERTY for ALL names a material; .*spring.f has UEL"
    with pytest.raises(DeckError, match=message):
        build(group)


TURNED = Orientation("TURNED", np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), Source("test.inp", 5))


def test_user_elements_have_one_orientation_of_built_in_materials(build, user_group):
    """Directions that are the same everywhere, and of UMAT the global ones."""
    elastic = Material("M", Source("test.inp", 3), Elastic(ElasticType.ISOTROPIC, (1.0, 0.3), Source("test.inp", 4)))
    around = replace(TURNED, system=LocalSystem(SystemKind.CYLINDRICAL, np.eye(3)))
    group = user_group(NODES, SPRING, material=elastic, orientation=around, tensor="PSTRESS", integration=1)
    message = (
        r"test.inp:5: \*ORIENTATION with directions that differ from point to point is not supported for user elements"
    )
    with pytest.raises(DeckError, match=message):
        build(group, "point.f")
    umat = Material("M", Source("test.inp", 3), user=UserMaterial(np.zeros(1), False, Source("test.inp", 4)))
    group = user_group(NODES, SPRING, material=umat, orientation=TURNED, tensor="PSTRESS", integration=1)
    components = (HERE / "components.f").read_text().replace("../", f"{HERE.parent}/")
    with pytest.raises(DeckError, match=r"test.inp:5: \*ORIENTATION is not supported for \*USER MATERIAL \(M\)"):
        build(group, (HERE / "point.f").read_text() + components)


@pytest.mark.parametrize("element_type, hint", [("CPS5", "; did you mean CPS8"), ("SAX1", "$")])
def test_unsupported_element_type(build, solid_group, element_type, hint):
    message = rf"test.inp:7: element type {element_type} is not supported{hint}"
    with pytest.raises(DeckError, match=message):
        build(solid_group(element_type, np.array([[0, 1, 2, 3]]), 1.0))


def test_number_of_nodes_of_a_built_in_element(build, solid_group):
    with pytest.raises(DeckError, match="elements of type CPS4 have 4 nodes, found 3"):
        build(solid_group("CPS4", np.array([[0, 1, 2]]), 1.0))


def test_dynamic_steps_need_a_density(build, solid_group):
    message = r"test.inp:7: material M has no \*DENSITY, which elements of type CPE3 need in \*DYNAMIC"
    with pytest.raises(DeckError, match=message):
        build(solid_group("CPE3", np.array([[0, 1, 2]]), 1.0), steps=(replace(STEP, procedure=Dynamic()),))


def test_hourglass_stiffness_of_user_materials(build, solid_group, load):
    group = solid_group("CPE4R", np.array([[0, 1, 2, 3]]), 1.0)
    user = Material("M", Source("test.inp", 3), user=UserMaterial(np.zeros(1), False, Source("test.inp", 4)))
    message = r"elements of type CPE4R with \*USER MATERIAL need \*HOURGLASS STIFFNESS"
    with pytest.raises(DeckError, match=message):
        build(replace(group, section=replace(group.section, material=user)))


def test_sections_of_the_wrong_kind(build, solid_group, user_group):
    solid, user = solid_group("CPS3", np.array([[0, 1, 2]]), 1.0), user_group(NODES, SPRING)
    with pytest.raises(DeckError, match=r"elements of type CPS3 need \*SOLID SECTION"):
        build(replace(solid, section=user.section))
    with pytest.raises(DeckError, match=r"user elements \(U1\) need \*UEL PROPERTY"):
        build(replace(user, section=solid.section))
    cohesive = replace(user, type="COH2D4", nodes=np.array([[0, 1, 2, 0]]), definition=None)
    with pytest.raises(DeckError, match=r"elements of type COH2D4 need \*COHESIVE SECTION"):
        build(cohesive)


def test_fields():
    """Abaqus: 1-3 forces, 4-7 moments, 8 pore pressure, 9 electrical, 11 and up temperature."""
    names = [FIELD_NAMES[field_of(dof)] for dof in (1, 3, 4, 6, 7, 8, 9, 11, 12, 30)]
    assert names == ["force"] * 2 + ["moment"] * 3 + ["pore", "electrical"] + ["temperature"] * 3


def test_all_places_are_named_at_once(solid_group, load):
    """One error for each section, not one after the other."""
    groups = [solid_group(kind, np.array([[0, 1, 2]]), 1.0) for kind in ("SAX1", "CPS4", "PIPE21")]
    mesh = Mesh(np.arange(1, 5), np.eye(4, 3), ("",) * 4)
    with pytest.raises(DeckError, match=r"(?s)type SAX1 is not.*\n.*type CPS4 have 4 nodes.*\n.*type PIPE21 is not"):
        build_blocks(Model(Path("test.inp"), "", mesh, tuple(groups), ()), load(None))
