# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rigid arms in large displacements: rotations of any angle, their derivatives, and beams bent by them.

Distributing couplings bend beams too.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from bent_beams import CELLS, COUPLING, DISTRIBUTING, HIGH, LENGTH, YOUNG, beam, beam_of_quads, last, step
from scipy import sparse
from scipy.spatial.transform import Rotation
from small_decks import bars

from uel import usersub
from uel.assembly import RotatingConstraints, system_of
from uel.assembly.finite_couplings import KinematicCouplings
from uel.deck import read_deck
from uel.elements import Call, Flags, rotation_matrices, spin_matrices
from uel.errors import DeckError, Source
from uel.model.model import Arm
from uel.running.job_on_ranks import refuse_unshared

ANGLES = [[0, 0, 0], [1e-5, -2e-5, 1e-5], [0.02, 0.02, 0.01], [0.03, 0.01, 0.0], [1.0, -2.0, 0.5], [0, 0, 3.0]]


@pytest.mark.parametrize("angle", ANGLES)
def test_rotations(angle):
    """Those of scipy, and H dtheta is the spin of dR R^T."""
    angles = np.array([angle], dtype=float)
    np.testing.assert_allclose(rotation_matrices(angles)[0], Rotation.from_rotvec(angle).as_matrix(), atol=1e-14)
    for k, small in enumerate(1e-6 * np.eye(3)):
        ahead, behind = (Rotation.from_rotvec(angle + sign * small) for sign in (1, -1))
        spin = (ahead * behind.inv()).as_rotvec() / 2e-6
        np.testing.assert_allclose(spin_matrices(angles)[0][:, k], spin, atol=1e-9)


class Numbering:
    """Six unknowns of each of four nodes."""

    class mesh:  # noqa: N801
        coordinates = np.array([[0.0, 0, 0], [1.0, 0.2, -0.4], [0.0, 2.0, 0.0], [0.5, -1.0, 3.0]])

    @staticmethod
    def find(nodes, dof):
        return 6 * np.asarray(nodes) + np.asarray(dof) - 1


@pytest.mark.parametrize("angle", ANGLES)
def test_derivatives(angle):
    """Of the displacements by the rotations, and of the moments of constant forces about the global axes."""
    sources = [Arm(node, 0, Source("test.inp", 1)) for node in (1, 2, 3)]
    dependent = Numbering.find(np.arange(1, 4)[:, None], np.arange(1, 4)).ravel()
    arms = KinematicCouplings(Numbering(), sources, np.array([], dtype=int), np.zeros(24), np.zeros(24, dtype=bool))
    start = np.zeros(24)
    start[3:6] = angle
    force = np.random.default_rng(1).standard_normal(24)
    step = 1e-5

    def moved(change):
        u = start.copy()
        u[3:6] += change
        return arms.satisfy(np.zeros(24), u)

    for k, one in enumerate(step * np.eye(3)):
        slope = (moved(one) - moved(-one)) / (2 * step)
        np.testing.assert_allclose(arms.slopes(start)[:, :, 3 + k].ravel(), slope[dependent], atol=1e-9)

    def moments(change):
        u = start.copy()
        u[3:6] += change
        turned = Rotation.from_rotvec(u[3:6]).apply(Numbering.mesh.coordinates[1:])
        moment = np.cross(turned, force[dependent].reshape(3, 3)).sum(axis=0)
        found = np.einsum("kij,ki->j", arms.levers(u)[:, :, 3:], force[dependent].reshape(3, 3))
        np.testing.assert_allclose(found, moment)
        return moment

    found = arms.curvature(start, force, arms.slopes(start))[0, 3:, 3:]
    for k, one in enumerate(step * np.eye(3)):
        np.testing.assert_allclose(found[:, k], -(moments(one) - moments(-one)) / (2 * step), atol=1e-8)


COUPLINGS = pytest.mark.parametrize("coupling", [COUPLING, DISTRIBUTING], ids=["kinematic", "distributing"])


