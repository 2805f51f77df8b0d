# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Named quantities of a run, which the reference.toml files of abaqus_inputs give values for."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from uel.delamination import front_measures
from uel.delamination.beams import branch_deviation
from uel.delamination.materials import TABLE_2
from uel.delamination.oscillation import total_variation
from uel.delamination.specimens import ARMS, CRACK, WIDTH
from uel.delamination.theory import dcb_crack, dcb_curve
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.paper import growth_measures, literature_measures, space_beam_measures


def load(result: Result) -> FloatArray:
    """Load of a specimen (N), positive the way it is loaded, by increment."""
    history = result.history
    if "RF2[LOAD_TOP]" in history:
        return history["RF2[LOAD_TOP]"]
    if "RF2[MIDSPAN]" in history:
        return -history["RF2[MIDSPAN]"]
    return front_measures.load(result)


def displacement(result: Result) -> FloatArray:
    """Return the displacement (mm) of the load, by increment; in space that on which both ends' loads work."""
    history = result.history
    if "U2[LOAD_TOP]" in history:
        return history["U2[LOAD_TOP]"]
    return -history["U2[MIDSPAN]"] if "U2[MIDSPAN]" in history else front_measures.displacement(result)


def dissipated(result: Result) -> FloatArray:
    """Return the energy that damage and its viscosity dissipate (N mm), by increment, by Abaqus' names."""
    names = ("ALLPD", "ALLVD") if "ALLPD" in result.history else ("ALLDMD", "ALLCD")
    return result.history[names[0]] + result.history[names[1]]


def crack_growth(result: Result) -> FloatArray:
    """Return the growth of the crack (mm) by the compliance method, by increment.

    The interface unloads to the origin, so that 2 Delta/P is the compliance of the damaged specimen at every moment;
    beam theory gives the crack length that belongs to it. The first increment, still elastic, is the start: errors of
    beam theory in the initial length cancel. Loads and displacements alone enter, not the interface's state.
    """
    moved = displacement(result) > 0.0
    lengths = np.array([dcb_crack(ARMS, value) for value in displacement(result)[moved] / load(result)[moved]])
    return np.concatenate([np.zeros(np.count_nonzero(~moved)), lengths - lengths[0]])


def beam_theory(result: Result) -> FloatArray:
    """Load by corrected beam theory at the displacements of the run (N), by increment."""
    return dcb_curve(ARMS, CRACK, TABLE_2.toughness_1, displacement(result))


def peak_load(result: Result) -> float:
    """Return the largest load (N)."""
    return float(load(result).max())


def peak_opening(result: Result) -> float:
    """Return the distance of the loaded corners at the largest load (mm)."""
    return float(2.0 * displacement(result)[load(result).argmax()])


def final_load(result: Result) -> float:
    """Load at the end (N)."""
    return float(load(result)[-1])


def final_displacement(result: Result) -> float:
    """Return the displacement of the load at the end (mm)."""
    return float(displacement(result)[-1])


def theory_deviation(result: Result) -> float:
    """Return the largest relative distance from beam theory between the peak and the end."""
    after = slice(int(load(result).argmax()), None)
    return float(np.max(np.abs(load(result)[after] / beam_theory(result)[after] - 1.0)))


def dissipation_ratio(result: Result) -> float:
    """Return the dissipated energy over G_Ic x width x crack growth, from the peak to the end.

    Up to the peak the process zone forms: the compliance grows, at an energy release rate below G_Ic.
    """
    peak = int(load(result).argmax())
    energy, growth = dissipated(result), crack_growth(result)
    return float((energy[-1] - energy[peak]) / (TABLE_2.toughness_1 * WIDTH * (growth[-1] - growth[peak])))


def energy_error(result: Result) -> float:
    """Return the external work minus stored and dissipated energy, over the external work, at the end."""
    work, stored = result.history["ALLWK"][-1], result.history["ALLSE"][-1]
    return float((work - stored - dissipated(result)[-1]) / work)


def traction_mean(result: Result) -> float:
    """Return the mean of the normal traction along the interface at the end (MPa)."""
    return float(np.mean(result.interface()["TN"]))


