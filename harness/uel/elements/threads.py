# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Selection of the elements that several threads may call at the same time."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Final

from uel.elements.block import ElementBlock
from uel.errors import UsageError
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import UserPotential, UserProperty, materials_of
from uel.usersub import Library

MOST_THREADS: Final = 64
"""Largest number of threads, as in fortran/host/guards/protect.c."""

WITHOUT_SHARING: Final = "or take an interface element that has the stress itself (U4, U6, U8, U12) and FACE = 0"


def known_routines(model: Model) -> list[str]:
    """Return the names that the user can declare safe in a model: user element types, and routines of materials."""
    names = {group.type.upper() for group in model.groups if group.definition is not None}
    for group in model.groups:
        names |= _user_routines(group)
    return sorted(names)


def use_threads(blocks: Iterable[ElementBlock], library: Library, number: int, safe: Collection[str]) -> None:
    """Allow several threads in each block that is safe; the others give a warning.

    Parameters
    ----------
    blocks
        Of the system.
    library
        The loaded user routines, which takes the warnings.
    number
        Threads, for the messages.
    safe
        User element types and routines of points (UMAT, UHYPER, ...) in capitals, that the user says several threads
        may call.

    Raises
    ------
    UsageError
        Elements read what others have stored in memory that all threads share.
    """
    warned: set[str] = set()
    for block in blocks:
        reason = _reason_for_one(block.group, library, number, safe)
        block.parallel = not reason
        if reason and reason not in warned:
            warned.add(reason)
            library.warn(reason)


def refuse_shared_stress(model: Model, library: Library, ranks: int) -> None:
    """Raise UsageError where elements read what others have stored, who may be on another rank."""
    for group in model.groups if ranks > 1 else ():
        if group.definition is None or not isinstance(group.section, UserProperty):
            continue
        if library.shares_stress(group.definition.number, group.section.integers):
            raise UsageError(
                f"mpiexec -n {ranks}: elements of type {group.type.upper()} ({group.source}) store or take the stress "
                "of their neighbours in memory that ranks do not share; run in one process, " + WITHOUT_SHARING
            )


def _reason_for_one(group: ElementGroup, library: Library, number: int, safe: Collection[str]) -> str:
    """Return the reason why only one thread may call the elements, '' if several may. Raises UsageError."""
    kind = group.type.upper()
    if group.definition is not None:
        assert isinstance(group.section, UserProperty)  # build_blocks has refused others
        if library.shares_stress(group.definition.number, group.section.integers):
            raise UsageError(
                f"--cpus {number}: elements of type {kind} ({group.source}) store or take the stress of their "
                f"neighbours in memory that all threads share; run with --cpus 1, {WITHOUT_SHARING}"
            )
        if not library.is_own and kind not in safe:
            return _undeclared(f"elements of type {kind}", [kind], number)
    missing = sorted(_user_routines(group).difference(safe))
    if missing:
        return _undeclared(f"elements of type {kind}", missing, number)
    for material in materials_of(group.section):
        if material.elastic is not None and material.elastic.table is not None:
            return (
                f"elements of type {kind} are called by one thread: *ELASTIC of material {material.name} depends on "
                "temperature or field variables"
            )
    return ""


def _user_routines(group: ElementGroup) -> set[str]:
    """Return the user routines that elements call at their points."""
    names: set[str] = set()
    for material in materials_of(group.section):
        routines: dict[str, object] = {"UMAT": material.user, "USDFLD": material.user_field}
        routines |= {"UMATHT": material.user_thermal, "HETVAL": material.heat_generation}
        if isinstance(material.hyperelastic, UserPotential):
            routines[material.hyperelastic.routine] = material.hyperelastic
        if any(network.user is not None for network in material.networks):
            routines["UCREEPNETWORK"] = material.networks
        if any(network.shift is not None for network in material.networks):
            routines["UTRSNETWORK"] = material.networks
        if material.plastic is not None:
            routines["UHARD"] = material.plastic.user
        if material.creep is not None and material.creep.user:
            routines["CREEP"] = material.creep
        names |= {name for name, given in routines.items() if given is not None}
    return names


def _undeclared(what: str, missing: list[str], number: int) -> str:
    options = " ".join(f"--thread-safe {name}" for name in missing)
    return (
        f"{what} are called by one thread; {options} lets {number} threads call them, if the user's file passes the "
        "checks 'shuffle' and 'threads' of uel check"
    )
