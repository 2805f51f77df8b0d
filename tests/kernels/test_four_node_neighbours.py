# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The four-node stabilised interface: what it takes from the quads next to it, and its complaints about them."""

import numpy as np
import pytest

from uel.errors import KernelError

BOTTOM, TOP, INTERFACE = 11, 12, 400
OFFSETS = {"OFFSETBOTTOM": BOTTOM - INTERFACE, "OFFSETTOP": TOP - INTERFACE}
OPTIONS = [
    {},
    {"INTEGRATION": 1},
    {"SAMPLING": 1},
    {"SAMPLING": 1, "INTEGRATION": 1},
    {"SAMPLING": 2},
    {"SAMPLING": 2, "INTEGRATION": 1},
    {"BETAN": 4.0e3, "BETAT": 6.0e3, "GAMMABOT": 0.3},
    {"VISCOSITY": 0.5},
    {"CLOSURE": 1},
    {"CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0, "SAMPLING": 1, "INTEGRATION": 1},
    {"CLOSURE": 1, "ALPHAN": 0.0, "ALPHAT": 0.0, "VISCOSITY": 0.5},
]


@pytest.fixture(autouse=True)
def start_of_analysis(library):
    """UEXTERNALDB empties the shared module."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)


class Sandwich:
    """Two quads and the interface between them; quads may start with any node, so that any face is the interface."""

    def __init__(self, element, interface, *, turns=(0, 0), labels=(BOTTOM, TOP), faces=None, shift=0.0, **options):
        self.interface = interface
        # turning the numbering back by k nodes turns the face on by k: bottom face 3, top face 1
        self.orders = [np.roll([0, 1, 2, 3], turns[0]), np.roll([4, 5, 6, 7], turns[1])]
        faces = faces or [(2 + turns[0]) % 4 + 1, turns[1] % 4 + 1]
        self.quads = [
            element(1, interface.eight[order] + shift, label=label, FACE=face)
            for order, label, face in zip(self.orders, labels, faces, strict=True)
        ]
        offsets = {"OFFSETBOTTOM": labels[0] - INTERFACE, "OFFSETTOP": labels[1] - INTERFACE}
        self.four = element(3, interface.four, label=INTERFACE, **{**offsets, **options})

    def evaluate(self, u, **options):
        for quad, order in zip(self.quads, self.orders, strict=True):
            quad.evaluate(u[order])
        return self.four.evaluate(u[list(self.interface.owned)], **options)

    def advance(self, u):
        outcome = self.evaluate(u)
        self.four.block.commit()
        return outcome


@pytest.mark.parametrize("state", ["elastic", "softening", "sliding", "closed", "failed", "mixed"])
@pytest.mark.parametrize("options", OPTIONS, ids=lambda options: " ".join(f"{k}={v}" for k, v in options.items()))
def test_same_as_eight_nodes(element, interface, options, state):
    """Tractions, state and forces for the same displacements, whichever face of the quads is the interface."""
    u = interface.displacements(8, *interface.states[state], seed=8)
    eight = element(4, interface.eight, **options)
    forces = eight.advance(u)[0].reshape(8, 2)[list(interface.owned)]
    for turns in ((0, 0), (1, 3), (2, 1)):
        sandwich = Sandwich(element, interface, turns=turns, **options)
        rhs, _ = sandwich.advance(u)
        np.testing.assert_allclose(rhs.reshape(4, 2), forces, rtol=1e-10, atol=1e-10)
        for name, values in sandwich.four.state.items():
            np.testing.assert_allclose(values, eight.state[name], rtol=1e-9, atol=1e-9, err_msg=name)


@pytest.mark.parametrize("state", ["elastic", "softening", "sliding", "failed"])
@pytest.mark.parametrize("rule", [0, 1])
def test_secant_tangent_is_the_penalty_part(element, interface, reference, law, rule, state):
    """S alpha (1 - d) of each point, without the derivative of damage and bulk stress."""
    sandwich = Sandwich(element, interface, INTEGRATION=rule, TANGENT=1)
    _, tangent = sandwich.advance(interface.displacements(8, *interface.states[state], seed=8))
    point = sandwich.four.state
    axes, length = reference.frame(*interface.edge)
    expected = np.zeros((8, 8))
    for k, s in enumerate(reference.POINTS[rule]):
        left, right = (1 - s) / 2, (1 + s) / 2
        jump = np.kron([-left, -right, right, left], axes)
        closed = point["TN"][k] < 0
        secant = reference.stiffness(law, point["DAMAGE"][k], closed)
        penalty = np.diag([point["ST"][k], point["SN"][k]] * secant)
        expected += 0.5 * length * law["THICKNESS"] * jump.T @ penalty @ jump
    np.testing.assert_allclose(tangent, expected, atol=1e-11 * abs(expected).max())
    assert expected.any() == (state != "failed")


def test_large_and_many_element_numbers(element, interface):
    """The shared module grows with the numbers of the quads and with their count."""
    u = interface.displacements(8, *interface.states["elastic"], seed=8)
    sandwich = Sandwich(element, interface, labels=(3_000_000, 20_000))
    expected, _ = sandwich.evaluate(u)
    for label in range(1, 260):
        element(1, interface.eight[:4], label=label, FACE=1).evaluate(np.zeros(8))
    np.testing.assert_array_equal(sandwich.four.evaluate(u[list(interface.owned)])[0], expected)


def test_offset_to_nothing(element, interface):
    sandwich = Sandwich(element, interface, OFFSETTOP=5)
    with pytest.raises(
        KernelError, match=r"U3 element 400: JPROPS\(7\) OFFSETTOP = 5: bulk element 405 has not been evaluated before"
    ):
        sandwich.evaluate(np.zeros((8, 2)))


def test_quad_that_does_not_share(element, interface):
    sandwich = Sandwich(element, interface, faces=(3, 0))
    with pytest.raises(KernelError, match=r"bulk element 12 has not been evaluated.*must be a U1 with FACE"):
        sandwich.evaluate(np.zeros((8, 2)))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"faces": (1, 1)}, r"JPROPS\(6\) OFFSETBOTTOM = -389: bulk element 11 is not a neighbour: its face 1 "),
        ({"faces": (3, 4)}, r"JPROPS\(7\) OFFSETTOP = -388: bulk element 12 is not a neighbour: its face 4 does not"),
        ({"OFFSETBOTTOM": -388, "OFFSETTOP": -389}, r"U3 element 400: .*bulk element 12 is not a neighbour"),
    ],
)
def test_wrong_neighbour(element, interface, changes, message):
    sandwich = Sandwich(element, interface, **changes)
    with pytest.raises(KernelError, match=message):
        sandwich.evaluate(np.zeros((8, 2)))


@pytest.mark.parametrize(("part", "neighbour"), [(0.5e-4, True), (1.5e-4, False)])
def test_quads_lie_on_the_interface_as_closely_as_its_edges_on_each_other(element, interface, part, neighbour):
    """To a part of 1e-4 of the length, which a mesh generator that prints few digits may leave."""
    left, right = interface.edge
    sandwich = Sandwich(
        element, interface, shift=part * np.linalg.norm(np.subtract(right, left)) * np.array([1.0, 0.0])
    )
    if neighbour:
        assert np.isfinite(sandwich.evaluate(np.zeros((8, 2)))[0]).all()
        return
    with pytest.raises(KernelError, match=r"bulk element 11 is not a neighbour"):
        sandwich.evaluate(np.zeros((8, 2)))


def test_quad_not_yet_evaluated_in_this_iteration(element, interface):
    sandwich = Sandwich(element, interface)
    u = interface.displacements(8, *interface.states["elastic"], seed=8)
    sandwich.evaluate(u)
    sandwich.quads[0].evaluate(1.001 * u[:4])
    with pytest.raises(
        KernelError,
        match=r"U3 element 400: JPROPS\(7\) OFFSETTOP = -388: bulk element 12 has not been evaluated before the "
        r"interface element in this iteration: give bulk elements lower numbers and run on one thread",
    ):
        sandwich.four.evaluate(1.001 * u[list(interface.owned)])


@pytest.mark.parametrize("lop", [0, 3])
def test_shared_module_is_emptied_between_analyses(element, interface, library, lop):
    sandwich = Sandwich(element, interface)
    sandwich.evaluate(np.zeros((8, 2)))
    for kept in (1, 2, 4, 5, 6):
        library.external_database(kept, 0, (0.0, 0.0), 0.0, 1, 1)
        sandwich.four.evaluate(np.zeros(8))
    library.external_database(lop, 0, (0.0, 0.0), 0.0, 1, 1)
    with pytest.raises(KernelError, match="has not been evaluated before"):
        sandwich.four.evaluate(np.zeros(8))


def test_mass_call_needs_no_quads(element, interface):
    four = element(3, interface.four, label=INTERFACE, **OFFSETS)
    assert not four.evaluate(np.zeros(8), request=4)[1].any()


@pytest.mark.parametrize("state", ["softening", "sliding", "mixed"])
def test_consistent_tangent_adds_the_derivative_of_the_damage(element, interface, state):
    """What it adds to the penalty part is what the exact tangent of U4 has beyond its own secant one."""
    u = interface.displacements(8, *interface.states[state], seed=8)
    dofs = np.array([[2 * node, 2 * node + 1] for node in interface.owned]).ravel()
    four = [Sandwich(element, interface, TANGENT=tangent).evaluate(u)[1] for tangent in (0, 1)]
    eight = [element(4, interface.eight, TANGENT=tangent).evaluate(u)[1][np.ix_(dofs, dofs)] for tangent in (0, 1)]
    difference = four[0] - four[1]
    np.testing.assert_allclose(difference, eight[0] - eight[1], atol=1e-11 * abs(eight[0]).max())
    assert abs(difference).max() > 1e-2 * abs(four[1]).max()


@pytest.mark.parametrize("alpha", [2.0e4, 1.0e12, 0.0])
@pytest.mark.parametrize("gap", [(0.004, 0.003), (0.006, -0.002), (1e-4, 1e-4), (0.05, 0.03)])
def test_consistent_closure_at_constant_bulk_stress(element, interface, reference, alpha, gap):
    """AMATRX is the derivative by the jump alone: that of U4 between quads so soft that their stress is none."""
    options = {"ALPHAN": alpha, "ALPHAT": alpha, "CLOSURE": 1, "BETAN": 5.0e4, "BETAT": 4.0e4}
    soft = {f"{name} {side}": 1e-6 for name in ("E1", "E2", "G12") for side in ("BOTTOM", "TOP")}
    axes, _ = reference.frame(*interface.edge)
    u = np.zeros((8, 2))
    u[4:] = gap @ axes  # rigid, so that hard quads have no stress either
    tangent = Sandwich(element, interface, **options).evaluate(u)[1]
    dofs = np.array([[2 * node, 2 * node + 1] for node in interface.owned]).ravel()
    expected = element(4, interface.eight, **options, **soft).evaluate(u)[1][np.ix_(dofs, dofs)]
    np.testing.assert_allclose(tangent, expected, atol=1e-6 * abs(expected).max())
    assert expected.any() == (gap[0] < 0.04)


def test_friction_is_that_of_eight_nodes(element, interface):
    options = {"CLOSURE": 1, "FRICTION": 0.4}
    eight, sandwich = element(4, interface.eight, **options), Sandwich(element, interface, **options)
    for seed, factor in ((8, 1.0), (9, 3.0), (10, -2.0)):
        left, right = np.array(interface.states["sliding"]) * [[factor, 2.0]]
        u = interface.displacements(8, left, right, seed)
        forces = eight.advance(u)[0].reshape(8, 2)[list(interface.owned)]
        np.testing.assert_allclose(sandwich.advance(u)[0].reshape(4, 2), forces, rtol=1e-10, atol=1e-10)
        np.testing.assert_allclose(sandwich.four.state["DISSF"], eight.state["DISSF"], rtol=1e-9)
    assert (eight.state["DISSF"] > 0.01).all()


def test_small_beta_of_the_consistent_closure_is_refused(element, interface):
    sandwich = Sandwich(element, interface, CLOSURE=1, BETAN=1.0e3)
    with pytest.raises(
        KernelError, match=r"U3 element 400: PROPS\(13\) BETAN: beta = 1000.*, too small for the consist"
    ):
        sandwich.evaluate(np.zeros((8, 2)))
