# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keyword blocks of a step: increments, solution controls, prescribed displacements, output."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from uel.delamination.kernels import state_labels
from uel.delamination.keywords import keyword, number, table


@dataclass(frozen=True, slots=True)
class Increments:
    """*STATIC over a period of 1: increments, and the solution controls of a failing interface.

    initial, smallest, largest  increment in step time
    limit          number of increments allowed
    discontinuous  ANALYSIS=DISCONTINUOUS: the residual may grow for more iterations before a cutback
    line_search    number of line-search iterations, 0 for none
    attempts       attempts allowed in one increment (I_A)
    residual       R_n and R_l where the default is not strict enough
    field_parts    NUMBER INTERVAL of the field output; 0: every so many increments
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
    """Write *STEP to *END STEP.

    Parameters
    ----------
    title, increments
        Subtitle of the step; its incrementation.
    prescribed
        Node set, dof, displacement (mm).
    history
        Node sets whose U2 and RF2 are written.
    field_every
        FREQUENCY of printed output and, without `field_parts`, of field output.
    built_in
        The interface elements are cohesive elements of Abaqus, with other output variables.
    """
    static = (increments.initial, 1.0, increments.smallest, increments.largest)
    head = [keyword("STEP", INC=increments.limit, UNSYMM="YES"), title, "*STATIC", *table([static])]
    boundary = [f"{name}, {dof}, {dof}, {number(value)}" for name, dof, value in prescribed]
    interval = f"NUMBER INTERVAL={increments.field_parts}, TIME MARKS=NO"
    dissipated = "ALLDMD, ALLCD" if built_in else "ALLPD, ALLVD"
    names = list(history)
    output = Output(
        when=interval if increments.field_parts else f"FREQUENCY={field_every}",
        stresses=False,
        history=dict.fromkeys(names, "U2, RF2"),
        energies=f"ALLIE, ALLSE, {dissipated}, ALLWK, ETOTAL",
    )
    lines = [*head, *_controls(increments), "*BOUNDARY", *boundary, *output.lines()]
    for name in names:
        lines += [keyword("NODE PRINT", NSET=name, FREQUENCY=field_every), "U2, RF2"]
    # the state of the first interface element, as all types of the plane have it; Abaqus prints SVARS as SDV
    variables = "S, E, SDEG" if built_in else ", ".join(state_labels(2, "SEPN", "TN", "DAMAGE"))
    lines += [keyword("EL PRINT", ELSET="TIP", FREQUENCY=field_every), variables]
    return [*lines, "*END STEP"]


@dataclass(frozen=True, slots=True)
class Output:
    """Output requests of a step.

    when      options of the field output; displacements, reactions and, with `stresses`, those of the elements
    history   node sets with the variables that are written in every increment
    energies  of the whole model, '' for none
    """

    when: str = "FREQUENCY=10"
    stresses: bool = True
    history: Mapping[str, str] = field(default_factory=dict)
    energies: str = ""

    def lines(self) -> list[str]:
        """Write *OUTPUT."""
        lines = [f"*OUTPUT, FIELD, {self.when}", "*NODE OUTPUT", "U, RF"]
        if self.stresses:
            lines += ["*ELEMENT OUTPUT", "S, SDEG"]
        lines.append("*OUTPUT, HISTORY, FREQUENCY=1")
        for name, variables in self.history.items():
            lines += [keyword("NODE OUTPUT", NSET=name), variables]
        return [*lines, "*ENERGY OUTPUT", self.energies] if self.energies else lines


def static_step(
    static: Iterable[float],
    boundary: Iterable[str],
    output: Output,
    *,
    limit: int = 1000,
    unsymmetric: bool = True,
    nlgeom: bool = False,
) -> list[str]:
    """Write *STEP to *END STEP with *STATIC and the default solution controls.

    Parameters
    ----------
    static
        Data line of *STATIC: initial increment, period, smallest and largest increment.
    boundary
        Data lines of *BOUNDARY.
    output
        Output requests.
    limit
        Number of increments allowed.
    unsymmetric, nlgeom
        Options of *STEP.
    """
    flags = [*(["NLGEOM"] if nlgeom else []), *(["UNSYMM=YES"] if unsymmetric else [])]
    lines = [keyword("STEP", *flags, INC=limit), "*STATIC", *table([tuple(float(value) for value in static)])]
    return [*lines, "*BOUNDARY", *boundary, *output.lines(), "*END STEP"]


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
