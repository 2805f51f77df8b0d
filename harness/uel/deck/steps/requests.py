# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Output requests of the steps; they stay in force until replaced."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.table import Keyword, Kind, Option, Where, compact, ignored, one_of, refused
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.sections.user_elements import LARGEST_DOF
from uel.errors import Source
from uel.model.arrays import IntArray
from uel.model.energies import ELEMENT_ENERGIES, ENERGIES
from uel.model.nodal_variables import COMPONENTS
from uel.model.steps import ElementRequest, EnergyRequest, NodeRequest, OutputRequests, Position

PRESELECTED_NODAL = ("U", "RF", "CF")
NEVER = 0
_OUTPUT_TIMES = ("NUMBER INTERVAL", "TIME INTERVAL", "TIME POINTS")


_EMPTY: dict[str, dict[str, object]] = {
    "FIELD": {"field_frequency": NEVER, "field_intervals": 0},
    "HISTORY": {"history_nodes": (), "history_energies": (), "history_sets": (), "history_frequency": 1},
    "NODE PRINT": {"node_print": ()},
    "EL PRINT": {"element_print": ()},
}
"""Values of `OutputRequests` without requests of each kind."""


@dataclass(frozen=True, slots=True)
class _Open:
    """*OUTPUT of the following *NODE OUTPUT and *ENERGY OUTPUT."""

    history: bool
    frequency: int
    sensor: str = ""


