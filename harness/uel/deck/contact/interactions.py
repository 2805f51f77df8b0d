# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SURFACE INTERACTION and its contact properties, which are read when a contact pair uses them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from uel.deck.error_report import Problems, nearest
from uel.deck.language.blocks import Block
from uel.deck.language.repetition import check_once
from uel.deck.language.table import NAME, Keyword, Kind, Option, Where, ignored, one_of
from uel.deck.materials.damage import KEYWORDS as DAMAGE_OPTIONS
from uel.deck.materials.damage import OF_SURFACES, extend_damage
from uel.errors import DeckError, Source
from uel.model.contact import INITIAL, SLIP_TOLERANCE, Cohesion, ContactProperty


class Interactions:
    """Contact properties by name."""

    def __init__(self, blocks: Iterable[Block], problems: Problems) -> None:
        self._problems = problems
        self._options: set[Source] = set()
        self._blocks: dict[str, list[Block]] = {}
        self._read: dict[str, ContactProperty] = {}
        current: list[Block] | None = None
        for block in blocks:
            with problems.gather():
                if block.name == "SURFACE INTERACTION":
                    self._blocks[block.options.text("NAME")] = current = [block]
                elif block.name not in _OPTIONS:
                    current = None
                elif current is not None:
                    current.append(block)
                    self._options.add(block.source)
                elif block.name not in DAMAGE:
                    raise block.error("does not follow *SURFACE INTERACTION")

    def find(self, name: str, source: Source) -> ContactProperty:
        """Return a contact property. Raises DeckError if it is unknown or unsupported."""
        if name not in self._blocks:
            raise DeckError(source, f"unknown surface interaction {name}{nearest(name, self._blocks)}")
        if name not in self._read:
            head, *others = self._blocks[name]
            check_once(self._blocks[name], self._problems)
            contact = ContactProperty(name, head.source)
            for block in others:
                match block.name:
                    case "SURFACE BEHAVIOR":
                        contact = _read_behavior(contact, block, self._problems)
                    case "FRICTION":
                        contact = _read_friction(contact, block)
                    case "COHESIVE BEHAVIOR":
                        contact = replace(contact, cohesion=_read_cohesion(block))
                    case _ if block.name in _HEAT:
                        contact = replace(contact, heat=contact.heat or block.source)
                    case _ if block.name in DAMAGE:
                        contact = replace(contact, cohesion=_extend_cohesion(contact.cohesion, block))
                    case _:
                        raise block.error(f"is not supported, but a contact pair uses {name} ({source})")
            self._read[name] = contact
        return self._read[name]

    def without_options(self, blocks: Iterable[Block]) -> list[Block]:
        """Return the blocks without those of contact properties, which *MATERIAL may have too."""
        return [block for block in blocks if block.source not in self._options]

    @property
    def unused(self) -> tuple[tuple[str, Source], ...]:
        """Names and locations of keywords of unused properties."""
        rest = [blocks for name, blocks in self._blocks.items() if name not in self._read]
        return tuple((block.name, block.source) for blocks in rest for block in blocks)


def _refuse(block: Block, *names: str) -> None:
    for name in names:
        if block.options.has(name):
            raise block.unsupported(f"option {name}")


