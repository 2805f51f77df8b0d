# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact in small sliding: closed forms of pressed, separating and sliding bodies, derivatives, iteration counts."""

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from contact_decks import YOUNG, Box, plane, step, total, two_boxes

from uel.contact import ContactBlock
from uel.contact.block import OPEN, SLIPPING, STICKING
from uel.deck import read_deck
from uel.elements import CurrentPass, Flags, Request
from uel.errors import ConvergenceError, DeckError, Source, UsageError
from uel.model.contact import Cohesion, ContactPair, ContactProperty
from uel.model.damage import Damage, DamageEvolution
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import UserProperty
from uel.running.job_on_ranks import refuse_unshared
from uel.solver.options import SolverOptions

SOURCE = Source("test.inp", 1)
THICKNESS = 1.5
SOFTENING = "ENERGY", "EXPONENTIAL", "BK", (0.5, 0.8, 0.8), 1.4
SURFACES = "SMALL SLIDING, TYPE=SURFACE TO SURFACE"
SLIDING = "TYPE=NODE TO SURFACE"
SLIDING_SURFACES = "TYPE=SURFACE TO SURFACE"
PAIRS = pytest.mark.parametrize(
    "pair", ["SMALL SLIDING", SURFACES, SLIDING, SLIDING_SURFACES], ids=["nodes", "surfaces", "sliding", "both"]
)
HELD = "*BOUNDARY\nLOWER_BOTTOM, 2\nLOWER_LEFT, 1\nUPPER_LEFT, 1"


def pressed(by, options=""):
    return step("1., 1.", f"*BOUNDARY\nUPPER_TOP, 2, 2, {-by}", options=options)


# ------------------------------------------------------------ bodies pressed together


@pytest.mark.parametrize("element_type", ["CPE4", "CPS4", "CAX4"])
@pytest.mark.parametrize(
    ("pair", "lower"),
    [("SMALL SLIDING", 3), (SLIDING, 3), (SURFACES, 3), (SURFACES, 2), (SLIDING_SURFACES, 3), (SLIDING_SURFACES, 2)],
)
def test_patch_test(run_deck, element_type, pair, lower):
    """Uniaxial stress: E strain, E / (1 - nu^2) strain in plane strain; between surfaces on any meshes."""
    boxes = plane(lower=lower, upper=3, element_type=element_type)
    held = HELD.replace("\nLOWER_LEFT, 1\nUPPER_LEFT, 1", "") if element_type == "CAX4" else HELD
    result = run_deck(two_boxes(*boxes, [held, pressed(0.02)], pair=pair))
    stress = -YOUNG * 0.01 / (1 - 0.3**2 if element_type == "CPE4" else 1.0)
    area = np.pi * 2**2 if element_type == "CAX4" else 2 * THICKNESS
    for end, sign in (("LOWER_BOTTOM", -1), ("UPPER_TOP", 1)):
        assert total(result, "RF2", end)[-1] == pytest.approx(sign * stress * area, rel=1e-10)
    np.testing.assert_allclose(result.field("S22"), stress, rtol=1e-10)
    np.testing.assert_allclose(result.field("S11"), 0.0, atol=1e-10 * abs(stress))
    assert [(row.severe_discontinuity_iterations, row.iterations) for row in result.status] == [(0, 1)]


@PAIRS
@pytest.mark.parametrize("element_type", ["CPE4T", "CPE4RT", "C3D8T"])
def test_warm_bodies_close_a_gap(run_deck, pair, element_type):
    """No heat crosses. Between walls strains are (stress (1 + nu) (1 - 2 nu) / E + (1 + nu) alpha T) / (1 - nu)."""
    gap, alpha, warm, cold, nu = 0.01, 1e-3, 20.0, 10.0, 0.3
    lower, upper = plane(gap, element_type=element_type)
    held, side = HELD + "\nLOWER_RIGHT, 1\nUPPER_RIGHT, 1", ""
    if element_type == "C3D8T":
        lower = Box("LOWER", element_type, (0, 0, 0), (2, THICKNESS, 1), (2, 1, 1))
        upper = Box("UPPER", element_type, (0, 0, 1 + gap), (2, THICKNESS, 2 + gap), (2, 1, 1), first=1001)
        held = held.replace("BOTTOM, 2", "BOTTOM, 3") + "".join(f"\n{name}_FACE, 2" for name in ("LOWER", "UPPER"))
        side = "".join(
            f"*NSET, NSET={box.name}_FACE\n" + "".join(f"{k},\n" for k in np.ravel(box.numbers))
            for box in (lower, upper)
        )
    top = 3 if side else 2
    law = f"*ELASTIC\n{YOUNG}, {nu}\n*EXPANSION\n{alpha}\n*CONDUCTIVITY\n1."
    ends = f"*BOUNDARY\nUPPER_TOP, {top}\nUPPER_TOP, 11, 11, {warm}\nLOWER_BOTTOM, 11, 11, {cold}"
    warming = step("1., 1.", ends).replace("*STATIC", "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE")
    warming = warming.replace("*OUTPUT, FIELD", "*OUTPUT, FIELD\n*NODE OUTPUT\nU, NT")
    result = run_deck(two_boxes(lower, upper, [held, warming], pair=pair, model=side.rstrip(), law=law))
    stress = (gap * (1 - nu) - (1 + nu) * alpha * (warm + cold)) * YOUNG / (2 * (1 + nu) * (1 - 2 * nu))
    assert total(result, f"RF{top}", "UPPER_TOP")[-1] == pytest.approx(2 * THICKNESS * stress, rel=1e-9)
    temperatures = result.field("NT11")
    of_lower = np.arange(len(temperatures)) < lower.numbers.size
    np.testing.assert_allclose(temperatures, np.where(of_lower, cold, warm), rtol=1e-9)


