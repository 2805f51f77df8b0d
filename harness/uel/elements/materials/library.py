# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Materials of the deck as the host's material library needs them: stiffness in global axes, per state of stress.

Stress components are those of Tensor in harness/uel/model/element_types.py; shear strains are engineering strains. The
constants' meaning is that of the *ELASTIC data line (Abaqus Analysis User's Guide, Linear elastic behavior).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.elements.materials.anisotropic import define_holzapfel, define_user_invariants
from uel.elements.materials.hyperelastic import define_hyperelastic
from uel.elements.routine import PARALLEL, Linearity
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray
from uel.model.element_types import Tensor
from uel.model.properties import (
    SRATIO_ROUNDING,
    CreepLaw,
    Elastic,
    ElasticType,
    Holzapfel,
    HybridFormulation,
    Hyperelastic,
    Material,
    Network,
    Orientation,
    UserMaterial,
    UserPotential,
    Viscoelastic,
    isotropic_fault,
)
from uel.usersub import Library, _materials

HISTORY_VALUES: Final = 7
"""Values of the history of a point of a plastic or prestressed material, before backstresses of six values each
(fortran/host/materials/library.f90)."""
PRONY_VALUES: Final = 8
"""History values of a viscoelastic material, before six stresses for each term (fortran/host/materials/prony.f90)."""
CREEP_VALUES: Final = 9
"""History values of a material that creeps (fortran/host/materials/creep.f90)."""
USER_CREEP_VALUES: Final = 11
"""History values of a material that creeps by CREEP (fortran/host/routines/user_creep.f90)."""
VISCOUS_CHANGE: Final = 7
"""Place, in these three histories, of the change of the viscous strain rate in the increment, times its length."""
COMMON_VALUES: Final = 5
"""History values of a material with networks, before those of each network (host/materials/networks.f90); the change of
the viscous strain rate is the last one.
"""
NETWORK_VALUES: Final = 10
"""History values of each network."""
USER_HISTORY_VALUES: Final = 15
"""History values of a user material, besides STATEV (fortran/host/routines/umat.f90)."""

_PAIRS: Final = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
_COMPONENTS: Final = {
    Tensor.UNIAXIAL: [0],
    Tensor.TORSION: [0, 3],
    Tensor.PLANE_STRESS: [0, 1, 3],
    Tensor.PLANE_STRAIN: [0, 1, 2, 3],
    Tensor.SOLID: list(range(6)),
}


def history_values(material: Material, *, prestressed: bool = False) -> int:
    """Return the number of history values of a point, which may have an initial stress;
    1 for a material without history.
    """
    if material.user is not None:
        return USER_HISTORY_VALUES + state_variables(material)
    kept = material.plastic is not None or prestressed
    if material.viscoelastic is not None:
        return PRONY_VALUES + 6 * len(material.viscoelastic.terms) + state_variables(material)
    if material.creep is not None:
        return (USER_CREEP_VALUES if material.creep.user else CREEP_VALUES) + state_variables(material)
    if material.networks:
        return COMMON_VALUES + NETWORK_VALUES * len(material.networks) + state_variables(material)
    backstresses = 0 if material.plastic is None else len(material.plastic.backstresses)
    return (HISTORY_VALUES + 6 * backstresses if kept else 1) + state_variables(material)


def viscous_change(material: Material) -> int:
    """Return the place in the history of the largest change of a viscous strain rate in the increment,
    times its length; or -1.
    """
    if material.viscous is None:
        return -1
    return COMMON_VALUES - 1 if material.networks else VISCOUS_CHANGE


def linearity(material: Material, *, prestressed: bool = False) -> Linearity:
    """Return whether continuum elements of a material, which may have an initial stress, have linear forces."""
    depends = material.user_field is not None or material.elastic is None or material.elastic.table is not None
    plain = history_values(material, prestressed=prestressed) == 1 and not depends
    return Linearity.KNOWN if plain else Linearity.UNKNOWN


def state_variables(material: Material) -> int:
    """Return the number of STATEV of a point; 0 without a routine that uses them."""
    hardening = None if material.plastic is None else material.plastic.user
    uses = [material.user, material.user_field, material.user_thermal, material.heat_generation, hardening]
    uses += [given for network in material.networks for given in (network.user, network.shift)]
    used = isinstance(material.hyperelastic, UserPotential) or any(use is not None for use in uses)
    used = used or (material.creep is not None and material.creep.user)
    return material.state_variables if used else 0


