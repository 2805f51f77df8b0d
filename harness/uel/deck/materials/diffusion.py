# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Diffusion of one material through another: *DIFFUSIVITY, *SOLUBILITY and *KAPPA; concentrations in place of
temperatures in a deck with *MASS DIFFUSION.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Where, one_of, refused
from uel.deck.materials.heat import read_by_temperature
from uel.model.dofs import CONCENTRATION, TEMPERATURE
from uel.model.model import Equation, Model
from uel.model.properties import Diffusivity, Material
from uel.model.steps import PRESSURE_STRESS, Boundary, Step

_DIAGONAL: Final = ((0, 0), (1, 1), (2, 2))
_PLACES: Final = {"ISO": _DIAGONAL, "ORTHO": _DIAGONAL, "ANISO": ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))}
"""Positions in the matrix of the constants of each TYPE."""


def extend_diffusion(material: Material, block: Block) -> Material:
    """Return the material extended by one of these options. Raises DeckError."""
    if block.name == "DIFFUSIVITY":
        return replace(material, diffusivity=_read_diffusivity(block))
    if block.name == "SOLUBILITY":
        return replace(material, solubility=read_by_temperature(block, "solubility"))
    return replace(material, diffusivity=_read_kappa(block, material.diffusivity))


def _read_diffusivity(block: Block) -> Diffusivity:
    kind = block.options.text("TYPE")
    places = _PLACES[kind]
    rows = _read_rows(block, 1 if kind == "ISO" else len(places), "diffusivity")
    tensors = np.zeros((len(rows), 3, 3))
    for tensor, (row, values) in zip(tensors, rows, strict=True):
        for value, (i, j) in zip(np.broadcast_to(values[:-2], len(places)), places, strict=True):
            tensor[i, j] = tensor[j, i] = value
        if np.linalg.eigvalsh(tensor)[0] <= 0:
            raise row.error("the diffusivity must be positive" if kind == "ISO" else "D must be positive definite")
    points = np.array([values[-2:] for _, values in rows])
    return Diffusivity(tensors, points, block.options.text("LAW") == "FICK", kind == "ISO", block.source)


def _read_kappa(block: Block, given: Diffusivity | None) -> Diffusivity:
    kind = block.options.text("TYPE")
    if given is None:
        raise block.error("does not follow *DIFFUSIVITY")
    table = np.array([values for _, values in _read_rows(block, 1, "factor")])
    if kind == "PRESS":
        return replace(given, pressure=table)
    if given.fick:
        message = f"TYPE=TEMP and *DIFFUSIVITY, LAW=FICK ({given.source}) exclude each other"
        raise block.error(f"{message}: Fick's law sets the factor by the solubility")
    return replace(given, soret=table)


def _read_rows(block: Block, constants: int, what: str) -> list[tuple[Row, list[float]]]:
    """Read rows of constants, concentration and temperature. Raises DeckError for a repeated pair of the last two."""
    found: list[tuple[Row, list[float]]] = []
    for row in block.rows():
        row.at_most(constants + 2)
        values = [row.real(k, what) for k in range(constants)]
        values += [row.real(constants, "concentration", 0.0), row.real(constants + 1, "temperature", 0.0)]
        if any(values[constants:] == earlier[constants:] for _, earlier in found):
            raise row.error("concentration and temperature are those of an earlier line")
        found.append((row, values))
    if not found:
        raise block.error(f"needs a data line with the {what}")
    return found


def with_concentrations(model: Model, problems: Problems) -> Model:
    """Return the model with the concentration as dof 11 if its steps are *MASS DIFFUSION;
    add errors for what does not fit.
    """
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
    given = [(entry.source, "*INITIAL CONDITIONS, TYPE=CONCENTRATION") for entry in model.initial_concentrations]
    given += [
        (entry.source, "*INITIAL CONDITIONS, TYPE=PRESSURE STRESS")
        for entry in model.initial_fields
        if entry.dof == PRESSURE_STRESS
    ]
    given += [
        (entry.source, "*PRESSURE STRESS")
        for step in model.steps
        for entry in step.fields
        if entry.dof == PRESSURE_STRESS
    ]
    for source, what in given:
        problems.add(source, f"{what} is for *MASS DIFFUSION")


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

OPTIONS = (
    Keyword(
        "DIFFUSIVITY",
        "Diffusivity of a material that diffuses through another one, in *MASS DIFFUSION.",
        Where.MODEL,
        (
            one_of("TYPE", "symmetry, in the directions of *ORIENTATION", tuple(_PLACES), default="ISO"),
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
"""Keywords of diffusion after *MATERIAL."""

KEYWORDS = OPTIONS
