# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear elements, which are called for their state alone: the same results with fewer calls."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from reference_cells import patch_of

import uel
from uel import usersub
from uel.assembly import Contributors, LinearShortcut
from uel.cli import main
from uel.deck import read_deck
from uel.delamination.blocks import BY_EQUATION_21, Interface
from uel.delamination.keywords import element_block, node_block
from uel.delamination.materials import TABLE_2
from uel.delamination.mesh import two_arms
from uel.delamination.specimens import ARM_HEIGHT, dcb_deck, dcb_specimen, mesh_files
from uel.delamination.steps import Increments
from uel.errors import ElementError, UelError, UsageError
from uel.model.element_types import CONTINUUM
from uel.model.records import IncrementDone
from uel.procedures import run_steps

SPRING = """! a spring of a node to the ground along x: PROPS(1) U + PROPS(2) U**3
      include '{include}'
      if (nrhs == 2) rhs(1,2) = 0
      rhs(1,1) = -props(1)*u(1) - props(2)*u(1)**3
      amatrx(1,1) = props(1) + 3*props(2)*u(1)**2
      energy(2) = props(1)*u(1)**2/2 + props(2)*u(1)**4/4
      svars(1) = u(1)
      end
"""

STEP = """*STEP, INC=20{step}
*STATIC
0.25, 1., 1e-5, 0.25
*CLOAD
END, 1, {load}
*OUTPUT, FIELD
*NODE OUTPUT
U, RF
*ELEMENT OUTPUT
S
*OUTPUT, HISTORY
*ENERGY OUTPUT
ALLSE, ALLAE, ALLWK, ETOTAL
*END STEP
"""


def deck_of(element_type: str, *, load: float = 3.0, step: str = "", section: str = "") -> str:
    """A patch of elements, held at one side, with cubic springs at all other nodes."""
    nodes, elements = patch_of(CONTINUUM[element_type].family.cell)
    labels = range(1, len(nodes) + 1)
    held = [label for label, place in zip(labels, nodes, strict=True) if place[0] == nodes[:, 0].min()]
    free = [label for label in labels if label not in held]
    lines = ["*HEADING", "patch", *node_block(np.array(labels), nodes)]
    lines += element_block(element_type, "PATCH", 1 + np.asarray(elements), 1)
    lines += ["*USER ELEMENT, TYPE=U1, NODES=1, COORDINATES=1, PROPERTIES=2, VARIABLES=1", "1"]
    lines += ["*ELEMENT, TYPE=U1, ELSET=SPRINGS", *(f"{1000 + node}, {node}" for node in free)]
    lines += ["*UEL PROPERTY, ELSET=SPRINGS", "1., 30."]
    lines += ["*NSET, NSET=HELD", *map(str, held), "*NSET, NSET=END", *map(str, free)]
    lines += [section or "*SOLID SECTION, ELSET=PATCH, MATERIAL=ELASTIC\n1."]
    lines += ["*MATERIAL, NAME=ELASTIC", "*ELASTIC", "20., 0.3", "*BOUNDARY", "HELD, 1, 3"]
    return "\n".join(lines) + "\n" + STEP.format(load=load / len(free), step=step)


@pytest.fixture
def spring(tmp_path: Path) -> Path:
    """The user file."""
    file = tmp_path / "spring.f"
    file.write_text(SPRING.format(include=Path(__file__).parents[1] / "uel.inc"))
    return file


def always_called(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LinearShortcut, "_applies", lambda *_: False)


def assert_same(found: uel.Result, expected: uel.Result) -> None:
    """The same increments and iterations; all results to 1e-10 of the largest value."""
    assert [line.total_iterations for line in found.status] == [line.total_iterations for line in expected.status]
    for increment in range(1, len(expected.status) + 1):
        one, other = found.mesh(increment), expected.mesh(increment)
        for name, values in other.point_data.items():
            np.testing.assert_allclose(one.point_data[name], values, rtol=0, atol=1e-10 * (1 + np.abs(values).max()))
        for name, values in other.cell_data.items():
            for part, others in zip(one.cell_data[name], values, strict=True):
                scale = 1 + np.nanmax(np.abs(others), initial=0.0)
                np.testing.assert_allclose(part, others, rtol=0, atol=1e-10 * scale)
    for name, column in expected.history.items():
        np.testing.assert_allclose(found.history[name], column, rtol=0, atol=1e-10 * (1 + np.abs(column).max()))


