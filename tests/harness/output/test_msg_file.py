# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lines of the message file, compared with lines that stand in public .msg files of Abaqus 6.14 to 2023."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.model.controls import Controls, FieldControls, LineSearchControls, TimeControls
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.procedures import Static
from uel.model.records import (
    AttemptAbandoned,
    AttemptStarted,
    Convergence,
    FieldCheck,
    IncrementDone,
    IterationDone,
    Largest,
    Record,
    SearchHelped,
    StepStarted,
)
from uel.output.files.msg_file import MessageFile

Records = Callable[..., Iterator[Record]]


@pytest.fixture
def labelled(model: Model) -> Model:
    """The model with the node numbers of a public file."""
    labels = np.array([1, 2, 3, 207, 279, 1051, 559, 2083])
    return replace(model, mesh=Mesh(labels, model.mesh.coordinates, model.mesh.instances))


def written(model: Model, path: Path, *calls: tuple[str, object]) -> list[str]:
    file = MessageFile(path / "job.msg", model)
    for name, record in calls:
        getattr(file, name)(record)
    return [line.rstrip() for line in (path / "job.msg").read_text().splitlines()]


def iteration(*checks: FieldCheck, number: int = 1) -> tuple[str, object]:
    return "iteration", IterationDone(number, checks)


NONE = Largest(0.0, -1, 0)


def test_an_iteration_that_is_not_in_equilibrium(labelled: Model, tmp_path: Path) -> None:
    check = FieldCheck(
        "force",
        64.6,
        64.6,
        Largest(-8.61, 3, 1),
        Largest(0.692, 0, 2),
        Largest(-5.576e-3, 5, 2),
        Convergence.NOT_ACHIEVED,
    )
    assert written(labelled, tmp_path, iteration(check)) == [
        "",
        "               CONVERGENCE CHECKS FOR EQUILIBRIUM ITERATION     1",
        "",
        "",
        " AVERAGE FORCE                       64.6       TIME AVG. FORCE        64.6",
        " LARGEST RESIDUAL FORCE             -8.61       AT NODE        207   DOF  1",
        " LARGEST INCREMENT OF DISP.         0.692       AT NODE          1   DOF  2",
        " LARGEST CORRECTION TO DISP.       -5.576E-03   AT NODE       1051   DOF  2",
        "          FORCE     EQUILIBRIUM NOT ACHIEVED WITHIN TOLERANCE.",
    ]


def test_two_fields_and_an_instance(labelled: Model, tmp_path: Path) -> None:
    mesh = Mesh(labelled.mesh.labels, labelled.mesh.coordinates, ("CUBE_ASSEMBLY",) * 8)
    force = FieldCheck(
        "force", 0.997, 0.997, Largest(-1.581e-7, 5, 1), Largest(-5.582e-3, 6, 3), NONE, Convergence.CONVERGED
    )
    heat = FieldCheck(
        "temperature",
        1.987e-2,
        1.987e-2,
        Largest(-3.933e-6, 1, 11),
        Largest(100.0, 0, 11),
        Largest(-9.896e-3, 1, 11),
        Convergence.CORRECTION_TOO_LARGE,
    )
    lines = written(replace(labelled, mesh=mesh), tmp_path, iteration(force, heat, number=2))
    assert lines[4:] == [
        " AVERAGE FORCE                      0.997       TIME AVG. FORCE       0.997",
        " LARGEST RESIDUAL FORCE            -1.581E-07   AT NODE       1051   DOF  1",
        "   INSTANCE: CUBE_ASSEMBLY",
        " LARGEST INCREMENT OF DISP.        -5.582E-03   AT NODE        559   DOF  3",
        "   INSTANCE: CUBE_ASSEMBLY",
        " ALL CORRECTION TO DISP.    ARE ZERO",
        "          THE FORCE     EQUILIBRIUM EQUATIONS HAVE CONVERGED",
        "",
        " AVERAGE HEAT FLUX                  1.987E-02   TIME AVG. HEAT FLUX   1.987E-02",
        " LARGEST RESIDUAL HEAT FLUX        -3.933E-06   AT NODE          2   DOF 11",
        "   INSTANCE: CUBE_ASSEMBLY",
        " LARGEST INCREMENT OF TEMP.          100.       AT NODE          1   DOF 11",
        "   INSTANCE: CUBE_ASSEMBLY",
        " LARGEST CORRECTION TO TEMP.       -9.896E-03   AT NODE          2   DOF 11",
        "   INSTANCE: CUBE_ASSEMBLY",
        "          TEMP.    CORRECTION TOO LARGE COMPARED TO TEMP.    INCREMENT",
    ]


