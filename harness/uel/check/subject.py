# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Subject of the checks: the elements of one type, with states from the run of the deck and random ones."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from uel.check.differences import Differences, differences
from uel.check.element_calls import ElementState, state_of
from uel.check.patch import patches_of
from uel.check.recording import Pass, Recording
from uel.check.replay import Elements, Results, abaqus_order, replay
from uel.check.shuffle import TypeVerdict
from uel.check.single import Returned, first_difference
from uel.check.tie_breaking import first_largest
from uel.errors import KernelError
from uel.model.arrays import FloatArray
from uel.model.mesh import ElementGroup
from uel.model.properties import UserElement
from uel.usersub import Library

PASSES: Final = 5
"""Number of passes of the run from which states are taken, including the first and the last."""

ELEMENTS: Final = 3
"""Number of elements of a type whose states are taken."""


NOT_MOVING: Final = (
    "nothing moves within an increment: take a deck whose first increments move these elements, or run more of them "
    "(--increments)"
)

PATCHES: Final = 3
"""Number of nodes of the deck at which the patch test is made."""


YIELDING: Final = 1e-4
"""Least stiffness of a state, over that of the others."""


@dataclass(frozen=True, slots=True)
class Patch:
    """Node surrounded by elements of one type, with their states in the first pass."""

    node: int
    states: tuple[ElementState, ...]


@dataclass(frozen=True, slots=True)
class Subject:
    """User element type of a deck.

    recording   the run of the deck
    elements    of this type in the model
    states      from the run; the first ones are of the first pass, without displacements
    returned    their results in the run
    random      the same with random displacements of the magnitude of the deformations in the run
    scales      (n,) size of a displacement, rotation or temperature in this run, for each unknown
    order       outcome of random calling orders
    patches     for the patch test
    library     the user routines
    refusal     reason why no element returns from a separate call; '' if one does
    not_finite  message about the first value of SVARS, ENERGY or PNEWDT that is not finite; '' without one
    """

    type: str
    recording: Recording
    definition: UserElement
    elements: int
    states: tuple[ElementState, ...]
    returned: tuple[Returned, ...]
    random: tuple[ElementState, ...]
    scales: FloatArray
    order: TypeVerdict
    patches: tuple[Patch, ...]
    library: Library
    refusal: str
    not_finite: str
    _differences: dict[int, Differences] = field(default_factory=dict)
    _quiet: dict[int, ElementState] = field(default_factory=dict)
    _magnitudes: list[FloatArray] = field(default_factory=list)

    def differences(self, state: ElementState) -> Differences:
        """Return -dRHS/dU (n, n) by finite differences at a state or its `quiet` state, cached. Raises KernelError."""
        if id(state) not in self._differences:
            self._differences[id(state)] = differences(state, self.scales)
        return self._differences[id(state)]

    def stiffness(self, state: ElementState) -> FloatArray:
        """Return magnitudes (n, n) of the stiffness: the larger of AMATRX and the differences of RHS, as either may be
        wrong.

        Without inertia these are the differences, because AMATRX of a dynamic step includes mass. Otherwise they are at
        least a fraction of those at the other states, so that round-off does not count where an element yields. Raises
        KernelError.
        """
        quotients: FloatArray = np.abs(self.differences(state).matrix)
        if not state.inertia:
            return quotients
        others = self.largest_stiffness
        return np.asarray(np.maximum.reduce([np.abs(state.evaluate().amatrx), quotients, YIELDING * others]))

    def quiet(self, state: ElementState) -> ElementState:
        """Return one of the states without inertia, see `ElementState.quiet`; the same object each time."""
        return self._quiet.setdefault(id(state), state.quiet())

    @property
    def usual_forces(self) -> FloatArray:
        """Forces (n,): AMATRX times the displacements of the run, at its states."""
        return np.asarray(self.largest_stiffness @ self.scales)

    @property
    def largest_stiffness(self) -> FloatArray:
        """Largest magnitude (n, n) of each entry of AMATRX at the states of the run. Raises KernelError."""
        if not self._magnitudes:
            self._magnitudes.append(np.max([np.abs(state.evaluate().amatrx) for state in self.states], axis=0))
        return self._magnitudes[0]

    @property
    def carries_on(self) -> bool:
        """True if UEXTERNALDB passes data from increment to increment; after the run these are of its end."""
        if self.library.uexternaldb is None:
            return False
        pairs = zip(self.states, self.returned, strict=True)
        return any(first_difference(returned, state.evaluate()) for state, returned in pairs)

    @property
    def idle(self) -> bool:
        """True if RHS and AMATRX are zero at all states, so that forces cannot be checked."""
        for state in self.all_states:
            try:
                returned = state.evaluate()
            except KernelError:
                return False
            if returned.rhs.any() or returned.amatrx.any():
                return False
        return True

    @property
    def all_states(self) -> tuple[ElementState, ...]:
        """States from the run, then random ones."""
        return self.states + self.random

    @property
    def resting(self) -> list[ElementState]:
        """States of the first pass of the run, before anything has happened, without displacements.

        In a dynamic step without inertia.
        """
        first = self.states[0].call if self.states else None
        return [self.quiet(state) for state in self.states if state.call is first and not state.u.any()]

    @property
    def local_nodes(self) -> np.ndarray:
        """Local node (n,) of each unknown, from 0."""
        return np.array([node for node, _ in self.definition.dofs])

    @property
    def dofs(self) -> np.ndarray:
        """Dof (n,) of each unknown, as Abaqus numbers them."""
        return np.array([dof for _, dof in self.definition.dofs])

    def coordinates(self, state: ElementState) -> FloatArray:
        """Return the original coordinates (nodes, COORDINATES= of *USER ELEMENT) of an element."""
        nodes = state.single.block.group.nodes[0]
        return self.recording.model.mesh.coordinates[nodes, : self.definition.coordinates]

    @property
    def advice_is_ours(self) -> bool:
        """True if the element is one of the project's."""
        return not self.recording.user


