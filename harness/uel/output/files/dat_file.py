# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Data file (.dat): echo of the deck, summary of the model, printed tables, warnings and errors."""

from __future__ import annotations

import math
from datetime import datetime
from itertools import islice
from pathlib import Path
from typing import Final

import numpy as np

from uel.model.model import Model
from uel.model.nodal_variables import NodalIndex
from uel.model.properties import UserElement
from uel.model.records import BucklingFactors, IncrementDone, ModesFound, StepStarted
from uel.model.steps import ElementRequest, NodeRequest
from uel.output.files.tables import (
    element_tables,
    energy_table,
    missing_variables,
    node_tables,
    not_extrapolated,
    used_nodes,
)
from uel.output.formats import TextFile, program, read_remarks, remark
from uel.output.schedule import Schedule
from uel.output.step_header import completed, procedure

_USER_ELEMENT_OUTPUT = (
    "ABAQUS DOES NOT SUPPORT ELEMENT OUTPUT FOR USER ELEMENTS. HERE FIELD OUTPUT HAS THE VARIABLES OF THE PROJECT'S "
    "OWN ELEMENTS AND THOSE THAT COMMENTS BELOW *USER ELEMENT NAME, AND *EL PRINT "
    "OF SDV HAS THE SOLUTION-DEPENDENT VARIABLES OF ANY USER ELEMENT."
)

_DECK: Final = "     INPUT FILE: "
_PARAMETERS: Final = "PARAMETERS GIVEN IN PLACE OF THE VALUES IN THE DECK: "
_HEAD_LINES: Final = 10
"""Number of lines at the top, one of them with the path of the deck."""


