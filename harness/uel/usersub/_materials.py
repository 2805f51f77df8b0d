# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Typed interface to the materials of the compiled host (fortran/host/entry/materials.f90)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uel.model.arrays import FloatArray
from uel.usersub._extension import host, padded


def define_material(
    stiffness: FloatArray,
    compliance: FloatArray,
    thickness: FloatArray,
    axes: FloatArray,
    constants: tuple[float, float],
    table: FloatArray,
) -> int:
    """Add a material to the host's library; arguments as in fortran/host/entry/materials.f90."""
    return int(host.host_define_material(stiffness.T, compliance.T, thickness, axes, constants, table.T))


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
    return int(host.host_define_hyperelastic(ntens, polynomial, ogden.T, volumetric, logarithmic, moduli))


def set_networks(number: int, networks: Sequence[tuple[float, int, Sequence[float]]], statev: int) -> None:
    """Add creeping networks to a hyperelastic material: ratio, law and constants of each."""
    ratios, laws, constants = zip(*networks, strict=True)
    padded = np.array([[*row, *[0.0] * (5 - len(row))] for row in constants])
    host.host_set_networks(number, np.array(ratios), np.array(laws, np.int32), padded.T, statev)


def set_network_routine(
    number: int, network: int, address: int, name: str, constants: FloatArray, *, shifts: bool
) -> None:
    """Set UCREEPNETWORK for the creep of a network, from 1, or UTRSNETWORK for its reduced time."""
    padded = np.append(constants, 0.0)
    host.host_set_network_routine(number, network, address, name, shifts, padded, len(constants))


def define_user_potential(uhyper: int, name: str, ntens: int, statev: int, constants: FloatArray) -> int:
    """Add a hyperelastic material of UHYPER at an address to the host's library."""
    padded = np.append(constants, 0.0)
    return int(host.host_define_user_potential(uhyper, name, ntens, statev, padded, len(constants)))


def define_anisotropic(ntens: int, directions: FloatArray, holzapfel: Sequence[float], compliance: float) -> int:
    """Add a hyperelastic material with preferred directions to the host's library; returns its number there.

    directions  (m, 3) unit vectors in the axes of the material; m may be 0
    holzapfel   C10, k1, k2, kappa
    compliance  D
    """
    padded = np.vstack([directions, np.zeros((1, 3))]).T
    return int(host.host_define_anisotropic(ntens, padded, len(directions), holzapfel, compliance))


def set_user_invariants(number: int, uanisohyper: int, name: str, statev: int, constants: FloatArray) -> None:
    """Set UANISOHYPER_INV for the strain energy of a material of `define_anisotropic`."""
    host.host_set_user_invariants(number, uanisohyper, name, statev, np.append(constants, 0.0), len(constants))


def set_expansion(number: int, table: FloatArray, zero: float) -> None:
    """Give a material of the host's library thermal expansion; table (k, 7) as that of `Expansion`."""
    host.host_set_expansion(number, table.T, zero)


def compliance(constants: Sequence[float]) -> FloatArray:
    """Return the compliance (6, 6) of E1, E2, E3, nu12, nu13, nu23, G12, G13, G23.

    Rows: 11, 22, 33, 12, 13, 23, with engineering shear.
    """
    return host.host_compliance(np.array(constants))


def set_prestressed(number: int) -> None:
    """Add initial stresses to the history of a material other than UMAT's."""
    host.host_set_prestressed(number)


def set_backstresses(number: int, backstresses: FloatArray, growth: tuple[float, float]) -> None:
    """Add backstresses, and exponential isotropic hardening, to a plastic material.

    backstresses (k, 2) C and gamma; growth: Q and b.
    """
    host.host_set_backstresses(number, backstresses.T, growth)


def set_user_hardening(
    number: int, uhard: int, name: str, constants: tuple[float, float], statev: int, properties: FloatArray
) -> None:
    """Set UHARD for the yield stress of an isotropic material.

    constants: Young's modulus and Poisson's ratio; properties: PROPS.
    """
    host.host_set_user_hardening(number, uhard, name, *constants, statev, np.append(properties, 0.0), len(properties))


