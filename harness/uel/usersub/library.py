# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loaded library of user routines."""

from __future__ import annotations

import ctypes
import hashlib
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from uel.errors import CompileError, UelError
from uel.model.arrays import FloatArray, IntArray
from uel.model.records import PointVariables
from uel.model.user_values import AskedAmplitude, GivenAmplitude, UserValues
from uel.usersub import _binding, _points, layout
from uel.usersub.compilation.cache import Built
from uel.usersub.compilation.compiler import build, digest_of_sources
from uel.usersub.compilation.languages import CPP, SUFFIXES, C
from uel.usersub.compilation.linker import undefined_routine
from uel.usersub.compilation.source_lines import innermost
from uel.usersub.messages import Inbox, Message
from uel.usersub.own_kernels import path_of_kernels

ENTRY_POINTS: Final = (
    *("UEL", "UELMAT", "UEXTERNALDB", "UMAT", "UVARM", "SDVINI", "DLOAD", "DISP", "UAMP", "USDFLD", "UTRACLOAD"),
    *("UFIELD", "URDFIL", "UMATHT", "UHARD", "UEXPAN", "CREEP", "FRIC", "UINTER", "MPC", "ORIENT", "SIGINI", "HETVAL"),
    *("DFLUX", "FILM", "UTEMP", "UHYPER", "UANISOHYPER_INV", "UMESHMOTION", "VUEL", "VUMAT", "VDLOAD", "VUSDFLD"),
    *("VEXTERNALDB", "UCREEPNETWORK", "UTRSNETWORK"),
)
"""User routines of Abaqus, looked up in a user's file."""

_dlclose = ctypes.CDLL(None).dlclose
_dlclose.argtypes = [ctypes.c_void_p]

_STOP_ANALYSIS, _CONCLUDE_STEP = 4, 5
"""Indices in lFlagsDefine of UAMP."""