def has_unsymmetric_tangent(material: Material) -> bool:
    """Return whether the derivatives of the stresses by the strains are unsymmetric."""
    if material.user is not None:
        return material.user.unsymmetric
    if material.networks:
        return any(map(_creeps_by_more, material.networks))
    return material.plastic is not None and bool(material.plastic.backstresses[:, 1].any())


def _creeps_by_more(network: Network) -> bool:
    """Return whether the creep of a network depends on other stretches than those of its stress."""
    depends_on_pressure = network.law is CreepLaw.POWER and network.constants[3] > 0
    return network.law in (CreepLaw.BERGSTROM_BOYCE, CreepLaw.USER) or depends_on_pressure


def is_global(orientation: Orientation) -> bool:
    """Return whether the directions are the global ones, within rounding."""
    return bool(np.abs(orientation.axes - np.eye(3)).max() < PARALLEL)


def directions(orientation: Orientation | None) -> tuple[FloatArray, str]:
    """Return the axes (3, 3), whose rows are the directions of a material, and the name of the orientation."""
    return (np.eye(3), "") if orientation is None else (orientation.axes, orientation.name)


def _define_fields(
    number: int, material: Material, along: tuple[FloatArray, str], tensor: Tensor, library: Library, room: int
) -> None:
    """Define in the host the dependence of a material on temperature and fields, or on USDFLD. Raises DeckError.

    along: directions of the material, as `directions` has them; room: as `define_material` has it.
    """
    axes, name = along
    elastic = material.elastic
    if elastic is not None and elastic.table is not None:
        count = elastic.type.constants
        rows = [tuple(row[:count]) for row in elastic.table.tolist()]
        if tensor is not Tensor.UNIAXIAL:
            rows = _definite_rows(elastic, rows, tensor)
        table = np.hstack([np.array(rows), elastic.table[:, count:]])
        _materials.set_dependence(number, len(rows[0]), _turn(axes), table)
    define_user_field(number, material, (axes, name), library, room=room)


def define_user_field(
    number: int, material: Material, along: tuple[FloatArray, str], library: Library, *, room: int | None = None
) -> None:
    """Define USDFLD in the host, if the material uses it. Arguments and errors as in `_define_fields`."""
    if material.user_field is not None:
        address = _needed(library.usdfld, "USDFLD", material, "*USER DEFINED FIELD", material.user_field, library)
        axes, name = along
        statev = state_variables(material)
        room = statev if room is None else room
        _materials.set_user_field(number, address, (material.name, name), statev, room, axes)


def user_outputs(material: Material, library: Library) -> int:
    """Return the number of variables of UVARM; 0 if the job has no UVARM: then they are left out of the output."""
    return 0 if library.uvarm is None else material.output_variables


def _definite_rows(elastic: Elastic, rows: list[tuple[float, ...]], tensor: Tensor) -> list[tuple[float, ...]]:
    """Convert rows of a table to the host's constants. Raises DeckError unless each is positive definite."""
    found = [_engineering(elastic, row, tensor) for row in rows]
    for row in found:
        _check_definite(elastic, _materials.compliance(row))
    # the shear modulus is not linear in both constants
    return [(row[0], row[3]) for row in found] if elastic.type is ElasticType.ISOTROPIC else found


def define_material(
    material: Material,
    orientation: Orientation | None,
    tensor: Tensor,
    user: Source,
    library: Library,
    *,
    hybrid: bool = False,
    local: bool = False,
    prestressed: bool = False,
    room: int | None = None,
    outputs: int = 0,
) -> int:
    """Define a material in the host, and return its number. Raises DeckError.

    orientation  its directions
    user         the place that uses it
    hybrid       its elements are, so that it may be incompressible
    local        the elements turn strains and stresses at each point: only the name of the orientation counts
    prestressed  its points may have an initial stress
    room         values at the end of the history of which STATEV are the first, if they are not all, since another
                 layer has more
    outputs      values of the history for UVAR, of elements that call UVARM themselves
    """
    if local and orientation is not None:
        orientation = replace(orientation, axes=np.eye(3), system=None)
    room = state_variables(material) if room is None else room
    number = _define_stresses(material, orientation, tensor, user, library, hybrid=hybrid, room=room)
    along = directions(orientation)
    _define_fields(number, material, along, tensor, library, room)
    _define_expansion(number, material, orientation)
    if outputs and material.output_variables and library.uvarm is not None:
        counts = material.output_variables, outputs, state_variables(material), room
        _materials.set_user_output(number, library.uvarm, (material.name, along[1]), counts)
    if local:
        _materials.set_local(number)
    if prestressed:
        _materials.set_prestressed(number)
    return number


