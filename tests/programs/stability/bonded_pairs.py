# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of random pairs of solids with an interface element between them, and how much of beta they need.

A batch has many shapes and one pair of plies: the elements share no nodes, so that three calls give all their matrices.
With half of the solids' energy the needed multiple of beta is the least with which K = (K_below + K_above)/2 +
K_interface has no negative eigenvalue.
"""

import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from random_pairs import random_ply, random_shapes
from solid_pairs import solid_nodes

from uel.elements import Call, Flags, Request, build_blocks
from uel.elements.interfaces.neighbour_solids import formulation_of
from uel.errors import Source
from uel.model.element_types import BUILT_IN
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.properties import (
    Elastic,
    ElasticType,
    Material,
    Orientation,
    SolidSection,
    UserElement,
    UserProperty,
)
from uel.usersub.layout import element_layouts

BATCH = 40
"""Shapes with the same plies."""

RIGID, SOFT, BETWEEN = range(3)
"""Stiffness of the law: infinite (ALPHAN 0), next to nothing, anything between."""

LAW = {"SIGMAMAX": 1.0, "TAUMAX": 1.0, "GIC": 1e25, "GIIC": 1e25}
"""Strengths and energies whose softening slope, 5e-26, is below any beta."""

STANDARD = {(2, 2): 2, (2, 3): 5, (3, 3): 13, (3, 4): 7, (3, 6): 14, (3, 8): 11}
"""Standard elements by dimension and nodes of a face: their matrix is that of the jumps."""

SOURCE = Source("stability.inp", 1)
AT_REST = Call(Flags(1, False, Request.NORMAL), 1, 1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)


@dataclass(frozen=True)
class Batch:
    """Cases with the same plies.

    shapes       (count, nodes, dim)
    own          (count, n, n) matrices of the interface elements
    solids       (count, n, n) matrices of the solids below and above
    beta         (count, 2) beta_n and beta_tau that the elements have computed
    integration  INTEGRATION
    """

    shapes: np.ndarray
    own: np.ndarray
    solids: np.ndarray
    beta: np.ndarray
    integration: int


@dataclass(frozen=True)
class Measures:
    """Numbers of a batch, each with a value per case.

    lowest   smallest eigenvalue over the largest one
    betti    difference of u1.K u2 and u2.K u1, over the sum of their terms' sizes
    needed   multiple of beta that suffices with half of the solids' energy; NaN for BETWEEN
    """

    lowest: np.ndarray
    betti: np.ndarray
    needed: np.ndarray


# --- matrices


def matrices(library, groups, coordinates):
    """Matrices (count, n, n) and SVARS of groups: a type, a section, a definition, and nodes (count, k) each."""
    xyz = np.zeros((len(coordinates), 3))
    xyz[:, : coordinates.shape[1]] = coordinates
    mesh = Mesh(np.arange(1, len(xyz) + 1), xyz, ("",) * len(xyz))
    made = tuple(
        ElementGroup(name, 1 + 1000000 * k + np.arange(len(nodes)), nodes, "", section, definition, SOURCE)
        for k, (name, section, definition, nodes) in enumerate(groups)
    )
    found = []
    for block in build_blocks(Model(Path("stability.inp"), "", mesh, made, ()), library):
        count, n = len(block.nodes), len(block.unknowns)
        equations = np.arange(count * n, dtype=np.int32).reshape(count, n)
        block.bind(equations, np.zeros((count, n, n), dtype=np.int32))
        u = np.zeros(count * n)
        # columns first
        matrix = block.evaluate_unassembled(AT_REST, u, u, np.zeros_like(u))[1].transpose(0, 2, 1)
        block.commit()
        found.append((matrix, block.state(0).svars))
    return found


def user_group(jtype, values, nodes):
    """Group of elements of the project with these properties and nodes (count, k)."""
    layout = element_layouts()[jtype]
    reals, integers = ([values.get(item.name, 0.0) for item in items] for items in (layout.reals, layout.integers))
    assert set(values) <= {item.name for item in (*layout.reals, *layout.integers)}, values
    definition = UserElement(
        jtype,
        layout.nodes,
        tuple((node, dof) for node in range(layout.nodes) for dof in range(1, 1 + layout.dimension)),
        SOURCE,
        coordinates=layout.dimension,
        properties=len(reals),
        integer_properties=len(integers),
        variables=layout.svars,
        unsymmetric=True,
    )
    section = UserProperty("ALL", SOURCE, np.array(reals), np.array(integers, dtype=int), None)
    return f"U{jtype}", section, definition, nodes


def solid_group(name, ply, axes, nodes):
    """Group of built-in elements of a ply, whose ANGLE is from the first of the axes (rows) towards the second."""
    angle = np.deg2rad(ply["ANGLE"])
    c, s = np.cos(angle), np.sin(angle)
    own = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ axes
    constants = tuple(value for each, value in ply.items() if each != "ANGLE")
    material = Material("PLY", SOURCE, Elastic(ElasticType.ENGINEERING_CONSTANTS, constants, SOURCE))
    return name, SolidSection("ALL", material, Orientation("PLY", own, SOURCE), 1.0, SOURCE), None, nodes


def make_batch(library, kind, rng, count, law):
    """Draw plies, shapes and options, and compute the matrices.

    In space s, the direction from which the plies' angles are, and the normal are the same in all elements of a batch.
    """
    layout = element_layouts()[kind.jtype]
    dim = layout.dimension
    size, modulus, ratio = 10.0 ** rng.uniform(-2, 2), 10.0 ** rng.uniform(-3, 3), 10.0 ** rng.uniform(-3, 3)
    plies = random_ply(rng, modulus), random_ply(rng, modulus * ratio)
    shapes = size * random_shapes(kind.jtype, rng, count)
    axes = np.eye(3)
    values = LAW | {"CLOSURE": 3, "SAMPLING": rng.choice(3, p=[0.5, 0.25, 0.25])}
    values["INTEGRATION"] = rng.choice(2, p=[0.75, 0.25])
    if rng.random() < 0.25:
        values["GAMMABOT"] = rng.uniform(0.05, 0.95)
    if dim == 3:
        axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        axes *= np.sign(np.linalg.det(axes))
        shapes = shapes @ axes
        values |= {f"DIRECTION{k + 1}": axes[0, k] for k in range(3)}
    else:
        values |= {"PLANE": kind.plane, "THICKNESS": 1.0}
    exponent = {SOFT: -9.0, BETWEEN: rng.uniform(-3, 5)}
    if law != RIGID:
        values |= dict.fromkeys(("ALPHAN", "ALPHAT"), modulus * min(1.0, ratio) / size * 10.0 ** exponent[law])
    for side, name, ply in zip(("BOTTOM", "TOP"), (kind.below, kind.above), plies, strict=True):
        names = {item.name for item in layout.reals}
        values |= {f"{each} {side}": value for each, value in ply.items() if f"{each} {side}" in names}
        values[f"FORMULATION {side}"] = formulation_of(BUILT_IN[name])
    nodes = np.arange(count * layout.nodes).reshape(count, -1)
    parts = solid_nodes(kind.jtype)
    groups = [user_group(kind.jtype, values, nodes)]
    groups += [
        solid_group(name, ply, axes, nodes[:, part])
        for name, ply, part in zip((kind.below, kind.above), plies, parts, strict=True)
    ]
    (own, svars), *of_solids = matrices(library, groups, shapes.reshape(-1, dim))
    solids = np.zeros_like(own)
    for part, (matrix, _) in zip(parts, of_solids, strict=True):
        rows = slice(dim * part.start, dim * part.stop)
        solids[:, rows, rows] = matrix
    first = layout.points * len(layout.variables)
    beta = np.column_stack(
        [svars[:, first - 1 + item.position] for item in layout.own if item.name in ("BETAN", "BETAT")]
    )
    return Batch(shapes, own, solids, beta, values["INTEGRATION"])


def jump_matrices(library, kind, shapes, integration):
    """Matrices (count, n, n) of |g_n|^2 and |g_tau|^2, summed over the points: those of the standard element there."""
    layout = element_layouts()[kind.jtype]
    dim = layout.dimension
    standard = STANDARD[dim, len(layout.faces[0])]
    places = np.zeros(element_layouts()[standard].nodes, dtype=int)
    for mine, faces in zip(element_layouts()[standard].faces, layout.faces, strict=True):
        places[list(mine)] = faces
    nodes = np.arange(len(shapes) * layout.nodes).reshape(len(shapes), -1)[:, places]
    values = LAW | {"INTEGRATION": integration} | ({"THICKNESS": 1.0} if dim == 2 else {})
    pairs = ((2.0, 1.0), (1.0, 2.0))
    groups = [user_group(standard, values | {"ALPHAN": n, "ALPHAT": t}, nodes) for n, t in pairs]
    (first, _), (second, _) = matrices(library, groups, shapes.reshape(-1, dim))
    dofs = np.add.outer(dim * places, range(dim)).ravel()
    found = np.zeros((2, len(shapes), dim * layout.nodes, dim * layout.nodes))
    found[0][:, dofs[:, None], dofs] = (2.0 * first - second) / 3.0
    found[1][:, dofs[:, None], dofs] = (2.0 * second - first) / 3.0
    return found


# --- what is asked of them


def rigid_motions(shapes):
    """Orthonormal rigid motions (count, dim nodes, 3 or 6) of nodes (count, nodes, dim)."""
    count, nodes, dim = shapes.shape
    centred = shapes - shapes.mean(axis=1, keepdims=True)
    motions = [np.tile(axis, (count, nodes, 1)) for axis in np.eye(dim)]
    for i, j in ((0, 1), (0, 2), (1, 2))[: 2 * dim - 3]:
        turn = np.zeros_like(centred)
        turn[:, :, i], turn[:, :, j] = -centred[:, :, j], centred[:, :, i]
        motions.append(turn)
    return np.linalg.qr(np.stack([motion.reshape(count, -1) for motion in motions], axis=2))[0]


def without_zeros(matrix, shapes):
    """Matrix to which rigid motions of nodes add the mean stiffness, and any motion 1e-10 of it.

    The second is for displacements without energy, which quadratic elements of reduced integration have.
    """
    n = matrix.shape[-1]
    mean = np.trace(matrix, axis1=1, axis2=2)[:, None, None] / n
    motions = rigid_motions(shapes)
    return matrix + mean * (motions @ motions.transpose(0, 2, 1) + 1e-10 * np.eye(n))


def largest_ratio(matrix, energy):
    """Largest eigenvalue (count,) of matrix v = lambda energy v; infinite if an energy is not positive definite."""
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(energy))
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.array([np.inf])
        return np.concatenate([largest_ratio(matrix[k : k + 1], energy[k : k + 1]) for k in range(len(matrix))])
    return np.linalg.eigvalsh(inverse @ matrix @ inverse.transpose(0, 2, 1))[:, -1]


def needed_soft(kind, batch):
    """Multiple of beta (count,) without a stiffness: K is -B^T B/beta, B being that of <sigma>.n."""
    dim = batch.shapes.shape[2]
    energy = np.zeros_like(batch.solids)
    for part in solid_nodes(kind.jtype):
        rows = slice(dim * part.start, dim * part.stop)
        energy[:, rows, rows] = without_zeros(0.5 * batch.solids[:, rows, rows], batch.shapes[:, part])
    return largest_ratio(-batch.own, energy)


def needed_rigid(library, kind, batch):
    """Multiple m of beta (count,) with an infinite stiffness: K has m times the matrix G of beta |g|^2.

    With P for K at m = 2 K has no negative eigenvalue at m = 2 - 1/lambda, if lambda is the largest one of G v = lambda
    P v; P has none if the needed m is below 2.
    """
    normal, shear = jump_matrices(library, kind, batch.shapes, batch.integration)
    jumps = batch.beta[:, :1, None] * normal + batch.beta[:, 1:, None] * shear
    whole = 0.5 * batch.solids + 0.5 * (batch.own + batch.own.transpose(0, 2, 1)) + jumps
    return 2.0 - 1.0 / largest_ratio(jumps, without_zeros(whole, batch.shapes))


def measure(library, kind, batch, law, rng):
    """Compute the numbers of a batch."""
    whole = batch.own + batch.solids
    values = np.linalg.eigvalsh(0.5 * (whole + whole.transpose(0, 2, 1)))
    first, second = rng.normal(size=(2, *whole.shape[:2], 1))
    sizes = abs(first).transpose(0, 2, 1) @ abs(whole) @ abs(second)
    difference = first.transpose(0, 2, 1) @ (whole @ second) - second.transpose(0, 2, 1) @ (whole @ first)
    needed = np.full(len(whole), np.nan)
    if law == SOFT:
        needed = needed_soft(kind, batch)
    elif law == RIGID:
        needed = needed_rigid(library, kind, batch)
    return Measures(values[:, 0] / values[:, -1], (abs(difference) / sizes).ravel(), needed)


def run_batch(library, kind, number, seed, count=BATCH):
    """Draw the batch of a number, and measure it; law and measures."""
    rng = np.random.default_rng([seed, zlib.crc32(kind.name.encode()), number])
    law = number % 3
    return law, measure(library, kind, make_batch(library, kind, rng, count, law), law, rng)
