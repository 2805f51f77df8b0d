# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs several decks on the ranks of one `mpiexec`, which saves the start of Python for each.

python on_ranks.py JOBS.json: a list of arguments of `uel.run` by name, with those of SolverOptions in `solver`. Rank 0
prints what each run ends with.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import uel
from uel.errors import SilentError, UelError
from uel.parallel import launched
from uel.parallel.mpi import MpiRanks


class SeveralJobs(MpiRanks):
    """Ranks that go on after a job."""

    def close(self) -> None:
        self._together = None


ranks = SeveralJobs(launched())
for job in json.loads(Path(sys.argv[1]).read_text()):
    try:
        solver = uel.SolverOptions(**job.pop("solver", {}))
        uel.run(**job, solver=solver, ranks=ranks)
        end = "completed"
    except SilentError:
        continue
    except UelError as error:
        end = str(error)
    if not ranks.rank:
        print(json.dumps(end), flush=True)
MpiRanks.close(ranks)