@pytest.mark.parametrize(
    ("element_type", "coupling"),
    [
        *((kind, COUPLING) for kind in ("CPE4", "CPS8R", "CPE8H")),
        *((kind, DISTRIBUTING) for kind in ("CPS8R", "CPE8H")),
    ],
)
def test_rigid_rotation(run_deck, element_type, coupling):
    """By 90 degrees about a node far away: no stress, and every node where the rotation puts it."""
    coupled = coupling.replace("END\n*COUPLING", "START\n*COUPLING")
    lines = beam("CPS8R", reference=(-3.0, 4.0), constraint=coupled, held="")
    if element_type == "CPE4":
        lines = beam_of_quads(lines)
    lines = [line.replace("TYPE=CPS8R", f"TYPE={element_type}") for line in lines]
    result = run_deck([*lines, *step("*BOUNDARY", "900, 1, 2", f"900, 6, 6, {np.pi / 2!r}", increments=9)])
    x = result.mesh().points - np.array([-3.0, 4.0, 0.0])
    turned = np.stack([-x[:, 1], x[:, 0], 0 * x[:, 2]], axis=1)
    used = np.abs(result.field("U")).max(axis=1) > 0
    np.testing.assert_allclose(result.field("U")[used], (turned - x)[used], atol=1e-9)
    for name in ("S11", "S22", "S12"):
        np.testing.assert_allclose(result.field(name), 0, atol=1e-7 * YOUNG)


@pytest.mark.parametrize("reference", [(LENGTH, HIGH / 2), (LENGTH + 2.0, HIGH / 2 + 1.0)])
def test_cantilever_bent_to_an_arc(run_deck, reference):
    """By a rotation p of its end alone: an arc of radius L/p, and the moment E I p/L (elastica).

    A reference node off the axis moves with the end, and has the same moment, for there is no force.
    """
    angle = np.pi / 2
    result = run_deck([*beam(reference=reference), *step("*BOUNDARY", f"900, 6, 6, {angle!r}", increments=20)])
    radius = LENGTH / angle
    off = np.array(reference) - [LENGTH, HIGH / 2]
    turned = np.array([-off[1], off[0]])
    expected = np.array([radius - LENGTH, radius]) + turned - off
    found = [
        result.history[f"U{k}[REF:900]" if f"U{k}[REF:900]" in result.history else f"U{k}[REF]"][-1] for k in (1, 2)
    ]
    np.testing.assert_allclose(found, expected, atol=5e-3 * LENGTH)
    assert last(result, "RM3") == pytest.approx(YOUNG * HIGH**3 / 12 * angle / LENGTH, rel=1e-2)


def test_moment_and_force_on_the_reference_node(run_deck):
    """The rotation is free: the moment E I/R bends it to an arc, a dead force P to the elastica of a cantilever.

    (K.E. Bisshopp, D.C. Drucker, Quarterly of Applied Mathematics 3 (1945) 272: at P L^2/(E I) = 2 the end deflects by
    0.4935 L and moves back by 0.1606 L.)
    """
    inertia = HIGH**3 / 12
    moment = YOUNG * inertia * (np.pi / 2) / LENGTH
    result = run_deck([*beam(), *step("*CLOAD", f"900, 6, {moment!r}", increments=20)])
    assert last(result, "UR3") == pytest.approx(np.pi / 2, rel=1e-2)
    force = 2 * YOUNG * inertia / LENGTH**2
    result = run_deck([*beam(), *step("*CLOAD", f"900, 2, {force!r}")])
    found = [last(result, f"U{k}") for k in (1, 2)]
    np.testing.assert_allclose(found, [-0.1606 * LENGTH, 0.4935 * LENGTH], rtol=1e-2)


HELD = {
    "none": [],
    "a displacement": [(4, 1)],
    "one of two nodes": [(4, 1), (5, 2)],
    "two in one direction": [(4, 2), (5, 2)],
    "a node": [(4, 1), (4, 2), (4, 3)],
    "all but one": [(4, 1), (4, 2), (4, 3), (5, 1), (6, 3)],
    "too many": [(4, 1), (4, 2), (4, 3), (5, 1), (5, 2), (5, 3)],
}
"""Nodes and dofs of the body that are prescribed: they eliminate unknowns of its reference node."""


