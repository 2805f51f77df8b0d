# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The block driver with small user elements: what they are given, and what becomes of what they return."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import uel
from uel.elements import FIELD_NAMES, Flags, Request
from uel.errors import KernelError

HERE = Path(__file__).parent
ROW = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
SPRING = ((0, 1), (1, 1))
# fields but that of the forces
OTHERS = [0] * (len(FIELD_NAMES) - 1)


@pytest.fixture
def springs(load, user_group, bound):
    """Two springs of stiffness 10 in a row, on three nodes."""
    group = user_group(np.array([[0, 1], [1, 2]]), SPRING, properties=(10.0,))
    return bound(group, ROW, load("spring.f"))


@pytest.fixture
def evaluate_springs(load, user_group, bound, call):
    """One pass over two springs of a file, with an option in JPROPS(1); gives the library too."""

    def evaluate_springs(file, option, *, lflag=1, assemble=True):
        library = load(file)
        group = user_group(np.array([[0, 1], [1, 2]]), SPRING, properties=(10.0,), integers=(option,), variables=2)
        block, matrix = bound(group, ROW, library)
        u = np.array([0.0, 0.1, 0.3])
        call_ = replace(call.asking(Request(lflag)), increment=4)
        residual = np.zeros(3)
        report = block.evaluate(call_, u, u, residual, matrix.data if assemble else None)
        return library, block, report

    return evaluate_springs


def test_residual_matrix_and_sums(springs, call):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    report = block.evaluate(call, u, u, residual, matrix.data)
    np.testing.assert_allclose(residual, [1, 1, -2], rtol=1e-15)
    np.testing.assert_array_equal(matrix.toarray(), [[10, -10, 0], [-10, 20, -10], [0, -10, 10]])
    assert report.flux[0] == pytest.approx(1 + 1 + 2 + 2)
    assert report.flux_count.tolist() == [4, *OTHERS]
    assert report.energy[1] == pytest.approx(0.5 * 10 * (0.1**2 + 0.2**2))
    assert report.pnewdt > 1e30


@pytest.mark.parametrize(("floor", "terms"), [(None, 4), (-1.0, 4), (0.0, 4), (1.5, 2), (3.0, 0)])
def test_small_forces_are_no_terms_of_the_average_flux(springs, call, floor, terms):
    """Element forces 1, 1, 2, 2; the sum holds them all."""
    block, matrix = springs
    floors = None if floor is None else np.array([floor, *OTHERS])
    u = np.array([0.0, 0.1, 0.3])
    report = block.evaluate(replace(call, flux_floor=floors), u, u, np.zeros(3), matrix.data)
    assert report.flux[0] == pytest.approx(6)
    assert report.flux_count.tolist() == [terms, *OTHERS]


def test_state_variables_start_from_the_committed_ones(springs, call):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    for _ in range(3):
        block.evaluate(call, u, u, residual, matrix.data)
    assert block.state(0).svars.ravel().tolist() == [0, 0]
    block.commit()
    np.testing.assert_allclose(block.state(0).svars.ravel(), [0.1, 0.2], rtol=1e-15)


@pytest.mark.parametrize("lflag", [2, 3, 4, 5, 6, 100])
def test_only_calls_at_ends_of_increments_are_kept(springs, call, lflag):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    block.evaluate(call.asking(Request(lflag)), u, u, residual, matrix.data)
    block.commit()
    # the forces at the start of a dynamic step are left in SVARS by the call for the initial acceleration
    assert block.state(0).svars.any() == (lflag == 6)
    assert residual.any() == (lflag in (5, 6, 100))


def test_without_a_matrix_nothing_is_assembled(springs, call):
    block, matrix = springs
    residual, u = np.zeros(3), np.array([0.0, 0.1, 0.3])
    block.evaluate(call, u, u, residual, None)
    np.testing.assert_allclose(residual, [1, 1, -2], rtol=1e-15)
    assert not matrix.data.any()


