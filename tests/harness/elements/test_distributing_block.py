# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributing couplings in large displacements: motion, forces and derivatives against the theory manual; beams and
blocks that they turn.

(Abaqus Theory Guide, Distributing coupling elements: Load distribution, Finite motion.)
"""

import re

import numpy as np
import pytest
from bent_beams import DISTRIBUTING, HIGH, LENGTH, YOUNG, beam, beam_of_quads, last, step
from scipy.spatial.transform import Rotation
from small_decks import BAR_ENDS, bars

import uel
from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags
from uel.errors import ConvergenceError, DeckError, UsageError
from uel.model.dofs import COUPLED

REFERENCE = np.array([1.5, 1.0, 3.0])
DISTANCES = np.linalg.norm(BAR_ENDS - REFERENCE, axis=1)
WEIGHTS = (1.0 - DISTANCES / DISTANCES.max()) / (1.0 - DISTANCES / DISTANCES.max()).sum()


class Bars:
    """Bars whose free ends are coupled to node 9, and their system."""

    def __init__(self, folder, *, space=True, nlgeom=True):
        coupling = "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=S\n*DISTRIBUTING, WEIGHTING METHOD=LINEAR"
        (folder / "bars.inp").write_text(bars(coupling, space=space, nlgeom=nlgeom))
        model = read_deck(folder / "bars.inp")
        self.system = system_of(model, usersub.load(None, job="bars", output_dir=folder))
        self._call = Call(
            Flags(1, nlgeom), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0
        )

    def evaluate(self, u, du):
        return self.system.evaluate(self._call, u, du)

    def unknowns(self, node, dofs):
        """node: its label, 0 for the coupling."""
        mesh = self.system.dofs.mesh
        index = len(mesh.labels) + 9 if node == 0 else int(np.flatnonzero(mesh.labels == node)[0])
        return self.system.dofs.find(index, np.array(dofs))


ROTATION = [4, 5, 6]


@pytest.fixture
def coupled(tmp_path):
    return lambda **options: Bars(tmp_path, **options)


@pytest.mark.parametrize("nlgeom", [True, False])
@pytest.mark.parametrize("space", [True, False])
def test_tangent(coupled, space, nlgeom):
    """The matrix is minus the derivative of the residual, in any state; that of the bars is exact."""
    found = coupled(space=space, nlgeom=nlgeom)
    rng = np.random.default_rng(1)
    n = len(found.system)
    start, du = 0.4 * rng.standard_normal((2, n))
    # sets what the multipliers are measured in
    found.evaluate(start, np.zeros(n))
    matrix = found.system.matrix(found.evaluate(start + du, du).data.copy()).toarray()
    h = 1e-6
    for k, one in enumerate(h * np.eye(n)):
        ahead, behind = (found.evaluate(start + du + s * one, du + s * one).residual.copy() for s in (1, -1))
        np.testing.assert_allclose(matrix[:, k], (behind - ahead) / (2 * h), atol=1e-6 * abs(matrix).max())


def test_motion(coupled):
    """The reference node moves by the mid-increment spin of the coupled nodes and the rotation of Hughes and Winget."""
    found = coupled()
    rng = np.random.default_rng(2)
    start, du = np.zeros(len(found.system)), np.zeros(len(found.system))
    theta, reference = 0.7 * rng.standard_normal((2, 3))
    moved, change = rng.standard_normal((2, 4, 3))
    begun = BAR_ENDS + moved
    middle = begun + 0.5 * change
    arms = middle - WEIGHTS @ middle
    inertia = sum(w * (r @ r * np.eye(3) - np.outer(r, r)) for w, r in zip(WEIGHTS, arms, strict=True))
    spin = np.linalg.solve(inertia, WEIGHTS @ np.cross(arms, change))
    turn = Rotation.from_rotvec(2 * np.arctan(np.linalg.norm(spin) / 2) * spin / np.linalg.norm(spin))
    lever = REFERENCE + reference - WEIGHTS @ begun
    for k in range(4):
        start[found.unknowns(4 + k, [1, 2, 3])], du[found.unknowns(4 + k, [1, 2, 3])] = moved[k], change[k]
    start[found.unknowns(9, [1, 2, 3])], start[found.unknowns(9, ROTATION)] = reference, theta
    du[found.unknowns(9, [1, 2, 3])] = WEIGHTS @ change + turn.apply(lever) - lever
    du[found.unknowns(9, ROTATION)] = (turn * Rotation.from_rotvec(theta)).as_rotvec() - theta
    errors = found.evaluate(start + du, du).coupling
    assert errors.displacement[0] < 1e-14
    assert errors.rotation[0] < 1e-14
    # an error of the reference node is measured as such
    wrong, error = du.copy(), np.array([0.0, 1e-3, 0.0])
    wrong[found.unknowns(9, [1, 2, 3])] += error
    errors = found.evaluate(start + wrong, wrong).coupling
    size = np.sqrt(WEIGHTS @ np.sum((BAR_ENDS - REFERENCE) ** 2, axis=1))
    assert errors.displacement[0] == pytest.approx(np.linalg.norm(error - 0.5 * np.cross(spin, error)) / size)
    assert errors.rotation[0] < 1e-14


def test_forces(coupled):
    """Of a force and a moment at the reference node, from the present places: w (F + (T^-1 M) x r)."""
    found = coupled()
    rng = np.random.default_rng(3)
    u = np.zeros(len(found.system))
    zero = np.zeros(len(u))
    moved, reference = rng.standard_normal((4, 3)), rng.standard_normal(3)
    for k in range(4):
        u[found.unknowns(4 + k, [1, 2, 3])] = moved[k]
    u[found.unknowns(9, [1, 2, 3])] = reference
    of_reference = np.concatenate([found.unknowns(9, [1, 2, 3]), found.unknowns(9, ROTATION)])
    multipliers = found.unknowns(0, range(COUPLED, COUPLED + 6))
    without = found.evaluate(u, zero).residual.copy()
    columns = found.system.matrix(found.evaluate(u, zero).data).toarray()[np.ix_(of_reference, multipliers)]
    force, moment = rng.standard_normal((2, 3))
    u[multipliers] = np.linalg.solve(columns, np.concatenate([force, moment]))
    residual = found.evaluate(u, zero).residual - without
    np.testing.assert_allclose(residual[of_reference], -np.concatenate([force, moment]), atol=1e-12)
    places = BAR_ENDS + moved
    arms = places - WEIGHTS @ places
    inertia = sum(w * (r @ r * np.eye(3) - np.outer(r, r)) for w, r in zip(WEIGHTS, arms, strict=True))
    about_centre = moment + np.cross(REFERENCE + reference - WEIGHTS @ places, force)
    expected = WEIGHTS[:, None] * (force + np.cross(np.linalg.solve(inertia, about_centre), arms))
    given = np.array([residual[found.unknowns(4 + k, [1, 2, 3])] for k in range(4)])
    np.testing.assert_allclose(given, expected, atol=1e-12)


@pytest.mark.parametrize("loaded", ["moment", "rotation"])
def test_cantilever_rolled_to_a_circle(run_deck, loaded):
    """By the moment 2 pi E I/L at its end, or by a rotation of 2 pi: it comes back to the clamped one (elastica)."""
    high = 0.2
    moment = 2 * np.pi * YOUNG * high**3 / 12 / LENGTH
    load = ["*CLOAD", f"900, 6, {moment!r}"] if loaded == "moment" else ["*BOUNDARY", f"900, 6, 6, {2 * np.pi!r}"]
    lines = beam(high=high, reference=(LENGTH, high / 2), constraint=DISTRIBUTING)
    result = run_deck([*lines, *step(*load, increments=40)])
    # strains of 6 % at the faces, where theory has small ones
    assert last(result, "UR3") == pytest.approx(2 * np.pi, rel=1e-2)
    np.testing.assert_allclose([last(result, "U1"), last(result, "U2")], [-LENGTH, 0.0], atol=1e-2 * LENGTH)
    if loaded == "rotation":
        assert last(result, "RM3") == pytest.approx(moment, rel=1e-2)


def test_couplings_at_both_ends(run_deck):
    """Turned against each other, they bend the beam to an arc of the angle between them; one has two nodes.

    The stress resultant is a moment alone, thus all sections are alike (elastica).
    """
    both = DISTRIBUTING + "\n*NODE, NSET=FAR\n901, -1., 0.4\n*SURFACE, NAME=ROOT, TYPE=NODE\n1\n3\n"
    both += "*COUPLING, CONSTRAINT NAME=D, REF NODE=901, SURFACE=ROOT\n*DISTRIBUTING"
    turn = ["901, 1, 2", f"901, 6, 6, {-np.pi / 4!r}", f"900, 6, 6, {np.pi / 4!r}"]
    result = run_deck([*beam(constraint=both, held=""), *step("*BOUNDARY", *turn, increments=20)])
    assert last(result, "RM3") == pytest.approx(YOUNG * HIGH**3 / 12 * (np.pi / 2) / LENGTH, rel=2e-2)
    u, x = result.field("U"), result.mesh().points
    ends = [
        (x + u)[(x[:, 0] == at) & (x[:, 1] == HIGH / 2) & (np.arange(len(x)) < len(x) - 2)][0] for at in (0.0, LENGTH)
    ]
    chord = np.linalg.norm(ends[1] - ends[0])
    radius = LENGTH / (np.pi / 2)
    assert chord == pytest.approx(2 * radius * np.sin(np.pi / 4), rel=1e-2)


def test_force_on_a_reference_node_beyond_the_end(run_deck):
    """A dead force at the end of a rigid arm bends the beam as the force and its moment about the end do."""
    loads = [f"900, {k}, {value}" for k, value in ((1, -0.3), (2, 1.0))]
    far = run_deck([*beam(reference=(LENGTH + 2.0, HIGH / 2 + 1.0), constraint=DISTRIBUTING), *step("*CLOAD", *loads)])
    angle = last(far, "UR3")
    arm = Rotation.from_rotvec([0.0, 0.0, angle]).apply([2.0, 1.0, 0.0])
    moment = np.cross(arm, [-0.3, 1.0, 0.0])[2]
    near = run_deck([*beam(constraint=DISTRIBUTING), *step("*CLOAD", *loads, f"900, 6, {moment}")], name="near")
    assert angle > 0.3
    assert last(near, "UR3") == pytest.approx(angle, rel=1e-3)
    moved = [last(far, f"U{k + 1}") - (arm - [2.0, 1.0, 0.0])[k] for k in (0, 1)]
    assert [last(near, f"U{k}") for k in (1, 2)] == pytest.approx(moved, rel=1e-3)


def test_small_rotations(run_deck):
    """As equations without NLGEOM give them, to the order of the rotation."""
    loads = "*CLOAD", "900, 1, 1e-5", "900, 2, 2e-5", "900, 6, 3e-5"
    lines = beam(reference=(LENGTH + 1.0, HIGH), constraint=DISTRIBUTING)
    found = [
        [last(run_deck([*lines, *step(*loads, name=name, increments=1)], name=job), u) for u in ("U1", "U2", "UR3")]
        for name, job in (("*STEP, NLGEOM", "large"), ("*STEP", "small"))
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-3)
    assert found[1][2] > 1e-7


def test_linear_step_before(run_deck):
    """A step without NLGEOM gives what equations give, and the next one goes on from there."""
    linear = step("*CLOAD", "900, 6, 0.1", name="*STEP", increments=1)
    lines = beam(reference=(LENGTH + 1.0, HIGH), constraint=DISTRIBUTING)
    alone = run_deck([*lines, *linear], name="alone")
    both = run_deck([*lines, *linear, *step("*CLOAD", "900, 6, 0.1", increments=1)])
    for name in ("U1", "U2", "UR3"):
        column = next(column for column in both.history if column.startswith(f"{name}["))
        assert both.history[column][-2] == pytest.approx(last(alone, name), rel=1e-9)
        assert both.history[column][-1] == pytest.approx(last(alone, name), rel=2e-2)


def test_tolerances(run_deck, tmp_path):
    """Errors of the constraints are in .msg; one that nothing can meet ends the run, and says so."""
    run_deck([*beam(constraint=DISTRIBUTING), *step("*CLOAD", "900, 6, 1.", increments=1)], name="met")
    text = (tmp_path / "met.msg").read_text()
    assert re.search(r"ROTATION COMPATIBILITY TOLERANCE FOR DCOUP ELEMENTS +1.000E-05", text)
    assert re.search(r"LARGEST ROTATION ERROR +\S+   AT REFERENCE NODE 900", text)
    assert "THE DISTRIBUTING COUPLING EQUATIONS HAVE CONVERGED" in text
    lines = step("*CLOAD", "900, 6, 1.", increments=1)
    lines.insert(2, "*CONTROLS, PARAMETERS=CONSTRAINTS\n,,,,, 1e-30")
    with pytest.raises(ConvergenceError) as error:
        run_deck([*beam(constraint=DISTRIBUTING), *lines], name="missed")
    assert any(
        "displacement error" in note and "node 900, of its distributing" in note for note in error.value.__notes__
    )
    assert "THE DISTRIBUTING COUPLING EQUATIONS HAVE NOT CONVERGED" in (tmp_path / "missed.msg").read_text()


@pytest.mark.parametrize(
    ("constraint", "how", "message"),
    [
        (f"{DISTRIBUTING}\n1, 2", "*STATIC", r"released rotations are not supported with NLGEOM; expected all dofs"),
        (DISTRIBUTING, "*DYNAMIC", r"is not supported with \*DYNAMIC \(.*deck.inp:\d+\) where a step has NLGEOM"),
    ],
)
def test_what_is_not_supported(run_deck, constraint, how, message):
    lines = beam(constraint=constraint)
    lines[lines.index(f"*ELASTIC\n{YOUNG}, 0.")] += "\n*DENSITY\n1."
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: \*DISTRIBUTING: {message}"):
        run_deck([*lines, *step("*CLOAD", "900, 1, 1.", how=how)])


def test_nodes_on_a_line_are_refused(run_deck):
    coupling = DISTRIBUTING.replace("\nEND\n", "\n20\n17\n")
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*DISTRIBUTING: its nodes lie on a line, about which"):
        run_deck([*beam("C3D8", reference=[0.0, 0.0, 3.0], constraint=coupling), *step("*CLOAD", "900, 1, 1.")])


def test_free_nodes_are_refused(run_deck):
    """Those in the middle of the sides of quadratic elements, that linear ones do not have."""
    lines = beam_of_quads([line.replace("TYPE=CPS8R", "TYPE=CPS4") for line in beam(constraint=DISTRIBUTING)])
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: \*DISTRIBUTING: node 102 is free, for no element has it"):
        run_deck([*lines, *step("*CLOAD", "900, 1, 1.")])


def test_options_of_the_run_that_are_refused(run_deck):
    message = r"--fallback: not supported with \*DISTRIBUTING with NLGEOM \(.*deck\.inp:\d+\)"
    with pytest.raises(UsageError, match=message):
        run_deck(
            [*beam(constraint=DISTRIBUTING), *step("*CLOAD", "900, 1, 1.")], solver=uel.SolverOptions(fallback=True)
        )
