# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measured times of the linear solvers, for `auto`, `uel solvers` and solvers.md.

`tests/programs/benchmarks/solvers.py` measures them.
"""

from __future__ import annotations

import json
import platform
from dataclasses import asdict, dataclass
from datetime import date
from pathlib import Path
from typing import Final

ROWS: Final = Path(__file__).with_name("measured.json")
PAGE: Final = Path(__file__).with_name("solvers.md")

BEGIN, END = "<!-- rows of tests/programs/benchmarks/solvers.py -->", "<!-- end of the rows -->"

HEADER: Final = ("matrix", "unknowns", "half bandwidth", "solver", "first", "in full", "in part", "solution", "GMRES")
"""Head of the table; times are CPU times in ms."""


@dataclass(frozen=True, slots=True)
class Measured:
    """Times of a solver on a matrix: CPU times in ms.

    width       half bandwidth
    first       first factorisation with the analysis, or set-up
    full        factorisation of another matrix, None if there is none
    part        factorisation of one that differs in the process zone of a crack, None if the solver does it in full
    solution    solution for one right-hand side
    iterations  of GMRES on the matrix that differs, preconditioned by the factors of the one before; or those of an
                iterative solver
    """

    matrix: str
    unknowns: int
    width: int
    solver: str
    first: float
    full: float | None
    part: float | None
    solution: float
    iterations: int

    @property
    def cells(self) -> tuple[str, ...]:
        """Cells of the table, as `HEADER` names them."""
        times = (_time(value) for value in (self.first, self.full, self.part, self.solution))
        return self.matrix, f"{self.unknowns:,}", str(self.width), self.solver, *times, str(self.iterations)


Table = tuple[str, list[Measured]]
"""Machine and date, and the rows."""


def _time(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}" if value < 10.0 else f"{value:,.0f}"


def machine() -> str:
    """Describe this machine and the date, for the table."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.partition(":")[2].strip() for line in cpuinfo.read_text().splitlines() if "model name" in line]
        model = names[0] if names else model
    return f"{model}, {date.today():%d %B %Y}"


def read() -> Table:
    """Read the stored rows."""
    kept = json.loads(ROWS.read_text(encoding="utf-8"))
    return kept["machine"], [Measured(**row) for row in kept["rows"]]


def write(table: Table) -> None:
    """Store rows, and write them into the page."""
    kept = {"machine": table[0], "rows": [asdict(row) for row in table[1]]}
    ROWS.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8"), table), encoding="utf-8")


def page(text: str, table: Table) -> str:
    """Replace the rows in the page by these."""
    name, rows = table
    lines = [HEADER, ("---",) * len(HEADER), *(row.cells for row in rows)]
    body = "\n".join("| " + " | ".join(cells) + " |" for cells in lines)
    return replaced(text, BEGIN, f"{name}:\n\n{body}")


def replaced(text: str, begin: str, body: str) -> str:
    """Replace the body of the page between the line `begin` and the next line `END`."""
    before, _, rest = text.partition(begin)
    after = rest.partition(END)[2]
    return f"{before}{begin}\n\n{body}\n\n{END}{after}"
