# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*DLOAD, *DSLOAD, *TEMPERATURE, *FIELD and *PRESSURE STRESS."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.repetition import overlaps, repeated_value
from uel.deck.language.table import Keyword, Kind, Option, Where, refused
from uel.deck.mesh.flatten import FlatMesh
from uel.deck.mesh.surfaces import face_nodes
from uel.deck.steps.initial import FIELD_NUMBER, field_number
from uel.deck.steps.prescribed import HARMONIC, LOAD, Prescription, of_amplitude
from uel.model.element_types import BODY_FORCES, BeamType, ContinuumType, Direction, SurfaceType
from uel.model.mesh import ElementGroup
from uel.model.steps import ON_EDGES, PRESSURE_STRESS, DistributedLoad, ElementLoad, Load, LoadKind, LoadType

_USER_LOAD = re.compile(r"U([1-9]\d{0,3})(NU)?")
_BY_DLOAD = re.compile(r"(P\d|B[XYZR])NU")
_NO_DIRECTION: Direction = (0.0, 0.0, 0.0)
_SURFACE = ("P", "TRVEC", "TRSHR")
_ON_EDGE = re.compile(rf"({'|'.join(ON_EDGES)})([1-4])")


def read_distributed(block: Block, prescription: Prescription) -> list[DistributedLoad | ElementLoad]:
    """Read the entries of one *DLOAD, on user elements and on built-in ones. Raises DeckError."""
    amplitude, imaginary = prescription.amplitude(block), block.options.flag("IMAGINARY")
    loads: list[DistributedLoad | ElementLoad] = []
    for row in block.rows():
        label = row.name(1, "load type")
        elements = prescription.flat.elements(row.name(0, "element or element set"), row.source)
        magnitude = row.real(2, "magnitude", 0.0)
        match = _USER_LOAD.fullmatch(label)
        if match is None:
            by_user = _BY_DLOAD.fullmatch(label) is not None
            plain = label.removesuffix("NU") if by_user else label
            for group, positions in prescription.surfaces.by_group(elements):
                solid = _loaded(row, label, group)
                if isinstance(solid, BeamType):
                    load_type = _beam_load(row, label, solid)
                    loads.append(ElementLoad(positions, load_type, magnitude, amplitude, row.source, imaginary))
                    continue
                kind, face, direction = _volume_load(row, plain)
                if plain == "P" and not isinstance(solid, SurfaceType):
                    message = f"load type P on elements of type {group.type}"
                    raise row.error(f"{message}; expected Pn with the number of a face")
                if kind is LoadKind.BODY:
                    direction = _body_direction(row, plain, solid)
                jltyp = _jltyp(face, direction) if by_user else 0
                nodes = face_nodes(group, face, row.source, block.name) if face else ()
                follows = kind is LoadKind.PRESSURE or kind in ON_EDGES
                load_type = LoadType(kind, nodes, direction, follows=follows, jltyp=jltyp)
                loads.append(ElementLoad(positions, load_type, magnitude, amplitude, row.source, imaginary))
            continue
        row.at_most(3)
        built_in = prescription.built_in[elements]
        if built_in.any():
            raise row.error(f"load type {label} on elements that are not user elements ({np.count_nonzero(built_in)})")
        kind_number = -int(match[1]) if match[2] else int(match[1])
        loads.append(DistributedLoad(elements, kind_number, magnitude, amplitude, row.source))
    return loads


def _jltyp(face: str, direction: Direction) -> int:
    """Return JLTYP of a nonuniform load: 20 + n for face n, 1 to 3 for directions (User Subroutines Guide, DLOAD)."""
    return 20 + int(face[1:]) if face else 1 + direction.index(1.0)


def _volume_load(row: Row, label: str) -> tuple[LoadKind, str, Direction]:
    """Return kind, face ('' for a volume) and direction of a *DLOAD label, except that of body forces."""
    match = re.fullmatch(r"P(\d)", label)
    if label == "P":
        # along the normal of the shell, which is a pressure on SNEG
        row.at_most(3)
        return LoadKind.PRESSURE, "SNEG", _NO_DIRECTION
    if (edge := _ON_EDGE.fullmatch(label)) is not None:
        general = edge[1] == LoadKind.EDGE
        row.at_most(6 if general else 3)
        return LoadKind(edge[1]), f"E{edge[2]}", _direction(row, label) if general else _NO_DIRECTION
    if match is None and label != "GRAV" and label not in BODY_FORCES:
        forces, edges = ", ".join(BODY_FORCES), ", ".join(f"{kind}n" for kind in ON_EDGES)
        supported = (
            f"Un and UnNU on user elements; Pn (P on shells and membranes), {forces}, those with NU, and GRAV on "
            f"built-in elements; {edges} on shells"
        )
        raise row.error(f"load type {label} is not supported (supported: {supported})")
    row.at_most(6 if label == "GRAV" else 3)
    if label == "GRAV":
        return LoadKind.GRAVITY, "", _direction(row, label)
    if match is None:
        return LoadKind.BODY, "", _NO_DIRECTION
    return LoadKind.PRESSURE, f"S{match[1]}", _NO_DIRECTION


