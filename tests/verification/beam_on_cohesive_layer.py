# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two beams on a cohesive layer under cycles: an independent code to compare elements with (N, mm, MPa, width 1 mm).

Each arm is a beam with axial force, bending and shear, exact between its nodes; at the nodes the layer between the
arms carries normal and shear tractions by the laws of `cyclic_cohesive_law`. Displacements and tractions are the
unknowns. G is the work of the tractions over the separations along the layer, which is the J-integral.

A crack grows at da/dN, with a the length over which the fracture energy is spent (each node by its D). Jumps of
cycles are implicit and of first order: da/dN exceeds its limit for small `d_max` by 0.6 % at 0.01, 1.2 % at 0.02 and
3 % at 0.05.

Elements in 2D and 3D differ from this model by

- the strain of the arms across the layer and the warping of their sections, which a beam has not. `Arm` adds the
  compliance of its loaded face from plane elasticity, exact for long waves and at one wave as long as the front's
  tractions; another wave, 2 to 8 over the height, moves da/dN by less than 4 % in mode I and 2 % in mode II. Without
  the faces (`faces=False`) da/dN is 25 % larger in mode I and 19 % in mode II: s enters with the power b;
- the motion of a face along the layer by its normal traction, and across by its shear traction. For equal arms it
  moves both faces alike;
- Poisson's contraction along the width: `Arm` in plane strain has E1/(1 - nu13 nu31) for E1, and so on.

G depends on the forces alone, and both models have the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from cyclic_cohesive_law import NORMAL, SHEAR, Law, Reals, Response
from numpy.typing import NDArray
from scipy.linalg import solve_banded

# degrees of freedom of a node: displacements along and across the beam, rotation, of the lower and the upper arm
U_LOWER, W_LOWER, TURN_LOWER, U_UPPER, W_UPPER, TURN_UPPER = range(6)
# those of the faces come next: opening and sliding by the strains of the arms
FACES = 6
# shear strain of a section of a rectangle over its mean
SHEAR_FACTOR = 6.0 / 5.0
# a solution that exists is reached in fewer iterations; without one Newton's method cycles
ITERATIONS = 25
# a crack that has not grown after so many cycles is arrested
ENDLESS = 1e12
# of the strength: the tractions of a converged increment have eight digits
TOLERANCE = 1e-8


class NoEquilibriumError(Exception):
    """The load exceeds what the layer carries."""


