# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Steps, procedures, controls and output requests."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from uel.errors import DeckError
from uel.model.controls import Controls, FieldControls, LineSearchControls, TimeControls
from uel.model.model import Model
from uel.model.procedures import Riks, Static
from uel.model.steps import Position, Step

Read = Callable[[str], Model]
FLAT = Path(__file__).with_name("flat.inp").read_text()
MODEL = FLAT[: FLAT.index("*STEP")]


def steps(read: Read, *bodies: str, options: str = "") -> tuple[Step, ...]:
    """Steps made of these lines each; *STATIC comes first unless the lines hold it."""
    texts = [
        f"*STEP{options}\n" + ("" if "*STATIC" in body else "*STATIC\n") + f"{body}\n*END STEP\n" for body in bodies
    ]
    return read(MODEL + "".join(texts)).steps


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        # Abaqus Keywords Guide, *STATIC: period 1, initial = period, smallest = min(initial, 1e-5 period)
        ("", Static(1.0, 1.0, 1e-5, 1.0)),
        (", 4.", Static(4.0, 4.0, 4e-5, 4.0)),
        ("0.5, 2.", Static(0.5, 2.0, 2e-5, 2.0)),
        ("1e-6, 1.", Static(1e-6, 1.0, 1e-6, 1.0)),
        ("0.1, 1., , 0.2", Static(0.1, 1.0, 1e-5, 0.2)),
        ("0.1, 1., 0., 0.", Static(0.1, 1.0, 1e-5, 1.0)),
        ("0.1, 1., 0.01, 0.5", Static(0.1, 1.0, 0.01, 0.5)),
    ],
)
def test_static_defaults(read: Read, line: str, expected: Static) -> None:
    assert steps(read, f"*STATIC\n{line}")[0].procedure == expected