@pytest.mark.parametrize("coordinates, dofs, mcrd", [(1, (1, 2), 2), (3, (1, 2), 3), (1, (1, 3), 3), (2, (1, 11), 2)])
def test_arguments(load, user_group, bound, call, coordinates, dofs, mcrd):
    """MCRD is the larger of COORDINATES= and the largest active dof up to 3 (Abaqus manual, UEL)."""
    unknowns = tuple((node, dof) for node in (0, 1) for dof in dofs)
    group = user_group(
        np.array([[1, 0]]), unknowns, properties=(3.0, 4.0), integers=(5, 6, 7), coordinates=coordinates, variables=60
    )
    points = np.array([[1.0, 2, 3], [4, 5, 6]])
    block, matrix = bound(group, points, load("arguments.f"))
    size = matrix.shape[0]
    u, du = 1.0 + np.arange(size), 0.1 + np.arange(size)
    given = replace(
        call,
        flags=Flags(2, nlgeom=True, extrapolated=True),
        step=3,
        increment=4,
        step_time=0.5,
        total_time=2.5,
        time_increment=0.1,
    )
    block.evaluate(replace(given, period=0.8), u, du, np.zeros(size), matrix.data)
    block.commit()
    svars = block.state(0).svars[0]
    assert svars[:7].tolist() == [4, 1, 60, 2, mcrd, 2, 1]
    assert svars[7:13].tolist() == [0.5, 2.5, 0.1, 3, 4, 101]
    assert svars[13:16].tolist() == [0, 1, 4]
    assert svars[16] > 1e30
    assert svars[17:19].tolist() == [3, 0.8]
    assert svars[19:24].tolist() == [2, 1, 1, 0, 1]
    assert svars[24:27].tolist() == [4, 7, 0]
    np.testing.assert_array_equal(svars[30 : 30 + 2 * mcrd], points[[1, 0], :mcrd].ravel())
    equations = np.array([max(dofs) * node + dof - 1 for node in (1, 0) for dof in dofs])
    np.testing.assert_array_equal(svars[30 + 2 * mcrd :][:8], [*u[equations], *du[equations]])


@pytest.mark.parametrize("unsymmetric", [True, False])
def test_matrix_is_symmetrised_unless_unsymmetric(load, user_group, bound, call, unsymmetric):
    group = user_group(
        np.array([[0, 1]]), SPRING, properties=(1.0,), integers=(1,), variables=60, unsymmetric=unsymmetric
    )
    block, matrix = bound(group, ROW[:2], load("arguments.f"))
    block.evaluate(call, np.zeros(2), np.zeros(2), np.zeros(2), matrix.data)
    np.testing.assert_array_equal(matrix.toarray(), [[11, 12], [21, 22]] if unsymmetric else [[11, 16.5], [16.5, 22]])


@pytest.mark.parametrize(
    "option, message",
    [
        (1, r"element 102 \(type U1\): writes outside SVARS: entry 5 of 2 \(VARIABLES=\)"),
        (2, r"element 102 \(type U1\): writes outside AMATRX: entry 5 of 4 \(2 x 2\)"),
        (3, r"element 102 \(type U1\): writes outside RHS: entry 0 of 2"),
        (4, r"element 102 \(type U1\): writes outside ENERGY: entry 9 of 8"),
        pytest.param(5, r"element 102 \(type U1\): RHS\(2\) is NaN or infinite", marks=pytest.mark.nan),
        (6, r"element 102 \(type U1\): AMATRX\(2,1\) is NaN or infinite"),
        (7, r"element 102 \(type U1\): stopped the analysis \(XIT\) without a message"),
        (
            8,
            r"102 \(type U1\): stopped the analysis: element 102 in increment 4: 0.125000 is too much for MODE_I",
        ),
        (10, r"element 102 \(type U1\): stopped the analysis: STOP 'no more'"),
        (11, r"element 102 \(type U1\): stopped the analysis: STOP 7"),
        (13, r"element 102 \(type U1\): stopped the analysis: it calls GETVRN, which the harness does not supply"),
        (15, r"element 102 \(type U1\): stopped the analysis \(XIT\) without a message"),
    ],
)
def test_faults_are_reported_by_element(evaluate_springs, option, message):
    with pytest.raises(KernelError, match=message):
        evaluate_springs("faults.f", option)


@pytest.mark.nan
@pytest.mark.parametrize("option, entry", [(1, r"RHS\(2\)"), (2, r"AMATRX\(1,2\)"), (3, r"RHS\(1\)")])
def test_entries_left_unset_are_reported(evaluate_springs, option, entry):
    with pytest.raises(KernelError, match=rf"element 101 \(type U1\): {entry} was not filled, or was added to"):
        evaluate_springs("unset.f", option)


