# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures of the beams of `harness/uel/paper/space_beams.py`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uel.delamination import front_measures
from uel.delamination.theory import dcb_curve, enf_compliance, enf_load, mmb_mode_mix
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper.space_beams import ARMS, CRACK, ETA, LAW, LENGTH, LEVER, WIDTH, SpaceBeam


def beam_release(result: Result) -> float:
    """Return the energy release rate by Rice's integral (N/mm), mean over the second half of the fronts' way."""
    return float(_releases(result).sum())


def beam_mode_mix(result: Result) -> float:
    """Return (G_II + G_III)/G by Rice's integral over the second half of the way."""
    releases = _releases(result)
    return float(releases[1:].sum() / releases.sum())


def beam_dissipated_release(result: Result) -> float:
    """Return the energy dissipated per area (N/mm) over the second half of the way."""
    return front_measures.dissipated_release(result, CRACK, WIDTH)


def beam_compliance_release(result: Result) -> float:
    """Return the energy release rate by the compliance (N/mm) over the second half of the way."""
    return front_measures.compliance_release(result, CRACK, WIDTH)


def toughness(mix: float) -> float:
    """Return the fracture energy of the law (N/mm) at a mode mix, by Benzeggagh and Kenane."""
    return float(LAW.toughness_1 + (LAW.toughness_2 - LAW.toughness_1) * mix**ETA)


def beam_toughness_ratio(result: Result) -> float:
    """Return Rice's integral over the fracture energy of the law at its mode mix."""
    return beam_release(result) / toughness(beam_mode_mix(result))


def beam_dissipation_ratio(result: Result) -> float:
    """Return the energy dissipated per area over Rice's integral."""
    return beam_dissipated_release(result) / beam_release(result)


def beam_front_depth(result: Result) -> float:
    """Return the largest distance along x of two points of one front (mm)."""
    return max(float(np.ptp(front.coordinates[:, 0])) for front in front_measures.grown_fronts(result, CRACK))


def beam_dcb_deviation(result: Result) -> float:
    """Return the relative deviation of the load from corrected beam theory at the end: [0/0]."""
    opening = front_measures.displacement(result)[-1:]
    return float(front_measures.load(result)[-1] / dcb_curve(ARMS, CRACK, LAW.toughness_1, 0.5 * opening)[0] - 1.0)


def beam_enf_deviation(result: Result) -> float:
    """Return the largest relative deviation of the load from corrected beam theory while the crack grows: [0/0].

    It grows from the largest load on; before that the process zone forms, in which half of the energy is dissipated.
    """
    half = 0.5 * LENGTH
    cracks = np.linspace(CRACK, half, 300)
    loads = np.array([enf_load(ARMS, crack, LAW.toughness_2) for crack in cracks])
    moved = loads * np.array([enf_compliance(ARMS, crack, half) for crack in cracks])
    deflection, load = front_measures.displacement(result), front_measures.load(result)
    later = (np.arange(len(load)) > load.argmax()) & (deflection <= moved[-1])
    return float(np.abs(load[later] / np.interp(deflection[later], moved, loads) - 1.0).max())


def beam_mix_deviation(result: Result) -> float:
    """Return the deviation of the mode mix from corrected beam theory, at the mean front's last position."""
    crack = float(front_measures.mean_fronts(result, CRACK)[1][-1])
    return beam_mode_mix(result) - mmb_mode_mix(ARMS, crack, 0.5 * LENGTH, LEVER)


def against_theory(case: SpaceBeam, result: Result) -> dict[str, tuple[float, float]]:
    """Compare theory with a run: both values, by quantity."""
    mix, release = beam_mode_mix(result), beam_release(result)
    values = {
        "G by Rice's integral, for the law's at its mode mix (N/mm)": (toughness(mix), release),
        "G by dissipation per area, for Rice's integral (N/mm)": (release, beam_dissipated_release(result)),
        "G by the compliance, for Rice's integral (N/mm)": (release, beam_compliance_release(result)),
        "depth of the front (mm)": (0.0, round(beam_front_depth(result), 6)),
    }
    if case.problem == "mmb":
        values["G_II/G"] = (mix - beam_mix_deviation(result), mix)
    if (case.problem, case.plies) == ("dcb", "0_0"):
        load = float(front_measures.load(result)[-1])
        values["load at the end (N)"] = (load / (1.0 + beam_dcb_deviation(result)), load)
    if case.problem == "enf":
        values["largest deviation from the load of beam theory in growth"] = (0.0, beam_enf_deviation(result))
    return values


def _releases(result: Result) -> FloatArray:
    """Return G_I, G_II, G_III (3,), mean over the second half of the way."""
    found = front_measures.grown_fronts(result, CRACK)
    places = np.array([front.coordinates[:, 0].mean() for front in found])
    later = [front for front, place in zip(found, places, strict=True) if place > 0.5 * (places[0] + places[-1])]
    return np.asarray(np.mean([front.releases.mean(axis=0) for front in later], axis=0))


MEASURES: dict[str, Callable[[Result], float]] = {
    function.__name__: function
    for function in (
        *(beam_release, beam_mode_mix, beam_dissipated_release, beam_compliance_release),
        *(beam_toughness_ratio, beam_dissipation_ratio, beam_front_depth),
        *(beam_dcb_deviation, beam_enf_deviation, beam_mix_deviation),
    )
}