def test_direct(read: Read) -> None:
    assert steps(read, "*STATIC, DIRECT\n0.1, 1.")[0].procedure == Static(0.1, 1.0, 0.1, 0.1, direct=True)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        # Abaqus Keywords Guide, *STATIC, RIKS: no limit of the arc length, and none of the load factor
        ("", Static(1.0, 1.0, 1e-5, math.inf, riks=Riks())),
        ("0.1, 2., 1e-4, 0.5, 1.5", Static(0.1, 2.0, 1e-4, 0.5, riks=Riks(1.5))),
        ("0.1, , , , , 3, 2, -0.5", Static(0.1, 1.0, 1e-5, math.inf, riks=Riks(None, 2, 2, -0.5))),
    ],
)
def test_riks(read: Read, line: str, expected: Static) -> None:
    assert steps(read, f"*STATIC, RIKS\n{line}")[0].procedure == expected


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("0.1, 1., , , 1., 3, 2, 1., 5.", "9 entries, expected at most 8"),
        ("0.1, 1., , , , 3, 2", "displacement is missing"),
        ("0.1, 1., , , , 3", "dof is missing"),
        ("0.1, 1., , , , , 2", "a dof and a displacement need a node"),
        ("0.1, 1., , , , ALL, 1, 1.", "ALL has 8 nodes, expected one"),
    ],
)
def test_wrong_riks(read: Read, line: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        steps(read, f"*STATIC, RIKS\n{line}")


def test_step_defaults(read: Read) -> None:
    (step,) = steps(read, "")
    assert (step.name, step.increments, step.nlgeom, step.extrapolation) == ("Step-1", 100, False, "LINEAR")
    assert (step.amplitude, step.unsymmetric, step.controls) == ("RAMP", False, Controls())


def test_step_options(read: Read) -> None:
    (step,) = steps(read, "", options=", NLGEOM, UNSYMM=YES, EXTRAPOLATION=PARABOLIC, AMPLITUDE=STEP, INC=7")
    assert (step.nlgeom, step.unsymmetric, step.extrapolation) == (True, True, "PARABOLIC")
    assert (step.amplitude, step.increments) == ("STEP", 7)


def test_nlgeom_and_unsymm_stay(read: Read) -> None:
    """Abaqus Keywords Guide, *STEP: both hold in all later steps."""
    text = MODEL + "*STEP, NLGEOM, UNSYMM\n*STATIC\n*END STEP\n" + "*STEP\n*STATIC\n*END STEP\n"
    text += "*STEP, NLGEOM=NO, UNSYMM=NO\n*STATIC\n*END STEP\n"
    assert [(step.nlgeom, step.unsymmetric) for step in read(text).steps] == [(True, True), (True, True), (True, False)]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (", INC=0", r"deck.inp:41: \*STEP: INC=0 must be positive"),
        (", NAME=A", r"deck.inp:45: \*STEP: the name A is taken by an earlier step"),
    ],
)
def test_wrong_step_options(read: Read, options: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        steps(read, "", "", options=options)


def test_second_procedure(read: Read) -> None:
    with pytest.raises(DeckError, match=r"deck.inp:43: \*STATIC: the step has a procedure already, at deck.inp:42"):
        steps(read, "*STATIC\n*STATIC")


def test_op(read: Read) -> None:
    first, second = steps(
        read, "*BOUNDARY\nTOP, 2, , 0.1\n*CLOAD\n3, 1, 5.", "*BOUNDARY, OP=NEW\nTOP, 1\n*CLOAD, OP=NEW"
    )
    assert (first.new_boundary, first.new_loads) == (False, False)
    assert (second.new_boundary, second.new_loads) == (True, True)
    assert [entry.dof for entry in second.boundaries] == [1]


def test_op_must_be_one_in_a_step(read: Read) -> None:
    """Abaqus Keywords Guide, *BOUNDARY: OP must be the same for all uses within a step."""
    with pytest.raises(
        DeckError, match=r"deck.inp:45: \*BOUNDARY: OP=NEW and OP=MOD in one step; first OP=NEW at deck.inp:43"
    ):
        steps(read, "*BOUNDARY, OP=NEW\nTOP, 1\n*BOUNDARY\nTOP, 2")


def test_named_boundaries(read: Read) -> None:
    """Dofs of the manual's table, of those that some element has; here 1 and 2."""
    kinds = ("XSYMM", "YSYMM", "ZSYMM", "XASYMM", "YASYMM", "ZASYMM", "PINNED", "ENCASTRE")
    found = [
        [entry.dof for entry in read(MODEL.replace("PINNED", kind) + "*STEP\n*STATIC\n*END STEP\n").boundaries]
        for kind in kinds
    ]
    assert found == [[1], [2], [], [2], [1], [1, 2], [1, 2], [1, 2]]


FIELD = "*CONTROLS, PARAMETERS=FIELD"
TIME = "*CONTROLS, PARAMETERS=TIME INCREMENTATION"
CONSTRAINTS = "*CONTROLS, PARAMETERS=CONSTRAINTS"


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            f"{FIELD}\n.01, .02, 3., 4., .05, 6e-5, 7e-3, 8e-8\n",
            Controls(default=FieldControls(0.01, 0.02, 3.0, 4.0, 0.05, 6e-5, 7e-3, 8e-8)),
        ),
        (f"{FIELD}\n, 1.\n", Controls(default=FieldControls(c_n=1.0))),
        (f"{FIELD}\n\n0.5, 1e-6\n", Controls(default=FieldControls(c_f=0.5, eps_l=1e-6))),
        (f"{FIELD}, FIELD=DISP\n.01\n", Controls(fields={"DISPLACEMENT": FieldControls(r_n=0.01)})),
        (
            f"{FIELD}, FIELD=ROTATION\n.01, 1.\n{FIELD}\n.02\n",
            Controls(default=FieldControls(r_n=0.02), fields={"ROTATION": FieldControls(r_n=0.02, c_n=1.0)}),
        ),
        (f"{TIME}\n8, 10, , , , , , 20\n", Controls(time=TimeControls(i_0=8, i_r=10, i_a=20))),
        (f"{TIME}\n\n.1, , .6\n", Controls(time=TimeControls(d_f=0.1, d_b=0.6))),
        (
            f"{TIME}\n5, 6, 7, 8, 9, 3, 11, 12, 13, 2, 40, 45, 50\n"
            ".2, .4, .6, .8, .3, .31, 1.4, .7\n.9, 1.6, 1.7, 1.8, .96, .2, 1., .9\n1.5\n",
            Controls(
                time=TimeControls(
                    *(5, 6, 7, 8, 9, 3, 11, 12, 13, 2, 40, 45),
                    *(0.2, 0.4, 0.6, 0.8, 0.3, 0.31, 1.4, 0.7, 0.9, 1.6, 1.7, 1.8, 0.96, 0.2),
                )
            ),
        ),
        ("*CONTROLS, ANALYSIS=DISCONTINUOUS\n", Controls(time=TimeControls(i_0=8, i_r=10))),
        # it overrides what TIME INCREMENTATION gives, in any order
        (f"*CONTROLS, ANALYSIS=DISC\n{TIME}\n5, 6, 7\n", Controls(time=TimeControls(i_0=8, i_r=10, i_p=7))),
        ("*CONTROLS, PARAMETERS=LINE SEARCH\n4, 2.\n", Controls(line_search=LineSearchControls(4, 2.0))),
        (
            "*CONTROLS, PARAMETERS=LINE\n4, 2., .01, .3, .2\n",
            Controls(line_search=LineSearchControls(4, 2.0, 0.01, 0.3, 0.2)),
        ),
        (f"{CONSTRAINTS}\n1e-3\n", Controls(volume=1e-3)),
        (
            f"{CONSTRAINTS}\n, 1e-6, 1e-6, 1e-2, .2, 1e-6, 1e-4, .5\n",
            Controls(contact=1e-2, coupling=1e-6, coupling_rotation=1e-4, contact_force=0.5),
        ),
        (f"{FIELD}\n\n, , 1e-8\n", Controls()),
        (f"{FIELD}\n\n, , 1e-14\n", Controls()),
        (f"{TIME}\n8, 10\n*CONTROLS, RESET\n", Controls()),
    ],
)
def test_controls(read: Read, body: str, expected: Controls) -> None:
    assert steps(read, body)[0].controls == expected


