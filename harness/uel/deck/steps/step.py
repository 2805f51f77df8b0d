# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEP: the steps of a deck."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block
from uel.deck.language.structure import Scope
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.steps.controls import ControlState
from uel.deck.steps.distributed import keep_last, read_distributed, read_fields, read_surface_loads
from uel.deck.steps.heat_loads import HEAT_LOADS, number_exchanges, read_heat_loads
from uel.deck.steps.prescribed import Prescription, check_load_cases, contradictions, of_load_case
from uel.deck.steps.procedures import read_procedure
from uel.deck.steps.requests import RequestReader
from uel.errors import Source
from uel.model.amplitude import AmplitudeType, UserAmplitude
from uel.model.energies import ENERGIES
from uel.model.procedures import Procedure
from uel.model.steps import ON_EDGES, DistributedLoad, ElementLoad, LoadKind, Step

MOST_INCREMENTS = 100
Entry = TypeVar("Entry")


def read_steps(
    scopes: list[Scope], prescription: Prescription, requests: RequestReader, problems: Problems
) -> tuple[Step, ...]:
    """Read all steps; controls, output requests, NLGEOM, UNSYMM and CONVERT SDI carry over from one to the next."""
    steps: list[Step] = []
    controls = ControlState()
    nlgeom, unsymmetric, convert = False, False, True
    read_heat = partial(read_heat_loads, prescription=prescription)
    for number, scope in enumerate(scopes, start=1):
        for block in scope.blocks:
            if block.name == "CONTROLS":
                with problems.gather():
                    controls = controls.read(block)
        output = requests.read_step(scope.blocks)
        nlgeom = nlgeom or scope.head.options.flag("NLGEOM")
        options = scope.head.options
        unsymmetric = options.flag("UNSYMM") if options.has("UNSYMM") else unsymmetric
        convert = options.flag("CONVERT SDI") if options.has("CONVERT SDI") else convert
        name = options.text("NAME") or f"Step-{number}"
        if name in (step.name for step in steps):
            problems.add(scope.head.source, f"*STEP: the name {name} is taken by an earlier step")
        read_boundary = partial(prescription.read_boundary, in_step=True)
        cases = [replace(scope, blocks=of_load_case(scope.blocks, case)) for case in (1, 2)]
        boundaries, new_boundary = _read_entries(cases[0], ("BOUNDARY",), read_boundary, problems)
        of_modes, _ = _read_entries(cases[1], ("BOUNDARY",), read_boundary, problems)
        check_load_cases(scope.blocks, boundaries, of_modes, problems)
        for source, message in contradictions(boundaries, prescription.flat):
            problems.warn(source, message)
        loads, new_loads = _read_entries(scope, ("CLOAD", "CFLUX", "CECHARGE"), prescription.read_loads, problems)
        distributed, new_distributed = _read_entries(
            scope, ("DLOAD",), partial(read_distributed, prescription=prescription), problems
        )
        surface_loads, new_surface_loads = _read_entries(
            scope, ("DSLOAD",), partial(read_surface_loads, prescription=prescription), problems
        )
        heat = {name: _read_entries(scope, (name,), read_heat, problems) for name in HEAT_LOADS}
        fields, new_fields = _read_entries(
            scope,
            ("TEMPERATURE", "FIELD", "PRESSURE STRESS"),
            partial(read_fields, prescription=prescription),
            problems,
        )
        fields = keep_last(fields, prescription.flat, problems)
        with problems.gather():
            procedure = read_procedure(scope, prescription)
            if procedure.energies is not None:
                _check_energies(scope, procedure, requests, problems)
                output = replace(output, history_energies=procedure.energies)
            check_parts(scope.blocks, problems, harmonic=procedure.harmonic)
            increments = options.integer("INC", MOST_INCREMENTS)
            if increments < 1:
                raise scope.head.error(f"INC={increments} must be positive")
            steps.append(
                Step(
                    number=number,
                    name=name,
                    procedure=procedure,
                    source=scope.head.source,
                    nlgeom=nlgeom,
                    increments=increments,
                    extrapolation=_extrapolation(scope, procedure),
                    unsymmetric=unsymmetric,
                    convert_sdi=convert,
                    amplitude=options.text("AMPLITUDE") or procedure.default_amplitude,
                    title=next((line for line in scope.head.lines if line), ""),
                    controls=controls.effective,
                    boundaries=boundaries,
                    new_boundary=new_boundary,
                    loads=loads,
                    new_loads=new_loads,
                    distributed=tuple(load for load in distributed if isinstance(load, DistributedLoad)),
                    new_distributed=new_distributed,
                    element_loads=tuple(load for load in distributed if isinstance(load, ElementLoad)),
                    surface_loads=surface_loads,
                    new_surface_loads=new_surface_loads,
                    heat_loads=tuple(load for loads, _ in heat.values() for load in number_exchanges(loads)),
                    new_heat_loads=frozenset(name for name, (_, new) in heat.items() if new),
                    fields=fields,
                    new_fields=new_fields,
                    output=output,
                    notes=tuple(_notes(scope)),
                )
            )
    _check_followers(steps, problems)
    _check_modes(steps, problems)
    for step in steps:
        if step.procedure.inertia and not step.procedure.linear:
            _check_smoothing(step, problems)
        if step.procedure.linear and step.procedure.loaded:
            _check_perturbation(step, problems)
    return tuple(steps)