def _define_stresses(
    material: Material,
    orientation: Orientation | None,
    tensor: Tensor,
    user: Source,
    library: Library,
    *,
    hybrid: bool,
    room: int,
) -> int:
    """Define what gives the stresses of a material, and return its number. Arguments as in `define_material`."""
    if material.user is not None:
        return _define_user_material(material, material.user, orientation, tensor, library, hybrid=hybrid, room=room)
    if material.hyperelastic is not None:
        return _define_hyperelastic(material, orientation, tensor, library, hybrid=hybrid)
    elastic = material.elastic
    if elastic is None:
        raise DeckError(user, f"material {material.name} ({material.source}) has no *ELASTIC")
    if hybrid and is_incompressible(material):
        return _define_incompressible(elastic, tensor)
    axes = _axes(orientation, tensor)
    compliance = rotated_compliance(_compliance(elastic, tensor), axes)
    components = _COMPONENTS[tensor]
    if tensor <= Tensor.PLANE_STRESS:
        reduced = compliance[np.ix_(components, components)]
        stiffness = _inverse(reduced, elastic)
    else:
        stiffness = _inverse(compliance, elastic)[np.ix_(components, components)]
        reduced = _inverse(stiffness, elastic)
    constants, table = (0.0, 0.0), np.zeros((1, 2))
    plastic = material.plastic
    if plastic is not None and plastic.user is None:
        constants, table = _isotropic_constants(elastic), plastic.table
    thickness = np.zeros(3)
    thickness[: len(components)] = compliance[2, components[:3]]
    number = _materials.define_material(stiffness, reduced, thickness, axes, constants, table)
    if plastic is not None and plastic.user is not None:
        address = _needed(library.uhard, "UHARD", material, "*PLASTIC, HARDENING=USER", plastic.source, library)
        moduli, statev = _isotropic_constants(elastic), state_variables(material)
        _materials.set_user_hardening(number, address, material.name, moduli, statev, plastic.user)
    if plastic is not None and len(plastic.backstresses):
        _materials.set_backstresses(number, plastic.backstresses, plastic.growth)
    if material.viscoelastic is not None:
        _materials.set_prony(number, *_moduli(elastic, material.viscoelastic), material.viscoelastic.terms)
    if (creep := material.creep) is not None and creep.user:
        address = _needed(library.creep, "CREEP", material, "*CREEP, LAW=USER", creep.source, library)
        constants = _isotropic_constants(elastic)
        _materials.set_user_creep(number, address, material.name, constants, state_variables(material))
    elif creep is not None:
        law = creep.factor, creep.stress_power, creep.time_power
        _materials.set_creep(number, _isotropic_constants(elastic), law, by_time=creep.by_time)
    return number


def _axes(orientation: Orientation | None, tensor: Tensor) -> FloatArray:
    """Return the directions of the material (3, 3), rows. Raises DeckError."""
    if orientation is None:
        return np.eye(3)
    if tensor is not Tensor.SOLID and abs(orientation.axes[2, 2]) < 1 - 1e-9:
        message = f"*ORIENTATION, NAME={orientation.name}: direction 3 must be normal to the plane of the elements"
        raise DeckError(orientation.source, message)
    return orientation.axes