@dataclass(frozen=True, slots=True)
class Arm:
    """Orthotropic arm of one height (mm), width 1 mm."""

    height: float = 1.55
    e1: float = 120_000.0
    e2: float = 10_500.0
    g12: float = 5_300.0
    nu12: float = 0.3

    @property
    def bending(self) -> float:
        """EI (N mm^2)."""
        return self.e1 * self.height**3 / 12.0

    def stiffness(self, length: float) -> Reals:
        """Matrix (6, 6) of an element, exact for a beam that carries loads at its nodes alone."""
        axial = self.e1 * self.height / length
        shear = 12.0 * self.bending * SHEAR_FACTOR * self.slip / (self.height * length**2)
        c = self.bending / (length**3 * (1.0 + shear))
        near, far = (4.0 + shear) * length**2, (2.0 - shear) * length**2
        matrix = np.zeros((6, 6))
        matrix[np.ix_([0, 3], [0, 3])] = axial * np.array([[1.0, -1.0], [-1.0, 1.0]])
        matrix[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = c * np.array(
            [
                [12.0, 6.0 * length, -12.0, 6.0 * length],
                [6.0 * length, near, -6.0 * length, far],
                [-12.0, -6.0 * length, 12.0, -6.0 * length],
                [6.0 * length, far, -6.0 * length, near],
            ]
        )
        return matrix

    @property
    def slip(self) -> float:
        """Compliance 1/G12 - 2 nu12/E1 in shear of a beam under tractions along its length (1/MPa)."""
        return 1.0 / self.g12 - 2.0 * self.nu12 / self.e1

    @property
    def face_compliances(self) -> Reals:
        """Motion of a face beside that of the beam, per traction that is constant along x (normal, shear; mm^3/N).

        The third term of the expansion of `face_motions` for long waves, after those of bending and of shear.
        """
        normal = 13.0 / (35.0 * self.e2) - self.e1 * self.slip**2 / 700.0
        return self.height * np.array([normal, 2.0 / 15.0 * self.slip])

    @property
    def face_lengths(self) -> Reals:
        """Lengths over which a face follows its tractions (normal, shear; mm).

        Chosen so that the compliance of a beam with c/(1 + (k length)^2) is exact at k h = 4: the fronts' tractions
        vary over about the height.
        """
        k = 4.0 / self.height
        beam = [12.0 / (self.e1 * self.height**3 * k**4) + SHEAR_FACTOR * self.slip / (self.height * k**2)]
        beam += [4.0 / (self.e1 * self.height * k**2)]
        return np.asarray(np.sqrt(self.face_compliances / (self.face_motions(k) - beam) - 1.0) / k)

    def face_motions(self, k: float) -> Reals:
        """Amplitudes of the loaded face of a strip in plane stress, by elasticity (normal, shear; mm^3/N).

        Under a normal traction cos(k x) the face moves by that of the first times cos(k x), under a shear traction
        sin(k x) by the second times sin(k x). Airy's function is f(y) cos(k x) with f of four exponentials (S. G.
        Lekhnitskii, Anisotropic Plates, 1968).
        """
        a11, a12, a22, a66 = 1.0 / self.e1, -self.nu12 / self.e1, 1.0 / self.e2, 1.0 / self.g12
        middle = 2.0 * a12 + a66
        roots = np.sqrt((middle + np.array([1.0, -1.0]) * np.sqrt(middle**2 - 4.0 * a11 * a22)) / (2.0 * a11))
        rates = k * np.concatenate([roots, -roots])
        # each exponential is 1 at the face where it is largest
        near = np.exp(-np.maximum(rates, 0.0) * self.height)
        far = np.exp(np.minimum(rates, 0.0) * self.height)
        boundary = np.array([-(k**2) * near, k * rates * near, -(k**2) * far, k * rates * far])
        normal, shear = np.linalg.solve(boundary, np.eye(4)[:, :2]).T * near
        across = -np.sum(normal * (a12 * rates - a22 * k**2 / rates))
        along = np.sum(shear * (a11 * rates**2 - a12 * k**2)) / k
        return np.abs([across, along])


Place = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Specimen:
    """Two arms on a layer: `laws` act side by side, the layer is cracked where x < `crack`.

    `forces` and `prescribed` give the value at (node, degree of freedom) for a load factor of 1.
    """

    x: Reals
    arms: tuple[Arm, Arm]
    laws: Sequence[Law]
    crack: float
    prescribed: dict[Place, float]
    forces: dict[Place, float]
    faces: bool = True


class State(NamedTuple):
    """Displacements (n, 8), tractions (laws, n, 2), history and damage (laws, n), largest growth of damage."""

    u: Reals
    tractions: Reals
    history: Reals
    damage: Reals
    growth: float


class Layer:
    """The equations of a specimen in a banded matrix.

    A node has the displacements of the arms, the relative motion of the faces beside that of the beams (normal,
    shear), and the tractions of each law.
    """

    def __init__(self, specimen: Specimen) -> None:
        self.specimen = specimen
        x = specimen.x
        lower, upper = specimen.arms
        self.jump = np.zeros((2, FACES + 2))
        self.jump[NORMAL, [W_LOWER, W_UPPER, FACES]] = -1.0, 1.0, -1.0
        self.jump[SHEAR, [U_LOWER, U_UPPER, FACES + 1]] = -1.0, 1.0, -1.0
        self.jump[SHEAR, [TURN_LOWER, TURN_UPPER]] = 0.5 * lower.height, 0.5 * upper.height
        self.areas = np.zeros(len(x))
        self.areas[:-1] += 0.5 * np.diff(x)
        self.areas[1:] += 0.5 * np.diff(x)
        self.betas = np.array([[law.beta, law.beta * law.ratio] for law in specimen.laws])
        self.dofs = FACES + 2
        self.size = self.dofs + 2 * len(specimen.laws)
        # an element couples the first unknown of a node with the last displacement of the next
        self.band = self.size + self.dofs - 1
        self.first = self.size * np.arange(len(x))
        self.matrix = self._constant_part()

    def _constant_part(self) -> Reals:
        """Equilibrium of arms and faces; the rows of prescribed displacements are those of the unit matrix."""
        x, size, band = self.specimen.x, self.size, self.band
        matrix = np.zeros((2 * band + 1, size * len(x)))

        def add(unknowns: NDArray[np.int_], stiffness: Reals) -> None:
            rows, columns = np.meshgrid(unknowns, unknowns, indexing="ij")
            matrix[band + rows - columns, columns] += stiffness

        compliances = np.sum([arm.face_compliances for arm in self.specimen.arms], axis=0)
        lengths = np.mean([arm.face_lengths for arm in self.specimen.arms], axis=0)
        for node, length in enumerate(np.diff(x)):
            ends = size * np.array([node, node + 1])
            for k, arm in enumerate(self.specimen.arms):
                add(
                    np.concatenate([ends[0] + 3 * k + np.arange(3), ends[1] + 3 * k + np.arange(3)]),
                    arm.stiffness(length),
                )
            for k in (NORMAL, SHEAR):
                gradient = lengths[k] ** 2 / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
                add(ends + FACES + k, (0.5 * length * np.eye(2) + gradient) / compliances[k])
        for k, row in np.ndindex(len(self.specimen.laws), 2):
            for dof in range(self.dofs):
                column = self.dofs + 2 * k + row
                matrix[band + dof - column, self.first + column] = self.areas * self.jump[row, dof]
        fixed = [size * node + dof for node, dof in self.specimen.prescribed]
        if not self.specimen.faces:
            fixed += [int(row) for k in (NORMAL, SHEAR) for row in self.first + FACES + k]
        for row in fixed:
            columns = np.arange(max(0, row - band), min(matrix.shape[1], row + band + 1))
            matrix[band + row - columns, columns] = 0.0
            matrix[band, row] = 1.0
        return matrix

    def start(self) -> State:
        """State without load."""
        n, laws = len(self.specimen.x), len(self.specimen.laws)
        history = np.tile((self.specimen.x < self.specimen.crack).astype(float), (laws, 1))
        return State(np.zeros((n, self.dofs)), np.zeros((laws, n, 2)), history, history, 0.0)

    def solve(self, state: State, factor: float, cycles: float) -> State:
        """Equilibrium at a load factor after more cycles, by Newton's method. NoEquilibriumError if there is none."""
        specimen, dofs = self.specimen, self.dofs
        n = len(specimen.x)
        right = np.zeros((n, self.size))
        for (node, dof), value in (specimen.forces | specimen.prescribed).items():
            right[node, dof] = factor * value
        strength = max(max(law.strengths) for law in specimen.laws)
        trial = state
        for _ in range(ITERATIONS):
            p = trial.tractions + self.betas[:, None, :] * (trial.u @ self.jump.T)
            answers = [
                law.respond(own, history, cycles)
                for law, own, history in zip(specimen.laws, p, state.history, strict=True)
            ]
            tractions, history, damage = (
                np.array([getattr(answer, name) for answer in answers]) for name in ("tractions", "history", "damage")
            )
            growth = max(float(answer.growth.max()) for answer in answers)
            if trial is not state and np.abs(tractions - trial.tractions).max() < TOLERANCE * strength:
                return State(trial.u, trial.tractions, history, damage, growth)
            matrix = self.matrix.copy()
            for k, answer in enumerate(answers):
                first = dofs + 2 * k
                right[:, first : first + 2] = self._law_rows(matrix, k, answer, p[k])
            bands = (self.band, self.band)
            new = solve_banded(bands, matrix, right.ravel(), overwrite_ab=True, check_finite=False).reshape(n, -1)
            tractions = np.moveaxis(new[:, dofs:].reshape(n, -1, 2), 1, 0)
            trial = State(new[:, :dofs], tractions, history, damage, growth)
        raise NoEquilibriumError(f"no equilibrium at load factor {factor:g}")

    def _law_rows(self, matrix: Reals, k: int, answer: Response, p: Reals) -> Reals:
        """Write the linearised rows T(p) - t = 0 of law k over beta; returns their right side."""
        scale = 1.0 / self.betas[k, NORMAL]
        for c in (NORMAL, SHEAR):
            row = self.dofs + 2 * k + c
            by_jump = scale * answer.jacobian[:, c, :] * self.betas[k]
            for dof in range(self.dofs):
                matrix[self.band + row - dof, self.first + dof] = by_jump @ self.jump[:, dof]
            for d in (NORMAL, SHEAR):
                column = self.dofs + 2 * k + d
                matrix[self.band + row - column, self.first + column] = scale * (answer.jacobian[:, c, d] - (c == d))
        return np.asarray(scale * (np.einsum("ncd,nd->nc", answer.jacobian, p) - answer.tractions))


class Run(NamedTuple):
    """Records of a run: cycles, equivalent length of the crack (mm), G in modes I and II (N/mm), and its end.

    `failed` is True if the run ends because the structure does not carry the load any more.
    """

    cycles: Reals
    crack: Reals
    release: Reals
    state: State
    failed: bool

    @property
    def total(self) -> Reals:
        """Energy release rate of both modes (N/mm)."""
        return np.asarray(self.release.sum(axis=1))

    def rate(self, start: float, end: float) -> float:
        """Mean da/dN (mm/cycle) between two lengths of the crack. ValueError if it did not grow over both."""
        if not self.crack[0] <= start < end <= self.crack[-1]:
            raise ValueError(f"the crack grew from {self.crack[0]:.3f} to {self.crack[-1]:.3f} mm")
        cycles = np.interp([start, end], self.crack, self.cycles)
        return float((end - start) / (cycles[1] - cycles[0]))


def crack_length(layer: Layer, state: State, law: int = 0) -> float:
    """Length of the layer that is cracked, each node by the share of the fracture energy that it has dissipated."""
    return float(layer.specimen.x[0] + layer.areas @ state.damage[law])


def release_rates(layer: Layer, state: State) -> Reals:
    """G in modes I and II (N/mm): work of the tractions over the separations from the intact layer to the crack."""
    jumps = state.u[:, :FACES] @ layer.jump[:, :FACES].T
    tractions = state.tractions.sum(axis=0)
    return np.asarray(-0.5 * ((tractions[1:] + tractions[:-1]) * np.diff(jumps, axis=0)).sum(axis=0))


def load(layer: Layer, increments: int = 10) -> State:
    """Apply the load once, in equal increments that are halved where Newton's method fails."""
    state, factor, step = layer.start(), 0.0, 1.0 / increments
    while factor < 1.0:
        end = min(1.0, factor + step)
        try:
            state = layer.solve(state, end, 0.0)
        except NoEquilibriumError:
            step *= 0.5
            if step < 1e-5:
                raise
            continue
        factor, step = end, min(1.0 / increments, 2.0 * step)
    return state


def cycle(layer: Layer, state: State, growth: float, d_max: float = 0.05, cycles: float = ENDLESS) -> Run:
    """Apply cycles until the crack has grown by `growth` (mm), the structure fails, or after `cycles`.

    No jump changes D by more than `d_max`.
    """
    n, jump = 0.0, 1e-3
    start = crack_length(layer, state)
    records = [(n, start, *release_rates(layer, state))]
    failed = False
    while records[-1][1] < start + growth and n < cycles:
        jump = min(jump, cycles - n)
        try:
            trial = layer.solve(state, 1.0, jump)
        except NoEquilibriumError:
            jump *= 0.25
            if jump < 1e-9 * (1.0 + n):
                failed = True
                break
            continue
        ratio = trial.growth / d_max
        if ratio <= 1.0:
            n, state = n + jump, trial
            records.append((n, crack_length(layer, state), *release_rates(layer, state)))
        jump *= min(2.0, max(0.2, 0.9 / max(ratio, 1e-9)))
    table = np.array(records)
    return Run(table[:, 0], table[:, 1], table[:, 2:], state, failed)


def reaction(layer: Layer, state: State, place: Place) -> float:
    """Force of the surroundings on a displacement of an arm's first node (N/mm)."""
    node, dof = place
    if node != 0:
        raise ValueError("only the first node has a reaction")
    arm, first = layer.specimen.arms[dof // 3], dof // 3 * 3
    ends = state.u[:2, first : first + 3].ravel()
    stiffness = arm.stiffness(float(layer.specimen.x[1] - layer.specimen.x[0]))
    layer_force = layer.areas[0] * (state.tractions.sum(axis=0)[0] @ layer.jump[:, dof])
    return float(stiffness[dof - first] @ ends + layer_force)