@pytest.mark.nan
def test_what_is_not_used_may_stay_unset(evaluate_springs):
    evaluate_springs("unset.f", 2, assemble=False)
    evaluate_springs("unset.f", 1, lflag=2)
    with pytest.raises(KernelError, match=r"AMATRX\(1,2\) was not filled"):
        evaluate_springs("unset.f", 2, lflag=2)


def test_damage_beyond_one_pass_is_not_repeated(evaluate_springs):
    """The guards are whole again after a fault."""
    with pytest.raises(KernelError):
        evaluate_springs("faults.f", 1)
    evaluate_springs("faults.f", 0)


def test_changing_the_arguments_harms_nobody(evaluate_springs):
    _, block, _ = evaluate_springs("faults.f", 14)
    block.commit()
    assert block.state(0).svars[:, 0].tolist() == [4, 4]


def test_smallest_pnewdt_of_normal_calls(evaluate_springs):
    assert evaluate_springs("faults.f", 12)[2].pnewdt == 0.25
    assert evaluate_springs("faults.f", 12, lflag=5)[2].pnewdt > 1e30


def test_messages_are_kept_with_their_place(evaluate_springs):
    library, _, _ = evaluate_springs("faults.f", 9)
    found = [(m.file, m.kind, m.text, m.element, m.step, m.increment) for m in library.messages()]
    assert found == [
        (".msg", "note", "a note", 102, 1, 4),
        (".msg", "warning", "a warning, 100%", 102, 1, 4),
        (".msg", "error", "an error of 0.125000", 102, 1, 4),
    ]
    assert library.messages() == []


OUTSIDE = """\
*USER ELEMENT, TYPE=U1, NODES=2, I PROPERTIES=1, VARIABLES=2
1
*NODE
1, 0.
2, 1.
3, 2.
*ELEMENT, TYPE=U1, ELSET=ALL
101, 1, 2
102, 2, 3
*UEL PROPERTY, ELSET=ALL
{option}
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
3, 1, 1, 1.
*END STEP
"""


def test_a_job_goes_on_after_a_write_outside_an_array(tmp_path):
    """The write is reported once, with its element; the results are those of the element that stays inside."""
    results = {}
    for option in (0, 1):
        deck = tmp_path / f"outside{option}.inp"
        deck.write_text(OUTSIDE.format(option=option))
        results[option] = uel.run(deck, HERE / "faults.f", output_dir=tmp_path)
    np.testing.assert_array_equal(results[1].field("U"), results[0].field("U"))
    assert len(results[1].status) == 4
    text = " ".join(results[1].file(".msg").read_text().split())
    assert text.count("writes outside SVARS: entry 5 of 2 (VARIABLES=)") == 1
    assert "***WARNING: element 102 (type U1): writes outside SVARS" in text
    assert "writes outside" not in results[0].file(".msg").read_text()


@pytest.mark.nan
def test_a_job_goes_on_where_entries_are_not_set(tmp_path):
    """RHS and AMATRX are zero on entry then, as mostly in Abaqus; it is reported once, the results are the same."""
    results = {}
    for option in (0, 1):
        deck = tmp_path / f"adds{option}.inp"
        deck.write_text(OUTSIDE.format(option=option))
        results[option] = uel.run(deck, HERE / "adds.f", output_dir=tmp_path)
    np.testing.assert_array_equal(results[1].field("U"), results[0].field("U"))
    np.testing.assert_array_equal(results[1].history["ALLSE"], results[0].history["ALLSE"])
    text = " ".join(results[1].file(".msg").read_text().split())
    assert text.count("was not filled") == 1
    warning = "***WARNING: element 101 (type U1): RHS(1) was not filled, or was added to without being set first"
    assert warning in text
    assert "; the run goes on with zeros there before each call" in text
    assert "was not filled" not in results[0].file(".msg").read_text()


def test_local_variables_without_a_value_are_zero_in_a_job(run_deck):
    """A chain of two springs of stiffness 1: the middle goes half as far as the end."""
    result = run_deck(OUTSIDE.format(option=0), HERE / "forgets.f")
    np.testing.assert_allclose(result.field("U")[:, 0], [0.0, 0.5, 1.0], rtol=1e-14)
