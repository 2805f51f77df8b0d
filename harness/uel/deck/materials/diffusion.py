# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Mass diffusion: *DIFFUSIVITY, *SOLUBILITY and *KAPPA; dof 11 is the concentration with *MASS DIFFUSION."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Where, one_of, refused
from uel.model.dofs import CONCENTRATION, TEMPERATURE
from uel.model.model import Equation, Model
from uel.model.properties import Diffusivity
from uel.model.steps import PRESSURE_STRESS, Boundary, Step

_DIAGONAL: Final = ((0, 0), (1, 1), (2, 2))
_ENTRIES: Final = {"ISO": _DIAGONAL, "ORTHO": _DIAGONAL, "ANISO": ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))}
"""Positions in the matrix of the constants of each TYPE."""


def read_diffusivity(block: Block) -> Diffusivity:
    """Read the diffusivity by concentration and temperature. Raises DeckError."""
    kind = block.options.text("TYPE")
    entries = _ENTRIES[kind]
    rows = _read_rows(block, 1 if kind == "ISO" else len(entries), "diffusivity")
    tensors = np.zeros((len(rows), 3, 3))
    for tensor, (row, values) in zip(tensors, rows, strict=True):
        for value, (i, j) in zip(np.broadcast_to(values[:-2], len(entries)), entries, strict=True):
            tensor[i, j] = tensor[j, i] = value
        if np.linalg.eigvalsh(tensor)[0] <= 0:
            raise row.error("the diffusivity must be positive" if kind == "ISO" else "D must be positive definite")
    points = np.array([values[-2:] for _, values in rows])
    return Diffusivity(tensors, points, block.options.text("LAW") == "FICK", kind == "ISO", block.source)


def read_kappa(block: Block, diffusivity: Diffusivity | None) -> Diffusivity:
    """Return the diffusivity extended by the factors of *KAPPA. Raises DeckError."""
    kind = block.options.text("TYPE")
    if diffusivity is None:
        raise block.error("does not follow *DIFFUSIVITY")
    table = np.array([values for _, values in _read_rows(block, 1, "factor")])
    if kind == "PRESS":
        return replace(diffusivity, pressure=table)
    if diffusivity.fick:
        message = f"TYPE=TEMP and *DIFFUSIVITY, LAW=FICK ({diffusivity.source}) exclude each other"
        raise block.error(f"{message}: Fick's law sets the factor by the solubility")
    return replace(diffusivity, soret=table)


def _read_rows(block: Block, constants: int, quantity: str) -> list[tuple[Row, list[float]]]:
    """Read rows of constants, concentration and temperature. Raises DeckError for a repeated pair of the last two."""
    table: list[tuple[Row, list[float]]] = []
    for row in block.required_rows(f"the {quantity}"):
        row.at_most(constants + 2)
        values = [row.real(k, quantity) for k in range(constants)]
        values += [row.real(constants, "concentration", 0.0), row.real(constants + 1, "temperature", 0.0)]
        if any(values[constants:] == earlier[constants:] for _, earlier in table):
            raise row.error("concentration and temperature are those of an earlier line")
        table.append((row, values))
    return table


def with_concentrations(model: Model, problems: Problems) -> Model:
    """Return the model with the concentration as dof 11 if its steps are *MASS DIFFUSION; report incompatible data."""
    if not model.diffusive:
        _refuse_elsewhere(model, problems)
        return model
    _check(model, problems)
    return replace(
        model,
        boundaries=_renumbered(model.boundaries),
        equations=tuple(_of_concentrations(equation) for equation in model.equations),
        steps=tuple(_in_step(step) for step in model.steps),
    )


def _refuse_elsewhere(model: Model, problems: Problems) -> None:
    conditions = [("CONCENTRATION", entry.source) for entry in model.initial_concentrations]
    conditions += [("PRESSURE STRESS", entry.source) for entry in model.initial_fields if entry.dof == PRESSURE_STRESS]
    entries = [(source, f"*INITIAL CONDITIONS, TYPE={kind}") for kind, source in conditions]
    fields = (entry for step in model.steps for entry in step.fields if entry.dof == PRESSURE_STRESS)
    entries += [(entry.source, "*PRESSURE STRESS") for entry in fields]
    for source, keyword in entries:
        problems.add(source, f"{keyword} is for *MASS DIFFUSION")


def _check(model: Model, problems: Problems) -> None:
    for step in model.steps:
        if not step.procedure.concentrations:
            message = "is not supported in a job with *MASS DIFFUSION, where dof 11 is a concentration"
            problems.add(step.source, f"*{step.procedure.keyword} {message}; expected a job of its own")
        for heat in step.heat_loads:
            if heat.type.exchanges:
                problems.add(heat.source, f"*{heat.type.keyword} exchanges heat, which *MASS DIFFUSION has none of")


def _in_step(step: Step) -> Step:
    monitor = step.output.monitor
    if monitor is not None and monitor[1] == TEMPERATURE:
        monitor = monitor[0], CONCENTRATION
    return replace(
        step,
        boundaries=_renumbered(step.boundaries),
        loads=tuple(replace(entry, dof=_number(entry.dof)) for entry in step.loads),
        output=replace(step.output, monitor=monitor),
    )


def _renumbered(entries: tuple[Boundary, ...]) -> tuple[Boundary, ...]:
    return tuple(replace(entry, dof=_number(entry.dof)) for entry in entries)


def _of_concentrations(equation: Equation) -> Equation:
    return replace(equation, terms=tuple((node, _number(dof), factor) for node, dof, factor in equation.terms))


def _number(dof: int) -> int:
    return CONCENTRATION if dof == TEMPERATURE else dof


_POINT: Final = "concentration, temperature; linear in between"

KEYWORDS = (
    Keyword(
        "DIFFUSIVITY",
        "Diffusivity of a material that diffuses through another one, in *MASS DIFFUSION.",
        Where.MODEL,
        (
            one_of("TYPE", "symmetry, in the directions of *ORIENTATION", tuple(_ENTRIES), default="ISO"),
            one_of("LAW", "general chemical potential or Fick's law", ("GENERAL", "FICK"), default="GENERAL"),
            *refused("DEPENDENCIES"),
        ),
        f"D; or D11, D22, D33; or D11, D12, D22, D13, D23, D33; then {_POINT}",
    ),
    Keyword(
        "KAPPA",
        "Diffusion that gradients of temperature (Soret effect) or of the equivalent pressure stress drive; after "
        "*DIFFUSIVITY.",
        Where.MODEL,
        (one_of("TYPE", "which gradient", ("TEMP", "PRESS"), default="TEMP"), *refused("DEPENDENCIES")),
        f"factor, {_POINT}",
    ),
    Keyword(
        "SOLUBILITY",
        "Solubility: concentration over normalized concentration.",
        Where.MODEL,
        refused("DEPENDENCIES"),
        "solubility, temperature; linear in between",
    ),
)
