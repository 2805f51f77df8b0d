# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The only module that imports the compiled host (fortran/host); everything above it is typed Python.

The extension is loaded with RTLD_GLOBAL: user libraries find XIT, MATERIAL_LIB_MECH and the rest in it by name.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Final, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from harness.errors import UelError
from harness.model.arrays import FloatArray
from harness.model.user_values import AskedAmplitude, UserValues
from harness.usersub.exchange import BlockArrays, Int32Array, LoadArrays, Outcome, RawMessage, UnknownFields
from harness.usersub.faults import Fault

# threads that wait for each other give their core away soon: on a busy machine another process has work for it
os.environ.setdefault("GOMP_SPINCOUNT", "2000")
_flags = sys.getdlopenflags()
sys.setdlopenflags(_flags | os.RTLD_GLOBAL)
try:
    from harness.usersub import _host
except ImportError as error:
    raise UelError(f"the compiled host does not load: {error}; `uel doctor` says what to do") from None
finally:
    sys.setdlopenflags(_flags)

ARRAYS: Final = ("RHS", "AMATRX", "SVARS", "ENERGY", "PROPS", "COORDS", "U", "DU", "V", "A", "PREDEF")
"""Guarded arrays, in the order of fortran/host/host_workspace.f90."""


POINT_ROUTINES: Final = (
    "",
    "UMAT",
    "USDFLD",
    "UMATHT",
    "HETVAL",
    "DFLUX",
    "FILM",
    "UHYPER",
    "UANISOHYPER_INV",
    "UHARD",
    "UCREEPNETWORK",
    "UTRSNETWORK",
    "UVARM",
    "CREEP",
)
"""Routines of points, in the order of fortran/host/host_driver.f90."""

VALUE_ROUTINES: Final = ("DISP", "DLOAD", "UTEMP", "UFIELD")
"""Routines that give values, in the order of fortran/host/host_values.f90."""

_STRAIN_ENERGY: Final = 1
"""Index of ENERGY(2)."""


class Scalars(TypedDict):
    """Scalar arguments of a pass, as host_evaluate in fortran/host/entry.f90 has them."""

    address: int
    material: int
    jtype: int
    kstep: int
    kinc: int
    time: tuple[float, float]
    dtime: float
    period: float


class PassOptions(TypedDict):
    """Arguments that a plain loop does not need."""

    tensor: int
    symmetric: bool
    want_matrix: bool
    guards: int
    entries: int
    iteration: int
    parallel: bool
    params: tuple[float, float, float]


_watching = False


def evaluate(
    scalars: Scalars,
    options: PassOptions,
    lflags: tuple[int, ...],
    arrays: BlockArrays,
    u: FloatArray,
    du: FloatArray,
    v: FloatArray,
    a: FloatArray,
    loads: LoadArrays,
    predef: FloatArray,
    floor: FloatArray,
    fields: UnknownFields,
    residual: FloatArray,
    matrix: FloatArray,
) -> Outcome:
    """One pass over a block; lflags is LFLAGS(1..7).

    v and a are (n,), or (1,) where nothing moves; predef is (m, nodes, fields, 2), or (1, nodes, fields, 2) if it is
    the same for all elements; floor (ndofel,); residual (NRHS, n), whose rows take the columns of RHS.
    """
    if _watching:
        scalars = {**scalars, "address": _host.host_watch(scalars["address"], scalars["material"])}
    flux, pnewdt, energy, fault, position, array, item, alone = _host.host_evaluate(
        **scalars,
        **options,
        lflags=lflags,
        labels=arrays.labels,
        jprops=arrays.jprops,
        equations=arrays.equations.T,
        map=arrays.map.T,
        props=arrays.props,
        coords=arrays.coords.T,
        u=u,
        du=du,
        v=v,
        a=a,
        counts=loads.counts,
        kinds=loads.kinds.T,
        loads=loads.values.T,
        predef=predef.T,
        floor=floor,
        field=fields.of,
        svars=arrays.svars.T,
        svars_trial=arrays.svars_trial.T,
        energy=arrays.energy.T,
        energy_trial=arrays.energy_trial.T,
        history=arrays.history.T,
        history_trial=arrays.history_trial.T,
        residual=residual.T,
        matrix=matrix,
        fluxes=fields.number,
    )
    left = fault == Fault.LEFT
    return Outcome(
        fault=Fault(fault),
        position=position - 1,
        array="" if left else ARRAYS[array - 1],
        routine=POINT_ROUTINES[array] if left else "",
        item=item,
        flux=flux.T,
        pnewdt=pnewdt,
        energy=energy,
        alone=alone,
    )


