# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""CRACKED 1: points that have failed before the analysis begins carry contact and friction, and nothing else."""

import numpy as np
import pytest
from lines import BRIDGING, TABLE
from neighbours import OWNED, Sandwich
from scipy.spatial.transform import Rotation
from solid_pairs import frames_at, geometry

from uel.errors import KernelError
from uel.usersub.layout import element_layouts

STORED, DISSIPATED, VISCOUS = 1, 3, 4
ALPHA, BETA, MU = 2.0e4, 4.0e4, 0.4
NLGEOM = (1, 1, 0, 0)
OWNER = {2: 4, 3: 4, 5: 6, 7: 8, 10: 8, 11: 12, 13: 404, 14: 1010}
"""Type with solids whose geometry one without takes."""
STANDARD = (2, 5, 7, 11, 13, 14)
INTERFACES = [jtype for jtype, layout in element_layouts().items() if layout.faces[0]]
CASES = [
    *((jtype, 0) for jtype in STANDARD),
    *((jtype, closure) for jtype in INTERFACES if jtype not in STANDARD for closure in (1, 2, 3)),
]
CASES = [(jtype, closure) for jtype, closure in CASES if not (jtype in OWNED and closure == 3)]
CONSISTENT = [(jtype, closure) for jtype, closure in CASES if closure in (1, 3)]
LAWS = {
    "bilinear": {"LAW": 1},
    "BK": {"LAW": 2, "ETA": 1.45},
    "power": {"LAW": 2, "POWER": 1.5},
    "exponential": {"LAW": 3, "POWER": 1.0},
    "PPR": {"LAW": 4, "SHAPEN": 3.0, "SHAPET": 2.5},
    "bridging": BRIDGING,
    "table": TABLE,
}
every = pytest.mark.parametrize(("jtype", "closure"), CASES)
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


class Crack:
    """A flat interface in a random direction whose upper side moves as a body.

    item     the element; U3 and U10 with the solids beside them
    nodes    (nodes, dimension)
    """

    def __init__(self, element, library, jtype, closure, **values):
        owner = OWNER.get(jtype, jtype)
        layouts = element_layouts()
        self.nodes = geometry(owner, np.random.default_rng(jtype), flat=True, affine=True)
        self.frame = frames_at(owner, self.nodes)
        self.upper = np.arange(len(self.nodes)) >= layouts[owner].solids[0]
        given = {"ALPHAN": ALPHA, "ALPHAT": ALPHA, "CRACKED": 1, **values}
        if jtype in STANDARD:
            solids, self.nodes = self.nodes, np.zeros((layouts[jtype].nodes, self.nodes.shape[1]))
            for own, face in zip(layouts[jtype].faces, layouts[owner].faces, strict=True):
                self.nodes[list(own)] = solids[list(face)]
            self.upper = np.isin(np.arange(len(self.nodes)), layouts[jtype].faces[1])
        else:
            given = {"CLOSURE": closure, "BETAN": BETA, "BETAT": BETA, "GAMMABOT": 0.4, **given}
        if jtype in OWNED:
            library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
            self.item = Sandwich(element, jtype, self.nodes, **given)
        else:
            self.item = element(jtype, self.nodes, **given)

    def moved(self, along, opening):
        """Displacements that part the sides by a gap along tau or s, and n; the solids do not strain."""
        u = np.zeros_like(self.nodes)
        u[self.upper] = along * self.frame[0] + opening * self.frame[1]
        return u

    def force(self, rhs):
        """Components of the force on the upper side along the rows of the frame."""
        return self.frame @ -rhs.reshape(self.nodes.shape)[self.upper].sum(axis=0)

    def along(self, name="T"):
        """Traction T, or separation W, of the points along tau or s."""
        return self.item.state[f"{name}S" if self.nodes.shape[1] == 3 else f"{name}T"]


@pytest.fixture
def crack(element, library):
    """Make a crack: crack(jtype, closure, NAME=value, ...)."""

    def make(jtype, closure, **values):
        return Crack(element, library, jtype, closure, **values)

    return make


def contact_stiffness(jtype):
    """Return what closes a crack: alpha_n, in a stabilised element in series with beta_n (fortran/laws.md)."""
    return ALPHA if jtype in STANDARD else 1 / (1 / ALPHA + 1 / BETA)


@pytest.mark.sample(7)
@every
@every_law
def test_points_begin_with_the_state_of_failure_and_without_dissipation(crack, jtype, closure, law):
    item = crack(jtype, closure, **law).item
    rhs, _ = item.advance(np.zeros(item.shape if jtype in OWNED else item.n))
    state = item.state
    for name in ("DAMAGE", "DMAX", "SPENT"):
        np.testing.assert_array_equal(state[name], 1)
    for name in ("DISSI", "DISSII", "DISSV", "DISSF"):
        np.testing.assert_array_equal(state[name], 0)
    assert ((state["MAXN"] > 0) == (law["LAW"] == 4)).all() and ((state["MAXT"] > 0) == (law["LAW"] == 4)).all()
    assert not rhs.any() and not item.energy.any()


