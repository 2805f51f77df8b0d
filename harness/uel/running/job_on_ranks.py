# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Job on several ranks: what it refuses, its output and messages, how it ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from uel.assembly import System
from uel.errors import DeckError, SilentError, UsageError, in_words
from uel.model.model import Model, constraints_with_multipliers
from uel.output import JobOutput
from uel.output.lock import locked
from uel.output.verdict import forget_verdict, write_verdict
from uel.parallel import write_reason
from uel.parallel.ranks import FAILURES, Ranks
from uel.usersub import Library, Message, set_rank


def refuse_unshared(model: Model, ranks: Ranks) -> None:
    """Raise DeckError, on several ranks, for contact, linear perturbation steps, and with NLGEOM distributing couplings
    and constraints with rotations.
    """
    if ranks.size == 1:
        return
    unshared = list(constraints_with_multipliers(model))
    for step in model.steps:
        if step.procedure.linear:
            unshared.append((f"step {step.number} is a linear perturbation step, which", step.source))
        elif step.nlgeom and model.arms:
            unshared.append(("a constraint with rotations, with NLGEOM,", model.arms[0].source))
    for what, source in unshared:
        raise DeckError(source, f"{what} does not run on {ranks.size} ranks; run this deck in one process")


class SharedOutput:
    """Output of a job, on rank 0; the other ranks send the states of their elements when it reads them.

    files   output files; None on ranks other than 0
    ranks   ranks of the job
    system  system whose element states are read
    """

    def __init__(self, files: Callable[[], JobOutput], library: Library, ranks: Ranks) -> None:
        """Open the files."""
        self.files = ranks.agree(lambda: None if ranks.rank else files())
        self.system: System | None = None
        self.ranks, self._library = ranks, library

    @property
    def warnings(self) -> list[str]:
        """Warnings so far; none on ranks other than 0."""
        return [] if self.files is None else self.files.warnings

    def write(self, act: Callable[[JobOutput], None]) -> None:
        """Write the messages of user routines on all ranks where Abaqus puts them, then call a function on rank 0."""
        files, system = self.files, self.system
        self._pass_on(self._messages())
        self.ranks.lead(lambda: None if files is None else act(files), lambda: system and system.share_states())

    def write_own(self, act: Callable[[JobOutput], None]) -> None:
        """Write as `write` does, with messages of rank 0 only and without the states of other ranks."""
        if self.files is not None:
            self._pass_on(self._library.messages())
            act(self.files)

    def _pass_on(self, messages: Sequence[Message]) -> None:
        for message in messages:
            assert self.files is not None
            self.files.user_text(message.file, message.kind, message.text)

    def _messages(self) -> list[Message]:
        """Return the messages of all ranks since the last call, on rank 0, each of them once."""
        own, *others = self.ranks.gather(self._library.messages()) or [[]]
        known = {(message.file, message.kind, message.text) for message in own}
        for messages in others:
            new = [message for message in messages if (message.file, message.kind, message.text) not in known]
            own += new
            known.update((message.file, message.kind, message.text) for message in new)
        return own


@contextmanager
def files_of_job(stem: Path, ranks: Ranks) -> Iterator[None]:
    """Lock the files of a job, and write the verdict if it fails, on rank 0; tell user routines their rank.

    Raises
    ------
    LockedError
        Another process runs a job of this name.
    SilentError
        On ranks other than 0, in place of an error: rank 0, or the process that watches this rank, prints it.
    """
    with ExitStack() as stack:
        stack.callback(set_rank, 0, 1)
        set_rank(ranks.rank, ranks.size)

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
                # `_analyse` has written it, unless the files did not exist yet or could not be closed
                with suppress(OSError):  # the error that counts is the first
                    write_verdict(stem, in_words(error))
            if not ranks.rank or not isinstance(error, (*FAILURES, KeyboardInterrupt)):
                raise
            if not together:
                write_reason(stem, ranks.token, f"ended with rank {ranks.rank} of {ranks.size}: {in_words(error)}")
            raise SilentError(2 if isinstance(error, UsageError) else 1) from None
        finally:
            ranks.close()
