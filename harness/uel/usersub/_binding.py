# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Typed interface to the element loop, the integration rules and the state of the compiled host.

Its materials are in `_materials`, what is called at points in `_points`.
"""

from __future__ import annotations

import os
from typing import Final

import numpy as np

from uel.model.arrays import FloatArray
from uel.usersub._extension import host
from uel.usersub.exchange import BlockArrays, Called, Int32Array, LoadArrays, Moment, Outcome, RawMessage, UnknownFields
from uel.usersub.faults import Entries, Fault, Guards

ARRAYS: Final = ("RHS", "AMATRX", "SVARS", "ENERGY", "PROPS", "COORDS", "U", "DU", "V", "A", "PREDEF")
"""Guarded arrays, in the order of fortran/host/driver/workspace.f90."""


POINT_ROUTINES: Final = (
    *("", "UMAT", "USDFLD", "UMATHT", "HETVAL", "DFLUX", "FILM", "UHYPER", "UANISOHYPER_INV", "UHARD"),
    *("UCREEPNETWORK", "UTRSNETWORK", "UVARM", "CREEP"),
)
"""Routines of points, in the order of fortran/host/driver/driver.f90."""

_STRAIN_ENERGY: Final = 1
"""Index of ENERGY(2)."""


_FAULTS: Final = tuple(Fault)

_watching = False


def evaluate(
    called: Called,
    arrays: BlockArrays,
    options: tuple[bool, bool, Guards, Entries, bool],
    moment: Moment,
    unknowns: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    loads: LoadArrays,
    predef: FloatArray,
    floor: FloatArray,
    fields: UnknownFields,
    residual: FloatArray,
    matrix: FloatArray,
) -> Outcome:
    """Make one pass over a block.

    options are: (A + A^T)/2 is assembled, AMATRX is assembled, what a write outside an array does, what an entry that
    is not set does, several threads may call. unknowns are u and du, (n,), v and a, (n,), or (1,) where nothing moves;
    predef is (m, nodes, fields, 2), or (1, nodes, fields, 2) if it is the same for all elements; floor (ndofel,);
    residual (NRHS, n), whose rows take the columns of RHS.
    """
    if _watching:
        called = called._replace(address=host.host_watch(called.address, called.material))
    # by position: to match some forty names takes as long as a call of several elements
    flux, pnewdt, energy, fault, position, array, item, alone = host.host_evaluate(
        called.address,
        called.material,
        called.jtype,
        called.tensor,
        *arrays.reversed,
        *options,
        moment.kstep,
        moment.kinc,
        moment.iteration,
        moment.time,
        moment.dtime,
        moment.period,
        moment.params,
        moment.lflags,
        *unknowns,
        loads.counts,
        loads.kinds.T,
        loads.values.T,
        predef.T,
        floor,
        fields.of,
        fields.number,
        residual.T,
        matrix,
    )
    ended_by_user = fault == Fault.LEFT
    return Outcome(
        _FAULTS[fault],
        position - 1,
        "" if ended_by_user else ARRAYS[array - 1],
        POINT_ROUTINES[array] if ended_by_user else "",
        item,
        flux.T,
        pnewdt,
        energy,
        alone,
    )


def exchange_guard_values(values: FloatArray) -> None:
    """Exchange the values of the guards of each of ARRAYS and, last, of RHS and AMATRX before a call."""
    host.host_exchange_guard_values(values)


def exchange_room(entries: int) -> int:
    """Set the least number of entries of the guards after the arrays; return the former one."""
    room = np.array([entries], dtype=np.int32)
    host.host_exchange_room(room)
    return int(room[0])


def watch_inputs(on: bool) -> bool:
    """Set whether `evaluate` detects changes of inputs by the elements; return the former setting."""
    global _watching
    before, _watching = _watching, on
    return before


def take_changes() -> tuple[Int32Array, FloatArray]:
    """Return the first changed entries (37,) of the arguments since the last call (0: none), and values (37, 2)."""
    entries, values = host.host_take_changes()
    return entries, values.T


def fill_stack(number: float | None) -> None:
    """Fill local variables with a number at the start of watched calls of elements; None: do not fill them."""
    host.host_fill_stack(int(number is not None), number or 0.0)


def exchange_around(argument: int, number: float) -> float:
    """Surround an argument (from 0) with a number in watched calls; return the former one."""
    value = np.array([number], dtype=np.float64)
    host.host_exchange_around(argument, value)
    return float(value[0])


def take_outside() -> dict[int, int]:
    """Return the arguments (from 0) with writes outside since the last call, and the entry, from 1."""
    written, entries = host.host_take_outside()
    return {k: int(entries[k]) for k in np.flatnonzero(written).tolist()}


def allocated() -> int:
    """Return the bytes allocated by this process; negative if the C library does not provide them."""
    return int(host.host_allocated())


def bare_loop(
    called: Called, arrays: BlockArrays, moment: Moment, u: FloatArray, du: FloatArray, residual: FloatArray
) -> None:
    """Call the elements from a plain loop, the reference for the run time of `evaluate`."""
    ndofel = arrays.equations.shape[1]
    host.host_bare_loop(
        address=called.address,
        material=called.material,
        jtype=called.jtype,
        kstep=moment.kstep,
        kinc=moment.kinc,
        lflags=np.array(moment.lflags, dtype=np.int32),
        time=moment.time,
        dtime=moment.dtime,
        period=moment.period,
        labels=arrays.labels,
        jprops=arrays.jprops,
        equations=arrays.equations.T,
        props=arrays.props,
        coords=arrays.coords.T,
        u=u,
        du=du,
        svars=arrays.svars.T,
        svars_trial=arrays.svars_trial.T,
        energy=arrays.energy.T,
        energy_trial=arrays.energy_trial.T,
        residual=residual,
        amatrx=np.zeros((ndofel, ndofel)).T,
    )


def linear_pass(
    matrices: FloatArray,
    equations: Int32Array,
    first: Int32Array,
    u: FloatArray,
    floor: FloatArray,
    fields: UnknownFields,
    residual: FloatArray,
) -> Outcome:
    """Add the forces of linear elements to residual (n,) without calling the elements.

    matrices (m, ndofel, ndofel), each by columns; equations (m, ndofel), from 1; first, floor (ndofel,): the
    entry of U, from 1, that is taken out of each one before the product, 0 for none. ENERGY(2) is what they store.
    """
    flux, stored = host.host_linear_pass(matrices.T, equations.T, first, u, floor, fields.of, residual, fields.number)
    energy = np.zeros(8)
    energy[_STRAIN_ENERGY] = stored
    return Outcome(Fault.NONE, -1, ARRAYS[0], "", 0, flux.T, np.inf, energy, 0)


def scatter_map(equations: Int32Array, indptr: Int32Array, indices: Int32Array) -> Int32Array:
    """Return positions (m, ndofel, ndofel) of (row, column) of element matrices in the values of a CSR matrix.

    equations (m, ndofel) from 0; the matrix has all their entries, columns ascending in each row.
    """
    m, n = equations.shape
    positions = np.zeros((m, n, n), dtype=np.int32)
    if m:
        host.host_scatter_map(equations.T, indptr, indices, positions.T)
    # the driver walks matrices by columns, so that this is a view
    return positions.transpose(0, 2, 1)


def add_matrices(matrices: FloatArray, positions: Int32Array, matrix: FloatArray) -> None:
    """Add matrices of elements, each by columns, to matrix (nnz,); places, from 1, has the same shape (m, n, n)."""
    host.host_add_matrices(matrices.T, positions.T, matrix)


def external_database(
    address: int, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
) -> bool:
    """Call UEXTERNALDB; False if it ended the analysis."""
    return not host.host_external_database(address, lop, lrestart, time, dtime, step, increment)


def define_heat_load(
    *, law: int, address: int | None, surface: str, jltyp: int, absolute_zero: float, stefan_boltzmann: float
) -> int:
    """Add a flux, a film or radiation to those the host knows; returns its number there.

    Parameters
    ----------
    law
        0 a flux, 1 a film, 2 radiation.
    address
        Of DFLUX or FILM; None where the deck gives the magnitudes.
    surface, jltyp
        SNAME and JLTYP of the routine.
    absolute_zero, stefan_boltzmann
        Constants of radiation.
    """
    constants = absolute_zero, stefan_boltzmann
    return int(host.host_define_heat_load(law, address or 0, surface, jltyp, *constants))


def integration_rule(family: int, points: int, nodes: int, dimension: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return weights (points,), shape functions (points, nodes), derivatives (points, nodes, dimension) of a family.

    The derivatives are with respect to parent coordinates. Raises ValueError if the host has no such rule.
    """
    weights, shapes, slopes = np.zeros(points), np.zeros((points, nodes)), np.zeros((points, dimension, nodes))
    if not host.host_rule(family, weights, shapes.T, slopes.T):
        raise ValueError(f"the host has no family {family} of {nodes} nodes with {points} integration points")
    return weights, shapes, slopes.transpose(0, 2, 1)