@pytest.mark.parametrize(
    ("pair", "along", "error"),
    [
        ("SMALL SLIDING", 2, 1e-10),
        (SLIDING, 2, 1e-10),
        (SURFACES, 2, 1e-10),
        (SURFACES, 3, 0.01),
        (SLIDING_SURFACES, 2, 1e-10),
        (SLIDING_SURFACES, 3, 0.01),
    ],
)
def test_patch_of_bricks(run_deck, pair, along, error):
    """Between surfaces on matching meshes, and on others as well as the points of a face integrate."""
    lower = Box("LOWER", "C3D8", (0, 0, 0), (2, 3, 1), (along, 3, 1))
    upper = Box("UPPER", "C3D8", (0, 0, 1), (2, 3, 3), (2, 3, 2), first=1001)
    held = "*BOUNDARY\nLOWER_BOTTOM, 3\nLOWER_LEFT, 1\nUPPER_LEFT, 1\nLOWER_FRONT, 2\nUPPER_FRONT, 2"
    result = run_deck(two_boxes(lower, upper, [held, step("1., 1.", "*BOUNDARY\nUPPER_TOP, 3, 3, -0.03")], pair=pair))
    np.testing.assert_allclose(result.field("S33"), -YOUNG * 0.01, rtol=error)
    assert total(result, "RF3", "UPPER_TOP")[-1] == pytest.approx(-YOUNG * 0.01 * 6, rel=error)


def test_meshes_that_do_not_match(run_deck):
    """Node to surface fails the patch test, but forces balance; on one face of the main surface it passes.

    Constant pressure on nodes at 0, 2/3, 4/3 and 2 gives the nodes at 0, 1 and 2 5/9, 8/9 and 5/9 of it in place of
    1/2, 1, 1/2: such forces do not belong to a constant stress.
    """
    boxes = plane(lower=2, upper=3)
    result = run_deck(two_boxes(*boxes, [HELD, pressed(0.02)]))
    forces = [total(result, "RF2", end)[-1] for end in ("LOWER_BOTTOM", "UPPER_TOP")]
    assert forces[0] == pytest.approx(-forces[1], rel=1e-10)
    stress = -YOUNG * 0.01 / (1 - 0.3**2)
    error = np.abs(result.field("S22") / stress - 1).max()
    assert 0.01 < error < 0.2
    single = run_deck(two_boxes(*plane(lower=1, upper=3), [HELD, pressed(0.02)]))
    np.testing.assert_allclose(single.field("S22"), stress, rtol=1e-10)


@pytest.mark.parametrize(
    ("behavior", "stiffness", "clearance"),
    [
        ("*SURFACE BEHAVIOR, PENALTY\n5000.", 5000.0, 0.0),
        ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD, PENALTY=LINEAR\n5000., 0.002, 0.1", 500.0, 0.002),
        ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2000.", 2000.0, 0.0),
        ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", np.inf, 0.0),
        ("*SURFACE BEHAVIOR, DIRECT", np.inf, 0.0),
    ],
)
def test_stiffness_in_series_with_the_bodies(run_deck, behavior, stiffness, clearance):
    """Two columns of height 1 with nu = 0: p (1/E + 1/E + 1/k) = displacement - (gap - clearance)."""
    boxes = plane(gap=0.01)
    result = run_deck(two_boxes(*boxes, [HELD, pressed(0.02)], nu=0.0, behavior=behavior))
    pressure = (0.02 - 0.01 + clearance) / (2 / YOUNG + 1 / stiffness)
    assert total(result, "RF2", "UPPER_TOP")[-1] == pytest.approx(-pressure * 2 * THICKNESS, rel=1e-9)
    assert [(row.severe_discontinuity_iterations, row.iterations) for row in result.status] == [(1, 1)]