class Library:
    """User routines of a job, and the job's messages from them.

    uel, uelmat, umat, umatht, uhyper, uanisohyper_inv, uhard, creep, ucreepnetwork, utrsnetwork, hetval, uvarm, sdvini,
    sigini, orient, disp, dload, dflux, film, utemp, ufield, uamp, usdfld, uexternaldb   addresses, None without it
    name                      the file as the user named it, for messages
    file                      the shared library
    is_own                    it has the elements of the project
    entry_points              names of all user routines in the files
    """

    def __init__(self, name: str, file: Path, handle: ctypes.CDLL, inbox: Inbox, *, sanitized: bool = False) -> None:
        self.name = name
        self.file = file
        self._handle, self._loaded = handle, True
        self._sanitized = sanitized
        _binding.sanitize(sanitized)
        self._inbox = inbox
        addresses = {entry: _address(handle, entry) for entry in ENTRY_POINTS}
        self.is_own = hasattr(handle, layout.MARKER)
        self.entry_points = tuple(entry for entry, address in addresses.items() if address)
        of = addresses.__getitem__
        self.uel, self.uelmat, self.uexternaldb = map(of, ("UEL", "UELMAT", "UEXTERNALDB"))
        self.umat, self.umatht, self.uhard, self.creep = map(of, ("UMAT", "UMATHT", "UHARD", "CREEP"))
        self.uhyper, self.uanisohyper_inv = map(of, ("UHYPER", "UANISOHYPER_INV"))
        self.ucreepnetwork, self.utrsnetwork = map(of, ("UCREEPNETWORK", "UTRSNETWORK"))
        self.hetval, self.uvarm, self.usdfld = map(of, ("HETVAL", "UVARM", "USDFLD"))
        self.sdvini, self.sigini, self.orient = map(of, ("SDVINI", "SIGINI", "ORIENT"))
        self.disp, self.dload, self.dflux, self.film = map(of, ("DISP", "DLOAD", "DFLUX", "FILM"))
        self.utemp, self.ufield, self.uamp = map(of, ("UTEMP", "UFIELD", "UAMP"))

    def variables(self, jtype: int) -> PointVariables | None:
        """Return the meaning of the SVARS of an element type of the project, None for others."""
        return layout.variables(jtype) if self.is_own else None

    def is_continuum(self, jtype: int, integers: IntArray) -> bool:
        """Return whether elements are continuum elements of the project whose stress no other element reads.

        integers: JPROPS.
        """
        return self.is_own and layout.is_continuum(jtype, integers)

    def shares_stress(self, jtype: int, integers: IntArray) -> bool:
        """Return whether elements of the project store stress for others, or read it; integers: JPROPS."""
        return self.is_own and layout.shares_stress(jtype, integers)

    def external_database(
        self, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
    ) -> None:
        """Call UEXTERNALDB if there is one.

        Parameters
        ----------
        lop
            LOP: 0 and 3 at the start and the end of the analysis, 1 and 2 of an increment, 5 and 6 of a step.
        lrestart
            LRESTART; 0: no restart file is written.
        time
            TIME: step and total time at the moment of the call.
        dtime
            DTIME: size of the increment, 0 outside one.
        step, increment
            KSTEP, KINC.

        Raises
        ------
        UelError
            The routine ends the analysis, or does not return within the limit of a call.
        """
        if self.uexternaldb is None:
            return
        if not _binding.external_database(self.uexternaldb, lop, lrestart, time, dtime, step, increment):
            raise UelError(f"{self.name}: UEXTERNALDB (LOP={lop}) {self.stop_reason()}")

    @property
    def contents(self) -> str:
        """Names of its user routines, for messages."""
        if self.entry_points:
            return ", ".join(self.entry_points)
        if any(self.name.lower().endswith(suffix) for suffix in (*C.suffixes, *CPP.suffixes)):
            return 'no user routine (in C its name is uel_ or FOR_NAME(uel), in C++ it is extern "C" as well)'
        return "no user routine"

    def user_values(self, request: UserValues) -> FloatArray:
        """Call DISP, DLOAD, UTEMP or UFIELD, which the job must have, once for each node or point.

        Returns the values (n,), those of the deck where the routine sets none. Raises UelError if the routine ends the
        analysis, or does not return within the limit of a call.
        """
        routines = {"DISP": self.disp, "DLOAD": self.dload, "UTEMP": self.utemp, "UFIELD": self.ufield}
        address = routines[request.routine]
        assert address is not None
        made = np.array(request.values)
        failed = _points.user_values(address, request, made)
        if failed:
            first, second = request.numbers[failed - 1, :2].tolist()
            location = f"element {first}" if request.routine == "DLOAD" else f"node {first}"
            location += f", dof {second}" if request.routine == "DISP" else ""
            raise UelError(f"{self.name}: {request.routine} {self.stop_reason()} ({location}, step {request.step})")
        return made

    def user_amplitude(self, request: AskedAmplitude) -> GivenAmplitude:
        """Call UAMP, which the job must have.

        Returns the value, the state variables after the call, and lFlagsDefine(6), which ends the step. Raises UelError
        if UAMP ends the analysis, also by lFlagsDefine(5), does not return in time, or sets no finite number.
        """
        assert self.uamp is not None
        value, state, define, ended = _points.user_amplitude(self.uamp, request)
        location = f"amplitude {request.name}, step {request.step}, increment {request.increment}"
        if ended:
            raise UelError(f"{self.name}: UAMP {self.stop_reason()} ({location})")
        if define[_STOP_ANALYSIS]:
            raise UelError(f"{self.name}: UAMP stopped the analysis by lFlagsDefine(5) ({location})")
        if not np.isfinite(value):
            raise UelError(f"{self.name}: UAMP does not set AmpValueNew, or sets it to NaN or infinity ({location})")
        return GivenAmplitude(value, state, bool(define[_CONCLUDE_STEP]))

    def stop_reason(self) -> str:
        """Return the reason why a user routine ended the analysis, as the end of a sentence."""
        if text := self._inbox.last_error():
            return f"stopped the analysis: {self._with_location(text)}"
        if lines := self._inbox.last_lines():
            return f"stopped the analysis (XIT); last printed: {' / '.join(lines)}"
        return "stopped the analysis (XIT) without a message"

    def _with_location(self, text: str) -> str:
        """Add file and line, and the routine if it differs, to the message of a signal, 'in UEL: ...'."""
        line = innermost(_binding.take_frames(), self._handle._name, self.file)
        head, colon, tail = text.partition(": ")
        if line is None or not colon:
            return text
        inside = "" if f"in {line.routine}" == head else f" ({line.routine})"
        return f"{head}, {line.file} line {line.line}{inside}: {tail}"

    def messages(self) -> list[Message]:
        """Return the messages since the last call: STDB_ABQERR, then the output to units 6 and 7."""
        return self._inbox.take()

    def warn(self, text: str) -> None:
        """Add a warning of the harness to the messages."""
        self._inbox.warn(text)

    def close(self) -> None:
        """End the job: disconnect units 6 and 7, and unload the routines.

        Each job of a process has a copy of its own (`_open`), and the system maps some ten thousand of them at most.
        The address sanitizer does not let go of what it watches.
        """
        self._inbox.close()
        if self._sanitized:
            _binding.sanitize(False)
        elif self._loaded:
            _dlclose(self._handle._handle)
        self._loaded = False


