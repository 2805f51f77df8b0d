# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One cohesive element, driven by separations in its own axes."""

from dataclasses import replace

import numpy as np
import pytest

from uel.errors import Source
from uel.model.damage import Damage, DamageEvolution
from uel.model.mesh import ElementGroup
from uel.model.properties import CohesiveSection, Elastic, ElasticType, Material, SectionControls

SOURCE = Source("test.inp", 7)
LENGTH, WIDTH = 2.0, 5.0
STIFFNESS, ONSET = (1e4, 1e4, 1e4), (30.0, 60.0, 50.0)
BK = ("ENERGY", "LINEAR", "BK", (0.26, 1.002, 0.8), 1.8)
DEFAULTS = SectionControls()


class Layer:
    """An element turned out of the global axes, driven by separations in its own axes (n, s[, t])."""

    def __init__(self, bound, library, call, element_type, damage, *, stiffness, controls, thickness, gap, density):
        self.dimension = 2 if element_type == "COH2D4" else 3
        self.call = call
        n = self.dimension
        if n == 2:
            c, s = np.cos(0.4), np.sin(0.4)
            self.axes = np.array([[-s, c], [c, s]])
            bottom = np.array([[0.0, 0.0], LENGTH * self.axes[1]])
            top, self.area = bottom[::-1], LENGTH * WIDTH
            self.pairs = [(0, 3), (1, 2)]
        else:
            normal = np.array([0.3, -0.2, 0.9]) / np.linalg.norm([0.3, -0.2, 0.9])
            first = np.array([1.0, 0, 0]) - normal[0] * normal
            first /= np.linalg.norm(first)
            self.axes = np.array([normal, first, np.cross(normal, first)])
            # a parallelogram, so that the corners have equal areas
            corners = np.array([[0, 0, 0], [0, 2.0, 0.3], [0, 2.5, 1.8], [0, 0.5, 1.5]])
            self.area = 2.0 * 1.5 - 0.3 * 0.5
            if element_type == "COH3D6":
                corners, self.area = corners[[0, 1, 3]], 0.5 * self.area
            top = bottom = corners @ self.axes
            self.pairs = [(k, k + len(corners)) for k in range(len(corners))]
        nodes = np.concatenate([bottom, top + gap * self.axes[0]])
        coordinates = np.zeros((len(nodes), 3))
        coordinates[:, :n] = nodes
        material = Material(
            "M", SOURCE, Elastic(ElasticType.TRACTION, stiffness, SOURCE), damage=damage, density=density
        )
        section = CohesiveSection("ALL", material, thickness, WIDTH, controls, SOURCE)
        group = ElementGroup(element_type, np.array([101]), np.arange(len(nodes))[None], "", section, None, SOURCE)
        self.block, self.matrix = bound(group, coordinates, library)
        self.coordinates = coordinates[:, :n]

    def displacements(self, separations):
        """Unknowns of separations (points, n) or (n,): half of them on each face, on top of a translation."""
        u = np.tile(np.linspace(0.1, 0.3, self.dimension), (len(self.coordinates), 1))
        for (below, above), separation in zip(
            self.pairs, np.broadcast_to(separations, (len(self.pairs), self.dimension)), strict=True
        ):
            u[below] -= 0.5 * separation @ self.axes
            u[above] += 0.5 * separation @ self.axes
        return u.ravel()

    def evaluate(self, u, dtime=1.0):
        residual = np.zeros(len(u))
        self.matrix.data[:] = 0.0
        call = replace(self.call, time_increment=dtime)
        self.report = self.block.evaluate(call, u, np.zeros(len(u)), residual, self.matrix.data)
        return residual

    def move(self, separations, dtime=1.0, steps=1):
        """Go there in equal steps and stay; returns the traction (n, s[, t]) of the first point."""
        start = self.state()[:, self.dimension : 2 * self.dimension]
        for k in range(1, steps + 1):
            self.residual = self.evaluate(self.displacements(start + k / steps * (separations - start)), dtime)
            self.block.commit()
        return self.state()[0, 2 * self.dimension : 3 * self.dimension]

    def state(self):
        return self.block.state(0).svars.reshape(len(self.pairs), -1)

    def value(self, name):
        """A variable of the first point."""
        return self.state()[0, self.block.variables.names.index(name)]

    @property
    def dissipated(self):
        """Energy per area."""
        return self.report.damage / self.area


@pytest.fixture
def layer(bound, load, call):
    """Make an element; evolution: entries of DamageEvolution, None for the onset alone."""

    def layer(
        element_type="COH2D4",
        evolution=BK,
        criterion="QUADS",
        *,
        stiffness=STIFFNESS,
        controls=DEFAULTS,
        thickness=1.0,
        gap=0.0,
        viscosity=0.0,
        density=0.0,
    ):
        scale = 1.0 if criterion.endswith("S") else 1e-4
        onset = tuple(scale * value for value in ONSET)
        found = DamageEvolution(*evolution, SOURCE) if evolution else None
        damage = Damage(criterion, onset, SOURCE, found, viscosity)
        return Layer(
            bound,
            load(None),
            call,
            element_type,
            damage,
            stiffness=stiffness,
            controls=controls,
            thickness=thickness,
            gap=gap,
            density=density,
        )

    return layer