class DataFile:
    """Writer of NAME.dat; `warnings` are those in it."""

    def __init__(self, path: Path, model: Model) -> None:
        self._model = model
        self._file = TextFile(path)
        self.warnings = [*model.warnings, *model.differences]
        self._index: NodalIndex | None = None
        # step whose requests were compared with the available variables; the last increment of a step may come twice
        self._looked_at = 0
        requests = [
            request for step in model.steps for request in (*step.output.node_print, *step.output.element_print)
        ]
        self._schedules = {id(request): Schedule() for request in requests}
        self._energies = Schedule()
        now = datetime.now()
        self._file.write(
            f"1\n\n   {program()}                                  Date {now:%d-%b-%Y}   Time {now:%H:%M:%S}\n\n"
            f"{_DECK}{model.deck.absolute()}\n\n{echo(model.deck)}{self._input()}"
        )

    def step_started(self, record: StepStarted) -> None:
        """Write the head of a step."""
        self._file.write(f"\n\n{procedure(self._model.steps[record.step - 1])}")

    def increment(self, record: IncrementDone, *, last: bool) -> None:
        """Write the summary and tables of an increment, if the step prints any."""
        step = self._model.steps[record.step - 1]
        if self._index is None:
            self._index = NodalIndex(len(self._model.mesh.labels), record.solution)
        if record.step != self._looked_at:
            self._looked_at = record.step
            self._missing(record, self._index)
        nodes = "".join(
            node_tables(request, self._model, record.solution, self._index, nlgeom=step.nlgeom)
            for request in step.output.node_print
            if self._schedules[id(request)].due(request.frequency, record, last=last)
        )
        elements = "".join(
            element_tables(request, self._model, record.solution)
            for request in step.output.element_print
            if self._schedules[id(request)].due(request.frequency, record, last=last)
        )
        energies = ""
        if self._energies.due(step.output.energy_print, record, last=last):
            energies = energy_table(record.solution, record.total_time, harmonic=step.procedure.harmonic)
        if not nodes and not elements and not energies:
            return
        text = (
            f"\n\n                                INCREMENT{record.increment:6d} SUMMARY\n\n\n"
            f"{completed(record, step.procedure.period)}"
        )
        if energies:
            text += f"\n\n                    E N E R G Y   O U T P U T\n{energies}"
        if elements:
            text += f"\n\n                             E L E M E N T   O U T P U T\n{elements}"
        if nodes:
            text += f"\n\n                                N O D E   O U T P U T\n{nodes}"
        self._file.write(text)

    def modes(self, record: ModesFound | BucklingFactors) -> None:
        """Write the table of eigenvalues."""
        self._file.write(_natural(record) if isinstance(record, ModesFound) else _buckling(record))

    def _missing(self, record: IncrementDone, index: NodalIndex) -> None:
        """Warn, once per step, of requested variables that are not available."""
        output = self._model.steps[record.step - 1].output
        requests: list[tuple[str, NodeRequest | ElementRequest]] = []
        requests += [(_request("*NODE PRINT", "NSET", request.nset), request) for request in output.node_print]
        requests += [(_request("*EL PRINT", "ELSET", request.elset), request) for request in output.element_print]
        for keyword, request in requests:
            if isinstance(request, ElementRequest):
                for element_type in not_extrapolated(request, self._model):
                    text = f"ELEMENTS OF TYPE {element_type} HAVE VALUES AT THE INTEGRATION POINTS ONLY"
                    self.remark("WARNING", f"{keyword}, POSITION={request.position}: {text}")
            for name in missing_variables(request, self._model, record.solution, index):
                self.remark("WARNING", f"{keyword}: {name} IS NOT AVAILABLE AND IS LEFT OUT")

    def remark(self, kind: str, text: str) -> None:
        """Write a note, warning or error."""
        if kind == "WARNING":
            self.warnings.append(text)
        self._file.write(f"\n{remark(kind, text)}")

    def text(self, text: str) -> None:
        """Write the text of a user routine, unchanged."""
        self._file.write_lines(text)

    def close(self, error: str | None, others: int = 0) -> None:
        """Write the verdict of the job; others: number of warnings in .msg alone."""
        if error is not None:
            self.remark("ERROR", error)
        verdict = "BEEN COMPLETED" if error is None else "NOT BEEN COMPLETED"
        self._file.write(
            f"\n\n          THE ANALYSIS HAS {verdict}\n\n\n"
            f"                              WITH {len(self.warnings):6d} WARNING MESSAGES ON THE DAT FILE\n"
            f"                              AND  {others:6d} WARNING MESSAGES ON THE MSG FILE\n"
        )
        self._file.close()

    def _input(self) -> str:
        """Return a summary of the model: size, user elements, ignored keywords, warnings."""
        model = self._model
        elements = sum(len(group.labels) for group in model.groups)
        used = used_nodes(model)
        nodes, unused = int(used.sum()), int((~used).sum())
        text = (
            "\n\n                            P R O B L E M   S I Z E\n\n\n"
            f"          NUMBER OF ELEMENTS IS                            {elements:10d}\n"
            f"          NUMBER OF NODES IS                               {nodes:10d}\n"
        )
        text += "".join(
            f"          {len(group.labels):10d} ELEMENTS OF TYPE {group.type}"
            + (f" IN INSTANCE {group.instance}" if group.instance else "")
            + "\n"
            for group in model.groups
        )
        if unused:
            first = model.mesh.name(int(np.argmin(used)))
            belong = "NODE BELONGS" if unused == 1 else "NODES BELONG"
            message = f"{unused} {belong} TO NO ELEMENT AND NO CONSTRAINT, LEFT OUT: {first}"
            text += "\n" + remark("NOTE", message + (" AND OTHERS" if unused > 1 else ""))
        definitions = {group.type: group.definition for group in model.groups if group.definition is not None}
        if definitions:
            text += "\n\n                            U S E R   E L E M E N T S\n\n"
            text += "".join(_user_element(name, definition) for name, definition in definitions.items())
            text += "\n" + remark("NOTE", _USER_ELEMENT_OUTPUT)
        if model.parameters:
            values = ", ".join(f"{name} = {value}" for name, value in model.parameters.items())
            text += "\n" + remark("NOTE", f"{_PARAMETERS}{values}")
        if model.ignored:
            text += "\n" + remark("NOTE", "THESE OPTIONS DO NOT CHANGE THE SOLUTION AND ARE IGNORED:")
            lines: dict[str, list[str]] = {}
            for keyword, source in model.ignored:
                lines.setdefault(keyword, []).append(str(source))
            text += "".join(f"          {_locations(keyword, sources)}\n" for keyword, sources in lines.items())
        return text + "".join(f"\n{remark('WARNING', warning)}" for warning in self.warnings)


