# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of the manual about what is supported: the table of formulations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Final

from uel.elements.materials.laws import Law
from uel.elements.support import FORMULATIONS, LIMITS_OF_LAWS, OF_HEAT, STEPS, Feature, Support
from uel.model.element_types import BUILT_IN, LAYERED, Formulation
from uel.model.steps import Step

YES, SMALL, IDLE, NO = "yes", "small", "–", ""
"""Supported; with small displacements only; accepted without effect; refused."""

_SHORT: Final = {
    Formulation.LAYERED: f"{LAYERED[0]} layers",
    Formulation.DIFFUSION: "DC diffusion",
    Formulation.USER: "Un",
}


def types_of(formulation: Formulation) -> list[str]:
    """Return the element types of a formulation."""
    other = {Formulation.LAYERED: LAYERED, Formulation.USER: ["Un"]}
    kind = Formulation.HEAT if formulation is Formulation.DIFFUSION else formulation
    return list(other.get(kind) or (name for name, built_in in BUILT_IN.items() if built_in.formulation is kind))


def mark_law(support: Support, law: Law) -> str:
    """Return how elements take a part of their material."""
    return YES if law in support.laws else IDLE if law in support.ignored else NO


def mark_feature(support: Support, feature: Feature) -> str:
    """Return how elements take a feature."""
    return YES if feature in support.features else NO


def mark_step(support: Support, step: Step) -> str:
    """Return how elements take a procedure."""
    large = support.supports(replace(step, nlgeom=True))
    if support.mechanical_only and not step.procedure.displacements and support.supports(step):
        return IDLE
    return NO if not support.supports(step) else YES if large else SMALL


def support() -> str:
    """Return the page."""
    return "\n".join([*_introduction(), *_families(), *_tables(), *_limits(), *_apart()]) + "\n"


def _introduction() -> list[str]:
    return [
        "# What is supported",
        "",
        "The table that this page shows also refuses the rest, with its place in the deck. A combination is supported "
        "if each of its cells is: whether S4R takes \\*EXPANSION in \\*FREQUENCY, the column of its family says in the "
        f"rows \\*EXPANSION and \\*FREQUENCY. `{YES}`: supported; `{SMALL}`: without NLGEOM only; {IDLE}: accepted "
        "without effect; an empty cell: refused.",
    ]


def _families() -> list[str]:
    lines = ["", "## Families of element types", "", "| column | family | types |", "|---|---|---|"]
    lines += [f"| {label(each)} | {_cell(each)} | {', '.join(types_of(each))} |" for each in FORMULATIONS]
    return lines


def _tables() -> list[str]:
    return [
        *_matrix("Materials", {law: partial(mark_law, law=law) for law in Law}),
        *_matrix("Procedures", {name: partial(mark_step, step=step) for name, step in STEPS.items()}),
        *_matrix("Sections and initial conditions", {each: partial(mark_feature, feature=each) for each in Feature}),
    ]


def _matrix(title: str, rows: Mapping[Any, Callable[[Support], str]]) -> list[str]:
    """Return a table, without the families that have nothing in it."""
    marks = {each: [mark(support) for mark in rows.values()] for each, support in FORMULATIONS.items()}
    marks = {each: column for each, column in marks.items() if any(column)}
    lines = ["", f"## {title}", "", f"| | {' | '.join(map(label, marks))} |", "|---" * (len(marks) + 1) + "|"]
    return lines + [
        f"| {_cell(name)} | {' | '.join(row)} |"
        for name, row in zip(rows, zip(*marks.values(), strict=True), strict=True)
    ]


def _limits() -> list[str]:
    lines = ["", "## Procedures that materials do not take", "", "| material | procedures | reason |", "|---|---|---|"]
    for law in (law for law in Law if law in LIMITS_OF_LAWS):
        for limit in LIMITS_OF_LAWS[law]:
            names = [name for name, step in STEPS.items() if limit.refuses(replace(step, nlgeom=True))]
            lines.append(f"| {_cell(law)} | {_cell(', '.join(names) or 'all without NLGEOM')} | {limit.reason} |")
    return lines


def _apart() -> list[str]:
    lines = [
        "",
        "## What excludes each other",
        "",
        "| one of | beside one of | expected | families |",
        "|---|---|---|---|",
    ]
    for rule in dict.fromkeys(rule for support in FORMULATIONS.values() for rule in support.exclusions):
        first, *others = map(_listed, rule.sets)
        having = [each for each, support in FORMULATIONS.items() if rule in support.exclusions]
        families = "all" if len(having) > len(Formulation) / 2 else ", ".join(map(label, having))
        lines.append(f"| {_cell(first)} | {_cell(' and '.join(others))} | {_cell(rule.expected)} | {families} |")
    return lines


def _listed(names: frozenset[str]) -> str:
    """List laws or features, by the keyword alone where all its forms are among them."""
    words: list[str] = [name for name in Feature if name in names]
    for law in (law for law in Law if law in names):
        forms = {each for each in Law if each.keyword == law.keyword and each not in OF_HEAT}
        words.append(law.keyword if forms <= names else law)
    return ", ".join(dict.fromkeys(words))


def label(formulation: Formulation) -> str:
    """Return the head of a column: one of the types."""
    types = types_of(formulation)
    return _SHORT.get(formulation) or next((name for name in types if name.startswith("C3D8")), types[0])


def _cell(text: str) -> str:
    return text.replace("*", "\\*")