def traction_deviation(result: Result) -> float:
    """Return the standard deviation of the normal traction along the interface at the end (MPa)."""
    return float(np.std(result.interface()["TN"]))


def traction_lowest(result: Result) -> float:
    """Return the lowest normal traction along the interface at the end (MPa)."""
    return float(np.min(result.interface()["TN"]))


def traction_highest(result: Result) -> float:
    """Return the highest normal traction along the interface at the end (MPa)."""
    return float(np.max(result.interface()["TN"]))


def traction_variation(result: Result) -> float:
    """Return the total variation of the normal traction along the interface at the end (MPa)."""
    return total_variation(result.interface()["TN"])


def shear_variation(result: Result) -> float:
    """Return the total variation of the shear traction along the interface at the end (MPa)."""
    return total_variation(result.interface()["TT"])


def damage_variation(result: Result) -> float:
    """Return the total variation of the damage along the interface at the end; 1 where it falls steadily."""
    return total_variation(result.interface()["DAMAGE"])


def enf_deviation(result: Result) -> float:
    """Return the largest relative distance from corrected beam theory of an end-notched flexure in growth."""
    history = result.history
    return float(np.max(np.abs(branch_deviation("enf", -history["U2[MIDSPAN]"], -history["RF2[MIDSPAN]"]))))


def frmm_deviation(result: Result) -> float:
    """Return the largest relative distance from corrected beam theory of a fixed-ratio specimen in growth."""
    return float(np.max(np.abs(branch_deviation("frmm", displacement(result), load(result)))))


def rice_ratio(profile: Mapping[str, FloatArray]) -> float:
    """Return G_I/G_II of a profile along the interface, both by Rice's integral around the process zone.

    That is minus the integral of traction times the slope of the separation. What single points have dissipated
    scatters by a quarter, as the crack runs in small jumps.
    """
    rates = []
    for traction, separation in (("TN", np.maximum(profile["SEPN"], 0.0)), ("TT", profile["SEPT"])):
        mean = 0.5 * (profile[traction][1:] + profile[traction][:-1])
        rates.append(-float(np.sum(mean * np.diff(separation))))
    return rates[0] / rates[1]


def frmm_mode_ratio(result: Result) -> float:
    """Return the `rice_ratio` at three fifths of the step, a moment of steady growth in the fixed-ratio specimens."""
    profiles = result.interfaces()
    times = np.array([profile["time"][0] for profile in profiles])
    return rice_ratio(profiles[int(np.abs(times - 0.6).argmin())])


def increments(result: Result) -> int:
    """Count the increments done."""
    return sum(not row.cutback for row in result.status)


def cutbacks(result: Result) -> int:
    """Count the abandoned attempts."""
    return sum(row.cutback for row in result.status)


def iterations(result: Result) -> int:
    """Count the iterations, including those of abandoned attempts."""
    return sum(row.total_iterations for row in result.status)


def curve_distance(result: Result, other: Result) -> float:
    """Return the largest distance of two load curves from the peak on, over the peak load; other: interpolated."""
    after = slice(int(load(result).argmax()), None)
    between = np.interp(displacement(result)[after], displacement(other), load(other))
    return float(np.max(np.abs(load(result)[after] - between)) / peak_load(other))


def whole_curve_distance(result: Result, other: Result) -> float:
    """Return the largest distance of two load curves, all of them, over the peak load; the other is interpolated."""
    between = np.interp(displacement(result), displacement(other), load(other))
    return float(np.max(np.abs(load(result) - between)) / peak_load(other))


QUANTITIES: dict[str, Callable[[Result], float]] = {
    function.__name__: function
    for function in (
        *(peak_load, peak_opening, final_load, final_displacement, theory_deviation, dissipation_ratio, energy_error),
        *(enf_deviation, frmm_deviation, frmm_mode_ratio, cutbacks),
        *(traction_mean, traction_deviation, traction_lowest, traction_highest, traction_variation, damage_variation),
    )
}
QUANTITIES |= literature_measures.MEASURES | space_beam_measures.MEASURES | growth_measures.MEASURES
COMPARISONS: dict[str, Callable[[Result, Result], float]] = {
    function.__name__: function for function in (curve_distance, whole_curve_distance)
}
