# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Heat loads on elements with temperatures: fluxes, films and radiation."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Kind, Option, Where, ignored, refused
from uel.deck.mesh.surfaces import face_nodes
from uel.deck.steps.prescribed import LOAD, Prescription
from uel.model.amplitude import Amplitude
from uel.model.arrays import IntArray
from uel.model.element_types import SolidType
from uel.model.mesh import ElementGroup
from uel.model.steps import HeatLaw, HeatLoad, HeatLoadType

HEAT_LOADS: Final = ("DFLUX", "DSFLUX", "FILM", "SFILM", "CFILM", "RADIATE", "SRADIATE", "CRADIATE")
_ENDS: Final = {"FLUX": HeatLaw.FLUX, "FILM": HeatLaw.FILM, "RADIATE": HeatLaw.RADIATION}
"""Law of the heat load, by the end of the keyword."""
_LETTERS: Final = {HeatLaw.FLUX: "S", HeatLaw.FILM: "F", HeatLaw.RADIATION: "R"}
_WORDS: Final = {
    HeatLaw.FILM: ("sink temperature", "film coefficient"),
    HeatLaw.RADIATION: ("ambient temperature", "emissivity"),
}
_BODY, _FIRST_FACE = 1, 11
"""JLTYP of BFNU, and of the first face, S1NU or F1NU (User Subroutines Guide, DFLUX and FILM)."""


def read_heat_loads(block: Block, prescription: Prescription) -> list[HeatLoad]:
    """Read the entries of one of these keywords. Raises DeckError."""
    law, amplitude = _law(block.name), prescription.amplitude(block)
    film_amplitude = prescription.amplitude(block, "FILM AMPLITUDE") if law is HeatLaw.FILM else None
    loads = []
    for row in block.rows():
        row.at_most(3 if law is HeatLaw.FLUX else 4)
        for positions, kind in _places(block, row, prescription):
            loads.append(_load(row, positions, kind, (amplitude, film_amplitude)))
    return loads


def number_exchanges(loads: Sequence[HeatLoad]) -> list[HeatLoad]:
    """Assign numbers to the films and radiation loads of a step on the same face or node, so that each has its own
    sink.

    loads: those of one keyword. Fluxes need no numbers: they are summed.
    """
    size = max((int(load.places.max()) for load in loads if len(load.places)), default=-1) + 1
    counts: dict[HeatLoadType, IntArray] = {}
    numbered: list[HeatLoad] = []
    for load in loads:
        if not load.type.exchanges:
            numbered.append(load)
            continue
        # a node exchanges heat with any area
        count = counts.setdefault(replace(load.type, area=float(load.type.area > 0)), np.zeros(size, dtype=np.int64))
        numbers = count[load.places]
        for number in np.unique(numbers).tolist():
            kind = replace(load.type, number=number)
            numbered.append(replace(load, places=load.places[numbers == number], type=kind))
        count[load.places] += 1
    return numbered


def _law(keyword: str) -> HeatLaw:
    (law,) = (law for end, law in _ENDS.items() if keyword.endswith(end))
    return law


def _load(
    row: Row, positions: IntArray, kind: HeatLoadType, amplitudes: tuple[Amplitude | None, Amplitude | None]
) -> HeatLoad:
    amplitude, film_amplitude = amplitudes
    if not kind.exchanges:
        return HeatLoad(positions, kind, row.real(2, "flux", 0.0), amplitude, row.source)
    sink, factor = _WORDS[kind.law]
    temperature = row.real(2, sink, 0.0)
    coefficient = (row.not_negative if kind.law is HeatLaw.RADIATION else row.real)(3, factor, 0.0)
    return HeatLoad(positions, kind, temperature, amplitude, row.source, coefficient, film_amplitude)


