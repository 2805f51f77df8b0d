# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Job: run a deck with a user file, write the files of Abaqus, return a result."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from operator import methodcaller
from pathlib import Path

from uel import usersub
from uel.assembly import System, TolerantSystem
from uel.deck import read_deck
from uel.elements.interfaces.neighbour_data import judge_neighbours
from uel.elements.interfaces.process_zone import LongElements
from uel.elements.interfaces.unsymmetric_matrices import warn_of_missing_unsymm
from uel.elements.threads import refuse_shared_stress, use_threads
from uel.errors import ConvergenceError, ElementError, UelError, UsageError, in_words, note_warnings
from uel.files import deck_named
from uel.interrupts import held, settle
from uel.model.model import Model, constraints_with_multipliers
from uel.model.records import AttemptEnded, HarmonicResponse, IncrementDone, ModeShape, Record, StepDone
from uel.model.restart import DeckPart, Resumption
from uel.output import JobOutput, Result
from uel.output.earlier_jobs import EarlierJobs
from uel.output.lock import job_stem
from uel.output.outcome import progress
from uel.parallel.ranks import ALONE, Ranks
from uel.procedures import run_steps
from uel.procedures.general.incrementation import FIXED_TOO_LARGE, TOO_MANY_ATTEMPTS, TOO_MANY_INCREMENTS
from uel.running.job_on_ranks import SharedOutput, files_of_job, refuse_unshared
from uel.running.options import RoutineOptions
from uel.running.restart import (
    begins_within_step,
    decks_of,
    find_state,
    refuse_finished,
    refuse_on_ranks,
    refuse_options,
)
from uel.solver.options import SolverOptions
from uel.solver.threads import one_blas_thread
from uel.usersub import Library, guard_values
from uel.usersub.layout import without_user


def run(
    deck: str | Path,
    user: str | Path | Sequence[str | Path] | None = None,
    *,
    job: str | None = None,
    oldjob: str | Path | None = None,
    output_dir: str | Path | None = None,
    parameters: Mapping[str, float] | None = None,
    solver: SolverOptions = SolverOptions(),
    routines: RoutineOptions = RoutineOptions(),
    quiet: bool = True,
    ranks: Ranks = ALONE,
) -> Result:
    """Run an Abaqus deck.

    Parameters
    ----------
    deck
        Abaqus input file; its ending, .inp, may be left out.
    user
        File with UEL, UELMAT, UEXTERNALDB in Fortran, C or C++, or several in compilation order, or a compiled
        library; None takes the project's own elements.
    job
        Name of the output files; the deck's name without its ending by default.
    oldjob
        Job that the deck continues, with its folder: from the state that *RESTART, READ of the deck names, or from the
        last one if it is the deck of that job. See harness/uel/procedures/restart.md.
    output_dir
        Folder of the output files, created if missing; the current folder by default.
    parameters
        Values of parameters that replace those of the deck's *PARAMETER.
    solver
        Options for solving the equations: the linear solver, and a remedy if Newton's method fails.
    routines
        Options for compiling and calling user routines: number of threads, limit of a call, and checks.
    quiet
        No progress display.
    ranks
        Processes that run the job together, see harness/uel/parallel/README.md: each calls this function with the same
        arguments, and rank 0 writes the files.

    Returns
    -------
    Result
        Access to the files of the job: `.history`, `.field(name)`, `.interface()`, `.status`.

    Raises
    ------
    UelError
        UsageError for a wrong `job`, `parameters`, `solver` or `routines`, DeckError, CompileError, KernelError,
        CallLimitError, SingularMatrixError or ConvergenceError; LockedError if another process runs a job of this
        name; UelError itself if a user routine other than an element ends the analysis; SilentError on all ranks but
        0, whatever the error. What was written until then stays readable. The notes of the error are the first
        warnings before it, how far the run got, and what may help.
    OSError
        A file cannot be written.
    """
    deck = deck_named(Path(deck))
    stem = job_stem(deck.stem if job is None else job, output_dir)
    job, folder = stem.name, stem.parent
    refuse_on_ranks(oldjob, ranks)
    files = [user] if isinstance(user, str | Path) else user or ()
    started = time.perf_counter()
    with files_of_job(stem, ranks):
        resumed, parts = (None, ()) if oldjob is None else find_state(deck, parameters, Path(oldjob), stem)
        if parts:
            parameters = parts[-1].given
        earlier = EarlierJobs([Path(), folder, deck.parent])

        def read() -> tuple[Model, Sequence[DeckPart]]:
            model = read_deck(deck, parameters, parts, earlier)
            refuse_finished(model, resumed, oldjob)
            refuse_options(resumed, oldjob, solver)
            return model, decks_of(model, parameters, parts)

        model, decks = ranks.agree(read)
        refuse_unshared(model, ranks)
        _refuse_with_multipliers(model, solver)
        routines = routines.for_model(model)
        debug = routines.debug
        usersub.limit_calls(routines.call_limit)
        sources = [Path(file) for file in files]
        load = partial(usersub.load, sources, job=job, output_dir=folder, deck=deck, zero_locals=not debug, debug=debug)
        # rank 0 compiles, the others find the result in the cache
        library = ranks.in_turn(partial(load, rank=ranks.rank))
        trapping = usersub.trap(True) if debug else None
        usersub.set_threads(routines.cpus)
        try:
            files_of = partial(JobOutput, model, job, folder, decks=decks, quiet=quiet)
            output = SharedOutput(files_of, library, ranks)
            assemble = partial(ranks.agree, partial(_assemble, model, library, routines, ranks))
            _analyse(assemble, model, library, output, solver, resumed)
        except ElementError as error:
            if not debug and _debug_helps(sources, str(error)):
                error.add_note("run again with --debug to see file and line")
            if not sources and (note := without_user(error.element_type)):
                error.add_note(note)
            raise
        finally:
            usersub.set_threads(1)
            if trapping is not None:
                usersub.trap(trapping)
            library.close()
    return Result(stem, seconds=time.perf_counter() - started, warnings=output.warnings)


