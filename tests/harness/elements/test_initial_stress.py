# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS, TYPE=STRESS: a bar along axis 1 whose initial stress is held at both ends, or at one."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from uel.errors import DeckError

HERE = Path(__file__).parent
YOUNG, STRESS, LENGTH = 1000.0, 10.0, 2.0
STRAIN = STRESS / YOUNG

PLANE = "1, 0., 0.\n2, 2., 0.\n3, 2., 1.\n4, 0., 1.\n"
SPACE = PLANE.replace("\n", ", 0.\n") + "5, 0., 0., 3.\n6, 2., 0., 3.\n7, 2., 1., 3.\n8, 0., 1., 3.\n"
FAR = PLANE.replace("0., ", "5., ").replace("2., ", "7., ")


@dataclass(frozen=True)
class Bar:
    """An element with the cross-section `area`; `held` leaves it free to get thicker and to move along the axis."""

    nodes: str
    last: int
    area: float
    held: str


QUAD = Bar(PLANE, 4, 3.0, "1, 1\n4, 1\n1, 2\n2, 2\n")
BRICK = Bar(SPACE, 8, 3.0, "1, 1\n4, 1\n5, 1\n8, 1\n1, 2\n2, 2\n5, 2\n6, 2\n1, 3\n2, 3\n3, 3\n4, 3\n")
BARS = {"CPS4": QUAD, "CPS4R": QUAD, "C3D8": BRICK, "C3D8R": BRICK}

DECK = """*NODE, NSET=ALL
{nodes}*NSET, NSET=END
2, 3{more}
*ELEMENT, TYPE={type}, ELSET=BAR
1, {element}
*SOLID SECTION, ELSET=BAR, MATERIAL=M{orientation}
{thickness}
*MATERIAL, NAME=M
{material}
*INITIAL CONDITIONS, TYPE=STRESS{unbalanced}
BAR, {stress}
*STEP{step}
{static}
*BOUNDARY
{held}*EL PRINT, FREQUENCY=0
*OUTPUT, FIELD
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U1, RF1
*ENERGY OUTPUT
ALLSE, ALLPD, ALLWK, ETOTAL
*END STEP
"""


@pytest.fixture
def run_bar(run_deck):
    def run_bar(type="CPS4", *, clamped=False, held="", user=None, lines="", bar=None, **given):
        bar = bar or BARS[type]
        nodes = "2, 3, 6, 7" if bar.last == 8 else "2, 3"
        ends = f"END, 1, 1, {given.pop('end', 0.0)}\n" if clamped else ""
        values = {
            "nodes": bar.nodes,
            "more": nodes[4:],
            "type": type,
            "element": ", ".join(map(str, range(1, bar.last + 1))),
            "thickness": "" if bar.last == 8 else "3.",
            "material": f"*ELASTIC\n{YOUNG}, 0.3",
            "orientation": "",
            "unbalanced": "",
            "stress": f"{STRESS}, 0.",
            "step": "",
            "static": "*STATIC\n0.25, 1., , 0.25",
            "held": (held or bar.held) + ends,
            **given,
        }
        return run_deck(DECK.format(**values).replace("*STEP", f"{lines}*STEP", 1), user)

    return run_bar


def force(result):
    """Sum of the reactions at the nodes of the end."""
    return sum(values for name, values in result.history.items() if name.startswith("RF1["))


def moved(result):
    """Displacement of the end."""
    return result.history["U1[END:2]"]


TIMES = np.array([0.25, 0.5, 0.75, 1.0])


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
@pytest.mark.parametrize("type", BARS)
def test_held_at_both_ends_the_reaction_is_stress_times_area(run_bar, type, step):
    """It grows in the course of the step, in which the forces that keep the stress in equilibrium fade."""
    result = run_bar(type, clamped=True, step=step)
    np.testing.assert_allclose(force(result), STRESS * BARS[type].area * TIMES, rtol=1e-9)
    np.testing.assert_allclose(result.field("S11"), STRESS, rtol=1e-9)
    energy = 0.5 * STRESS * STRAIN * BARS[type].area * LENGTH
    np.testing.assert_allclose(result.history["ALLSE"], energy, rtol=1e-9)
    np.testing.assert_allclose(result.history["ETOTAL"], energy, rtol=1e-9)