def define_rule(family: int, parent: FloatArray, weights: FloatArray, *, reduced: bool) -> int:
    """Add a family with integration points at parent coordinates (points, dimension); returns its number.

    With any other number of points it is the given family. reduced: of an element with hourglass control.
    """
    return int(host.host_define_rule(family, parent.T, weights, reduced))


def slopes_at_nodes(family: int, nodes: int) -> FloatArray:
    """Return derivatives (places, nodes, 2) of a surface's shape functions by parent coordinates, at each node."""
    slopes = np.zeros((nodes, 2, nodes))
    host.host_slopes_at_nodes(family, slopes.T)
    return slopes.transpose(0, 2, 1)


def address_of(elements: str) -> int:
    """Return the address of built-in elements by their name in fortran/host/driver/built_in.f90.

    Raises ValueError if the host has no such elements.
    """
    address = int(host.host_element_address(elements))
    if not address:
        raise ValueError(f"the host has no elements called {elements!r}")
    return address


def take_messages() -> list[RawMessage]:
    """Return the messages of STDB_ABQERR since the last call, oldest first."""
    messages: list[RawMessage] = []
    while True:
        level, (element, step, increment), text = host.host_take_message()
        if not level:
            return messages
        messages.append(
            RawMessage(level, int(element), int(step), int(increment), text.decode(errors="replace").rstrip())
        )