def _assemble(model: Model, library: Library, routines: RoutineOptions, ranks: Ranks) -> System:
    judge_neighbours(model, library)
    refuse_shared_stress(model, library, ranks.size)
    system = TolerantSystem(model, library, routines.linear, ranks)
    if routines.cpus > 1:
        use_threads(system.blocks, library, routines.cpus, routines.thread_safe)
    return system


def _refuse_with_multipliers(model: Model, solver: SolverOptions) -> None:
    """Raise UsageError for options that contact, and distributing couplings with NLGEOM, do not take."""
    for keyword, source in constraints_with_multipliers(model):
        for name, requested in (("--fallback", solver.fallback), ("--control energy", solver.energy_control)):
            if requested:
                raise UsageError(f"{name}: not supported with {keyword} ({source})")


def _analyse(
    assemble: Callable[[], System],
    model: Model,
    library: Library,
    output: SharedOutput,
    solver: SolverOptions,
    resumed: Resumption | None,
) -> None:
    """Run all steps, write their records to the files, and close these however the run ends."""
    files = output.files
    try:
        warn_of_missing_unsymm(model, library)
        output.system = system = assemble()
        long_elements = LongElements(model, library)

        def write_record(record: Record, files: JobOutput) -> None:
            files.write(record)
            # nothing fails in modes and harmonic responses
            if isinstance(record, IncrementDone) and not isinstance(record, ModeShape | HarmonicResponse):
                for warning in long_elements.warnings(record, files.warnings):
                    files.user_text(".dat", "warning", warning)

        with one_blas_thread(), guard_values({}):
            for record in run_steps(system, model, library, solver, resumed=resumed):
                with held():
                    write = output.write if isinstance(record, AttemptEnded | StepDone) else output.write_own
                    write(partial(write_record, record))
        with held():
            if files is not None:
                for warning in long_elements.waiting(files.warnings):
                    files.user_text(".dat", "warning", warning)
            output.write(methodcaller("close", None))
            output.ranks.ended(None)
            settle()
    except BaseException as error:
        settle()
        output.ranks.ended(error)
        with suppress(OSError):
            output.write(methodcaller("close", UelError(in_words(error))))
        if files is None:
            raise
        note_warnings(error, files.warnings, f" in {files.job}.dat and .msg")
        for text in files.unbalanced if isinstance(error, ConvergenceError) else ():
            error.add_note(text)
        if isinstance(error, UelError) and (note := _progress(files.stem)):
            error.add_note(note)
        error.add_note(f"{files.job} ended {files.reached}; what was written is readable")
        if isinstance(error, ConvergenceError):
            # constraints with multipliers take neither of the two options, a restart at most energy control
            multipliers = bool(constraints_with_multipliers(model))
            within_step = resumed is not None and begins_within_step(resumed)
            fallback = solver.fallback or multipliers or resumed is not None
            energy_control = solver.energy_control or multipliers or within_step
            error.add_note(_advice(str(error), fallback=fallback, energy_control=energy_control))
        raise


def _progress(stem: Path) -> str:
    """Describe the progress of a run from its files; '' if they cannot be read."""
    with suppress(Exception):  # the error that counts is the one that ended the run
        return progress(Result(stem))
    return ""


def _advice(error: str, *, fallback: bool, energy_control: bool) -> str:
    """Return a sentence on what may help where a step does not converge; the flags: not to be suggested."""
    if error.startswith(TOO_MANY_INCREMENTS):
        return "what may help: a larger INC on *STEP"
    ways = [] if fallback else ["--fallback, a search where Newton's method fails"]
    ways += [] if energy_control else ["--control energy, where an interface snaps"]
    if error.startswith(FIXED_TOO_LARGE):
        ways.append("*STATIC without DIRECT, which cuts increments back")
    elif error.startswith(TOO_MANY_ATTEMPTS):
        ways.append("a smaller largest increment (fourth number below *STATIC), which needs fewer cutbacks")
        ways.append("more attempts (I_A, eighth number below *CONTROLS, PARAMETERS=TIME INCREMENTATION)")
    else:
        ways.append("a smaller minimum increment (third number below *STATIC)")
    ways.append("VISCOSITY of the interface elements, or on *SECTION CONTROLS of cohesive elements")
    return f"what may help: {'; '.join(ways)}"


def _debug_helps(sources: Sequence[Path], message: str) -> bool:
    """Return whether a debug build may add the line that an error does not name."""
    compiled = bool(sources) and all(map(usersub.is_source, sources))
    return compiled and not usersub.names_line(message)
