# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Head of a step in the .msg and .dat files: procedure, tolerances and time incrementation controls."""

from __future__ import annotations

from collections.abc import Iterable

from uel.model.controls import Controls, FieldControls
from uel.model.procedures import HeadLine
from uel.model.records import BucklingMode, HarmonicResponse, IncrementDone, ModeShape
from uel.model.steps import Step
from uel.output.field_terms import FIELDS, FieldTerms
from uel.output.formats import general

# *CONTROLS, FIELD= names a field by its conjugate quantity
CONTROL_NAMES = {
    "force": "DISPLACEMENT",
    "moment": "ROTATION",
    "pore": "PORE FLUID PRESSURE",
    "electrical": "ELECTRICAL POTENTIAL",
    "temperature": "TEMPERATURE",
    "concentration": "CONCENTRATION",
}


def controls_of(field: str, controls: Controls) -> FieldControls:
    """Return the tolerances of a field of the records ('force', ...)."""
    return controls.fields.get(CONTROL_NAMES.get(field, field), controls.default)


def procedure(step: Step) -> str:
    """Return the text on the procedure of the step and its time incrementation."""
    procedure = step.procedure
    lines = [
        f"                        S T E P  {step.number:6d}     {' '.join(procedure.full_title)}",
        "",
        "",
        f"          {step.title}".rstrip(),
        "",
        *map(_head_line, procedure.head()),
    ]
    return "\n".join([*lines, "", ""])


def _head_line(line: HeadLine) -> str:
    """Format a line of the head of a step; a line with others below it is indented less."""
    if isinstance(line, str):
        return f"{' ' * (5 if line.endswith('WITH -') else 10)}{line}"
    words, value = line
    return f"          {words:<51}{value if isinstance(value, str) else general(value)}"


def completed(record: IncrementDone, period: float) -> str:
    """Return the text on the progress of the step after an increment, in time or along a path."""
    match record:
        case BucklingMode():
            return f" MODE{record.increment:6d},  EIGENVALUE{general(record.step_time)}\n"
        case ModeShape():
            return f" MODE{record.increment:6d},  FREQUENCY (CYCLES/TIME){general(record.step_time)}\n"
        case HarmonicResponse():
            return f" FREQUENCY (CYCLES/TIME){general(record.step_time)}\n"
        case IncrementDone(load_factor=None):
            fraction = record.step_time / period
            return (
                f" TIME INCREMENT COMPLETED{general(record.time_increment)},"
                f"  FRACTION OF STEP COMPLETED{general(fraction)}\n"
                f" STEP TIME COMPLETED     {general(record.step_time)},  TOTAL TIME COMPLETED      "
                f"{general(record.total_time)}\n"
            )
        case _:
            assert record.load_factor is not None
            return (
                f" LOAD PROPORTIONALITY FACTOR{general(record.load_factor)},"
                f"  LENGTH OF THE PATH    {general(record.total_time)}\n"
            )


def tolerances(
    step: Step, fields: Iterable[str], *, hybrid: bool = False, coupled: bool = False, contact: bool = False
) -> str:
    """Return the text on the tolerances and time incrementation controls of the step.

    hybrid: the model has hybrid elements; coupled: it has distributing couplings with NLGEOM; contact: it has contact
    pairs.
    """
    if step.procedure.linear:
        return ""
    blocks = [_field(FIELDS[name], controls_of(name, step.controls)) for name in fields]
    if hybrid:
        blocks.append(_row("VOLUMETRIC STRAIN COMPATIBILITY TOLERANCE FOR HYBRID SOLIDS", step.controls.volume))
    if coupled:
        blocks.append(
            _row("DISPLACEMENT COMPATIBILITY TOLERANCE FOR DCOUP ELEMENTS", step.controls.coupling)
            + _row("ROTATION COMPATIBILITY TOLERANCE FOR DCOUP ELEMENTS", step.controls.coupling_rotation)
        )
    if contact and step.convert_sdi:
        blocks.append(" EQUILIBRIUM WILL BE CHECKED FOR SEVERE DISCONTINUITY ITERATIONS\n")
    blocks.append(_time(step, contact=contact))
    search = step.controls.line_search
    if search.n_ls:
        blocks.append(
            " LINE SEARCH CONTROL PARAMETERS:\n"
            + _row("MAXIMUM NUMBER OF LINE SEARCH ITERATIONS", search.n_ls)
            + _row("MAXIMUM CORRECTION SCALE FACTOR", search.s_max)
            + _row("MINIMUM CORRECTION SCALE FACTOR", search.s_min)
            + _row("RESIDUAL REDUCTION FACTOR AT WHICH LINE SEARCHING STOPS", search.f_s)
            + _row("RATIO OF CORRECTION SCALE FACTORS AT WHICH LINE SEARCHING STOPS", search.eta_s)
        )
    options = [f"     THE MAXIMUM NUMBER OF INCREMENTS IN THIS STEP IS{step.increments:24d}\n"]
    if step.nlgeom:
        options.append("          LARGE DISPLACEMENT THEORY WILL BE USED\n")
    if step.unsymmetric or step.procedure.unsymmetric:
        options.append("          UNSYMMETRIC MATRIX STORAGE AND SOLUTION WILL BE USED\n")
    kind = (
        "EXTRAPOLATION WILL NOT" if step.extrapolation in ("NO", "NONE") else f"{step.extrapolation} EXTRAPOLATION WILL"
    )
    options.append(f"     {kind} BE USED\n")
    return "\n".join(blocks + options)