def _beam_load(row: Row, label: str, beam: BeamType) -> LoadType:
    """Return the load type of a *DLOAD on beams. Raises DeckError."""
    row.at_most(6 if label == "GRAV" else 3)
    if label == "GRAV":
        return LoadType(LoadKind.GRAVITY, direction=_direction(row, label))
    if label in beam.body_forces:
        return LoadType(LoadKind.BODY, direction=beam.body_forces[label])
    if label in beam.line_forces:
        return LoadType(LoadKind.LINE, direction=beam.line_forces[label])
    if label in beam.local_forces:
        return LoadType(LoadKind.LOCAL_LINE, direction=beam.local_forces[label], follows=True)
    supported = ", ".join([*beam.body_forces, *beam.line_forces, *beam.local_forces, "GRAV"])
    raise row.error(f"load type {label} on elements of type {beam.name} is not supported (supported: {supported})")


def _body_direction(row: Row, label: str, solid: ContinuumType | SurfaceType) -> Direction:
    known = solid.body_forces
    if label not in known:
        raise row.error(f"load type {label} on elements of type {solid.name}, whose body forces are {', '.join(known)}")
    return known[label]


def read_surface_loads(block: Block, prescription: Prescription) -> list[ElementLoad]:
    """Read the entries of one *DSLOAD. Raises DeckError."""
    amplitude, imaginary = prescription.amplitude(block), block.options.flag("IMAGINARY")
    follower = block.options.flag("FOLLOWER") if block.options.has("FOLLOWER") else True
    loads = []
    for row in block.rows():
        label = row.name(1, "load type")
        if label not in (*_SURFACE, *ON_EDGES):
            raise row.unsupported(f"load type {label}", (*_SURFACE, *ON_EDGES))
        kind = LoadKind(label)
        directed = kind in (LoadKind.TRACTION, LoadKind.SHEAR, LoadKind.EDGE)
        row.at_most(6 if directed else 3)
        direction = _direction(row, label) if directed else _NO_DIRECTION
        magnitude = row.real(2, "magnitude", 0.0)
        for elements, face, source in prescription.surfaces.faces(row.name(0, "surface"), row.source):
            for group, positions in prescription.surfaces.by_group(elements):
                kind_of_element = _loaded(row, label, group)
                on_edge = isinstance(kind_of_element, SurfaceType) and face in kind_of_element.edges
                if on_edge != (kind in ON_EDGES):
                    expected = ", ".join(ON_EDGES if on_edge else _SURFACE)
                    raise row.error(f"load type {label} on face {face} of {group.type}; expected {expected}")
                nodes = face_nodes(group, face, source, "SURFACE")
                follows = follower if kind in (LoadKind.TRACTION, LoadKind.SHEAR, LoadKind.EDGE) else True
                load_type = LoadType(kind, nodes, direction, follows=follows)
                loads.append(ElementLoad(positions, load_type, magnitude, amplitude, row.source, imaginary))
    return loads


def _direction(row: Row, label: str) -> Direction:
    """Read the unit vector in entries 4 to 6. Raises DeckError."""
    components = np.array([row.real(index, "component of the direction", 0.0) for index in (3, 4, 5)])
    length = float(np.linalg.norm(components))
    if length == 0.0:
        raise row.error(f"{label} needs a direction, entries 4 to 6")
    x, y, z = (components / length).tolist()
    return x, y, z


def _loaded(row: Row, label: str, group: ElementGroup) -> ContinuumType | SurfaceType | BeamType:
    """Return the type of a group of continuum elements, shells, membranes or beams. Raises DeckError for others."""
    kind = group.built_in
    if isinstance(kind, SurfaceType) and label.endswith("NU"):
        raise row.error(f"load type {label} on elements of type {group.type}; loads by DLOAD are not supported there")
    if not isinstance(kind, ContinuumType | SurfaceType | BeamType):
        message = f"load type {label} on elements of type {group.type}"
        raise row.error(f"{message}, which are not built-in continuum elements, shells, membranes or beams")
    return kind