def open_job(name: str, directory: str, file6: str, file7: str, *, alone: bool) -> int:
    """Set the job for GETJOBNAME and GETOUTDIR and connect units 6 and 7.

    alone: no other job of this process is open, so the materials of earlier ones are dropped.
    Returns 0, the number of an error, or -1 if an abandoned call of an earlier job has them locked inside a WRITE.
    """
    encode = os.fsencode
    return int(host.host_open_job(encode(name), encode(directory), encode(file6), encode(file7), alone))


def set_threads(number: int) -> None:
    """Set the number of threads that call the elements of the jobs of this process, where possible."""
    host.host_set_threads(number)


def set_rank(rank: int, ranks: int) -> None:
    """Set rank and number of the processes of the job for user routines (GETRANK, GETNUMCPUS)."""
    host.host_set_rank(rank, ranks)


def limit_calls(seconds: float) -> None:
    """Set the time limit (s, wall clock) of each call of a user routine, after which it ends with an error; 0: none."""
    host.host_limit_calls(seconds)


def trap(on: bool) -> bool:
    """Set whether user routines stop at the operation that makes a NaN or an infinity; return the former setting."""
    return bool(host.host_trap(int(on)))


def sanitizing() -> bool:
    """Return whether this process has the runtime of AddressSanitizer, see harness/uel/running/sanitizer.py."""
    return bool(host.host_sanitizing())


def sanitize(on: bool) -> None:
    """Set whether the current library is built with AddressSanitizer."""
    host.host_sanitize(int(on))


def take_frames() -> list[int]:
    """Return and clear the addresses of the call stack at the last signal, innermost first."""
    addresses, count = host.host_take_frames()
    return [int(address) for address in addresses[:count]]


def share_slate(descriptor: int) -> bool:
    """Note calls on the slate, an open file as long as `uel.shared_progress.Slate`; False if that fails."""
    return not host.host_share(descriptor)


def set_loading(begins: bool) -> None:
    """Note on the slate whether constructors of user code may be running."""
    host.host_loading(int(begins))


def flush_units(*, close: bool = False) -> bool:
    """Write out what user routines printed to units 6 and 7; False if an abandoned call has the units locked."""
    return not host.host_flush(int(close))