@pytest.mark.sample(7)
@every
@every_law
@pytest.mark.parametrize("viscosity", [0.0, 0.3])
def test_open_faces_are_free_and_closed_ones_press_without_shear(crack, jtype, closure, law, viscosity):
    """Whatever came before. The contact stores energy, nothing is dissipated."""
    part = crack(jtype, closure, VISCOSITY=viscosity, **law)
    stiffness = contact_stiffness(jtype)
    for along, opening in ((0.02, 0.01), (0.0, -1e-3), (0.3, -2e-3), (-0.1, 0.5), (0.0, -1e-3)):
        rhs, tangent = part.item.advance(part.moved(along, opening), dtime=0.1)
        pressed = min(opening, 0.0)
        np.testing.assert_allclose(part.item.state["TN"], stiffness * pressed, rtol=1e-10)
        np.testing.assert_array_equal(part.along(), 0)
        force = part.force(rhs)
        np.testing.assert_allclose(force[[0, *range(2, len(force))]], 0, atol=1e-12 * ALPHA)
        if closure != 1:
            # the incomplete form does not count the springs beta
            expected = 0.5 * force[1] * pressed
            np.testing.assert_allclose(part.item.energy[STORED], expected, rtol=1e-9, atol=1e-15)
        assert not part.item.energy[[DISSIPATED, VISCOUS]].any()
        assert (part.item.state["SPENT"] == 1).all()
        if opening > 0:
            # the complete form takes the stress of the solids, here rounding: 1e5 MPa times a body's motion of 0.5,
            # of which a sum over its nodes loses some tens of units in the last place
            np.testing.assert_allclose(rhs, 0, atol=100 * 1e5 * 0.5 * np.finfo(float).eps if closure == 3 else 0)
            if closure != 3:
                # the slope of the exponential law where its damage rounds to 1
                np.testing.assert_allclose(tangent, 0, atol=1e-12 * ALPHA if law["LAW"] == 3 else 0)


@pytest.mark.sample(5)
@every
@pytest.mark.parametrize("law", [LAWS["bilinear"], LAWS["BK"], LAWS["PPR"]], ids=["bilinear", "BK", "PPR"])
def test_a_crack_answers_as_an_interface_that_has_failed(crack, jtype, closure, law):
    """But for what the latter has dissipated on its way; the exponential law never fails quite."""
    parts = [crack(jtype, closure, CRACKED=cracked, **law) for cracked in (1, 0)]
    for part in parts:
        part.item.advance(part.moved(0.6, 0.5))
    assert (parts[1].item.state["DAMAGE"] == 1).all()
    assert parts[1].item.energy[DISSIPATED] > 0
    rng = np.random.default_rng(1)
    for along, opening in ((0.1, -1e-3), (-0.1, -2e-3), (0.0, 0.2)):
        u = parts[0].moved(along, opening) + 1e-5 * rng.normal(size=parts[0].nodes.shape)
        first, second = (part.item.advance(u) for part in parts)
        np.testing.assert_array_equal(first[0], second[0])
        np.testing.assert_array_equal(first[1], second[1])


@pytest.mark.sample(7)
@pytest.mark.parametrize(("jtype", "closure"), CONSISTENT)
@pytest.mark.parametrize("alpha", [ALPHA, 0.0])
@every_law
def test_a_closed_crack_rubs(crack, jtype, closure, alpha, law):
    """It sticks from the start, and slides at mu times the pressure p (Coulomb); beta is the stiffness of sticking.

    Work of the forces, of springs in series: p^2 (1/alpha + 1/beta)/2 to press, T^2/(2 beta) to the limit T = mu p,
    and T times the slip G - T/beta. The complete form counts all of it.
    """
    part = crack(jtype, closure, ALPHAN=alpha, ALPHAT=alpha, FRICTION=MU, **law)
    stiffness = 1 / ((1 / alpha if alpha else 0.0) + 1 / BETA)
    opening, pressure = -1e-3, 1e-3 * stiffness
    rhs, _ = part.item.advance(part.moved(0.0, opening))
    area = -part.force(rhs)[1] / pressure
    for along, sliding in ((0.3 * MU * pressure / BETA, False), (0.05, True)):
        rhs, _ = part.item.advance(part.moved(along, opening))
        traction = MU * pressure if sliding else BETA * along
        np.testing.assert_allclose(part.along(), traction, rtol=1e-9)
        np.testing.assert_allclose(part.force(rhs)[:2], [area * traction, -area * pressure], rtol=1e-9)
    slip = along - traction / BETA
    np.testing.assert_allclose(part.item.energy[DISSIPATED], area * traction * slip, rtol=1e-9)
    np.testing.assert_array_equal(part.item.state["DISSI"] + part.item.state["DISSII"], 0)
    if closure == 3:
        stored = area * (0.5 * pressure**2 / stiffness + 0.5 * traction**2 / BETA)
        np.testing.assert_allclose(part.item.energy[STORED], stored, rtol=1e-9)
    rhs, _ = part.item.advance(part.moved(along, 1e-3))
    np.testing.assert_allclose(rhs, 0, atol=1e-10 if closure == 3 else 0)
    np.testing.assert_allclose(part.item.energy[DISSIPATED], area * traction * slip, rtol=1e-9)


