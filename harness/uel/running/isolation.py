# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run in a separate process: whatever user code does, the files are closed and the reason is stated."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO, Final

from uel.errors import tell_error
from uel.interrupts import ENDS, collected, describe_interrupt
from uel.parallel import Launch, await_end, read_reason, remove_reason, without_launch, write_reason
from uel.running import sanitizer
from uel.shared_progress import Slate, Within, new_slate

SAME_PROCESS: Final = "--same-process"
"""Option of `uel run` and `uel check`: no separate process."""

_ENDED = 2
"""Exit code with which the Fortran library ends a process; usage errors, which have it too, are reported before."""

_GLANCE: Final = 0.2
"""Seconds between two checks of the process."""

_GRACE: Final = 5.0
"""Seconds that the process has to end: after a signal, when it has finished, or beyond the limit of a call."""

_IDLE: Final = 10.0
"""Seconds without CPU time after which a process that abandoned a call counts as waiting for a lock for ever."""

_ONE_BLAS_THREAD: Final = {"OPENBLAS_NUM_THREADS": "1"}
"""A job uses one thread (`solver.threads`); numpy would start more, which wait in a loop for work."""

_REASONS: Final = {
    signal.SIGKILL: "killed, by a user or by the system for lack of memory",
    signal.SIGABRT: "abort, usually because a user routine wrote outside an array",
    signal.SIGSEGV: "segmentation fault outside a user routine, usually because one wrote outside an array earlier",
}


@dataclass(frozen=True, slots=True)
class End:
    """Ending of a process.

    code         exit code, -n for signal n
    finished     whether it ended by itself
    reason       reason why it did not, as the end of a sentence
    location     location in user code; '' if it ended elsewhere
    interrupted  whether a signal asked for the end
    token        name of the run on several ranks, '' without ranks
    """

    code: int
    finished: bool
    reason: str
    location: str
    interrupted: bool = False
    token: str = ""


def supervise(
    arguments: Sequence[str],
    stem: Path,
    call_limit: float,
    *,
    sanitized: bool = False,
    log: IO[str] | None = None,
    signals: Sequence[int] | None = None,
    launch: Launch | None = None,
) -> int:
    """Run `uel` with these arguments, a subcommand first, in a separate process; return the exit code.

    stem: folder and name of the job. sanitized, signals, launch: see `run_isolated`. log: file for all that the run
    prints. If the process ends without closing the files of the job, this function closes them, on rank 0 of several.
    """
    arguments = [arguments[0], SAME_PROCESS, *arguments[1:]]
    end = run_isolated(
        "uel.cli",
        arguments,
        call_limit,
        sanitized=sanitized,
        output=log,
        errors=log,
        signals=signals,
        launch=launch,
        reason_elsewhere=partial(read_reason, stem),
    )
    if launch and launch.rank and end.token:
        if not end.finished:
            location = f", {end.location}" if end.location else ""
            write_reason(stem, end.token, f"ended with {launch.name}, {end.reason}{location}")
        await_end(stem, end.token)
        return end.code if end.finished else 1
    if end.finished:
        remove_reason(stem, end.token)
        return end.code
    from uel.output.verdict import close_ended_run  # noqa: PLC0415 (numpy, after the process has begun)

    reason = f"the run was {end.reason}" + (f", {end.location}" if end.location else "")
    close_ended_run(stem, reason)
    tell_error(f"{reason}; the output written so far is readable", log)
    # the other ranks, and `mpiexec`, wait for this before they end
    remove_reason(stem, end.token)
    return 1


def run_isolated(
    module: str,
    arguments: Sequence[str],
    call_limit: float,
    *,
    sanitized: bool = False,
    output: IO[str] | None = None,
    errors: IO[str] | None = None,
    meanwhile: Callable[[], None] | None = None,
    signals: Sequence[int] | None = None,
    launch: Launch | None = None,
    reason_elsewhere: Callable[[str], str] = str,
) -> End:
    """Call `main` of a module with arguments in a process that user code may end; end the process if it hangs.

    call_limit: seconds that one call of a user routine may take, 0: no limit; the process enforces it itself if it can.
    sanitized: debug builds have AddressSanitizer in it; where that is not possible, a message says why.
    output, errors: files for stdout and stderr, by default those of this process. meanwhile: called now and then.
    signals: signals that the main thread collects for this one, which cannot do so itself; passed on to the process.
    launch: rank of the process; None: no rank, however this process was started. reason_elsewhere: returns, for the
    token of the run, the reason why another rank has ended, '' if none has.
    """
    _raise_stack_limit()
    variables: Mapping[str, str] = os.environ if launch else without_launch()
    if sanitized:
        try:
            variables = sanitizer.environment()
        except sanitizer.NoSanitizerError as error:
            tell_error(str(error), errors)
    descriptor, slate = new_slate()
    with collected() if signals is None else nullcontext(signals) as arrived:
        # signals stay blocked in the process until it handles them
        before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDS)
        try:
            process = subprocess.Popen(
                [sys.executable, "-m", "uel.running.worker", str(os.getpid()), str(descriptor), module, *arguments],
                env={**_ONE_BLAS_THREAD, **variables},
                stdout=output,
                stderr=errors,
                pass_fds=[descriptor, *(launch.descriptors if launch else ())],
            )
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
            os.close(descriptor)
        watch = _Watch(process, slate, call_limit)
        code, why, other = None, "", ""
        while code is None:
            try:
                code = process.wait(_GLANCE)
            except subprocess.TimeoutExpired:
                if meanwhile:
                    meanwhile()
                why = why or watch.glance(arrived)
                if launch and not (launch.rank or why or arrived or slate.finished):
                    why = other = reason_elsewhere(slate.token.decode())
                if why:
                    process.kill()
    token = slate.token.decode()
    if slate.finished:
        return End(slate.finished - 1, True, "", "", bool(arrived), token)
    inside = (bool(slate.within) and not other) or why == HANGS
    return End(code, False, why or describe_end(code), slate.where() if inside else "", bool(arrived), token)


