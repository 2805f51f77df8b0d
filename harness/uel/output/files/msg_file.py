# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Message file (.msg): tolerances of each step, then every iteration with its checks, as Abaqus prints them.

Layout and wording follow the message files of Abaqus 6.14 to 2024, without the figures of the solver (equations,
operations). The wording of the checks of hybrid elements and distributing couplings is our own.
"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Final

from uel.model.contact import CONTACT, ContactChanges
from uel.model.couplings import COUPLING
from uel.model.element_types import ContinuumType
from uel.model.model import Model
from uel.model.records import (
    AttemptAbandoned,
    AttemptStarted,
    Convergence,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Largest,
    SearchHelped,
    StepDone,
    StepStarted,
)
from uel.output.field_terms import FIELDS, FieldTerms, fields_of
from uel.output.formats import TextFile, engineering, general, program, remark
from uel.output.step_header import completed, procedure, tolerances

WRITTEN: Final = "ALL OUTPUT REQUESTS HAVE BEEN WRITTEN FOR THE LAST CONVERGED INCREMENT."
LOST: Final = "THE OUTPUT REQUESTED FOR INCREMENT {0.increment} OF STEP {0.step} COULD NOT BE WRITTEN."


class MessageFile:
    """Writer of NAME.msg; `warnings` are those in it."""

    def __init__(self, path: Path, model: Model) -> None:
        self._model = model
        self._file = TextFile(path)
        self._fields = fields_of(model)
        kinds = [group.built_in for group in model.groups]
        self._hybrid = any(isinstance(kind, ContinuumType) and kind.pressures for kind in kinds)
        self._touches, self._coupled = bool(model.contacts), bool(model.couplings)
        self._started = (time.perf_counter(), time.process_time())
        self.warnings: list[str] = []
        self._counts = dict.fromkeys(("increments", "cutbacks", "iterations", "searches", "helped", "errors"), 0)

    def step_started(self, record: StepStarted) -> None:
        """Write the head of a step: tolerances and controls."""
        step = self._model.steps[record.step - 1]
        now = datetime.now()
        limits = {"hybrid": self._hybrid, "coupled": self._coupled, "contact": self._touches}
        self._file.write(
            f"1\n\n   {program()}                                  Date {now:%d-%b-%Y}   Time {now:%H:%M:%S}\n\n"
            f" {self._model.heading}".rstrip()
            + "\n\n"
            f" STEP {step.number:4d}     INCREMENT     1     STEP TIME {general(0.0)}\n\n\n"
            f"{procedure(step)}{tolerances(step, self._fields, **limits)}"
        )

    def attempt_started(self, record: AttemptStarted) -> None:
        """Write the first line of an attempt."""
        along_path = self._model.steps[record.step - 1].procedure.riks is not None
        self._file.write(
            f"\n\n  INCREMENT{record.increment:6d} STARTS. ATTEMPT NUMBER{record.attempt:3d}, "
            f"{'ARC LENGTH' if along_path else 'TIME'} INCREMENT{general(record.time_increment)}\n"
        )

    def iteration(self, record: IterationDone) -> None:
        """Write the block of one iteration: a paragraph for each field."""
        self._counts["iterations"] += 1
        self._counts["searches"] += max(len(record.line_search) - 1, 0)
        kind = "SEVERE DISCONTINUITY" if record.severe else "EQUILIBRIUM"
        text = _changes(record.contact)
        text += f"\n               CONVERGENCE CHECKS FOR {kind} ITERATION{record.iteration:6d}\n\n"
        if len(record.line_search) > 1:
            text += "\n CORRECTION SCALE FACTORS OF THE LINE SEARCH" + "".join(map(general, record.line_search)) + "\n"
        contact = [self._contact(check, severe=record.severe) for check in record.checks if check.field == CONTACT]
        others = [self._check(check) for check in record.checks if check.field != CONTACT]
        self._file.write("".join([text, *contact, *others]))

    def abandoned(self, record: AttemptAbandoned) -> None:
        """Write the reason why an attempt was abandoned."""
        if record.next_increment > 0.0:
            self._counts["cutbacks"] += 1
        self._file.write(f" \n\n{remark('NOTE', record.reason)}")

    def helped(self, record: SearchHelped) -> None:
        """Write a note on an increment for which the descent search took over."""
        self._counts["helped"] += 1
        text = (
            f"EQUILIBRIUM FOUND WITH THE DESCENT SEARCH, WHICH TOOK OVER IN ITERATION {record.since} OF "
            f"{record.iterations}: {record.reason}"
        )
        self._file.write(f" \n\n{remark('NOTE', text)}")

    def increment(self, record: IncrementDone) -> None:
        """Write the summary of a converged increment."""
        self._counts["increments"] += 1
        period = self._model.steps[record.step - 1].procedure.period
        grows, path = "", record.load_factor
        if record.next_increment > record.time_increment and path is None:
            grows = f"          TIME INCREMENT MAY NOW INCREASE TO  {general(record.next_increment)}\n"
        severe, calm = record.severe, record.iterations
        self._file.write(
            f"{grows}\n ITERATION SUMMARY FOR THE INCREMENT:{severe + calm:4d} TOTAL ITERATIONS, OF WHICH\n"
            f"{severe:4d} ARE SEVERE DISCONTINUITY ITERATIONS AND{calm:3d} ARE EQUILIBRIUM ITERATIONS.\n\n"
            f"{completed(record, period)}"
        )

    def step_done(self, record: StepDone) -> None:
        """Write the totals of a step."""
        self._file.write(
            f"\n\n STEP{record.step:4d} IS COMPLETE:{record.increments:6d} INCREMENTS,{record.cutbacks:5d} CUTBACKS,"
            f"{record.iterations:6d} ITERATIONS\n"
        )

    def remark(self, kind: str, text: str) -> None:
        """Write a note, warning or error."""
        if kind == "WARNING":
            self.warnings.append(text)
        elif kind == "ERROR":
            self._counts["errors"] += 1
        self._file.write(f" \n\n{remark(kind, text)}")

    def text(self, text: str) -> None:
        """Write the text of a user routine, unchanged."""
        self._file.write_lines(text)

    def close(self, error: str | None, lost: IncrementDone | None = None) -> None:
        """Write verdict, summary and times of the job; lost: converged increment whose output could not be written."""
        if error is None:
            self._file.write("\n\n          THE ANALYSIS HAS BEEN COMPLETED\n")
        else:
            self.remark("ERROR", error)
            output = LOST.format(lost) if lost else WRITTEN
            self.remark("ERROR", f"THE ANALYSIS HAS BEEN TERMINATED DUE TO PREVIOUS ERRORS. {output}")
        self._file.write(self._summary())
        self._file.close()

    def _check(self, check: FieldCheck) -> str:
        if check.field == COUPLING:
            return self._coupling(check)
        if check.residual.element:
            return (
                f"\n{' LARGEST VOLUMETRIC STRAIN ERROR':<34}{general(check.residual.value)}   IN HYBRID ELEMENT "
                f"{check.residual.element}\n          THE VOLUMETRIC STRAIN COMPATIBILITY EQUATIONS HAVE "
                f"{'' if check.verdict.accepted else 'NOT '}CONVERGED\n"
            )
        words = FIELDS.get(check.field) or FieldTerms(check.field.upper(), check.field.upper())
        flux = words.flux
        text = (
            f"\n{f' AVERAGE {flux}':<34}{general(check.average_flux)}   {f'TIME AVG. {flux}':<19} "
            f"{general(check.time_average_flux)}{_origin(check)}\n"
        )
        text += self._largest(f" LARGEST RESIDUAL {flux}", f" ALL {flux:<9} RESIDUALS ARE ZERO", check.residual)
        quantity = words.quantity
        text += self._largest(
            f" LARGEST INCREMENT OF {quantity}", f" ALL {quantity:<9}INCREMENTS ARE ZERO", check.increment
        )
        text += self._largest(
            f" LARGEST CORRECTION TO {quantity}", f" ALL CORRECTION TO {quantity:<9}ARE ZERO", check.correction
        )
        if check.verdict is Convergence.ACCEPTED_ESTIMATE and check.estimated_correction is not None:
            text += f"{f' ESTIMATE OF {quantity:<9}CORRECTION':<34}{general(check.estimated_correction)}\n"
        return text + f"{_verdict(check.verdict, words)}\n"

    def _coupling(self, check: FieldCheck) -> str:
        """Return the errors of distributing couplings, a line for displacements and one for rotations."""
        errors = {"DISPLACEMENT": check.residual, "ROTATION": check.correction}
        lines = [
            f"{f' LARGEST {words} ERROR':<34}{general(largest.value)}   AT REFERENCE NODE "
            f"{self._model.mesh.name(largest.node)}\n"
            for words, largest in errors.items()
        ]
        verdict = "" if check.verdict.accepted else "NOT "
        return "".join(["\n", *lines, f"          THE DISTRIBUTING COUPLING EQUATIONS HAVE {verdict}CONVERGED\n"])

    def _contact(self, check: FieldCheck, *, severe: bool) -> str:
        """Return the errors of the contact constraints, in two lines and a verdict."""
        errors = {"MAX. PENETRATION ERROR": check.residual, "MAX. CONTACT FORCE ERROR": check.correction}
        lines = [
            f"   {words} {engineering(largest.value)} AT NODE {self._model.mesh.name(largest.node)} OF CONTACT PAIR\n"
            f"   {largest.element}\n"
            for words, largest in errors.items()
        ]
        within = "THE CONTACT CONSTRAINT ERRORS ARE WITHIN THE TOLERANCES." if severe else _CONSTRAINED
        verdict = {Convergence.NOT_ACHIEVED: _PENETRATION, Convergence.CORRECTION_TOO_LARGE: _FORCE_ERROR}
        return "".join([*lines, f"          {verdict.get(check.verdict, within)}\n"])

    def _largest(self, words: str, all_zero: str, largest: Largest) -> str:
        if largest.value == 0.0 or largest.node < 0:
            return f"{all_zero}\n"
        mesh = self._model.mesh
        text = f"{words:<34}{general(largest.value)}   AT NODE{mesh.labels[largest.node]:11d}   DOF{largest.dof:3d}\n"
        instance = mesh.instances[largest.node]
        return f"{text}   INSTANCE: {instance}\n" if instance else text

    def _summary(self) -> str:
        counts = self._counts
        wall, cpu = time.perf_counter() - self._started[0], time.process_time() - self._started[1]
        rows = (
            (counts["cutbacks"], "CUTBACKS IN AUTOMATIC INCREMENTATION"),
            (counts["iterations"], "ITERATIONS INCLUDING CONTACT ITERATIONS IF PRESENT"),
            (counts["searches"], "ADDITIONAL RESIDUAL EVALUATIONS FOR LINE SEARCHES"),
            *([(counts["helped"], "INCREMENTS THAT NEEDED THE DESCENT SEARCH")] if counts["helped"] else []),
            (len(self._model.warnings), "WARNING MESSAGES DURING USER INPUT PROCESSING"),
            (len(self.warnings), "WARNING MESSAGES DURING ANALYSIS"),
            (counts["errors"], "ERROR MESSAGES"),
        )
        return (
            f"\n\n\n     ANALYSIS SUMMARY:\n     TOTAL OF {counts['increments']:10d}  INCREMENTS\n"
            + "".join(f"{count:24d}  {words}\n" for count, words in rows)
            + "\n\n\n     JOB TIME SUMMARY\n"
            + f"       TOTAL CPU TIME (SEC) ={general(cpu, 13, 5)}\n"
            + f"       WALLCLOCK TIME (SEC) ={general(wall, 13, 5)}\n"
        )


