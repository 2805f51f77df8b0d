# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Read a deck into the model, in stages: each stage reports all its errors before the next one starts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from uel.deck.constraints.couplings import ConstraintReader
from uel.deck.constraints.equations import read_equations
from uel.deck.contact.general_contact import GeneralContact
from uel.deck.contact.interactions import Interactions
from uel.deck.contact.pairs import ContactReader, check_contact
from uel.deck.contact.profiles import reference_dofs
from uel.deck.error_report import Problems
from uel.deck.keywords import KEYWORDS
from uel.deck.language.blocks import Block
from uel.deck.language.lexer import Survey, read_blocks, survey_blocks
from uel.deck.language.repetition import check_once
from uel.deck.language.structure import Structure, read_heading
from uel.deck.materials.diffusion import with_concentrations
from uel.deck.materials.material import leave_out_unused, read_materials
from uel.deck.materials.physical_constants import read_physical_constants
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.groups import make_groups
from uel.deck.mesh.imperfection import EarlierResults, displace
from uel.deck.mesh.surfaces import Surfaces
from uel.deck.mesh.transforms import Transforms
from uel.deck.sections.controls import read_section_controls
from uel.deck.sections.user_elements import dofs_of, refuse_types
from uel.deck.steps.amplitudes import read_amplitudes
from uel.deck.steps.initial import read_initial_solutions, read_initial_stresses, read_initial_values
from uel.deck.steps.prescribed import Prescription
from uel.deck.steps.requests import RequestReader
from uel.deck.steps.restart import digest_of, find_restart, join_parts, refuse_reading
from uel.deck.steps.step import check_parts, read_steps
from uel.elements.families.beam import with_normals
from uel.errors import DeckError, Source
from uel.model.contact import ContactPair, SlidingPair
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.restart import DeckPart, RestartRead
from uel.model.steps import Boundary