def _moduli(elastic: Elastic, viscoelastic: Viscoelastic) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return long-term Young's modulus and Poisson's ratio, and instantaneous shear and bulk modulus."""
    young, nu = _isotropic_constants(elastic)
    given = np.array([young / (2 * (1 + nu)), young / (3 * (1 - 2 * nu))])
    left = 1 - viscoelastic.terms[:, :2].sum(axis=0)
    instantaneous = given if elastic.instantaneous else given / left
    shear, bulk = instantaneous * left
    young = 9 * bulk * shear / (3 * bulk + shear)
    return (young, young / (2 * shear) - 1), (float(instantaneous[0]), float(instantaneous[1]))


def global_compliance(material: Material, orientation: Orientation | None, tensor: Tensor) -> FloatArray | None:
    """Return the (6, 6) compliance in global axes; None for a material without constants of *ELASTIC.
    Raises DeckError.
    """
    elastic = material.elastic
    if elastic is None or elastic.type is ElasticType.TRACTION:
        return None
    return rotated_compliance(_compliance(elastic, tensor), directions(orientation)[0])


def _define_hyperelastic(
    material: Material, orientation: Orientation | None, tensor: Tensor, library: Library, *, hybrid: bool
) -> int:
    ntens = int(tensor)
    match material.hyperelastic:
        case Hyperelastic() as law:
            _check_long_term(material, law)
            long_term = 1.0 if law.instantaneous else material.equilibrium
            number = define_hyperelastic(law, ntens, library, hybrid=hybrid, long_term=long_term)
            _define_networks(number, material, library)
            return number
        case Holzapfel() as law:
            return define_holzapfel(law, orientation, ntens)
        case UserPotential() as law:
            known = library.uhyper if law.directions is None else library.uanisohyper_inv
            address = _needed(known, law.routine, material, f"*{law.keyword}, USER", law.source, library)
            statev = state_variables(material)
            if law.directions is None:
                return _materials.define_user_potential(address, material.name, ntens, statev, law.constants)
            return define_user_invariants(law, orientation, material.name, ntens, statev, address)
    raise AssertionError


def _check_long_term(material: Material, law: Hyperelastic) -> None:
    """Raise DeckError if networks leave no long-term elasticity, and the coefficients are its moduli."""
    if material.equilibrium <= SRATIO_ROUNDING and not law.instantaneous:
        message = "the sum of SRATIO is 1, so that there is no long-term elasticity; expected MODULI=INSTANTANEOUS"
        message += f" of *{law.keyword}, at {law.source}"
        raise DeckError(material.networks[0].source, f"material {material.name}: {message}")


def _define_networks(number: int, material: Material, library: Library) -> None:
    if not material.networks:
        return
    laws = [(network.ratio, network.law, network.constants) for network in material.networks]
    _materials.set_networks(number, laws, state_variables(material))
    for place, network in enumerate(material.networks, 1):
        if network.user is not None:
            what = "*VISCOELASTIC, NONLINEAR, LAW=USER"
            creep = _needed(library.ucreepnetwork, "UCREEPNETWORK", material, what, network.source, library)
            _materials.set_network_routine(number, place, creep, material.name, network.user, shifts=False)
        if network.shift is not None:
            what = "*TRS, DEFINITION=USER"
            shift = _needed(library.utrsnetwork, "UTRSNETWORK", material, what, network.source, library)
            _materials.set_network_routine(number, place, shift, material.name, network.shift, shifts=True)


def is_incompressible(material: Material) -> bool:
    """Return whether a material preserves its volume, so that its elements have to be hybrid."""
    if material.user is not None:
        return material.user.hybrid is HybridFormulation.INCOMPRESSIBLE
    match material.hyperelastic:
        case Hyperelastic() as law:
            return not any(law.compliances)
        case Holzapfel() as law:
            return law.coefficients[1] == 0
        case UserPotential() as potential:
            return potential.incompressible
    return material.elastic is not None and _preserves_volume(material.elastic)


def _preserves_volume(elastic: Elastic) -> bool:
    return elastic.type is ElasticType.ISOTROPIC and elastic.constants[1:2] == (INCOMPRESSIBLE,)


def _define_incompressible(elastic: Elastic, tensor: Tensor) -> int:
    """Define the deviatoric response in the host, and return its number; elements add the mean stress."""
    young = elastic.constants[0]
    _check_isotropic(elastic, young, 0.0)
    shear = young / 3
    stiffness = np.diag([2 * shear] * 3 + [shear] * 3)
    stiffness[:3, :3] -= 2 * shear / 3
    compliance = _materials.compliance([*(young,) * 3, *(INCOMPRESSIBLE,) * 3, *(shear,) * 3])
    chosen = np.ix_(_COMPONENTS[tensor], _COMPONENTS[tensor])
    nothing = np.zeros(3), np.eye(3), (0.0, 0.0), np.zeros((1, 2))
    return _materials.define_material(stiffness[chosen], compliance[chosen], *nothing)


def define_truss_material(material: Material, library: Library) -> int:
    """Define an isotropic or user material of trusses in the host, and return its number. Raises DeckError."""
    elastic, room = material.elastic, state_variables(material)
    if material.user is not None:
        number = _define_user_material(material, material.user, None, Tensor.UNIAXIAL, library, hybrid=False, room=room)
    else:
        assert elastic is not None
        young, poisson = _isotropic_constants(elastic)
        table = np.zeros((1, 2)) if material.plastic is None else material.plastic.table
        one = np.eye(1)
        number = _materials.define_material(one * young, one / young, np.zeros(3), np.eye(3), (young, poisson), table)
    _define_fields(number, material, directions(None), Tensor.UNIAXIAL, library, room)
    return number


def define_thermal(number: int, material: Material, library: Library) -> None:
    """Define conduction, storage and generation of heat of a material in the host. Raises DeckError."""
    tables = material.conductivity, material.specific_heat, material.latent_heat
    _materials.set_thermal(number, material.density, *tables)
    statev = state_variables(material)
    if material.user_thermal is not None:
        source = material.user_thermal.source
        address = _needed(library.umatht, "UMATHT", material, "*USER MATERIAL, TYPE=THERMAL", source, library)
        _materials.set_umatht(number, address, material.name, statev, material.user_thermal.constants)
    if material.heat_generation is not None:
        source = material.heat_generation
        address = _needed(library.hetval, "HETVAL", material, "*HEAT GENERATION", source, library)
        _materials.set_hetval(number, address, material.name, statev)


def shear_modulus(elastic: Elastic, tensor: Tensor) -> float:
    """Return the mean of the shear moduli; in the plane that of the plane."""
    if _preserves_volume(elastic):
        return elastic.constants[0] / 3
    moduli = 1.0 / np.diag(_compliance(elastic, tensor))[3:]
    return float(moduli.mean() if tensor is Tensor.SOLID else moduli[0])


def _needed(
    address: int | None, routine: str, material: Material, keyword: str, source: Source, library: Library
) -> int:
    """Return the address of a user routine. Raises DeckError at the keyword that needs it if there is none."""
    if address is None:
        message = f"material {material.name} needs {routine}; {library.name} has {library.contents}"
        raise DeckError(source, f"{keyword}: {message}")
    return address


def _define_user_material(
    material: Material,
    given: UserMaterial,
    orientation: Orientation | None,
    tensor: Tensor,
    library: Library,
    *,
    hybrid: bool,
    room: int,
) -> int:
    address = _needed(library.umat, "UMAT", material, "*USER MATERIAL", given.source, library)
    if orientation is not None and not is_global(orientation):
        raise DeckError(orientation.source, f"*ORIENTATION is not supported for *USER MATERIAL ({material.name})")
    formulation = int(given.hybrid) if hybrid else 0
    statev = state_variables(material)
    return _materials.define_user_material(
        address, material.name, int(tensor), given.constants, formulation, statev, room
    )


INCOMPRESSIBLE: Final = 0.5
"""Poisson's ratio of an isotropic material that preserves its volume."""