def test_constraints_with_rotations_are_not_shared_by_ranks(tmp_path):
    (tmp_path / "bars.inp").write_text(bars("*RIGID BODY, REF NODE=9, PIN NSET=BODY"))
    with pytest.raises(DeckError, match=r"bars\.inp:\d+: a constraint with rotations, with NLGEOM, does not run on 2"):
        refuse_unshared(read_deck(tmp_path / "bars.inp"), SimpleNamespace(size=2))


@pytest.mark.parametrize("weight", [1.0, 0.7])
@pytest.mark.parametrize("name", HELD)
def test_tangent(tmp_path, name, weight):
    """It is the derivative of the reduced forces, of bars whose own tangent is exact.

    With a weight they act in the directions of a time before the end.

    Prescribed displacements of the body stay as they are in any position, and all distances in it: of two nodes with
    all of theirs prescribed one is redundant.
    """
    (tmp_path / "bars.inp").write_text(bars("*RIGID BODY, REF NODE=9, PIN NSET=BODY"))
    model = read_deck(tmp_path / "bars.inp")
    library = usersub.load(None, job="bars", output_dir=tmp_path)
    system = system_of(model, library)
    held = np.sort(system.dofs.find(np.arange(3)[:, None], np.array([1, 2, 3])).ravel())
    of_body = [int(system.dofs.find(model.mesh.labels.tolist().index(node), dof)) for node, dof in HELD[name]]
    held = np.concatenate([held, np.array(of_body, dtype=np.int64)])
    constraints = RotatingConstraints(system, held, model.equations, {}, model.arms)
    call = Call(Flags(1, True), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)
    zero, load = np.zeros(len(system)), np.random.default_rng(2).standard_normal(len(system))

    turned = np.zeros(len(system))
    turned[-6:] = [0.1, -0.2, 0.3, 0.2, 0.3, -0.1]
    # where the body has come by a free motion, what is prescribed is consistent
    free = RotatingConstraints(system, held[:9], model.equations, {}, model.arms)
    start = free.satisfy(zero, turned)

    def reduced(q):
        dq = constraints.expand(q, np.zeros(len(held)))
        change = constraints.satisfy(start, dq)
        np.testing.assert_allclose(change[held], 0, atol=1e-13)
        u = start + change
        evaluation = system.evaluate(call, u, u)
        residual = evaluation.residual + load
        constraints.update(u, residual, change, weight)
        return constraints.reduce_vector(residual), evaluation.data

    constraints.update(start, zero)
    count = max(6 - len(of_body), 1)
    assert len(constraints.overconstraints) == max(len(of_body) - 5, 0)
    q = 0.1 * np.random.default_rng(3).standard_normal(len(constraints.free))
    _, data = reduced(q)
    pattern = constraints.reduced_indices, constraints.reduced_indptr
    tangent = sparse.csr_array((constraints.reduce_tangent(data).copy(), *pattern)).toarray()
    assert len(q) == count
    for k, one in enumerate(1e-6 * np.eye(len(q))):
        slope = (reduced(q + one)[0] - reduced(q - one)[0]) / 2e-6
        np.testing.assert_allclose(tangent[:, k], -slope, atol=1e-6 * abs(tangent).max())


@pytest.mark.parametrize("name", HELD)
def test_tangential_velocities(tmp_path, name):
    """They are those of a movement of the body, and the movements that are left keep their momenta.

    Nodes have any masses, and what is prescribed keeps its velocity.
    """
    (tmp_path / "bars.inp").write_text(bars("*RIGID BODY, REF NODE=9, PIN NSET=BODY"))
    model = read_deck(tmp_path / "bars.inp")
    library = usersub.load(None, job="bars", output_dir=tmp_path)
    system = system_of(model, library)
    of_body = [int(system.dofs.find(model.mesh.labels.tolist().index(node), dof)) for node, dof in HELD[name]]
    turned = np.zeros(len(system))
    turned[-6:] = [0.1, -0.2, 0.3, 1.2, 0.3, -0.5]
    free = RotatingConstraints(system, np.array([], dtype=int), model.equations, {}, model.arms)
    u = free.satisfy(np.zeros(len(system)), turned)
    constraints = RotatingConstraints(system, np.array(of_body, dtype=int), model.equations, {}, model.arms, u)
    constraints.update(u, np.zeros(len(system)))
    numbers = np.random.default_rng(4)
    # moments are about the global axes, velocities those of rotation vectors: rotary inertia would mix both
    masses = np.where(system.dofs.dof > 3, 0.0, numbers.uniform(1.0, 2.0, len(system)))
    mass = sparse.dia_array((masses[None, :], [0]), shape=2 * (len(system),)).tocsr()
    velocity = numbers.standard_normal(len(system))
    found = constraints.project_velocity(velocity, constraints.inertia(mass))
    np.testing.assert_allclose(constraints.project(found), found, atol=1e-12)
    np.testing.assert_allclose(constraints.reduce_vector(mass @ (found - velocity)), 0, atol=1e-12)
    np.testing.assert_allclose(found[of_body], velocity[of_body])
    again = constraints.project_velocity(found, constraints.inertia(mass))
    np.testing.assert_allclose(again, found, atol=1e-12)