@pytest.mark.parametrize("deep", [0.005, 0.02, 0.05])
def test_stiffness_that_grows(run_deck, deep):
    """PENALTY=NONLINEAR, default ratios: K/100 up to 1 % of the length of a face, 1 here, K from 3 % on; between them
    the stiffness is linear and the pressure its integral. The columns of height 1 are E/2 in series.
    """
    final = 5000.0
    pressure = final / 100 * deep + 0.99 * final * (
        max(min(deep, 0.03) - 0.01, 0.0) ** 2 / 0.04 + max(deep - 0.03, 0.0)
    )
    behavior = f"*SURFACE BEHAVIOR, PENALTY=NONLINEAR\n{final}"
    moved = f"*BOUNDARY\nUPPER_TOP, 2, 2, {-(deep + 2 * pressure / YOUNG)}"
    moved = step("1., 1.", moved, "*CONTROLS, PARAMETERS=FIELD\n1e-9, 1e-6")
    result = run_deck(two_boxes(*plane(), [HELD, moved], nu=0.0, behavior=behavior))
    assert total(result, "RF2", "UPPER_TOP")[-1] == pytest.approx(-pressure * 2 * THICKNESS, rel=1e-8)


@PAIRS
def test_interference_is_resolved_at_once_unless_nodes_are_adjusted(run_deck, pair):
    """Overlap h of two columns of height 1: p = E h / 2, in the first increment; ADJUST leaves no stress."""
    boxes = plane(gap=-0.01)
    steps = [HELD, step("0.25, 1.", "*BOUNDARY\nUPPER_TOP, 2")]
    result = run_deck(two_boxes(*boxes, steps, nu=0.0, pair=pair))
    found = total(result, "RF2", "UPPER_TOP")
    np.testing.assert_allclose(found[1:], -YOUNG * 0.01 / 2 * 2 * THICKNESS, rtol=1e-9)
    for adjust in ("ADJUST=0.", "ADJUST", "ADJUST=SEC"):
        model = "*NSET, NSET=SEC, GENERATE\n1001, 1100"
        result = run_deck(two_boxes(*boxes, steps, nu=0.0, pair=f"{pair}, {adjust}", model=model))
        assert np.abs(total(result, "RF2", "UPPER_TOP")).max() < 1e-12


def test_adjust_moves_nodes_that_are_near(tmp_path):
    boxes = plane(gap=0.01)
    for adjust, moved in (("0.02", True), ("0.005", False), ("0.", False)):
        pair = f"SMALL SLIDING, ADJUST={adjust}"
        (tmp_path / "deck.inp").write_text(two_boxes(*boxes, [HELD, pressed(0.1)], pair=pair))
        model = read_deck(tmp_path / "deck.inp")
        places = model.mesh.coordinates[model.contacts[0].nodes[:, 0], 1]
        np.testing.assert_allclose(places, 1.0 if moved else 1.01)
        np.testing.assert_allclose(model.contacts[0].clearances, 0.0 if moved else 0.01, atol=1e-15)