def read_times(path: Path) -> tuple[float, float] | None:
    """Read the processor time and wall-clock time of a job in seconds from its message file.

    None if that was not written to its end.
    """
    if not path.exists():
        return None
    with path.open("rb") as file:
        file.seek(max(file.seek(0, os.SEEK_END) - _LONGEST_END, 0))
        times = _TIMES.findall(file.read())
    return (float(times[-1][0]), float(times[-1][1])) if times else None


_TIMES: Final = re.compile(rb"TOTAL CPU TIME \(SEC\) = *(\S+)\s+WALLCLOCK TIME \(SEC\) = *(\S+)")
_LONGEST_END: Final = 4096
"""Bytes at the end of the file with the times of a job."""


_CONSTRAINED: Final = "THE CONTACT CONSTRAINTS HAVE CONVERGED."
_PENETRATION: Final = "PENETRATION ERROR TOO LARGE COMPARED TO DISPLACEMENT INCREMENT."
_FORCE_ERROR: Final = "THE ESTIMATED CONTACT FORCE ERROR IS OUTSIDE THE TOLERANCE."


def _changes(contact: Sequence[ContactChanges]) -> str:
    """Count the status changes of an iteration in all contact pairs; '' if there are none."""
    rows = {
        "SEVERE DISCONTINUITIES OCCURRED DURING THIS ITERATION.": sum(changes.count for changes in contact),
        "POINTS CHANGED FROM OPEN TO CLOSED": sum(changes.closed for changes in contact),
        "POINTS CHANGED FROM CLOSED TO OPEN": sum(changes.opened for changes in contact),
        "POINTS CHANGED FROM SLIPPING TO STICKING": sum(changes.sticking for changes in contact),
        "POINTS CHANGED FROM STICKING TO SLIPPING": sum(changes.slipping for changes in contact),
    }
    lines = "".join(f"{count:21d} {words}\n" for words, count in rows.items() if count)
    return f"\n{lines}" if lines else ""


