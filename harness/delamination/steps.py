# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword blocks of a step: increments, solution controls, prescribed displacements, output."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from harness.delamination.keywords import keyword, number, table


@dataclass(frozen=True, slots=True)
class Increments:
    """*STATIC over a period of 1: increments, and the solution controls of a failing interface.

    initial, smallest, largest  increment in step time
    limit          number of increments allowed
    discontinuous  ANALYSIS=DISCONTINUOUS: the residual may rise for longer before an attempt is abandoned
    line_search    number of line-search iterations, 0 for none
    attempts       attempts allowed in one increment (I_A)
    residual       R_n and R_l where the default is not strict enough
    field_parts    field output at the end of so many equal parts of the step; 0: every so many increments
    """

    initial: float
    smallest: float
    largest: float
    limit: int = 1000
    discontinuous: bool = False
    line_search: int = 0
    attempts: int = 5
    residual: float | None = None
    field_parts: int = 0


LINEAR = Increments(initial=1.0, smallest=1.0, largest=1.0, limit=1)


def step_block(
    title: str,
    increments: Increments,
    prescribed: Iterable[tuple[str, int, float]],
    history: Iterable[str],
    *,
    field_every: int = 10,
    built_in: bool = False,
) -> list[str]:
    """*STEP to *END STEP.

    Parameters
    ----------
    title, increments
        Subtitle of the step; its incrementation.
    prescribed
        Node set, dof, displacement (mm).
    history
        Node sets whose U2 and RF2 are written.
    field_every
        Field output every so many increments, unless the increments say otherwise; printed output too.
    built_in
        The interface elements are Abaqus' own: other names of their variables and energies.
    """
    static = (increments.initial, 1.0, increments.smallest, increments.largest)
    lines = [keyword("STEP", INC=increments.limit, UNSYMM="YES"), title, "*STATIC", *table([static])]
    lines += _controls(increments)
    lines += ["*BOUNDARY", *(f"{name}, {dof}, {dof}, {number(value)}" for name, dof, value in prescribed)]
    every = f"NUMBER INTERVAL={increments.field_parts}, TIME MARKS=NO"
    lines += [f"*OUTPUT, FIELD, {every if increments.field_parts else f'FREQUENCY={field_every}'}"]
    lines += ["*NODE OUTPUT", "U, RF"]
    lines.append("*OUTPUT, HISTORY, FREQUENCY=1")
    for name in history:
        lines += [keyword("NODE OUTPUT", NSET=name), "U2, RF2"]
    dissipated = "ALLDMD, ALLCD" if built_in else "ALLPD, ALLVD"
    lines += ["*ENERGY OUTPUT", f"ALLIE, ALLSE, {dissipated}, ALLWK, ETOTAL"]
    for name in history:
        lines += [keyword("NODE PRINT", NSET=name, FREQUENCY=field_every), "U2, RF2"]
    # the state of the first interface element; Abaqus prints the SVARS of user elements as SDV
    lines += [keyword("EL PRINT", ELSET="TIP", FREQUENCY=field_every), "S, E, SDEG" if built_in else "SDV3, SDV5, SDV7"]
    return [*lines, "*END STEP"]


def _controls(increments: Increments) -> list[str]:
    lines = []
    if increments.residual is not None:
        limit = number(increments.residual)
        lines += ["*CONTROLS, PARAMETERS=FIELD", f"{limit}, , , , , , , {limit}"]
    if increments.discontinuous:
        lines.append("*CONTROLS, ANALYSIS=DISCONTINUOUS")
    if increments.attempts != 5:
        # I_0, I_R, I_P, I_C, I_L, I_G, I_S, I_A; what ANALYSIS=DISCONTINUOUS sets is not the default of this line
        first = "8, 10" if increments.discontinuous else "4, 8"
        lines += ["*CONTROLS, PARAMETERS=TIME INCREMENTATION", f"{first}, 9, 16, 10, 4, 12, {increments.attempts}"]
    if increments.line_search:
        lines += ["*CONTROLS, PARAMETERS=LINE SEARCH", f"{increments.line_search}, 1., 0.0001, 0.25, 0.1"]
    return lines