def set_prony(number: int, constants: tuple[float, float], moduli: tuple[float, float], terms: FloatArray) -> None:
    """Add a Prony series to an isotropic material.

    constants: long-term Young's modulus and Poisson's ratio; moduli: instantaneous shear and bulk modulus; terms (n, 3)
    g, k, tau.
    """
    host.host_set_prony(number, constants, moduli, terms.T)


def set_creep(number: int, constants: tuple[float, float], law: tuple[float, float, float], *, by_time: bool) -> None:
    """Add creep to an isotropic material: Young's modulus, Poisson's ratio; A, n, m of time or strain hardening."""
    host.host_set_creep(number, constants, by_time, law)


def set_user_creep(number: int, creep: int, name: str, constants: tuple[float, float], statev: int) -> None:
    """Set CREEP for the creep law of an isotropic material.

    constants: Young's modulus and Poisson's ratio.
    """
    host.host_set_user_creep(number, creep, name, constants, statev)


def set_dependence(number: int, constants: int, turn: FloatArray, table: FloatArray) -> None:
    """Set elastic constants that depend on temperature and field variables.

    table (k, constants + variables); turn (6, 6) stress components in global axes to those of the material.
    """
    host.host_set_dependence(number, constants, turn, table.T)


def set_local(number: int) -> None:
    """Evaluate a material in the local directions of each point."""
    host.host_set_local(number)


def set_user_field(number: int, address: int, names: tuple[str, str], statev: int, room: int, axes: FloatArray) -> None:
    """Set USDFLD for the field variables of a material; names: of the material and its orientation.

    room: values at the end of the history of which the `statev` STATEV are the first.
    """
    host.host_set_user_field(number, address, padded(names), statev, room, axes)


def set_user_output(number: int, address: int, names: tuple[str, str], counts: tuple[int, int, int, int]) -> None:
    """Set UVARM for output variables of a material in elements that call it; names as in set_user_field.

    counts: NUVARM and the values of the history for UVAR, then NSTATV and the values at its end for STATEV.
    """
    host.host_set_user_output(number, address, padded(names), counts)


def define_user_material(
    umat: int, name: str, ntens: int, constants: FloatArray, hybrid: int, statev: int, room: int
) -> int:
    """Add a material of UMAT at an address to the host's library.

    hybrid: 1 for the total formulation of hybrid elements, 2 for that of incompressible materials; statev, room: as
    set_user_field has them.
    """
    values = np.append(constants, 0.0)
    return int(host.host_define_user_material(umat, name, ntens, hybrid, statev, room, values, len(constants)))


def define_empty_material() -> int:
    """Add a material without properties to the host's library."""
    return int(host.host_define_empty_material())


def set_thermal(
    number: int, density: float, conductivity: FloatArray, specific_heat: FloatArray, latent_heat: FloatArray
) -> None:
    """Give a material conductivity (k, 2) and specific heat (k, 2) with temperatures, latent heat (k, 3)."""
    tables = [np.vstack([table, np.zeros((1, table.shape[1]))]) for table in (conductivity, specific_heat, latent_heat)]
    counts = len(conductivity), len(specific_heat), len(latent_heat)
    host.host_set_thermal(number, density, counts, *(table.T for table in tables))


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
        Number of the material.
    fick
        Fick's law, else the general one.
    absolute_zero
        Absolute zero on the scale of the temperatures.
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
    host.host_set_diffusion(number, int(fick), absolute_zero, axes, counts, *padded)


def set_hetval(number: int, address: int, name: str, statev: int) -> None:
    """Set HETVAL for heat generation in a material with `set_thermal`; its name and number of STATEV."""
    host.host_set_user_thermal(number, 0, address, name, statev, np.zeros(1), 0)


def set_umatht(number: int, address: int, name: str, statev: int, constants: FloatArray) -> None:
    """Set UMATHT for the thermal behaviour of a material with `set_thermal`; its name, number of STATEV, PROPS."""
    host.host_set_user_thermal(number, 1, address, name, statev, np.append(constants, 0.0), len(constants))
