# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
# Written by fortran/host/stub.py.
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

def host_evaluate(
    address: int,
    material: int,
    jtype: int,
    tensor: int,
    labels: NDArray[np.int32],
    jprops: NDArray[np.int32],
    equations: NDArray[np.int32],
    map: NDArray[np.int32],
    props: NDArray[np.float64],
    coords: NDArray[np.float64],
    svars: NDArray[np.float64],
    energy: NDArray[np.float64],
    history: NDArray[np.float64],
    svars_trial: NDArray[np.float64],
    energy_trial: NDArray[np.float64],
    history_trial: NDArray[np.float64],
    symmetric: int,
    want_matrix: int,
    guards: int,
    entries: int,
    parallel: int,
    kstep: int,
    kinc: int,
    iteration: int,
    time: Sequence[float] | NDArray[np.float64],
    dtime: float,
    period: float,
    params: Sequence[float] | NDArray[np.float64],
    lflags: Sequence[int] | NDArray[np.int32],
    u: NDArray[np.float64],
    du: NDArray[np.float64],
    v: NDArray[np.float64],
    a: NDArray[np.float64],
    counts: NDArray[np.int32],
    kinds: NDArray[np.int32],
    loads: NDArray[np.float64],
    predef: NDArray[np.float64],
    floor: NDArray[np.float64],
    field: NDArray[np.int32],
    fluxes: int,
    residual: NDArray[np.float64],
    matrix: NDArray[np.float64],
) -> tuple[NDArray[np.float64], float, NDArray[np.float64], int, int, int, int, int]: ...
def host_exchange_guard_values(values: NDArray[np.float64]) -> None: ...
def host_take_message() -> tuple[int, NDArray[np.int32], bytes]: ...
def host_open_job(
    name: str | bytes, directory: str | bytes, file6: str | bytes, file7: str | bytes, alone: int
) -> int: ...
def host_set_threads(number: int) -> None: ...
def host_set_rank(number: int, of: int) -> None: ...
def host_limit_calls(seconds: float) -> None: ...
def host_share(file: int) -> int: ...
def host_loading(begins: int) -> None: ...
def host_flush(finish: int) -> int: ...
def host_external_database(
    address: int,
    lop: int,
    lrestart: int,
    time: Sequence[float] | NDArray[np.float64],
    dtime: float,
    kstep: int,
    kinc: int,
) -> int: ...
def host_define_heat_load(
    law: int, address: int, surface: str | bytes, jltyp: int, absolute_zero: float, stefan_boltzmann: float
) -> int: ...
def host_element_address(name: str | bytes) -> int: ...
def host_define_material(
    stiffness: NDArray[np.float64],
    compliance: NDArray[np.float64],
    thickness: Sequence[float] | NDArray[np.float64],
    axes: NDArray[np.float64],
    constants: Sequence[float] | NDArray[np.float64],
    hardening: NDArray[np.float64],
) -> int: ...
def host_set_backstresses(
    number: int, backstresses: NDArray[np.float64], growth: Sequence[float] | NDArray[np.float64]
) -> None: ...
def host_set_prony(
    number: int,
    constants: Sequence[float] | NDArray[np.float64],
    moduli: Sequence[float] | NDArray[np.float64],
    terms: NDArray[np.float64],
) -> None: ...
def host_set_creep(
    number: int,
    constants: Sequence[float] | NDArray[np.float64],
    by_time: int,
    power_law: Sequence[float] | NDArray[np.float64],
) -> None: ...
def host_set_user_creep(
    number: int, address: int, name: str | bytes, constants: Sequence[float] | NDArray[np.float64], statev: int
) -> None: ...
def host_set_expansion(number: int, table: NDArray[np.float64], zero: float) -> None: ...
def host_compliance(constants: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]: ...
def host_set_prestressed(number: int) -> None: ...
def host_set_local(number: int) -> None: ...
def host_set_dependence(number: int, constants: int, turn: NDArray[np.float64], table: NDArray[np.float64]) -> None: ...
def host_set_user_field(
    number: int,
    address: int,
    names: Sequence[str] | NDArray[np.bytes_],
    statev: int,
    room: int,
    axes: NDArray[np.float64],
) -> None: ...
def host_set_user_output(
    number: int, address: int, names: Sequence[str] | NDArray[np.bytes_], counts: Sequence[int] | NDArray[np.int32]
) -> None: ...
def host_define_user_material(
    umat: int,
    name: str | bytes,
    ntens: int,
    hybrid: int,
    statev: int,
    room: int,
    constants: NDArray[np.float64],
    count: int,
) -> int: ...
def host_define_hyperelastic(
    ntens: int,
    polynomial: NDArray[np.float64],
    ogden: NDArray[np.float64],
    volumetric: Sequence[float] | NDArray[np.float64],
    logarithmic: int,
    moduli: Sequence[float] | NDArray[np.float64],
) -> int: ...
def host_set_networks(
    number: int, ratios: NDArray[np.float64], laws: NDArray[np.int32], constants: NDArray[np.float64], statev: int
) -> None: ...
def host_set_network_routine(
    number: int, network: int, address: int, name: str | bytes, shifts: int, constants: NDArray[np.float64], count: int
) -> None: ...
def host_define_user_potential(
    uhyper: int, name: str | bytes, ntens: int, statev: int, constants: NDArray[np.float64], count: int
) -> int: ...
def host_define_anisotropic(
    ntens: int,
    directions: NDArray[np.float64],
    fibres: int,
    holzapfel: Sequence[float] | NDArray[np.float64],
    compliance: float,
) -> int: ...
def host_set_user_invariants(
    number: int, uanisohyper: int, name: str | bytes, statev: int, constants: NDArray[np.float64], count: int
) -> None: ...
def host_set_user_hardening(
    number: int,
    uhard: int,
    name: str | bytes,
    young: float,
    poisson: float,
    statev: int,
    constants: NDArray[np.float64],
    count: int,
) -> None: ...
def host_define_empty_material() -> int: ...
def host_set_thermal(
    number: int,
    density: float,
    counts: Sequence[int] | NDArray[np.int32],
    conductivity: NDArray[np.float64],
    specific_heat: NDArray[np.float64],
    latent_heat: NDArray[np.float64],
) -> None: ...
def host_set_diffusion(
    number: int,
    fick: int,
    absolute_zero: float,
    axes: NDArray[np.float64],
    counts: Sequence[int] | NDArray[np.int32],
    diffusivity: NDArray[np.float64],
    solubility: NDArray[np.float64],
    soret: NDArray[np.float64],
    pressure: NDArray[np.float64],
) -> None: ...
def host_set_user_thermal(
    number: int, flows: int, address: int, name: str | bytes, statev: int, constants: NDArray[np.float64], count: int
) -> None: ...
def host_traction_separation(
    reals: NDArray[np.float64],
    integers: NDArray[np.int32],
    dtime: float,
    separation: NDArray[np.float64],
    before: NDArray[np.float64],
    after: NDArray[np.float64],
    tangent: NDArray[np.float64],
) -> tuple[int, float]: ...
def host_uvarm_pass(
    address: int,
    names: Sequence[str] | NDArray[np.bytes_],
    axes: NDArray[np.float64],
    counts: Sequence[int] | NDArray[np.int32],
    place: Sequence[int] | NDArray[np.int32],
    clock: Sequence[float] | NDArray[np.float64],
    labels: NDArray[np.int32],
    coords: NDArray[np.float64],
    svars: NDArray[np.float64],
    history: NDArray[np.float64],
    uvar: NDArray[np.float64],
) -> tuple[int, int, int]: ...
def host_sdvini_pass(
    address: int, family: int, labels: NDArray[np.int32], coords: NDArray[np.float64], statev: NDArray[np.float64]
) -> tuple[int, int, int]: ...
def host_sigini_pass(
    address: int,
    element_type: str | bytes,
    family: int,
    labels: NDArray[np.int32],
    coords: NDArray[np.float64],
    sigma: NDArray[np.float64],
) -> tuple[int, int, int]: ...
def host_orient_pass(
    address: int,
    name: str | bytes,
    family: int,
    labels: NDArray[np.int32],
    nodes: NDArray[np.int32],
    coords: NDArray[np.float64],
    t: NDArray[np.float64],
) -> tuple[int, int, int]: ...
def host_value_pass(
    routine: int,
    address: int,
    place: Sequence[int] | NDArray[np.int32],
    time: Sequence[float] | NDArray[np.float64],
    places: NDArray[np.int32],
    coords: NDArray[np.float64],
    temperatures: NDArray[np.float64],
    values: NDArray[np.float64],
) -> tuple[int, int]: ...
def host_uamp_call(
    address: int,
    name: str | bytes,
    clock: Sequence[float] | NDArray[np.float64],
    props: NDArray[np.float64],
    svars: NDArray[np.float64],
    info: Sequence[int] | NDArray[np.int32],
    sensors: NDArray[np.float64],
    names: NDArray[np.bytes_],
    counts: Sequence[int] | NDArray[np.int32],
    given: float,
) -> tuple[float, NDArray[np.int32], int]: ...
def host_rule(family: int, weight: NDArray[np.float64], n: NDArray[np.float64], dn: NDArray[np.float64]) -> int: ...
def host_define_rule(family: int, parent: NDArray[np.float64], weight: NDArray[np.float64], reduced: int) -> int: ...
def host_slopes_at_nodes(family: int, slopes: NDArray[np.float64]) -> None: ...
def host_watch(address: int, with_material: int) -> int: ...
def host_take_changes() -> tuple[NDArray[np.int32], NDArray[np.float64]]: ...
def host_fill_stack(on: int, number: float) -> None: ...
def host_exchange_around(argument: int, number: NDArray[np.float64]) -> None: ...
def host_take_outside() -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def host_allocated() -> int: ...
def host_trap(on: int) -> int: ...
def host_take_frames() -> tuple[NDArray[np.int64], int]: ...
def host_exchange_room(room: NDArray[np.int32]) -> None: ...
def host_sanitizing() -> int: ...
def host_sanitize(begins: int) -> None: ...
def host_bare_loop(
    address: int,
    material: int,
    jtype: int,
    kstep: int,
    kinc: int,
    lflags: NDArray[np.int32],
    time: Sequence[float] | NDArray[np.float64],
    dtime: float,
    period: float,
    labels: NDArray[np.int32],
    jprops: NDArray[np.int32],
    equations: NDArray[np.int32],
    props: NDArray[np.float64],
    coords: NDArray[np.float64],
    u: NDArray[np.float64],
    du: NDArray[np.float64],
    svars: NDArray[np.float64],
    svars_trial: NDArray[np.float64],
    energy: NDArray[np.float64],
    energy_trial: NDArray[np.float64],
    residual: NDArray[np.float64],
    amatrx: NDArray[np.float64],
) -> None: ...
def host_linear_pass(
    matrices: NDArray[np.float64],
    equations: NDArray[np.int32],
    first: NDArray[np.int32],
    u: NDArray[np.float64],
    floor: NDArray[np.float64],
    field: NDArray[np.int32],
    residual: NDArray[np.float64],
    fluxes: int,
) -> tuple[NDArray[np.float64], float]: ...
def host_add_matrices(matrices: NDArray[np.float64], map: NDArray[np.int32], matrix: NDArray[np.float64]) -> None: ...
def host_scatter_map(
    equations: NDArray[np.int32], indptr: NDArray[np.int32], indices: NDArray[np.int32], map: NDArray[np.int32]
) -> None: ...
def host_contact_monomials(
    natural: NDArray[np.float64], values: NDArray[np.float64], first: NDArray[np.float64], second: NDArray[np.float64]
) -> None: ...
def host_contact_sizes(nodes: NDArray[np.int64], coordinates: NDArray[np.float64]) -> NDArray[np.float64]: ...
def host_contact_frames(
    tangents: NDArray[np.float64], normals: NDArray[np.float64], metrics: NDArray[np.float64]
) -> None: ...
def host_contact_feet(
    shapes: NDArray[np.float64],
    nodes: NDArray[np.int64],
    coordinates: NDArray[np.float64],
    face: NDArray[np.int64],
    natural: NDArray[np.float64],
    at: NDArray[np.float64],
    tangents: NDArray[np.float64],
    second: NDArray[np.float64],
) -> None: ...
def host_contact_search(
    shapes: NDArray[np.float64],
    nodes: NDArray[np.int64],
    coordinates: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    total: NDArray[np.float64],
    reach_low: NDArray[np.float64],
    reach_high: NDArray[np.float64],
    reach_total: NDArray[np.float64],
    ring: NDArray[np.int64],
    facing: float,
    points: NDArray[np.float64],
    outward: NDArray[np.float64],
    before: NDArray[np.int64],
    near: NDArray[np.int64],
    most: int,
    face: NDArray[np.int64],
    natural: NDArray[np.float64],
    within: NDArray[np.float64],
    distance: NDArray[np.float64],
    above: NDArray[np.int32],
) -> None: ...
def host_contact_derivatives(
    tangents: NDArray[np.float64],
    second: NDArray[np.float64],
    gap: NDArray[np.float64],
    along: NDArray[np.float64],
    across: NDArray[np.float64],
    natural_by: NDArray[np.float64],
    tilt: NDArray[np.float64],
) -> None: ...
def host_contact_products(
    left: NDArray[np.float64],
    rows: NDArray[np.int32],
    right: NDArray[np.float64],
    columns: NDArray[np.int32],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
) -> None: ...
def host_contact_means(
    shapes: NDArray[np.float64],
    loads: NDArray[np.float64],
    nodes: NDArray[np.int64],
    coordinates: NDArray[np.float64],
    own: NDArray[np.float64],
    face: NDArray[np.int64],
    natural: NDArray[np.float64],
    sample: NDArray[np.int64],
    point: NDArray[np.int64],
    weight: NDArray[np.float64],
    place: NDArray[np.int64],
    positions: NDArray[np.int64],
    gradients: NDArray[np.float64],
    shares: NDArray[np.float64],
) -> None: ...
def host_contact_samples_stiffness(
    shapes: NDArray[np.float64],
    loads: NDArray[np.float64],
    nodes: NDArray[np.int64],
    coordinates: NDArray[np.float64],
    own: NDArray[np.float64],
    face: NDArray[np.int64],
    natural: NDArray[np.float64],
    gap: NDArray[np.float64],
    normal_force: NDArray[np.float64],
    friction: NDArray[np.float64],
    first: NDArray[np.int64],
    equations: NDArray[np.int32],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
) -> None: ...
