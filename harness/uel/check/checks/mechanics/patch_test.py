# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Patch test: linear fields cause no force at an interior node of the mesh.

Without such a node in the deck, the nodal forces of a single element have to be those of a uniform stress or flux by
the shape functions of its cell.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from uel.check.cells import gradient_integrals
from uel.check.element_calls import ElementState
from uel.check.finding import Finding, Verdict, failed, not_applicable, passed
from uel.check.rigid_motions import INERTIA, ROTATIONS, Body, body_of, makes_inertia
from uel.check.subject import Patch, Subject, diagonal
from uel.check.tie_breaking import exceeds
from uel.model.arrays import FloatArray

TOLERANCE: Final = 1e-8
"""Tolerance relative to the forces that the single elements exert there."""

RESISTED: Final = 1e-9
"""Smallest stiffness relative to the largest: a gradient with less is not resisted, as along an interface."""

SILENT: Final = 1e-9
"""Smallest force of a uniform field relative to those of a gradient: less counts as zero."""

GENTLE: Final = 1e-3
"""Gradient relative to the size of a scalar field in the run: its terms of third order are below the tolerance."""

NO_FIELD: Final = (
    "no displacements or other fields at the nodes of an element with a volume, or fields of which a uniform value has "
    "forces of its own"
)

ADVICE: Final = (
    "An element that does not pass does not converge to the solution. Check the Jacobian (the elements are distorted) "
    "and its transpose in each derivative, the strain-displacement matrix, the weights and positions of the "
    "integration points, the volume of each, and, with incompatible modes, their correction."
)


@dataclass(frozen=True, slots=True)
class _Field:
    """Linear field: name, values (n,) and checked unknowns (n,); within: it is applied within an increment."""

    name: str
    values: FloatArray
    rows: np.ndarray
    within: bool

    def forces(self, state: ElementState) -> FloatArray:
        """Return RHS (n,) of the field, from rest."""
        still = state.still().quiet()
        if self.within:
            change: FloatArray = still.moved(self.values).evaluate().rhs[0] - still.evaluate().rhs[0]
        else:
            there, back = (still.carried(sign * self.values).evaluate().rhs[0] for sign in (1.0, -1.0))
            # without the terms of second order, such as a source that the field has
            change = (there - back) / 2.0
        return change


def check(subject: Subject) -> Finding:
    """Apply each gradient from rest, scaled to those of the run, at nodes of the deck, else to single elements."""
    states = [state for patch in subject.patches for state in patch.states] or list(subject.states)
    if any(state.call.predefined is not None for state in states):
        return not_applicable("predefined fields, which cause forces of their own: take a deck without them")
    bodies = [(state, body_of(subject, state)) for state in states]
    if any(body is not None and makes_inertia(state, body) for state, body in bodies):
        return not_applicable(INERTIA)
    return _at_nodes(subject) if subject.patches else _single_elements(subject)


def _at_nodes(subject: Subject) -> Finding:
    """Check the balance of forces at nodes of the deck that are surrounded by elements of the type."""
    figure, message, names = 0.0, "", list[str]()
    for patch in subject.patches:
        # of one size in all elements
        sized = _size(subject, patch.states[0])
        for fields in zip(*(_fields(subject, state, sized) for state in patch.states), strict=False):
            ratio = _unbalanced(subject, patch, fields)
            names.append(fields[0].name)
            if exceeds(ratio, figure):
                figure = ratio
                node = subject.recording.model.mesh.name(patch.node)
                message = (
                    f"node {node}, {patch.states[0].origin}: the forces of its {len(fields)} elements do not balance "
                    f"for {fields[0].name} times a constant: {100 * ratio:.3g} % is left"
                )
    if not names:
        return not_applicable(NO_FIELD)
    if figure <= TOLERANCE:
        return passed(f"forces balance at {len(subject.patches)} nodes, to {figure:.1e}", figure, TOLERANCE)
    if _single_elements(subject).verdict is Verdict.PASSED and all(
        _scaled(subject, patch) for patch in subject.patches
    ):
        return passed(
            "forces of single elements are those of a uniform stress or flux, which differs from element to element by "
            "a factor: they do not balance",
        )
    return failed(message, ADVICE, figure=figure, limit=TOLERANCE)


