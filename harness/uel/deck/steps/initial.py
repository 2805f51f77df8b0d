# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.repetition import overlaps, repeated_value
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, one_of, refused
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.imperfection import EarlierResults, same_nodes
from uel.deck.sections.user_elements import LARGEST_DOF
from uel.errors import Source, UelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.dofs import CONCENTRATION, TEMPERATURE
from uel.model.steps import PRESSURE_STRESS, InitialSolution, InitialStress, InitialValue, VerticalStress

MOST_FIELDS = 1000

_ONE_VALUE = {"CONCENTRATION": CONCENTRATION, "PRESSURE STRESS": PRESSURE_STRESS}
"""Dof of each TYPE= with one value per node."""

MOST_COMPONENTS = 6
"""Components of a stress."""


def field_number(block: Block) -> int:
    """Read VARIABLE= of *FIELD and *INITIAL CONDITIONS, TYPE=FIELD. Raises DeckError."""
    number = block.options.integer("VARIABLE", 1)
    if not 1 <= number <= MOST_FIELDS:
        raise block.error(f"VARIABLE={number}: expected a number from 1 to {MOST_FIELDS}")
    return number


def read_initial_values(
    blocks: Iterable[Block], kind: str, flat: FlatMesh, problems: Problems, earlier: EarlierResults | None
) -> list[InitialValue]:
    """Read all *INITIAL CONDITIONS of a TYPE= with nodal values.

    The dof of a field is VARIABLE=; further temperatures of a node are dofs 12 and up. Without a reader of earlier
    results FILE is skipped.
    """
    entries: list[InitialValue] = []
    for block in blocks:
        if block.name != "INITIAL CONDITIONS" or block.options.text("TYPE") != kind:
            continue
        if block.options.flag("USER"):
            problems.add(block.source, "*INITIAL CONDITIONS: USER is for TYPE=SOLUTION and TYPE=STRESS")
        if block.options.has("UNBALANCED STRESS") or block.options.flag("GEOSTATIC"):
            problems.add(block.source, "*INITIAL CONDITIONS: GEOSTATIC and UNBALANCED STRESS are for TYPE=STRESS")
        if block.options.has("FILE"):
            with problems.gather():
                entries += _read_earlier(block, kind, flat, earlier)
            continue
        for row in block.rows():
            with problems.gather():
                everywhere = block.options.has("SECTION SPECIFICATION") and not row.fields[0]
                nodes = (
                    np.arange(len(flat.mesh.labels))
                    if everywhere
                    else flat.nodes(row.name(0, "node or node set"), row.source)
                )
                if kind == "VELOCITY":
                    dof, value = row.integer(1, "dof"), row.real(2, "velocity", 0.0)
                    if not 1 <= dof <= 6:
                        raise row.error(f"dof {dof} has no velocity (1 to 6)")
                    values = {dof: value}
                elif kind == "FIELD":
                    row.at_most(2)
                    values = {field_number(block): row.real(1, "value", 0.0)}
                elif kind in _ONE_VALUE:
                    row.at_most(2)
                    values = {_ONE_VALUE[kind]: row.real(1, "value", 0.0)}
                else:
                    row.at_most(1 + LARGEST_DOF - TEMPERATURE + 1)
                    count = max(len(row) - 1, 1)
                    values = {TEMPERATURE + k: row.real(1 + k, "temperature", 0.0) for k in range(count)}
                entries += [InitialValue(nodes, dof, value, row.source) for dof, value in values.items()]
    for dof in dict.fromkeys(entry.dof for entry in entries):
        of_dof = [(entry.nodes, f"{entry.value:g}", entry.source) for entry in entries if entry.dof == dof]
        item = f"*INITIAL CONDITIONS, TYPE={kind}: {f'dof {dof} of ' if kind == 'VELOCITY' else ''}node"
        _warn_of_changes(of_dof, item, flat.mesh.name, problems)
    return entries


def _warn_of_changes(
    entries: Sequence[tuple[IntArray, str, Source]], item: str, name: Callable[[int], str], problems: Problems
) -> None:
    """Warn of nodes or elements with another value in a later entry (indices, value, location)."""
    for first, later, index in overlaps([indices for indices, _, _ in entries]):
        (_, before, source), (_, here, at) = entries[first], entries[later]
        if here != before:
            problems.warn(at, repeated_value(f"{item} {name(index)}", here, before, source))