@pytest.mark.sample(7)
@every
@pytest.mark.parametrize("law", [LAWS["bilinear"], LAWS["PPR"]], ids=["bilinear", "PPR"])
@pytest.mark.parametrize(("along", "opening"), [(0.02, 5e-3), (0.05, -1e-3), (1e-6, -1e-3)])
@pytest.mark.parametrize("flags", [(1, 0, 0, 0), NLGEOM])
def test_tangent(crack, reference, jtype, closure, law, along, opening, flags):
    """AMATRX against differences: open, sliding and sticking. That of U3 and U10 holds the stress of the solids."""
    friction = {"FRICTION": MU} if closure in (1, 3) else {}
    part = crack(jtype, closure, **friction, **law)
    part.item.advance(part.moved(0.0, 0.5 * opening), flags=flags)
    u = part.moved(along, opening).ravel()
    if jtype in OWNED:
        ways = [part.moved(1.0, 0.0).ravel(), part.moved(0.0, 1.0).ravel()]
    else:
        rng = np.random.default_rng(2)
        u += 1e-8 * rng.normal(size=u.size)
        ways = rng.normal(size=(4, u.size)) / np.sqrt(u.size)
    tangent = part.item.evaluate(u, flags=flags)[1]
    along_ways = reference.central_differences(
        lambda s: part.item.evaluate(u + s @ np.array(ways), flags=flags)[0], np.zeros(len(ways)), step=1e-7
    )
    scale = max(abs(tangent).max(), 1e-3 * ALPHA)
    # rounding of forces: 1e-16 of the constants of the plies over the step
    np.testing.assert_allclose(tangent @ np.transpose(ways), -along_ways, rtol=0, atol=2e-5 * scale)


@every
def test_large_rotations_turn_the_forces(crack, jtype, closure):
    friction = {"FRICTION": MU} if closure in (1, 3) else {}
    part = crack(jtype, closure, **friction)
    dim = part.nodes.shape[1]
    axis = np.array([0.6, -0.48, 0.64]) if dim == 3 else np.array([0.0, 0.0, 1.0])
    q = Rotation.from_rotvec(1.1 * axis).as_matrix()[:dim, :dim]
    u = part.moved(0.01, -1e-3)
    straight, _ = part.item.evaluate(u, flags=NLGEOM)
    assert straight.any()
    turned, _ = part.item.evaluate((part.nodes + u) @ q.T - part.nodes, flags=NLGEOM)
    expected = straight.reshape(part.nodes.shape) @ q.T
    np.testing.assert_allclose(turned.reshape(part.nodes.shape), expected, atol=1e-9 * abs(straight).max() + 1e-9)


@pytest.mark.parametrize("jtype", [4, 8])
def test_beta_need_not_exceed_a_softening_that_is_over(crack, jtype):
    values = {"BETAN": 10.0, "BETAT": 10.0, "FRICTION": MU}
    part = crack(jtype, 3, **values)
    part.item.advance(part.moved(0.01, -1e-2))
    np.testing.assert_allclose(part.item.state["TN"], -1e-2 / (1 / ALPHA + 1 / 10.0), rtol=1e-9)
    bonded = crack(jtype, 3, CRACKED=0, **values)
    with pytest.raises(KernelError, match=r"BETAN: beta = 10.*does not exceed the softening slope"):
        bonded.item.evaluate(bonded.moved(0.0, 0.0))


@pytest.mark.parametrize("jtype", [2, 3, 4, 7, 8, 10])
@pytest.mark.parametrize("value", [-1, 2])
def test_other_values_are_refused(element, library, jtype, value):
    part = Crack(element, library, jtype, 0 if jtype in STANDARD else 1)
    layout = element_layouts()[jtype]
    position = next(item.position for item in layout.integers if item.name == "CRACKED")
    item = element(jtype, part.nodes[part.item.owned] if jtype in OWNED else part.nodes, CRACKED=value)
    message = rf"U{jtype} element 1: JPROPS\({position}\) CRACKED = {value}: expected 0 to 1"
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize("cracked", [0, 1])
def test_no_process_zone_is_asked_of_a_crack(element, library, cracked):
    """Elements of 1 mm are longer than the zone of a brittle law, 0.06 mm at most; only one that fails says so."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    library.messages()
    brittle = {"ALPHAN": 0.0, "ALPHAT": 0.0, "SIGMAMAX": 1.0, "TAUMAX": 1.0, "GIC": 1e-6, "GIIC": 1e-6}
    part = Crack(element, library, 4, 3, CRACKED=cracked, BETAN=2e6, BETAT=2e6, **brittle)
    for _ in range(2):
        part.item.advance(part.moved(0.0, 0.01))
    told = [message.text for message in library.messages() if "process zone" in message.text]
    assert len(told) == 1 - cracked