def _read_behavior(contact: ContactProperty, block: Block, problems: Problems) -> ContactProperty:
    options = block.options
    _refuse(block, "AUGMENTED LAGRANGE", "NO SEPARATION")
    kind, row = options.text("PRESSURE-OVERCLOSURE"), block.only_row()
    if kind not in ("HARD", "LINEAR"):
        raise block.unsupported(f"PRESSURE-OVERCLOSURE={kind}", ("HARD", "LINEAR"))
    if kind == "HARD" and not options.has("PENALTY"):
        return replace(contact, stiffness=None)
    if options.has("DIRECT"):
        raise block.error("DIRECT and a stiffness exclude each other")
    unknown = "that of Abaqus depends on the elements in a way that it does not describe"
    if row is None and kind == "HARD":
        problems.warn(block.source, f"*{block.name}: PENALTY without a stiffness is enforced exactly; {unknown}")
        return replace(contact, stiffness=None)
    if row is None or row.blank(0):
        why = "" if kind == "LINEAR" else f"; {unknown}"
        raise block.error(f"expected the stiffness, pressure per overclosure, on the data line{why}")
    slope = row.positive(0, "stiffness")
    clearance, factor, initial = 0.0, 1.0, 1.0
    if kind == "HARD":
        if options.text("PENALTY") == "NONLINEAR":
            initial = INITIAL
            if len(row) > 3:
                raise row.error("other ratios of PENALTY=NONLINEAR than the default ones are not supported")
        row.at_most(3)
        clearance = row.not_negative(1, "clearance at zero pressure", 0.0)
        factor = row.positive(2, "scale factor", 1.0)
    else:
        row.at_most(1)
    return replace(contact, stiffness=slope * factor, clearance=clearance, initial=initial)


def _read_friction(contact: ContactProperty, block: Block) -> ContactProperty:
    _refuse(
        block,
        *("ANISOTROPIC", "DEPENDENCIES", "DEPVAR", "EXPONENTIAL DECAY", "LAGRANGE", "PROPERTIES", "ROUGH"),
        *("SHEAR TRACTION SLOPE", "TAUMAX", "TEST DATA", "USER"),
    )
    rows = list(block.rows())
    if not rows:
        raise block.error("expected the friction coefficient on the data line")
    if len(rows) > 1 or len(rows[0]) > 1:
        raise rows[-1].unsupported("a coefficient that depends on slip rate, pressure or fields")
    coefficient = rows[0].not_negative(0, "friction coefficient")
    tolerance, elastic = block.positive("SLIP TOLERANCE", SLIP_TOLERANCE), block.positive("ELASTIC SLIP", 0.0)
    return replace(contact, friction=coefficient, slip_tolerance=tolerance, elastic_slip=elastic)


def _read_cohesion(block: Block) -> Cohesion:
    _refuse(block, "DEPENDENCIES", "REPEATED CONTACTS")
    row = block.only_row()
    if row is None:
        raise block.error(
            "expected the stiffnesses, traction per separation, on the data line; those of Abaqus depend on the "
            "elements in a way that it does not describe"
        )
    if len(row) not in (2, 3):
        raise row.dependent(f"{len(row)} values, expected 2 or 3")
    values = tuple(row.real(k, "stiffness") for k in range(len(row)))
    if min(values) <= 0:
        raise row.error(f"stiffness {min(values):g} must be positive")
    return Cohesion(values, block.source)


def _extend_cohesion(cohesion: Cohesion | None, block: Block) -> Cohesion:
    """Return the cohesive behavior with the damage data of a keyword. Raises DeckError."""
    if cohesion is None:
        raise block.error("does not follow *COHESIVE BEHAVIOR")
    return replace(cohesion, damage=extend_damage(cohesion.damage, block, OF_SURFACES))


DAMAGE = tuple(keyword.name for keyword in DAMAGE_OPTIONS)

_HEAT = ("GAP CONDUCTANCE", "GAP HEAT GENERATION")

_OPTIONS = ("SURFACE BEHAVIOR", "FRICTION", "COHESIVE BEHAVIOR", "CONTACT DAMPING", *_HEAT, *DAMAGE)


def _flags(*names: str) -> tuple[Option, ...]:
    return tuple(Option(name, Kind.FLAG, "not supported in contact pairs") for name in names)


def _values(*names: str) -> tuple[Option, ...]:
    return tuple(Option(name, Kind.NAME, "not supported in contact pairs", bare="YES") for name in names)