def _read_earlier(block: Block, kind: str, flat: FlatMesh, earlier: EarlierResults | None) -> Iterator[InitialValue]:
    """Yield the temperatures of an earlier job as initial values of temperature or of a field. Raises DeckError."""
    if kind not in ("TEMPERATURE", "FIELD"):
        raise block.error("FILE is for TYPE=TEMPERATURE and TYPE=FIELD")
    if any(block.rows()):
        raise block.error("FILE: values are those of that job; expected no data lines")
    job = block.options.text("FILE")
    if earlier is None:
        return
    try:
        step, increment = block.options.integer("STEP", 0), block.options.integer("INC", 0)
        labels, values = earlier.temperatures(job, step, increment)
    except UelError as error:
        raise block.error(f"FILE={job}: {error}") from None
    rows, earlier_rows = same_nodes(flat, labels, block, job)
    dof = field_number(block) if kind == "FIELD" else TEMPERATURE
    for value in np.unique(values[earlier_rows]).tolist():
        yield InitialValue(rows[values[earlier_rows] == value], dof, value, block.source)


def _refuse_file(block: Block) -> None:
    if block.options.has("FILE"):
        raise block.error("FILE is for TYPE=TEMPERATURE and TYPE=FIELD")


def read_initial_stresses(blocks: Iterable[Block], flat: FlatMesh, problems: Problems) -> list[InitialStress]:
    """Read the entries of all *INITIAL CONDITIONS, TYPE=STRESS: element or set and components of the stress."""
    entries: list[InitialStress] = []
    for block in blocks:
        if block.name != "INITIAL CONDITIONS" or block.options.text("TYPE") != "STRESS":
            continue
        with problems.gather():
            _refuse_file(block)
            by_user = _check_stress(block)
            # UNBALANCED STRESS=RAMP is the default (Keywords Guide, *INITIAL CONDITIONS)
            ramped = block.options.text("UNBALANCED STRESS") != "STEP"
            if entries and entries[0].ramped != ramped:
                raise block.error(
                    f"UNBALANCED STRESS must be the same in the whole model, but differs at {entries[0].source}"
                )
            if by_user:
                entries.append(InitialStress(np.arange(flat.element_count), None, ramped, block.source))
            for row in block.rows():
                row.at_most(1 + MOST_COMPONENTS)
                elements = flat.elements(row.name(0, "element or element set"), row.source)
                if block.options.flag("GEOSTATIC"):
                    profile = _read_profile(row)
                    entries.append(InitialStress(elements, np.zeros(0), ramped, row.source, profile))
                    continue
                values = np.array([row.real(k, "stress", 0.0) for k in range(1, len(row))])
                entries.append(InitialStress(elements, values, ramped, row.source))
    described = [(entry.elements, _stress_of(entry), entry.source) for entry in entries]
    _warn_of_changes(described, "*INITIAL CONDITIONS, TYPE=STRESS: element", flat.element_name, problems)
    return entries


def _stress_of(entry: InitialStress) -> str:
    """Return the stress of an entry, for messages."""
    if entry.values is None:
        return "what SIGINI says"
    return str(entry.profile) if entry.profile is not None else _listed(np.trim_zeros(entry.values, "b"))


def _listed(values: FloatArray) -> str:
    return ", ".join(f"{value:g}" for value in values.tolist()) or "0"


def _read_profile(row: Row) -> VerticalStress:
    """Read a data line with GEOSTATIC. Raises DeckError."""
    names = ("vertical stress", "elevation", "second vertical stress", "its elevation")
    first, low, second, high = (row.real(k, name) for k, name in enumerate(names, start=1))
    if low == high:
        raise row.error(f"both elevations are {low:g}, expected two")
    along = row.real(5, "coefficient of lateral stress")
    return VerticalStress((first, second), (low, high), (along, row.real(6, "second coefficient", along)))


def _check_stress(block: Block) -> bool:
    """Return whether SIGINI defines the stresses. Raises DeckError without SIGINI and data lines."""
    expected = "expected the components of the stress after each element or set"
    if block.options.flag("USER"):
        if any(True for _ in block.rows()):
            raise block.error("USER: SIGINI gives the stresses; expected no data lines")
        return True
    if not any(True for _ in block.rows()):
        raise block.error(f"TYPE=STRESS has no data lines; {expected}, or USER for SIGINI")
    return False