def test_controls_stay_in_later_steps(read: Read) -> None:
    found = [step.controls.time for step in steps(read, f"{TIME}\n5", f"{TIME}\n, 6", "*CONTROLS, RESET", "")]
    changed = TimeControls(i_0=5)
    assert found == [changed, replace(changed, i_r=6), TimeControls(), TimeControls()]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (f"{FIELD}\n-.01", r"deck.inp:44: \*CONTROLS: R_N = -0.01 must not be negative"),
        (f"{TIME}\n4.5", r"deck.inp:44: \*CONTROLS: I_0: '4.5' is not an integer"),
        (f"{FIELD}\n{'1,' * 9}", r"deck.inp:44: \*CONTROLS: 9 entries, expected at most 8"),
        (f"{FIELD}\n1\n2\n3", r"deck.inp:46: \*CONTROLS: data line 3 is not supported"),
        (f"{FIELD}\n1\n1., 1e-5, 1e-8, 1", r"deck.inp:45: \*CONTROLS: 4 entries, expected at most 3"),
        (f"{FIELD}\n1\n1., 1e-5, 1e-7", r"deck.inp:45: \*CONTROLS: EPS_D = 1e-07: only up to the default 1e-08"),
        (f"{CONSTRAINTS}\n{'1,' * 9}", r"deck.inp:44: \*CONTROLS: 9 entries, expected at most 8"),
        (f"{TIME}\n1\n1\n1\n1.5\n1", r"deck.inp:48: \*CONTROLS: data line 5 is not supported"),
        ("*CONTROLS, RESET\n1", r"deck.inp:43: \*CONTROLS: RESET takes no data lines"),
        ("*CONTROLS\n1", r"deck.inp:43: \*CONTROLS: data lines need PARAMETERS="),
        ("*CONTROLS", r"deck.inp:43: \*CONTROLS: needs ANALYSIS, PARAMETERS or RESET"),
        (f"{FIELD}, FIELD=COLOUR\n1", r"deck.inp:43: \*CONTROLS, FIELD=COLOUR: expected one of GLOBAL, DISP"),
    ],
)
def test_wrong_controls(read: Read, body: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        steps(read, body)


def test_preselected_output(read: Read) -> None:
    """Without any *OUTPUT: field output in every increment, energies of the whole model."""
    output = steps(read, "")[0].output
    assert (output.field_frequency, output.history_frequency, output.history_nodes) == (1, 1, ())
    assert {"ALLIE", "ALLSE", "ALLWK", "ETOTAL"} < set(output.history_energies)


def test_output_of_one_kind_drops_the_preselected(read: Read) -> None:
    field = steps(read, "*OUTPUT, FIELD, FREQUENCY=3")[0].output
    assert (field.field_frequency, field.history_energies) == (3, ())
    history = steps(read, "*OUTPUT, HISTORY, FREQUENCY=4\n*NODE OUTPUT, NSET=TOP\nU, RF2")[0].output
    assert (history.field_frequency, history.history_frequency) == (0, 4)
    assert history.history_nodes[0].variables == ("U", "RF2")
    assert history.history_nodes[0].frequency == 4


def test_several_outputs_in_a_step_add_up(read: Read) -> None:
    body = "*OUTPUT, FIELD, FREQUENCY=6\n*OUTPUT, FIELD, FREQUENCY=4\n"
    body += (
        "*OUTPUT, HISTORY, FREQUENCY=10\n*NODE OUTPUT, NSET=TOP\nU1\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=BOTTOM\nU2"
    )
    output = steps(read, body)[0].output
    assert output.field_frequency == 4
    assert [(request.nset, request.frequency) for request in output.history_nodes] == [("TOP", 10), ("BOTTOM", 1)]
    assert output.history_frequency == 1


@pytest.mark.parametrize(
    ("given", "position"),
    [
        ("", Position.POINTS),
        (", POSITION=INTEGRATION POINTS", Position.POINTS),
        (", POSITION=CENTROIDAL", Position.CENTROID),
        (", POSITION=centroid", Position.CENTROID),
        (", POSITION=NODES", Position.NODES),
        (", POSITION=AVERAGED AT NODES", Position.AVERAGED),
    ],
)
def test_positions_of_element_tables(read: Read, given: str, position: Position) -> None:
    model = read(MODEL + f"*STEP\n*STATIC\n*EL PRINT{given}\nS\n*END STEP\n")
    assert not model.warnings
    (request,) = model.steps[0].output.element_print
    assert request.position is position


def test_an_unknown_position_is_refused(read: Read) -> None:
    message = (
        r"deck\.inp:43: \*EL PRINT, POSITION=FACES: expected one of INTEGRATION POINTS, CENTROIDAL, CENTROID, NODES, "
    )
    with pytest.raises(DeckError, match=message):
        read(MODEL + "*STEP\n*STATIC\n*EL PRINT, POSITION=FACES\nS\n*END STEP\n")


def test_energies_are_printed_where_asked_for(read: Read) -> None:
    assert steps(read, "*NODE PRINT\nU")[0].output.energy_print == 0
    assert steps(read, "*ENERGY PRINT")[0].output.energy_print == 1
    assert steps(read, "*ENERGY PRINT, FREQUENCY=3")[0].output.energy_print == 3


def test_variables_below_energy_print_are_warned_of(read: Read) -> None:
    """Public decks have them there, and run in Abaqus."""
    model = read(MODEL + "*STEP\n*STATIC\n*ENERGY PRINT\nCOORD\n*END STEP\n")
    assert model.steps[0].output.energy_print == 1
    assert model.warnings == ("deck.inp:44: *ENERGY PRINT takes no data lines; all energies are printed",)


def test_requests_stay_until_replaced(read: Read) -> None:
    body = "*OUTPUT, FIELD, FREQUENCY=6\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TOP\nU1\n"
    body += "*NODE PRINT, NSET=TOP\nU\n*EL PRINT\nS"
    bodies = [
        body,
        "",
        "*OUTPUT, HISTORY, OP=ADD\n*NODE OUTPUT, NSET=BOTTOM\nU2\n*NODE PRINT, FREQUENCY=0",
        "*OUTPUT, FIELD",
    ]
    outputs = [step.output for step in steps(read, *bodies)]
    assert outputs[1] == outputs[0]
    assert [request.nset for request in outputs[2].history_nodes] == ["TOP", "BOTTOM"]
    assert (outputs[2].field_frequency, outputs[2].node_print) == (6, ())
    assert outputs[2].element_print == outputs[0].element_print
    assert (outputs[3].field_frequency, outputs[3].history_nodes) == (1, ())


def test_replace_drops_one_kind(read: Read) -> None:
    outputs = steps(
        read, "*OUTPUT, FIELD\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=TOP\nU1", "*OUTPUT, FIELD, OP=REPLACE, FREQUENCY=5"
    )
    assert outputs[1].output.field_frequency == 5
    assert outputs[1].output.history_nodes == outputs[0].output.history_nodes


def test_suppressed_output(read: Read) -> None:
    output = steps(read, "*OUTPUT, FIELD, FREQUENCY=0\n*OUTPUT, HISTORY, FREQUENCY=0\n*NODE OUTPUT, NSET=TOP\nU")[
        0
    ].output
    assert (output.field_frequency, output.history_nodes) == (0, ())


def test_field_output_in_parts_of_the_step(read: Read) -> None:
    output = steps(read, "*OUTPUT, FIELD, NUMBER INTERVAL=10, TIME MARKS=NO")[0].output
    assert (output.field_frequency, output.field_intervals) == (0, 10)
    body = "*OUTPUT, FIELD, NUMBER INTERVAL=10, TIME MARKS=NO\n*OUTPUT, FIELD, FREQUENCY=3"
    output = steps(read, body)[0].output
    assert (output.field_frequency, output.field_intervals) == (3, 10)
    first, second = steps(read, "*OUTPUT, FIELD, NUMBER INTERVAL=10, TIME MARKS=NO", "*OUTPUT, FIELD")
    assert (first.output.field_intervals, second.output.field_intervals) == (10, 0)
    with pytest.raises(DeckError, match="NUMBER INTERVAL=0 must be positive"):
        steps(read, "*OUTPUT, FIELD, NUMBER INTERVAL=0, TIME MARKS=NO")


def test_output_times_are_warned_of(read: Read) -> None:
    text = MODEL + "*STEP\n*STATIC\n*OUTPUT, FIELD, NUMBER INTERVAL=10\n*END STEP\n"
    assert read(text).warnings == (
        "deck.inp:43: *OUTPUT: increments do not end at the output times; every increment is written instead",
    )
    assert read(text.replace("=10", "=10, TIME MARKS=NO")).warnings == ()


def test_print_tables(read: Read) -> None:
    output = steps(read, "*NODE PRINT\nU1, U2\nRF\n*EL PRINT, ELSET=BULK\nSDV1\nSDV 2")[0].output
    assert [request.variables for request in output.node_print] == [("U1", "U2"), ("RF",)]
    assert output.node_print[0].nodes.tolist() == list(range(8))
    assert [request.variables for request in output.element_print] == [("SDV1",), ("SDV2",)]
    assert output.element_print[0].elements.tolist() == [0, 1]


def test_dof_that_is_given_two_values_in_a_step(read: Read) -> None:
    """The later value counts, as in later steps; what says the same is no contradiction."""
    body = "*BOUNDARY\nTOP, 1, 2\n*BOUNDARY, AMPLITUDE=GROW\n7, 2, , 0.1\n*BOUNDARY\nTOP, 1, 1, 0.\n"
    begin = FLAT.index("*STEP")
    line = FLAT[:begin].count("\n") + 5
    model = read(MODEL + f"*STEP\n*STATIC\n{body}*END STEP\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, , 1.\n*END STEP\n")
    (warning,) = [text for text in model.warnings if "in one step" in text]
    assert warning == (
        f"deck.inp:{line + 1}: *BOUNDARY: node 7, dof 2 is given the value 0.1 with amplitude GROW here and the value "
        f"0 at deck.inp:{line - 1}, in one step; the entry here counts"
    )


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (", TYPE=VELOCITY", "the rate 0"),
        (", USER", "what DISP says"),
        (", FIXED", "the value at the start of the step"),
    ],
)
def test_other_ways_to_contradict(read: Read, options: str, said: str) -> None:
    body = f"*BOUNDARY\nTOP, 1, 1\n*BOUNDARY{options}\n7, 1, 1\n"
    model = read(MODEL + f"*STEP\n*STATIC\n{body}*END STEP\n")
    (warning,) = [text for text in model.warnings if "in one step" in text]
    assert f"node 7, dof 1 is given {said} here and the value 0 at deck.inp:" in warning