KEYWORDS = (
    Keyword(
        "SURFACE INTERACTION",
        "Begin a contact property: hard contact without friction, unless *SURFACE BEHAVIOR and *FRICTION follow. One "
        "that no contact pair uses is listed and left out, whatever it has.",
        Where.MODEL,
        (NAME, *ignored("DEPVAR", "PAD THICKNESS", "PROPERTIES")),
        "out-of-plane thickness, which counts on surfaces of nodes alone and is not read: areas of *SURFACE, TYPE=NODE "
        "are",
    ),
    Keyword(
        "SURFACE BEHAVIOR",
        "Pressure of a contact property: HARD, enforced directly or by PENALTY, or LINEAR.",
        Where.MODEL,
        (
            one_of(
                "PRESSURE-OVERCLOSURE",
                "how the pressure depends on the overclosure",
                ("HARD", "LINEAR", "EXPONENTIAL", "TABULAR", "SCALE FACTOR"),
                default="HARD",
            ),
            Option("DIRECT", doc="the constraint is enforced directly, the default of hard contact"),
            one_of(
                "PENALTY",
                "a stiffness enforces it, constant or growing with the overclosure; without a data line it is exact",
                ("LINEAR", "NONLINEAR"),
                bare="LINEAR",
            ),
            *_flags("AUGMENTED LAGRANGE", "NO SEPARATION"),
        ),
        "PENALTY: (final) stiffness, clearance at zero pressure (0), scale factor (1); LINEAR: slope",
    ),
    Keyword(
        "FRICTION",
        "Coulomb friction of a contact property, with an elastic slip below the limit.",
        Where.MODEL,
        (
            Option("SLIP TOLERANCE", Kind.REAL, f"largest elastic slip over the length of a face ({SLIP_TOLERANCE})"),
            Option("ELASTIC SLIP", Kind.REAL, "largest elastic slip itself"),
            *_flags("ANISOTROPIC", "EXPONENTIAL DECAY", "LAGRANGE", "ROUGH", "TEST DATA"),
            *_values("DEPENDENCIES", "DEPVAR", "PROPERTIES", "SHEAR TRACTION SLOPE", "TAUMAX", "USER"),
        ),
        "friction coefficient",
    ),
    Keyword(
        "COHESIVE BEHAVIOR",
        "Bond of the points of a contact pair that are in contact at the start, until it fails where *DAMAGE "
        "INITIATION and *DAMAGE EVOLUTION follow. See harness/uel/contact/contact.md.",
        Where.MODEL,
        (
            one_of("TYPE", "tractions by the separations", ("UNCOUPLED",), default="UNCOUPLED", refused=("COUPLED",)),
            one_of(
                "ELIGIBILITY",
                "points that are bonded",
                ("ORIGINAL CONTACTS",),
                default="ORIGINAL CONTACTS",
                refused=("CURRENT CONTACTS", "SPECIFIED CONTACTS"),
            ),
            one_of(
                "COHERE",
                "points that are bonded",
                ("ORIGINAL CONTACTS",),
                default="ORIGINAL CONTACTS",
                refused=("FIRST CONTACTS", "REPEATED CONTACTS"),
            ),
            *_flags("REPEATED CONTACTS"),
            *_values("DEPENDENCIES"),
        ),
        "stiffness, traction per separation, of the normal, first shear and second shear direction",
    ),
    Keyword(
        "GAP CONDUCTANCE",
        "Heat that crosses a contact: refused in steps with temperatures, without effect in others.",
        Where.MODEL,
        ignored("DEPENDENCIES", "PRESSURE", "TABULAR", "USER"),
        "not read",
    ),
    Keyword(
        "GAP HEAT GENERATION",
        "Heat of friction: refused in steps with temperatures, without effect in others.",
        Where.MODEL,
        ignored("USER"),
        "not read",
    ),
    Keyword(
        "CONTACT DAMPING",
        "Viscous contact property, which no contact pair here can have.",
        Where.MODEL,
        ignored("DEFINITION", "TANGENT FRACTION"),
        "not read",
    ),
)