QUASI = "*DYNAMIC, APPLICATION=QUASI-STATIC"


STATIC = ("*STATIC", "*STATIC, RIKS", "*VISCO, CETOL=1.", "*STATIC, STABILIZE=1e-12")


# *DISTRIBUTING with NLGEOM is refused in *DYNAMIC
@pytest.mark.parametrize(
    ("how", "coupling"),
    [(how, coupling) for coupling in (COUPLING, DISTRIBUTING) for how in STATIC] + [(QUASI, COUPLING)],
)
def test_procedures(run_deck, how, coupling):
    """The same deflection in each."""
    inertia = HIGH**3 / 12
    lines = step(
        "*CLOAD", f"900, 2, {2 * YOUNG * inertia / LENGTH**2!r}", how=how, name="*STEP, NLGEOM, INC=100, AMPLITUDE=RAMP"
    )
    if "RIKS" in how:
        lines[1] += ", 1."
    body = beam(constraint=coupling)
    # a period of the beam that is short beside that of the load
    body[body.index(f"*ELASTIC\n{YOUNG}, 0.")] += "\n*DENSITY\n1e-6"
    result = run_deck([*body, *lines])
    factor = result.history["LPF"][-1] if "RIKS" in how else 1.0
    assert last(result, "U2") == pytest.approx(0.4935 * LENGTH, rel=1e-2 if factor == 1.0 else 0.1)


PARTIAL = "unless all displacements of its nodes follow; expected .BOUNDARY to hold dofs 6"
CONSTRAINTS = {
    "coupling": COUPLING,
    "kinematic coupling": "*KINEMATIC COUPLING, REF NODE=900\nEND, 1, 6",
    "rigid body": "*RIGID BODY, REF NODE=900, PIN NSET=END",
    "beams": "*MPC\nBEAM, END, REF",
}


@pytest.mark.parametrize("name", CONSTRAINTS)
def test_keywords(run_deck, name):
    """All that make nodes follow a reference node."""
    inertia = HIGH**3 / 12
    load = "*CLOAD", f"900, 6, {YOUNG * inertia * (np.pi / 2) / LENGTH!r}"
    result = run_deck([*beam(constraint=CONSTRAINTS[name]), *step(*load, increments=20)])
    assert last(result, "UR3") == pytest.approx(np.pi / 2, rel=1e-2)


@COUPLINGS
def test_rotation_in_space(run_deck, coupling):
    """About a skew axis, of a body all of whose one end follows: every node is where the rotation vector puts it."""
    vector, reference = np.array([0.4, -1.1, 0.7]), np.array([1.0, 2.0, -3.0])
    coupled = coupling.replace("END\n*COUPLING", "START\n*COUPLING")
    lines = beam("C3D8", reference=reference.tolist(), constraint=coupled, held="")
    given = [f"900, {k}, {k}, {one!r}" for k, one in enumerate(vector.tolist(), start=4)]
    result = run_deck([*lines, *step("*BOUNDARY", "900, 1, 3", *given)])
    x = result.mesh().points - reference
    moved = x @ Rotation.from_rotvec(vector).as_matrix().T - x
    used = np.abs(result.field("U")).max(axis=1) > 0
    assert used.sum() == 4 * (CELLS + 1)
    np.testing.assert_allclose(result.field("U")[used], moved[used], atol=1e-8)
    np.testing.assert_allclose(result.field("S11"), 0, atol=1e-6 * YOUNG)