def test_contact_variables(run_deck):
    """Pressure and clearance of the secondary nodes, in the order of the mesh; not of others."""
    boxes = plane(gap=0.01)
    squeeze = step("0.25, 1., 1e-5, 0.25", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.02")
    result = run_deck(two_boxes(*boxes, [HELD, squeeze], nu=0.0, behavior="*FRICTION\n0.3,"))
    on_it = np.isin(result.mesh().point_data["NODE"], boxes[1].numbers[:, 0])
    for increment, clearance, pressure in ((1, 0.005, 0.0), (-1, 0.0, YOUNG * 0.005)):
        for name, value in (("COPEN", clearance), ("CPRESS", pressure), ("CSHEAR1", 0.0), ("CSHEAR2", 0.0)):
            found = result.field(name, increment)
            np.testing.assert_allclose(found[on_it], value, atol=1e-12, rtol=1e-9)
            assert np.isnan(found[~on_it]).all()


def test_friction_stress(run_deck):
    """Full slip: mu p everywhere, against the motion of the upper body along the tangent -1 of the normal 2."""
    boxes = plane(lower=1, upper=1)
    steps = [
        "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2",
        step("1., 1.", "*BOUNDARY\nUPPER_TOP, 1\nUPPER_TOP, 2, 2, -0.02\nUPPER_BOTTOM, 1"),
        step("0.25, 1.", "*BOUNDARY\nUPPER_TOP, 1, 1, 0.5\nUPPER_BOTTOM, 1, 1, 0.5"),
    ]
    result = run_deck(two_boxes(*boxes, steps, nu=0.0, behavior="*FRICTION\n0.3,"))
    on_it = np.isin(result.mesh().point_data["NODE"], boxes[1].numbers[:, 0])
    np.testing.assert_allclose(result.field("CPRESS")[on_it], YOUNG * 0.02, rtol=1e-9)
    np.testing.assert_allclose(np.abs(result.field("CSHEAR1")[on_it]), 0.3 * YOUNG * 0.02, rtol=1e-9)


# ------------------------------------------------------------ large displacements


@PAIRS
@pytest.mark.parametrize("behavior", ["", "*SURFACE BEHAVIOR, PENALTY\n1e5"])
def test_bodies_that_turn(run_deck, behavior, pair):
    """Two bodies are pressed together, then turned by 70 degrees: the forces turn with them, in space too.

    Rubber does not remember that its ends went straight to where they are.
    """
    turn = np.radians(70.0)
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    for space in (False, True):
        if space:
            # where faces meet at an angle, finite sliding in space takes the normal of either
            cells = (1 if pair == SLIDING else 2, 1, 1)
            lower = Box("LOWER", "C3D8", (0, 0, 0), (2, 1, 1), cells)
            upper = Box("UPPER", "C3D8", (0, 0, 1), (2, 1, 2), cells, first=1001)
        else:
            lower, upper = plane()
        up = lower.nodes.shape[1]
        first, second = [], []
        for box, end in ((lower, 0), (upper, -1)):
            for number in box.numbers[..., end].ravel():
                place = box.nodes[number - box.first].copy()
                place[-1] -= 0.02 * (end == -1)
                moved = np.array([place[0], place[-1]]) @ rotation.T - box.nodes[number - box.first][[0, -1]]
                first += [f"{number}, 1, {up - 1}", f"{number}, {up}, {up}, {-0.02 * (end == -1)}"]
                second += [f"{number}, 1, 1, {moved[0]}", f"{number}, {up}, {up}, {moved[1]}"]
                second += [f"{number}, 2, 2"] * space
        tight = "*CONTROLS, PARAMETERS=FIELD\n1e-9, 1."
        steps = [
            step("1., 1.", tight, "*BOUNDARY", *first, options=", NLGEOM"),
            step("0.1, 1.", "*BOUNDARY, OP=NEW", *second),
        ]
        law = "*HYPERELASTIC, NEO HOOKE\n200., 0.005"
        result = run_deck(two_boxes(lower, upper, steps, behavior=behavior, pair=pair, law=law))
        of_step = result.history["step"]
        before, after = (
            np.array([total(result, name, "UPPER_TOP")[of_step == k][-1] for name in ("RF1", f"RF{up}")])
            for k in (1, 2)
        )
        assert abs(before[1]) > 1.0
        np.testing.assert_allclose(after, rotation @ before, atol=1e-6 * abs(before[1]))


def test_same_as_one_body_in_large_displacements(run_deck):
    """Matching meshes without friction, squeezed by a quarter: those of one body with nu = 0."""
    boxes = plane()
    whole = Box("UPPER", "CPE4", (0, 0), (2, 2), (2, 2))
    squeeze = step("0.25, 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.5", options=", NLGEOM")
    apart = run_deck(two_boxes(*boxes, [HELD, squeeze], nu=0.0))
    lines = [*whole.lines(), f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, 0.", "*BOUNDARY\nUPPER_BOTTOM, 2\nUPPER_LEFT, 1"]
    found = total(apart, "RF2", "UPPER_TOP")[-1]
    alone = run_deck([*lines, squeeze.replace("LOWER", "UPPER")])
    assert found == pytest.approx(total(alone, "RF2", "UPPER_TOP")[-1], rel=1e-6)


# ------------------------------------------------------------ opening and closing


def test_convert_sdi(run_deck, tmp_path):
    """NO: an increment ends with an iteration without changes; after I_S of them it is cut back."""
    boxes = plane(gap=0.01)
    steps = [HELD, step("1., 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.02", options=", CONVERT SDI=NO")]
    result = run_deck(two_boxes(*boxes, steps))
    assert [(row.severe_discontinuity_iterations, row.iterations) for row in result.status] == [(1, 1)]
    assert "EQUILIBRIUM WILL BE CHECKED" not in result.file(".msg").read_text()
    assert re.search(r"MAXIMUM ITERATIONS FOR SEVERE DISCONTINUITIES +12\n", result.file(".msg").read_text())
    few = "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n, , , , , , 1\n"
    steps[1] = steps[1].replace("*BOUNDARY", few + "*BOUNDARY")
    with pytest.raises(ConvergenceError, match="TOO MANY ATTEMPTS"):
        run_deck(two_boxes(*boxes, steps), name="cut")
    assert "SUBDIVISION AFTER 1 ITERATIONS FOR SEVERE DISCONTINUITIES" in (tmp_path / "cut.msg").read_text()


def test_separation_and_contact_again(run_deck):
    """The upper body is lifted by 0.01 and pressed by it, twice: no force while it is up, -E 0.005 while it is down."""
    boxes = plane()
    wave = "*AMPLITUDE, NAME=WAVE\n0., 0., 1., 1., 2., -1., 3., 1., 4., -1."
    text = two_boxes(
        *boxes,
        [HELD, step("0.5, 4.", "*BOUNDARY, AMPLITUDE=WAVE\nUPPER_TOP, 2, 2, -0.01", options=", INC=50")],
        nu=0.0,
        model=wave,
    )
    result = run_deck(text)
    time = result.history["time"]
    wanted = -YOUNG * 0.005 * 2 * THICKNESS * np.maximum(np.interp(time, range(5), (0, 1, -1, 1, -1)), 0)
    np.testing.assert_allclose(total(result, "RF2", "UPPER_TOP"), wanted, atol=1e-9)
    severe = [row.severe_discontinuity_iterations for row in result.status]
    assert sum(severe) == 3
    assert all(row.iterations <= 2 for row in result.status)


def test_severe_discontinuity_iterations_in_the_files(run_deck):
    boxes = plane(gap=0.01)
    result = run_deck(two_boxes(*boxes, [HELD, step("0.4, 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.02")]))
    assert [(row.severe_discontinuity_iterations, row.iterations) for row in result.status][:2] == [(0, 1), (1, 1)]
    text = result.file(".msg").read_text()
    for words in (
        "EQUILIBRIUM WILL BE CHECKED FOR SEVERE DISCONTINUITY ITERATIONS",
        "     MAXIMUM ITERATIONS FOR SEVERE DISCONTINUITIES                            50",
        "                    3 SEVERE DISCONTINUITIES OCCURRED DURING THIS ITERATION.\n"
        "                    3 POINTS CHANGED FROM OPEN TO CLOSED\n\n"
        "               CONVERGENCE CHECKS FOR SEVERE DISCONTINUITY ITERATION     1\n",
        "OF CONTACT PAIR\n   (UPPER_LOW,LOWER_HIGH)\n",
        "PENETRATION ERROR TOO LARGE COMPARED TO DISPLACEMENT INCREMENT.",
        "THE CONTACT CONSTRAINTS HAVE CONVERGED.",
        " ITERATION SUMMARY FOR THE INCREMENT:   2 TOTAL ITERATIONS, OF WHICH\n"
        "   1 ARE SEVERE DISCONTINUITY ITERATIONS AND  1 ARE EQUILIBRIUM ITERATIONS.",
    ):
        assert words in text


def test_what_the_run_refuses(run_deck, tmp_path):
    text = two_boxes(*plane(), [HELD, pressed(0.02)])
    for option, name in (("fallback", "--fallback"), ("energy_control", "--control energy")):
        with pytest.raises(UsageError, match=rf"{name}: not supported with \*CONTACT PAIR \(.*deck\.inp:\d+\)"):
            run_deck(text, solver=SolverOptions(**{option: True}))
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*CONTACT PAIR does not run on 2 ranks; run this deck in one"):
        refuse_unshared(read_deck(tmp_path / "deck.inp"), SimpleNamespace(size=2))


def test_error_says_where_contact_has_not_converged(run_deck):
    """One severe discontinuity iteration is allowed, and that of the first increment is not enough."""
    few = "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n, , , , , , , , , , 1"
    steps = [HELD, step("1., 1., 1., 1.", few, "*BOUNDARY\nUPPER_TOP, 2, 2, -0.02")]
    for behavior, message in (
        ("", r"penetration -0\.01 at node 1001 of contact pair \(UPPER_LOW,LOWER_HIGH\)"),
        ("*SURFACE BEHAVIOR, PENALTY\n1e5", r"contact force error 1500 at node 1003 of contact pair"),
    ):
        with pytest.raises(ConvergenceError) as caught:
            run_deck(two_boxes(*plane(gap=0.01), steps, behavior=behavior))
        notes = "\n".join(caught.value.__notes__)
        assert re.search(f"last iteration: largest {message}", notes)
        assert "--fallback" not in notes


# ------------------------------------------------------------ friction


@PAIRS
def test_block_sticks_and_slips(run_deck, pair):
    """A stiff block under a constant force N is pushed: it sticks until the force is mu N, and turns back likewise.

    Sticking, the friction force is mu N / gamma_crit times the slip, gamma_crit = 0.005 of a face.
    """
    force, friction = 30.0, 0.4
    boxes = plane(lower=1, upper=1, width=1.0)
    crit = 0.005 * 1.0
    loads = "*CLOAD\n" + "\n".join(f"{number}, 2, {-force / 2}" for number in boxes[1].numbers[:, -1])
    push = step(
        "0.05, 4.",
        "*BOUNDARY, AMPLITUDE=WAVE",
        f"UPPER_LEFT, 1, 1, {2 * crit}",
        f"UPPER_RIGHT, 1, 1, {2 * crit}",
        options=", INC=200",
        output="*NODE OUTPUT, NSET=UPPER_LEFT\nRF1\n*NODE OUTPUT, NSET=UPPER_RIGHT\nRF1",
    )
    press = step("1., 1.", loads, "*BOUNDARY\nUPPER_LEFT, 1\nUPPER_RIGHT, 1")
    text = two_boxes(
        *boxes,
        ["*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2", press, push],
        nu=0.0,
        pair=pair,
        behavior=f"*FRICTION\n{friction},",
        model="*AMPLITUDE, NAME=WAVE\n0., 0., 1., 1., 3., -1., 4., 1.",
    )
    result = run_deck(text)
    found = total(result, "RF1", "UPPER_LEFT", "UPPER_RIGHT")
    time = result.history["time"]
    slip, elastic, wanted = 0.0, 0.0, []
    for moment in time:
        at = 2 * crit * np.interp(moment - 1, (0, 1, 3, 4), (0, 1, -1, 1)) if moment > 1 else 0.0
        elastic = np.clip(elastic + at - slip, -crit, crit)
        slip = at
        wanted.append(friction * force * elastic / crit)
    np.testing.assert_allclose(found[1:], wanted[1:], atol=1e-6 * friction * force)
    assert max(wanted) == pytest.approx(friction * force)
    assert "POINTS CHANGED FROM STICKING TO SLIPPING" in result.file(".msg").read_text()


# ------------------------------------------------------------ curved surfaces


@pytest.mark.parametrize(("pair", "faces"), [("SMALL SLIDING", 1), (SLIDING, 1), (SURFACES, 2), (SLIDING_SURFACES, 2)])
def test_hertz_line_contact(run_deck, pair, faces):
    """A cylinder on a rigid plane: half-width b = sqrt(4 P R / (pi E*)), largest pressure 2 P / (pi b).

    K. L. Johnson, Contact Mechanics (1985), section 4.2. A block of 20 b by 20 b replaces a half of the half-space, its
    upper side goes down; its lower side has the parabola of the cylinder. The plane is the main surface, whose nodes
    are opposite: their reactions are the contact forces. Each is a mean of the pressure over a face of 0.1, between
    surfaces over two, so b is known to one or two of them, and the mean is the less exact the nearer the edge.
    """
    radius, reduced, size, edge = 50.0, YOUNG / (1 - 0.3**2), 20.0, 0.1
    across = np.concatenate([np.arange(0, 1.55, edge), 1.5 + np.geomspace(0.12, size - 1.5, 14)])
    body = Box("UPPER", "CPE4", (0, 0), (1, 1), (len(across) - 1, len(across) - 1), first=10001)
    height = across**2 / (2 * radius)
    x, y = np.meshgrid(across, across, indexing="ij")
    body.nodes = np.stack([x, y + height[:, None] * (1 - y / size)], axis=-1).reshape(-1, 2)
    plate = Box("LOWER", "CPE4", (0, -1), (1, 0), (len(across) - 1, 1))
    plate.nodes = np.stack(np.meshgrid(across, (-1.0, 0.0), indexing="ij"), axis=-1).reshape(-1, 2)
    load = step("1., 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -0.05", output="*NODE OUTPUT, NSET=LOWER_TOP\nRF2")
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nLOWER_TOP, 1, 2\nUPPER_LEFT, 1"
    result = run_deck(two_boxes(plate, body, [held, load], pair=pair))
    found = np.array([result.history[f"RF2[LOWER_TOP:{number}]"][-1] for number in plate.numbers[:, 1]])
    force = 2 * found.sum() / THICKNESS
    assert -total(result, "RF2", "UPPER_TOP")[-1] * 2 / THICKNESS == pytest.approx(force, rel=1e-9)
    half = np.sqrt(4 * force * radius / (np.pi * reduced))
    assert 0.7 < half < 1.3
    last = across[found > 0].max()
    assert half - edge <= last <= half + faces * edge
    np.testing.assert_array_equal(found > 0, across <= last)
    share = np.gradient(across) * THICKNESS
    share[0] /= 2
    inner = across < 0.75 * half
    wanted = 2 * force / (np.pi * half) * np.sqrt(1 - (across[inner] / half) ** 2)
    np.testing.assert_allclose((found / share)[inner], wanted, rtol=0.03)


# ------------------------------------------------------------ the block of points


BOND = Cohesion(
    (30.0, 20.0, 10.0), SOURCE, Damage("MAXS", (0.3, 0.2, 0.1), SOURCE, DamageEvolution(*SOFTENING, SOURCE))
)


def pair_of(dimension, stiffness, friction, rng, cohesion=None):
    """A pair of two points, whose normals have any direction."""
    count = 3 if dimension == 2 else 5
    nodes = np.arange(2 * count).reshape(2, count)
    normals = rng.normal(size=(2, 3))
    if dimension == 2:
        normals[:, 2] = 0.0
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    shares, slopes = np.ones((2, count)), rng.normal(size=(2, count, dimension - 1))
    shares[:, 1:] = -rng.dirichlet(np.ones(count - 1), size=2)
    slopes -= slopes.mean(axis=1, keepdims=True)
    # the stiffness grows from overclosures of 0.2 to 0.6
    surface = ContactProperty("P", SOURCE, stiffness=stiffness, friction=friction, initial=0.1, cohesion=cohesion)
    clearances, areas = np.array([0.01, -0.02]), np.array([1.5, 0.7])
    pair = ContactPair("(A,B)", surface, SOURCE, dimension, nodes, shares, slopes, normals, clearances, areas, 20.0)
    mesh = Mesh(np.arange(1, nodes.size + 1), rng.normal(size=(nodes.size, 3)), ("",) * nodes.size)
    group = ElementGroup("U1", np.array([1]), nodes[:1], "", UserProperty("ALL", SOURCE), None, SOURCE)
    block = ContactBlock(Model(Path("test.inp"), "", mesh, (group,), ()), pair)
    size = len(block.unknowns)
    equations = np.arange(2 * size, dtype=np.int32).reshape(2, size)
    block.number(lambda nodes, dof: nodes // count * size + nodes % count * dimension + dof - 1, equations)
    dense = np.arange(2 * size, dtype=np.int32)
    block.locate(2 * size * np.arange(2 * size + 1, dtype=np.int32), np.tile(dense, 2 * size))
    return block


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("moved", [0.01, 1.0])
@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("cohesion", [None, BOND], ids=["", "bonded"])
def test_matrix_by_differences(call, dimension, stiffness, friction, moved, nlgeom, cohesion):
    """Points that stick (moved little) and slip (moved far), and one of them open at times, where it may be bonded."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        block = pair_of(dimension, stiffness, friction, rng, cohesion)
        n = 2 * len(block.unknowns)
        u = moved * rng.normal(size=n)
        if block.direct:
            u[n // 2 - 1 :: n // 2] = moved * rng.random(2)  # multipliers: pressures
        first, second = (replace(call, iteration=k, flags=Flags(1, nlgeom)) for k in range(2))
        asked = second.asking(Request.RESIDUAL)
        matrix = np.zeros(n * n)
        matrix[:: n + 1] = 7.0
        block.contribute(CurrentPass(first, 0 * u, 0 * u, np.zeros((1, n)), matrix.copy()))
        given = matrix.copy()
        block.contribute(CurrentPass(second, u, u, np.zeros((1, n)), given))
        found = (given - matrix).reshape(n, n)

        def forces(x, block=block, asked=asked):
            now = CurrentPass(asked, x, x, np.zeros((1, len(x))), None)
            block.contribute(now)
            return now.columns[0]

        step_size = 1e-6 * moved
        wanted = np.stack(
            [-(forces(u + step_size * e) - forces(u - step_size * e)) / (2 * step_size) for e in np.eye(n)], axis=1
        )
        np.testing.assert_allclose(found, wanted, atol=1e-6 * max(1.0, np.abs(wanted).max()))
        if not friction and not cohesion:
            np.testing.assert_allclose(found, found.T, atol=1e-12 * np.abs(found).max())


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_points_that_do_not_move_on_stick_after_an_increment_with_slip(call, dimension, nlgeom):
    """Their elastic slip is the largest one but for rounding, which would choose the status otherwise."""
    rng = np.random.default_rng(6)
    slipped = 0
    for _ in range(50):
        block = pair_of(dimension, 40.0, 0.3, rng)
        n = 2 * len(block.unknowns)
        first, second = (replace(call, iteration=k, flags=Flags(1, nlgeom)) for k in range(2))
        u = rng.normal(size=n)
        for at, change in ((first, 0 * u), (second, u)):
            block.contribute(CurrentPass(at, change, change, np.zeros((1, n)), np.zeros(n * n)))
        block.commit()
        slipping = block.kept()["status"] == SLIPPING
        slipped += np.count_nonzero(slipping)
        for at in (first, second):
            block.contribute(CurrentPass(at, u, 0 * u, np.zeros((1, n)), np.zeros(n * n)))
        block.commit()
        assert (block.kept()["status"][slipping] == STICKING).all()
    assert slipped > 30


@pytest.mark.parametrize("dimension", [2, 3])
def test_rigid_motion(call, dimension):
    """Clearances stay, and nothing slips; the forces of both balance, and so do their moments."""
    rng = np.random.default_rng(7)
    block = pair_of(dimension, None, 0.0, rng)
    kinematics, places = block._motion, block._motion._coordinates
    rotation = np.linalg.qr(rng.normal(size=(dimension, dimension)))[0]
    rotation[:, 0] *= np.sign(np.linalg.det(rotation))
    at_rest = kinematics.finite(np.zeros(places.shape).reshape(2, -1))
    turned = places @ rotation.T + rng.normal(size=dimension)
    found = kinematics.finite((turned - places).reshape(2, -1))
    np.testing.assert_allclose(found.value, at_rest.value, atol=1e-12)
    motion = (turned - places).reshape(2, -1)
    slips = kinematics.slips(motion, motion, np.zeros((2, dimension - 1)))
    np.testing.assert_allclose(slips.value, 0.0, atol=1e-12)
    kinematics.finite(0.0 * motion)
    before = kinematics.slips(0.0 * motion, 0.0 * motion, np.zeros((2, dimension - 1)))
    by, start = (one.by.reshape(2, -1, *places.shape[1:]) for one in (slips, before))
    np.testing.assert_allclose(by, start @ rotation.T, atol=1e-12)
    np.testing.assert_allclose(by.sum(axis=2), 0.0, atol=1e-12)
    couples = np.einsum("mnp,mtnq->mtpq", turned, by)
    np.testing.assert_allclose(couples, couples.transpose(0, 1, 3, 2), atol=1e-12)
    forces = found.gradient.reshape(places.shape)
    np.testing.assert_allclose(forces, at_rest.gradient.reshape(places.shape) @ rotation.T, atol=1e-12)
    np.testing.assert_allclose(forces.sum(axis=1), 0.0, atol=1e-12)
    moments = np.einsum("mnp,mnq->mpq", turned, forces)
    np.testing.assert_allclose(moments, moments.transpose(0, 2, 1), atol=1e-12)


def test_status_is_that_of_the_increment_until_it_is_committed(call):
    """A cutback starts again from the status at the start of the increment; a state that is kept has it too."""
    block = pair_of(2, None, 0.0, np.random.default_rng(1))
    n = 2 * len(block.unknowns)
    zero = np.zeros(n)
    data = np.zeros(n * n)
    data[:: n + 1] = 1.0

    def changes(iteration, u):
        now = CurrentPass(replace(call, iteration=iteration), u, u, np.zeros((1, n)), data.copy())
        return block.contribute(now).contact

    changes(0, zero)
    np.testing.assert_array_equal(block.kept()["status"], [OPEN, STICKING])
    pulled = zero.copy()
    pulled[n - 1] = -1.0  # the multiplier of the second point: tension
    opening = changes(1, pulled)
    assert opening.opened == 1
    assert opening.force[0] == -1.0
    assert not changes(0, zero).count
    changes(1, pulled)
    block.commit()
    kept = block.kept()
    np.testing.assert_array_equal(kept["status"], [OPEN, OPEN])
    other = pair_of(2, None, 0.0, np.random.default_rng(1))
    other.resume(kept)
    np.testing.assert_array_equal(other.kept()["status"], [OPEN, OPEN])
    with pytest.raises(ValueError, match=r"contact pair \(A,B\)"):
        other.resume({**kept, "status": np.zeros(3)})