def _check_energies(scope: Scope, procedure: Procedure, requests: RequestReader, problems: Problems) -> None:
    """Report requested energies that the procedure does not have."""
    known = procedure.energies or ()
    where = f"*{procedure.keyword} (step at {scope.head.source}), which has {', '.join(known)}"
    by_place: dict[Source, list[str]] = {}
    for source, name in requests.energies:
        if name not in known:
            by_place.setdefault(source, []).append(name)
    for source, names in by_place.items():
        problems.warn(source, f"*ENERGY OUTPUT: {', '.join(names)} not available in {where}; left out")
    for block in scope.blocks:
        if block.name == "ENERGY PRINT" and not any(name in ENERGIES for name in known):
            problems.warn(block.source, f"*ENERGY PRINT: nothing is printed in {where}")


def _check_smoothing(step: Step, problems: Problems) -> None:
    """Report tabular amplitudes of prescribed motion in a dynamic step, whose corners Abaqus smooths."""
    for entry in step.boundaries:
        curve = entry.amplitude
        if curve is None or curve.type is not AmplitudeType.TABULAR or len(curve.data) <= 2 or not entry.magnitude:
            continue
        motion = f"amplitude {curve.name} of prescribed motion in *DYNAMIC"
        if curve.smoothing is None:
            problems.differ(entry.source, f"Abaqus rounds the corners of {motion} by SMOOTH=0.25; here they stay")
        elif curve.smoothing > 0:
            message = f"SMOOTH={curve.smoothing:g} is not supported for {motion}; expected SMOOTH=0"
            problems.add(entry.source, f"*BOUNDARY: {message}")


