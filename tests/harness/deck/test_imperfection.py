# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*IMPERFECTION: shapes of earlier jobs and data lines, and what follows from them in a column."""

import numpy as np
import pytest
from columns import LONG, column, head

from uel.deck import read_deck
from uel.errors import DeckError

TOP, LOAD = head("CPS8R")
COLUMN = column("CPS8R") + TOP
BUCKLE = f"*STEP\n*BUCKLE\n2\n{LOAD}\n*NODE FILE\nU\n*END STEP\n"
SMALL = 1e-3 * LONG
TRUSS = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 2., 0., 0.
3, 0., 3., 1.
*ELEMENT, TYPE=T3D2, ELSET=BARS
1, 1, 2
2, 2, 3
*NSET, NSET=TIP
3
*SOLID SECTION, ELSET=BARS, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
100.
{imperfection}*BOUNDARY
1, 1, 3
3, 1, 3
*STEP
*STATIC
1., 1.
*BOUNDARY
2, 2, 3
*CLOAD
2, 1, 1.
*END STEP
"""


def imperfect(step, data, options=""):
    return COLUMN.replace("*BOUNDARY", f"*IMPERFECTION, FILE=modes, STEP=1{options}\n{data}\n*BOUNDARY", 1) + step


@pytest.mark.parametrize("how", ["*STATIC, RIKS\n0.1, 1., 1e-5, 0.2, 0.8\n", "*STATIC\n0.2, 0.8\n"])
def test_column_with_its_first_mode(run_deck, how):
    """A deflection a of the first mode grows to a/(1 - P/Pcr), for small ones.

    (S.P. Timoshenko, Theory of Elastic Stability, columns with initial curvature.)
    """
    critical = run_deck(COLUMN + BUCKLE, name="modes").history["EIGVAL"][0]
    load = LOAD.replace("TRVEC, 1.", f"TRVEC, {critical if 'RIKS' in how else 0.8 * critical}")
    step = f"*STEP, NLGEOM, INC=30\n{how}{load}\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU2\n*END STEP\n"
    result = run_deck(imperfect(step, f"1, {SMALL}"), name="column")
    tip = max((name for name in result.history if name.startswith("U2[")), key=lambda n: abs(result.history[n][-1]))
    share = result.history["LPF"] if "RIKS" in how else result.history["time"]
    found = result.history[tip]
    assert share[-1] >= 0.8 - 1e-9
    np.testing.assert_allclose(np.abs(found[1:]), SMALL * (1 / (1 - share[1:]) - 1), rtol=3e-2)


def test_sum_of_shapes(run_deck, tmp_path):
    """Modes with their factors; a general step has the displacements of its last increment, or of INC."""
    result = run_deck(COLUMN + BUCKLE, name="modes")
    modes = [result.field("U", increment=k) for k in (1, 2)]
    straight = read_deck(tmp_path / "modes.inp").mesh.coordinates

    def moved(data, options=""):
        return run_deck(imperfect(BUCKLE, data, options), name="sum").mesh().points - straight

    np.testing.assert_allclose(moved("1, 0.1\n2, -0.02"), 0.1 * modes[0] - 0.02 * modes[1], atol=1e-14)
    chosen = np.zeros((len(straight), 1))
    chosen[straight[:, 0] == 0] = 1
    np.testing.assert_allclose(moved("2, 0.5", ", NSET=FOOT"), 0.5 * chosen * modes[1], atol=1e-14)
    static = f"*STEP\n*STATIC\n0.5, 1., 1e-5, 0.5\n{LOAD}\n*OUTPUT, FIELD, FREQUENCY=1\n*END STEP\n"
    last = run_deck(COLUMN + static, name="modes").field("U")
    np.testing.assert_allclose(moved("1, 2."), 2 * last, atol=1e-14)
    np.testing.assert_allclose(moved("1, 2.", ", INC=1"), last, atol=1e-14)


def test_nodes_by_their_numbers(run_deck):
    """Nodes that the other job does not have stay."""
    run_deck(TRUSS.format(imperfection=""), name="bars")
    more = TRUSS.format(imperfection="*IMPERFECTION, FILE=bars.fil, STEP=1\n1, 10.\n")
    more = more.replace("3, 0., 3., 1.\n", "3, 0., 3., 1.\n7, 5., 5., 5.\n").replace("2, 2, 3\n", "2, 2, 3\n3, 3, 7\n")
    result = run_deck(more.replace("3, 1, 3\n", "3, 1, 3\n7, 1, 3\n"), name="more")
    found = result.mesh().points
    assert found[1, 0] > 2.01
    np.testing.assert_allclose(found[[0, 2, 3]], [[0, 0, 0], [0, 3, 1], [5, 5, 5]])


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("*IMPERFECTION\n2, 0.1, 0.2, 0.3\nTIP, , , 0.5", [[2.1, 0.2, 0.3], [0, 3, 1.5]]),
        ("*IMPERFECTION, INPUT=moved.txt", [[2.0, -1.0, 0.0], [0, 3, 1]]),
        ("*IMPERFECTION, SYSTEM=C\n2, 1., 90.\n3, -1., -90., 1.", [[0.0, 3.0, 0.0], [2, 0, 2]]),
        ("*IMPERFECTION\n2, 0.1\n*IMPERFECTION\n2, 0.1", [[2.2, 0.0, 0.0], [0, 3, 1]]),
    ],
)
def test_data_lines(tmp_path, lines, found):
    (tmp_path / "moved.txt").write_text("2, 0., -1.\n")
    path = tmp_path / "bars.inp"
    path.write_text(TRUSS.format(imperfection=f"{lines}\n"))
    np.testing.assert_allclose(read_deck(path).mesh.coordinates[1:], found, atol=1e-14)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("*IMPERFECTION, FILE=none, STEP=1\n1, 1.", r"FILE=none: no results of a job none in "),
        ("*IMPERFECTION, FILE=bars\n1, 1.", r"FILE needs STEP, the number of the step of that job"),
        ("*IMPERFECTION, FILE=bars, STEP=1", r"needs data lines with a mode and its factor"),
        ("*IMPERFECTION, FILE=bars, STEP=2\n1, 1.", r"FILE=bars: .*no field output of step 2"),
        ("*IMPERFECTION, FILE=bars, STEP=1\n2, 1.", r"FILE=bars: step 1 has no modes: expected 1 .* found mode 2"),
        ("*IMPERFECTION, FILE=bars, STEP=1, INC=5\n1, 1.", r"FILE=bars: .*no field output of step 1, increment 5"),
        ("*IMPERFECTION, FILE=bars, STEP=1, NSET=NONE\n1, 1.", r"NONE"),
        ("*IMPERFECTION", r"needs FILE, or data lines with nodes"),
        ("*IMPERFECTION, STEP=1\n2, 1.", r"STEP, INC and NSET are about FILE"),
        ("*IMPERFECTION\n9, 1.", r"node 9 is not defined"),
        ("*IMPERFECTION, SYSTEM=S\n2, 1.", r"SYSTEM=S"),
    ],
)
def test_what_is_wrong_is_named(run_deck, lines, message):
    run_deck(TRUSS.format(imperfection=""), name="bars")
    with pytest.raises(DeckError, match=rf"wrong\.inp:\d+: .*{message}"):
        run_deck(TRUSS.format(imperfection=f"{lines}\n"), name="wrong")


def test_nodes_of_instances(run_deck):
    """They have to be the same, for numbers alone do not tell them apart."""
    run_deck(TRUSS.format(imperfection=""), name="bars")
    part, steps = TRUSS.format(imperfection="").split("*BOUNDARY", 1)
    part, material = part.split("*MATERIAL")
    steps = "*BOUNDARY" + steps.replace("\n1, 1", "\nA.1, 1").replace("\n2, ", "\nA.2, ").replace("\n3, 1", "\nA.3, 1")
    instance = "*ASSEMBLY, NAME=W\n*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*END ASSEMBLY\n"
    more = part.replace("3, 0., 3., 1.\n", "3, 0., 3., 1.\n7, 5., 5., 5.\n").replace("2, 2, 3\n", "2, 2, 3\n3, 3, 7\n")
    for own, message in ((part, None), (more, "the nodes of that job are not those of this model with instances")):
        text = f"*PART, NAME=P\n{own}*END PART\n{instance}*MATERIAL{material}"
        text += f"*IMPERFECTION, FILE=bars, STEP=1\n1, 1.\n{steps}"
        if message is None:
            run_deck(text, name="parts")
            continue
        with pytest.raises(DeckError, match=message):
            run_deck(text, name="parts")
