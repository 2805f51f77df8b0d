# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's equations as they are printed, one point at a time, to compare the kernels with.

Ghosh, Duddu, Annavarapu, "A stabilized finite element method for delamination analysis of composites using cohesive
elements". Signs as in fortran/laws.md; vectors are (tau, n).
"""

from itertools import combinations, product

import numpy as np
from scipy.optimize import brentq

GAUSS = 1 / np.sqrt(3)
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
POINTS = {0: (-GAUSS, GAUSS), 1: (-1.0, 1.0)}


def damage(law, g):
    """Equations (9) to (11) without history."""
    opening = max(g[1], 0.0)
    equivalent = np.hypot(g[0], opening)
    if equivalent == 0:
        return 0.0
    cos_n, cos_t = opening / equivalent, abs(g[0]) / equivalent
    onset = 1 / np.hypot(law["ALPHAN"] * cos_n / law["SIGMAMAX"], law["ALPHAT"] * cos_t / law["TAUMAX"])
    ultimate = 1 / (
        law["ALPHAN"] * onset * cos_n**2 / (2 * law["GIC"]) + law["ALPHAT"] * onset * cos_t**2 / (2 * law["GIIC"])
    )
    if equivalent < onset:
        return 0.0
    if equivalent >= ultimate:
        return 1.0
    return ultimate * (equivalent - onset) / (equivalent * (ultimate - onset))


def law_traction(law, w):
    """Traction of the bilinear law at an opening w without history; ALPHAN = ALPHAT = 0 is the limit of (8) to (11)."""
    if law["ALPHAN"] > 0:
        return (1 - damage(law, w)) * np.array([law["ALPHAT"], law["ALPHAN"]]) * w
    length = np.hypot(*w)
    cos_t, cos_n = w / length
    # delta_c = 0, alpha delta_c the strength in this direction
    strength = 1 / np.hypot(cos_n / law["SIGMAMAX"], cos_t / law["TAUMAX"])
    ultimate = 1 / (strength * cos_n**2 / (2 * law["GIC"]) + strength * cos_t**2 / (2 * law["GIIC"]))
    return max(0.0, strength * (1 - length / ultimate)) * w / length


def softening_slopes(law):
    """Slopes of the softening branch in sliding and opening, stress/length; ALPHAN = ALPHAT = 0 is infinite."""
    slopes = []
    for toughness, strength, alpha in (("GIIC", "TAUMAX", "ALPHAT"), ("GIC", "SIGMAMAX", "ALPHAN")):
        onset = law[strength] / law[alpha] if law[alpha] > 0 else 0.0
        slopes.append(law[strength] / (2 * law[toughness] / law[strength] - onset))
    return np.array(slopes)


def stiffness(law, d, closed):
    """Diagonal of the secant matrix (24)."""
    return np.array([(1 - d) * law["ALPHAT"], law["ALPHAN"] * (1 if closed else 1 - d)])


def standard_traction(law, g, d):
    """Equation (8)."""
    return stiffness(law, d, g[1] < 0) * g


def stabilised_traction(law, g, d, bulk, beta):
    """Equation (16), closed where <sigma>_n + beta_n g_n < 0; T and S."""
    k = stiffness(law, d, bulk[1] + beta[1] * g[1] < 0)
    s = beta / (k + beta)
    return (1 - s) * bulk + s * k * g, s


def elasticity(ply, angle, plane_strain):
    """Stiffness in global axes of a ply turned by angle (degrees), from the inverse of the full compliance."""
    e, nu12, nu13, nu23 = [ply[f"E{i}"] for i in (1, 2, 3)], ply["NU12"], ply["NU13"], ply["NU23"]
    compliance = np.diag([1 / e[0], 1 / e[1], 1 / e[2], 1 / ply["G12"]])
    for i, j, nu in ((0, 1, nu12), (0, 2, nu13), (1, 2, nu23)):
        compliance[i, j] = compliance[j, i] = -nu / e[i]
    kept = [0, 1, 3]
    local = (
        np.linalg.inv(compliance)[np.ix_(kept, kept)] if plane_strain else np.linalg.inv(compliance[np.ix_(kept, kept)])
    )
    # through the tensor of fourth order
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c, -s], [s, c]])
    pairs = [(0, 0), (1, 1), (0, 1)]
    place = {(0, 0): 0, (1, 1): 1, (0, 1): 2, (1, 0): 2}
    tensor = np.array(
        [[[[local[place[i, j], place[k, m]] for m in (0, 1)] for k in (0, 1)] for j in (0, 1)] for i in (0, 1)]
    )
    turned = np.einsum("ai,bj,ck,dm,ijkm->abcd", turn, turn, turn, turn, tensor)
    return np.array([[turned[*p, *q] for q in pairs] for p in pairs])


def ply_stress(strain):
    """(3, 3) stress of the ply of the fixtures from its (3, 3) strain, both along its axes, from its compliance."""
    e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = (1.2e5, 1.05e4, 1.05e4, 0.3, 0.3, 0.51, 5.52e3, 5.52e3, 3.48e3)
    compliance = np.array(
        [[1 / e1, -nu12 / e1, -nu13 / e1], [-nu12 / e1, 1 / e2, -nu23 / e2], [-nu13 / e1, -nu23 / e2, 1 / e3]]
    )
    stress = np.diag(np.linalg.solve(compliance, np.diag(strain)))
    for (i, j), modulus in {(0, 1): g12, (0, 2): g13, (1, 2): g23}.items():
        stress[i, j] = stress[j, i] = 2 * modulus * strain[i, j]
    return stress


def tensors(state, name):
    """(points, 3, 3) stress or strain of the points of a brick."""
    full = np.empty((8, 3, 3))
    for (i, j), component in zip(PAIRS, ("11", "22", "33", "12", "13", "23"), strict=True):
        values = state[f"{name}{component}"] / (2 if name == "E" and i != j else 1)
        full[:, i, j] = full[:, j, i] = values
    return full


def ply_axes(coordinates, angle=0.0):
    """Rows: axes of the ply. 3 is normal to the surface half-way between both faces, 1 at an angle from s to t = n x s,
    s being the projection of the x axis."""
    middle = (coordinates[:4] + coordinates[4:]) / 2
    n = np.cross(middle[1] + middle[2] - middle[0] - middle[3], middle[2] + middle[3] - middle[0] - middle[1])
    n /= np.linalg.norm(n)
    s = np.array([1.0, 0, 0]) - n[0] * n
    s /= np.linalg.norm(s)
    c, d = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
    t = np.cross(n, s)
    return np.array([c * s + d * t, c * t - d * s, n])


def strain_matrix(xy, xi, eta):
    """B (3, 8) and Jacobian of a bilinear quad."""
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    by_parent = np.array([corner[:, 0] * (1 + corner[:, 1] * eta) / 4, corner[:, 1] * (1 + corner[:, 0] * xi) / 4])
    jacobian = by_parent @ np.asarray(xy)
    by_x, by_y = np.linalg.solve(jacobian, by_parent)
    b = np.zeros((3, 8))
    b[0, 0::2], b[1, 1::2] = by_x, by_y
    b[2, 0::2], b[2, 1::2] = by_y, by_x
    return b, np.linalg.det(jacobian)


def serendipity(places, point):
    """Shape functions at a point and their derivatives (dimension, nodes), from the monomials that they span.

    With middles of edges these have one square at most (O.C. Zienkiewicz, R.L. Taylor, The Finite Element Method).
    """
    places, dim = np.asarray(places, dtype=float), len(point)
    squares = int(len(places) > 2**dim)
    powers = np.array([p for p in product(range(3), repeat=dim) if p.count(2) <= squares])
    coefficients = np.linalg.inv(np.prod(places[:, None] ** powers, axis=2))
    slopes = []
    for i in range(dim):
        less = powers.copy()
        less[:, i] = np.maximum(less[:, i] - 1, 0)
        slopes.append(powers[:, i] * np.prod(np.asarray(point) ** less, axis=1))
    return np.prod(np.asarray(point) ** powers, axis=1) @ coefficients, np.array(slopes) @ coefficients


def serendipity_strain(places, coordinates, point):
    """B and the Jacobian matrix of such an element: strains (11, 22, 12) or (11, 22, 33, 12, 13, 23)."""
    slopes = serendipity(places, point)[1]
    jacobian = slopes @ coordinates
    g, dim = np.linalg.solve(jacobian, slopes), len(point)
    b = np.zeros((3 * (dim - 1), dim * len(places)))
    for i in range(dim):
        b[i, i::dim] = g[i]
    for k, (i, j) in enumerate(combinations(range(dim), 2), start=dim):
        b[k, i::dim], b[k, j::dim] = g[j], g[i]
    return b, jacobian


def gauss(count, dim):
    """Points (count**dim, dim) and weights of the product rule."""
    line, weights = np.polynomial.legendre.leggauss(count)
    return np.array(list(product(line, repeat=dim))), np.prod(list(product(weights, repeat=dim)), axis=1)


def frame(start, finish):
    """Rows tau and n, and the length."""
    along = np.subtract(finish, start)
    length = np.linalg.norm(along)
    tau = along / length
    return np.array([tau, [-tau[1], tau[0]]]), length


def shoelace(xy):
    """Area of a polygon."""
    x, y = np.asarray(xy).T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def weights(norms, areas, length):
    """Equations (22) and (21): gamma of (bottom, top) and beta."""
    soft = np.divide(areas, norms)
    gamma = soft / soft.sum()
    return gamma, 2 * (gamma**2 / soft).sum() * length


def traction_of_stress(axes, stress):
    """Components (tau, n) of sigma.n for stress (11, 22, 12)."""
    tensor = np.array([[stress[0], stress[2]], [stress[2], stress[1]]])
    return axes @ tensor @ axes[1]


def sampling_place(sampling, s, side):
    """(xi, eta) where the stress of the bottom (0) or top (1) quad is taken for the place s of the interface."""
    face = 1.0 if side == 0 else -1.0
    return {0: (0.0, face), 1: (s, face), 2: (np.sign(s) * GAUSS, face * GAUSS)}[sampling]


def trial_traction(sides, u, options, s, elasticity):
    """p = <sigma>.n + beta g in (tau, n), g, beta and the frame, at the place s of the interface of U4.

    sides       (8, 2) coordinates of the nodes
    u           (8, 2) displacements
    options     BETAN, BETAT, GAMMABOT, SAMPLING of the element, where given
    s           place of the point, from -1 to 1
    elasticity  stiffness of the bottom and the top quad
    """
    axes, length = frame(sides[3], sides[2])
    norms = [np.linalg.norm(d, 2) for d in elasticity]
    areas = [shoelace(sides[:4]), shoelace(sides[4:])]
    gamma, _ = weights(norms, areas, length)
    if "GAMMABOT" in options:
        gamma = np.array([options["GAMMABOT"], 1 - options["GAMMABOT"]])
    computed = 2 * length * (gamma**2 * norms / areas).sum()
    beta = np.array([options.get("BETAT", computed), options.get("BETAN", computed)])
    stress = np.zeros(3)
    for side in (0, 1):
        nodes = slice(4 * side, 4 * side + 4)
        place = sampling_place(options.get("SAMPLING", 0), s, side)
        stress += gamma[side] * elasticity[side] @ strain_matrix(sides[nodes], *place)[0] @ u[nodes].ravel()
    gap = axes @ ((1 - s) / 2 * (u[4] - u[3]) + (1 + s) / 2 * (u[5] - u[2]))
    return traction_of_stress(axes, stress) + beta * gap, gap, beta, axes


def central_differences(function, x, step):
    """Jacobian of function by central differences of sixth order."""
    columns = []
    for i in range(len(x)):
        e = np.zeros(len(x))
        e[i] = step
        terms = ((45, 1), (-9, 2), (1, 3))
        columns.append(sum(w * (function(x + n * e) - function(x - n * e)) for w, n in terms) / (60 * step))
    return np.array(columns).T


def toughness(law, g):
    """Fracture energy in the mode mix of g: Benzeggagh and Kenane with ETA, the power law with POWER (0: 1).

    Abaqus Analysis User's Guide, "Defining the constitutive response of cohesive elements using a traction-separation
    description", "Dependence of fracture energy on mode mix"; the mode mix is that of the energies.
    """
    normal, tangential = law["ALPHAN"] * max(g[1], 0.0) ** 2, law["ALPHAT"] * g[0] ** 2
    m1, m2 = normal / (normal + tangential), tangential / (normal + tangential)
    if law.get("ETA", 0) > 0:
        return law["GIC"] + (law["GIIC"] - law["GIC"]) * m2 ** law["ETA"]
    power = law.get("POWER", 0) or 1.0
    return ((m1 / law["GIC"]) ** power + (m2 / law["GIIC"]) ** power) ** (-1 / power)


def onset(law, g):
    """Separation at which a ray through g meets the quadratic stress criterion."""
    return 1 / np.hypot(law["ALPHAN"] * max(g[1], 0.0) / law["SIGMAMAX"], law["ALPHAT"] * g[0] / law["TAUMAX"])


def damage_of_law(law, g):
    """Damage without history of LAW 2, 3, 5 and 6, from size of the separation along its ray: 1 at the onset.

    The traction along the ray is 1 at the onset too, so the areas are in units of twice the energy at the onset.
    LAW 2: Camanho and Davila, NASA/TM-2002-211737. LAW 3: exponential decay of the traction from the onset.
    LAW 5: two bilinear laws with one damage (Davila, Rose, Camanho, Int. J. of Fracture 158 (2009) 211), each with its
    share of the traction at the onset and of the area. LAW 6: a polygon from the onset on.
    """
    scale = onset(law, g) if any(g) else np.inf
    size = 1 / scale
    if size <= 1:
        return 0.0
    at_onset = 0.5 * (law["ALPHAN"] * max(g[1], 0.0) ** 2 + law["ALPHAT"] * g[0] ** 2) * scale**2
    area = 0.5 * toughness(law, g) / at_onset
    if law["LAW"] == 3:
        return 1 - np.exp(-(size - 1) / (area - 0.5)) / size
    if law["LAW"] == 5:
        share = mode_mix(law, g)
        strength, energy = (np.interp(share, [0, 1], pair) for pair in bridging_shares(law))
        left = 0.0
        for height, part in ((1 - strength, 1 - energy), (strength, energy)):
            # half of height times the separation at failure
            last = 2 * area * part / height
            left += height * max(0.0, last - size) / (last - 1)
        return 1 - left / size
    if law["LAW"] == 6:
        x, t = polygon(law)
        return 1 - np.interp((size - 1) / (area - 0.5) * np.trapezoid(t, x), x, t) / size
    last = 2 * area
    return 1.0 if size >= last else last * (size - 1) / (size * (last - 1))


def mode_mix(law, g):
    """Share of mode II in the energy of a separation g; ALPHAN = 0 is infinite, and alike in both directions."""
    alpha = [law["ALPHAT"], law["ALPHAN"]] if law["ALPHAN"] else [1.0, 1.0]
    normal, tangential = alpha[1] * max(g[1], 0.0) ** 2, alpha[0] * g[0] ** 2
    return tangential / (normal + tangential)


def bridging_shares(law):
    """Return the shares of the bridging in strength and energy, each in mode I and II; 0 in mode II: that of mode I."""
    pairs = (("SIGMABRIDGE", "SIGMAMAX", "TAUBRIDGE", "TAUMAX"), ("GIBRIDGE", "GIC", "GIIBRIDGE", "GIIC"))
    return [(law[a] / law[b], law[c] / law[d] if law.get(c) else law[a] / law[b]) for a, b, c, d in pairs]


def polygon(law):
    """Points of the softening of LAW 6: separation beyond the onset over that at failure, traction over the onset's."""
    points = [(law.get(f"SEPARATION{k}", 0.0), law.get(f"TRACTION{k}", 0.0)) for k in range(1, 6)]
    return np.array([(0.0, 1.0), *(p for p in points if p[0] > 0), (1.0, 0.0)]).T


