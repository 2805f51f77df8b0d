# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties of the elements that are inserted: given by name, or those of the solids that an element owns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from uel.deck.error_report import nearest
from uel.delamination.blocks import Interface, traction_material, traction_section
from uel.delamination.kernels import uel_property, user_element
from uel.delamination.materials import Cohesive
from uel.errors import UsageError
from uel.insertion.connectivity import InterfaceType, known_types
from uel.insertion.sections import Side
from uel.usersub.layout import check_law_uses, element_layouts

_LAW = ("SIGMAMAX", "TAUMAX", "GIC", "GIIC")
_OF_ABAQUS = ("THICKNESS", "ALPHAN", "ALPHAT", *_LAW, "VISCOSITY", "ETA", "POWER")


def read_values(words: Sequence[str]) -> dict[str, float]:
    """Return the values by name from NAME=VALUE; an underscore stands for a blank. Raises UsageError."""
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
    """Names of the properties that have to be given: those without a default that sections of solids do not have."""
    if not kind.jtype:
        return ("ALPHAN", *_LAW)
    names = tuple(item.name for item in element_layouts()[kind.jtype].reals if item.required)
    law = tuple(name for name in names if name != "THICKNESS" and not name.endswith((" BOTTOM", " TOP")))
    return law if kind.solid else ("ALPHAN", *law)


def check_values(kind: InterfaceType, values: Mapping[str, float]) -> None:
    """Raise UsageError for a name that the type lacks, a law that is not complete, or a value out of its range."""
    known = names_of(kind)
    for name in values:
        if name not in known:
            raise UsageError(f"{kind.name} has no property {name} (it has: {', '.join(known)}){nearest(name, known)}")
    needed = required_names(kind)
    missing = [name for name in needed if name not in values]
    if missing:
        owners = ", ".join(each.name for each in known_types().values() if each.solid)
        why = f": a stiffness, which only {owners} can do without, between quads and bricks" * ("ALPHAN" in missing)
        raise UsageError(f"{kind.name} needs {', '.join(f'{name}=VALUE' for name in missing)}{why}")
    for name in (*needed, "THICKNESS"):
        if values.get(name, 1.0) <= 0.0 and not (kind.solid and name == "ALPHAN"):
            raise UsageError(f"{name}={values[name]:g}: expected a value above 0")
    if kind.jtype:
        check_law_uses(kind.jtype, values, _law_of(values))


def _law_of(given: Mapping[str, float]) -> int:
    """Return LAW, if it is not given: a mixed mode criterion with an exponent needs the law that has one."""
    return int(given.get("LAW", 2 if given.get("ETA") or given.get("POWER") else 1))


def element_values(kind: InterfaceType, given: Mapping[str, float], below: Side, above: Side) -> dict[str, float]:
    """Return the properties of an element: given ones, then those of its solids. Raises UsageError."""
    known = names_of(kind)
    values = ({"LAW": float(_law_of(given))} if "LAW" in known else {}) | dict(given)
    if given.get("ALPHAN") and not given.get("ALPHAT"):
        values["ALPHAT"] = given["ALPHAN"]
    if "THICKNESS" in known and "THICKNESS" not in values:
        if None in (below.thickness, above.thickness) or below.thickness != above.thickness:
            given_ones = " and ".join(f"{_number(side.thickness)} {_place(side)}" for side in (below, above))
            raise UsageError(f"{kind.name} needs THICKNESS=VALUE: the sections on its sides have {given_ones}")
        values["THICKNESS"] = below.thickness or 1.0
    if "PLANE" in known and "PLANE" not in values:
        if below.plane is None or below.plane != above.plane:
            places = " and ".join(_place(side) for side in (below, above))
            which = "PLANE=0 (plane stress) or 1 (plane strain)"
            raise UsageError(f"{kind.name} needs {which}: its sides differ or do not say it {places}")
        values["PLANE"] = below.plane
    if kind.solid:
        for word, side in (("BOTTOM", below), ("TOP", above)):
            values = {f"{name} {word}": value for name, value in side.constants.items()} | values
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


def _place(side: Side) -> str:
    return f"({side.place or 'without a section'})"


def property_lines(kind: InterfaceType, elset: str, material: str, values: Mapping[str, float]) -> list[str]:
    """Write the keyword that gives elements of a set their properties, with their names as comments."""
    if kind.jtype:
        return uel_property(kind.jtype, elset, values)
    return traction_section(elset, material, values.get("THICKNESS"))


def definition_lines(kind: InterfaceType) -> list[str]:
    """Write *USER ELEMENT of a type of the project; nothing for those of Abaqus."""
    if not kind.jtype:
        return []
    return user_element(kind.jtype)


def material_lines(kind: InterfaceType, name: str, values: Mapping[str, float]) -> list[str]:
    """Write material and section controls of elements of Abaqus, in no part; nothing for the project's own."""
    if kind.jtype:
        return []
    stiffness = values["ALPHAN"]
    law = Cohesive(stiffness, values["ALPHAT"], *(values[each] for each in _LAW))
    numbers = (values.get(each, 0.0) for each in ("VISCOSITY", "ETA", "POWER"))
    viscosity, eta, power = numbers
    return traction_material(name, Interface(kind.name, law, viscosity=viscosity, eta=eta, power=power))