@pytest.mark.parametrize(
    ("verdict", "lines"),
    [
        (Convergence.LINEAR, ["          THE FORCE     EQUILIBRIUM RESPONSE WAS LINEAR IN THIS INCREMENT"]),
        (Convergence.ZERO_FLUX, ["          THERE IS ZERO FORCE     EVERYWHERE"]),
        (Convergence.CORRECTION_TOO_LARGE, ["          DISP.    CORRECTION TOO LARGE COMPARED TO DISP.    INCREMENT"]),
        (
            Convergence.ACCEPTED_ESTIMATE,
            [
                " ESTIMATE OF DISP.    CORRECTION   -1.444E-04",
                " FORCE     EQUILIB. ACCEPTED BASED ON SMALL RESIDUAL AND ESTIMATED CORRECTION",
            ],
        ),
    ],
)
def test_verdicts(labelled: Model, tmp_path: Path, verdict: Convergence, lines: list[str]) -> None:
    check = FieldCheck("force", 0.0, 0.01, NONE, NONE, NONE, verdict, estimated_correction=-1.444e-4)
    assert written(labelled, tmp_path, iteration(check))[4:] == [
        " AVERAGE FORCE                       0.00       TIME AVG. FORCE       1.000E-02",
        " ALL FORCE     RESIDUALS ARE ZERO",
        " ALL DISP.    INCREMENTS ARE ZERO",
        " ALL CORRECTION TO DISP.    ARE ZERO",
        *lines,
    ]


def test_moments_have_their_own_words(labelled: Model, tmp_path: Path) -> None:
    check = FieldCheck(
        "moment",
        1.12,
        1.9,
        Largest(-3.273e-3, 2, 5),
        Largest(1.598e-2, 1, 5),
        Largest(1.598e-2, 1, 5),
        Convergence.CORRECTION_TOO_LARGE,
    )
    assert written(labelled, tmp_path, iteration(check))[4:] == [
        " AVERAGE MOMENT                      1.12       TIME AVG. MOMENT       1.90",
        " LARGEST RESIDUAL MOMENT           -3.273E-03   AT NODE          3   DOF  5",
        " LARGEST INCREMENT OF ROTATION      1.598E-02   AT NODE          2   DOF  5",
        " LARGEST CORRECTION TO ROTATION     1.598E-02   AT NODE          2   DOF  5",
        "          ROTATION CORRECTION TOO LARGE COMPARED TO ROTATION INCREMENT",
    ]


def test_an_increment(model: Model, records: Records, tmp_path: Path) -> None:
    """Abaqus 2018: an attempt, its summary, and the increment that follows two easy ones."""
    done = next(record for record in records(model) if isinstance(record, IncrementDone))
    model = replace(model, steps=(replace(model.steps[0], procedure=Static(1.0, 10.0, 2e-10, 10.0)),))
    lines = written(
        model,
        tmp_path,
        ("attempt_started", AttemptStarted(1, 1, 2, 0.0, 0.0, 0.346)),
        (
            "increment",
            replace(done, step_time=0.346, total_time=0.346, time_increment=2.02e-3, next_increment=3.03e-3),
        ),
    )
    assert lines == [
        "",
        "",
        "  INCREMENT     1 STARTS. ATTEMPT NUMBER  2, TIME INCREMENT  0.346",
        "          TIME INCREMENT MAY NOW INCREASE TO    3.030E-03",
        "",
        " ITERATION SUMMARY FOR THE INCREMENT:   2 TOTAL ITERATIONS, OF WHICH",
        "   0 ARE SEVERE DISCONTINUITY ITERATIONS AND  2 ARE EQUILIBRIUM ITERATIONS.",
        "",
        " TIME INCREMENT COMPLETED  2.020E-03,  FRACTION OF STEP COMPLETED  3.460E-02",
        " STEP TIME COMPLETED       0.346    ,  TOTAL TIME COMPLETED        0.346",
    ]