@pytest.mark.sample(5)
@pytest.mark.parametrize("element_type", CONTINUUM)
def test_built_in_elements_are_called_once_and_at_the_end_of_increments(
    tmp_path, monkeypatch, spring, calls, element_type
):
    deck = tmp_path / "patch.inp"
    deck.write_text(deck_of(element_type))
    found = uel.run(deck, spring, output_dir=tmp_path / "spared")
    increments, iterations = len(found.status), sum(line.total_iterations for line in found.status)
    assert iterations > increments
    # the analysis begins with a pass of its own, an increment with one, and each iteration makes one; another compares
    # the forces with the matrices
    assert calls[element_type] == 1 + 2 + increments
    assert calls["U1"] == 1 + increments + iterations
    always_called(monkeypatch)
    assert_same(found, uel.run(deck, spring, output_dir=tmp_path / "called"))
    assert calls[element_type] == 3 + increments + 1 + increments + iterations


@pytest.mark.parametrize(("kind", "stored"), [("U2", ()), ("U3", ("BOTTOM_FACE", "TOP_FACE"))])
def test_own_quads_are_called_in_each_pass_only_where_u3_reads_their_stress(tmp_path, monkeypatch, calls, kind, stored):
    mesh = two_arms(np.linspace(0.0, 60.0, 31), ARM_HEIGHT, 2, 35.0)
    specimen = dcb_specimen(
        "beam", mesh, Interface(kind, TABLE_2.with_stiffness(1e4), BY_EQUATION_21, consistent=False)
    )
    increments = Increments(0.05, 1e-6, 0.05)
    files = mesh_files("beam", mesh, (4,)) | {"dcb.inp": dcb_deck("DCB", specimen, 1.5, increments, 1)}
    for name, content in files.items():
        (tmp_path / name).write_text(content)
    found = uel.run(tmp_path / "dcb.inp", output_dir=tmp_path / "spared")
    passes = calls[kind]
    groups = {"BOTTOM", "TOP", "BOTTOM_FACE", "TOP_FACE"} if stored else {"BOTTOM", "TOP"}
    spared = len(groups) - len(stored)
    assert calls["U1"] == spared * (3 + len(found.status)) + len(stored) * passes
    assert found.interface()["DAMAGE"].max() > 0.1
    always_called(monkeypatch)
    assert_same(found, uel.run(tmp_path / "dcb.inp", output_dir=tmp_path / "called"))
    assert calls["U1"] == spared * (3 + len(found.status)) + len(stored) * passes + len(groups) * passes


EXCEPTIONS = {
    "large displacements": ("INC=20", "INC=20, NLGEOM"),
    "fields": ("*ELEMENT, TYPE=CPS4", "*NSET, NSET=ALL, GENERATE\n1, 8\n*ELEMENT, TYPE=CPS4"),
    "plasticity": ("20., 0.3\n", "20., 0.3\n*PLASTIC\n1000., 0.\n"),
    "arc length": ("*STATIC\n", "*STATIC, RIKS\n"),
    "inertia": ("*STATIC\n", "*DYNAMIC\n"),
}


