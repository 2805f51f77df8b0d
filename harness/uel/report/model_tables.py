# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of a model: its elements, its steps, and the properties of its sections by name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from uel.errors import Source
from uel.model.element_types import BuiltInType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import (
    BeamSection,
    CohesiveSection,
    CompositeSection,
    ElasticType,
    Holzapfel,
    Material,
    MembraneSection,
    ShellSection,
    SolidSection,
    UserElement,
    UserPotential,
    UserProperty,
)
from uel.output.files.sta_file import StatusRow
from uel.output.results import Counts
from uel.usersub.layout import ElementLayout, Item, element_layouts

_CONSTANTS: Final = {
    ElasticType.ISOTROPIC: ("E", "nu"),
    ElasticType.ENGINEERING_CONSTANTS: ("E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"),
    ElasticType.LAMINA: ("E1", "E2", "nu12", "G12", "G13", "G23"),
    ElasticType.TRACTION: ("Knn", "Kss", "Ktt"),
}
"""Names of the constants of *ELASTIC in their order."""

Row = tuple[str, ...]
_WithMaterial = SolidSection | CompositeSection | CohesiveSection | ShellSection | MembraneSection | BeamSection


@dataclass(frozen=True, slots=True)
class Table:
    """A table: title, where it is in the deck, heads of the columns, rows."""

    title: str
    head: Row
    rows: Sequence[Row]
    source: Source | None = None


def element_table(model: Model) -> Table:
    """Return the numbers of elements by type, and what each type is."""
    counts: dict[str, int] = {}
    meanings: dict[str, str] = {}
    for group in model.groups:
        counts[group.type] = counts.get(group.type, 0) + len(group.labels)
        layout = layout_of(group.definition)
        meanings[group.type] = layout.meaning if layout else "user element" if group.definition else "built in"
    rows = [(name, f"{count}", meanings[name]) for name, count in counts.items()]
    return Table("Elements", ("type", "number", "what it is"), rows)


def step_table(model: Model, status: Sequence[StatusRow]) -> Table:
    """Make the table of the steps with what they took."""
    rows = []
    for step in model.steps:
        mine = [row for row in status if row.step == step.number]
        counts = Counts.of(mine)
        words = [step.procedure.full_title.lower(), *(["large displacements"] if step.nlgeom else [])]
        period = f"{step.procedure.period:g}" if not step.procedure.linear else "-"
        numbers = (f"{value}" for value in (counts.increments, counts.iterations, counts.cutbacks))
        rows.append((f"{step.number} {step.name}".strip(), ", ".join(words), period, *numbers))
    head = ("step", "procedure", "time", "increments", "iterations", "cutbacks")
    return Table("Steps", head, rows)


def property_tables(model: Model) -> Iterator[Table]:
    """Yield a table of properties for each section, once."""
    seen: set[Source] = set()
    for group in model.groups:
        section = group.section
        if section.source in seen:
            continue
        seen.add(section.source)
        if isinstance(section, UserProperty):
            yield _user_table(group, section)
        elif isinstance(section, _WithMaterial):
            rows = _said_once(_section_rows(section, group.built_in))
            yield Table(f"{section.elset}: {group.type}", ("property", "value", ""), rows, section.source)


def layout_of(definition: UserElement | None) -> ElementLayout | None:
    """Return the project's element that a deck defines, by its number, nodes and variables; None for any other."""
    layout = element_layouts().get(definition.number) if definition else None
    if definition and layout and (layout.nodes, layout.svars) == (definition.nodes, definition.variables):
        return layout
    return None


def _user_table(group: ElementGroup, section: UserProperty) -> Table:
    definition = group.definition
    title = f"{section.elset}: {group.type}"
    layout = layout_of(definition)
    if layout is not None:
        items = [*zip(layout.reals, section.values.tolist(), strict=False)]
        items += [*zip(layout.integers, section.integers.tolist(), strict=False)]
        rows = [_item_row(item, value) for item, value in items if value]
        if zero := ", ".join(item.name for item, value in items if not value):
            rows.append(("the others", "0", zero))
        return Table(title, ("property", "value", "meaning"), rows, section.source)
    names = definition.names if definition else None
    rows = [
        *_named(section.values.tolist(), names.properties if names else (), "PROPS"),
        *_named(section.integers.tolist(), names.integers if names else (), "JPROPS"),
    ]
    return Table(title, ("property", "value", ""), rows, section.source)


def _item_row(item: Item, value: float) -> Row:
    dimension = f" ({item.unit})" if item.unit not in ("", "1") else ""
    return item.name, f"{value:g}", f"{item.meaning}{dimension}"


def _named(values: Sequence[float], names: Sequence[str], array: str) -> list[Row]:
    entries = [f"{array}({k})" for k in range(1, len(values) + 1)]
    if not names:
        return [(entry, f"{value:g}", "") for entry, value in zip(entries, values, strict=True)]
    return [(name, f"{value:g}", entry) for name, value, entry in zip(names, values, entries, strict=True)]


def _said_once(rows: Sequence[Row]) -> list[Row]:
    """Return the rows whose last cell is empty where it repeats the one above."""
    above = ["", *(row[-1] for row in rows)]
    return [(*row[:-1], "" if row[-1] == last else row[-1]) for row, last in zip(rows, above, strict=False)]


