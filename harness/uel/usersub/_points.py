# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Typed interface to user routines of points, nodes and amplitudes (fortran/host/entry/points.f90)."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uel.model.arrays import FloatArray
from uel.model.user_values import AskedAmplitude, UserValues
from uel.usersub._extension import host, padded
from uel.usersub.exchange import BlockArrays, Int32Array

VALUE_ROUTINES: Final = ("DISP", "DLOAD", "UTEMP", "UFIELD")
"""Routines that give values, in the order of fortran/host/routines/values.f90."""


def uvarm(
    address: int,
    names: tuple[str, str],
    axes: FloatArray,
    counts: tuple[int, int, int, int],
    step_increment: tuple[int, int],
    clock: tuple[float, float, float],
    arrays: BlockArrays,
    hidden: int,
    uvar: FloatArray,
    *,
    local: bool,
) -> tuple[int, int]:
    """Call UVARM at the points of a block; returns element and point at which it ended the analysis, 0 if it did not.

    names are of the material and its orientation, axes (m or 1, points or 1, 3, 3) its directions in rows, counts the
    stress components, NSTATV, the number of the family, and 1 if the history begins with a plastic strain, place step
    and increment, clock the times at the start and the time increment; the last `hidden` SVARS belong to no point;
    uvar (m, points, NUVARM); local: the history is in these directions.
    """
    m, points, _ = uvar.shape
    count = arrays.svars.shape[1] - hidden
    svars = np.ascontiguousarray(arrays.svars[:, :count]).reshape(m, points, count // points)
    history = arrays.history if arrays.history.shape[1] == points else np.zeros((m, points, 1))
    ended, element, point = host.host_uvarm_pass(
        address,
        padded(names),
        axes.transpose(2, 3, 1, 0),
        (*counts, int(local)),
        step_increment,
        clock,
        arrays.labels,
        arrays.coords.T,
        svars.T,
        history.T,
        uvar.T,
    )
    return (element, point) if ended else (0, 0)


def sdvini(address: int, arrays: BlockArrays, statev: FloatArray, family: int) -> tuple[int, int]:
    """Call SDVINI at the points of a block; returns element and point at which it ended the analysis, 0 if it did not.

    statev (m, points, NSTATV), contiguous, is changed; family: its number for built-in elements, else 0.
    """
    ended, element, point = host.host_sdvini_pass(address, family, arrays.labels, arrays.coords.T, statev.T)
    return (element, point) if ended else (0, 0)


def sigini(address: int, element_type: str, arrays: BlockArrays, sigma: FloatArray, family: int) -> tuple[int, int]:
    """Call SIGINI at the points of a block of built-in elements.

    sigma (m, points, NTENS), contiguous, is what SIGINI leaves. Returns element and point at which it ended the
    analysis, 0 if it did not.
    """
    of_points = arrays.labels, arrays.coords.T, sigma.T
    ended, element, point = host.host_sigini_pass(address, element_type, family, *of_points)
    return (element, point) if ended else (0, 0)


def orient(
    address: int, name: str, arrays: BlockArrays, nodes: Int32Array, family: int, points: int
) -> tuple[FloatArray, int, int]:
    """Call ORIENT at the points of a block of built-in elements.

    name is of the orientation, nodes (m, nnode) their numbers. Returns the directions (m, points, 3, 3), in rows, as
    ORIENT leaves them, then element and point at which it ended the analysis, 0 if it did not.
    """
    axes = np.zeros((len(nodes), points, 3, 3))
    of_points = arrays.labels, nodes.T, arrays.coords.T
    ended, element, point = host.host_orient_pass(address, name, family, *of_points, axes.T)
    return (axes, element, point) if ended else (axes, 0, 0)


def user_values(address: int, request: UserValues, values: FloatArray) -> int:
    """Call a routine for all nodes or points; return the call, from 1, that ended the analysis, else 0.

    values (n,) are those of the deck, and become those of the routine.
    """
    moment = (request.step, request.increment), (*request.time, request.size)
    coords = np.ascontiguousarray(request.coords)
    temperatures = np.zeros((len(values), 2)) if request.temperatures is None else request.temperatures
    routine = 1 + VALUE_ROUTINES.index(request.routine)
    ended, last = host.host_value_pass(routine, address, *moment, request.numbers.T, coords.T, temperatures.T, values)
    return last if ended else 0


def user_amplitude(address: int, request: AskedAmplitude) -> tuple[float, FloatArray, NDArray[np.int32], bool]:
    """Call UAMP: the value (NaN where it sets none), the state, lFlagsDefine, and whether it ended the analysis."""
    clock = (*request.time, request.size, request.old)
    info = (int(not request.increment), int(request.increment > 0), request.cutbacks, request.step, request.increment)
    counts = len(request.properties), len(request.state), len(request.sensors)
    # an array has one entry more than UAMP is told, because none may be empty
    properties, state = np.append(request.properties, 0.0), np.append(request.state, 0.0)
    sensors = np.array([*request.sensors.values(), 0.0]), padded((*request.sensors, ""))
    arguments = request.name, clock, properties, state, info, *sensors, counts
    value, define, ended = host.host_uamp_call(address, *arguments, np.nan)
    return float(value), state[: len(request.state)], define, bool(ended)


POINT_REALS: Final = 13
"""Reals of a cohesive_point in host/materials/traction_separation.f90: separation (3), traction (3), damage, energies
that damage dissipates (3), that of the viscosity, damage without viscosity, initiation criterion.
"""


def traction_separation(
    law: tuple[FloatArray, Int32Array], time: float, separations: FloatArray, old: FloatArray
) -> tuple[FloatArray, FloatArray, tuple[int, float] | None]:
    """Return the traction-separation response of points: states (m, POINT_REALS) and tangents (m, 3, 3).

    Also return the row of a point whose fracture energy at the mode mix is below the elastic energy at the onset of
    damage, and by how much.

    Parameters
    ----------
    law
        Reals and integers of the law: traction_separation in fortran/built_in.toml.
    time
        Length of the increment.
    separations
        (m, 3) normal and shear separations.
    old
        (m, POINT_REALS) states at the start of the increment.
    """
    new, tangents, brittle, fault = np.zeros_like(old), np.zeros((len(old), 3, 3)), 0, 0.0
    # f2py knows no empty arrays
    if len(old):
        brittle, fault = host.host_traction_separation(*law, time, separations.T, old.T, new.T, tangents.T)
    return new, tangents.transpose(0, 2, 1), (brittle - 1, fault) if brittle else None