def read_initial_solutions(blocks: Iterable[Block], flat: FlatMesh, problems: Problems) -> list[InitialSolution]:
    """Read all *INITIAL CONDITIONS, TYPE=SOLUTION: element or set and values."""
    entries: list[InitialSolution] = []
    for block in blocks:
        if block.name != "INITIAL CONDITIONS" or block.options.text("TYPE") != "SOLUTION":
            continue
        with problems.gather():
            _refuse_file(block)
            if block.options.flag("USER"):
                entries.append(InitialSolution(None, np.zeros(0), block.source))
            else:
                entries += _read_solution(block, flat)
    described = [
        (entry.elements, _listed(entry.values), entry.source) for entry in entries if entry.elements is not None
    ]
    _warn_of_changes(described, "*INITIAL CONDITIONS, TYPE=SOLUTION: element", flat.element_name, problems)
    return entries


def _read_solution(block: Block, flat: FlatMesh) -> list[InitialSolution]:
    """Read lines of a name and up to seven values; a full line is continued by a line of up to eight values."""
    entries: list[InitialSolution] = []
    values: list[float] = []
    continued = False
    for row in block.rows():
        row.at_most(8)
        if not continued:
            elements = flat.elements(row.name(0, "element or element set"), row.source)
            values = [row.real(k, "value", 0.0) for k in range(1, len(row))]
            entries.append(InitialSolution(elements, np.array(values), row.source))
        else:
            values += row.reals("value")
            entries[-1] = replace(entries[-1], values=np.array(values))
        continued = len(row) == 8
    if not entries:
        raise block.error("needs data lines, or USER for SDVINI")
    return entries


FIELD_NUMBER = Option("VARIABLE", Kind.INTEGER, "number of the field variable (1)")

KEYWORDS = (
    Keyword(
        "INITIAL CONDITIONS",
        "Values at the start of the analysis.",
        Where.MODEL,
        (
            one_of(
                "TYPE",
                "what is given; TEMPERATURE is for dof 11 and a predefined field, CONCENTRATION (normalized) and "
                "PRESSURE STRESS are for *MASS DIFFUSION",
                ("VELOCITY", "TEMPERATURE", "FIELD", "SOLUTION", "STRESS", "CONCENTRATION", "PRESSURE STRESS"),
                required=True,
                refused=(
                    *("ACOUSTIC STATIC PRESSURE", "HARDENING", "PLASTIC STRAIN"),
                    *("PORE PRESSURE", "RATIO", "REF COORDINATE", "ROTATING VELOCITY", "SATURATION"),
                    "SPECIFIC ENERGY",
                ),
            ),
            INPUT,
            FIELD_NUMBER,
            Option("USER", doc="state variables by SDVINI, with TYPE=SOLUTION; stresses by SIGINI, with TYPE=STRESS"),
            Option("GEOSTATIC", doc="stresses by elevation, the last coordinate, with TYPE=STRESS"),
            one_of(
                "UNBALANCED STRESS",
                "unbalanced initial stresses take effect gradually over the first step (RAMP, the default) or at once",
                ("RAMP", "STEP"),
            ),
            Option(
                "FILE",
                Kind.FILE,
                "name of an earlier job, whose temperatures (dof 11) give the values, by node numbers, with "
                "TYPE=TEMPERATURE and TYPE=FIELD; it is looked up as that of *IMPERFECTION",
            ),
            Option("STEP", Kind.INTEGER, "its step (the last one)"),
            Option("INC", Kind.INTEGER, "increment of the step (the last one written)"),
            one_of(
                "SECTION SPECIFICATION",
                "one temperature in a section; that it is one of all nodes where none is named is inferred",
                ("UNIFORM",),
            ),
            *refused("REBAR", "SECTION POINTS", "INTERPOLATE", "MIDSIDE", "DRIVING ELSETS", "OUTPUT VARIABLE"),
        ),
        "node or set, dof, velocity; or node or set, temperatures of dofs 11, 12, ...; or node or set, value; "
        "or element or set, state variables; or element or set, stress components of a built-in continuum element (11, "
        "22, 33, 12, 13, 23; 11, 22, 12 in plane stress), in the directions of *ORIENTATION; with GEOSTATIC element or "
        "set, vertical stress, elevation, vertical stress, elevation, coefficients of the lateral stresses along 1 and "
        "2 (in the plane 3)",
    ),
)