def steepest(values, ratio):
    """Steepest softening -d tau/d lambda in any mode mix, stress/length, of LAW 1 to 3, 5 and 6."""
    if values["LAW"] == 5:
        share = mixes()
        least, flexibility = reserves(values, ratio), 1 / values["ALPHAN"] if values["ALPHAN"] else 0.0
        strength, energy = (np.interp(share, [0, 1], pair) for pair in bridging_shares(values))
        lines = ((1 - strength, 1 - energy), (strength, energy))
        slopes = [height / (part / height * least - flexibility) for height, part in lines]
        # a line that falls before its onset is infinitely steep
        return np.inf if min(map(np.min, slopes)) <= 0 else np.sum(slopes, axis=0).max()
    room = reserve(values, ratio)
    if values["LAW"] == 6:
        x, t = polygon(values)
        return 2 * np.trapezoid(t, x) * max(-np.diff(t) / np.diff(x)) / room if room > 0 else np.inf
    return (2.0 if values["LAW"] == 3 else 1.0) / room if room > 0 else np.inf


def mixes():
    """Shares of mode II in the energy, all of them close enough and more near the pure modes."""
    near = np.geomspace(1e-5, 1e-2, 40)
    return np.unique(np.concatenate([np.linspace(0.0, 1.0, 401), near, 1 - near]))