def read_fields(block: Block, prescription: Prescription) -> list[Load]:
    """Read one *TEMPERATURE, *FIELD or *PRESSURE STRESS; dof: number of the field, 0 for temperature."""
    amplitude = prescription.amplitude(block)
    number = field_number(block) if block.name == "FIELD" else {"TEMPERATURE": 0}.get(block.name, PRESSURE_STRESS)
    by_user = block.options.known("USER") and block.options.flag("USER")
    entries = []
    for row in block.rows():
        row.at_most(2)
        nodes = prescription.flat.nodes(row.name(0, "node or node set"), row.source)
        data = nodes, number, row.real(1, "value", 0.0), amplitude, row.source
        entries.append(Load(*data, user=by_user))
    return entries


def keep_last(entries: Sequence[Load], flat: FlatMesh, problems: Problems) -> tuple[Load, ...]:
    """Return the fields of a step with the last value of each node; warn of earlier values that differ."""
    by_field: dict[int, list[int]] = {}
    for k, entry in enumerate(entries):
        by_field.setdefault(entry.dof, []).append(k)
    nodes_of = {k: entry.nodes for k, entry in enumerate(entries)}
    for dof, group in by_field.items():
        name = {0: "TEMPERATURE", PRESSURE_STRESS: "PRESSURE STRESS"}.get(dof, f"FIELD, VARIABLE={dof}")
        for first, later, node in overlaps([nodes_of[k] for k in group]):
            before, here = entries[group[first]], entries[group[later]]
            if _value(before) != _value(here):
                item = f"*{name}: node {flat.mesh.name(node)}"
                message = repeated_value(item, _value(here), _value(before), before.source, "in one step")
                problems.warn(here.source, message)
        set_later = np.zeros(len(flat.mesh.labels), dtype=bool)
        for k in reversed(group):
            nodes_of[k] = nodes_of[k][~set_later[nodes_of[k]]]
            set_later[nodes_of[k]] = True
    return tuple(replace(entry, nodes=nodes_of[k]) for k, entry in enumerate(entries) if len(nodes_of[k]))


def _value(entry: Load) -> str:
    """Return the value of an entry, for messages."""
    return "what the user routine says" if entry.user else of_amplitude(entry)


KEYWORDS = (
    Keyword(
        "DLOAD",
        "Distributed loads on elements.",
        Where.STEP,
        (
            *LOAD,
            *HARMONIC,
            *refused(
                *("CONSTANT RESULTANT", "CYCLIC MODE", "FOLLOWER", "LOAD CASE", "ORIENTATION", "REF NODE"),
                "REGION TYPE",
            ),
        ),
        "element or set, Un or UnNU (user elements), Pn, BX, BY, BZ, BR (CAX) or GRAV (built-in continuum elements; "
        "with NU, as in P2NU, by DLOAD), P (shells and membranes: along their normal), BX, BY, BZ or GRAV (on them), "
        "EDLDn, EDNORn, EDSHRn, EDTRAn (per length of edge n of shells), magnitude; GRAV, EDLDn: direction; beams: PX, "
        "PY, PZ (force per length), P1, P2 (along the local directions), BX, BY, BZ or GRAV",
    ),
    Keyword(
        "DSLOAD",
        "Distributed loads on surfaces of built-in continuum elements, shells and membranes. Like those of *DLOAD they "
        "are nodal forces, which CF in the output includes, except with NLGEOM pressures and tractions that follow the "
        "surface: they act on the current area, and tractions turn by the rotation in the polar decomposition of its "
        "deformation.",
        Where.STEP,
        (
            *LOAD,
            Option("FOLLOWER", Kind.SWITCH, "TRVEC and TRSHR follow the surface (YES)"),
            *HARMONIC,
            *refused("CONSTANT RESULTANT", "CYCLIC MODE", "LOAD CASE", "ORIENTATION", "REF NODE"),
        ),
        "surface, P, TRVEC or TRSHR, or of edges of shells EDLD, EDNOR (into the shell), EDSHR (along the edge) or "
        "EDTRA (against the normal), magnitude; TRVEC, TRSHR, EDLD: direction",
    ),
    Keyword(
        "TEMPERATURE",
        "Temperature as a predefined field.",
        Where.STEP,
        (
            *LOAD,
            Option("USER", doc="UTEMP gives the values"),
            *refused("ABSOLUTE EXTERIOR TOLERANCE", "BSTEP", "DRIVING ELSETS", "ESTEP", "FILE"),
        ),
        "node or set, temperature",
    ),
    Keyword(
        "PRESSURE STRESS",
        "Equivalent pressure stress, minus the mean of the direct stresses, as a predefined field in *MASS DIFFUSION.",
        Where.STEP,
        (*LOAD, *refused("BSTEP", "BINC", "ESTEP", "EINC", "FILE", "USER")),
        "node or set, equivalent pressure stress",
    ),
    Keyword(
        "FIELD",
        "Predefined field variable.",
        Where.STEP,
        (FIELD_NUMBER, *LOAD, Option("USER", doc="UFIELD gives the values"), *refused("FILE")),
        "node or set, value",
    ),
)