MOST_STIFF: Final = 1e13
"""Ratio of the stiffest to the softest response of a material that leaves three digits."""


def _inverse(matrix: FloatArray, elastic: Elastic) -> FloatArray:
    if (ratio := np.linalg.cond(matrix)) > MOST_STIFF:
        message = (
            f"the stiffest response is {ratio:.0e} times the softest; the largest usable ratio is {MOST_STIFF:.0e}"
        )
        raise DeckError(elastic.source, f"*ELASTIC: {message}")
    return np.asarray(np.linalg.inv(matrix), dtype=np.float64)


def _isotropic_constants(elastic: Elastic) -> tuple[float, float]:
    young, *rest = elastic.constants
    return young, rest[0] if rest else 0.0


def _compliance(elastic: Elastic, tensor: Tensor) -> FloatArray:
    """Return the (6, 6) compliance in the material's axes. Raises DeckError unless it is positive definite."""
    c = elastic.constants
    count = elastic.type.constants
    alone = elastic.type is ElasticType.ISOTROPIC and len(c) == 1
    if len(c) != count and not alone:
        raise DeckError(elastic.source, f"*ELASTIC, TYPE={elastic.type} needs {count} constants, found {len(c)}")
    if elastic.type in (ElasticType.ORTHOTROPIC, ElasticType.ANISOTROPIC):
        stiffness = _orthotropic(c) if elastic.type is ElasticType.ORTHOTROPIC else _anisotropic(c)
        _check_definite(elastic, stiffness)
        return _inverse(stiffness, elastic)
    compliance = _materials.compliance(_engineering(elastic, c, tensor))
    _check_definite(elastic, compliance)
    return compliance


