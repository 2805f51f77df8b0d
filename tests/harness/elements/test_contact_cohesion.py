# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface-based cohesive behaviour: closed forms, cohesive elements of the same law, derivatives, friction."""

from dataclasses import replace

import numpy as np
import pytest
from contact_decks import YOUNG, Box, plane, step, total, two_boxes
from contact_points import SOURCE, Points
from test_contact_finite_sliding import pair_of as nodes_pair
from test_contact_surface_to_surface import pair_of as surfaces_pair

from uel.errors import DeckError
from uel.model.contact import Cohesion
from uel.model.damage import Damage, DamageEvolution

THICKNESS = 1.5
HELD = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nUPPER_TOP, 1"
LAW = (
    "*DAMAGE INITIATION, CRITERION=QUADS\n4., 6., 6.\n*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER=1.5"
)
LAW += "\n0.06, 0.15, 0.15\n*DAMAGE STABILIZATION\n0.02"
BOND = "*COHESIVE BEHAVIOR\n2000., 1500., 1500."
PAIRS = pytest.mark.parametrize(
    "pair",
    ["SMALL SLIDING", "SMALL SLIDING, TYPE=SURFACE TO SURFACE", "TYPE=NODE TO SURFACE", "TYPE=SURFACE TO SURFACE"],
    ids=["nodes", "surfaces", "sliding", "both"],
)


def pulled(by, times="0.05, 1., 1e-6, 0.05", extra=""):
    lines = [f"*BOUNDARY\nUPPER_TOP, 2, 2, {by}", "*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-4"]
    return step(times, *lines, *([extra] if extra else []))


@PAIRS
def test_bond_in_series_with_the_bodies(run_deck, pair):
    """Two columns of height 1 with nu = 0: p (2/E + 1/K) = displacement in tension, K infinite in compression."""
    for by, compliance in ((0.02, 2 / YOUNG + 1 / 2000), (-0.02, 2 / YOUNG)):
        result = run_deck(two_boxes(*plane(), [HELD, pulled(by, "1., 1.")], nu=0.0, behavior=BOND, pair=pair))
        assert total(result, "RF2", "UPPER_TOP")[-1] == pytest.approx(by / compliance * 2 * THICKNESS, rel=1e-9)
        np.testing.assert_allclose(result.field("S22"), by / compliance, rtol=1e-9)


def elements_between(lower, upper, element_type):
    """Cohesive elements between the faces of two boxes with the same meshes there, in place of their contact pair."""
    low, high = lower.numbers[..., -1], upper.numbers[..., 0]
    if low.ndim == 1:
        rows = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    else:
        faces = [
            np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4) for n in (low, high)
        ]
        rows = np.concatenate(faces, axis=1)
    lines = [f"*ELEMENT, TYPE={element_type}, ELSET=GLUE"]
    lines += [", ".join(map(str, [5000 + k, *row])) for k, row in enumerate(rows.tolist())]
    lines += ["*COHESIVE SECTION, ELSET=GLUE, MATERIAL=G, RESPONSE=TRACTION SEPARATION, THICKNESS=SPECIFIED"]
    lines += [f"1., {THICKNESS}" if low.ndim == 1 else "1.,"]
    return "\n".join([*lines, "*MATERIAL, NAME=G\n*ELASTIC, TYPE=TRACTION\n2000., 1500., 1500."])


def bricks():
    return (
        Box("LOWER", "C3D8", (0, 0, 0), (6, 2, 1), (6, 1, 1)),
        Box("UPPER", "C3D8", (0, 0, 1), (6, 2, 2), (6, 1, 1), first=1001),
    )