@contextmanager
def subject_of(recording: Recording, kind: str, order: TypeVerdict, seed: int) -> Iterator[Subject]:
    """Yield a user element type of a recorded run, with loaded user routines that have just been through the run.

    States are left out at which an element cannot be called again because it needs calls of other elements.
    """
    made = [event for event in recording.events if isinstance(event, Pass) and event.normal]
    chosen = {id(made[k]) for k in np.unique(np.linspace(0, len(made) - 1, PASSES).astype(int))}
    group = next(group for group in recording.model.groups if group.type == kind)
    states: list[tuple[ElementState, Returned]] = []
    refusals: list[str] = []
    patches: tuple[Patch, ...] = ()
    not_finite = ""
    with closing(replay(recording, abaqus_order, strict=False)) as passes:
        for elements, results in passes:
            if results.made is made[0]:
                patches = _patches(recording, group, elements, made[0])
            refusals += [str(results.refusals[k]) for k in results.refusals if elements.types[k] == kind]
            not_finite = not_finite or _first_not_finite(elements, results, kind)
            if id(results.made) in chosen:
                states += _states(elements, kind, results.made, made[-1])
            if results.made is made[-1]:
                break
        errors = [_error_of(state) for state, _ in states]
        refusal = "" if not all(errors) else [*refusals, *errors, "it is not called in the run"][0]
        states = [pair for pair, error in zip(states, errors, strict=True) if not error]
        yield _subject(recording, group, states, order, seed, patches, elements.library, refusal, not_finite)


def _first_not_finite(elements: Elements, results: Results, kind: str) -> str:
    """Name the first value, returned by an element of a type in a pass, that is not finite; '' if there is none."""
    if not results.made.normal or np.isfinite(results.values).all():
        return ""
    wrong = np.flatnonzero(~np.isfinite(results.values))
    for index, position in zip(wrong, np.searchsorted(elements.starts, wrong, side="right") - 1, strict=True):
        if elements.types[position] == kind:
            entry = elements.entry(position, int(index - elements.starts[position]))
            call = results.made.call
            where = f"step {call.step}, increment {call.increment}, iteration {call.iteration}"
            return f"element {elements.names[position]}, {where}: {entry} is {results.values[index]:.6g}"
    return ""