def test_an_abandoned_attempt_and_a_failed_job(model: Model, tmp_path: Path) -> None:
    file = MessageFile(tmp_path / "job.msg", model)
    file.abandoned(
        AttemptAbandoned(
            1, 4, 5, 4, 0.39, 0.39, 1.6e-4, 0.0, "THE SOLUTION APPEARS TO BE DIVERGING. CONVERGENCE IS JUDGED UNLIKELY."
        )
    )
    file.close("TOO MANY ATTEMPTS MADE FOR THIS INCREMENT")
    lines = [line.rstrip() for line in (tmp_path / "job.msg").read_text().splitlines()]
    assert lines[2] == " ***NOTE: THE SOLUTION APPEARS TO BE DIVERGING. CONVERGENCE IS JUDGED UNLIKELY."
    assert lines[5] == " ***ERROR: TOO MANY ATTEMPTS MADE FOR THIS INCREMENT"
    assert lines[8:10] == [
        " ***ERROR: THE ANALYSIS HAS BEEN TERMINATED DUE TO PREVIOUS ERRORS. ALL OUTPUT",
        "           REQUESTS HAVE BEEN WRITTEN FOR THE LAST CONVERGED INCREMENT.",
    ]
    assert "     TOTAL OF          0  INCREMENTS" in lines
    assert "                       2  ERROR MESSAGES" in lines


@pytest.mark.parametrize(
    "line",
    [
        "                        S T E P       1     S T A T I C   A N A L Y S I S",
        "     AUTOMATIC TIME CONTROL WITH -",
        "          A SUGGESTED INITIAL TIME INCREMENT OF                 1.00",
        "          AND A TOTAL TIME PERIOD OF                            10.0",
        "          THE MINIMUM TIME INCREMENT ALLOWED IS                2.000E-10",
        "          THE MAXIMUM TIME INCREMENT ALLOWED IS                 10.0",
        " CONVERGENCE TOLERANCE PARAMETERS FOR FORCE",
        "     CRITERION FOR RESIDUAL FORCE     FOR A NONLINEAR PROBLEM          5.000E-03",
        "     CRITERION FOR DISP.    CORRECTION IN A NONLINEAR PROBLEM          1.000E-02",
        "     INITIAL VALUE OF TIME AVERAGE FORCE                               1.000E-02",
        "     ALTERNATE CRIT. FOR RESIDUAL FORCE     FOR A NONLINEAR PROBLEM    2.000E-02",
        "     CRITERION FOR ZERO FORCE     RELATIVE TO TIME AVRG. FORCE         1.000E-05",
        "     CRITERION FOR RESIDUAL FORCE     WHEN THERE IS ZERO FLUX          1.000E-05",
        "     CRITERION FOR DISP.    CORRECTION WHEN THERE IS ZERO FLUX         1.000E-03",
        "     CRITERION FOR RESIDUAL FORCE     FOR A LINEAR INCREMENT           1.000E-08",
        " TIME INCREMENTATION CONTROL PARAMETERS:",
        "     FIRST EQUILIBRIUM ITERATION FOR CONSECUTIVE DIVERGENCE CHECK              4",
        "     EQUILIBRIUM ITERATION AT WHICH LOG. CONVERGENCE RATE CHECK BEGINS         8",
        "     EQUILIBRIUM ITERATION AFTER WHICH ALTERNATE RESIDUAL IS USED              9",
        "     MAXIMUM EQUILIBRIUM ITERATIONS ALLOWED                                   16",
        "     EQUILIBRIUM ITERATION COUNT FOR CUT-BACK IN NEXT INCREMENT               10",
        "     MAXIMUM EQUILIB. ITERS IN TWO INCREMENTS FOR TIME INCREMENT INCREASE      4",
        "     MAXIMUM ATTEMPTS ALLOWED IN AN INCREMENT                                  5",
        "     CUT-BACK FACTOR AFTER DIVERGENCE                                 0.2500",
        "     CUT-BACK FACTOR FOR TOO SLOW CONVERGENCE                         0.5000",
        "     CUT-BACK FACTOR AFTER TOO MANY EQUILIBRIUM ITERATIONS            0.7500",
        "     INCREASE FACTOR AFTER TWO INCREMENTS THAT CONVERGE QUICKLY        1.500",
        "     MAX. TIME INCREMENT INCREASE FACTOR ALLOWED                       1.500",
        "     MINIMUM TIME INCREMENT RATIO FOR EXTRAPOLATION TO OCCUR          0.1000",
        "     THE MAXIMUM NUMBER OF INCREMENTS IN THIS STEP IS                     100",
        "          LARGE DISPLACEMENT THEORY WILL BE USED",
        "          UNSYMMETRIC MATRIX STORAGE AND SOLUTION WILL BE USED",
        "     LINEAR EXTRAPOLATION WILL BE USED",
    ],
)
def test_the_head_of_a_step(model: Model, tmp_path: Path, line: str) -> None:
    step = replace(
        model.steps[0],
        procedure=Static(1.0, 10.0, 2e-10, 10.0),
        controls=Controls(FieldControls(q_0=0.01)),
        nlgeom=True,
        unsymmetric=True,
    )
    assert line in written(replace(model, steps=(step,)), tmp_path, ("step_started", StepStarted(1)))