@pytest.mark.parametrize(
    ("boxes", "element_type", "pair"),
    [
        (lambda: plane(lower=4, upper=4, width=4.0), "COH2D4", "SMALL SLIDING"),
        (lambda: plane(lower=8, upper=8, width=4.0), "COH2D4", "SMALL SLIDING, TYPE=SURFACE TO SURFACE"),
        (lambda: plane(lower=8, upper=8, width=4.0), "COH2D4", "TYPE=SURFACE TO SURFACE"),
        (bricks, "COH3D8", "SMALL SLIDING"),
    ],
    ids=["plane", "plane-surfaces", "plane-sliding", "space"],
)
def test_peeled_as_cohesive_elements_are(run_deck, boxes, element_type, pair):
    """One end is pulled and drawn: mixed mode, partly failed. Under pressure both have the stiffness of the law.

    The points of cohesive elements are the nodes, as those of node to surface. Surface to surface has means over the
    faces around a node, eight along the interface: they spread what differs from node to node.
    """
    lower, upper = boxes()
    normal = 2 if element_type == "COH2D4" else 3
    held = f"*BOUNDARY\nLOWER_BOTTOM, 1, {normal}"
    way = f"*BOUNDARY\nUPPER_RIGHT, {normal}, {normal}, 0.08\nUPPER_RIGHT, 1, 1, 0.05"
    energies = "*OUTPUT, HISTORY\n*ENERGY OUTPUT\nALLSE, ALLDMD"
    peel = step("0.1, 1., 1e-6, 0.1", way, "*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-4", energies)
    stiff = "*SURFACE BEHAVIOR, PENALTY\n2000.\n"
    found = run_deck(two_boxes(lower, upper, [held, peel], behavior=f"{stiff}{BOND}\n{LAW}", pair=pair))
    damage = found.field("CSDMG")
    damage = damage[np.isfinite(damage)]
    text = two_boxes(lower, upper, [held, peel], model=f"{elements_between(lower, upper, element_type)}\n{LAW}")
    wanted = run_deck(text.replace(text[text.index("*SURFACE INTERACTION") : text.index("*ELEMENT, TYPE=COH")], ""))
    assert damage.max() > 0.99
    assert damage.min() < 0.6
    exact = "SURFACE" not in pair
    for name in (f"RF{normal}", "RF1"):
        forces = total(wanted, name, "LOWER_BOTTOM")
        error = 1e-5 if exact else 0.1
        np.testing.assert_allclose(total(found, name, "LOWER_BOTTOM"), forces, atol=error * np.abs(forces).max())
    for name in ("ALLSE", "ALLDMD"):
        np.testing.assert_allclose(found.history[name][1:], wanted.history[name][1:], rtol=1e-4 if exact else 0.1)


@PAIRS
def test_torn_in_one_increment(run_deck, pair):
    """Bonds that an increment takes from intact to failed have dissipated the fracture energy of mode I, 0.06."""
    tear = pulled(0.2, "1., 1.", "*OUTPUT, HISTORY\n*ENERGY OUTPUT\nALLDMD")
    law = LAW[: LAW.index("\n*DAMAGE STABILIZATION")]
    result = run_deck(two_boxes(*plane(), [HELD, tear], nu=0.0, behavior=f"{BOND}\n{law}", pair=pair))
    assert len(result.history["ALLDMD"]) == 1
    assert result.history["ALLDMD"][-1] == pytest.approx(0.06 * 2 * THICKNESS, rel=1e-9)


def test_friction_takes_over(run_deck):
    """Pressed and drawn: the bond alone at first, K_s s on both nodes; friction mu N alone when it has failed."""
    stiff = f"*ELASTIC\n{1e7}, 0."
    behavior = f"{BOND}\n*DAMAGE INITIATION, CRITERION=MAXS\n4., 6., 6.\n*DAMAGE EVOLUTION, TYPE=DISPLACEMENT\n0.02"
    press = step("1., 1.", "*BOUNDARY\nUPPER_TOP, 2, 2, -1e-5")
    draw = [step("1., 1.", f"*BOUNDARY\nUPPER_TOP, 1, 1, {by}") for by in (0.001, 0.03, 0.031)]
    held = "*BOUNDARY\nLOWER_BOTTOM, 1, 2\nUPPER_TOP, 1"
    text = two_boxes(*plane(lower=1, upper=1), [held, press, *draw], law=stiff, behavior=f"*FRICTION\n0.3,\n{BOND}")
    result = run_deck(text.replace(BOND, behavior))
    area = 2 * THICKNESS
    along, pressure = total(result, "RF1", "LOWER_BOTTOM"), total(result, "RF2", "LOWER_BOTTOM")
    assert pressure[-1] == pytest.approx(1e-5 / 2 * 1e7 * area, rel=1e-3)
    assert along[1] == pytest.approx(-1500.0 * 0.001 * area, rel=2e-3)
    assert along[-1] == pytest.approx(-0.3 * pressure[-1], rel=1e-6)
    np.testing.assert_array_equal(result.field("CSDMG")[np.isfinite(result.field("CSDMG"))], 1.0)


def test_points_that_do_not_touch_at_the_start_are_not_bonded(run_deck):
    result = run_deck(
        two_boxes(*plane(gap=0.01), [f"{HELD}\nUPPER_TOP, 2", pulled(0.0, "1., 1.")], behavior=f"{BOND}\n{LAW}")
    )
    assert np.isnan(result.field("CSDMG")).all()
    assert np.abs(total(result, "RF2", "UPPER_TOP")).max() == 0.0


