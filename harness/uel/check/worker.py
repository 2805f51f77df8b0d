# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Entry point TASK SNAPSHOT of the separate process, which user code may end (`uel.running.worker`)."""

from __future__ import annotations

import pickle
import resource
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from uel.check.progress import Running, Snapshot
from uel.errors import UelError, in_words
from uel.usersub import limit_calls

INTERRUPTED: Final = 130
"""Exit code after an interrupt from the keyboard."""


def main(words: Sequence[str]) -> int:
    """Call the function of the file TASK and save its outcome in the file SNAPSHOT; returns the exit code."""
    task, file = map(Path, words)
    function, arguments, options, call_limit = pickle.loads(task.read_bytes())
    limit_calls(call_limit)
    # a user element that leaves files open must be found before the system refuses to open more
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))

    def keep(snapshot: Snapshot) -> None:
        # written whole or not at all
        fresh = file.with_suffix(".new")
        fresh.write_bytes(pickle.dumps(snapshot))
        fresh.replace(file)

    def progress(running: Running, outcome: object = None) -> None:
        keep(Snapshot(running, outcome))

    try:
        keep(Snapshot(None, function(*arguments, progress=progress, **options)))
    except (UelError, OSError, MemoryError) as error:
        keep(Snapshot(None, error=in_words(error), notes=tuple(getattr(error, "__notes__", ()))))
    except KeyboardInterrupt:
        return INTERRUPTED
    return 0