def test_the_head_of_a_step_with_fixed_increments(model: Model, tmp_path: Path) -> None:
    step = replace(model.steps[0], procedure=Static(0.01, 20.0, direct=True), extrapolation="NO")
    lines = written(replace(model, steps=(step,)), tmp_path, ("step_started", StepStarted(1)))
    assert "          FIXED TIME INCREMENTS" in lines
    assert "          TIME INCREMENT IS                                    1.000E-02" in lines
    assert "          TIME PERIOD IS                                        20.0" in lines
    assert " ITERATION CONTROL PARAMETERS:" in lines
    assert "     EXTRAPOLATION WILL NOT BE USED" in lines
    assert not any("CUT-BACK" in line for line in lines)


def test_controls_of_the_deck_are_printed(model: Model, tmp_path: Path) -> None:
    controls = Controls(
        FieldControls(r_n=0.01),
        {"ROTATION": FieldControls(r_n=0.02, q_u=3.0)},
        TimeControls(i_0=8, i_r=10),
        LineSearchControls(n_ls=4),
    )
    definition = model.groups[0].definition
    assert definition is not None
    group = replace(model.groups[0], definition=replace(definition, dofs=((0, 1), (0, 6))))
    assert isinstance(group, ElementGroup)
    model = replace(model, steps=(replace(model.steps[0], controls=controls),), groups=(group,))
    lines = written(model, tmp_path, ("step_started", StepStarted(1)))
    assert "     CRITERION FOR RESIDUAL FORCE     FOR A NONLINEAR PROBLEM          1.000E-02" in lines
    assert "     CRITERION FOR RESIDUAL MOMENT    FOR A NONLINEAR PROBLEM          2.000E-02" in lines
    assert "     TIME AVERAGE MOMENT IS SET TO                                      3.00" in lines
    assert "     FIELD CONVERSION RATIO                                             1.00" in lines
    assert "     CRITERION FOR ZERO FORCE     REL. TO TIME AVRG. MAX. FORCE        1.000E-05" in lines
    assert "     FIRST EQUILIBRIUM ITERATION FOR CONSECUTIVE DIVERGENCE CHECK              8" in lines
    assert "     MAXIMUM NUMBER OF LINE SEARCH ITERATIONS                                  4" in lines
    assert " CONVERGENCE TOLERANCE PARAMETERS FOR HEAT FLUX" not in lines


def test_line_searches_beyond_the_full_correction_are_printed_and_counted(model: Model, tmp_path: Path) -> None:
    check = FieldCheck("force", 1.0, 1.0, NONE, NONE, NONE, Convergence.CONVERGED)
    file = MessageFile(tmp_path / "job.msg", model)
    file.iteration(IterationDone(1, (check,), line_search=(1.0, 0.345)))
    file.iteration(IterationDone(2, (check,), line_search=(1.0,)))
    file.close(None)
    text = (tmp_path / "job.msg").read_text()
    assert text.count(" CORRECTION SCALE FACTORS OF THE LINE SEARCH") == 1
    assert " CORRECTION SCALE FACTORS OF THE LINE SEARCH   1.00      0.345" in text
    assert "                       1  ADDITIONAL RESIDUAL EVALUATIONS FOR LINE SEARCHES" in text
    assert "          THE ANALYSIS HAS BEEN COMPLETED\n" in text


def test_an_increment_that_needed_the_descent_search_says_so_and_is_counted(model: Model, tmp_path: Path) -> None:
    """Not in Abaqus: the harness runs so only on request."""
    file = MessageFile(tmp_path / "job.msg", model)
    file.helped(SearchHelped(1, 4, 3, 9, "THE CORRECTION WENT UPHILL"))
    file.close(None)
    text = " ".join((tmp_path / "job.msg").read_text().split())
    assert (
        "***NOTE: EQUILIBRIUM FOUND WITH THE DESCENT SEARCH, WHICH TOOK OVER IN ITERATION 3 OF 9: "
        "THE CORRECTION WENT UPHILL" in text
    )
    assert "1 INCREMENTS THAT NEEDED THE DESCENT SEARCH" in text
    MessageFile(tmp_path / "plain.msg", model).close(None)
    assert "DESCENT" not in (tmp_path / "plain.msg").read_text()