@pytest.mark.parametrize("type", BARS)
def test_a_free_bar_gets_shorter_by_stress_over_stiffness(run_bar, type):
    result = run_bar(type)
    np.testing.assert_allclose(moved(result), -STRAIN * LENGTH * TIMES, rtol=1e-9)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-9 * STRESS)
    np.testing.assert_allclose(result.field("E22"), 0.3 * STRAIN, rtol=1e-9)
    energy = 0.5 * STRESS * STRAIN * BARS[type].area * LENGTH
    np.testing.assert_allclose(result.history["ALLSE"], energy * (1 - TIMES) ** 2, atol=1e-9 * energy)
    # what was stored goes to the forces that fade
    np.testing.assert_allclose(result.history["ETOTAL"], energy, rtol=1e-9)
    np.testing.assert_allclose(result.history["ALLPD"], 0.0, atol=1e-9 * energy)


@pytest.mark.parametrize("type", BARS)
def test_in_large_displacements_the_logarithmic_strain_is_stress_over_stiffness(run_bar, type):
    """Of one increment it is the strain at its middle: du / (L + du/2)."""
    result = run_bar(type, step=", NLGEOM", unbalanced=", UNBALANCED STRESS=STEP", static="*STATIC\n1., 1.")
    (end,) = moved(result)
    assert end / (LENGTH + 0.5 * end) == pytest.approx(-STRAIN, rel=1e-6)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-6 * STRESS)


def test_unbalanced_stress_takes_effect_at_once_where_the_deck_says_so(run_bar):
    held = run_bar(clamped=True, unbalanced=", UNBALANCED STRESS=STEP")
    np.testing.assert_allclose(force(held), STRESS * QUAD.area, rtol=1e-9)
    free = run_bar(unbalanced=", UNBALANCED STRESS=STEP")
    np.testing.assert_allclose(moved(free), -STRAIN * LENGTH, rtol=1e-9)


def test_a_load_that_balances_the_stress_leaves_everything_where_it_is(run_bar):
    """The load of the step is there at once, as the whole unbalanced stress is."""
    loads = f"*CLOAD\n2, 1, {STRESS * QUAD.area / 2}\n3, 1, {STRESS * QUAD.area / 2}\n"
    result = run_bar(held=QUAD.held + loads, step=", AMPLITUDE=STEP", unbalanced=", UNBALANCED STRESS=STEP")
    np.testing.assert_allclose(moved(result), 0.0, atol=1e-12)
    np.testing.assert_allclose(result.field("S11"), STRESS, rtol=1e-9)


def test_components_of_plane_strain_and_axisymmetric_elements(run_bar):
    """11, 22, 33, 12: those that are held stay, and 33 of plane strain."""
    held = "ALL, 1, 2\n"
    for type, bar in (("CPE4", QUAD), ("CAX4", Bar(FAR, 4, 3.0, held))):
        result = run_bar(type, bar=bar, held=held, stress="1., 2., 3., 4.")
        for name, value in (("S11", 1.0), ("S22", 2.0), ("S33", 3.0), ("S12", 4.0)):
            np.testing.assert_allclose(result.field(name), value, rtol=1e-9, err_msg=f"{type} {name}")


def test_components_in_space_and_in_plane_stress(run_bar):
    held = "ALL, 1, 3\n"
    result = run_bar("C3D8", held=held, stress="1., 2., 3., 4., 5., 6.")
    for value, name in enumerate(("S11", "S22", "S33", "S12", "S13", "S23"), 1):
        np.testing.assert_allclose(result.field(name), value, rtol=1e-9, err_msg=name)
    result = run_bar("CPS4", held="ALL, 1, 2\n", stress="1., 2., 4., 0., 0., 0.")
    for name, value in (("S11", 1.0), ("S22", 2.0), ("S33", 0.0), ("S12", 4.0), ("E33", 0.0)):
        np.testing.assert_allclose(result.field(name), value, rtol=1e-9, atol=1e-12, err_msg=name)


