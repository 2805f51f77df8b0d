# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's statements (statements.toml), each decided by one number from the runs.

A statement has

id, section, figure   figure is empty where the paper shows none
quote                 a few words of the paper
number                what our number is
measure, arguments    function of `findings`, `curves`, `basics`, `foundations` or `parameters`
at_least, at_most     what the number has to be, one of them or both
cases                 part of the command that runs what the number needs: 'law', 'patch', 'dcb', 'enf', 'frmm', ...
also                  further numbers to show, each with number, measure, arguments; with `full` not in --quick; one
                      that a remark speaks of has a name
why                   remark, or a list of remarks, each with text and, if it holds for some results only, `when`: the
                      numbers that decide on it, by name (`value` is that of the statement), with at_least, or below, or
                      both, and `reproduced`. A text has the numbers it speaks of by name, as in '{value:.0%}'
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Formatter

from uel.paper.reproduce import basics, curves, findings, foundations, parameters
from uel.paper.reproduce.findings import Evidence

FILE = Path(__file__).with_name("statements.toml")
MEASURES = findings.MEASURES | curves.MEASURES | basics.MEASURES | foundations.MEASURES | parameters.MEASURES
REQUIRED = {"id", "section", "figure", "quote", "number", "measure", "cases"}
OPTIONAL = {"arguments", "at_least", "at_most", "also", "why"}
ALSO = {"number", "measure", "arguments", "full", "name"}
VALUE = "value"
"""Name of the statement's own number."""
LIMITS = {"at_least", "below"}


@dataclass(frozen=True, slots=True)
class Number:
    """A number: what it is, and how it is measured; full: on the full meshes only; its name in remarks."""

    text: str
    measure: str
    arguments: Mapping[str, object]
    full: bool = False
    name: str = ""

    def of(self, evidence: Evidence) -> float:
        """Compute its value."""
        return float(MEASURES[self.measure](evidence, **self.arguments))


@dataclass(frozen=True, slots=True)
class Remark:
    """A remark on the numbers of a statement.

    text        with the numbers by name, in the form of `str.format`
    limits      smallest value, and the one it has to be below, by the names of the numbers that decide
    reproduced  the verdict that it belongs to; None for both
    """

    text: str
    limits: Mapping[str, tuple[float, float]]
    reproduced: bool | None = None

    def names(self) -> set[str]:
        """Return the names of the numbers that it needs."""
        return {name for _, name, _, _ in Formatter().parse(self.text) if name} | set(self.limits)

    def holds(self, values: Mapping[str, float], *, reproduced: bool) -> bool:
        """Report whether it belongs to these numbers, which it needs, and this verdict."""
        if not self.names() <= set(values) or self.reproduced not in (None, reproduced):
            return False
        return all(low <= values[name] < high for name, (low, high) in self.limits.items())


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement of the paper and the number that decides on it."""

    id: str
    section: str
    figure: str
    quote: str
    number: Number
    at_least: float | None
    at_most: float | None
    cases: tuple[str, ...]
    also: tuple[Number, ...]
    remarks: tuple[Remark, ...]

    @property
    def limits(self) -> str:
        """Limits of the number, in words."""
        low = "" if self.at_least is None else f"at least {self.at_least:g}"
        high = "" if self.at_most is None else f"at most {self.at_most:g}"
        return ", ".join(filter(None, (low, high)))

    def holds(self, value: float) -> bool:
        """Report whether a value is within the limits; NaN is not."""
        low = self.at_least is None or value >= self.at_least
        high = self.at_most is None or value <= self.at_most
        return low and high


@dataclass(frozen=True, slots=True)
class JudgedStatement:
    """A statement with our numbers: its own, and the others with what they are and their names."""

    statement: Statement
    value: float
    also: tuple[tuple[Number, float], ...]

    @property
    def reproduced(self) -> bool:
        """True if our number is what the statement says."""
        return self.statement.holds(self.value)

    @property
    def why(self) -> str:
        """Remarks that belong to the numbers."""
        values = {number.name: value for number, value in self.also if number.name} | {VALUE: self.value}
        chosen = (remark for remark in self.statement.remarks if remark.holds(values, reproduced=self.reproduced))
        return " ".join(remark.text.format(**values) for remark in chosen)


def read_statements(file: Path = FILE) -> list[Statement]:
    """Return all statements.

    Raises
    ------
    ValueError
        A statement lacks an entry, has one that is not known, or names no measure of ours.
    """
    entries = tomllib.loads(file.read_text(encoding="utf-8"))["statement"]
    return [_statement(entry, f"{file.name}: {entry.get('id')}") for entry in entries]


def _statement(entry: Mapping[str, object], place: str) -> Statement:
    given = set(entry)
    if not given >= REQUIRED or given - REQUIRED - OPTIONAL or not given & {"at_least", "at_most"}:
        wanted = ", ".join(sorted(REQUIRED))
        raise ValueError(f"{place}: expected {wanted}, and at_least or at_most; {', '.join(sorted(OPTIONAL))} may be")
    texts = {name: str(entry[name]) for name in ("id", "section", "figure", "quote")}
    low, high = (None if entry.get(name) is None else float(str(entry[name])) for name in ("at_least", "at_most"))
    also, cases = entry.get("also", []), entry["cases"]
    assert isinstance(also, Sequence)
    if any(set(other) - ALSO for other in also):
        raise ValueError(f"{place}: also: expected {', '.join(sorted(ALSO))}")
    assert isinstance(cases, Sequence)
    others = tuple(_number(other, place) for other in also)
    remarks = _remarks(entry.get("why", []), place, {VALUE, *(other.name for other in others if other.name)})
    return Statement(
        **texts,
        number=_number(entry, place),
        at_least=low,
        at_most=high,
        cases=tuple(cases),
        also=others,
        remarks=remarks,
    )


def _remarks(entries: object, place: str, names: set[str]) -> tuple[Remark, ...]:
    given = [{"text": entries}] if isinstance(entries, str) else entries
    assert isinstance(given, Sequence)
    remarks = []
    for entry in given:
        limits = dict(entry.get("when", {}))
        reproduced = limits.pop("reproduced", None)
        if "text" not in entry or set(entry) - {"text", "when"} or any(set(end) - LIMITS for end in limits.values()):
            raise ValueError(f"{place}: why: expected text, and when with reproduced or numbers by {sorted(LIMITS)}")
        ends = {name: (end.get("at_least", -math.inf), end.get("below", math.inf)) for name, end in limits.items()}
        remark = Remark(str(entry["text"]), ends, reproduced)
        if unknown := remark.names() - names:
            raise ValueError(f"{place}: why: no number is named {sorted(unknown)}; there are {sorted(names)}")
        remarks.append(remark)
    return tuple(remarks)


def _number(entry: Mapping[str, object], place: str) -> Number:
    measure, arguments = str(entry["measure"]), entry.get("arguments", {})
    if measure not in MEASURES:
        raise ValueError(f"{place}: no measure '{measure}'; expected one of {', '.join(sorted(MEASURES))}")
    assert isinstance(arguments, Mapping)
    return Number(str(entry["number"]), measure, arguments, bool(entry.get("full", False)), str(entry.get("name", "")))


def judge(statement: Statement, evidence: Evidence) -> JudgedStatement:
    """Return our numbers for a statement."""
    also = [number for number in statement.also if not (number.full and evidence.coarse)]
    return JudgedStatement(
        statement, statement.number.of(evidence), tuple((number, number.of(evidence)) for number in also)
    )