def _check_perturbation(step: Step, problems: Problems) -> None:
    """Report entries that are meaningless or unsupported in a linear step."""
    for field in step.fields:
        problems.add(field.source, "predefined fields are not supported in a linear perturbation")
    for boundary in step.boundaries:
        if boundary.velocity:
            problems.add(boundary.source, "TYPE=VELOCITY has no meaning in a linear perturbation")
        elif boundary.user and (step.procedure.harmonic or step.procedure.modal):
            procedure = "a harmonic response" if step.procedure.harmonic else "a step by modes"
            problems.add(boundary.source, f"values of DISP are not supported in {procedure}")
    for load in (*step.element_loads, *step.surface_loads):
        if load.type.jltyp and step.procedure.modal:
            problems.add(load.source, "loads by DLOAD are not supported in a step by modes")
        if step.procedure.buckles and load.type.follows and load.type.kind is not LoadKind.PRESSURE:
            message = f"load type {load.type.kind} follows the surface: its load stiffness is not supported in *BUCKLE"
            problems.add(load.source, f"{message}; {_not_following(load)}")
    if step.procedure.harmonic or step.procedure.modal:
        for user_load in step.distributed:
            kind = "harmonic loads" if step.procedure.harmonic else "loads by modes"
            problems.add(user_load.source, f"{kind} on user elements are not supported")
        if any(isinstance(amplitude, UserAmplitude) for amplitude in step.amplitudes):
            over = "frequency" if step.procedure.harmonic else "the time of this step alone"
            problems.add(step.source, f"an amplitude is a function of {over} here, which UAMP cannot give")
        return
    for source in step.varying:
        problems.add(source, "an amplitude has no meaning in a step with PERTURBATION")


def _check_modes(steps: Sequence[Step], problems: Problems) -> None:
    """Report steps that need modes without an earlier *FREQUENCY, and nonzero values of *BOUNDARY in steps by modes."""
    has_modes = False
    for step in steps:
        has_modes = has_modes or step.procedure.finds_modes
        if step.procedure.needs_modes and not has_modes:
            how = "by modes" if step.procedure.modal else "with INTERVAL=EIGENFREQUENCY"
            problems.add(step.source, f"*{step.procedure.keyword} {how} needs a *FREQUENCY step before it")
        for boundary in step.boundaries if step.procedure.modal else ():
            if boundary.magnitude or boundary.amplitude is not None:
                message = "a step by modes moves all supports alike, by *BASE MOTION; values of *BOUNDARY must be zero"
                problems.add(boundary.source, message)


def check_parts(blocks: list[Block], problems: Problems, *, harmonic: bool) -> None:
    """Report REAL and IMAGINARY outside harmonic steps, or together: they exclude each other."""
    for block in blocks:
        options = block.options
        real, imaginary = (options.known(part) and options.flag(part) for part in ("REAL", "IMAGINARY"))
        if (real or imaginary) and not harmonic:
            problems.add(block.source, f"*{block.name}: REAL and IMAGINARY are for *STEADY STATE DYNAMICS")
        elif real and imaginary:
            problems.add(block.source, f"*{block.name}: REAL and IMAGINARY exclude each other")


def _not_following(load: ElementLoad) -> str:
    kind = "EDLD" if load.type.kind in ON_EDGES else "TRVEC"
    return f"{kind} of *DSLOAD with FOLLOWER=NO does not follow it"


def _check_followers(steps: Sequence[Step], problems: Problems) -> None:
    """Report unsupported follower loads with NLGEOM or *BUCKLE: on edges, along local directions of beams, or with a
    perturbation step.
    """
    nonlinear = next((step for step in steps if step.nlgeom), None)
    if nonlinear is None:
        _check_buckling_loads(steps, problems)
        return
    linear = next((step for step in steps if step.procedure.linear), None)
    for load in (load for step in steps for load in (*step.element_loads, *step.surface_loads) if load.type.follows):
        message = f"load type {load.type.kind} follows the surface, which is not supported with NLGEOM"
        if load.type.kind in ON_EDGES:
            problems.add(load.source, f"{message} ({nonlinear.source}); {_not_following(load)}")
            continue
        if load.type.kind is LoadKind.LOCAL_LINE:
            message = "a force along a local direction of a beam follows it, which is not supported with NLGEOM"
            problems.add(load.source, f"{message} ({nonlinear.source})")
        elif linear is not None:
            problems.add(load.source, f"{message} ({nonlinear.source}) beside a perturbation step ({linear.source})")