def reserve(values, ratio):
    """Least separation at failure less that at onset over the traction at onset, in any mode mix; LAW 1 to 3.

    ratio is ALPHAT/ALPHAN; ALPHAN = 0 is infinite. Its inverse is the steepest softening of the bilinear laws.
    """
    return reserves(values, ratio).min() - (1 / values["ALPHAN"] if values["ALPHAN"] else 0.0)


def reserves(values, ratio):
    """Separation at failure over the traction at onset in each of the `mixes`, of a straight softening."""
    share = mixes()
    power = values.get("POWER", 1.0)
    toughness = ((share / values["GIIC"]) ** power + ((1 - share) / values["GIC"]) ** power) ** (-1 / power)
    if "ETA" in values:
        toughness = values["GIC"] + (values["GIIC"] - values["GIC"]) * share ** values["ETA"]
    strength = share * ratio / values["TAUMAX"] ** 2 + (1 - share) / values["SIGMAMAX"] ** 2
    return 2 * toughness * strength


def ppr_final(a, m):
    """Final separation of the PPR law in units of G/strength (Park, Paulino, Roesler 2009)."""
    lam = np.sqrt(m / (a * (a + m - 1)))
    return a * lam * (1 - lam) ** (a - 1) * (a / m + 1) * (1 + a * lam / m) ** (m - 1)


def ppr_slope(strength, toughness, alpha, a):
    """A little more than the bound of its softening slope: (a - 1) times the largest traction/(final - separation)."""
    if alpha == 0:
        return 1.01 * (a - 1) * strength**2 / (a * toughness)
    wanted = np.log(toughness * alpha / strength**2)
    log_m = brentq(lambda z: np.log(a * (a / np.exp(z) + 1) / ppr_final(a, np.exp(z)) ** 2) - wanted, -60, np.log(a))
    m, final = np.exp(log_m), ppr_final(a, np.exp(log_m)) * toughness / strength
    x = np.concatenate([np.geomspace(1e-2 * m, 0.5, 400), 1 - np.geomspace(0.5, 1e-9, 200)])
    over_rest = alpha * final * x * (1 - x) ** (a - 2) * (1 + a * x / m) ** (m - 1)
    return 1.01 * (a - 1) / final * over_rest.max()
