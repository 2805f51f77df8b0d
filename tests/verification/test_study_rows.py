# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the parameter study measures of a run, and the references that it is compared with."""

import re
from pathlib import Path

import numpy as np
import pytest

from uel.delamination.oscillation import total_variation
from uel.output.files.sta_file import StatusRow
from uel.paper.study.cases import StudyCase
from uel.paper.study.reference import restricted
from uel.paper.study.refinement import Bonded, bonded, facet_means, on_facets, turned
from uel.paper.study.rows import at_tenths, bonded_part, damage_variation, measure, oscillations, same_moments

CASE = StudyCase("frmm", "0/0", "1e6", "paper", "structured", "newton")


class Run:
    """What a result gives, made up: 4 increments, the third after a cutback and with the load falling by half."""

    def __init__(self) -> None:
        self.history = {
            "U2[LOAD_TOP]": np.array([1.5, 3.0, 4.5, 6.0]),
            "RF2[LOAD_TOP]": np.array([10.0, 20.0, 10.0, 9.7]),
            "ALLWK": np.array([1.0, 2.0, 3.0, 10.0]),
            "ALLSE": np.array([1.0, 2.0, 2.0, 2.0]),
            "ALLPD": np.array([0.0, 0.0, 1.0, 5.0]),
            "ALLVD": np.array([0.0, 0.0, 0.0, 2.0]),
        }
        self.status = [
            StatusRow(1, 1, 1, False, 2, 0.25, 0.25, 0.25),
            StatusRow(1, 2, 1, False, 3, 0.5, 0.5, 0.25),
            StatusRow(1, 3, 1, True, 5, 0.5, 0.5, 0.25),
            StatusRow(1, 3, 2, False, 7, 0.75, 0.75, 0.25),
            StatusRow(1, 4, 1, False, 4, 1.0, 1.0, 0.25),
        ]

    def interface(self) -> dict[str, np.ndarray]:
        """The last profile."""
        return self.interfaces()[-1]

    def interfaces(self) -> list[dict[str, np.ndarray]]:
        """Smooth at first, then with one point of tension less and a damage that comes back."""
        smooth = {
            "TN": [0.0, 0.0, 30.0, -9.0, 0.0],
            "TT": [0.0, 0.0, -50.0, 0.0, 0.0],
            "DAMAGE": [1.0, 0.5, 0.2, 0.0, 0.0],
            "DISSI": [0.13, 0.1, 0.0, 0.0, 0.0],
            "DISSII": [0.5511, 0.0, 0.0, 0.0, 0.0],
        }
        later = smooth | {"TN": [0.0, 0.0, 28.0, -9.0, 0.0], "DAMAGE": [1.0, 0.5, 0.2, 0.4, 0.0]}
        return [
            {name: np.array(column) for name, column in (profile | {"time": [time] * 5}).items()}
            for time, profile in ((0.5, smooth), (1.0, later))
        ]


def test_measures_of_a_run() -> None:
    real = Run().interfaces()
    row = measure(CASE, Run(), "", 1.0, real)  # type: ignore[arg-type]
    assert row.finished
    assert (row.reached, row.increments, row.iterations, row.cutbacks) == (1.0, 4, 21, 1)
    # the load falls by 10 of 20 N in the third increment: a snap, whose 12 iterations are counted apart
    assert (row.snaps, row.snap_iterations, row.iterations_per_increment) == (1, 12, 3.0)
    assert (row.peak_load, row.peak_displacement, row.final_load) == (20.0, 3.0, 9.7)
    assert row.balance_error == pytest.approx((8.0 - 7.0) / 8.0)
    # one failed point, which has spent 0.13 of 0.26 and 0.5511 of 1.002 N/mm
    assert row.dissipation_error == pytest.approx(0.05)
    assert (row.peak_n, row.peak_t) == (30.0, 50.0)
    assert (row.index_n, row.index_t, row.error_n, row.error_t, row.raw_n, row.raw_t) == (1.0,) * 6
    # from the point with damage 0.5 on: up by 30, down by 39, up by 9; and 50 down and up
    assert (row.variation_n, row.real_n, row.difference_n) == (78.0, 78.0, 0.0)
    assert (row.variation_t, row.real_t, row.difference_t) == (100.0, 100.0, 0.0)
    # down by 0.8, up by 0.2, down by 0.4
    assert row.damage_variation == pytest.approx(1.4)


def test_a_run_that_stopped() -> None:
    run = Run()
    run.history = {name: column[:2] for name, column in run.history.items()}
    row = measure(CASE, run, "TOO MANY ATTEMPTS", 1.0, [])  # type: ignore[arg-type]
    assert not row.finished
    assert row.reached == 0.5
    assert row.balance_error == 0.0


def test_oscillations_against_the_reference() -> None:
    # the reference holds one point more; a step of 3 MPa that it does not have, up and down
    first, second = (
        {"time": np.full(4, time), "DAMAGE": np.array([1.0, 0.9, 0.0, 0.0]), "TN": np.array(values)}
        for time, values in ((0.1, [0.0, 0.0, 30.0, 0.0]), (0.2, [0.0, 3.0, 30.0, 0.0]))
    )
    other = {"time": np.full(4, 0.2), "DAMAGE": np.array([0.9, 0.9, 0.0, 0.0]), "TN": np.array([0.0, 0.0, 30.0, 0.0])}
    found = oscillations("TN", "n", [first, second], [(first, first), (second, other)])
    # TV 57 against 60; the strength is 30 MPa
    assert found["index_n"] == 1.0
    assert found["error_n"] == pytest.approx(1.0 + 3.0 / 60.0)
    assert (found["variation_n"], found["real_n"], found["difference_n"]) == (60.0, 60.0, 0.0)
    alone = oscillations("TN", "n", [first], [])
    assert np.isnan(alone["index_n"])
    assert alone["raw_n"] == 1.0