def read_deck(
    path: Path,
    parameters: Mapping[str, float] | None = None,
    parts: Sequence[DeckPart] = (),
    earlier: EarlierResults | None = None,
) -> Model:
    """Read an Abaqus input deck.

    Parameters
    ----------
    path
        The deck. Included files are looked up in the current folder, as Abaqus does where the job is submitted, then
        in the folder of the deck, then in that of the including file.
    parameters
        Values of parameters in place of those in *PARAMETER.
    parts
        Decks of a restart, in order; the last one is this deck.
    earlier
        Reader of the results of earlier jobs, for FILE of *IMPERFECTION and *INITIAL CONDITIONS; None: FILE is skipped.

    Returns
    -------
    Model
        The flattened model, with warnings.

    Raises
    ------
    DeckError
        The deck is invalid, unsupported or unreadable: one line with file:line for each of the first 50 errors of a
        stage.
    UsageError
        The deck does not define one of the parameters.
    """
    problems = Problems()
    blocks = read_blocks(path, KEYWORDS, problems, parameters)
    structure, restarts = join_parts(parts, blocks, KEYWORDS, problems)
    if not parts:
        refuse_reading(structure, problems)
    leave_out_unused(structure, problems)
    if problems.has_errors:
        refuse_types(blocks, problems)
    problems.check()
    interactions = Interactions(structure.root, problems)
    root = interactions.without_options(structure.root)
    _check_repetition(root, structure, problems)
    materials = read_materials(root, structure, problems)
    in_steps = [block for scope in structure.steps for block in scope.blocks]
    amplitudes = read_amplitudes([*structure.root, *in_steps], problems)
    flat = FlatMesh(structure, problems)
    displace(structure.root, flat, problems, earlier)
    if not any(len(owner.elements) for owner in flat.owners):
        raise DeckError(Source(str(path), 1), "the deck has no elements")
    groups = make_groups(flat, materials, read_section_controls(structure.root, problems), problems)
    if not structure.steps:
        raise DeckError(Source(str(path), 1), "the deck has no *STEP")
    # ADJUST moves nodes, which the readers below use
    constraints = ConstraintReader(flat, groups, problems)
    constraints.adjust()
    contacts: tuple[ContactPair | SlidingPair, ...] = ContactReader(flat, groups, interactions, problems).read()
    contacts += GeneralContact(flat, groups, interactions, problems).read(structure.root)
    built_in = np.concatenate([np.full(len(group.labels), group.definition is None) for group in groups])
    transforms = Transforms(flat, groups, problems)
    active = _active_dofs(groups) | reference_dofs(flat)
    prescription = Prescription(flat, amplitudes, active, built_in, Surfaces(flat, groups), transforms)
    boundaries: list[Boundary] = []
    check_parts(structure.root, problems, harmonic=False)
    for block in structure.root:
        if block.name == "BOUNDARY":
            with problems.gather():
                boundaries += prescription.read_boundary(block, in_step=False)
    kinds = ("VELOCITY", "TEMPERATURE", "FIELD", "CONCENTRATION", "PRESSURE STRESS")
    velocities, temperatures, fields, concentrations, pressures = (
        tuple(read_initial_values(structure.root, kind, flat, problems, earlier)) for kind in kinds
    )
    solutions = read_initial_solutions(structure.root, flat, problems)
    stresses = read_initial_stresses(structure.root, flat, problems)
    equations = read_equations(flat, problems)
    steps = read_steps(structure.steps, prescription, RequestReader(flat, problems), problems)
    # a step with errors is missing
    steps = tuple(replace(step, restart=restarts[step.number - 1]) for step in steps)
    related = constraints.read(boundaries, steps)
    check_contact(contacts, steps, problems)
    transforms.check(equations, related, in_steps)
    problems.check()
    model = Model(
        deck=path,
        heading=read_heading(blocks),
        mesh=flat.mesh,
        groups=with_normals(groups, flat.mesh),
        steps=steps,
        nsets=flat.nsets,
        elsets=flat.elsets,
        boundaries=tuple(boundaries),
        equations=(*equations, *related, *transforms.equations()),
        contacts=contacts,
        arms=constraints.arms,
        couplings=tuple(constraints.couplings),
        initial_velocities=velocities,
        initial_temperatures=temperatures,
        initial_concentrations=concentrations,
        initial_fields=(*fields, *pressures),
        initial_solutions=tuple(solutions),
        initial_stresses=tuple(stresses),
        constants=read_physical_constants(structure.root),
        parameters=dict(parameters or {}),
        ignored=(*interactions.unused, *structure.ignored),
        warnings=problems.warnings,
        differences=problems.differences,
    )
    complete = with_concentrations(model, problems)
    problems.check()
    return complete


def _check_repetition(root: Sequence[Block], structure: Structure, problems: Problems) -> None:
    """Refuse repeated keywords in the model, its steps, or an instance; root: blocks of the model itself."""
    check_once([*root, *(block for scope in structure.steps for block in (scope.head, *scope.blocks))], problems)
    for blocks in structure.of_instances.values():
        check_once(blocks, problems)


def survey_deck(path: Path, parameters: Mapping[str, float] | None = None) -> Survey:
    """Return the files and parameters of a deck, missing include files too, without interpreting its keywords.

    Raises DeckError if the deck itself is empty or cannot be read.
    """
    return survey_blocks(path, KEYWORDS, parameters)


def survey_restart(path: Path, parameters: Mapping[str, float] | None = None) -> RestartRead | None:
    """Return the *RESTART, READ of a deck, None if it has none. Raises DeckError and UsageError as `read_deck`."""
    return find_restart(path, KEYWORDS, parameters)


def part_of(path: Path, parameters: Mapping[str, float] | None = None, steps: int = 0) -> DeckPart:
    """Return a deck as part of a restart; steps: steps taken from earlier decks. Raises DeckError."""
    return DeckPart(str(path.resolve()), digest_of(path, KEYWORDS, parameters), dict(parameters or {}), steps)


def _active_dofs(groups: tuple[ElementGroup, ...]) -> frozenset[int]:
    """Return the dofs that at least one element uses."""
    used: set[int] = set()
    for group in groups:
        used |= dofs_of(group)
    return frozenset(used)