def _unbalanced(subject: Subject, patch: Patch, fields: tuple[_Field, ...]) -> float:
    """Return the unbalanced force at a node over the largest force of one of its elements."""
    sums: dict[int, float] = {}
    largest = 0.0
    for state, field in zip(patch.states, fields, strict=True):
        at_node = field.rows & (state.single.block.group.nodes[0][subject.local_nodes] == patch.node)
        forces = field.forces(state)
        for row in np.flatnonzero(at_node).tolist():
            dof = int(subject.dofs[row])
            sums[dof] = sums.get(dof, 0.0) + float(forces[row])
            largest = max(largest, abs(float(forces[row])))
    return max(map(abs, sums.values()), default=0.0) / (largest or 1.0)


def _single_elements(subject: Subject) -> Finding:
    """Check the nodal forces of single elements against those of a uniform stress or flux in their cell."""
    figure, message, judged = 0.0, "", 0
    for state in {state.single.name: state for state in reversed(subject.states)}.values():
        fields = list(_fields(subject, state, _size(subject, state)))
        if not _resisted(subject, state, fields):
            continue
        for field in fields:
            ratio = _deviation(subject, state, field)
            if ratio is None:
                continue
            judged += 1
            if exceeds(ratio, figure):
                figure = ratio
                message = (
                    f"element {state.single.name}: the forces of {field.name} times a constant are not those of a "
                    f"uniform {'stress' if field.within else 'flux'} in its volume: {100 * ratio:.3g} % is left"
                )
    if not judged:
        return not_applicable(
            "no node is surrounded by elements of the type, and these are no triangles, quads, tetrahedra or bricks "
            "with a volume: take a deck with, for example, a patch of four quads"
        )
    if figure <= TOLERANCE:
        message = f"forces of single elements are those of a uniform stress or flux, to {figure:.1e}"
        return passed(message, figure, TOLERANCE)
    return failed(message, ADVICE, figure=figure, limit=TOLERANCE)


def _scaled(subject: Subject, patch: Patch) -> bool:
    """Return whether the stresses of the elements differ by one factor for all gradients: random stiffness."""
    size = _size(subject, patch.states[0])
    stresses: list[dict[bytes, list[FloatArray]]] = []
    for state in patch.states:
        by_rows: dict[bytes, list[FloatArray]] = {}
        for field in _fields(subject, state, size):
            fit = _stress(subject, state, field)
            if fit is None:
                return False
            by_rows.setdefault(field.rows.tobytes(), []).append(fit[0])
        stresses.append(by_rows)
    for kind, first in stresses[0].items():
        reference = np.array(first).ravel()
        for other in (np.array(by_rows.get(kind, [])).ravel() for by_rows in stresses[1:]):
            if len(other) != len(reference):
                return False
            factor = float(reference @ other) / max(float(reference @ reference), 1e-300)
            if np.abs(other - factor * reference).max() > TOLERANCE * np.abs(other).max():
                return False
    return True


def _deviation(subject: Subject, state: ElementState, field: _Field) -> float | None:
    """Return the deviation of nodal forces from those of any uniform stress, over the largest; None without a cell."""
    fit = _stress(subject, state, field)
    return None if fit is None else fit[1]