class RequestReader:
    """Reader of the output requests of successive steps."""

    def __init__(self, flat: FlatMesh, problems: Problems) -> None:
        self._flat = flat
        self._problems = problems
        self._requests = OutputRequests(history_energies=ENERGIES)
        self._open: _Open | None = None
        self._dropped: set[str] = set()
        self.energies: list[tuple[Source, str]] = []
        """Energies of the model requested in the step itself."""
        self._readers: dict[str, Callable[[Block], None]] = {
            "OUTPUT": self._output,
            "NODE OUTPUT": self._node_output,
            "ENERGY OUTPUT": self._energy_output,
            "NODE PRINT": self._node_print,
            "EL PRINT": self._element_print,
            "ENERGY PRINT": self._energy_print,
            "MONITOR": self._monitor,
        }

    def reads(self, block: Block) -> bool:
        """Return whether the keyword belongs to output requests."""
        return block.name in self._readers

    def read_step(self, blocks: list[Block]) -> OutputRequests:
        """Return the requests in force in a step."""
        self._open = None
        self._dropped, self.energies = set(), []
        for block in blocks:
            if self.reads(block):
                with self._problems.gather():
                    self._readers[block.name](block)
        return self._requests

    def _output(self, block: Block) -> None:
        options = block.options
        both = not options.flag("FIELD") and not options.flag("HISTORY")
        kinds = {kind for kind in ("FIELD", "HISTORY") if options.flag(kind) or both}
        if any(options.has(name) for name in _OUTPUT_TIMES) and options.flag("TIME MARKS"):
            message = "*OUTPUT: increments do not end at the output times; every increment is written instead"
            self._problems.warn(block.source, message)
        self._drop({"NEW": {"FIELD", "HISTORY"}, "REPLACE": kinds}.get(options.text("OP"), set()))
        frequency = _frequency(block)
        sensor = options.text("NAME") if options.flag("SENSOR") else ""
        if options.flag("SENSOR") and (not sensor or kinds != {"HISTORY"}):
            raise block.error("SENSOR needs HISTORY and NAME=")
        self._open = _Open("HISTORY" in kinds, frequency, sensor)
        now = self._requests
        if frequency == NEVER:
            return
        intervals = _intervals(block) if kinds == {"FIELD"} and not options.flag("TIME MARKS") else 0
        if intervals:
            self._requests = replace(self._requests, field_intervals=max(now.field_intervals, intervals))
        elif "FIELD" in kinds:
            smallest = min(now.field_frequency, frequency) if now.field_frequency != NEVER else frequency
            self._requests = replace(self._requests, field_frequency=smallest)
        if "HISTORY" in kinds:
            smallest = min(now.history_frequency, frequency) if now.history_nodes or now.history_energies else frequency
            energies = ENERGIES if options.has("VARIABLE") else now.history_energies
            self._requests = replace(self._requests, history_frequency=smallest, history_energies=energies)

    def _drop(self, kinds: set[str]) -> None:
        """Drop the requests of earlier steps of these kinds, once in a step."""
        empty: dict[str, Any] = {key: value for kind in kinds - self._dropped for key, value in _EMPTY[kind].items()}
        self._requests = replace(self._requests, **empty)
        self._dropped |= kinds

    def _history(self, block: Block) -> _Open | None:
        """Return the *OUTPUT of a request, None if it writes no history. Raises DeckError."""
        if self._open is None:
            raise block.error("does not follow *OUTPUT")
        return self._open if self._open.history and self._open.frequency != NEVER else None

    def _node_output(self, block: Block) -> None:
        nodes = self._nodes(block)
        output = self._history(block)
        variables = _listed(block) or PRESELECTED_NODAL
        if output is not None:
            if output.sensor and (len(nodes) != 1 or len(variables) != 1 or variables[0] not in COMPONENTS):
                raise block.error(f"sensor {output.sensor} must be one component, such as U2, of one node")
            name = block.options.text("NSET")
            request = NodeRequest(name, nodes, variables, output.frequency, sensor=output.sensor)
            self._requests = replace(self._requests, history_nodes=(*self._requests.history_nodes, request))

    def _energy_output(self, block: Block) -> None:
        options = block.options
        if options.has("PER ELEMENT SET") or options.has("PER SECTION"):
            message = "PER ELEMENT SET and PER SECTION are not supported; ELSET= is, with the energies of a set"
            self._problems.warn(block.source, f"*ENERGY OUTPUT: {message}")
        if self._history(block) is None:
            return
        if elset := options.text("ELSET"):
            elements = np.unique(self._flat.elements(elset, block.source))
            request = EnergyRequest(elset, elements, _listed(block) or ELEMENT_ENERGIES)
            self._requests = replace(self._requests, history_sets=(*self._requests.history_sets, request))
            return
        names = _listed(block) or ENERGIES
        self.energies += [(block.source, name) for name in names]
        energies = tuple(dict.fromkeys((*self._requests.history_energies, *names)))
        self._requests = replace(self._requests, history_energies=energies)

    def _node_print(self, block: Block) -> None:
        self._drop({"NODE PRINT"})
        name, nodes, frequency = block.options.text("NSET"), self._nodes(block), _frequency(block)
        totals = block.options.flag("TOTALS")
        tables = [_variables(row.fields) for row in block.rows()] if frequency != NEVER else []
        requests = [NodeRequest(name, nodes, variables, frequency, totals) for variables in tables]
        self._requests = replace(self._requests, node_print=(*self._requests.node_print, *requests))

    def _element_print(self, block: Block) -> None:
        self._drop({"EL PRINT"})
        name, frequency = block.options.text("ELSET"), _frequency(block)
        elements = self._flat.elements(name, block.source) if name else np.arange(self._flat.element_count)
        text = block.options.text("POSITION")
        # Abaqus takes CENTROID too, in a public deck with its .dat file
        position = Position.CENTROID if text == "CENTROID" else Position(text)
        tables = [_variables(row.fields) for row in block.rows()] if frequency != NEVER else []
        requests = [ElementRequest(name, elements, variables, frequency, position) for variables in tables]
        self._requests = replace(self._requests, element_print=(*self._requests.element_print, *requests))

    def _energy_print(self, block: Block) -> None:
        row = next(block.rows(), None)
        if row is not None:
            self._problems.warn(row.source, "*ENERGY PRINT takes no data lines; all energies are printed")
        self._requests = replace(self._requests, energy_print=_frequency(block))

    def _monitor(self, block: Block) -> None:
        name, dof = block.options.text("NODE"), block.options.integer("DOF", 0)
        node = self._flat.one_node(name, f"set {name}", block)
        if not 1 <= dof <= LARGEST_DOF:
            raise block.error(f"{dof} is not a dof (1 to {LARGEST_DOF})")
        self._requests = replace(self._requests, monitor=(node, dof))

    def _nodes(self, block: Block) -> IntArray:
        name = block.options.text("NSET")
        return self._flat.nodes(name, block.source) if name else np.arange(len(self._flat.mesh.labels))


def _listed(block: Block) -> tuple[str, ...]:
    return tuple(name for row in block.rows() for name in _variables(row.fields))


