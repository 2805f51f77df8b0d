# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Contact in finite sliding: derivatives, rotations, and bodies that slide over many faces, by closed forms."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness.deck.pieces import make_pieces
from harness.elements import ContactBlock, FiniteSliding, Flags, Request
from harness.errors import Source
from harness.model.contact import ContactProperty, SlidingPair
from harness.model.mesh import ElementGroup, Mesh
from harness.model.model import Model
from harness.model.properties import UserProperty

SOURCE = Source("test.inp", 1)


def arc(count=6, radius=4.0):
    """Nodes of a part of a circle and lines between them, outward normals upward."""
    angle = np.linspace(2.4, 0.7, count + 1)
    nodes = radius * np.stack([np.cos(angle), np.sin(angle) - 1, 0 * angle], axis=1)
    return nodes, [np.stack([np.arange(1, count + 1), np.arange(count)], axis=1)]


def dome(count=3):
    """Nodes of a curved roof of quadrilaterals, two of which are cut into triangles."""
    x, y = np.meshgrid(np.arange(count + 1.0), np.arange(count + 1.0), indexing="ij")
    nodes = np.stack([x, y, 0.1 * np.sin(x) * np.cos(2 * y)], axis=-1).reshape(-1, 3)
    n = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    four = np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
    cut = four[3:5]
    return nodes, [np.delete(four, [3, 4], axis=0), np.concatenate([cut[:, :3], cut[:, [0, 2, 3]]])]


def pair_of(dimension, rng, *, stiffness=None, friction=0.0, smooth=0.2, height=0.0):
    """Five points near a curved surface, with coordinates of all nodes."""
    main, faces = arc() if dimension == 2 else dome()
    count = 5
    points = np.zeros((count, 3))
    if dimension == 2:
        angle = rng.uniform(0.9, 2.2, count)
        points[:, :2] = (4.0 + height) * np.stack([np.cos(angle), np.sin(angle)], axis=1) - [0, 4.0]
    else:
        points[:, :2] = rng.uniform(0.1, 2.9, (count, 2))
        points[:, 2] = 0.1 * np.sin(points[:, 0]) * np.cos(2 * points[:, 1]) + height
    surface = ContactProperty("P", SOURCE, stiffness=stiffness, friction=friction)
    secondary = len(main) + np.arange(count)
    pieces = make_pieces(faces, main, smooth, 0.1)
    pair = SlidingPair(
        "(A,B)", surface, SOURCE, dimension, secondary, (), pieces, rng.uniform(0.5, 1.5, count), 0.05
    )
    return pair, np.concatenate([main, points])


def block_of(pair, coordinates):
    n, d, m = len(coordinates), pair.dimension, len(pair.secondary)
    mesh = Mesh(np.arange(1, n + 1), coordinates, ("",) * n)
    group = ElementGroup("U1", np.array([1]), np.array([[0, 1]]), "", UserProperty("ALL", SOURCE), None, SOURCE)
    block = ContactBlock(Model(Path("test.inp"), "", mesh, (group,), ()), pair)
    size = n * d + m * block.direct
    block.number(lambda nodes, dof: nodes * d + dof - 1, n * d + np.arange(m, dtype=np.int32))
    block.bind(size * np.arange(size + 1, dtype=np.int32), np.tile(np.arange(size, dtype=np.int32), size))
    return block, size


def evaluated(block, call, u, du, *, matrix):
    residual, data = np.zeros(len(u)), np.zeros(len(u) ** 2)
    data[:: len(u) + 1] = 7.0
    if not block.track(call, u, du, matrix=matrix):
        block.bind(*block._pattern)
    block.evaluate(call, u, du, residual, data if matrix else None)
    data[:: len(u) + 1] -= 7.0
    return residual, data.reshape(len(u), len(u))


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("stiffness", [None, 40.0])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("moved", [0.003, 0.1])
def test_matrix_by_differences(call, dimension, stiffness, friction, moved):
    """Points that stick (moved little) and slip (moved far), after an increment that left an elastic slip."""
    rng = np.random.default_rng(5)
    for _ in range(2):
        block, size = block_of(*pair_of(dimension, rng, stiffness=stiffness, friction=friction, height=-0.2))
        first, second = (replace(call, iteration=k, flags=Flags(1, True)) for k in range(2))
        start = 0.01 * rng.normal(size=size)
        if block.direct:
            start[-5:] = rng.uniform(0.5, 1.0, 5)
        evaluated(block, first, np.zeros(size), np.zeros(size), matrix=True)
        evaluated(block, second, start, start, matrix=True)
        block.commit()
        du = moved * rng.normal(size=size)
        u = start + du
        evaluated(block, first, start, np.zeros(size), matrix=True)
        _, found = evaluated(block, second, u, du, matrix=True)
        assert (block.output[1] > 0.0).any()

        def forces(x, block=block, start=start, second=second):
            return evaluated(block, second.asking(Request.RESIDUAL), x, x - start, matrix=False)[0]

        step = 1e-6
        wanted = np.stack([-(forces(u + step * e) - forces(u - step * e)) / (2 * step) for e in np.eye(size)], axis=1)
        np.testing.assert_allclose(found, wanted, atol=1e-6 * max(1.0, np.abs(wanted).max()))
        if not friction and dimension == 3:
            np.testing.assert_allclose(found, found.T, atol=1e-12 * np.abs(found).max())


def rotation_of(angle, dimension):
    """About the axis of the plane, or (1, 2, 2) / 3, by the formula of Rodrigues."""
    if dimension == 2:
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize(("dimension", "smooth"), [(2, 0.2), (2, 0.0), (3, 0.0)])
def test_bodies_that_turn(call, dimension, smooth, friction):
    """Both surfaces turn together, by any angle: clearances stay, forces turn, and so do elastic slips."""
    rng = np.random.default_rng(7)
    pair, coordinates = pair_of(dimension, rng, stiffness=40.0, friction=friction, height=-0.1, smooth=smooth)
    block, size = block_of(pair, coordinates)
    places, d = coordinates[:, :dimension], dimension
    first, second = (replace(call, iteration=k, flags=Flags(1, True)) for k in range(2))
    slid = np.zeros_like(places)
    slid[pair.secondary] = 0.02 * rng.normal(size=(5, d))
    evaluated(block, first, np.zeros(size), np.zeros(size), matrix=False)
    before = evaluated(block, second, slid.ravel(), slid.ravel(), matrix=False)[0].reshape(-1, d)
    clearances = block.output[0]
    block.commit()
    assert np.abs(before).max() > 1.0
    turn, steps, last = 0.0, 4, slid
    for _ in range(steps):
        turn += 2.5 / steps
        rotation = rotation_of(turn, d)
        now = (places + slid) @ rotation.T - places
        evaluated(block, first, last.ravel(), 0 * last.ravel(), matrix=False)
        forces = evaluated(block, second, now.ravel(), (now - last).ravel(), matrix=False)[0].reshape(-1, d)
        block.commit()
        last = now
        np.testing.assert_allclose(block.output[0], clearances, atol=1e-12)
    np.testing.assert_allclose(forces, before @ rotation.T, atol=1e-11)
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-11)
    if friction or smooth:
        # friction acts on the main surface below a penetrating node, and a force at a rounded node on the face
        return
    moments = np.einsum("np,nq->pq", places + last, forces)
    np.testing.assert_allclose(moments, moments.T, atol=1e-10)