def _engineering(elastic: Elastic, c: tuple[float, ...], tensor: Tensor) -> tuple[float, ...]:
    """Convert other constants to E1, E2, E3, nu12, nu13, nu23, G12, G13, G23. Raises DeckError."""
    moduli: tuple[float, ...]
    ratios: tuple[float, ...]
    shear: tuple[float, ...]
    if elastic.type is ElasticType.LAMINA:
        if tensor is not Tensor.PLANE_STRESS:
            raise DeckError(elastic.source, "*ELASTIC, TYPE=LAMINA is for plane stress only")
        e1, e2, nu12, g12, g13, g23 = c
        # plane stress does not see the third direction; any value serves
        moduli, ratios, shear = (e1, e2, e2), (nu12, 0.0, 0.0), (g12, g13 or g12, g23 or g12)
    elif elastic.type is ElasticType.ISOTROPIC:
        young, *rest = c
        nu = rest[0] if rest else 0.0
        _check_isotropic(elastic, young, nu)
        moduli, ratios, shear = (young,) * 3, (nu,) * 3, (young / (2 * (1 + nu)),) * 3
    else:
        moduli, ratios, shear = c[0:3], c[3:6], c[6:9]
    if min(*moduli, *shear) <= 0:
        raise DeckError(elastic.source, f"*ELASTIC, TYPE={elastic.type}: moduli must be positive, found {min(c):g}")
    return (*moduli, *ratios, *shear)


def _check_isotropic(elastic: Elastic, young: float, nu: float) -> None:
    fault = isotropic_fault(young, nu)
    if nu == 0.5:
        fault = "nu = 0.5 needs hybrid elements, as C3D8H; expected nu < 0.5 for others"
    if fault:
        raise DeckError(elastic.source, f"*ELASTIC: {fault}")


def _check_definite(elastic: Elastic, matrix: FloatArray) -> None:
    # scaled to a unit diagonal, so that moduli of any size are judged alike
    diagonal = np.diag(matrix)
    if diagonal.min() > 0:
        scale = 1 / np.sqrt(diagonal)
        if np.linalg.eigvalsh(matrix * np.outer(scale, scale)).min() > 1e-12:
            return
    raise DeckError(elastic.source, f"*ELASTIC, TYPE={elastic.type}: the stiffness is not positive definite")


def _orthotropic(c: tuple[float, ...]) -> FloatArray:
    """Return the stiffness (6, 6) from D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323."""
    d = np.diag([c[0], c[2], c[5], *c[6:9]])
    d[0, 1] = d[1, 0] = c[1]
    d[0, 2] = d[2, 0] = c[3]
    d[1, 2] = d[2, 1] = c[4]
    return d


def _anisotropic(c: tuple[float, ...]) -> FloatArray:
    """Return the stiffness (6, 6) from D1111, D1122, D2222, D1133, ...: the upper triangle by columns, components
    ordered 11, 22, 33, 12, 13, 23.
    """
    d = np.zeros((6, 6))
    columns, rows = np.tril_indices(6)
    d[rows, columns] = d[columns, rows] = c
    return d


def _define_expansion(number: int, material: Material, orientation: Orientation | None) -> None:
    """Define the thermal expansion of a material in the host, if it has any."""
    if material.expansion is None:
        return
    table = material.expansion.table.copy()
    # strains go with the stresses that do work on them
    table[:, 1:] = table[:, 1:] @ _turn(directions(orientation)[0])
    _materials.set_expansion(number, table, material.expansion.zero)


def rotated_compliance(compliance: FloatArray, axes: FloatArray) -> FloatArray:
    """Rotate a (..., 6, 6) compliance to global axes. Local stress = T global stress, so S_global = T^T S_local T."""
    t = _turn(axes)
    rotated: FloatArray = np.swapaxes(t, -1, -2) @ compliance @ t
    return rotated


def _turn(axes: FloatArray) -> FloatArray:
    """Return the (..., 6, 6) matrix that turns a stress in global axes to the axes of the material (..., 3, 3)."""
    t = np.zeros((*axes.shape[:-2], 6, 6))
    a = np.moveaxis(axes, (-2, -1), (0, 1))
    for row, (i, j) in enumerate(_PAIRS):
        for column, (k, m) in enumerate(_PAIRS):
            t[..., row, column] = a[i, k] * a[j, m] + (a[i, m] * a[j, k] if k != m else 0.0)
    return t