def exchange_guard_values(values: FloatArray) -> None:
    """Exchange the values of the guards of each of ARRAYS and, last, of RHS and AMATRX before a call."""
    _host.host_exchange_guard_values(values)


def exchange_room(entries: int) -> int:
    """From now on guards after the arrays have at least this many entries; returns the number before."""
    room = np.array([entries], dtype=np.int32)
    _host.host_exchange_room(room)
    return int(room[0])


def watch_inputs(on: bool) -> bool:
    """Let `evaluate` note from now on which inputs the elements change, or not; returns whether it did before."""
    global _watching
    before, _watching = _watching, on
    return before


def take_changes() -> tuple[Int32Array, FloatArray]:
    """First entry (37,) of each argument that was changed since the last call (0: none), and values (37, 2)."""
    entries, values = _host.host_take_changes()
    return entries, values.T


def fill_stack(number: float | None) -> None:
    """From now on local variables hold a number at the start of watched calls of elements; None: whatever is there."""
    _host.host_fill_stack(int(number is not None), number or 0.0)


def exchange_around(argument: int, number: float) -> float:
    """From now on a number surrounds an argument (from 0) in watched calls; returns the one before."""
    held = np.array([number], dtype=np.float64)
    _host.host_exchange_around(argument, held)
    return float(held[0])


def take_outside() -> dict[int, int]:
    """Arguments (from 0) outside which something was written since the last call, with the entry, from 1."""
    found, entries = _host.host_take_outside()
    return {k: int(entries[k]) for k in np.flatnonzero(found).tolist()}


def allocated() -> int:
    """Bytes that this process has allocated; negative if the C library does not tell."""
    return int(_host.host_allocated())