def test_stresses_are_in_the_directions_of_the_orientation(run_bar):
    """Direction 1 of the material is axis 2: the bar gets shorter along it."""
    turned = "*ORIENTATION, NAME=TURNED\n0., 1., 0., -1., 0., 0.\n"
    result = run_bar(orientation=", ORIENTATION=TURNED", lines=turned)
    np.testing.assert_allclose(moved(result), 0.3 * STRAIN * LENGTH * TIMES, rtol=1e-9)
    np.testing.assert_allclose(result.field("U")[2, 1], -STRAIN, rtol=1e-9)
    np.testing.assert_allclose(result.field("E11"), -STRAIN, rtol=1e-9)


def test_stresses_are_in_the_directions_of_the_orientation_with_nlgeom(run_bar):
    """Direction 2 of the material is minus axis 1: held, the bar keeps the stress, in the directions of the deck."""
    turned = "*ORIENTATION, NAME=TURNED\n0., 1., 0., -1., 0., 0.\n"
    given = {"orientation": ", ORIENTATION=TURNED", "step": ", NLGEOM", "lines": turned, "clamped": True}
    result = run_bar(stress=f"0., {STRESS}", **given)
    np.testing.assert_allclose(result.field("S22"), STRESS, rtol=1e-9)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-9 * STRESS)


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
@pytest.mark.parametrize("type", BARS)
def test_a_plastic_bar_yields_earlier(run_bar, type, step):
    """Pulled to the strain 0.008 from the stress 10 on, with E = 1000 and the yield stress 15, it yields at 0.005.

    Across the bar there is equilibrium within the tolerance of residuals; the work is that of the trapezoidal rule over
    four increments, in one of which it yields.
    """
    plastic = f"*ELASTIC\n{YOUNG}, 0.3\n*PLASTIC\n15., 0."
    end = 0.008 * LENGTH
    result = run_bar(type, clamped=True, end=end, material=plastic, step=step)
    stretch = np.log1p(0.008) if step else 0.008
    np.testing.assert_allclose(result.field("S11"), 15.0, rtol=1e-4)
    volume = BARS[type].area * LENGTH
    plastic_work = 15.0 * (stretch - 0.005) * volume
    assert result.history["ALLPD"][-1] == pytest.approx(plastic_work, rel=0.02)
    assert result.history["ALLSE"][-1] == pytest.approx(0.5 * 15.0**2 / YOUNG * volume, rel=0.02)


def test_stress_of_a_material_that_depends_on_temperature(run_bar):
    """The strain without stress is that at the initial temperature: where E is half of it, so is the stress."""
    table = f"*ELASTIC\n{YOUNG}, 0.3, 0.\n{YOUNG / 2}, 0.3, 100."
    result = run_bar(
        clamped=True,
        material=table,
        lines="*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 0.\n",
        held=QUAD.held + "END, 1\n*TEMPERATURE\nALL, 100.\n*BOUNDARY\n",
    )
    np.testing.assert_allclose(result.field("S11"), STRESS / 2, rtol=1e-9)


@pytest.mark.parametrize("step", ["", ", NLGEOM"])
@pytest.mark.parametrize("type", ["CPS4", "CPE4", "C3D8"])
def test_umat_gets_the_stress_on_entry_and_keeps_it_where_nothing_happens(run_bar, type, step):
    user = f"*USER MATERIAL, CONSTANTS=2\n{YOUNG}, {STRESS}\n*DEPVAR\n2"
    bar = BARS.get(type, QUAD)
    held = "ALL, 1, 3\n" if bar is BRICK else "ALL, 1, 2\n"
    result = run_bar(type, bar=bar, held=held, material=user, step=step, user=HERE / "stressed.f")
    np.testing.assert_array_equal(result.field("SDV1"), 0.0)
    np.testing.assert_array_equal(result.field("SDV2"), STRESS)
    np.testing.assert_array_equal(result.field("S11"), STRESS)


