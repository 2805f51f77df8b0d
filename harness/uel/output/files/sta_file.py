# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Status file (.sta): a line per increment and per abandoned attempt, as Abaqus prints it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from uel.output.formats import TextFile, program, status_number

HEADER = """\
 SUMMARY OF JOB INFORMATION:
 STEP  INC ATT SEVERE EQUIL TOTAL  TOTAL      STEP       INC OF       DOF    IF
               DISCON ITERS ITERS  TIME/    TIME/LPF    TIME/LPF    MONITOR RIKS
               ITERS               FREQ
"""
COMPLETED = " THE ANALYSIS HAS COMPLETED SUCCESSFULLY"
NOT_COMPLETED = " THE ANALYSIS HAS NOT BEEN COMPLETED"

RIKS_COLUMN = HEADER.index("IF\n") - HEADER.index(" STEP")
"""Column of the R of an increment along a path, below IF RIKS."""

_ROW = re.compile(
    r"^ *(\d+) +(\d+) +(\d+)(U?) +(\d+) +(\d+) +(\d+) +([\d.eE+-]+) +([\d.eE+-]+) +([\d.eE+-]+)"
    r"(?: +([\d.eE+-]+))?(?: +(R))?"
)


@dataclass(frozen=True, slots=True)
class StatusRow:
    """Line of the status file.

    An abandoned attempt (`cutback`) has the times of its start, a converged one those of its end. `monitor` is the
    value of the degree of freedom of *MONITOR, if there is one. With `riks` the step time is the load proportionality
    factor, and the total time the length of the path.
    """

    step: int
    increment: int
    attempt: int
    cutback: bool
    iterations: int
    total_time: float
    step_time: float
    time_increment: float
    monitor: float | None = None
    severe_discontinuity_iterations: int = 0
    riks: bool = False

    @property
    def total_iterations(self) -> int:
        """Iterations of both kinds."""
        return self.iterations + self.severe_discontinuity_iterations

    def __str__(self) -> str:
        text = (
            f"{self.step:4d}{self.increment:6d}{self.attempt:4d}{'U' if self.cutback else ' '}"
            f"{self.severe_discontinuity_iterations:5d}{self.iterations:6d}{self.total_iterations:6d}  "
            f"{status_number(self.total_time, 3):<11}{status_number(self.step_time, 3):<11}"
            f"{status_number(self.time_increment, 4):<10}"
        )
        if self.monitor is not None:
            text += f"{status_number(self.monitor, 3):<10}"
        return f"{text:<{RIKS_COLUMN}}R" if self.riks else text

    @classmethod
    def read(cls, line: str) -> StatusRow | None:
        """Read the row of a line, None for a line that is not a row."""
        match = _ROW.match(line)
        if match is None:
            return None
        step, increment, attempt, flag, severe, iterations, _, total, step_time, size, monitor, riks = match.groups()
        return cls(
            int(step),
            int(increment),
            int(attempt),
            flag == "U",
            int(iterations),
            float(total),
            float(step_time),
            float(size),
            None if monitor is None else float(monitor),
            int(severe),
            riks is not None,
        )


def head() -> str:
    """Return the first lines of the file, with the current date."""
    now = datetime.now()
    return f" {program()}                  DATE {now:%d-%b-%Y} TIME {now:%H:%M:%S}\n{HEADER}"


class StatusFile:
    """Writer of NAME.sta."""

    def __init__(self, path: Path) -> None:
        self._file = TextFile(path)
        self._file.write(head())

    def write(self, row: StatusRow) -> None:
        """Append a line."""
        self._file.write(f"{row}\n")

    def close(self, *, completed: bool) -> None:
        """Write the last line."""
        self._file.write(f"{' ' * 26}\n{COMPLETED if completed else NOT_COMPLETED}\n")
        self._file.close()


def read_status(path: Path) -> list[StatusRow]:
    """Read the rows of a status file of this program or of Abaqus, without an incomplete last line."""
    lines = path.read_text("utf-8", errors="replace").splitlines(keepends=True)
    rows = [StatusRow.read(line) for line in lines if line.endswith("\n")]
    return [row for row in rows if row is not None]


def has_completed(path: Path) -> bool:
    """Return whether the analysis has completed, according to the status file."""
    return COMPLETED in path.read_text("utf-8", errors="replace").splitlines()