def _variables(fields: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(compact(name) for name in fields if name)


def _intervals(block: Block) -> int:
    intervals = block.options.integer("NUMBER INTERVAL", 0)
    if intervals < 1 and block.options.has("NUMBER INTERVAL"):
        raise block.error(f"NUMBER INTERVAL={intervals} must be positive")
    return intervals


def _frequency(block: Block) -> int:
    frequency = block.options.integer("FREQUENCY", 1)
    if frequency < 0:
        raise block.error(f"FREQUENCY={frequency} must not be negative")
    return frequency


_NSET = Option("NSET", Kind.NAME, "node set")
_FREQUENCY = Option("FREQUENCY", Kind.INTEGER, "every k-th increment (1); 0 never")
_VARIABLE = one_of("VARIABLE", "default variables", ("ALL", "PRESELECT"))

KEYWORDS = (
    Keyword(
        "OUTPUT",
        "Begin output requests; without any, history and field output are those Abaqus preselects.",
        Where.STEP,
        (
            Option("FIELD", doc="field output, written to .vtu"),
            Option("HISTORY", doc="history output, written to .csv"),
            _FREQUENCY,
            one_of("OP", "what happens to earlier requests", ("NEW", "ADD", "REPLACE"), default="NEW"),
            Option("NUMBER INTERVAL", Kind.INTEGER, "number of output times in the step"),
            Option("TIME INTERVAL", Kind.REAL, "time between outputs"),
            Option("TIME MARKS", Kind.SWITCH, "whether increments end at the output times", default="YES"),
            _VARIABLE,
            Option("TIME POINTS", Kind.NAME, "output times"),
            Option("SENSOR", doc="UAMP reads the variable, which is one component of one node, by NAME"),
            Option("NAME", Kind.NAME, "of a sensor"),
            *ignored("DIAGNOSTICS", "FILTER", "MODE LIST"),
        ),
    ),
    Keyword(
        "NODE OUTPUT",
        "Nodal variables of the *OUTPUT before.",
        Where.STEP,
        (_NSET, _VARIABLE, *ignored("EXTERIOR", "TRACER SET")),
        "variables",
    ),
    Keyword(
        "ENERGY OUTPUT",
        "Energies of the whole model, or of an element set, of the *OUTPUT, HISTORY before. In linear steps sets have "
        "none, and the model those of the procedure: ALLSE and ALLWK of *STATIC, ALLSE and ALLKE of *STEADY STATE "
        "DYNAMICS, means over a period, and of *MODAL DYNAMIC.",
        Where.STEP,
        (
            Option("ELSET", Kind.NAME, f"element set, which has {', '.join(ELEMENT_ENERGIES)}"),
            _VARIABLE,
            *(Option(name, doc="not supported: a warning") for name in ("PER ELEMENT SET", "PER SECTION")),
        ),
        "variables",
    ),
    Keyword(
        "NODE PRINT",
        "Table of nodal variables in .dat.",
        Where.STEP,
        (
            _NSET,
            _FREQUENCY,
            Option("TOTALS", Kind.SWITCH, "print the sum of each column"),
            *ignored("GLOBAL", "MODE", "LAST MODE", "SUMMARY"),
        ),
        "variables, one table per line",
    ),
    Keyword(
        "EL PRINT",
        "Table of element variables in .dat.",
        Where.STEP,
        (
            Option("ELSET", Kind.NAME, "element set"),
            _FREQUENCY,
            one_of(
                "POSITION",
                "where; values of built-in continuum elements are extrapolated, of others .dat has those at the "
                "points and warns",
                ("INTEGRATION POINTS", "CENTROIDAL", "CENTROID", "NODES", "AVERAGED AT NODES"),
                default="INTEGRATION POINTS",
            ),
            *ignored("DIRECTIONS", "LAST MODE", "LOCALDIR", "MODE", "REBAR", "SUMMARY", "TOTALS"),
        ),
        "variables, one table per line",
    ),
    Keyword(
        "ENERGY PRINT",
        "Table of the energies of the whole model in .dat.",
        Where.STEP,
        (_FREQUENCY, *refused("ELSET")),
        "ignored, with a warning: all energies are printed",
    ),
    Keyword(
        "MONITOR",
        "Dof whose value .sta prints.",
        Where.STEP,
        (
            Option("NODE", Kind.NAME, "node, or set of one node", required=True),
            Option("DOF", Kind.INTEGER, "dof", required=True),
            *ignored("FREQUENCY"),
        ),
    ),
)