def load(
    user: Path | Sequence[Path] | None,
    *,
    job: str,
    output_dir: Path,
    deck: Path | None = None,
    zero_locals: bool = False,
    debug: bool = False,
    rank: int = 0,
) -> Library:
    """Load user routines: files in Fortran, C or C++ (compiled, or from the cache) or a shared library.

    Parameters
    ----------
    user
        The files in the order of compilation, or one .so; None, or no file: the kernels of the project.
    job
        Name of the job, for GETJOBNAME and for the files of units 6 and 7, JOB.unit6 and JOB.unit7.
    output_dir
        Folder of these files, created if missing; GETOUTDIR.
    deck
        INCLUDE lines are looked up in its folder too, after those of the sources.
    zero_locals
        Uninitialised local variables of Fortran are zero, as many public user elements assume; a check turns this off.
        With `debug` those of C and C++ are zero too.
    debug
        Compile with run-time checks, which end a call with file and line, and, unless `zero_locals`, with NaN or other
        conspicuous values in uninitialised variables; with AddressSanitizer, if its runtime is in this process.
    rank
        Rank of this process in the job: each rank has its own files of units 6 and 7.

    Returns
    -------
    Library
        Its `close` ends the job. Of all libraries in this process, the one loaded last has units 6 and 7.

    Raises
    ------
    CompileError
        A file does not exist, has another ending, does not compile or link, or cannot be loaded.
    UelError
        The files of units 6 and 7 cannot be written.
    """
    files = [] if user is None else [user] if isinstance(user, Path) else list(user)
    sanitized = debug and _binding.sanitizing()
    built = _shared_library(files, _include(deck), zero_locals=zero_locals, debug=debug, sanitized=sanitized)
    name = _name_of(files)
    library = Library(
        name, built.library, _open(built.library, name), Inbox(job, output_dir, rank), sanitized=sanitized
    )
    for note in built.notes:
        library.warn(note)
    return library


def compile_ahead(user: Sequence[Path], *, deck: Path, zero_locals: bool = False, debug: bool = False) -> str:
    """Compile files into the cache, for later jobs; arguments and CompileError as in `load`.

    Returns a digest of the user's files, the same on any machine; '' without files.
    """
    if not user:
        return ""
    if _is_shared(user):
        return hashlib.sha256(user[0].read_bytes()).hexdigest()
    built = _shared_library(user, _include(deck), zero_locals=zero_locals, debug=debug)
    return hashlib.sha256(f"{digest_of_sources(user, _include(deck))} {built.read}".encode()).hexdigest()


def _include(deck: Path | None) -> tuple[Path, ...]:
    """Return the folders of INCLUDE lines besides those of the sources."""
    return () if deck is None else (deck.resolve().parent,)


def _name_of(files: Sequence[Path]) -> str:
    """Return the name of the user files in messages."""
    others = f" and {len(files) - 1} more" if len(files) > 1 else ""
    return f"{files[0]}{others}" if files else "this project's file"


def _shared_library(files: Sequence[Path], include: Sequence[Path], **how: bool) -> Built:
    if not files:
        return Built(path_of_kernels(), ())
    return Built(files[0], ()) if _is_shared(files) else build(files, include, **how)


def _is_shared(files: Sequence[Path]) -> bool:
    """Return whether the files are a shared library. Raises CompileError if they are neither that nor sources."""
    for file in files:
        if not file.is_file():
            raise CompileError(file, "not a file" if file.exists() else "no such file")
        if file.suffix.lower() not in (*SUFFIXES, ".so"):
            raise CompileError(file, f"not a file of user routines: expected {', '.join(SUFFIXES)} or .so")
    if any(file.suffix.lower() == ".so" for file in files):
        if len(files) > 1:
            raise CompileError(files[0], "a shared library cannot be combined with other files")
        return True
    return False


def _open(shared: Path, name: str) -> ctypes.CDLL:
    """Load a copy, so that data of modules and COMMON blocks are new in every job of this process."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / shared.name
        shutil.copyfile(shared, copy)
        _binding.set_loading(True)
        try:
            return ctypes.CDLL(str(copy), mode=ctypes.RTLD_LOCAL)
        except OSError as error:
            raise CompileError(Path(name), undefined_routine(str(error))) from None
        finally:
            _binding.set_loading(False)


def _address(handle: ctypes.CDLL, entry: str) -> int | None:
    try:
        symbol = getattr(handle, entry.lower() + "_")
    except AttributeError:
        return None
    return ctypes.cast(symbol, ctypes.c_void_p).value
