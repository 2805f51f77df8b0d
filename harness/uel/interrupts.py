# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Signals that ask a run to end: it does so once, between two writes to its files."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, Final

from uel.errors import tell_error

ENDS: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""Signals that end a run: from the keyboard, from a batch system, from a terminal that is closed."""

_WORDS: Final = {
    signal.SIGINT: "interrupted (SIGINT)",
    signal.SIGTERM: "ended by a user or the system (SIGTERM)",
    signal.SIGHUP: "ended because the terminal was closed (SIGHUP)",
}


class Interrupted(KeyboardInterrupt):
    """A signal has asked the process to end."""

    def __init__(self, signum: int) -> None:
        super().__init__(describe_interrupt(signum))


def describe_interrupt(signum: int) -> str:
    """Describe the effect of a signal on a run, as the end of a sentence."""
    return _WORDS[signal.Signals(signum)]


def take_interrupts() -> None:
    """Let SIGINT raise KeyboardInterrupt; during an import, which may turn it into another error, end the process."""

    def end(_: int, frame: FrameType | None) -> None:
        while frame is not None:
            if frame.f_code.co_filename.startswith("<frozen importlib"):
                tell_error("interrupted")
                os._exit(1)
            frame = frame.f_back
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, end)


class _State:
    held = False
    waiting = 0
    settled = False


def raise_interrupts() -> None:
    """Let the first of these signals raise Interrupted in this process; those after it have no effect."""

    def end(signum: int, _: FrameType | None) -> None:
        for each in ENDS:
            signal.signal(each, signal.SIG_IGN)
        if _State.held:
            _State.waiting = signum
        elif not _State.settled:
            raise Interrupted(signum)

    _handle(end)
    # isolation.py has blocked them
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDS)


@contextmanager
def held() -> Iterator[None]:
    """Put off such a signal until the end of the block."""
    _State.held = True
    try:
        yield
    finally:
        _State.held = False
    if _State.waiting:
        signum, _State.waiting = _State.waiting, 0
        raise Interrupted(signum)


def hold() -> None:
    """Put off such a signal until the next `held` block has ended: what has changed is recorded there first."""
    _State.held = True


def settle() -> None:
    """Forget such a signal, and let later ones have no effect: how the run ends is decided."""
    _State.settled = True
    _State.waiting = 0


@contextmanager
def collected() -> Iterator[list[int]]:
    """Put these signals on a list within the block, whose reader decides."""
    signals: list[int] = []
    before = _handle(lambda signum, _: signals.append(signum))
    try:
        yield signals
    finally:
        for signum, handler in before.items():
            signal.signal(signum, handler)


def _handle(handler: Callable[[int, FrameType | None], None]) -> dict[int, Any]:
    """Set a handler, as far as the signals are not ignored (nohup does so); returns the handlers before."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    return {each: signal.signal(each, handler) for each in ENDS if signal.getsignal(each) != signal.SIG_IGN}
