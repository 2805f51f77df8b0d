# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*CONTROLS: data lines as in the manual; values persist in later steps."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TypeVar

from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import Keyword, Option, Where, one_of, refused
from uel.model.controls import Controls, FieldControls, LineSearchControls, TimeControls

EPS_D, DEFAULT_EPS_D = "eps_d", 1e-8
"""Zero displacement increment over the characteristic element length, which is not used here."""

FIELD_LINES = (("r_n", "c_n", "q_0", "q_u", "r_p", "eps", "c_eps", "r_l"), ("c_f", "eps_l", EPS_D))
TIME_LINES = (
    # the last one is the number of contact augmentations, which are not used
    ("i_0", "i_r", "i_p", "i_c", "i_l", "i_g", "i_s", "i_a", "i_j", "i_t", "i_s_c", "i_j_c", ""),
    ("d_f", "d_c", "d_b", "d_a", "d_s", "d_h", "d_d", "w_g"),
    # the last two are for explicit creep integration
    ("d_g", "d_m", "d_m_dyn", "d_m_diff", "d_l", "d_e", "", ""),
    # growth before a time point of the output, where increments do not end here
    ("",),
)
# the others are for constraints that are exact here: of hybrid beams, soft contact at p = 0
CONSTRAINT_LINES = (("volume", "", "", "contact", "", "coupling", "coupling_rotation", "contact_force"),)
LINE_SEARCH_LINES = (("n_ls", "s_max", "s_min", "f_s", "eta_s"),)
DISCONTINUOUS = {"i_0": 8, "i_r": 10}
Group = TypeVar("Group", FieldControls, TimeControls, LineSearchControls, Controls)


@dataclass(frozen=True, slots=True)
class ControlState:
    """Controls in force; DISCONTINUOUS overrides I_0 and I_R."""

    controls: Controls = field(default_factory=Controls)
    discontinuous: bool = False

    @property
    def effective(self) -> Controls:
        """Controls of a step."""
        if not self.discontinuous:
            return self.controls
        return replace(self.controls, time=replace(self.controls.time, **DISCONTINUOUS))

    def read(self, block: Block) -> ControlState:
        """Return the state after one *CONTROLS. Raises DeckError."""
        options = block.options
        if options.flag("RESET"):
            if any(block.rows()):
                raise block.error("RESET takes no data lines")
            return ControlState()
        state = replace(self, discontinuous=True) if options.has("ANALYSIS") else self
        parameters = options.text("PARAMETERS")
        if not parameters:
            if any(block.rows()):
                raise block.error("data lines need PARAMETERS=")
            if not options.has("ANALYSIS"):
                raise block.error("needs ANALYSIS, PARAMETERS or RESET")
            return state
        return replace(state, controls=_apply(state.controls, parameters, block))


def _apply(controls: Controls, parameters: str, block: Block) -> Controls:
    if parameters == "CONSTRAINTS":
        return _update(controls, CONSTRAINT_LINES, block)
    if parameters == "TIME INCREMENTATION":
        return replace(controls, time=_update(controls.time, TIME_LINES, block))
    if parameters == "LINE SEARCH":
        return replace(controls, line_search=_update(controls.line_search, LINE_SEARCH_LINES, block))
    name = block.options.text("FIELD")
    if name != "GLOBAL":
        updated = _update(controls.fields.get(name, controls.default), FIELD_LINES, block)
        return replace(controls, fields={**controls.fields, name: updated})
    by_field = {key: _update(value, FIELD_LINES, block) for key, value in controls.fields.items()}
    return replace(controls, default=_update(controls.default, FIELD_LINES, block), fields=by_field)


def _update(group: Group, lines: tuple[tuple[str, ...], ...], block: Block) -> Group:
    """Return the group updated by the data lines; blank entries keep their value. Raises DeckError."""
    integers = {item.name for item in fields(group) if isinstance(getattr(group, item.name), int)}
    values: dict[str, float] = {}
    for number, row in enumerate(block.all_rows()):
        if number >= len(lines):
            if len(row):
                raise row.unsupported(f"data line {number + 1}")
            continue
        row.at_most(len(lines[number]))
        for index, name in enumerate(lines[number]):
            if not row.blank(index):
                value = _entry(row, index, name, name in integers)
                if name == EPS_D and value > DEFAULT_EPS_D:
                    message = f"{EPS_D.upper()} = {value:g}: only up to the default {DEFAULT_EPS_D:g} is supported"
                    raise row.error(f"{message}, as Abaqus does not document the element length that it is relative to")
                values |= {name: value} if name and name != EPS_D else {}
    return replace(group, **values)  # type: ignore[arg-type]  # int fields get what row.integer returns


def _entry(row: Row, index: int, name: str, integer: bool) -> float:
    quantity = name.upper() or f"entry {index + 1}"
    value = row.integer(index, quantity) if integer else row.real(index, quantity)
    if value < 0:
        raise row.error(f"{quantity} = {value:g} must not be negative")
    return value


KEYWORDS = (
    Keyword(
        "CONTROLS",
        "Solution controls; blank entries keep their value, later steps keep the controls. Of CONSTRAINTS the "
        "volumetric strain compatibility tolerance of hybrid solids, the tolerance of contact, the contact force error "
        "tolerance and those of distributing couplings count; what the others limit holds exactly here. Creep is "
        "integrated implicitly, increments do not end at output times, and no displacement increment counts as zero: "
        "what controls these has no effect.",
        Where.STEP,
        (
            one_of("ANALYSIS", "I_0 = 8, I_R = 10", ("DISCONTINUOUS",)),
            one_of(
                "PARAMETERS", "what the data lines set", ("FIELD", "TIME INCREMENTATION", "LINE SEARCH", "CONSTRAINTS")
            ),
            one_of(
                "FIELD",
                "field the values are for; all fields unless given",
                (
                    *("GLOBAL", "DISPLACEMENT", "ROTATION", "TEMPERATURE", "PORE FLUID PRESSURE"),
                    *("ELECTRICAL POTENTIAL", "CONCENTRATION", "HYDROSTATIC FLUID PRESSURE", "MATERIAL FLOW"),
                    *("PRESSURE LAGRANGE MULTIPLIER", "VOLUMETRIC LAGRANGE MULTIPLIER"),
                ),
                default="GLOBAL",
            ),
            Option("RESET", doc="all controls back to their defaults"),
            *refused("TYPE"),
        ),
        "the values of the manual's data lines",
    ),
)