ENDLESS: Final = "ended because {what} took longer than {limit:g} s (--call-limit)"
_ENDLESS: Final = {
    Within.CALL: "a call of a user routine",
    Within.LOADING: "loading the library of user routines",
}
HANGS: Final = "ended because it hung after an abandoned call, usually inside a WRITE, which locks its unit"


class _Watch:
    """Monitor of a process, which decides when and why to kill it.

    It measures time by the number of its checks, so that no time passes while all processes are stopped.
    """

    def __init__(self, process: subprocess.Popen[bytes], slate: Slate, call_limit: float) -> None:
        self._process = process
        self._slate = slate
        self._limit = call_limit
        self._passed = 0
        self._seen: tuple[int, ...] = ()
        self._call, self._idle, self._ending = 0.0, 0.0, 0.0
        self._work = 0

    def glance(self, signals: Sequence[int]) -> str:
        """Pass on signals that have arrived; return the reason to kill the process, '' for none."""
        slate = self._slate
        for signum in signals[self._passed :]:
            self._process.send_signal(signum)
        again, self._passed = 0 < self._passed < len(signals), len(signals)
        self._ending = self._ending + _GLANCE if signals or slate.finished else 0.0
        state, work = _state(self._process.pid)
        if state not in _STOPPED:
            seen = (slate.calls, slate.within, slate.left)
            self._call = self._call + _GLANCE if slate.within and seen == self._seen else 0.0
            waits = state == "S" and work == self._work
            self._idle = self._idle + _GLANCE if slate.left and waits else 0.0
            self._seen, self._work = seen, work
        if signals and (again or self._ending > _GRACE):
            return describe_interrupt(signals[0])
        if slate.finished and self._ending > _GRACE:
            return "ended"
        if self._limit > 0.0 and self._call > self._limit + _GRACE:
            return ENDLESS.format(what=_ENDLESS[Within(slate.within)], limit=self._limit)
        return HANGS if self._idle > _IDLE else ""


_STOPPED: Final = ("T", "t")
"""States of a process stopped by a user or a debugger."""


def _state(process: int) -> tuple[str, int]:
    """Return the state of a process and the ticks of CPU time that it has used.

    The state is "" if the system does not report it, or if the process may wait for another one, such as a compiler.
    """
    folder = Path(f"/proc/{process}")
    try:
        fields = (folder / "stat").read_text("utf-8", errors="replace").rpartition(")")[2].split()
        children = (folder / f"task/{process}/children").read_text()
    except OSError:
        return "", 0
    return "" if children and fields[0] == "S" else fields[0], int(fields[11]) + int(fields[12])


def describe_end(code: int) -> str:
    """Describe why a process ended, from its exit code, as the end of a sentence."""
    if code >= 0:
        who = " by the Fortran library, in an input or output statement of a user routine" if code == _ENDED else ""
        where = f"; it looks up files from the current folder, {Path.cwd()}" if who else ""
        return f"ended{who} (exit code {code}{where})"
    try:
        ending = signal.Signals(-code)
    except ValueError:
        return f"ended by signal {-code}"
    return f"ended by {ending.name}: {_REASONS.get(ending, signal.strsignal(ending))}"


def _raise_stack_limit() -> None:
    """Raise the stack limit as Abaqus does: local arrays of user routines are on the stack."""
    _, hard = resource.getrlimit(resource.RLIMIT_STACK)
    most = MOST_STACK if hard == resource.RLIM_INFINITY else min(hard, MOST_STACK)
    resource.setrlimit(resource.RLIMIT_STACK, (most, hard))


MOST_STACK: Final = 1 << 28
"""Bytes of stack: finite, so that endless recursion ends soon and is recognised."""
