# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact in steps with NLGEOM is objective: bodies that turn together keep the tractions between them.

All nodes are prescribed, so that the forces on the secondary nodes are those of the contact alone. A run opens or
shears the interface, holds it, and turns both bodies. A twin does the same but does not turn: its forces, turned, are
the expected ones. Tolerance: rounding of forces of about 10 over stiffnesses of 1e4 times coordinates of about 1.
"""

import numpy as np
import pytest
from contact_decks import Box, two_boxes
from scipy.spatial.transform import Rotation

ANGLES = (30, 90, 220)
EACH = 10
"""Degrees that an increment turns by."""
START = 5
"""Increments before the bodies turn."""
THICKNESS = 1.5

LAW = (
    "*DAMAGE INITIATION, CRITERION=QUADS\n4., 6., 6.\n*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK, POWER=1.5"
)
LAW += "\n0.06, 0.15, 0.15"
BOND = "*COHESIVE BEHAVIOR\n2000., 1500., 1500."
STIFF = "*SURFACE BEHAVIOR, PENALTY\n1e4"
EARLY = "*SURFACE BEHAVIOR, PENALTY\n100., 0.5"
"""Pressure from a clearance of 0.5 on."""


def boxes(dimension, gap=0.0):
    low, high, lifted = [0.0] * dimension, [1.0] * dimension, np.eye(dimension)[-1]
    upper = (lifted * (1 + gap)).tolist(), (np.array(high) + lifted * (1 + gap)).tolist()
    kind = "CPE4" if dimension == 2 else "C3D8"
    return Box("LOWER", kind, low, high, [1] * dimension), Box("UPPER", kind, *upper, [1] * dimension, first=1001)


def turn_of(dimension, degrees):
    axis = [0, 0, 1] if dimension == 2 else np.array([2.0, 1.0, 2.0]) / 3.0
    return Rotation.from_rotvec(np.radians(degrees) * np.array(axis, dtype=float)).as_matrix()[:dimension, :dimension]


def deck(dimension, behavior, pair, shift, *, turned, gap=0.0, between=None, last=ANGLES[-1]):
    """Upper body moved by `shift` (held in the frame that turns), then both turned; between: cohesive elements."""
    bodies = boxes(dimension, gap)
    text = two_boxes(*bodies, [], behavior=behavior, pair=pair)
    if between:
        text = text[: text.index("*SURFACE INTERACTION")] + between + "\n"
    angles = np.array([0] * (START + 1) + list(range(EACH, last + 1, EACH)))
    share = np.minimum(np.arange(len(angles)) / (START - 1), 1.0)
    count = len(angles) - 1
    lines, moves = [], []
    for body in bodies:
        for node, x in enumerate(body.nodes, start=body.first):
            at = [x + part * np.array(shift) * (body is bodies[1]) for part in share]
            u = [turn_of(dimension, a if turned else 0) @ place - x for a, place in zip(angles, at, strict=True)]
            for k in range(dimension):
                lines.append(f"*AMPLITUDE, NAME=A{node}_{k}, VALUE=ABSOLUTE")
                lines += [f"{n / count!r}, {float(one[k])!r}" for n, one in enumerate(u)]
                moves.append(f"*BOUNDARY, AMPLITUDE=A{node}_{k}\n{node}, {k + 1}, {k + 1}, 1.")
    step = [f"*STEP, NLGEOM, INC=1000, UNSYMM=YES\n*STATIC, DIRECT\n{1 / count!r}, 1.", *moves]
    return text + "\n".join([*lines, *step, "*OUTPUT, FIELD\n*NODE OUTPUT\nRF, U\n*END STEP"]) + "\n"


def forces(result, dimension):
    """Reactions (nodes, d) on the secondary surface at each of the ANGLES."""
    reactions = [result.field("RF", START + angle // EACH)[secondary(dimension), :dimension] for angle in ANGLES]
    assert np.abs(reactions).max(axis=(1, 2)).min() > 0.05
    return reactions


def secondary(dimension):
    """Positions of the nodes of the lower side of the upper body."""
    lower, upper = boxes(dimension)
    return len(lower.nodes) + np.ravel(upper.numbers[..., 0]) - upper.first


CASES = {
    "bond": (f"{STIFF}\n{BOND}", 0.1),
    "clearance": (EARLY + "\n" + BOND, 0.1),
    "damage": (f"{STIFF}\n{BOND}\n{LAW}", 0.02),
    "viscosity": (f"{STIFF}\n{BOND}\n{LAW}\n*DAMAGE STABILIZATION\n0.05", 0.02),
    "friction": (f"{EARLY}\n*FRICTION\n0.3", 0.2),
    "sticking": (f"{EARLY}\n*FRICTION, ELASTIC SLIP=1.\n0.3", 0.2),
    "softened": ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1000.\n*FRICTION\n0.3", -0.01),
}
PAIRS = ["SMALL SLIDING", "SMALL SLIDING, TYPE=SURFACE TO SURFACE"]
FINITE = ["TYPE=NODE TO SURFACE", "TYPE=SURFACE TO SURFACE"]


@pytest.mark.sample(7)
@pytest.mark.parametrize("pair", [*PAIRS, *FINITE])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("case", CASES)
def test_tractions_turn_with_the_bodies(run_deck, case, dimension, pair):
    behavior, lift = CASES[case]
    shift = [0.01, 0.02, lift][-dimension:]
    found, twin = (
        forces(run_deck(deck(dimension, behavior, pair, shift, turned=turned)), dimension) for turned in (True, False)
    )
    for angle, turned, still in zip(ANGLES, found, twin, strict=True):
        np.testing.assert_allclose(turned, still @ turn_of(dimension, angle).T, atol=1e-9)


@pytest.mark.parametrize("pair", [*PAIRS, FINITE[0]])
@pytest.mark.parametrize("dimension", [2, 3])
def test_bond_pulled_and_sheared(run_deck, dimension, pair):
    """The stiffnesses times separations of (0.001, 0.002), in axes that turn with the bodies."""
    shift = [0.0, 0.002, 0.001][-dimension:]
    result = run_deck(deck(dimension, f"{STIFF}\n{BOND}", pair, shift, turned=True, last=30))
    area = THICKNESS if dimension == 2 else 1.0
    local = area * np.array([0.0, 1500 * 0.002, 2000 * 0.001][-dimension:])
    total = result.field("RF")[secondary(dimension), :dimension].sum(axis=0)
    np.testing.assert_allclose(total, turn_of(dimension, 30) @ local, atol=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_bond_turns_as_cohesive_elements_do(run_deck, dimension):
    """COH2D4 and COH3D8 of the same law; the forces on the nodes, opened and damaged."""
    shift, law = [0.001, 0.002, 0.01][-dimension:], f"{LAW}\n*DAMAGE STABILIZATION\n0.05"
    found = forces(run_deck(deck(dimension, f"{STIFF}\n{BOND}\n{law}", PAIRS[0], shift, turned=True)), dimension)
    lower, upper = boxes(dimension)
    low, high = (n.ravel().tolist() for n in (lower.numbers[..., -1], upper.numbers[..., 0]))
    order = [[0, 1], [1, 0]] if dimension == 2 else [[0, 2, 3, 1], [0, 2, 3, 1]]
    nodes = [low[k] for k in order[0]] + [high[k] for k in order[1]]
    lines = [f"*ELEMENT, TYPE=COH{dimension}D{2**dimension}, ELSET=GLUE", f"5000, {', '.join(map(str, nodes))}"]
    lines += ["*COHESIVE SECTION, ELSET=GLUE, MATERIAL=G, RESPONSE=TRACTION SEPARATION, THICKNESS=SPECIFIED"]
    lines += [f"1., {THICKNESS}" if dimension == 2 else "1."]
    lines += ["*MATERIAL, NAME=G\n*ELASTIC, TYPE=TRACTION\n2000., 1500., 1500.", LAW]
    glued = "\n".join(lines) + "\n*SECTION CONTROLS, NAME=C, VISCOSITY=0.05"
    glued = glued.replace("THICKNESS=SPECIFIED", "THICKNESS=SPECIFIED, CONTROLS=C")
    wanted = forces(run_deck(deck(dimension, "", PAIRS[0], shift, turned=True, between=glued)), dimension)
    np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_moments_balance(run_deck, dimension, pair):
    """The forces of a bond with a clearance on both bodies have no resultant and no moment."""
    shift = [0.1, 0.2, 0.3][-dimension:]
    result = run_deck(deck(dimension, f"{STIFF}\n{BOND}", pair, shift, turned=True, last=30))
    force = result.field("RF")[:, :dimension]
    places = np.concatenate([body.nodes for body in boxes(dimension)]) + result.field("U")[:, :dimension]
    assert np.abs(force).max() > 10.0
    np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-9)
    moments = np.einsum("np,nq->pq", places, force)
    np.testing.assert_allclose(moments, moments.T, atol=1e-9)