def bare_loop(
    scalars: Scalars,
    lflags: tuple[int, ...],
    arrays: BlockArrays,
    u: FloatArray,
    du: FloatArray,
    residual: FloatArray,
) -> None:
    """Call the elements from a plain loop: what `evaluate` is measured against."""
    ndofel = arrays.equations.shape[1]
    _host.host_bare_loop(
        **scalars,
        lflags=np.array(lflags, dtype=np.int32),
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
    """Add the forces of elements that are linear to residual (n,): what a pass over them would, without calling them.

    matrices (m, ndofel, ndofel), each by columns; equations (m, ndofel), from 1; first, floor (ndofel,): the
    entry of U, from 1, that is taken out of each one before the product, 0 for none. ENERGY(2) is what they store.
    """
    flux, stored = _host.host_linear_pass(matrices.T, equations.T, first, u, floor, fields.of, residual, fields.number)
    energy = np.zeros(8)
    energy[_STRAIN_ENERGY] = stored
    return Outcome(Fault.NONE, -1, ARRAYS[0], "", 0, flux.T, np.inf, energy, 0)


def scatter_map(equations: Int32Array, indptr: Int32Array, indices: Int32Array) -> Int32Array:
    """Positions (m, ndofel, ndofel) of (row, column) of element matrices in the values of a CSR matrix, from 0.

    equations (m, ndofel) from 0; the matrix has all their entries, columns ascending in each row.
    """
    m, n = equations.shape
    places = np.zeros((m, n, n), dtype=np.int32)
    if m:
        _host.host_scatter_map(equations.T, indptr, indices, places.T)
    # the driver walks matrices by columns, so that this is a view
    return places.transpose(0, 2, 1)


def add_matrices(matrices: FloatArray, places: Int32Array, matrix: FloatArray) -> None:
    """Add matrices of elements, each by columns, to matrix (nnz,); places, from 1, has the same shape (m, n, n)."""
    _host.host_add_matrices(matrices.T, places.T, matrix)


def external_database(
    address: int, lop: int, lrestart: int, time: tuple[float, float], dtime: float, step: int, increment: int
) -> bool:
    """Call UEXTERNALDB; False if it ended the analysis."""
    return not _host.host_external_database(address, lop, lrestart, time, dtime, step, increment)


def define_material(
    stiffness: FloatArray,
    compliance: FloatArray,
    thickness: FloatArray,
    axes: FloatArray,
    constants: tuple[float, float],
    table: FloatArray,
) -> int:
    """Add a material to the host's library; arguments as in fortran/host/entry_materials.f90."""
    return int(_host.host_define_material(stiffness.T, compliance.T, thickness, axes, constants, table.T))


def define_hyperelastic(
    ntens: int,
    polynomial: FloatArray,
    ogden: FloatArray,
    volumetric: FloatArray,
    *,
    logarithmic: bool,
    moduli: tuple[float, float],
) -> int:
    """Add a hyperelastic material to the host's library.

    polynomial (7, 7) coefficients of powers of I1 - 3 and I2 - 3; ogden (6, 2) mu and alpha; volumetric (6) 1/D;
    logarithmic: the volumetric energy is that of Arruda and Boyce; moduli: initial Young's modulus and Poisson's ratio,
    for the enhanced hourglass control.
    """
    return int(_host.host_define_hyperelastic(ntens, polynomial, ogden.T, volumetric, logarithmic, moduli))


def set_networks(number: int, networks: Sequence[tuple[float, int, Sequence[float]]], statev: int) -> None:
    """Give a hyperelastic material networks that creep: ratio, law and constants of each, as the host has them."""
    ratios, laws, constants = zip(*networks, strict=True)
    padded = np.array([[*given, *[0.0] * (5 - len(given))] for given in constants])
    _host.host_set_networks(number, np.array(ratios), np.array(laws, np.int32), padded.T, statev)


def set_network_routine(
    number: int, network: int, address: int, name: str, constants: FloatArray, *, shifts: bool
) -> None:
    """Let UCREEPNETWORK give the creep of a network, from 1, or, if it shifts, UTRSNETWORK its reduced time."""
    given = np.append(constants, 0.0)
    _host.host_set_network_routine(number, network, address, name, shifts, given, len(constants))


def define_user_potential(uhyper: int, name: str, ntens: int, statev: int, constants: FloatArray) -> int:
    """Add a hyperelastic material of UHYPER, whose address is given, to the host's library."""
    given = np.append(constants, 0.0)
    return int(_host.host_define_user_potential(uhyper, name, ntens, statev, given, len(constants)))


def define_anisotropic(ntens: int, directions: FloatArray, holzapfel: Sequence[float], compliance: float) -> int:
    """Add a hyperelastic material with preferred directions to the host's library; returns its number there.

    directions  (m, 3) unit vectors in the axes of the material; m may be 0
    holzapfel   C10, k1, k2, kappa
    compliance  D
    """
    given = np.vstack([directions, np.zeros((1, 3))]).T
    return int(_host.host_define_anisotropic(ntens, given, len(directions), holzapfel, compliance))


def set_user_invariants(number: int, uanisohyper: int, name: str, statev: int, constants: FloatArray) -> None:
    """Let UANISOHYPER_INV, whose address is given, give the energy of a material of `define_anisotropic`."""
    _host.host_set_user_invariants(number, uanisohyper, name, statev, np.append(constants, 0.0), len(constants))


def set_expansion(number: int, table: FloatArray, zero: float) -> None:
    """Give a material of the host's library thermal expansion; table (k, 7) as that of `Expansion`."""
    _host.host_set_expansion(number, table.T, zero)


def compliance(constants: Sequence[float]) -> FloatArray:
    """Compliance (6, 6) of E1, E2, E3, nu12, nu13, nu23, G12, G13, G23; 11, 22, 33, 12, 13, 23, engineering shear."""
    return _host.host_compliance(np.array(constants))


def set_prestressed(number: int) -> None:
    """Give points of a material of the host's library, other than UMAT's, a history for initial stresses."""
    _host.host_set_prestressed(number)


def set_backstresses(number: int, backstresses: FloatArray, growth: tuple[float, float]) -> None:
    """Let the yield surface of a plastic material move, and grow exponentially beside its table.

    backstresses (k, 2) C and gamma; growth: Q and b.
    """
    _host.host_set_backstresses(number, backstresses.T, growth)


def set_user_hardening(
    number: int, uhard: int, name: str, constants: tuple[float, float], statev: int, properties: FloatArray
) -> None:
    """Let UHARD, whose address is given, give the yield stress of an isotropic material.

    constants: Young's modulus and Poisson's ratio; properties: PROPS.
    """
    _host.host_set_user_hardening(number, uhard, name, *constants, statev, np.append(properties, 0.0), len(properties))


def set_prony(number: int, constants: tuple[float, float], moduli: tuple[float, float], terms: FloatArray) -> None:
    """Let stresses of an isotropic material relax.

    constants: long-term Young's modulus and Poisson's ratio; moduli: instantaneous shear and bulk modulus; terms (n, 3)
    g, k, tau.
    """
    _host.host_set_prony(number, constants, moduli, terms.T)


def set_creep(number: int, constants: tuple[float, float], law: tuple[float, float, float], *, by_time: bool) -> None:
    """Let an isotropic material creep: Young's modulus and Poisson's ratio; A, n and m of time or strain hardening."""
    _host.host_set_creep(number, constants, by_time, law)


def set_user_creep(number: int, creep: int, name: str, constants: tuple[float, float], statev: int) -> None:
    """Let CREEP, whose address is given, give the creep law of an isotropic material.

    constants: Young's modulus and Poisson's ratio.
    """
    _host.host_set_user_creep(number, creep, name, constants, statev)


def set_dependence(number: int, constants: int, turn: FloatArray, table: FloatArray) -> None:
    """Let the elastic constants of a material depend on temperature and field variables.

    table (k, constants + variables); turn (6, 6) stress components in global axes to those of the material.
    """
    _host.host_set_dependence(number, constants, turn, table.T)


def set_local(number: int) -> None:
    """Let a material of the host's library take strains and give stresses in the directions of each point."""
    _host.host_set_local(number)


def set_user_field(number: int, address: int, names: tuple[str, str], statev: int, room: int, axes: FloatArray) -> None:
    """Let USDFLD give the field variables of a material; names: of the material and its orientation.

    room: values at the end of the history of which the `statev` STATEV are the first.
    """
    _host.host_set_user_field(number, address, _padded(names), statev, room, axes)


def set_user_output(number: int, address: int, names: tuple[str, str], counts: tuple[int, int, int, int]) -> None:
    """Let UVARM give output variables of a material in elements that call it themselves; names as set_user_field.

    counts: NUVARM and the values of the history for UVAR, then NSTATV and the values at its end for STATEV.
    """
    _host.host_set_user_output(number, address, _padded(names), counts)


def define_user_material(
    umat: int, name: str, ntens: int, constants: FloatArray, hybrid: int, statev: int, room: int
) -> int:
    """Add a material of UMAT, whose address is given, to the host's library.

    hybrid: 1 for the total formulation of hybrid elements, 2 for that of incompressible materials; statev, room: as
    set_user_field has them.
    """
    values = np.append(constants, 0.0)
    return int(_host.host_define_user_material(umat, name, ntens, hybrid, statev, room, values, len(constants)))


def define_empty_material() -> int:
    """Add a material to the host's library that has nothing yet."""
    return int(_host.host_define_empty_material())


def set_thermal(
    number: int, density: float, conductivity: FloatArray, specific_heat: FloatArray, latent_heat: FloatArray
) -> None:
    """Give a material conductivity (k, 2) and specific heat (k, 2) with temperatures, latent heat (k, 3)."""
    tables = [np.vstack([table, np.zeros((1, table.shape[1]))]) for table in (conductivity, specific_heat, latent_heat)]
    counts = len(conductivity), len(specific_heat), len(latent_heat)
    _host.host_set_thermal(number, density, counts, *(table.T for table in tables))


def set_diffusion(
    number: int,
    *,
    fick: bool,
    absolute_zero: float,
    axes: FloatArray,
    diffusivity: FloatArray,
    solubility: FloatArray,
    soret: FloatArray,
    pressure: FloatArray,
) -> None:
    """Give a material the constants of diffusion.

    Parameters
    ----------
    number
        Of the material.
    fick
        Fick's law, else the general one.
    absolute_zero
        On the scale of the temperatures.
    axes
        (3, 3) directions, in rows, in which fluxes are put out.
    diffusivity
        (k, 8) D11, D12, D22, D13, D23, D33 in global directions, concentration, temperature.
    solubility
        (k, 2) solubility, temperature.
    soret, pressure
        (k, 3) kappa_s and kappa_p, concentration, temperature; k = 0: none.
    """
    tables = diffusivity, solubility, soret, pressure
    padded = [np.vstack([table, np.zeros((1, table.shape[1]))]).T for table in tables]
    counts = tuple(map(len, tables))
    _host.host_set_diffusion(number, int(fick), absolute_zero, axes, counts, *padded)


def set_hetval(number: int, address: int, name: str, statev: int) -> None:
    """Let HETVAL generate heat in a material with `set_thermal`; its name and number of STATEV."""
    _host.host_set_user_thermal(number, 0, address, name, statev, np.zeros(1), 0)


def set_umatht(number: int, address: int, name: str, statev: int, constants: FloatArray) -> None:
    """Let UMATHT conduct and store heat in a material with `set_thermal`; its name, number of STATEV and PROPS."""
    _host.host_set_user_thermal(number, 1, address, name, statev, np.append(constants, 0.0), len(constants))


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
    return int(_host.host_define_heat_load(law, address or 0, surface, jltyp, *constants))


def uvarm(
    address: int,
    names: tuple[str, str],
    axes: FloatArray,
    counts: tuple[int, int, int, int],
    place: tuple[int, int],
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
    svars = np.ascontiguousarray(arrays.svars[:, : arrays.svars.shape[1] - hidden]).reshape(m, points, -1)
    history = arrays.history if arrays.history.shape[1] == points else np.zeros((m, points, 1))
    left, element, point = _host.host_uvarm_pass(
        address,
        _padded(names),
        axes.transpose(2, 3, 1, 0),
        (*counts, int(local)),
        place,
        clock,
        arrays.labels,
        arrays.coords.T,
        svars.T,
        history.T,
        uvar.T,
    )
    return (element, point) if left else (0, 0)


def sdvini(address: int, arrays: BlockArrays, statev: FloatArray, family: int) -> tuple[int, int]:
    """Call SDVINI at the points of a block; returns element and point at which it ended the analysis, 0 if it did not.

    statev (m, points, NSTATV), contiguous, is changed; family: its number for built-in elements, else 0.
    """
    left, element, point = _host.host_sdvini_pass(address, family, arrays.labels, arrays.coords.T, statev.T)
    return (element, point) if left else (0, 0)


def sigini(address: int, element_type: str, arrays: BlockArrays, sigma: FloatArray, family: int) -> tuple[int, int]:
    """Call SIGINI at the points of a block of built-in elements.

    sigma (m, points, NTENS), contiguous, is what SIGINI leaves. Returns element and point at which it ended the
    analysis, 0 if it did not.
    """
    given = arrays.labels, arrays.coords.T, sigma.T
    left, element, point = _host.host_sigini_pass(address, element_type, family, *given)
    return (element, point) if left else (0, 0)


def orient(
    address: int, name: str, arrays: BlockArrays, nodes: Int32Array, family: int, points: int
) -> tuple[FloatArray, int, int]:
    """Call ORIENT at the points of a block of built-in elements.

    name is of the orientation, nodes (m, nnode) their numbers. Returns the directions (m, points, 3, 3), in rows, as
    ORIENT leaves them, then element and point at which it ended the analysis, 0 if it did not.
    """
    found = np.zeros((len(nodes), points, 3, 3))
    given = arrays.labels, nodes.T, arrays.coords.T
    left, element, point = _host.host_orient_pass(address, name, family, *given, found.T)
    return (found, element, point) if left else (found, 0, 0)


def user_values(address: int, asked: UserValues, values: FloatArray) -> int:
    """Call a routine at all places; returns the number of the place, from 1, where it ended the analysis, else 0.

    values (n,) are those given, and become those of the routine.
    """
    moment = (asked.step, asked.increment), (*asked.time, asked.size)
    coords = np.ascontiguousarray(asked.coords)
    temperatures = np.zeros((len(values), 2)) if asked.temperatures is None else asked.temperatures
    routine = 1 + VALUE_ROUTINES.index(asked.routine)
    left, last = _host.host_value_pass(routine, address, *moment, asked.places.T, coords.T, temperatures.T, values)
    return last if left else 0


def user_amplitude(address: int, asked: AskedAmplitude) -> tuple[float, FloatArray, NDArray[np.int32], bool]:
    """Call UAMP: the value (NaN where it sets none), the state, lFlagsDefine, and whether it ended the analysis."""
    clock = (*asked.time, asked.size, asked.old)
    info = (int(not asked.increment), int(asked.increment > 0), asked.cutbacks, asked.step, asked.increment)
    counts = len(asked.properties), len(asked.state), len(asked.sensors)
    # an array has one entry more than UAMP is told, because none may be empty
    properties, state = np.append(asked.properties, 0.0), np.append(asked.state, 0.0)
    sensors = np.array([*asked.sensors.values(), 0.0]), _padded((*asked.sensors, ""))
    given = asked.name, clock, properties, state, info, *sensors, counts
    value, define, left = _host.host_uamp_call(address, *given, np.nan)
    return float(value), state[: len(asked.state)], define, bool(left)


POINT_REALS: Final = 13
"""Of a cohesive_point in fortran/host/host_traction_separation.f90: separation (3), traction (3), damage, energies that
damage dissipates (3), that of the viscosity, damage without viscosity, initiation criterion."""


def traction_separation(
    law: tuple[FloatArray, Int32Array], time: float, separations: FloatArray, old: FloatArray
) -> tuple[FloatArray, FloatArray, tuple[int, float] | None]:
    """Traction-separation response of points: states (m, POINT_REALS) and derivatives (m, 3, 3) of the tractions; the
    row of a point whose fracture energy at the mode mix is below the elastic energy at the onset of damage, and by how
    much.

    Parameters
    ----------
    law
        As `read_law` in fortran/host/host_traction_separation.f90 has it.
    time
        Of the increment.
    separations
        (m, 3) normal and shear separations.
    old
        (m, POINT_REALS) states at the start of the increment.
    """
    new, tangents, brittle, fault = np.zeros_like(old), np.zeros((len(old), 3, 3)), 0, 0.0
    # f2py knows no empty arrays
    if len(old):
        brittle, fault = _host.host_traction_separation(*law, time, separations.T, old.T, new.T, tangents.T)
    return new, tangents.transpose(0, 2, 1), (brittle - 1, fault) if brittle else None


def _padded(names: Sequence[str]) -> NDArray[np.bytes_]:
    """As CHARACTER*80."""
    return np.array([name.ljust(80) for name in names], dtype="S80")


def integration_rule(family: int, points: int, nodes: int, dimension: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weights (points,), shape functions (points, nodes) and their derivatives (points, nodes, dimension) of a family.

    The derivatives are with respect to parent coordinates. Raises ValueError if the host has no such rule.
    """
    weights, shapes, slopes = np.zeros(points), np.zeros((points, nodes)), np.zeros((points, dimension, nodes))
    if not _host.host_rule(family, weights, shapes.T, slopes.T):
        raise ValueError(f"the host has no family {family} of {nodes} nodes with {points} integration points")
    return weights, shapes, slopes.transpose(0, 2, 1)


def define_rule(family: int, parent: FloatArray, weights: FloatArray, *, reduced: bool) -> int:
    """Add a family with integration points at parent coordinates (points, dimension); returns its number.

    With any other number of points it is the given family. reduced: of an element with hourglass control.
    """
    return int(_host.host_define_rule(family, parent.T, weights, reduced))


def slopes_at_nodes(family: int, nodes: int) -> FloatArray:
    """Derivatives (places, nodes, 2) of a surface's shape functions by parent coordinates, at each of its nodes."""
    slopes = np.zeros((nodes, 2, nodes))
    _host.host_slopes_at_nodes(family, slopes.T)
    return slopes.transpose(0, 2, 1)


_ELEMENTS: Final = (
    *("solid", "coupled", "cohesive", "discrete", "heat", "heat load", "shell", "beam", "piezoelectric", "truss"),
    *("generalised", "beam section", "membrane", "mass diffusion", "continuum shell"),
)
"""In the order of host_element_address."""


def address_of(
    elements: Literal[
        "solid",
        "coupled",
        "cohesive",
        "discrete",
        "heat",
        "heat load",
        "shell",
        "beam",
        "piezoelectric",
        "truss",
        "generalised",
        "beam section",
        "membrane",
        "mass diffusion",
        "continuum shell",
    ],
) -> int:
    """Address of built-in elements.

    Cohesive ones, springs and masses, heat that enters and linear elastic beams are called like UEL, the others like
    UELMAT.
    """
    return int(_host.host_element_address(1 + _ELEMENTS.index(elements)))


def take_messages() -> list[RawMessage]:
    """Messages of STDB_ABQERR since the last call, oldest first."""
    found: list[RawMessage] = []
    while True:
        level, (element, step, increment), text = _host.host_take_message()
        if not level:
            return found
        found.append(RawMessage(level, int(element), int(step), int(increment), text.decode(errors="replace").rstrip()))


def open_job(name: str, directory: str, file6: str, file7: str) -> int:
    """Set the job for GETJOBNAME and GETOUTDIR and connect units 6 and 7.

    Returns 0, the number of an error, or -1 if an abandoned call of an earlier job has them locked inside a WRITE.
    """
    encode = os.fsencode
    return int(_host.host_open_job(encode(name), encode(directory), encode(file6), encode(file7)))


def set_threads(number: int) -> None:
    """Let so many threads call the elements of the jobs of this process from now on, where that is possible."""
    _host.host_set_threads(number)


def set_rank(rank: int, ranks: int) -> None:
    """Tell user routines the number of this process, from 0, among those that run its jobs (GETRANK, GETNUMCPUS)."""
    _host.host_set_rank(rank, ranks)


def limit_calls(seconds: float) -> None:
    """Limit the time of each call of a user routine.

    Parameters
    ----------
    seconds
        Wall-clock time of one call, in all jobs of this process from now on; 0: no limit. A call that takes longer is
        ended, and whoever made it gets an error.
    """
    _host.host_limit_calls(seconds)


def trap(on: bool) -> bool:
    """Let calls of user routines stop at the operation that makes a NaN or an infinity.

    Parameters
    ----------
    on
        Whether they stop there from now on: at an invalid operation, a division by zero and an overflow.

    Returns
    -------
    bool
        The former setting.
    """
    return bool(_host.host_trap(int(on)))


def sanitizing() -> bool:
    """Whether the runtime of AddressSanitizer is in this process, see harness/sanitizer.py."""
    return bool(_host.host_sanitizing())


def sanitize(on: bool) -> None:
    """Say whether the library called from now on is built with AddressSanitizer."""
    _host.host_sanitize(int(on))


def take_frames() -> list[int]:
    """Addresses of the calls that the last signal ended, innermost first; forgets them."""
    addresses, count = _host.host_take_frames()
    return [int(address) for address in addresses[:count]]


def share_slate(descriptor: int) -> bool:
    """Let another process, which has the file of the slate open too, see where user code is.

    Parameters
    ----------
    descriptor
        Of the file, at least as long as `harness.shared_progress.Slate`: from now on calls are noted in it.

    Returns
    -------
    bool
        False if that fails.
    """
    return not _host.host_share(descriptor)


def set_loading(begins: bool) -> None:
    """Note on the slate that constructors of user code may run, or that they have run."""
    _host.host_loading(int(begins))


def flush_units(*, close: bool = False) -> bool:
    """Write out what user routines printed to units 6 and 7; False if an abandoned call has the units locked."""
    return not _host.host_flush(int(close))
