# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Job on several ranks, beside what one process does: what it refuses, whose messages count, how it ends."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from uel.errors import DeckError, SilentError, UsageError, in_words
from uel.model.model import Model, constraints_with_multipliers
from uel.output.lock import locked
from uel.output.verdict import forget_verdict, write_verdict
from uel.parallel import leave_word
from uel.parallel.ranks import FAILURES, Ranks
from uel.usersub import Library, Message


def refuse_unshared(model: Model, ranks: Ranks) -> None:
    """Raise DeckError for contact, distributing couplings with NLGEOM and linear perturbation steps, whose matrices are
    not shared out.
    """
    for keyword, source in constraints_with_multipliers(model):
        raise DeckError(source, f"{keyword} does not run on {ranks.size} ranks; run this deck in one process")
    for step in model.steps:
        if step.procedure.linear:
            raise DeckError(
                step.source,
                f"step {step.number} is a linear perturbation step, which does not run on {ranks.size} ranks; "
                "run this deck in one process",
            )


def messages_of(library: Library, ranks: Ranks) -> list[Message]:
    """Return the messages of all ranks since the last call, on rank 0: its own, and others that it does not have."""
    own, *others = ranks.collect(library.messages()) or [[]]
    known = {(message.file, message.kind, message.text) for message in own}
    for messages in others:
        new = [message for message in messages if (message.file, message.kind, message.text) not in known]
        own += new
        known.update((message.file, message.kind, message.text) for message in new)
    return own


@contextmanager
def files_of_job(stem: Path, ranks: Ranks) -> Iterator[None]:
    """Hold the files of a job in the block, and write the verdict if it fails; only rank 0 does so.

    Raises
    ------
    LockedError
        Another process runs a job of this name.
    SilentError
        On all ranks but 0 instead of an error, which rank 0 has too; or its supervisor tells it.
    """
    with ExitStack() as stack:

        def begin() -> None:
            stem.parent.mkdir(parents=True, exist_ok=True)
            if not ranks.rank:
                stack.enter_context(locked(stem))
                forget_verdict(stem)

        begun = False
        try:
            ranks.agree(begin)
            begun = True
            yield
        except BaseException as error:
            together = ranks.ended(error)
            if not ranks.rank and begun:
                # if the files of the run do not exist yet, or cannot be closed
                with suppress(OSError):  # the error that counts is the first
                    write_verdict(stem, in_words(error))
            if not ranks.rank or not isinstance(error, (*FAILURES, KeyboardInterrupt)):
                raise
            if not together:
                leave_word(stem, ranks.token, f"ended with rank {ranks.rank} of {ranks.size}: {in_words(error)}")
            raise SilentError(2 if isinstance(error, UsageError) else 1) from None
        finally:
            ranks.close()