@pytest.mark.parametrize("reason", EXCEPTIONS)
def test_elements_are_called_in_each_pass(run_deck, spring, calls, reason):
    """Where their forces may be more than AMATRX times U."""
    text = deck_of("CPS4").replace(*EXCEPTIONS[reason]).replace("20., 0.3\n*BOUND", "20., 0.3\n*DENSITY\n1.\n*BOUND")
    if reason == "fields":
        text = text.replace("*STEP", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*STEP")
    run_deck(text, spring)
    assert calls["CPS4"] == calls["U1"] > 5


def linear_springs(folder: Path, cubic: float) -> Path:
    deck = folder / "patch.inp"
    deck.write_text(deck_of("CPS4").replace("1., 30.", f"1., {cubic}"))
    return deck


def test_elements_that_the_user_says_are_linear(tmp_path, monkeypatch, spring, calls):
    """They are called once, and at the end of each increment, with the state of its start."""
    deck = linear_springs(tmp_path, 0.0)
    found = uel.run(deck, spring, output_dir=tmp_path / "spared", routines=uel.RoutineOptions(linear=["u1"]))
    assert calls["U1"] == calls["CPS4"] - 1 == 2 + len(found.status)
    always_called(monkeypatch)
    assert_same(found, uel.run(deck, spring, output_dir=tmp_path / "called"))


def test_elements_that_are_not_linear_are_named(tmp_path, spring):
    deck = linear_springs(tmp_path, 30.0)
    message = (
        r"element 10\d\d \(type U1\): is not linear: RHS\(1\) is -[\d.]+, its first AMATRX times U gives -[\d.]+ "
        r"\(step 1, increment 1, iteration \d\); run without --linear U1"
    )
    with pytest.raises(ElementError, match=message) as error:
        uel.run(deck, spring, output_dir=tmp_path, routines=uel.RoutineOptions(linear=["U1"]))
    # the softest of the springs is the least wrong: the one that moves most is named
    found = uel.run(deck, spring, output_dir=tmp_path / "called")
    moved = np.abs(found.mesh(1).point_data["U"][:, 0])
    assert error.value.element == 1000 + found.mesh(1).point_data["NODE"][moved.argmax()]


def test_a_type_that_the_deck_does_not_have(tmp_path, spring, capsys):
    deck = linear_springs(tmp_path, 0.0)
    message = "--linear U7: the deck has no elements of this type; its user elements are U1"
    with pytest.raises(UsageError, match=re.escape(message)):
        uel.run(deck, spring, output_dir=tmp_path, routines=uel.RoutineOptions(linear=["U7"]))
    arguments = ["run", str(deck), "--user", str(spring), "--output-dir", str(tmp_path), "--linear"]
    assert main([*arguments, "U1", "--quiet"]) == 0
    assert main([*arguments, "U7"]) == 2
    assert message in capsys.readouterr().err


def test_states_are_brought_up_to_date_when_they_are_read(tmp_path, monkeypatch, calls):
    """Quads between two increments of field output are not called; the energies do not need them."""
    mesh = two_arms(np.linspace(0.0, 60.0, 31), ARM_HEIGHT, 2, 35.0)
    specimen = dcb_specimen("beam", mesh, Interface("U2", TABLE_2.with_stiffness(1e4)))
    increments = Increments(0.05, 1e-6, 0.05)
    files = mesh_files("beam", mesh, (4,)) | {"dcb.inp": dcb_deck("DCB", specimen, 1.5, increments, 7)}
    for name, content in files.items():
        (tmp_path / name).write_text(content)
    found = uel.run(tmp_path / "dcb.inp", output_dir=tmp_path / "spared")
    written = len(found.frames)
    assert 2 < written < len(found.status) / 3
    # in the first increment .dat compares what it is asked for with what there is
    assert calls["U1"] == 2 * (3 + 1 + written)
    always_called(monkeypatch)
    expected = uel.run(tmp_path / "dcb.inp", output_dir=tmp_path / "called")
    for name, column in expected.history.items():
        np.testing.assert_allclose(found.history[name], column, rtol=0, atol=1e-10 * (1 + np.abs(column).max()))
    for name, parts in expected.mesh(-1).cell_data.items():
        for part, others in zip(found.mesh(-1).cell_data[name], parts, strict=True):
            np.testing.assert_allclose(part, others, rtol=0, atol=1e-10 * (1 + np.nanmax(np.abs(others), initial=0.0)))


def test_states_are_not_read_too_late(tmp_path, spring):
    deck = tmp_path / "patch.inp"
    deck.write_text(deck_of("CPS4"))
    model = read_deck(deck)
    library = usersub.load([spring], job="late", output_dir=tmp_path, deck=deck)
    system = LinearShortcut(model.mesh, Contributors.of(model, library), model.equations)
    done = [record.solution for record in run_steps(system, model, library) if isinstance(record, IncrementDone)]
    with pytest.raises(UelError, match="element states have to be read before the next increment ends"):
        len(done[0].elements)
    assert len(done[-1].elements) == len(system.blocks)
    library.close()
