# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The process in which a function is called that user code may end: `python -m harness.check.worker TASK SNAPSHOT`."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path
from typing import Final

from harness.check.progress import Running, Snapshot
from harness.errors import UelError
from harness.usersub import limit_calls

INTERRUPTED: Final = 130
"""Exit code after an interrupt from the keyboard."""


def _work(task: Path, file: Path) -> int:
    """Call a function as asked for."""
    function, arguments, options, call_limit = pickle.loads(task.read_bytes())
    limit_calls(call_limit)

    def keep(snapshot: Snapshot) -> None:
        # whole, or not at all
        fresh = file.with_suffix(".new")
        fresh.write_bytes(pickle.dumps(snapshot))
        fresh.replace(file)

    def progress(running: Running, outcome: object = None) -> None:
        keep(Snapshot(running, outcome))

    try:
        keep(Snapshot(None, function(*arguments, progress=progress, **options)))
    except UelError as error:
        keep(Snapshot(None, error=str(error)))
    except OSError as error:
        keep(Snapshot(None, error=f"{error.filename or ''}: {error.strerror or error}"))
    except MemoryError:
        keep(Snapshot(None, error="not enough memory for this model"))
    except KeyboardInterrupt:
        return INTERRUPTED
    return 0


if __name__ == "__main__":
    sys.exit(_work(Path(sys.argv[1]), Path(sys.argv[2])))
