# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties of inserted elements: from the command line, or from the solids that an element owns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from uel.deck.error_report import nearest
from uel.delamination.blocks import Interface, traction_material, traction_section
from uel.delamination.kernels import uel_property, user_element
from uel.delamination.materials import Cohesive
from uel.errors import UsageError
from uel.insertion.connectivity import InterfaceType
from uel.insertion.sections import Side
from uel.usersub.layout import check_law_uses, element_layouts

_LAW = ("SIGMAMAX", "TAUMAX", "GIC", "GIIC")
_OF_ABAQUS = ("THICKNESS", "ALPHAN", "ALPHAT", *_LAW, "VISCOSITY", "ETA", "POWER")


def read_values(words: Sequence[str]) -> dict[str, float]:
    """Return the values by name from NAME=VALUE; an underscore is a blank. Raises UsageError."""
    values: dict[str, float] = {}
    for word in words:
        name, _, text = word.partition("=")
        name = " ".join(name.replace("_", " ").upper().split())
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise UsageError(f"{word}: expected NAME=VALUE with a number")
        if name in values:
            raise UsageError(f"{name} is given twice")
        values[name] = value
    return values


def names_of(kind: InterfaceType) -> tuple[str, ...]:
    """Return the names of the properties of a type."""
    if not kind.jtype:
        return tuple(name for name in _OF_ABAQUS if name != "THICKNESS" or kind.dimension == 2)
    layout = element_layouts()[kind.jtype]
    return tuple(item.name for item in (*layout.reals, *layout.integers))


def required_names(kind: InterfaceType) -> tuple[str, ...]:
    """Return the names of required properties: without a default, and not in the sections of solids."""
    if not kind.jtype:
        return ("ALPHAN", *_LAW)
    names = tuple(item.name for item in element_layouts()[kind.jtype].reals if item.required)
    law = tuple(name for name in names if name != "THICKNESS" and not name.endswith((" BOTTOM", " TOP")))
    return law if kind.solids else ("ALPHAN", *law)


def check_values(kind: InterfaceType, values: Mapping[str, float]) -> None:
    """Raise UsageError for an unknown property, an incomplete law, or a value out of range."""
    known = names_of(kind)
    for name in values:
        if name not in known:
            raise UsageError(f"{kind.name} has no property {name} (it has: {', '.join(known)}){nearest(name, known)}")
    needed = required_names(kind)
    missing = [name for name in needed if name not in values]
    if missing:
        why = ": a stiffness, which only stabilised elements can do without" * ("ALPHAN" in missing)
        raise UsageError(f"{kind.name} needs {', '.join(f'{name}=VALUE' for name in missing)}{why}")
    for name in (*needed, "THICKNESS"):
        if values.get(name, 1.0) <= 0.0 and not (kind.solids and name == "ALPHAN"):
            raise UsageError(f"{name}={values[name]:g}: expected a value above 0")
    if kind.jtype:
        check_law_uses(kind.jtype, values, _law_of(values))


def _law_of(values: Mapping[str, float]) -> int:
    """Return LAW; its default is the law with an exponent if a mixed mode criterion has one."""
    return int(values.get("LAW", 2 if values.get("ETA") or values.get("POWER") else 1))


def element_values(kind: InterfaceType, properties: Mapping[str, float], below: Side, above: Side) -> dict[str, float]:
    """Return the properties of an element, completed by those of its solids. Raises UsageError."""
    known = names_of(kind)
    values = ({"LAW": float(_law_of(properties))} if "LAW" in known else {}) | dict(properties)
    if properties.get("ALPHAN") and not properties.get("ALPHAT"):
        values["ALPHAT"] = properties["ALPHAN"]
    if "THICKNESS" in known and "THICKNESS" not in values:
        if None in (below.thickness, above.thickness) or below.thickness != above.thickness:
            thicknesses = " and ".join(f"{_number(side.thickness)} {_location(side)}" for side in (below, above))
            raise UsageError(f"{kind.name} needs THICKNESS=VALUE: the sections on its sides have {thicknesses}")
        values["THICKNESS"] = below.thickness or 1.0
    if "PLANE" in known and "PLANE" not in values:
        if below.plane is None or below.plane != above.plane:
            locations = " and ".join(_location(side) for side in (below, above))
            which = "PLANE=0 (plane stress) or 1 (plane strain)"
            raise UsageError(f"{kind.name} needs {which}: its sides differ or do not say it {locations}")
        values["PLANE"] = below.plane
    if kind.solids:
        for word, side in (("BOTTOM", below), ("TOP", above)):
            values = {f"{name} {word}": value for name, value in side.constants.items()} | values
            values = {f"FORMULATION {word}": float(side.formulation)} | values
            required = (item.name for item in element_layouts()[kind.jtype].reals if item.required)
            missing = [name for name in required if name.endswith(f" {word}") and name not in values]
            if missing:
                words = ", ".join(f"{name.replace(' ', '_')}=VALUE" for name in missing)
                raise UsageError(
                    f"{kind.name} owns the solids on both sides and needs their elastic constants: {side.why}; give "
                    f"{words} and the others of {word}, or the section a material with *ELASTIC"
                )
    return {name: value for name, value in values.items() if name in known}


def _number(value: float | None) -> str:
    return "no thickness" if value is None else f"{value:g}"


def _location(side: Side) -> str:
    return f"({side.location or 'without a section'})"


def property_lines(kind: InterfaceType, elset: str, material: str, values: Mapping[str, float]) -> list[str]:
    """Write the property keyword of an element set, with names as comments."""
    if kind.jtype:
        return uel_property(kind.jtype, elset, values)
    return traction_section(elset, material, values.get("THICKNESS"))


def definition_lines(kind: InterfaceType) -> list[str]:
    """Write *USER ELEMENT of a type of the project; nothing for those of Abaqus."""
    return user_element(kind.jtype) if kind.jtype else []


def material_lines(kind: InterfaceType, name: str, values: Mapping[str, float]) -> list[str]:
    """Write material and section controls of elements of Abaqus; nothing for those of the project."""
    if kind.jtype:
        return []
    law = Cohesive(values["ALPHAN"], values["ALPHAT"], *(values[each] for each in _LAW))
    viscosity, eta, power = (values.get(each, 0.0) for each in ("VISCOSITY", "ETA", "POWER"))
    return traction_material(name, Interface(kind.name, law, viscosity=viscosity, eta=eta, power=power))
