# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTACT, general contact: surface pairs in finite sliding from inclusions and assignments.

Faces of one body that are in the same named surfaces form a class. Inclusions, properties and roles are evaluated for
each pair of classes; classes of a body with the same main classes and property become one secondary surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uel.contact import SurfaceSliding
from uel.deck.contact.contact_sides import Sides, check_corners, surface_pair
from uel.deck.contact.faces import ContactFaces
from uel.deck.contact.geometric_corrections import ASSIGNMENT, Region, read_corrections
from uel.deck.contact.interactions import Interactions
from uel.deck.error_report import Problems, look_up
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import INPUT, NAME, Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.mesh.flatten import FlatMesh
from uel.errors import DeckError, Source
from uel.model.arrays import IntArray
from uel.model.contact import ContactProperty, SurfacePair
from uel.model.mesh import ElementGroup

EVERYTHING = ""
"""Name of the entire contact domain, for a data line without a surface."""

EXTERIOR = "ALL EXTERIOR"
"""The surface of all exterior faces."""

INCLUSIONS, EXCLUSIONS = "CONTACT INCLUSIONS", "CONTACT EXCLUSIONS"
PROPERTY, FORMULATION = "CONTACT PROPERTY ASSIGNMENT", "CONTACT FORMULATION"
INITIALIZATION = "CONTACT INITIALIZATION ASSIGNMENT"
ROLES = ("MASTER SLAVE ROLES", "MAIN SECONDARY ROLES")
MAIN, SECONDARY = ("MAIN", "MASTER"), ("SECONDARY", "SLAVE")


@dataclass(frozen=True, slots=True)
class _Line:
    """Data line: two surfaces and the assigned value."""

    first: str
    second: str
    value: str
    source: Source

    def holds(self, first: _Class, second: _Class) -> bool:
        """Return whether the first class is in the first surface, and the second class in the second."""
        return self.first in first.surfaces and self.second in second.surfaces

    def about(self, first: _Class, second: _Class) -> bool:
        """Return whether the line applies to contact between two classes."""
        return self.holds(first, second) or self.holds(second, first)


@dataclass(frozen=True, slots=True)
class _Class:
    """Faces (numbers of `ContactFaces`) of a body that are in the same surfaces."""

    body: int
    rigid: bool
    surfaces: frozenset[str]
    faces: IntArray


@dataclass(frozen=True, slots=True)
class _Start:
    """*CONTACT INITIALIZATION DATA: largest gap and overlap that are closed at the start."""

    above: float = 0.0
    below: float = np.inf