def _row(words: str, value: float) -> str:
    """Format a line of 80 columns: counts end there, tolerances have three digits and factors four."""
    if isinstance(value, int):
        return f"     {words:<70}{value:5d}\n"
    if " FACTOR " in words or " RATIO " in words:
        return f"     {words:<63}{general(value, 12, 4)}\n"
    return f"     {words:<64}{general(value)}\n"


def _field(words: FieldTerms, controls: FieldControls) -> str:
    flux, quantity = f"{words.flux:<9}", f"{words.quantity:<9}"
    rows = [
        (f"CRITERION FOR RESIDUAL {flux} FOR A NONLINEAR PROBLEM", controls.r_n),
        (f"CRITERION FOR {quantity}CORRECTION IN A NONLINEAR PROBLEM", controls.c_n),
    ]
    if controls.q_0:
        rows.append((f"INITIAL VALUE OF TIME AVERAGE {words.flux}", controls.q_0))
    if controls.q_u:
        rows.append((f"TIME AVERAGE {words.flux} IS SET TO", controls.q_u))
    rows += [
        (f"ALTERNATE CRIT. FOR RESIDUAL {flux} FOR A NONLINEAR PROBLEM", controls.r_p),
        (f"CRITERION FOR ZERO {flux} RELATIVE TO TIME AVRG. {words.flux}", controls.eps),
        (f"CRITERION FOR RESIDUAL {flux} WHEN THERE IS ZERO FLUX", controls.eps),
        (f"CRITERION FOR {quantity}CORRECTION WHEN THERE IS ZERO FLUX", controls.c_eps),
        (f"CRITERION FOR RESIDUAL {flux} FOR A LINEAR INCREMENT", controls.r_l),
        ("FIELD CONVERSION RATIO", controls.c_f),
        (f"CRITERION FOR ZERO {flux} REL. TO TIME AVRG. MAX. {words.flux}", controls.eps_l),
    ]
    return f" CONVERGENCE TOLERANCE PARAMETERS FOR {words.flux}\n" + "".join(_row(*row) for row in rows)


def _time(step: Step, *, contact: bool) -> str:
    controls, procedure = step.controls.time, step.procedure
    most = (controls.i_s_c, controls.i_j_c) if step.convert_sdi else (controls.i_s, controls.i_j)
    first: list[tuple[str, float]] = [("FIRST EQUILIBRIUM ITERATION FOR CONSECUTIVE DIVERGENCE CHECK", controls.i_0)]
    alternate = ("EQUILIBRIUM ITERATION AFTER WHICH ALTERNATE RESIDUAL IS USED", controls.i_p)
    largest = ("MAXIMUM EQUILIBRIUM ITERATIONS ALLOWED", controls.i_c)
    if procedure.direct:
        return " ITERATION CONTROL PARAMETERS:\n" + "".join(_row(*row) for row in [*first, alternate, largest])
    rows = [
        *first,
        ("EQUILIBRIUM ITERATION AT WHICH LOG. CONVERGENCE RATE CHECK BEGINS", controls.i_r),
        alternate,
        largest,
        ("EQUILIBRIUM ITERATION COUNT FOR CUT-BACK IN NEXT INCREMENT", controls.i_l),
        ("MAXIMUM EQUILIB. ITERS IN TWO INCREMENTS FOR TIME INCREMENT INCREASE", controls.i_g),
        *([("MAXIMUM ITERATIONS FOR SEVERE DISCONTINUITIES", most[0])] if contact else []),
        ("MAXIMUM ATTEMPTS ALLOWED IN AN INCREMENT", controls.i_a),
        *([("MAXIMUM DISCON. ITERS IN TWO INCREMENTS FOR TIME INCREMENT INCREASE", most[1])] if contact else []),
        ("CUT-BACK FACTOR AFTER DIVERGENCE", controls.d_f),
        ("CUT-BACK FACTOR FOR TOO SLOW CONVERGENCE", controls.d_c),
        ("CUT-BACK FACTOR AFTER TOO MANY EQUILIBRIUM ITERATIONS", controls.d_b),
        *([("CUT-BACK FACTOR AFTER TOO MANY SEVERE DISCONTINUITY ITERATIONS", controls.d_s)] if contact else []),
        ("CUT-BACK FACTOR AFTER PROBLEMS IN ELEMENT ASSEMBLY", controls.d_h),
        ("INCREASE FACTOR AFTER TWO INCREMENTS THAT CONVERGE QUICKLY", controls.d_d),
        ("MAX. TIME INCREMENT INCREASE FACTOR ALLOWED", getattr(controls, procedure.growth)),
        ("MINIMUM TIME INCREMENT RATIO FOR EXTRAPOLATION TO OCCUR", controls.d_e),
    ]
    return " TIME INCREMENTATION CONTROL PARAMETERS:\n" + "".join(_row(*row) for row in rows)