def read_deck_path(path: Path) -> Path | None:
    """Read the path of a job's deck from its .dat file; None if it is not there."""
    if not path.exists():
        return None
    with path.open(encoding="utf-8", errors="replace") as file:
        named = next((line for line in islice(file, _HEAD_LINES) if line.startswith(_DECK)), "")
    return Path(named.removeprefix(_DECK).rstrip("\n")) if named else None


def read_parameters(path: Path) -> dict[str, float]:
    """Read the parameters that replaced those of the deck from the .dat file of a job."""
    notes = [note.removeprefix(_PARAMETERS) for note in read_remarks(path, "NOTE") if note.startswith(_PARAMETERS)]
    pairs = [pair.partition(" = ") for note in notes for pair in note.split(", ")]
    return {name: float(value) for name, _, value in pairs}


def echo(deck: Path) -> str:
    """Return the deck with line numbers; included files are not followed."""
    try:
        lines = deck.read_text("utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    text = "".join(f"{number:8d}  {line}".rstrip() + "\n" for number, line in enumerate(lines, 1))
    return f"                            I N P U T   E C H O\n\n{text}"


def _natural(record: ModesFound) -> str:
    """Return the table of natural frequencies."""
    text = (
        "\n\n                              E I G E N V A L U E    O U T P U T\n\n"
        " MODE NO      EIGENVALUE              FREQUENCY               GENERALIZED MASS\n"
        "                             (RAD/TIME)   (CYCLES/TIME)\n\n"
    )
    for number, values in enumerate(zip(record.eigenvalues, record.frequencies, record.masses, strict=True), 1):
        value, frequency, mass = (float(value) for value in values)
        rate = 2 * math.pi * frequency
        text += f"{number:8d}   {value:13.5g}   {rate:13.5g}   {frequency:13.5g}   {mass:13.5g}\n"
    return text


def _buckling(record: BucklingFactors) -> str:
    """Return the table of buckling loads."""
    text = (
        "\n\n                              E I G E N V A L U E    O U T P U T\n\n"
        ' BUCKLING LOAD ESTIMATE = ("DEAD" LOADS) + EIGENVALUE * ("LIVE" LOADS).\n'
        '          "DEAD" LOADS = TOTAL LOAD BEFORE *BUCKLE STEP.\n'
        '          "LIVE" LOADS = INCREMENTAL LOAD IN *BUCKLE STEP\n\n'
        " MODE NO      EIGENVALUE\n\n"
    )
    return text + "".join(
        f"{number:8d}   {value:13.5g}\n" for number, value in enumerate(record.eigenvalues.tolist(), 1)
    )


def _user_element(name: str, definition: UserElement) -> str:
    """Return the definition of a type by *USER ELEMENT."""
    dofs: dict[int, list[str]] = {}
    for node, dof in definition.dofs:
        dofs.setdefault(node, []).append(str(dof))
    runs: list[tuple[list[int], list[str]]] = []
    for node in range(definition.nodes):
        if runs and runs[-1][1] == dofs.get(node, []):
            runs[-1][0].append(node + 1)
        else:
            runs.append(([node + 1], dofs.get(node, [])))
    text = (
        f"     TYPE {name}\n"
        f"          NUMBER OF NODES                                  {definition.nodes:10d}\n"
        f"          NUMBER OF REAL PROPERTIES                        {definition.properties:10d}\n"
        f"          NUMBER OF INTEGER PROPERTIES                     {definition.integer_properties:10d}\n"
        f"          NUMBER OF SOLUTION-DEPENDENT VARIABLES           {definition.variables:10d}\n"
        f"          MATRIX                                           "
        f"{'UNSYMMETRIC' if definition.unsymmetric else 'SYMMETRIC'}\n"
    )
    for nodes, names in runs:
        where = f"NODE {nodes[0]}" if len(nodes) == 1 else f"NODES {nodes[0]} TO {nodes[-1]}"
        text += f"          {where:<20} DEGREES OF FREEDOM {', '.join(names) or 'NONE'}\n"
    return text


def _request(keyword: str, option: str, name: str) -> str:
    """Return a keyword with its set, if it has one."""
    return f"{keyword}, {option}={name}" if name else keyword


def _locations(keyword: str, sources: list[str]) -> str:
    """Return a keyword with the first lines where it occurs."""
    more = f" and {len(sources) - 3} more" if len(sources) > 3 else ""
    return f"{keyword:<24} {', '.join(sources[:3])}{more}"