@COUPLINGS
def test_free_rotation_in_space(run_deck, coupling):
    """A force on an arm across the end turns it about two axes; its moments are in equilibrium with the support's."""
    lines = beam("C3D8I", reference=[LENGTH, 2.0, 1.0], held="START, 1, 3", constraint=coupling)
    force = np.array([0.0, 0.2, -0.3])
    loads = [f"900, {k + 1}, {force[k]:.1f}" for k in (1, 2)]
    result = run_deck([*lines, *step("*CLOAD", *loads, increments=5)])
    reaction, x = result.field("RF"), result.mesh().points + result.field("U")
    np.testing.assert_allclose(reaction.sum(axis=0), -force, atol=1e-3 * abs(force).max())
    moment = np.cross(x, reaction).sum(axis=0) + np.cross(x[-1], force)
    np.testing.assert_allclose(moment, 0, atol=1e-3 * LENGTH * abs(force).max())
    assert abs(last(result, "UR1")) > 0.05


@pytest.mark.parametrize(
    ("constraint", "loads", "how", "message"),
    [
        (
            f"{COUPLING}\n1, 1",
            ["*CLOAD", "900, 1, 1."],
            "*STATIC",
            PARTIAL,
        ),
        (
            f"{COUPLING}\n*EQUATION\n2\n900, 2, 1., 20, 2, -1.",
            [],
            "*STATIC",
            "reference node 900 has other constraints",
        ),
    ],
)
def test_what_is_not_supported(run_deck, constraint, loads, how, message):
    lines = beam(constraint=constraint)
    lines[lines.index(f"*ELASTIC\n{YOUNG}, 0.")] += "\n*DENSITY\n1."
    with pytest.raises(DeckError, match=rf"deck\.inp:\d+: .*{message}"):
        run_deck([*lines, *step(*loads, how=how)])


def test_node_of_two_constraints(run_deck):
    lines = beam(constraint=COUPLING)
    end = lines[lines.index("*NSET, NSET=END") + 1]
    lines += ["*EQUATION", "2", f"20, 2, 1., {end}, 2, -1."]
    lines = [*lines[: lines.index("*BOUNDARY")], *lines[-3:], *lines[lines.index("*BOUNDARY") : -3]]
    with pytest.raises(
        DeckError, match=r"deck\.inp:\d+: node .* follows a reference node, .* beside another constraint"
    ):
        run_deck([*lines, *step("*CLOAD", "900, 1, 1.")])


def test_perturbation(run_deck):
    linear = ["*STEP, PERTURBATION", "*STATIC", "*CLOAD", "900, 1, 1.", "*END STEP"]
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*rotations is not supported with NLGEOM in \*STATIC"):
        run_deck([*beam(), *step("*CLOAD", "900, 1, 1."), *linear])


def test_small_rotations_before_large_ones(run_deck):
    """A step without NLGEOM has equations, and the next one arms."""
    loads = "*CLOAD", "900, 6, 0.1"
    result = run_deck([*beam(), *step(*loads, name="*STEP", increments=1), *step(*loads, increments=1)])
    assert result.completed
    assert last(result, "UR3") == pytest.approx(0.1 * LENGTH / (YOUNG * HIGH**3 / 12), rel=1e-2)


def test_some_displacements_of_a_node_that_does_not_turn(run_deck):
    """The end is pulled along 1 and free to get thinner: S22 = 0."""
    lines = beam(constraint=f"{COUPLING}\n1, 1")
    lines = [line.replace(f"{YOUNG}, 0.", f"{YOUNG}, 0.3") for line in lines]
    result = run_deck([*lines, *step("*BOUNDARY", "900, 2, 2", "900, 6, 6", "900, 1, 1, 1.")])
    np.testing.assert_allclose(result.field("S22"), 0, atol=1e-6 * YOUNG)
    assert result.field("S11").min() > 0.09 * YOUNG