class GeneralContact:
    """Reader of *CONTACT. Moves nodes to close initial gaps and overlaps."""

    def __init__(
        self, flat: FlatMesh, groups: Sequence[ElementGroup], interactions: Interactions, problems: Problems
    ) -> None:
        self._flat, self._groups = flat, groups
        self._interactions, self._problems = interactions, problems
        self._sides = Sides(flat, groups)
        self._regions: tuple[Region, ...] = ()

    def read(self, blocks: Sequence[Block]) -> tuple[SurfacePair, ...]:
        """Return the contact pairs of the general contact that root blocks of a deck define."""
        pairs: list[SurfacePair] = []
        with self._problems.gather():
            domain = _blocks_of(blocks)
            if domain:
                lines = {name: [line for b in domain if b.name == name for line in _lines(b)] for name in _PARTS}
                lines[EXCLUSIONS] += self._constrained(blocks)
                self._regions = read_corrections(domain, self._sides.surfaces)
                pairs += self._pairs(domain[0], lines, _starts(blocks))
        return tuple(pairs)

    def _pairs(self, head: Block, lines: dict[str, list[_Line]], starts: dict[str, _Start]) -> Iterator[SurfacePair]:
        if not lines[INCLUSIONS]:
            raise head.error(f"expected *{INCLUSIONS}")
        faces = ContactFaces(self._flat, self._groups, self._sides.surfaces)
        classes = self._classes(lines, faces)
        self._check_inclusions(lines[INCLUSIONS], classes)
        chosen: dict[tuple[int, str, str, tuple[int, ...]], list[int]] = {}
        for number, first in enumerate(classes):
            mains: dict[tuple[str, str], list[int]] = {}
            for k, other in enumerate(classes):
                if _touches(lines, first, other) and _is_secondary(lines[FORMULATION], first, other):
                    assigned = _last(lines[PROPERTY], first, other), _last(lines[INITIALIZATION], first, other)
                    mains.setdefault(assigned, []).append(k)
            for assigned, numbers in mains.items():
                chosen.setdefault((first.body, *assigned, tuple(numbers)), []).append(number)
        if not chosen:
            raise head.error("no two bodies can touch; contact of a body with itself is not supported")
        hard = False
        for (_, surface, start, others), secondary in chosen.items():
            line = next((line for line in lines[PROPERTY] if line.value == surface), None)
            contact = self._interactions.find(surface, line.source) if line else ContactProperty("", head.source)
            hard |= contact.stiffness is None
            at_start = next((line for line in lines[INITIALIZATION] if line.value == start), None)
            begin = look_up(starts, start, "contact initialization", at_start.source) if at_start else _Start()
            sides = [classes[k] for k in secondary], [classes[k] for k in others]
            yield self._pair(head, faces, sides, contact, begin)
        if hard:
            self._problems.warn(
                head.source,
                "*CONTACT: hard contact is enforced exactly; unless *SURFACE BEHAVIOR has DIRECT, Abaqus has a penalty "
                "stiffness, which it does not describe, and penetrations",
            )

    def _classes(self, lines: dict[str, list[_Line]], faces: ContactFaces) -> list[_Class]:
        every_line = [line for group in lines.values() for line in group]
        sources = {name: line.source for line in every_line for name in (line.second, line.first) if name}
        members = [
            faces.exterior() if name == EXTERIOR else faces.of_surface(name, source) for name, source in sources.items()
        ]
        if EXTERIOR in sources and faces.without:
            message = f"elements of type {', '.join(faces.without)} have no faces, and touch nothing"
            self._problems.warn(sources[EXTERIOR], f"*{INCLUSIONS}: {message}")
        every = np.unique(np.concatenate(members))
        inside = [np.isin(every, chosen).astype(np.int64) for chosen in members]
        keys, index = np.unique(np.stack([*faces.bodies(every), *inside]), axis=1, return_inverse=True)
        return [
            _Class(
                body,
                bool(rigid),
                frozenset([EVERYTHING, *(name for name, there in zip(sources, inside_flags, strict=True) if there)]),
                every[index.ravel() == number],
            )
            for number, (body, rigid, *inside_flags) in enumerate(keys.T.tolist())
        ]

    def _constrained(self, blocks: Sequence[Block]) -> Iterator[_Line]:
        """Yield exclusions for the surfaces of contact pairs and ties."""
        for block in blocks:
            for row in block.rows() if block.name in ("CONTACT PAIR", "TIE") else ():
                if not row.blank(0) and not row.blank(1):
                    names = row.name(0, "surface"), row.name(1, "surface")
                    kinds = [self._sides.surfaces.kind(name, row.source) for name in names]
                    if kinds == ["ELEMENT"] * 2:
                        yield _Line(*names, "", row.source)

    def _check_inclusions(self, inclusions: Sequence[_Line], classes: Sequence[_Class]) -> None:
        """Raise DeckError for an inclusion within one body only; warn of one that is partly within a body."""
        for line in inclusions:
            bodies = {(first.body, second.body) for first in classes for second in classes if line.holds(first, second)}
            if not any(first != second for first, second in bodies):
                raise DeckError(
                    line.source,
                    f"*{INCLUSIONS}: {line.first} and {line.second} belong to one body; contact of a body with itself "
                    "is not supported",
                )
            if any(first == second for first, second in bodies):
                message = f"contact of a body with itself, between {line.first} and {line.second}, is left out"
                self._problems.warn(line.source, f"*{INCLUSIONS}: {message}")

    def _pair(
        self,
        head: Block,
        faces: ContactFaces,
        classes: tuple[list[_Class], list[_Class]],
        contact: ContactProperty,
        start: _Start,
    ) -> SurfacePair:
        names = ["+".join(str(body) for body in sorted({member.body for member in side})) for side in classes]
        row, points = Row(head.name, (), head.source), self._flat.mesh.coordinates
        secondary, main = (
            self._sides.of_facets(
                faces.facets(np.concatenate([own.faces for own in side]), head.source), f"of body {name}", row
            )
            for side, name in zip(classes, names, strict=True)
        )
        check_corners(main, self._flat.mesh, row)
        name = "({},{})".format(*(f"General_Contact_Faces_{body}" for body in names))
        origin = head.name, head.source
        pair = surface_pair(name, origin, (secondary, main), points, contact, everywhere=True, regions=self._regions)
        chosen, clearances, normals = SurfaceSliding(pair, points).at_nodes()
        chosen &= (clearances != 0.0) & (clearances >= -start.below) & (clearances <= start.above)
        normals = np.pad(normals, ((0, 0), (0, 3 - pair.dimension)))
        np.subtract.at(points, pair.secondary[chosen], (clearances[:, None] * normals)[chosen])
        return pair


def _blocks_of(blocks: Sequence[Block]) -> list[Block]:
    """Return *CONTACT and its keywords."""
    domain: list[Block] = []
    for block in blocks:
        if block.name == "CONTACT":
            domain.append(block)
        elif block.name in (*_PARTS, ASSIGNMENT):
            if not domain:
                raise block.error("does not follow *CONTACT")
            domain.append(block)
    return domain