def _section_rows(section: _WithMaterial, kind: BuiltInType | None) -> list[Row]:
    if isinstance(section, BeamSection):
        return [*_beam_rows(section)]
    if isinstance(section, ShellSection | CompositeSection):
        layers = _layer_rows(section) if isinstance(section, ShellSection) else _solid_layer_rows(section)
        return [*layers, *(row for material in _materials(section) for row in _material_rows(material))]
    rows: list[Row] = [("material", section.material.name, "")]
    # of a solid in space it is no more than the default
    if isinstance(section, CohesiveSection | MembraneSection) or kind is None or kind.dimension == 2:
        rows.append(("thickness", f"{section.thickness:g}", ""))
    if isinstance(section, CohesiveSection):
        rows.append(("width", f"{section.width:g}", ""))
    elif section.orientation is not None:
        rows.append(("orientation", section.orientation.name, ""))
    return [*rows, *_material_rows(section.material)]


def _layer_rows(section: ShellSection) -> Iterator[Row]:
    for number, layer in enumerate(section.layers, 1):
        remark = f"layer {number}, {layer.angle:g} degrees, {layer.points} section points"
        yield f"thickness of {layer.material.name}", f"{layer.thickness:g}", remark
    if section.offset:
        yield "offset", f"{section.offset:g}", "of the thickness"
    if section.orientation is not None:
        yield "orientation", section.orientation.name, ""


def _solid_layer_rows(section: CompositeSection) -> Iterator[Row]:
    for number, layer in enumerate(section.layers, 1):
        remark = f"layer {number}, {layer.points} section points"
        if layer.orientation is not None:
            remark += f", orientation {layer.orientation.name}"
        if layer.angle is not None:
            remark += f", {layer.angle:g} degrees"
        yield f"relative thickness of {layer.material.name}", f"{layer.thickness:g}", remark
    yield "stack direction", f"{section.direction}", ""


def _beam_rows(section: BeamSection) -> Iterator[Row]:
    yield "profile", section.profile, ", ".join(f"{value:g}" for value in section.dimensions)
    yield "n1", ", ".join(f"{value:g}" for value in section.n1), "approximate"
    if section.material is not None:
        yield from _material_rows(section.material)
    else:
        yield "E", f"{section.young:g}", ""
        yield "G", f"{section.shear_modulus:g}", ""


def _materials(section: ShellSection | CompositeSection) -> list[Material]:
    """Return each material of the layers once."""
    return list({layer.material.name: layer.material for layer in section.layers}.values())


def _material_rows(material: Material) -> Iterator[Row]:
    if material.elastic is not None:
        constants = material.elastic.constants
        names = _CONSTANTS.get(material.elastic.type, tuple(f"constant {k + 1}" for k in range(len(constants))))
        kind = f"*ELASTIC, TYPE={material.elastic.type}"
        yield from ((name, f"{value:g}", kind) for name, value in zip(names, constants, strict=False))
    law = material.hyperelastic
    if isinstance(law, UserPotential):
        yield from (
            (f"constant {k}", f"{value:g}", f"*{law.keyword}, USER") for k, value in enumerate(law.constants, 1)
        )
    elif isinstance(law, Holzapfel):
        names, kind = ("C10", "D", "k1", "k2", "kappa"), f"*{law.keyword}, HOLZAPFEL"
        yield from ((name, f"{value:g}", kind) for name, value in zip(names, law.coefficients, strict=True))
    elif law is not None:
        kind = f"*HYPERELASTIC, {law.potential}, N={law.order}"
        yield from ((f"coefficient {k}", f"{value:g}", kind) for k, value in enumerate(law.coefficients, 1))
        yield from ((f"D{k}", f"{value:g}", kind) for k, value in enumerate(law.compliances, 1))
    if material.damage is not None:
        words = f"*DAMAGE INITIATION, CRITERION={material.damage.criterion}"
        for name, value in zip(
            ("onset, normal", "onset, first shear", "onset, second shear"), material.damage.onset, strict=True
        ):
            yield name, f"{value:g}", words
        if material.damage.evolution is not None:
            evolution = material.damage.evolution
            kind = f"*DAMAGE EVOLUTION, TYPE={evolution.type}"
            yield "to failure", ", ".join(f"{value:g}" for value in evolution.values), kind
    if material.user is not None:
        yield from (
            (f"constant {k}", f"{value:g}", "*USER MATERIAL")
            for k, value in enumerate(material.user.constants.tolist(), 1)
        )
    if material.density:
        yield "density", f"{material.density:g}", ""
    yield from _thermal_rows(material)


def _thermal_rows(material: Material) -> Iterator[Row]:
    if material.expansion is not None:
        table = material.expansion.table
        for temperature, *values in table.tolist():
            remark = f"at temperature {temperature:g}" if len(table) > 1 else ""
            yield "expansion", ", ".join(f"{value:g}" for value in values if value), remark
    for name, table in (("conductivity", material.conductivity), ("specific heat", material.specific_heat)):
        for value, temperature in table.tolist():
            yield name, f"{value:g}", f"at temperature {temperature:g}" if len(table) > 1 else ""
