# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tangents by central differences."""

import numpy as np
import pytest


def differences(block, call, u, du, used, step=1e-3):
    """Of the forces of a block: as it should return K, for the unknowns at these positions."""
    n, found = len(u), np.zeros((len(used), len(used)))
    for k, unknown in enumerate(used):
        for sign in (1, -1):
            moved, residual = np.zeros(n), np.zeros(n)
            moved[unknown] = sign * step
            block.evaluate(call, u + moved, du + moved, residual, None)
            found[:, k] -= sign * residual[used] / (2 * step)
    return found


def check_uniform_tangent(solid, *, about):
    """Along x -> A x the differences of the forces are the tangent's and what it leaves out, forces times tr A.

    The stress is uniform; about an axis for A without A12, whose strain is not, and with A11 around the axis.
    """
    forces, _ = solid.evaluate(solid.u)
    tangent = solid.matrix.toarray()
    now, step = solid.nodes[:, : solid.dimension] + solid.u.reshape(-1, solid.dimension), 1e-6
    for a in np.eye(solid.dimension**2).reshape(-1, solid.dimension, solid.dimension):
        if about and a[0, 1]:
            continue
        trace = np.trace(a) + about * a[0, 0]
        d = (now @ a.T).ravel()
        slope = (solid.evaluate(solid.u - step * d)[0] - solid.evaluate(solid.u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, tangent @ d - forces * trace, atol=1e-6 * abs(tangent).max())


def asymmetry_along_a_path(respond, pass_time):
    """Compare tangents of a material point with central differences, on a path of six increments of half a unit of time
    that turns. Returns the largest difference of entries across the diagonal, over the largest entry."""
    step, strain, random, found = 1e-6, np.zeros(respond.n), np.random.default_rng(2), 0.0
    for k in range(6):
        pass_time(respond, 0.5 * k, 0.5 * (k + 1))
        strain = strain + 0.02 * random.normal(size=respond.n)
        _, tangent = respond(strain)
        slopes = [(respond(strain + h)[0] - respond(strain - h)[0]) / (2 * step) for h in step * np.eye(respond.n)]
        np.testing.assert_allclose(tangent, np.array(slopes).T, atol=1e-6 * abs(tangent).max())
        found = max(found, abs(tangent - tangent.T).max() / abs(tangent).max())
        respond(strain)
        respond.block.commit()
    return found


def check_energy(solid):
    """In random displacements the forces are derivatives of ENERGY(2), and the tangent theirs; returns the report."""
    random = np.random.default_rng(3)
    u = 0.06 * random.standard_normal(solid.u.size)
    forces, report = solid.evaluate(u)
    tangent, step = solid.matrix.toarray(), 1e-6
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12 * abs(tangent).max())
    for _ in range(3):
        d = random.standard_normal(u.size)
        (down, less), (up, more) = solid.evaluate(u - step * d), solid.evaluate(u + step * d)
        assert (more.energy[1] - less.energy[1]) / (2 * step) == pytest.approx(-forces @ d, rel=1e-6, abs=1e-8)
        np.testing.assert_allclose((down - up) / (2 * step), tangent @ d, atol=1e-7 * abs(tangent).max())
    return report