def _lines(block: Block) -> Iterator[_Line]:
    rows = list(block.rows())
    domain = block.name in (INCLUSIONS, EXCLUSIONS)
    everything = EXTERIOR if block.name == INCLUSIONS else EVERYTHING
    if block.name == INCLUSIONS and block.options.flag("ALL EXTERIOR"):
        if rows:
            raise rows[0].error("ALL EXTERIOR takes no data lines")
        yield _Line(EXTERIOR, EXTERIOR, "", block.source)
        return
    if not rows:
        raise block.error("expected two surfaces on the data line")
    for row in rows:
        row.at_most(2 if domain else 3)
        first = everything if row.blank(0) else row.name(0, "first surface")
        second = first if row.blank(1) else row.name(1, "second surface")
        value = "" if domain else row.name(2, "what is assigned")
        if block.name == FORMULATION and value not in (*MAIN, *SECONDARY):
            raise row.unsupported(f"role {value}", (*MAIN, *SECONDARY))
        yield _Line(first, second, value, row.source)


def _starts(blocks: Sequence[Block]) -> dict[str, _Start]:
    starts = {}
    for block in blocks:
        if block.name == "CONTACT INITIALIZATION DATA":
            above, below = block.not_negative("SEARCH ABOVE", 0.0), block.not_negative("SEARCH BELOW", np.inf)
            starts[block.options.text("NAME")] = _Start(above, below)
    return starts


def _touches(lines: dict[str, list[_Line]], first: _Class, second: _Class) -> bool:
    if first.body == second.body or (first.rigid and second.rigid):
        return False
    included = any(line.about(first, second) for line in lines[INCLUSIONS])
    return included and not any(line.about(first, second) for line in lines[EXCLUSIONS])


def _is_secondary(roles: Sequence[_Line], first: _Class, second: _Class) -> bool:
    """Return whether the first class is secondary: rigid classes are main, then roles decide, then the body number."""
    if first.rigid or second.rigid:
        return not first.rigid
    secondary = first.body > second.body
    for line in roles:
        # a line that applies both ways assigns no role
        if line.holds(first, second) != line.holds(second, first):
            secondary = line.holds(first, second) == (line.value in SECONDARY)
    return secondary


def _last(lines: Sequence[_Line], first: _Class, second: _Class) -> str:
    """Return the value of the last line for two classes, '' without one."""
    return next((line.value for line in reversed(lines) if line.about(first, second)), "")


_PARTS = (INCLUSIONS, EXCLUSIONS, PROPERTY, FORMULATION, INITIALIZATION)

_SURFACES = "first surface, second surface; without the second one the first with itself"

KEYWORDS = (
    Keyword(
        "CONTACT",
        "Begin general contact: finite sliding of surface to surface between bodies. See `uel/contact/contact.md`.",
        Where.MODEL,
        ignored("OP"),
    ),
    Keyword(
        "CONTACT INCLUSIONS",
        "Surfaces that may touch in general contact. A body does not touch itself.",
        Where.MODEL,
        (Option("ALL EXTERIOR", doc="all exterior faces of the model"),),
        f"{_SURFACES}; without the first one all exterior faces",
    ),
    Keyword("CONTACT EXCLUSIONS", "Surfaces that do not touch in general contact.", Where.MODEL, (), _SURFACES),
    Keyword(
        "CONTACT PROPERTY ASSIGNMENT",
        "Contact properties of general contact; the last line about two surfaces counts. Without any: hard contact "
        "without friction.",
        Where.MODEL,
        (INPUT,),
        f"{_SURFACES}; surface interaction",
    ),
    Keyword(
        "CONTACT FORMULATION",
        "Roles in general contact. Without it the body whose elements come first is main, and rigid ones are.",
        Where.MODEL,
        (
            one_of(
                "TYPE",
                "what is assigned",
                ROLES,
                required=True,
                refused=("EDGE TO EDGE", "PURE MASTER-SLAVE", "POLARITY", "SLIDING TRANSITION", "SMALL SLIDING"),
            ),
        ),
        f"{_SURFACES}; role of the first one: MAIN (MASTER), SECONDARY (SLAVE)",
    ),
    Keyword(
        "CONTACT INITIALIZATION ASSIGNMENT",
        "How general contact begins between surfaces.",
        Where.MODEL,
        (),
        f"{_SURFACES}; name of *CONTACT INITIALIZATION DATA",
    ),
    Keyword(
        "CONTACT INITIALIZATION DATA",
        "Gaps and overlaps of general contact that are closed at the start, without strain: secondary nodes are moved.",
        Where.MODEL,
        (
            NAME,
            Option("SEARCH ABOVE", Kind.REAL, "largest gap that is closed (0)"),
            Option("SEARCH BELOW", Kind.REAL, "largest overlap that is closed (any)"),
            *refused("ADJUST", "INITIAL CLEARANCE", "INTERFERENCE FIT", "MINIMUM DISTANCE", "SEARCH NSET"),
            *refused("STEP FRACTION"),
        ),
    ),
)