def _patches(recording: Recording, group: ElementGroup, elements: Elements, made: Pass) -> tuple[Patch, ...]:
    """Choose some of the nodes that are surrounded by elements of the type."""
    assert group.definition is not None
    nodes = list(patches_of(recording.model, group.type, group.definition.coordinates))
    if not nodes:
        return ()
    spread = np.unique(np.linspace(0, len(nodes) - 1, PATCHES).astype(int))
    return tuple(
        Patch(node, tuple(state_of(elements.singles[k], made, elements.equations[k]) for k in positions))
        for node, positions in (nodes[k] for k in spread)
    )


def _states(elements: Elements, kind: str, made: Pass, last: Pass) -> Iterator[tuple[ElementState, Returned]]:
    """Yield states of the most deformed element of a type, of others and of a loaded one, with what they return now."""
    positions = np.flatnonzero(elements.types == kind)
    dofs = np.array([dof for _, dof in elements.singles[positions[0]].block.unknowns])
    deformation = [deformations(last.u[elements.equations[position]], dofs).max() for position in positions]
    most = positions[first_largest(np.array(deformation))]
    spread = positions[np.unique(np.linspace(0, len(positions) - 1, ELEMENTS - 1).astype(int))]
    loads = last.call.distributed
    loaded = [p for p in positions.tolist() if loads and elements.singles[p].block.first in loads.elements][:1]
    for position in dict.fromkeys([int(most), *spread.tolist(), *loaded]):
        state = state_of(elements.singles[position], made, elements.equations[position])
        with suppress(KernelError):
            yield state, state.evaluate()


def _error_of(state: ElementState) -> str:
    """Return the error with which a call ends the analysis; '' if it returns."""
    try:
        state.evaluate()
    except KernelError as error:
        return str(error)
    return ""


def diagonal(coordinates: FloatArray) -> float:
    """Return the diagonal of the box around nodes (nodes, dimensions); 1 if all coincide."""
    return float(np.linalg.norm(np.ptp(coordinates, axis=0))) or 1.0


def deformations(u: FloatArray, dofs: np.ndarray) -> FloatArray:
    """Return the variation (n,) of the displacements among the nodes, for each unknown that of its dof."""
    ranges = {dof: float(np.ptp(u[dofs == dof])) for dof in np.unique(dofs).tolist()}
    return np.array([ranges[dof] for dof in dofs.tolist()])


def _subject(
    recording: Recording,
    group: ElementGroup,
    called: list[tuple[ElementState, Returned]],
    order: TypeVerdict,
    seed: int,
    patches: tuple[Patch, ...],
    library: Library,
    refusal: str,
    not_finite: str,
) -> Subject:
    assert group.definition is not None
    definition = group.definition
    states, returned = tuple(state for state, _ in called), tuple(result for _, result in called)
    dofs = np.array([dof for _, dof in definition.dofs])
    scales = np.max([np.zeros(len(dofs)), *(deformations(state.u, dofs) for state in states)], axis=0)
    size = diagonal(recording.model.mesh.coordinates[group.nodes[0]])
    # if the run moves nothing: strains of 1e-4, or a thousandth of the unit of any other field
    scales = np.where(scales > 0.0, scales, np.where(dofs <= 3, 1e-4 * size, 1e-3))
    rng = np.random.default_rng(seed)
    random = tuple(shaken for state in states if not _error_of(shaken := _shaken(state, scales, rng)))
    return Subject(
        group.type,
        recording,
        definition,
        order.elements,
        states,
        returned,
        random,
        scales,
        order,
        patches,
        library,
        refusal,
        not_finite,
    )


def _shaken(state: ElementState, scales: FloatArray, rng: np.random.Generator) -> ElementState:
    shift = scales * rng.uniform(-0.5, 0.5, len(scales))
    return replace(state.moved(shift), origin=f"random displacements added to {state.origin}")