# ------------------------------------------------------------ the block of points


def with_bonds(pair, law):
    cohesion = Cohesion((30.0, 20.0, 20.0), SOURCE, law)
    return replace(pair, property=replace(pair.property, cohesion=cohesion))


BRITTLE = Damage(
    "QUADU", (0.05, 0.05, 0.05), SOURCE, DamageEvolution("ENERGY", "LINEAR", "BK", (0.5, 0.8, 0.8), 1.4, SOURCE)
)


@pytest.mark.sample(5)
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("law", [None, BRITTLE], ids=["elastic", "damaged"])
@pytest.mark.parametrize("lifted", [0.08, 0.3], ids=["closed", "pulled"])
@pytest.mark.parametrize(
    ("pair_of", "dimension"),
    [(nodes_pair, 2), (nodes_pair, 3), (surfaces_pair, 2), pytest.param(surfaces_pair, 3, marks=pytest.mark.long)],
    ids=["nodes-2", "nodes-3", "surfaces-2", "surfaces-3"],
)
def test_matrix_by_differences(call, pair_of, dimension, stiffness, friction, law, lifted):
    """Points of curved surfaces in finite sliding, some of them closed or all of them pulled, in a second increment."""
    rng = np.random.default_rng(5)
    overlap = {"height": -0.2} if pair_of is nodes_pair else {"overlap": 0.2}
    pair, coordinates = pair_of(dimension, rng, stiffness=stiffness, friction=friction, **overlap)
    points = Points(call, with_bonds(pair, law), coordinates, range(1, dimension + 1))
    upper = points.size - (len(pair.secondary) if points.block.direct else 0)
    rise = np.zeros((len(coordinates), dimension))
    rise[np.unique(pair.secondary), -1] = lifted
    start = 0.02 * rng.normal(size=points.size)
    start[:upper] += rise.ravel()
    if points.block.direct:
        start[points.multipliers] = rng.uniform(0.5, 1.0, points.size - upper) * (1.0 if lifted < 0.2 else -1.0)
    still = np.zeros(points.size)
    points.evaluate(points.first, still, still)
    points.evaluate(points.second, start, start)
    points.block.commit()
    points.evaluate(points.first, start, still)
    du = 0.02 * rng.normal(size=points.size)
    du[:upper] += 0.3 * rise.ravel()
    u = start + du
    _, found = points.evaluate(points.second, u, du)
    size = 1e-6
    ways = size * np.eye(points.size)
    wanted = [(points.forces(u - way, du - way) - points.forces(u + way, du + way)) / (2 * size) for way in ways]
    assert np.abs(wanted).max() > 1.0
    np.testing.assert_allclose(found, np.stack(wanted, axis=1), atol=2e-6 * np.abs(wanted).max())


def test_bonds_are_kept(call):
    """A cutback begins with the state at the start of the increment; a state that is kept has it too."""
    pair, coordinates = nodes_pair(2, np.random.default_rng(1), stiffness=40.0, height=-0.2)
    points = [Points(call, with_bonds(pair, BRITTLE), coordinates, (1, 2)) for _ in range(2)]
    still, lifted = np.zeros(points[0].size), np.zeros((len(coordinates), 2))
    lifted[pair.secondary, 1] = 0.3
    lifted = lifted.ravel()
    points[0].evaluate(points[0].first, still, still)
    first, _ = points[0].evaluate(points[0].second, lifted, lifted)
    again, _ = points[0].evaluate(points[0].second, lifted, lifted)
    np.testing.assert_array_equal(first, again)
    points[0].block.commit()
    points[1].block.resume(points[0].block.kept())
    for u in (lifted, still, 0.5 * lifted):
        forces = [one.evaluate(one.second, u, u - lifted)[0] for one in points]
        np.testing.assert_array_equal(*forces)
    assert 0.0 < points[0].block.bonds["CSDMG"].min() < 1.0


@pytest.mark.parametrize(
    ("pair", "law", "message"),
    [
        ("TYPE=SURFACE TO SURFACE", LAW.replace("QUADS", "MAXS"), "depends on the direction of shear, which is not su"),
        ("SMALL SLIDING", LAW.replace("0.06, 0.15", "0.001, 0.15"), "energy 0.001 of the normal mode must exceed"),
    ],
)
def test_laws_that_are_refused(run_deck, pair, law, message):
    text = two_boxes(*bricks(), [step("1., 1.", "*BOUNDARY\nLOWER_BOTTOM, 1, 3")], behavior=f"{BOND}\n{law}", pair=pair)
    with pytest.raises(DeckError, match=message):
        run_deck(text)