def test_moments_of_the_reference_are_less_than_half_an_increment_away() -> None:
    profiles, real = ([{"time": np.array([t])} for t in times] for times in ((0.1, 0.196, 0.294), (0.1, 0.2, 0.3)))
    assert [(p["time"][0], r["time"][0]) for p, r in same_moments(profiles, real)] == [(0.1, 0.1), (0.196, 0.2)]


def test_restriction_takes_the_mean_over_the_share_of_a_point() -> None:
    # a facet with two points; cut in two, four points, of which two lie on each half
    fine = {"X": np.array([0.1, 0.4, 0.6, 0.9]), "TN": np.array([1.0, 3.0, 10.0, 20.0])}
    coarse = restricted(fine, 2)
    assert coarse["X"].tolist() == [0.25, 0.75]
    assert coarse["TN"].tolist() == [2.0, 15.0]
    assert restricted(fine, 1)["TN"].tolist() == fine["TN"].tolist()


def test_means_over_facets() -> None:
    assert facet_means(np.array([1.0, 3.0, 4.0, 8.0])).tolist() == [2.0, 6.0]
    assert facet_means(np.array([9.0, 1.0, 3.0, 4.0, 8.0])).tolist() == [2.0, 6.0]


def test_stress_on_facets() -> None:
    # turned by 45 degrees: uniaxial tension has half of itself as tension and as shear; pure shear becomes tension
    angle, zero, one = np.full(1, np.pi / 4), np.zeros(1), np.ones(1)
    assert np.concatenate(on_facets((one, zero, zero), angle)) == pytest.approx([0.5, -0.5])
    assert np.concatenate(on_facets((zero, one, zero), angle)) == pytest.approx([0.5, 0.5])
    assert np.concatenate(on_facets((zero, zero, one), angle)) == pytest.approx([-1.0, 0.0])
    # small angles: the shear of bending stress
    assert on_facets((np.array([500.0]), zero, zero), np.array([0.06]))[1] == pytest.approx(-30.0, rel=0.01)


def test_profiles_are_those_of_the_tenths() -> None:
    profiles = [{"time": np.array([time])} for time in (0.05, 0.1, 0.1001, 0.17, 0.2, 0.95, 1.0)]
    assert [float(profile["time"][0]) for profile in at_tenths(profiles)] == [0.1, 0.2, 1.0]


def test_bonded_part_starts_where_the_first_point_holds() -> None:
    profile = {"DAMAGE": np.array([1.0, 1.0, 0.9, 1.0, 0.0]), "TN": np.arange(5.0)}
    assert bonded_part(profile)["TN"].tolist() == [2.0, 3.0, 4.0]


def test_damage_variation() -> None:
    assert damage_variation(np.array([1.0, 1.0, 0.6, 0.0])) == 1.0
    assert damage_variation(np.array([0.5, 0.2, 0.0])) == 1.0
    assert damage_variation(np.array([1.0, 0.2, 0.7, 0.0])) == 2.0
    # damaged everywhere: it does not fall to 0
    assert damage_variation(np.array([1.0, 0.9, 0.9])) == pytest.approx(0.1)
    assert damage_variation(np.zeros(3)) == 1.0


def test_stress_of_the_homogeneous_body_acts_on_bonded_facets(tmp_path: Path) -> None:
    real = turned("frmm", tmp_path)
    found = [
        bonded(Bonded("frmm", "0/0", element, "perturbed", factor), tmp_path)
        for element, factor in (("consistent", 2), ("consistent", 1), ("standard", 1))
    ]
    page = (Path(__file__).parents[2] / "fortran" / "stabilised.md").read_text(encoding="utf-8")
    for name, traction in (("TN", "normal"), ("TT", "tangential")):
        # the page has h, h/2 and h/4 of either element; linear problems, so that only its digits limit the agreement
        row = next(line for line in page.splitlines() if line.startswith(f"| FRMM [0/0] | {traction} |"))
        standard_h, _, _, consistent_h, consistent_half, _, turned_h = (
            float(text) for text in re.findall(r"\d+(?:\.\d+)?", row)[2:]
        )
        said = [consistent_half, consistent_h, standard_h, turned_h]
        assert [total_variation(profile[name]) for profile in (*found, real)] == pytest.approx(said, rel=0.01, abs=0.5)
        errors = [total_variation(profile[name] - real[name]) for profile in found]
        # refined, the consistent element comes closer; the standard one is far off
        assert errors == sorted(errors)
        assert errors[0] < 0.3 * total_variation(real[name])
        assert errors[2] > max(5.0 * errors[1], total_variation(real[name]))
        # what the consistent one adds on the coarsest mesh lies between the two points of a facet
        real_facets, consistent, standard = (
            total_variation(facet_means(profile[name])) for profile in (real, found[1], found[2])
        )
        assert consistent == pytest.approx(real_facets, rel=0.06)
        # and the standard one misses even the mean over a facet
        assert standard < 0.6 * real_facets