def _check_buckling_loads(steps: Sequence[Step], problems: Problems) -> None:
    buckling = next((step for step in steps if step.procedure.buckles), None)
    for load in (load for step in steps for load in step.element_loads):
        if buckling is not None and load.type.kind is LoadKind.LOCAL_LINE:
            message = "a force along a local direction of a beam follows it; its load stiffness for *BUCKLE"
            problems.add(load.source, f"{message} ({buckling.source}) is not supported")


def _read_entries(
    scope: Scope, names: tuple[str, ...], read: Callable[[Block], Sequence[Entry]], problems: Problems
) -> tuple[tuple[Entry, ...], bool]:
    """Read the entries of keywords of a step; return them, and whether they replace those of earlier steps."""
    entries: list[Entry] = []
    blocks = [block for block in scope.blocks if block.name in names]
    for block in blocks:
        with problems.gather():
            entries += read(block)
    return tuple(entries), _is_new(blocks, problems)


def _is_new(blocks: list[Block], problems: Problems) -> bool:
    """Return whether OP=NEW; report a step with both OP=NEW and OP=MOD, which Abaqus refuses too."""
    operations = {block.options.text("OP") for block in blocks}
    if len(operations) > 1:
        other = next(block for block in blocks if block.options.text("OP") != blocks[0].options.text("OP"))
        message = f"*{other.name}: OP=NEW and OP=MOD in one step; first OP={blocks[0].options.text('OP')} at "
        problems.add(other.source, message + str(blocks[0].source))
    return operations == {"NEW"}


def _extrapolation(scope: Scope, procedure: Procedure) -> str:
    kind = scope.head.options.text("EXTRAPOLATION")
    if kind == "VELOCITY PARABOLIC" and not procedure.inertia:
        raise scope.head.error("EXTRAPOLATION=VELOCITY PARABOLIC needs velocities, thus *DYNAMIC")
    return kind


def _notes(scope: Scope) -> Iterator[str]:
    """Yield notes on differences between the solution of the step and the deck."""
    for block in scope.blocks:
        if block.name == "SOLUTION TECHNIQUE":
            kind = block.options.text("TYPE")
            yield f"*SOLUTION TECHNIQUE, TYPE={kind} ({block.source}): NEWTON'S METHOD WITH THE FULL MATRIX IS USED"


KEYWORDS = (
    Keyword(
        "STEP",
        "Begin a step.",
        Where.ANY,
        (
            Option("NAME", Kind.NAME, "name"),
            Option("INC", Kind.INTEGER, "largest number of increments (100)"),
            Option("NLGEOM", Kind.SWITCH, "large displacements, from this step on"),
            one_of(
                "EXTRAPOLATION",
                "first guess of an increment",
                ("LINEAR", "PARABOLIC", "VELOCITY PARABOLIC", "NO"),
                default="LINEAR",
            ),
            Option("UNSYMM", Kind.SWITCH, "unsymmetric matrix storage and solution"),
            one_of(
                "AMPLITUDE", "default time variation; RAMP unless given, STEP in transient procedures", ("RAMP", "STEP")
            ),
            Option(
                "CONVERT SDI",
                Kind.SWITCH,
                "an increment may end with a severe discontinuity iteration whose errors are small (YES)",
            ),
            *ignored("SOLVER"),
            Option(
                "PERTURBATION",
                doc="a linear step about the last state, of *STATIC; other procedures say it themselves",
            ),
            *refused("DSA", "SUBDIVIDE"),
        ),
        "title",
    ),
    Keyword("END STEP", "End a step.", Where.STEP),
    Keyword(
        "SOLUTION TECHNIQUE",
        "Always Newton's method with the full matrix: if another is requested, .msg says so.",
        Where.STEP,
        (
            one_of("TYPE", "technique", ("QUASI-NEWTON", "SEPARATED", "UNSYMMETRIC"), default="QUASI-NEWTON"),
            *ignored("REFORM KERNEL"),
        ),
        "ignored",
    ),
)