def _places(block: Block, row: Row, prescription: Prescription) -> Iterator[tuple[IntArray, HeatLoadType]]:
    """Yield the elements or nodes of a line, group by group, with their load type. Raises DeckError."""
    name, law = block.name, _law(block.name)
    if name in ("CFILM", "CRADIATE"):
        nodes = prescription.flat.nodes(row.name(0, "node or node set"), row.source)
        area = row.positive(1, "area", 1.0)
        by_user = law is HeatLaw.FILM and block.options.flag("USER")
        yield nodes, HeatLoadType(name, law, area=area, by_user=by_user)
        return
    on_surface = name in ("DSFLUX", "SFILM", "SRADIATE")
    label, by_user = _label(row, law, on_surface=on_surface)
    if on_surface:
        surface = row.name(0, "surface")
        for elements, face, source in prescription.surfaces.faces(surface, row.source):
            for group, positions in prescription.surfaces.by_group(elements):
                _check_temperatures(row, label, group)
                local = face_nodes(group, face, source, "SURFACE")
                yield positions, HeatLoadType(name, law, local, 0, surface, by_user)
        return
    elements = prescription.flat.elements(row.name(0, "element or element set"), row.source)
    for group, positions in prescription.surfaces.by_group(elements):
        _check_temperatures(row, label, group)
        if label == "BF":
            yield positions, HeatLoadType(name, law, (), _BODY, "", by_user)
        else:
            local = face_nodes(group, f"S{label[1:]}", row.source, name)
            yield positions, HeatLoadType(name, law, local, _FIRST_FACE + int(label[1:]) - 1, "", by_user)


def _label(row: Row, law: HeatLaw, *, on_surface: bool) -> tuple[str, bool]:
    """Return the label of a load without NU, and whether it has NU. Raises DeckError."""
    text, letter = row.name(1, "load type"), _LETTERS[law]
    known = [letter if on_surface else f"{letter}n"]
    if law is HeatLaw.FLUX and not on_surface:
        known.insert(0, "BF")
    by_user = law is not HeatLaw.RADIATION and text.endswith("NU")
    label = text.removesuffix("NU") if by_user else text
    if re.sub("[0-9]", "n", label) not in known:
        more = "" if law is HeatLaw.RADIATION else f"; with NU, as in {letter}NU"
        raise row.error(f"load type {text} is not supported (supported: {', '.join(known)}{more})")
    return label, by_user


def _check_temperatures(row: Row, label: str, group: ElementGroup) -> None:
    kind = group.built_in
    if not isinstance(kind, SolidType) or 11 not in kind.dofs(0):
        raise row.error(
            f"load type {label} on elements of type {group.type}, which are not built-in elements with heat"
        )


_FILM: Final = (
    Option("FILM AMPLITUDE", Kind.NAME, "amplitude of the film coefficient, which is constant without it"),
    *ignored("REGION TYPE"),
)

KEYWORDS = (
    Keyword(
        "DFLUX",
        "Heat flux into elements with temperatures, in their initial shape.",
        Where.STEP,
        (*LOAD, *refused("BLADE", "REGION TYPE")),
        "element or set, BF or Sn (with NU, as in S2NU, by DFLUX), flux per volume or area",
    ),
    Keyword(
        "DSFLUX",
        "Heat flux into surfaces of elements with temperatures.",
        Where.STEP,
        LOAD,
        "surface, S (SNU: by DFLUX), flux per area",
    ),
    Keyword(
        "FILM",
        "Heat that faces of elements exchange with a sink.",
        Where.STEP,
        (*LOAD, *_FILM),
        "element or set, Fn (FnNU: by FILM), sink temperature, film coefficient",
    ),
    Keyword(
        "SFILM",
        "Heat that surfaces exchange with a sink.",
        Where.STEP,
        (*LOAD, *_FILM),
        "surface, F (FNU: by FILM), sink temperature, film coefficient",
    ),
    Keyword(
        "CFILM",
        "Heat that nodes exchange with a sink.",
        Where.STEP,
        (*LOAD, *_FILM, Option("USER", doc="by FILM")),
        "node or set, area (1), sink temperature, film coefficient",
    ),
    Keyword(
        "RADIATE",
        "Heat that faces of elements radiate into surroundings, and get from there.",
        Where.STEP,
        (*LOAD, *ignored("REGION TYPE")),
        "element or set, Rn, ambient temperature, emissivity",
    ),
    Keyword(
        "SRADIATE",
        "Heat that surfaces radiate into surroundings, and get from there.",
        Where.STEP,
        LOAD,
        "surface, R, ambient temperature, emissivity",
    ),
    Keyword(
        "CRADIATE",
        "Heat that nodes radiate into surroundings, and get from there.",
        Where.STEP,
        LOAD,
        "node or set, area (1), ambient temperature, emissivity",
    ),
)