def _stress(subject: Subject, state: ElementState, field: _Field) -> tuple[FloatArray, float] | None:
    """Fit a uniform stress (components) to the nodal forces; also return the remainder over the largest force."""
    local, forces = subject.local_nodes, field.forces(state)
    nodes = np.unique(local[field.rows])
    if not np.array_equal(nodes, np.arange(len(nodes))):
        return None
    integrals = gradient_integrals(subject.coordinates(state)[nodes])
    if integrals is None:
        return None
    largest, remainder, stresses = float(np.abs(forces[field.rows]).max()), 0.0, []
    for dof in np.unique(subject.dofs[field.rows]).tolist():
        nodal = np.zeros(len(nodes))
        rows = np.flatnonzero(field.rows & (subject.dofs == dof))
        nodal[local[rows]] = forces[rows]
        stress = np.linalg.lstsq(integrals, nodal, rcond=None)[0]
        stresses.append(stress)
        remainder = max(remainder, float(np.abs(nodal - integrals @ stress).max()))
    return np.concatenate(stresses), remainder / (largest or 1.0)


def _resisted(subject: Subject, state: ElementState, fields: list[_Field]) -> bool:
    """Return whether every gradient but rotations stores energy: a solid, not an interface, shell or membrane.

    The symmetric part of the energies (fields, fields) of each kind of unknown has no other zero.
    """
    if np.isin(subject.dofs, ROTATIONS).any():
        return False
    for within in (True, False):
        of_kind = [field for field in fields if field.within is within]
        for rows in {field.rows.tobytes(): field.rows for field in of_kind}.values():
            alike = [field for field in of_kind if np.array_equal(field.rows, rows)]
            values = np.array([np.where(rows, field.values, 0.0) for field in alike])
            energies = -values @ np.array([field.forces(state) for field in alike]).T
            eigenvalues = np.linalg.eigvalsh(0.5 * (energies + energies.T))
            dimensions = subject.coordinates(state).shape[1]
            free = dimensions * (dimensions - 1) // 2 if within else 0
            if eigenvalues[free] <= RESISTED * eigenvalues[-1]:
                return False
    return True


def _size(subject: Subject, state: ElementState) -> float:
    """Return the length over which a field varies by its magnitude in the run."""
    return diagonal(subject.coordinates(state))


def _fields(subject: Subject, state: ElementState, size: float) -> Iterator[_Field]:
    """Yield fields linear in space, of displacements and of other dofs whose uniform value has no forces."""
    body = body_of(subject, state)
    if body is not None and not body.coincident:
        strain = float(subject.scales[body.displacement].max()) / size
        for i, j in np.ndindex(body.dimensions, body.dimensions):
            moved = body.displacement & (body.axis == i)
            values = np.where(moved, strain * body.points[body.local, j], 0.0)
            yield _Field(f"u{i + 1} = x{j + 1}", values, body.displacement, within=True)
    for dof in np.unique(subject.dofs[_scalar(subject, state, body)]).tolist():
        yield from _scalar_fields(subject, state, dof, size)


def _scalar(subject: Subject, state: ElementState, body: Body | None) -> np.ndarray:
    """Mask the unknowns (n,) other than displacements and rotations."""
    turns = False if body is None else body.turning.any(axis=0)
    chosen: np.ndarray = (subject.dofs > subject.coordinates(state).shape[1]) & ~np.isin(subject.dofs, ROTATIONS)
    return chosen & ~turns


def _scalar_fields(subject: Subject, state: ElementState, dof: int, size: float) -> Iterator[_Field]:
    """Yield the gradients of one dof in all directions, if a uniform value has no forces and the nodes are distinct."""
    rows = subject.dofs == dof
    points = subject.coordinates(state)[subject.local_nodes]
    distinct = np.unique(points[rows].round(12), axis=0)
    if not points.shape[1] < len(distinct) == rows.sum():
        return
    amplitude = GENTLE * float(subject.scales[rows].max())
    arms = (points - points[rows].mean(axis=0)) / size
    uniform = _Field("", np.where(rows, amplitude, 0.0), rows, within=False)
    fields = [
        _Field(f"dof {dof} = x{j + 1}", np.where(rows, amplitude * arms[:, j], 0.0), rows, within=False)
        for j in range(points.shape[1])
    ]
    largest = max(float(np.abs(field.forces(state)[rows]).max()) for field in fields)
    if np.abs(uniform.forces(state)[rows]).max() <= SILENT * largest:
        yield from fields
