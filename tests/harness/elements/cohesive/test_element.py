# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Cohesive elements: frame and forces, unloading, compression, deletion, what is wrong with them."""

from dataclasses import replace

import numpy as np
import pytest

from uel.errors import KernelError
from uel.model.element_types import COHESIVE
from uel.model.properties import SectionControls

TYPES = ("COH2D4", "COH3D6", "COH3D8")
EXPONENTIAL = ("ENERGY", "EXPONENTIAL", "BK", (0.26, 1.002, 0.8), 1.8)


@pytest.mark.parametrize("element_type", TYPES)
def test_rigid_motion(layer, element_type):
    """Neither a translation nor an infinitesimal rotation strains the element."""
    item = layer(element_type)
    turn = np.random.default_rng(3).normal(size=(item.dimension,) * 2)
    u = item.coordinates @ (turn - turn.T) + 0.3
    assert abs(item.evaluate(u.ravel())).max() < 1e-11
    rank = item.dimension * len(item.pairs)
    assert np.linalg.matrix_rank(item.matrix.toarray(), tol=1.0) == rank


@pytest.mark.parametrize("element_type", TYPES)
def test_forces_and_axes(layer, element_type):
    """Before the onset: traction E separation/thickness, nodal forces of equal shares, energy T.g/2."""
    stiffness = (1e4, 2e4, 3e4)
    item = layer(element_type, stiffness=stiffness, thickness=0.5)
    n = item.dimension
    separation = np.array([1e-4, -2e-4, 1.5e-4])[:n]
    traction = item.move(separation)
    np.testing.assert_allclose(traction, np.array(stiffness)[:n] * separation / 0.5, rtol=1e-11)
    forces = item.residual.reshape(-1, n)
    for below, above in item.pairs:
        np.testing.assert_allclose(forces[below], traction @ item.axes * item.area / len(item.pairs), rtol=1e-11)
        np.testing.assert_allclose(forces[above], -forces[below], rtol=1e-14)
    assert item.report.energy[1] == pytest.approx(0.5 * traction @ separation * item.area, rel=1e-11)
    names = ("E22", "E12") if n == 2 else ("E33", "E13", "E23")
    np.testing.assert_allclose([item.value(name) for name in names], separation / 0.5, rtol=1e-11)


@pytest.mark.parametrize("element_type", TYPES)
def test_unloading(layer, element_type):
    """On the secant to the origin and back again, without healing and without dissipation."""
    item = layer(element_type)
    n = item.dimension
    far = np.array([0.006, 0.004, -0.003])[:n]
    traction = item.move(far, steps=50)
    damage, spent = item.value("DAMAGE"), item.dissipated
    assert 0 < damage < 1
    for share in (0.5, 0.0, 0.7, 1.0):
        np.testing.assert_allclose(item.move(share * far, steps=7), share * traction, rtol=1e-12, atol=1e-12)
        # the mode mix is that of another separation of the same direction: they differ by rounding
        assert item.value("DAMAGE") == pytest.approx(damage, rel=1e-12)
        assert item.dissipated == pytest.approx(spent, rel=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_compression(layer, element_type):
    """Compression neither causes damage nor feels it; the shear of a damaged point stays damaged."""
    item = layer(element_type, controls=SectionControls(deletion=False))
    n = item.dimension
    item.move(np.array([-0.1, 0, 0])[:n])
    assert item.value("DAMAGE") == 0
    item.move(np.array([0.1, 0, 0])[:n])
    assert item.value("DAMAGE") == 1
    traction = item.move(np.array([-0.01, 0.02, 0.0])[:n])
    np.testing.assert_allclose(traction, [-100, 0, 0][:n], atol=1e-10)
    assert item.value("STATUS") == 1


@pytest.mark.parametrize("element_type", TYPES)
def test_deletion(layer, element_type):
    """An element goes once all its points have failed with none in compression, and takes what it stored with it."""
    item = layer(element_type, EXPONENTIAL, controls=SectionControls(degradation=0.9))
    n, points = item.dimension, len(item.pairs)
    far, near = np.array([0.02, 0, 0])[:n], np.array([0.001, 0, 0])[:n]
    # one point is still whole, then one is in compression
    item.move(np.array([far] * (points - 1) + [near]))
    assert (item.value("DAMAGE"), item.value("STATUS")) == (0.9, 1)
    item.move(np.array([-near] + [far] * (points - 1)))
    assert set(item.state()[:, 3 * n]) == {0.9}
    assert item.value("STATUS") == 1
    item.move(far)
    assert item.value("STATUS") == 0
    assert item.value("TN") == pytest.approx(0.1 * 1e4 * 0.02)
    stored, spent = item.report.energy[1], item.report.damage
    assert stored > 0
    assert item.move(-near).tolist() == [0.0] * n
    assert not item.matrix.data.any() and not item.residual.any()
    assert (item.report.energy[1], item.report.damage) == (0, pytest.approx(stored + spent))
    assert (item.value("SEPN"), item.value("STATUS")) == (pytest.approx(-0.001), 0)


def test_thickness_of_the_nodes(layer):
    item = layer(thickness=0.0, gap=0.25)
    np.testing.assert_allclose(item.move(np.array([1e-4, 2e-4])), [4, 8], rtol=1e-10)
    flat = layer(thickness=0.0)
    with pytest.raises(
        KernelError, match=r"element 101 \(type COH2D4\): .*THICKNESS=GEOMETRY: the thickness .* 0.00E\+00 at"
    ):
        flat.move(np.array([1e-4, 0.0]))


@pytest.mark.parametrize("element_type", TYPES)
def test_no_area(layer, bound, load, element_type):
    item = layer(element_type)
    group = item.block.group
    flat = np.zeros((len(item.coordinates), 3))
    block, matrix = bound(group, flat, load(None))
    u = np.zeros(flat.shape[0] * item.dimension)
    with pytest.raises(
        KernelError, match=rf"element 101 \(type {element_type}\): .*area of the mid-surface is +0.00E\+00"
    ):
        block.evaluate(item.call, u, u, u.copy(), matrix.data)


def test_names_in_the_output(layer):
    variables = layer("COH3D8").block.variables
    assert dict(variables.aliases) == {
        "S33": "TN",
        "S13": "TS",
        "S23": "TT",
        "SDEG": "DAMAGE",
        "DMICRT": "QUADSCRT",
    }
    assert (variables.bottom, variables.top) == ((0, 1, 2, 3), (4, 5, 6, 7))
    assert (layer().block.variables.bottom, layer().block.variables.top) == ((0, 1), (3, 2))


def test_faces_that_the_host_does_not_know(layer, monkeypatch):
    kind = COHESIVE["COH2D4"]
    monkeypatch.setitem(COHESIVE, "COH2D4", replace(kind, face=replace(kind.face, number=99)))
    with pytest.raises(
        KernelError, match=r"101 \(type COH2D4\): .*between faces of this family are not known to the host"
    ):
        layer().move(np.array([1e-4, 0.0]))