@pytest.mark.parametrize("type", ["CPS4", "C3D8"])
def test_umat_that_is_free_gets_shorter(run_bar, type):
    user = f"*USER MATERIAL, CONSTANTS=2\n{YOUNG}, {STRESS}\n*DEPVAR\n2"
    result = run_bar(type, material=user, user=HERE / "stressed.f")
    np.testing.assert_allclose(moved(result), -STRAIN * LENGTH * TIMES, rtol=1e-9)
    np.testing.assert_allclose(result.field("SDV2"), 0.0, atol=1e-9 * STRESS)


def test_a_dynamic_step_at_rest_stays_at_rest(run_bar):
    """Held at both ends with the whole stress from the start, nothing moves but the reactions."""
    dynamic = "*DYNAMIC, HAFTOL=1E9\n0.25, 1., , 0.25"
    material = f"*ELASTIC\n{YOUNG}, 0.\n*DENSITY\n1."
    given = {"clamped": True, "static": dynamic, "material": material, "held": "ALL, 1, 2\n"}
    result = run_bar(unbalanced=", UNBALANCED STRESS=STEP", **given)
    np.testing.assert_allclose(force(result), STRESS * QUAD.area, rtol=1e-9)


def test_elements_of_a_dynamic_step_each_have_their_stress(run_bar):
    """Their SVARS go on with forces of earlier increments."""
    second = "*ELEMENT, TYPE=CPS4, ELSET=BAR\n2, 1, 2, 3, 4\n*INITIAL CONDITIONS, TYPE=STRESS\n2, 3.\n"
    material = f"*ELASTIC\n{YOUNG}, 0.\n*DENSITY\n1."
    given = {"static": "*DYNAMIC, HAFTOL=1E9\n0.25, 1., , 0.25", "material": material, "held": "ALL, 1, 2\n"}
    result = run_bar(stress="7.", lines=second, **given)
    np.testing.assert_allclose(result.field("S11"), [7.0, 3.0], rtol=1e-9)


def test_coupled_elements_take_stresses(run_bar):
    material = f"*ELASTIC\n{YOUNG}, 0.3\n*CONDUCTIVITY\n1."
    heat = "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n0.25, 1."
    result = run_bar(
        "CPS4T", bar=QUAD, clamped=True, material=material, static=heat, held=QUAD.held + "ALL, 11, 11, 5.\n"
    )
    np.testing.assert_allclose(result.field("S11"), STRESS, rtol=1e-9)
    assert force(result)[-1] == pytest.approx(STRESS * QUAD.area, rel=1e-9)


