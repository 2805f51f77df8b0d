# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cohesive elements of a deck: section, material, controls, and every message about them."""

from collections.abc import Callable
from pathlib import Path

import pytest

from uel import usersub
from uel.elements import build_blocks
from uel.errors import DeckError
from uel.model.model import Model
from uel.model.properties import CohesiveSection, SectionControls

Read = Callable[[str], Model]
Refuse = Callable[[str, tuple[str, str, str]], None]
DECK = Path(__file__).with_name("cohesive.inp").read_text()
TABULAR = "TYPE=DISPLACEMENT, SOFTENING=TABULAR"
EVOLUTION = "TYPE=ENERGY, MIXED MODE BEHAVIOR=POWER LAW, POWER=1.5\n0.26, 1.002, 1.5"


def section(model: Model) -> CohesiveSection:
    found = model.groups[-1].section
    assert isinstance(found, CohesiveSection)
    return found


def test_cohesive_section(read: Read) -> None:
    model = read(DECK)
    assert [group.type for group in model.groups] == ["CPS4", "COH2D4"]
    found = section(model)
    assert (found.thickness, found.width) == (0.5, 5.0)
    assert found.controls == SectionControls(deletion=False, degradation=0.99, viscosity=1e-4)
    elastic, damage = found.material.elastic, found.material.damage
    assert elastic is not None and damage is not None and damage.evolution is not None
    assert elastic.constants == (1e4, 2e4, 3e4)
    assert (damage.criterion, damage.onset, damage.viscosity) == ("QUADS", (30.0, 60.0, 50.0), 0.1)
    evolution = damage.evolution
    assert (evolution.type, evolution.softening, evolution.mixed_mode) == ("ENERGY", "LINEAR", "POWER LAW")
    assert (evolution.values, evolution.power) == ((0.26, 1.002, 1.5), 1.5)


def test_defaults(read: Read) -> None:
    deck = DECK.replace(", CONTROLS=KEEP\n0.5, 5.\n", "\n")
    found = section(read(deck))
    assert (found.thickness, found.width, found.controls) == (1.0, 1.0, SectionControls(deletion=True, degradation=1.0))
    assert section(read(deck.replace("SEPARATION\n", "SEPARATION, THICKNESS=GEOMETRY\n"))).thickness == 0.0


@pytest.mark.parametrize(
    ("lines", "values"),
    [
        ("TYPE=DISPLACEMENT\n0.02", (0.02,)),
        ("TYPE=DISPLACEMENT, SOFTENING=EXPONENTIAL\n0.02, 5.", (0.02, 5.0)),
        ("TYPE=DISPLACEMENT, SOFTENING=TABULAR\n0.\n0.5, 0.01\n1., 0.04", (0.0, 0.0, 0.01, 0.5, 0.04, 1.0)),
        ("TYPE=ENERGY, SOFTENING=EXPONENTIAL\n0.3", (0.3,)),
        ("TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, MODE MIX RATIO=ENERGY, POWER=2\n0.3, 1.", (0.3, 1.0, 0.0)),
    ],
)
def test_evolution(read: Read, lines: str, values: tuple[float, ...]) -> None:
    damage = section(read(DECK.replace(EVOLUTION, lines))).material.damage
    assert damage is not None and damage.evolution is not None
    assert damage.evolution.values == values


