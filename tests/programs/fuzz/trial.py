# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One damaged deck through the harness: read, and some of them build, with one attempt at an increment if small.

A trial is good if the deck runs, or ends with an error that the user can fix and that names its place. The kernels are
the project's own, whatever the deck was written for. Nothing after the first attempt counts: a deck that is still valid
may run as long as it likes.
"""

from __future__ import annotations

import os
import re
import stat
import traceback
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

from corpus import DECK, Case
from mutations import ODD_FILES

from uel.assembly import System
from uel.deck import read_deck
from uel.errors import DeckError, UelError
from uel.model.records import AttemptAbandoned, IncrementDone, Record
from uel.procedures import run_steps
from uel.running import job
from uel.running.options import RoutineOptions

MOST_UNKNOWNS = 2000
"""A model with more is read, checked and built, but not solved."""
_PLACE = re.compile(r"[^:]+:\d+: \S")
OWN_FRAME = re.compile(r'File ".*/(harness/uel/\S+\.py)", line (\d+)')


def first_attempt(system: System, *arguments: Any, **options: Any) -> Iterator[Record]:
    """Records of a run up to the end of the first attempt at an increment."""
    if len(system) <= MOST_UNKNOWNS:
        for record in run_steps(system, *arguments, **options):
            yield record
            if isinstance(record, IncrementDone | AttemptAbandoned):
                return


def make_odd_files(folder: Path) -> None:
    """Create the files of ODD_FILES."""
    os.mkfifo(folder / "pipe")
    os.mknod(folder / "socket", stat.S_IFSOCK | 0o600)
    (folder / "loop").symlink_to("loop")
    (folder / "folder").mkdir()


@patch.object(job, "run_steps", first_attempt)
def run(case: Case, folder: Path) -> tuple[str, str]:
    """Kind of the outcome and its text: 'runs', 'reads', 'refused' and 'stopped' are good, any other is a finding."""
    for name, content in case.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    if any(name.encode() in content for content in case.files.values() for name in ODD_FILES):
        make_odd_files(folder)
    try:
        if not case.runs:
            read_deck(folder / DECK)
            return "reads", ""
        job.run(folder / DECK, job="job", output_dir=folder / "output", routines=RoutineOptions(call_limit=5.0))
    except DeckError as error:
        lines = str(error).splitlines()
        vague = next((line for line in lines if not _PLACE.match(line)), None)
        return ("refused", "") if vague is None else (f"no place: {vague[:80]}", str(error))
    except UelError as error:
        return ("stopped", "") if str(error).strip() else (f"no message: {type(error).__name__}", "")
    except Exception as error:
        text = traceback.format_exc()
        frames = OWN_FRAME.findall(text)
        where = ":".join(frames[-1]) if frames else "?"
        return f"{type(error).__name__} at {where}", text
    return "runs", ""
