# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a second value for the same thing is: one rule for each keyword that sets a value."""

import numpy as np
import pytest
from scipy.optimize import brentq

from uel.deck.error_report import Problems
from uel.deck.keywords import KEYWORDS
from uel.deck.language.lexer import read_blocks
from uel.deck.language.repetition import RULES, STRUCTURE, Repeat, check_once, overlaps
from uel.deck.language.table import Support
from uel.errors import DeckError

MESH = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*NSET, NSET=LEFT
1, 4
*NSET, NSET=TOP
4, 5, 6
*ELEMENT, TYPE={kind}, ELSET=BODY
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*ELSET, ELSET=SECOND
2
*SURFACE, NAME=UPPER
BODY, S3
*SURFACE, NAME=LOWER
BODY, S1
*SOLID SECTION, ELSET=BODY, MATERIAL=M
"""
ELASTIC = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*EXPANSION\n1e-5\n"
HELD = "*BOUNDARY\nLEFT, 1\n1, 2\n"
STEP = "*STEP\n*STATIC\n1., 1.\n"
END = "*OUTPUT, FIELD\n*NODE OUTPUT\nU, RF, NT\n*END STEP\n"


def elastic(lines, *, model="", held=HELD):
    return MESH.format(kind="CPS4") + ELASTIC + model + held + STEP + lines + "\n" + END


# --- the table


def test_every_keyword_that_sets_a_value_has_a_rule():
    read = {keyword.name for keyword in KEYWORDS.values() if keyword.support is Support.READ}
    assert set(RULES) | set(STRUCTURE) == read
    assert not set(RULES) & set(STRUCTURE)


def test_groups_and_options_of_the_rules_exist():
    names = {keyword.name: keyword for keyword in KEYWORDS.values()}
    for name, rule in RULES.items():
        assert set(rule.within) <= set(names), name
        assert set(rule.by) <= {option.name for option in names[name].options}, name


ONCE = {
    "AMPLITUDE": "*AMPLITUDE, NAME=X",
    "ANISOTROPIC HYPERELASTIC": "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL",
    "BASE MOTION": "*BASE MOTION, DOF=1, AMPLITUDE=A",
    "COHESIVE BEHAVIOR": "*COHESIVE BEHAVIOR",
    "CONDUCTIVITY": "*CONDUCTIVITY",
    "CONTACT": "*CONTACT",
    "CONTACT DAMPING": "*CONTACT DAMPING",
    "CONTACT INITIALIZATION DATA": "*CONTACT INITIALIZATION DATA, NAME=X",
    "CREEP": "*CREEP",
    "CYCLIC HARDENING": "*CYCLIC HARDENING",
    "CYCLIC SYMMETRY MODEL": "*CYCLIC SYMMETRY MODEL, N=3",
    "DAMAGE EVOLUTION": "*DAMAGE EVOLUTION, TYPE=ENERGY",
    "DAMAGE STABILIZATION": "*DAMAGE STABILIZATION",
    "DENSITY": "*DENSITY",
    "DEPVAR": "*DEPVAR",
    "DIELECTRIC": "*DIELECTRIC",
    "DIFFUSIVITY": "*DIFFUSIVITY",
    "DISTRIBUTING": "*DISTRIBUTING",
    "DISTRIBUTION": "*DISTRIBUTION, NAME=X, LOCATION=ELEMENT, TABLE=T",
    "DISTRIBUTION TABLE": "*DISTRIBUTION TABLE, NAME=X",
    "ELASTIC": "*ELASTIC",
    "EXPANSION": "*EXPANSION",
    "FRICTION": "*FRICTION",
    "HEAT GENERATION": "*HEAT GENERATION",
    "HYPERELASTIC": "*HYPERELASTIC, NEO HOOKE",
    "KAPPA": "*KAPPA, TYPE=TEMP",
    "KINEMATIC": "*KINEMATIC",
    "LATENT HEAT": "*LATENT HEAT",
    "MATERIAL": "*MATERIAL, NAME=X",
    "MONITOR": "*MONITOR, NODE=1, DOF=1",
    "ORIENTATION": "*ORIENTATION, NAME=X",
    "PHYSICAL CONSTANTS": "*PHYSICAL CONSTANTS",
    "PIEZOELECTRIC": "*PIEZOELECTRIC",
    "PLASTIC": "*PLASTIC",
    "SECTION CONTROLS": "*SECTION CONTROLS, NAME=X",
    "SELECT EIGENMODES": "*SELECT EIGENMODES",
    "SOLUBILITY": "*SOLUBILITY",
    "SPECIFIC HEAT": "*SPECIFIC HEAT",
    "SURFACE": "*SURFACE, NAME=X",
    "SURFACE BEHAVIOR": "*SURFACE BEHAVIOR",
    "SURFACE INTERACTION": "*SURFACE INTERACTION, NAME=X",
    "SURFACE SMOOTHING": "*SURFACE SMOOTHING, NAME=X",
    "TRS": "*TRS, DEFINITION=USER",
    "USER DEFINED FIELD": "*USER DEFINED FIELD",
    "USER ELEMENT": "*USER ELEMENT, TYPE=U1, NODES=2",
    "USER MATERIAL": "*USER MATERIAL, CONSTANTS=1",
    "USER OUTPUT VARIABLES": "*USER OUTPUT VARIABLES",
    "VISCOELASTIC": "*VISCOELASTIC, NONLINEAR, NETWORKID=1",
}
OPENERS = {
    "MATERIAL": "*MATERIAL, NAME={}",
    "SURFACE INTERACTION": "*SURFACE INTERACTION, NAME={}",
    "COUPLING": "*COUPLING, CONSTRAINT NAME={}, REF NODE=1, SURFACE=S",
    "DAMAGE INITIATION": "*DAMAGE INITIATION, CRITERION=MAXS",
    "DIFFUSIVITY": "*MATERIAL, NAME={}\n*DIFFUSIVITY",
    "VISCOELASTIC": "*VISCOELASTIC, NONLINEAR, NETWORKID={}",
    "STEP": "*STEP",
}


def test_every_keyword_that_may_be_given_once_is_tested():
    assert set(ONCE) == {name for name, rule in RULES.items() if rule.repeat is Repeat.ONCE and not rule.by_reader}


def checked(folder, *lines):
    deck = folder / "deck.inp"
    deck.write_text("\n".join(lines) + "\n")
    problems = Problems()
    check_once(read_blocks(deck, KEYWORDS, problems), problems)
    problems.check()


@pytest.mark.parametrize("name", ONCE)
def test_given_twice(tmp_path, name):
    """Twice is refused with both places; in another group, or under another name, it is not."""
    line, rule = ONCE[name], RULES[name]
    opener = OPENERS[rule.within[0]] if rule.within else "** {}"
    first, other = opener.format(1), opener.format(2)
    with pytest.raises(DeckError, match=rf"deck\.inp:[34]: \*{name}: .* already, at .*deck\.inp:[23]"):
        checked(tmp_path, first, line, line)
    if rule.within:
        checked(tmp_path, first, line, other, line)
    elif rule.by:
        checked(tmp_path, line, line.replace("=X", "=Y").replace("=U1", "=U2"))


@pytest.mark.parametrize(
    "lines",
    [
        ("*USER MATERIAL, CONSTANTS=1", "*USER MATERIAL, CONSTANTS=1, TYPE=THERMAL"),
        ("*VISCOELASTIC, NONLINEAR, NETWORKID=1", "*VISCOELASTIC, NONLINEAR, NETWORKID=2"),
        ("*DIFFUSIVITY", "*KAPPA, TYPE=TEMP", "*KAPPA, TYPE=PRESS"),
    ],
)
def test_options_tell_things_apart(tmp_path, lines):
    checked(tmp_path, "*MATERIAL, NAME=M", *lines)


@pytest.mark.parametrize(
    ("opener", "first", "second"),
    [
        ("*MATERIAL, NAME=M", "*HYPERELASTIC, NEO HOOKE", "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL"),
        ("*COUPLING, CONSTRAINT NAME=C, REF NODE=1, SURFACE=S", "*KINEMATIC", "*DISTRIBUTING"),
    ],
)
def test_two_keywords_for_one_thing(tmp_path, opener, first, second):
    with pytest.raises(DeckError, match=r"has one already, at .*deck\.inp:2"):
        checked(tmp_path, opener, first, second)


def test_a_file_that_is_included_twice(read, tmp_path):
    """Its lines have the same places both times."""
    (tmp_path / "m.inp").write_text(ELASTIC)
    include = "*INCLUDE, INPUT=m.inp\n"
    with pytest.raises(DeckError, match=r"m\.inp:1: \*MATERIAL: M is defined already, at .*m\.inp:1"):
        read(elastic("").replace(ELASTIC, include * 2))


def test_overlaps():
    """Each pair of neighbours at a place, once, with its first place."""
    places = [np.array(own) for own in ([1, 5, 7], [5, 7, 9], [7])]
    assert list(overlaps(places)) == [(0, 1, 5), (1, 2, 7)]
    assert list(overlaps(places[:1])) == []


# --- refused where they are read


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            ELASTIC,
            "*SOLID SECTION, ELSET=SECOND, MATERIAL=M\n" + ELASTIC,
            r"element 2 has a section already, by \*SOLID",
        ),
        (
            "kind=CPS4R",
            "*HOURGLASS STIFFNESS\n1.\n*HOURGLASS STIFFNESS\n2.\n",
            r"the section has one already, at .*:22",
        ),
        ("*STATIC\n", "*STATIC\n*VISCO\n", r"\*VISCO: the step has a procedure already, at .*:\d+"),
        (HELD, "*TRANSFORM, NSET=TOP\n0., 1., 0., -1., 0., 0.\n" * 2 + HELD, ""),
        (
            HELD,
            "*TRANSFORM, NSET=TOP\n0., 1., 0., -1., 0., 0.\n*TRANSFORM, NSET=LEFT\n1., 1., 0., -1., 1., 0.\n" + HELD,
            r"\*TRANSFORM: node 4 has other directions already, by .*deck\.inp:\d+",
        ),
    ],
)
def test_refused_where_it_is_read(read, old, new, message):
    text = elastic("")
    if old.startswith("kind"):
        text, old = text.replace("TYPE=CPS4", "TYPE=CPS4R"), "*MATERIAL"
        new += old
    assert old in text
    if not message:
        read(text.replace(old, new, 1))
        return
    with pytest.raises(DeckError, match=message):
        read(text.replace(old, new, 1))


def test_transverse_shear_stiffness_twice(read):
    shell = MESH.format(kind="S4").replace("SOLID", "SHELL") + "0.1\n"
    again = "*TRANSVERSE SHEAR STIFFNESS\n1., 1.\n"
    with pytest.raises(DeckError, match=r"\*TRANSVERSE SHEAR STIFFNESS: the section has one already, at .*:\d+"):
        read(shell + again * 2 + ELASTIC + HELD + STEP + END)


# --- the last one counts


@pytest.mark.parametrize(
    ("lines", "expected", "warned"),
    [
        # neighbouring sets at one temperature share nodes 2 and 5: elongation alpha T L, all sides free
        ("LEFTSIDE, 100.\nRIGHTSIDE, 100.", 2e-3, False),
        # alpha (100 * 1 + 125 * 1): the second element has 100 and 150 at its ends
        ("ALL, 100.\nHOT, 150.", 2.25e-3, True),
        ("ALL, 100.\n*TEMPERATURE\nHOT, 150.", 2.25e-3, True),
    ],
)
def test_temperature_twice(run_deck, lines, expected, warned):
    sets = "*NSET, NSET=LEFTSIDE\n1, 2, 4, 5\n*NSET, NSET=RIGHTSIDE\n2, 3, 5, 6\n*NSET, NSET=HOT\n3, 6\n"
    result = run_deck(elastic(f"*TEMPERATURE\n{lines}", model=sets))
    # Poisson's ratio is zero and the gradient along x alone: theory is met to rounding
    assert result.field("U")[2, 0] == pytest.approx(expected, rel=1e-9)
    assert bool(result.warnings) == warned


def test_a_temperature_with_an_amplitude_replaces_one_without(run_deck):
    curve = "*AMPLITUDE, NAME=HALF\n0., 0.5, 1., 0.5\n"
    text = elastic("*TEMPERATURE\nALL, 100.\n*TEMPERATURE, AMPLITUDE=HALF\nALL, 100.", model=curve)
    result = run_deck(text)
    assert result.field("U")[2, 0] == pytest.approx(1e-3, rel=1e-9)
    assert any("node 1 is given 100 with amplitude HALF here and 100 at" in warning for warning in result.warnings)


@pytest.mark.parametrize(
    ("keyword", "message"),
    [
        ("*TEMPERATURE", r"\*TEMPERATURE: node 4 is given 2 here and 1 at deck.inp:\d+, in one step; the entry here"),
        ("*FIELD, VARIABLE=2", r"\*FIELD, VARIABLE=2: node 4 is given 2 here and 1 at"),
        ("*PRESSURE STRESS", r"\*PRESSURE STRESS: node 4 is given 2 here and 1 at"),
    ],
)
def test_fields_of_a_step(read, keyword, message):
    """Each node has one value of each field."""
    text = elastic(f"{keyword}\nALL, 1.\nTOP, 2.\n*FIELD, VARIABLE=3\nTOP, 5.")
    if "STRESS" in keyword:
        text = text.replace("CPS4", "DC2D4").replace(ELASTIC, "*MATERIAL, NAME=M\n*DIFFUSIVITY\n1.\n*SOLUBILITY\n1.\n")
        text = text.replace("*STATIC", "*MASS DIFFUSION, STEADY STATE").replace(HELD, "")
    model = read(text)
    own = [entry for entry in model.steps[0].fields if entry.dof != 3]
    values = np.concatenate([np.full(len(entry.nodes), entry.magnitude) for entry in own])
    assert sorted(np.concatenate([entry.nodes for entry in own]).tolist()) == list(range(6))
    assert sorted(values.tolist()) == [1.0] * 3 + [2.0] * 3
    assert len(model.warnings) == 1
    assert_match(model.warnings[0], message)


def assert_match(text, pattern):
    with pytest.raises(ValueError, match=pattern):
        raise ValueError(text)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("TYPE=TEMPERATURE\nALL, 20.\nTOP, 30.", "TYPE=TEMPERATURE: node 4 is given 30 here and 20 at deck.inp"),
        ("TYPE=VELOCITY\nALL, 1, 2.\nTOP, 1, 3.", "TYPE=VELOCITY: dof 1 of node 4 is given 3 here and 2 at"),
        ("TYPE=STRESS\nBODY, 1., 2.\nSECOND, 1., 3.", "TYPE=STRESS: element 2 is given 1, 3 here and 1, 2 at"),
        ("TYPE=SOLUTION\nBODY, 1.\nSECOND, 2.", "TYPE=SOLUTION: element 2 is given 2 here and 1 at"),
        ("TYPE=TEMPERATURE\nALL, 20.\nTOP, 20.", ""),
        ("TYPE=VELOCITY\nALL, 1, 2.\nTOP, 2, 3.", ""),
    ],
)
def test_initial_conditions(read, lines, message):
    warnings = read(elastic("", model=f"*INITIAL CONDITIONS, {lines}\n")).warnings
    assert len(warnings) == bool(message)
    for warning in warnings:
        assert_match(warning, message)


def test_the_last_initial_stress_counts(run_deck):
    """It keeps its value, since the sides are held."""
    stress = "*INITIAL CONDITIONS, TYPE=STRESS\nBODY, 5.\nBODY, 7.\n"
    result = run_deck(elastic("", model=stress, held="*BOUNDARY\nALL, 1, 2\n"))
    assert np.allclose(result.field("S11"), 7.0, rtol=1e-12)


# --- all of them count


@pytest.mark.parametrize(
    "lines",
    [
        "*CLOAD\n6, 2, 1.\n6, 2, 2.",
        "*CLOAD\n6, 2, 1.\n*CLOAD\n6, 2, 2.",
        "*DLOAD\n2, P3, -1.\nSECOND, P3, -2.",
        "*DLOAD\n2, BY, 1.\n*DLOAD\n2, BY, 2.",
        "*DSLOAD\nRIGHT, P, -1.\nRIGHT, P, -2.",
    ],
)
def test_loads_add_up(run_deck, lines):
    result = run_deck(elastic(lines, model="*SURFACE, NAME=RIGHT\n2, S3\n"))
    assert result.field("RF")[:, 1].sum() == pytest.approx(-3.0, rel=1e-9)


def test_imperfections_add_up_with_a_warning(read):
    model = read(elastic("", model="*IMPERFECTION\n6, 0.1\nTOP, 0.2\n"))
    assert model.mesh.coordinates[3:, 0].tolist() == pytest.approx([0.2, 1.2, 2.3])
    (warning,) = model.warnings
    assert_match(
        warning, r"\*IMPERFECTION: node 6 is moved here and at deck\.inp:\d+: by the sum, which Abaqus does not"
    )


def test_the_last_value_of_a_distribution_counts(read):
    lines = "*DISTRIBUTION TABLE, NAME=T\nANGLE\n*DISTRIBUTION, NAME=D, LOCATION=ELEMENT, TABLE=T\n"
    lines += ", 0.\nBODY, 30.\n2, 60.\n"
    lines += "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, D\n"
    text = elastic("", model=lines).replace("BODY, MATERIAL=M", "BODY, MATERIAL=M, ORIENTATION=O")
    (group,) = read(text).groups
    assert group.section.orientation.system.angle.tolist() == [30.0, 60.0]


CONDUCTIVITY, SIGMA, ZERO = 1e7, 5.67e-8, -273.15
HEAT = (
    f"*MATERIAL, NAME=M\n*CONDUCTIVITY\n{CONDUCTIVITY}\n"
    f"*PHYSICAL CONSTANTS, ABSOLUTE ZERO={ZERO}, STEFAN BOLTZMANN={SIGMA}\n"
)
# radiation is not linear
HEAT_STEP = "*STEP\n*HEAT TRANSFER, STEADY STATE\n1., 1.\n*CONTROLS, PARAMETERS=FIELD\n1e-10, 1e-10\n"
# temperature and coefficient
FIRST, SECOND, BELOW = (100.0, 1.0), (20.0, 3.0), (0.0, 4.0)
GREY = (100.0, 0.5), (300.0, 0.4)
PLACES = {
    "FILM": ("BODY, F3", FIRST, SECOND),
    "SFILM": ("UPPER, F", FIRST, SECOND),
    # three nodes with a third of the area of 2
    "CFILM": ("TOP, 0.66666666666666667", FIRST, SECOND),
    "RADIATE": ("BODY, R3", *GREY),
    "SRADIATE": ("UPPER, R", *GREY),
    "CRADIATE": ("TOP, 0.66666666666666667", *GREY),
}


def flux(keyword, surroundings, temperature):
    """Heat that comes in through a unit of area."""
    other, coefficient = surroundings
    if keyword.endswith("FILM"):
        return coefficient * (other - temperature)
    return SIGMA * coefficient * ((other - ZERO) ** 4 - (temperature - ZERO) ** 4)


def heat(*steps):
    lower = "*SFILM\nLOWER, F, {}, {}".format(*BELOW)
    bodies = [f"{HEAT_STEP}{lower if not k else ''}\n{lines}\n{END}" for k, lines in enumerate(steps)]
    return MESH.format(kind="DC2D4") + HEAT + "".join(bodies).replace("\n\n", "\n")


def equilibrium(keyword, *upper):
    """Temperature at which the body, which conducts well, takes up no heat from above and below."""
    return brentq(
        lambda t: sum(flux(keyword, own, t) for own in upper) + flux("FILM", BELOW, t), -200.0, 400.0, xtol=1e-12
    )


@pytest.mark.parametrize("keyword", PLACES)
def test_each_film_and_radiation_acts(run_deck, keyword):
    """Each exchanges heat with its own surroundings; the temperature is one between all of them."""
    place, *surroundings = PLACES[keyword]
    lines = [f"{place}, {temperature}, {value}" for temperature, value in surroundings]
    result = run_deck(heat(f"*{keyword}\n" + "\n".join(lines)))
    # conduction leaves a difference of a few hundred over the conductivity
    assert np.allclose(result.field("NT11"), equilibrium(keyword, *surroundings), rtol=0, atol=1e-4)
    assert equilibrium("FILM", FIRST, SECOND) == pytest.approx(20.0)


@pytest.mark.parametrize("keyword", PLACES)
@pytest.mark.parametrize("option", ["", ", OP=NEW"])
def test_a_later_step_replaces_all_of_them(run_deck, keyword, option):
    place, *surroundings = PLACES[keyword]
    lines = [f"{place}, {temperature}, {value}" for temperature, value in surroundings]
    again = f"*{keyword}{option}\n{place}, 50., 0.7"
    if keyword == "SFILM" and option:
        again += "\nLOWER, F, {}, {}".format(*BELOW)
    result = run_deck(heat(f"*{keyword}\n" + "\n".join(lines), again))
    assert np.allclose(result.field("NT11"), equilibrium(keyword, (50.0, 0.7)), rtol=0, atol=1e-4)


def test_two_films_come_back_in_a_third_step(run_deck):
    place, *surroundings = PLACES["SFILM"]
    both = "*SFILM\n" + "\n".join(f"{place}, {temperature}, {value}" for temperature, value in surroundings)
    result = run_deck(heat(both, f"*SFILM\n{place}, 50., 0.7", both))
    assert np.allclose(result.field("NT11"), equilibrium("FILM", *surroundings), rtol=0, atol=1e-4)


def test_fluxes_add_up(run_deck):
    result = run_deck(heat("*DFLUX\nBODY, S3, 3.\nBODY, S3, 5.\n*DSFLUX\nUPPER, S, 1.\nUPPER, S, 3."))
    # 12 in through the top, out through the film below
    assert np.allclose(result.field("NT11"), 12.0 / BELOW[1], rtol=0, atol=1e-4)


# --- a surface is a set


@pytest.mark.parametrize(
    ("lines", "faces"),
    [
        ("*SURFACE, NAME=S\nBODY, S3\nSECOND, S3", {1, 2}),
        ("*SURFACE, NAME=S\n2, S3\nBODY, S3", {1, 2}),
        ("*SURFACE, NAME=S, COMBINE=UNION\nUPPER, RIGHT", {1, 2}),
        ("*SURFACE, NAME=S, COMBINE=UNION\nRIGHT\nUPPER", {1, 2}),
        ("*SURFACE, NAME=S, COMBINE=INTERSECTION\nUPPER, RIGHT", {2}),
        ("*SURFACE, NAME=S, COMBINE=DIFFERENCE\nUPPER, RIGHT", {1}),
        # of combined surfaces, and of faces of other numbers
        ("*SURFACE, NAME=D, COMBINE=DIFFERENCE\nUPPER, RIGHT\n*SURFACE, NAME=S, COMBINE=UNION\nD, RIGHT", {1, 2}),
        ("*SURFACE, NAME=S, COMBINE=DIFFERENCE\nUPPER, LOWER", {1, 2}),
    ],
)
def test_a_surface_has_each_face_once(run_deck, lines, faces):
    """The reaction is the pressure on the faces."""
    model = f"*SURFACE, NAME=RIGHT\n2, S3\n{lines}\n"
    result = run_deck(elastic("*DSLOAD\nS, P, 1.", model=model))
    assert result.field("RF")[:, 1].sum() == pytest.approx(len(faces), rel=1e-9)


def test_shared_face_has_its_weight_once(run_deck):
    """Nodes of two faces have the weights 1/2, 1, 1/2: 1.5, 3 and 1.5 of a force of 6, whatever names them twice."""
    model = "*SURFACE, NAME=S\nBODY, S3\nSECOND, S3\n*NODE\n99, 1., 2.\n"
    model += "*COUPLING, CONSTRAINT NAME=C, REF NODE=99, SURFACE=S\n*DISTRIBUTING\n"
    result = run_deck(elastic("*CLOAD\n99, 2, 6.", model=model, held="*BOUNDARY\n1, 1, 2\n2, 1, 2\n3, 1, 2\n"))
    assert np.allclose(result.field("RF")[:3, 1], [-1.5, -3.0, -1.5], rtol=1e-9)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("*SURFACE, NAME=S, COMBINE=DIFFERENCE\nUPPER", r"COMBINE=DIFFERENCE takes the names of two surfaces, found 1"),
        ("*SURFACE, NAME=S, COMBINE=UNION\n", r"COMBINE=UNION takes the names of surfaces, found 0"),
        ("*SURFACE, NAME=S, COMBINE=UNION\nUPPER, S", r"\*SURFACE: combines itself"),
        ("*SURFACE, NAME=S, COMBINE=UNION\nUPPER, NONE", r"unknown surface NONE"),
        ("*SURFACE, NAME=S, CROP\nUPPER\n0., 0., 0., 1., 1., 1.", r"\*SURFACE: option CROP is not supported"),
        (
            "*SURFACE, NAME=N, TYPE=NODE\nTOP\n*SURFACE, NAME=S, COMBINE=UNION\nUPPER, N",
            r"combines surfaces of elements and of nodes; expected one kind",
        ),
        ("*SURFACE, NAME=S\n1, S3\n*SURFACE, NAME=S\n2, S3", r"deck.inp:\d+: \*SURFACE: S is defined already, at deck"),
    ],
)
def test_wrong_surfaces(read, lines, message):
    with pytest.raises(DeckError, match=message):
        read(elastic("*DSLOAD\nS, P, 1.", model=f"{lines}\n"))


def test_an_empty_surface_is_told(read):
    lines = "*SURFACE, NAME=S, COMBINE=INTERSECTION\nUPPER, LOWER\n"
    assert any(
        "*SURFACE: S is empty" in warning for warning in read(elastic("*DSLOAD\nS, P, 1.", model=lines)).warnings
    )


def test_combined_surfaces_of_nodes(read):
    """A node counts once, and TYPE is that of the surfaces."""
    lines = (
        "*SURFACE, NAME=A, TYPE=NODE\n4\n5\n*SURFACE, NAME=B, TYPE=NODE\n5\n6\n*SURFACE, NAME=S, COMBINE=UNION\nA, B\n"
    )
    lines += "*NODE\n99, 1., 2.\n*COUPLING, CONSTRAINT NAME=C, REF NODE=99, SURFACE=S\n*KINEMATIC\n"
    model = read(elastic("*CLOAD\n99, 2, 6.", model=lines))
    followers = [equation.terms[0][0] for equation in model.equations if equation.terms[0][1] == 1]
    assert sorted(followers) == [3, 4, 5]


def test_contact_pair_twice(read):
    contact = "*CONTACT PAIR, INTERACTION=I\nUPPER, LOWER\nUPPER, LOWER\n"
    text = elastic("", model="*SURFACE INTERACTION, NAME=I\n" + contact)
    with pytest.raises(
        DeckError, match=r"\*CONTACT PAIR: UPPER and LOWER are a contact pair already, at deck\.inp:\d+"
    ):
        read(text)