# what to replace in cohesive.inp, by what, and the line and text of the message
MISTAKES = {
    "cohesive section": (
        "*SOLID SECTION, ELSET=ARMS, MATERIAL=STEEL",
        "*COHESIVE SECTION, ELSET=ARMS, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION",
        r"17: .*element set ARMS holds elements of type CPS4, which take \*SOLID SECTION",
    ),
    "no section": (
        "*COHESIVE SECTION, ELSET=GLUE, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION, CONTROLS=KEEP\n0.5, 5.\n",
        "",
        r"16: element 7 has no section: no \*COHESIVE SECTION refers to it",
    ),
    "solid section": (
        "*COHESIVE SECTION, ELSET=GLUE, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION, CONTROLS=KEEP",
        "*SOLID SECTION, ELSET=GLUE, MATERIAL=STEEL",
        r"19: .*element set GLUE holds elements of type COH2D4, which take \*COHESIVE SECTION",
    ),
    "continuum": (
        "TRACTION SEPARATION",
        "CONTINUUM",
        r"19: .*RESPONSE=CONTINUUM is not supported \(supported: TRACTION",
    ),
    "no response": (", RESPONSE=TRACTION SEPARATION", "", r"19: \*COHESIVE SECTION needs the option RESPONSE"),
    "stack direction": ("CONTROLS=KEEP", "STACK DIRECTION=1", r"19: .*option STACK DIRECTION is not supported"),
    "no such controls": ("CONTROLS=KEEP", "CONTROLS=KEEPS", r"19: unknown section controls KEEPS; did you mean KEEP\?"),
    "thickness": ("0.5, 5.\n", "-0.5, 5.\n", r"20: .*constitutive thickness -0.5 must be positive"),
    "width": ("0.5, 5.\n", "0.5, -5.\n", r"20: .*out-of-plane width -5 must be positive"),
    "degradation": ("=0.99", "=1.01", r"21: .*MAX DEGRADATION=1.01: expected a number above 0, up to 1"),
    "viscosity": ("VISCOSITY=1e-4", "VISCOSITY=-1", r"21: .*VISCOSITY=-1 must not be negative"),
    "controls twice": (
        "*MATERIAL, NAME=STEEL",
        "*SECTION CONTROLS, NAME=KEEP\n*MATERIAL, NAME=STEEL",
        r"23: .*KEEP is defined already, at .*:21",
    ),
    "coupled": ("TYPE=TRACTION", "TYPE=COUPLED TRACTION", r"27: .*TYPE=COUPLED TRACTION is not supported"),
    "criterion": ("CRITERION=QUADS", "CRITERION=HASHIN", r"29: .*CRITERION=HASHIN is not supported \(supported: MAXS"),
    "onset values": ("30., 60., 50.", "30.", r"30: .*1 values, expected 2 or 3"),
    "onset lines": ("30., 60., 50.\n", "", r"29: .*needs one data line; dependence on temperature is not supported"),
    "second criterion": (
        "*DAMAGE EVOLUTION",
        "*DAMAGE INITIATION, CRITERION=MAXS\n1., 1.\n*DAMAGE EVOLUTION",
        r"31: .*one criterion is supported; there is one already, at deck.inp:29",
    ),
    "no initiation": (
        "*DAMAGE INITIATION, CRITERION=QUADS\n30., 60., 50.\n",
        "",
        r"29: .*does not follow \*DAMAGE INIT",
    ),
    "no material": (
        "\n*DAMAGE INITIATION",
        "\n*NSET, NSET=X\n1\n*DAMAGE INITIATION",
        r"31: \*DAMAGE INITIATION: does not follow \*MATERIAL",
    ),
    "evolution twice": (
        "*DAMAGE STABILIZATION\n0.1",
        "*DAMAGE EVOLUTION, TYPE=ENERGY\n1.",
        r"33: .*a \*DAMAGE INITIATION has one already, at deck.inp:31",
    ),
    "stabilization alone": (f"*DAMAGE EVOLUTION, {EVOLUTION}\n", "", r"31: .*does not follow \*DAMAGE EVOLUTION"),
    "negative stabilization": ("\n0.1\n", "\n-0.1\n", r"34: .*viscosity -0.1 must not be negative"),
    "tabular": (
        "POWER LAW, POWER=1.5",
        "TABULAR",
        r"31: .*MIXED MODE BEHAVIOR=TABULAR is not supported \(supported: BK",
    ),
    "traction ratio": ("POWER=1.5", "POWER=1.5, MODE MIX RATIO=TRACTION", r"31: .*MODE MIX RATIO=TRACTION is not supp"),
    "no power": (", POWER=1.5", "", r"31: .*MIXED MODE BEHAVIOR=POWER LAW needs POWER"),
    "power": ("POWER=1.5", "POWER=0", r"31: .*POWER=0 must be positive"),
    "power alone": ("MIXED MODE BEHAVIOR=POWER LAW, ", "", r"31: .*POWER goes with MIXED MODE BEHAVIOR"),
    "mixed displacement": ("TYPE=ENERGY, ", "TYPE=DISPLACEMENT, ", r"31: .*BEHAVIOR=POWER LAW goes with TYPE=ENERGY"),
    "two shear energies": ("POWER LAW", "BK", r"32: .*shear fracture energies 1.002 and 1.5: BK has one for both"),
    "displacement": (EVOLUTION, "TYPE=DISPLACEMENT\n0.", r"32: .*displacement at failure 0 must be positive"),
    "energy": (EVOLUTION, "TYPE=ENERGY\n-1.", r"32: .*fracture energy -1 must be positive"),
    "table of energy": (EVOLUTION, "TYPE=ENERGY, SOFTENING=TABULAR\n0.", "31: .*TABULAR goes with TYPE=DISPLACEMENT"),
    "table with mixed mode": (
        "POWER=1.5",
        "POWER=1.5, SOFTENING=TABULAR",
        "31: .*POWER LAW goes with SOFTENING=LINEAR or",
    ),
    "short table": (EVOLUTION, f"{TABULAR}\n0.", "31: .*SOFTENING=TABULAR needs two or more lines of damage"),
    "mode mix in a table": (EVOLUTION, f"{TABULAR}\n0., 0., 0.5", "32: .*dependence on mode mix or temperature is not"),
    "late table": (
        EVOLUTION,
        f"{TABULAR}\n0., 0.1",
        "32: .*the first displacement, from the onset on, is 0, found 0.1",
    ),
    "table twice": (
        EVOLUTION,
        f"{TABULAR}\n0.\n0.5, 0.",
        "33: .*displacement 0 must exceed that of the line before, 0",
    ),
    "falling table": (
        EVOLUTION,
        f"{TABULAR}\n0.1\n0., 1.",
        "33: .*damage 0 must be from that of the line before, or 0",
    ),
    "too much": (
        EVOLUTION,
        f"{TABULAR}\n0.\n1.1, 1.",
        "33: .*damage 1.1 must be from that of the line before, or 0, to 1",
    ),
    "energies": (EVOLUTION, "TYPE=ENERGY\n1., 2.", r"32: .*2 values, expected 1"),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=list(MISTAKES))