def _origin(check: FieldCheck) -> str:
    """Return the origin of a time average that does not come from the flux of the field itself."""
    if not check.converted:
        return ""
    return f" FROM {'MOMENT' if check.field == 'force' else 'FORCE'} FIELD"


def _verdict(verdict: Convergence, words: FieldTerms) -> str:
    """Return the sentence of a verdict."""
    flux, quantity = f"{words.flux:<9}", f"{words.quantity:<9}"
    return {
        Convergence.LINEAR: f"          THE {flux} EQUILIBRIUM RESPONSE WAS LINEAR IN THIS INCREMENT",
        Convergence.ZERO_FLUX: f"          THERE IS ZERO {flux} EVERYWHERE",
        Convergence.NOT_ACHIEVED: f"          {flux} EQUILIBRIUM NOT ACHIEVED WITHIN TOLERANCE.",
        Convergence.CONVERGED: f"          THE {flux} EQUILIBRIUM EQUATIONS HAVE CONVERGED",
        Convergence.ACCEPTED_ESTIMATE: f" {flux} EQUILIB. ACCEPTED BASED ON SMALL RESIDUAL AND ESTIMATED CORRECTION",
        Convergence.CORRECTION_TOO_LARGE: f"          {quantity}CORRECTION TOO LARGE COMPARED TO {quantity}INCREMENT",
    }[verdict]
