# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors that the user can fix: each message is complete in itself and is printed without a traceback."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final


@dataclass(frozen=True, slots=True)
class Source:
    """Place in a deck, for messages: file as the user named it, and line number from 1; 0 stands for the whole file."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


class UelError(Exception):
    """Base of every error with a message for the user."""

    def __reduce__(self) -> tuple[object, ...]:
        # those that make their message of other arguments cannot be made of it again, in another process
        return _restored, (type(self), self.args, vars(self))


def _restored(kind: type[UelError], arguments: tuple[object, ...], attributes: dict[str, object]) -> UelError:
    """Return an error that comes from another process, with its notes."""
    error = kind.__new__(kind, *arguments)
    vars(error).update(attributes)
    return error


class UsageError(UelError):
    """A word of the command line, or an argument of a function, is not valid."""


class SilentError(UelError):
    """A process ends with others of its job, one of which says why."""

    def __init__(self, code: int) -> None:
        super().__init__("another process of the job says why it has ended")
        self.code = code


def in_words(error: BaseException) -> str:
    """Describe an error for a user: an error of ours, a system error, lack of memory, or an interrupt."""
    if isinstance(error, UelError):
        return str(error)
    if isinstance(error, OSError):
        file = f"{_shown(os.fsdecode(error.filename))}: " if isinstance(error.filename, str | bytes) else ""
        return f"{file}{error.strerror or error}"
    if isinstance(error, MemoryError):
        return "not enough memory for this model"
    if isinstance(error, KeyboardInterrupt):
        return f"{error}" or "interrupted"
    return f"{type(error).__name__}: {error}"


SPEAKER: Final = "uel: "
"""Beginning of each error of the command."""


def tell_error(text: str, stream: IO[str] | None = None) -> None:
    """Print an error of the command, to stderr unless there is another stream, as far as that is possible."""
    with suppress(OSError):
        print(f"{SPEAKER}{text}", file=sys.stderr if stream is None else stream, flush=True)


def tell(text: str) -> None:
    """Print what a command has to say, if possible: its exit code does not depend on that."""
    try:
        print(text, flush=True)
    except OSError:
        drop_output()


def drop_output() -> None:
    """Give up standard output, which takes no more; Python does not try to write the rest at exit either."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


MOST_REPEATED: Final = 5
"""Warnings that the end of a command repeats."""


def note_warnings(error: BaseException, warnings: Sequence[str], rest: str = "") -> None:
    """Give an error notes of earlier warnings, which often tell its reason.

    Parameters
    ----------
    error
        Gets the notes.
    warnings
        Of which the first MOST_REPEATED are repeated.
    rest
        Where the others are: ' in job.dat and .msg'.
    """
    for warning in warnings[:MOST_REPEATED]:
        error.add_note(f"earlier warning: {warning}")
    if len(warnings) > MOST_REPEATED:
        error.add_note(f"and {len(warnings) - MOST_REPEATED} more warnings{rest}")


def tell_failure(error: BaseException) -> None:
    """Print why a command failed, with the notes of the error."""
    notes: Sequence[str] = getattr(error, "__notes__", ())
    if not (notes or isinstance(error, UelError | OSError)):
        notes = ["the output written so far is readable"]
    for text in (in_words(error), *notes):
        tell_error(text)


FAILURES: Final = (UelError, OSError, MemoryError, KeyboardInterrupt)
"""Exceptions that end a command with a message instead of a traceback."""


class DeckError(UelError):
    """Error of an input deck that is wrong or asks for something unsupported; each line begins with file:line."""

    def __init__(self, source: Source, message: str, others: Sequence[DeckError] = ()) -> None:
        super().__init__("\n".join([f"{source}: {_shown(message)}", *map(str, others)]))
        self.source = source


def unsupported(source: Source, what: str, where: str = "", *, reason: str = "", instead: str = "") -> DeckError:
    """Make the error for what is not supported: what it is, where it is not, why, and what is supported instead."""
    parts = f" for {where}" if where else "", f": {reason}" if reason else "", f"; {instead}" if instead else ""
    return DeckError(source, f"{what} is not supported{''.join(parts)}")


_LONGEST: Final = 1000


def _shown(message: str) -> str:
    """Return a message that quotes a deck, with control characters spelt out and a long line shortened."""
    # a whole file may be one line
    text = message if len(message) <= 2 * _LONGEST else message[:_LONGEST] + message[-_LONGEST:]
    if not text.isprintable():
        text = "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST // 2]} ... {text[-_LONGEST // 2 :]}"


def all_of(errors: Sequence[DeckError]) -> DeckError:
    """Join errors into one that has the lines of all of them."""
    first = errors[0]
    return DeckError(first.source, str(first).removeprefix(f"{first.source}: "), errors[1:])


class CompileError(UelError):
    """Error of a user's file that does not compile or link; carries the compiler's line."""

    def __init__(self, file: Path, message: str) -> None:
        super().__init__(f"{file}: {message}")
        self.file = file


class ElementError(UelError):
    """A user or built-in element failed."""

    def __init__(self, element: int, element_type: str, message: str) -> None:
        super().__init__(f"element {element} (type {element_type}): {message}")
        self.element = element
        self.element_type = element_type


class KernelError(ElementError):
    """Error of an element that stopped the analysis, wrote outside its arrays, or returned NaN in some state."""


class OutsideError(KernelError):
    """Error of an element that wrote outside its arrays."""


class NotFiniteError(KernelError):
    """Error of an element that returned NaN, or infinity."""


class DistortionError(KernelError):
    """A built-in element has turned inside out."""


class CallLimitError(ElementError):
    """A call did not return within the time that a call may take."""


class SingularMatrixError(UelError):
    """Error of a system matrix that is singular at a node and dof, usually because a body is unconstrained."""

    def __init__(self, node: str, dof: int, message: str, source: Source | None = None) -> None:
        prefix = f"{source}: " if source else ""
        super().__init__(f"{prefix}singular system matrix at node {node}, dof {dof}: {message}")
        self.node = node
        self.dof = dof
        self.message = message

    def in_step(self, source: Source) -> SingularMatrixError:
        """Return this error with file and line of the step in which it occurred."""
        return SingularMatrixError(self.node, self.dof, self.message, source)


class ConvergenceError(UelError):
    """Error of a step that gave up: the smallest increment, the number of increments or of attempts is exhausted."""


class IncrementsUsedUpError(ConvergenceError):
    """A step needs more increments than INC= of *STEP allows."""