def test_mistake(refuse: Refuse, mistake: tuple[str, str, str]) -> None:
    refuse(DECK, mistake)


# found when the elements are made, with the dimension known
PROPERTIES = {
    "solid material": (
        "MATERIAL=GLUE, R",
        "MATERIAL=STEEL, R",
        r"24: .*TYPE=ISOTROPIC is not .* COH2D4 \(material STEEL, section at deck.inp:19",
    ),
    "no elasticity": ("*ELASTIC, TYPE=TRACTION\n1e4, 2e4, 3e4\n", "", r"26: .*GLUE has no \*ELASTIC, TYPE=TRACTION"),
    "traction in a solid": (
        "MATERIAL=STEEL\n5.",
        "MATERIAL=GLUE\n5.",
        r"27: .*TYPE=TRACTION is not supported .* CPS4 \(material GLUE, section at deck.inp:17.*: cohesive elements",
    ),
    "plasticity": (
        "*DAMAGE INITIATION",
        "*PLASTIC\n1.\n*DAMAGE INITIATION",
        r"29: \*PLASTIC is not supported for elements of type COH2D4 \(material GLUE, section at deck.inp:19\)",
    ),
    "user material": (
        "*DAMAGE INITIATION",
        "*USER MATERIAL, CONSTANTS=1\n1.\n*DAMAGE INITIATION",
        r"29: \*USER MATERIAL is not supported for elements of type COH2D4 \(material GLUE, section at deck.inp:19\)",
    ),
    "user material alone": (
        "*ELASTIC, TYPE=TRACTION\n1e4, 2e4, 3e4\n",
        "*USER MATERIAL, CONSTANTS=1\n1.\n",
        r"27: \*USER MATERIAL is not supported .* COH2D4 .*: Abaqus calls UMAT with separations and tractions; "
        r"expected \*ELASTIC, TYPE=TRACTION with",
    ),
    "damage of a solid": (
        "210000., 0.3\n",
        "210000., 0.3\n*DAMAGE INITIATION, CRITERION=MAXS\n1., 1.\n",
        r"26: \*DAMAGE INITIATION is not .* \(material STEEL, section at deck.inp:17\); supported: cohesive elements",
    ),
    "modulus": ("1e4, 2e4", "1e4, 0.", r"27: \*ELASTIC, TYPE=TRACTION: moduli must be positive, found 0"),
    "onset": ("30., 60., 50.", "-30., 60.", r"29: \*DAMAGE INITIATION: onset values must be positive, found -30"),
    "toughness": (
        "0.26, 1.002, 1.5",
        "0.26, 0.",
        r"31: \*DAMAGE EVOLUTION: fracture energies must be positive, found 0",
    ),
    "brittle": (
        "0.26, 1.002, 1.5",
        "0.26, 0.04",
        r"31: .*0.04 of the first shear mode must exceed the elastic .*, 0.045",
    ),
    "brittle strain": (
        "QUADS\n30., 60., 50.",
        "MAXE\n0.02, 0.01, 0.01",
        r"31: .*0.26 of the normal mode must exceed the elastic energy at the onset of damage, 1",
    ),
}


@pytest.mark.parametrize("name", PROPERTIES)
def test_property(read: Read, tmp_path: Path, name: str) -> None:
    old, new, message = PROPERTIES[name]
    assert old in DECK
    line, text = message.split(": ", 1)
    library = usersub.load(None, job="job", output_dir=tmp_path)
    model = read(DECK.replace(old, new, 1))
    with pytest.raises(DeckError, match=rf"^deck\.inp:{line}: .*{text}"):
        build_blocks(model, library)


def test_mass_in_dynamics(read: Read, tmp_path: Path) -> None:
    """Solids need a density there, cohesive elements do not."""
    steel = DECK.replace("210000., 0.3\n", "210000., 0.3\n*DENSITY\n7.8e-9\n").replace(
        "*STATIC\n", "*DYNAMIC\n1., 1.\n"
    )
    library = usersub.load(None, job="job", output_dir=tmp_path)
    build_blocks(read(steel), library)
    glue = steel.replace("3e4\n", "3e4\n*DENSITY\n1e-9\n")
    build_blocks(read(glue), library)