def test_elements_of_several_types_each_have_their_stress(run_bar):
    """A triangle of the second group over the quad of the first."""
    second = "*ELEMENT, TYPE=CPS3, ELSET=OTHER\n5, 2, 3, 4\n*SOLID SECTION, ELSET=OTHER, MATERIAL=M\n3.\n"
    lines = f"{second}*INITIAL CONDITIONS, TYPE=STRESS\nOTHER, 0., 7.\n"
    result = run_bar(held="ALL, 1, 2\n", stress="0.", lines=lines)
    np.testing.assert_allclose(result.field("S22"), [0.0, 7.0], atol=1e-12)
    result = run_bar(held="ALL, 1, 2\n", lines=lines)
    np.testing.assert_allclose(result.field("S11"), [STRESS, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    "given, message",
    [
        ({"stress": "1., 2., 3., 4."}, r"deck\.inp:16: .*type CPS4 have S11, S22, S12: component 4 is not zero"),
        (
            {"stress": "1., 2., 3., 4., 5., 6., 7."},
            r"deck\.inp:16: \*INITIAL CONDITIONS: 8 entries, expected at most 7",
        ),
        ({"unbalanced": ", GEOSTATIC", "stress": "1., 2., 3., 2., 1."}, r"deck\.inp:16: .*both elevations are 2"),
        ({"unbalanced": ", GEOSTATIC", "stress": "1., 2., 3., 4."}, r"deck\.inp:16: .*coefficient of lateral stress"),
        (
            {
                "unbalanced": ", GEOSTATIC",
                "stress": "1., 2., 3., 4., 1.",
                "orientation": ", ORIENTATION=O",
                "material": f"*ELASTIC\n{YOUNG}, 0.3\n*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.",
            },
            r"deck\.inp:18: .*type CPS4 have directions of their own \(\*ORIENTATION\), for which GEOSTATIC is not",
        ),
        ({"unbalanced": ", SECTION POINTS"}, r"deck\.inp:15: .*SECTION POINTS is not supported"),
        ({"unbalanced": ", REBAR"}, r"deck\.inp:15: .*REBAR is not supported"),
        ({"unbalanced": ", UNBALANCED STRESS=NO"}, r"deck\.inp:15: .*UNBALANCED STRESS=NO.*RAMP, STEP"),
        (
            {"lines": "*INITIAL CONDITIONS, TYPE=STRESS, UNBALANCED STRESS=STEP\n1, 1.\n"},
            r"deck\.inp:17: .*UNBALANCED STRESS must be the same in the whole model, but differs at .*deck\.inp:16",
        ),
        (
            {"lines": "*INITIAL CONDITIONS, TYPE=VELOCITY, UNBALANCED STRESS=STEP\n1, 1, 1.\n"},
            r"deck\.inp:17: .*GEOSTATIC and UNBALANCED STRESS are for TYPE=STRESS",
        ),
        (
            {"lines": "*INITIAL CONDITIONS, TYPE=STRESS\n"},
            r"deck\.inp:17: .*TYPE=STRESS has no data lines; expected the components .*, or USER for SIGINI",
        ),
        ({"lines": "*INITIAL CONDITIONS, TYPE=STRESS\n7, 1.\n"}, r"deck\.inp:18: element 7 is not defined"),
    ],
)
def test_what_is_wrong_is_refused(run_bar, given, message):
    with pytest.raises(DeckError, match=message):
        run_bar(**given)


def test_user_elements_are_not_told_and_the_run_says_so(run_deck):
    result = run_deck(
        "*NODE\n1, 0.\n2, 1.\n*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U1, ELSET=ALL\n1, 1, 2\n*UEL PROPERTY, ELSET=ALL\n1.\n"
        "*INITIAL CONDITIONS, TYPE=STRESS\nALL, 1.\n"
        "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n*END STEP\n",
        HERE / "spring.f",
    )
    (warning,) = result.warnings
    message = r"deck\.inp:11: \*INITIAL CONDITIONS, TYPE=STRESS has no effect: user elements \(U1\) do not get"
    assert re.search(message, warning)
    assert "HAS NO EFFECT" in result.file(".msg").read_text().upper()


def test_elements_without_initial_stress_say_so(run_bar):
    lines = "*ELEMENT, TYPE=MASS, ELSET=M\n9, 2\n*MASS, ELSET=M\n1.\n*INITIAL CONDITIONS, TYPE=STRESS\nM, 1.\n"
    with pytest.raises(DeckError, match=r"deck\.inp:22: .*elements of type MASS do not take an initial stress"):
        run_bar(lines=lines)


def test_what_usdfld_changes_has_no_initial_stress(run_bar, tmp_path):
    table = f"*ELASTIC, DEPENDENCIES=1\n{YOUNG}, 0.3, , 0.\n{YOUNG / 2}, 0.3, , 1.\n*USER DEFINED FIELD"
    user = tmp_path / "user.f"
    user.write_text(
        "      subroutine usdfld(field,statev,pnewdt,direct,t,celent,time,dtime,cmname,orname,nfield,nstatv,noel,\n"
        "     1 npt,layer,kspt,kstep,kinc,ndi,nshr,coord,jmac,jmatyp,matlayo,laccfla)\n      end\n"
    )
    with pytest.raises(
        DeckError, match=r"deck\.inp:18: .*TYPE=STRESS beside .* fields beside \*USER DEFINED FIELD is not supported"
    ):
        run_bar(material=table, user=user)
