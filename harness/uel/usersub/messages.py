# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Messages of user routines: STDB_ABQERR, and output to units 6 (.dat) and 7 (.msg)."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Final
from weakref import WeakSet

from uel.errors import UelError
from uel.usersub import _binding

MOST: Final = 1 << 26
"""Bytes of a unit that are read at once: an endless loop prints more than memory holds."""

_LAST: Final = 3
"""Number of printed lines that a message quotes."""

_LOCKED: Final = "an abandoned call inside a WRITE has unit 6 or 7 locked"

_KINDS = {1: "note", -1: "warning", -2: "error", -3: "error"}


@dataclass(frozen=True, slots=True)
class Message:
    """Message of a user routine.

    file      '.msg' or '.dat': where Abaqus puts it
    kind      'note', 'warning', 'error' (STDB_ABQERR) or 'print' (written to unit 6 or 7)
    element, step, increment  of the call that sent it; 0 where not known
    """

    file: str
    kind: str
    text: str
    element: int = 0
    step: int = 0
    increment: int = 0


class Inbox:
    """Inbox of the messages of a job. Units 6 and 7 are JOB.unit6 and JOB.unit7, removed once all has been read.

    With the rank after these names in all processes of a job but the first.
    """

    _current: ClassVar[Inbox | None] = None
    """The job that owns the units, of which the process has one set."""

    _open: ClassVar[WeakSet[Inbox]] = WeakSet()
    """Those of the jobs of this process that have not ended: the host keeps their materials."""

    def __init__(self, job: str, directory: Path, rank: int = 0) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        suffix = f".{rank}" if rank else ""
        self._files = {".dat": directory / f"{job}.unit6{suffix}", ".msg": directory / f"{job}.unit7{suffix}"}
        self._read = dict.fromkeys(self._files, 0)
        self._sent: list[Message] = []
        folder = str(directory.resolve())
        alone = not Inbox._open
        Inbox._open.add(self)
        Inbox._current = self
        failed = _binding.open_job(job, folder, *(str(f.resolve()) for f in self._files.values()), alone=alone)
        if failed > 0:
            raise UelError(f"cannot write {self._files['.dat']} and {self._files['.msg']}: {os.strerror(failed)}")
        self._lost = failed < 0
        if self._lost:
            self.warn(f"{_LOCKED} since an earlier run: text printed there is lost")

    def take(self) -> list[Message]:
        """Return all messages since the last call."""
        self._collect()
        self._print()
        messages, self._sent = self._sent, []
        return sorted(messages, key=lambda message: message.kind == "print")

    def last_error(self) -> str:
        """Return the text of the latest error or fatal error not yet read; '' if there is none."""
        self._collect()
        return next((m.text for m in reversed(self._sent) if m.kind == "error"), "")

    def last_lines(self) -> list[str]:
        """Return the last lines printed to unit 7, or else to unit 6, and not yet read."""
        self._print()
        printed = {m.file: m.text.split("\n") for m in self._sent if m.kind == "print"}
        lines = [line.strip() for line in printed.get(".msg", printed.get(".dat", [])) if line.strip()]
        return lines[-_LAST:]

    def warn(self, text: str) -> None:
        """Add a warning of the harness."""
        self._sent.append(Message(".msg", "warning", text))

    def close(self) -> None:
        """Disconnect the units; remove their files unless they hold text that nobody has read."""
        Inbox._open.discard(self)
        if Inbox._current is self:
            _binding.flush_units(close=True)
            Inbox._current = None
        for file, path in self._files.items():
            if path.exists() and path.stat().st_size <= self._read[file]:
                path.unlink()

    def _collect(self) -> None:
        for raw in _binding.take_messages():
            kind = _KINDS.get(raw.level, "note")
            self._sent.append(Message(".msg", kind, raw.text, raw.element, raw.step, raw.increment))

    def _print(self) -> None:
        """Read the output to the units."""
        if not self._lost and not _binding.flush_units():
            self._lost = True
            self.warn(f"{_LOCKED}: the last text printed there is lost")
        for file, path in self._files.items():
            try:
                unread = path.stat().st_size - self._read[file]
            except FileNotFoundError:
                continue
            if unread <= 0:
                continue
            with path.open("rb") as stream:
                stream.seek(self._read[file])
                text = stream.read(min(unread, MOST))
            if unread > MOST:
                self.warn(f"more was printed than is read at once: what is left at the end stays in {path.name}")
            self._read[file] += len(text)
            self._sent.append(Message(file, "print", text.decode(errors="replace")))