MOVED = (
    "*AMPLITUDE, NAME=WAVE{smooth}\n0., 0., 1., 1., 2., 0.\n*STEP\n{procedure}\n"
    "*BOUNDARY, AMPLITUDE=WAVE\nTOP, 1, , 1.\n*END STEP\n"
)


def test_smooth_of_an_amplitude_has_no_effect_in_a_static_step(read: Read) -> None:
    """Abaqus Keywords Guide, *AMPLITUDE, SMOOTH: only when time derivatives are needed, ignored for all other uses."""
    model = read(MODEL + MOVED.format(smooth=", SMOOTH=0.1", procedure="*STATIC"))
    curve = model.steps[0].boundaries[0].amplitude
    assert curve is not None
    assert (curve.smoothing, curve.value(0.95, 0.95)) == (0.1, 0.95)
    assert model.differences == ()


def test_corners_of_prescribed_motion_in_a_dynamic_step(read: Read) -> None:
    """Abaqus/Standard rounds them by a quarter of the intervals unless SMOOTH=0, which is as here."""
    (difference,) = read(MODEL + MOVED.format(smooth="", procedure="*DYNAMIC\n0.1, 2.")).differences
    assert "Abaqus rounds the corners of amplitude WAVE of prescribed motion in *DYNAMIC by SMOOTH=0.25" in difference
    assert read(MODEL + MOVED.format(smooth=", SMOOTH=0.", procedure="*DYNAMIC\n0.1, 2.")).differences == ()


@pytest.mark.parametrize(
    ("smooth", "message"),
    [
        (", SMOOTH=0.1", r"SMOOTH=0.1 is not supported for amplitude WAVE of prescribed motion in \*DYNAMIC; expected"),
        (", SMOOTH=0.6", r"\*AMPLITUDE: SMOOTH=0.6: expected 0 to 0.5"),
        (", SMOOTH=0.1, DEFINITION=SMOOTH STEP", r"SMOOTH is for DEFINITION=TABULAR and EQUALLY SPACED"),
    ],
)
def test_wrong_smooth(read: Read, smooth: str, message: str) -> None:
    with pytest.raises(DeckError, match=message):
        read(MODEL + MOVED.format(smooth=smooth, procedure="*DYNAMIC\n0.1, 2."))
