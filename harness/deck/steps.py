# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEP and *STATIC: the steps of a deck."""

from __future__ import annotations

import math

from harness.deck.blocks import Block, Row
from harness.deck.controls import ControlState
from harness.deck.prescribed import Prescription
from harness.deck.problems import Problems
from harness.deck.requests import RequestReader
from harness.deck.structure import Scope
from harness.model.steps import Boundary, Load, Riks, Static, Step

PROCEDURES = {"STATIC"}
SMALLEST_FRACTION = 1e-5
MOST_INCREMENTS = 100


def read_steps(
    scopes: list[Scope], prescription: Prescription, requests: RequestReader, problems: Problems
) -> tuple[Step, ...]:
    """All steps; controls, output requests, NLGEOM and UNSYMM go on from one to the next."""
    steps: list[Step] = []
    controls = ControlState()
    nlgeom = unsymmetric = False
    for number, scope in enumerate(scopes, start=1):
        for block in scope.blocks:
            if block.name == "CONTROLS":
                with problems.gather():
                    controls = controls.read(block)
        output = requests.read_step(scope.blocks)
        nlgeom = nlgeom or scope.head.options.flag("NLGEOM")
        options = scope.head.options
        unsymmetric = options.flag("UNSYMM") if options.given("UNSYMM") else unsymmetric
        name = options.text("NAME") or f"Step-{number}"
        if name in (step.name for step in steps):
            problems.add(scope.head.source, f"*STEP: the name {name} is taken by an earlier step")
        boundaries, new_boundary = _read_boundaries(scope, prescription, problems)
        loads, new_loads = _read_loads(scope, prescription, problems)
        with problems.gather():
            procedure = _read_procedure(scope, prescription)
            increments = options.integer("INC", MOST_INCREMENTS)
            if increments < 1:
                raise scope.head.error(f"INC={increments} must be positive")
            steps.append(
                Step(
                    number=number,
                    name=name,
                    procedure=procedure,
                    source=scope.head.source,
                    nlgeom=nlgeom,
                    increments=increments,
                    extrapolation=options.text("EXTRAPOLATION"),
                    unsymmetric=unsymmetric,
                    amplitude=options.text("AMPLITUDE"),
                    title=next((line for line in scope.head.lines if line), ""),
                    controls=controls.effective,
                    boundaries=tuple(boundaries),
                    new_boundary=new_boundary,
                    loads=tuple(loads),
                    new_loads=new_loads,
                    output=output,
                )
            )
    return tuple(steps)


def _read_boundaries(scope: Scope, prescription: Prescription, problems: Problems) -> tuple[list[Boundary], bool]:
    found: list[Boundary] = []
    blocks = [block for block in scope.blocks if block.name == "BOUNDARY"]
    for block in blocks:
        with problems.gather():
            found += prescription.read_boundary(block, in_step=True)
    return found, _is_new(blocks, problems)


def _read_loads(scope: Scope, prescription: Prescription, problems: Problems) -> tuple[list[Load], bool]:
    found: list[Load] = []
    blocks = [block for block in scope.blocks if block.name == "CLOAD"]
    for block in blocks:
        with problems.gather():
            found += prescription.read_loads(block)
    return found, _is_new(blocks, problems)


def _is_new(blocks: list[Block], problems: Problems) -> bool:
    """OP=NEW; a step that gives both OP=NEW and OP=MOD is refused, as Abaqus does."""
    operations = {block.options.text("OP") for block in blocks}
    if len(operations) > 1:
        other = next(block for block in blocks if block.options.text("OP") != blocks[0].options.text("OP"))
        message = f"*{other.name}: OP=NEW and OP=MOD in one step; first OP={blocks[0].options.text('OP')} at "
        problems.add(other.source, message + str(blocks[0].source))
    return operations == {"NEW"}


def _read_procedure(scope: Scope, prescription: Prescription) -> Static:
    blocks = [block for block in scope.blocks if block.name in PROCEDURES]
    if not blocks:
        raise scope.head.error("the step has no procedure such as *STATIC")
    if len(blocks) > 1:
        raise blocks[1].error(f"the step has a procedure already, at {blocks[0].source}")
    return _read_static(blocks[0], prescription)


def _read_static(block: Block, prescription: Prescription) -> Static:
    rows = list(block.all_rows())
    if len(rows) > 1:
        raise rows[1].error("a second data line, where one is read")
    along_path = block.options.flag("RIKS")
    entries = [0.0] * 4
    if rows:
        rows[0].at_most(8 if along_path else 4)
        names = ("initial increment", "period", "smallest increment", "largest increment")
        entries = [rows[0].real(index, name, 0.0) for index, name in enumerate(names)]
        if min(entries) < 0:
            raise rows[0].error("increments and period must not be negative")
    direct = block.options.flag("DIRECT")
    # zero stands for the default everywhere (Abaqus Keywords Guide, *STATIC)
    period = entries[1] or 1.0
    initial = entries[0] or period
    if initial > period:
        raise rows[0].error(f"initial increment {initial:g} exceeds the period {period:g}")
    minimum = entries[2] or min(initial, SMALLEST_FRACTION * period)
    maximum = entries[3] or (math.inf if along_path else period)
    riks = _read_riks(rows[0] if rows else None, prescription) if along_path else None
    if direct:
        return Static(initial, period, initial, initial, direct=True, riks=riks)
    if not minimum <= initial <= maximum:
        range_text = f"{minimum:g} to {maximum:g}"
        raise rows[0].error(
            f"initial increment {initial:g} is outside the smallest and largest increment, {range_text}"
        )
    return Static(initial, period, minimum, maximum, riks=riks)


def _read_riks(row: Row | None, prescription: Prescription) -> Riks:
    """Where a step with RIKS ends: entries 5 to 8 of its data line."""
    if row is None:
        return Riks()
    largest = row.real(4, "largest load proportionality factor", 0.0) or None
    if row.blank(5):
        if len(row) > 5:
            raise row.error("a dof and a displacement need a node")
        return Riks(largest)
    nodes = prescription.flat.nodes(row.name(5, "node"), row.source)
    if len(nodes) != 1:
        raise row.error(f"{row.fields[5]} has {len(nodes)} nodes, where one is monitored")
    return Riks(largest, int(nodes[0]), row.integer(6, "dof"), row.real(7, "displacement"))
