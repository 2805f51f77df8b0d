# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random properties, states and paths of every law in every interface element, for the tests that use them.

hypothesis draws the properties, a crowd of like elements its states: hundreds, the same in every run, or 10,000 others.
"""

from collections import namedtuple

import numpy as np
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st
from reference_cells import EDGES as EDGES_OF_CELLS
from reference_cells import SQUARE_EDGES, with_middles
from space import QUADRATIC, STANDARD, bottom_of, top_of

EXPONENTS = ("ETA", "POWER")
LAWS, PPR = {1: (), 2: EXPONENTS, 3: EXPONENTS, 4: ("SHAPE",), 5: EXPONENTS, 6: EXPONENTS}, 4
# type and closure; what a law may have besides, each of which is a case of its own
VARIANTS = {"U2": (2, 0), "U3": (3, 0), "U3 consistent": (3, 1), "U4": (4, 0), "U4 consistent": (4, 1)}
VARIANTS |= {"U5": (5, 0), "U6": (6, 0), "U6 consistent": (6, 1)}
IN_SPACE = {"U7": (7, 0), "U8": (8, 0), "U8 consistent": (8, 1), "U10": (10, 0), "U10 consistent": (10, 1)}
IN_SPACE |= {"U11": (11, 0), "U12": (12, 0), "U12 consistent": (12, 1)}
EXTRAS = {
    0: ("plain", "viscous", "rate", "viscous, rate"),
    1: ("plain", "viscous", "friction", "rigid", "rigid, viscous, friction", "rate", "rigid, viscous, friction, rate"),
}


def cases(variants):
    """(variant, law, what it has besides): every combination there is."""
    return [
        (variant, kind, extra)
        for variant, (_, closure) in variants.items()
        for kind in LAWS
        for extra in EXTRAS[closure]
        if not (kind == PPR and "rate" in extra)
    ]


CASES, SPACE_CASES = cases(VARIANTS), cases(IN_SPACE)

COPIES, INCREMENTS, DTIME = 32, 4, 0.3
STATES = COPIES * INCREMENTS
# where the two edges of the interface are among the nodes: left, right, middle
EDGES = {2: ([0, 1], [3, 2]), 4: ([3, 2], [4, 5]), 5: ([0, 1, 4], [3, 2, 5]), 6: ([3, 2, 6], [8, 9, 12])}
SIX = [3, 2, 9, 8, 6, 12]  # nodes of U5 among those of U6
BOTTOM, TOP, FOUR = 1, 1001, 2001  # first labels of the quads of U3 and of the bricks of U10, and their own

sampling = settings(deadline=None, database=None, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
Tools = namedtuple("Tools", "element interface library reference")


def positive(low, high):
    """Numbers spread evenly over the orders of magnitude."""
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


@st.composite
def properties(draw, reference, kind, closure, extra):
    """A law that exists, of any brittleness; with the consistent law a beta above its softening."""
    values = {"LAW": kind, "SIGMAMAX": draw(positive(1.0, 100.0)), "GIC": draw(positive(0.01, 1.0))}
    values["TAUMAX"] = values["SIGMAMAX"] * draw(positive(0.3, 3.0))
    values["GIIC"] = values["GIC"] * draw(positive(0.2, 8.0))
    exponent = draw(st.sampled_from(("", *LAWS[kind])))
    low = {"": 0.0, "SHAPE": 2.0 if closure else 1.2}.get(exponent, 0.5)
    if exponent == "SHAPE":
        values |= {f"SHAPE{i}": draw(st.floats(low, 6.0)) for i in "NT"}
    elif exponent:
        values[exponent] = draw(st.floats(low, 5.0))
    # stiffnesses above the least ones of the pure modes, and of any mode mix
    least = {"N": values["SIGMAMAX"] ** 2 / values["GIC"] / 2, "T": values["TAUMAX"] ** 2 / values["GIIC"] / 2}
    mixed = max(values["SIGMAMAX"], values["TAUMAX"]) ** 2 / min(values["GIC"], values["GIIC"])
    if kind == PPR:
        a = {i: values.get(f"SHAPE{i}", 2.0) for i in "NT"}
        least = {i: 4 * least[i] * a[i] / reference.ppr_final(a[i], a[i]) ** 2 for i in "NT"}
    elif exponent:
        least = {"N": mixed, "T": mixed}
    if kind == 5:
        values |= draw(bridging(values))
        pure = zip(*reference.bridging_shares(values), strict=True)
        brittle = max(max(r / m, (1 - r) / (1 - m)) for r, m in pure)
        least = {mode: brittle * value for mode, value in least.items()}
    elif kind == 6:
        values |= draw(tables())
    alike = draw(st.booleans())
    values["ALPHAN"] = draw(positive(1.05, 1e4)) * least["N"]
    values["ALPHAT"] = values["ALPHAN"] if alike else draw(positive(1.05, 1e4)) * least["T"]
    assume(values["ALPHAT"] > 1.05 * least["T"])
    if kind == 5:
        assume(reference.steepest(values, values["ALPHAT"] / values["ALPHAN"]) < 1e4 / reference.reserve(values, 1.0))
    if "rigid" in extra:
        values |= {"ALPHAN": 0.0, "ALPHAT": 0.0}
    if "viscous" in extra:
        values |= {"VISCOSITY": draw(positive(1e-3, 10.0)), "PACING": draw(st.integers(0, 1))}
    if "friction" in extra:
        values["FRICTION"] = draw(st.floats(0.05, 1.0))
    if "rate" in extra:
        values |= draw(rates(reference, values))
    return values | (draw(betas(reference, values)) if closure else {})


@st.composite
def rates(draw, reference, values):
    """Exponents and rates with which the law exists at every rate, and its traction does not fall with it."""
    strength = draw(st.floats(0.0, 0.3))
    toughness = max(strength * draw(st.floats(1.0, 3.0)), 0.01)
    # from the onset to failure in an increment of one or of ten thousand
    length = min(values["GIC"], values["GIIC"]) / max(values["SIGMAMAX"], values["TAUMAX"])
    slowest, span = length / DTIME * draw(positive(1e-4, 1.0)), draw(positive(1.5, 1e4))
    brittle = brittleness(reference, values) * (1 + span) ** max(0.0, 2.0 * strength - toughness)
    assume(brittle < 1.0)
    if values["LAW"] in (3, 6):
        toughness = max(toughness, 1.01 * strength * (1.0 + brittle))
    return {
        "RATEREFERENCE": slowest,
        "RATELIMIT": slowest * span,
        "STRENGTHRATE": strength,
        "TOUGHNESSRATE": toughness,
    }


def brittleness(reference, values):
    """Upper bound of the separation at onset over that at failure, in every mode mix and of every line; 0 if rigid."""
    if not values["ALPHAN"]:
        return 0.0
    ratio = values["ALPHAT"] / values["ALPHAN"]
    shorter = 1.0
    if values["LAW"] == 5:
        pure = zip(*reference.bridging_shares(values), strict=True)
        shorter = min(min((1 - m) / (1 - r), m / r) for r, m in pure)
    return 1.0 / (values["ALPHAN"] * reference.reserves(values, ratio).min() * shorter)


@st.composite
def bridging(draw, values):
    """Parts of the bridging, in both modes or in mode I alone."""
    parts = st.floats(0.02, 0.9)
    found = {"SIGMABRIDGE": draw(parts) * values["SIGMAMAX"], "GIBRIDGE": draw(parts) * values["GIC"]}
    if draw(st.booleans()):
        found |= {"TAUBRIDGE": draw(parts) * values["TAUMAX"], "GIIBRIDGE": draw(parts) * values["GIIC"]}
    return found


@st.composite
def tables(draw):
    """One to five points of a softening, a plateau in some."""
    count = draw(st.integers(1, 5))
    gaps = np.array([draw(st.floats(0.1, 1.0)) for _ in range(count + 1)])
    separations = np.cumsum(gaps)[:-1] / gaps.sum()
    tractions = np.cumprod([draw(st.sampled_from([1.0, 0.9, 0.6, 0.3])) for _ in range(count)])
    return {
        f"{name}{k}": float(value)
        for name, row in (("SEPARATION", separations), ("TRACTION", tractions))
        for k, value in enumerate(row, 1)
    }


def at_steepest_rate(values):
    """Properties of the law at the rate at which it softens most steeply, k ~ strength^2/toughness."""
    if "RATELIMIT" not in values:
        return values
    span = 1 + values["RATELIMIT"] / values["RATEREFERENCE"]
    factors = {"G": span ** values["TOUGHNESSRATE"], "S": span ** values["STRENGTHRATE"]}
    if factors["S"] ** 2 < factors["G"]:
        return values
    names = {"SIGMAMAX": "S", "TAUMAX": "S", "GIC": "G", "GIIC": "G", "SIGMABRIDGE": "S", "TAUBRIDGE": "S"}
    names |= {"GIBRIDGE": "G", "GIIBRIDGE": "G"}
    return {name: value * factors[names[name]] if name in names else value for name, value in values.items()}


@st.composite
def betas(draw, reference, values):
    """CLOSURE 1 with a beta that is large enough, alike in both directions or not."""
    ratio = values["ALPHAT"] / values["ALPHAN"] if values["ALPHAN"] else 1.0
    spread, size = draw(st.sampled_from([1.0, 0.4, 2.5])), draw(positive(1.1, 1e4))
    if values["LAW"] == PPR:
        pairs = (("SIGMAMAX", "GIC", "ALPHAN", "SHAPEN"), ("TAUMAX", "GIIC", "ALPHAT", "SHAPET"))
        slopes = [reference.ppr_slope(*(values.get(name, 2.0) for name in names)) for names in pairs]
        coupling = values["SIGMAMAX"] * values["TAUMAX"] / min(values["GIC"], values["GIIC"])
        found = [size * (slopes[0] + coupling * spread), size * (slopes[1] + coupling / spread)]
    else:
        # up to (2 - b_min/b_max) times the steepest slope is demanded
        steepest = 2.0 * size * reference.steepest(at_steepest_rate(values), ratio)
        assume(np.isfinite(steepest))
        found = [steepest * max(1.0, spread), steepest * max(1.0, 1 / spread) * ratio]
    return {"CLOSURE": 1, "BETAN": found[0], "BETAT": found[1]}


def options(rng, jtype, closure):
    """Integration, and what the stabilised elements have besides."""
    values = {"INTEGRATION": int(rng.integers(2))}
    if jtype in (3, 4, 6, 8, 10, 12):
        values["SAMPLING"] = int(rng.integers(3))
        if not closure and rng.integers(2):
            values |= {"BETAN": 10 ** rng.uniform(3, 6), "BETAT": 10 ** rng.uniform(3, 6), "GAMMABOT": 0.3}
        elif not closure and jtype not in (3, 10) and rng.integers(2):
            values |= {"BETAN": -1, "BETAT": -1}
    if jtype in (4, 6):
        values["PLANE"] = int(rng.integers(2))
    if jtype in (4, 6, 8, 12):
        values |= {"ANGLE BOTTOM": 30.0 * rng.integers(2), "ANGLE TOP": -55.0}
    return values


# --- crowds


class AnyCrowd:
    """Like elements with the continuum elements beside them, if they take their stress.

    item, neighbours  of the interface and beside it
    parts             nodes of each neighbour among all
    owned             those of the interface among all, where it has neighbours
    """

    def own(self, u):
        """What is of the nodes of the element itself, in a row."""
        return (u[:, self.owned] if self.neighbours else u).reshape(COPIES, -1)

    def call(self, method, u, dtime, **options):
        """`evaluate` or `advance` of the element, after its neighbours."""
        for neighbour, nodes in zip(self.neighbours, self.parts, strict=False):
            neighbour.evaluate(u[:, nodes], dtime=dtime)
        return getattr(self.item, method)(self.own(u), dtime=dtime, **options)


class Crowd(AnyCrowd):
    """Like elements with one way of moving: u (copies, nodes, 2), of the nodes of their quads too."""

    dim = 2
    parts = slice(0, 4), slice(4, 8)

    def __init__(self, make, interface, jtype, **values):
        self.interface, self.jtype, self.neighbours, self.owned = interface, jtype, [], list(interface.owned)
        corners = interface.eight
        if jtype in (5, 6):
            sides = [np.vstack([xy, (xy + np.roll(xy, -1, axis=0)) / 2]) for xy in (corners[:4], corners[4:])]
            xy = np.vstack(sides) if jtype == 6 else np.vstack(sides)[SIX]
        else:
            xy = corners if jtype == 4 else interface.four
        self.nodes = 8 if jtype == 3 else len(xy)
        if jtype == 3:
            values |= {"OFFSETBOTTOM": BOTTOM - FOUR, "OFFSETTOP": TOP - FOUR}
            faces = ((BOTTOM, corners[:4], 3), (TOP, corners[4:], 1))
            self.neighbours = [make(1, side, label=label, copies=COPIES, FACE=face) for label, side, face in faces]
        self.item = make(jtype, xy, label=FOUR, copies=COPIES, **values)
        tau = (interface.edge[1] - interface.edge[0]) / np.linalg.norm(interface.edge[1] - interface.edge[0])
        self.axes = np.array([tau, [-tau[1], tau[0]]])

    def displacements(self, ends, noise):
        """With separations (copies, 2 ends, 2) in (tau, n) upon other displacements."""
        bottom, top = EDGES[{3: 4}.get(self.jtype, self.jtype)]
        u = noise.copy()
        gaps = np.concatenate([ends, ends.mean(axis=1, keepdims=True)], axis=1)[:, : len(top)]
        u[:, top] = u[:, bottom] + gaps @ self.axes
        return u

    def direction(self, rng):
        """Of displacements, random; AMATRX of U3 is that at constant stress of its quads, which move rigidly."""
        shape = (COPIES, self.nodes, 2)
        if not self.neighbours:
            return rng.normal(size=shape) / np.sqrt(2 * self.nodes)
        move, turn = rng.normal(size=(COPIES, 2, 1, 2)), rng.normal(size=(COPIES, 2, 1, 1))
        across = self.interface.eight.reshape(2, 4, 2) @ [[0.0, 1.0], [-1.0, 0.0]]
        return 0.3 * (move + turn * across).reshape(shape)


class SpaceCrowd(AnyCrowd):
    """Like elements in space, on a skew face in the plane z = 0: u (copies, nodes, 3).

    Each copy shears in a direction of its own.
    """

    dim = 3
    parts, owned = (slice(0, 8), slice(8, 16)), slice(4, 12)

    def __init__(self, make, rng, jtype, **values):
        face = np.array([[0.0, 0.0, 0.0], [1.1, -0.15, 0.0], [0.8, 1.1, 0.0], [0.05, 1.2, 0.0]])
        below, above = face - np.array([0.1, 0, 0.8]), face + np.array([0, 0.1, 0.9])
        if jtype in STANDARD:
            middles = with_middles(face, SQUARE_EDGES)[4:] if jtype in QUADRATIC else face[:0]
            xyz = np.vstack([face, face, middles, middles])
        else:
            edges = EDGES_OF_CELLS["hexahedron"] if jtype in QUADRATIC else []
            xyz = np.vstack([with_middles(np.vstack(pair), edges) for pair in ((below, face), (face, above))])
        self.nodes, self.jtype, self.places, self.neighbours = len(xyz), jtype, xyz, []
        if jtype == 10:
            values |= {"OFFSETBOTTOM": BOTTOM - FOUR, "OFFSETTOP": TOP - FOUR}
            sides = ((BOTTOM, xyz[:8], 2), (TOP, xyz[8:], 1))
            self.neighbours = [make(9, side, label=label, copies=COPIES, FACE=face) for label, side, face in sides]
            xyz = xyz[4:12]
        self.item = make(jtype, xyz, label=FOUR, copies=COPIES, **values)
        angle = rng.uniform(-np.pi, np.pi, COPIES)
        along = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(COPIES)])
        self.axes = np.stack([along, np.tile([0.0, 0.0, 1.0], (COPIES, 1))], axis=1)

    def displacements(self, ends, noise):
        """With separations (copies, 2 ends, 2) in (tau, n) upon other displacements."""
        u, top = noise.copy(), top_of(self.jtype)
        gaps = (ends @ self.axes)[:, [0, 1, 1, 0]]
        gaps = np.concatenate([gaps, (gaps + np.roll(gaps, -1, axis=1)) / 2], axis=1)[:, : len(top)]
        u[:, top] = u[:, bottom_of(self.jtype)] + gaps
        return u

    def direction(self, rng):
        """Of displacements, random; the bricks of U10 move rigidly, as AMATRX is that at constant stress."""
        shape = (COPIES, self.nodes, 3)
        if not self.neighbours:
            return rng.normal(size=shape) / np.sqrt(3 * self.nodes)
        move, turn = rng.normal(size=(2, COPIES, 2, 1, 3))
        return 0.3 * (move + np.cross(turn, self.places.reshape(2, 8, 3))).reshape(shape)


def separations(rng, values, pure=1 / 6):
    """(copies, 2 ends, tau and n), below the onset to beyond failure; of any mode mix, a part pure; a sixth closed."""
    strength = min(values["SIGMAMAX"], values["TAUMAX"])
    tail = max(1.0, values.get("SHAPEN", 2.0) / 2, values.get("SHAPET", 2.0) / 2)
    soft = 3.0 * tail * max(values["GIC"], values["GIIC"]) / strength
    if "SIGMABRIDGE" in values:
        soft *= max(1.0, values["GIBRIDGE"] / values["GIC"] * values["SIGMAMAX"] / values["SIGMABRIDGE"])
    alpha = max(values["ALPHAN"], values["ALPHAT"])
    stiff = min(0.1 * strength / alpha if alpha else soft, 1e-3 * soft)
    size = np.exp(rng.uniform(np.log(stiff), np.log(soft), (COPIES, 2)))
    angle = rng.uniform(-np.pi / 2, np.pi / 2, (COPIES, 2)) * (rng.random((COPIES, 2)) > pure)
    closed = np.where(rng.random((COPIES, 2)) < 1 / 6, -1, 1)
    return size[..., None] * np.stack([np.sin(angle), closed * np.cos(angle)], axis=-1)


def run_examples(check, examples, tools, *case, again=False):
    """Some hypothesis examples of a check, the same ones `again`; what they return."""
    found = []

    @settings(sampling, max_examples=examples, derandomize=again)
    @given(data=st.data())
    def example(data):
        # no quads of an earlier crowd
        tools.library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
        found.append(check(tools, *case, data))

    example()
    return found
