# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Matrices that stand for linear elements: their product is the RHS of the element, for each type and elastic law."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cells import patch_of
from small_decks import body_lines

import uel
from uel import usersub
from uel.assembly import Contributors, LinearShortcut
from uel.deck import read_deck
from uel.elements import Call, ElementBlock, Flags
from uel.model.element_types import BEAM, CONTINUUM, CONTINUUM_SHELL, GENERALISED, HYBRID, MEMBRANE, SHELL

TYPES = {**CONTINUUM, **GENERALISED, **SHELL, **CONTINUUM_SHELL, **MEMBRANE, **BEAM}
SOLID_LAWS = {
    "isotropic": "*ELASTIC\n1000., 0.3",
    "nearly incompressible": "*ELASTIC\n1000., 0.4999",
    "incompressible": "*ELASTIC\n1000., 0.5",
    # unidirectional carbon fibres
    "orthotropic": "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n138000., 10500., 10500., .3, .3, .45, 6300., 6300.\n3500.",
    "anisotropic": "*ELASTIC, TYPE=ANISOTROPIC\n40., 12., 30., 8., 9., 25., 2., -1.\n1., 10., 1., 0.5, -2., 1., 12., "
    "0.3\n1., 2., 0.7, -1., 9.",
}
TURNED = "*ORIENTATION, NAME=O\n1., .4, .1, -.3, 1., .2\n3, 20."
IN_PLANE = "*ORIENTATION, NAME=O\n1., .4, 0., -.3, 1., 0.\n3, 20."
CALL = Call(Flags(1), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0)
INCOMPRESSIBLE = [name for name in HYBRID if not HYBRID[name].incompatible and name in CONTINUUM]
CASES = [
    (name, law)
    for name in TYPES
    for law in SOLID_LAWS
    if (law != "incompressible" or name in INCOMPRESSIBLE)
    and (law in ("isotropic", "nearly incompressible") or name not in BEAM)
]


def mesh_of(element_type: str) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and elements of a patch: a plane one, a brick, a curved surface, or three beams."""
    kind = TYPES[element_type]
    if element_type in BEAM:
        ends = np.arange(0, 3 * (kind.family.nodes - 1), kind.family.nodes - 1)
        nodes = np.random.default_rng(1).uniform(0, 1, (7, kind.dimension))
        return nodes, ends[:, None] + np.arange(kind.family.nodes)
    nodes, elements = patch_of(kind.family.cell)
    if nodes.shape[1] < kind.dimension:
        nodes = np.column_stack([nodes, 0.2 * nodes.prod(axis=1)])
    if element_type in CONTINUUM and kind.axisymmetric:
        nodes[:, 0] += 1.0
    return nodes, elements


def section_of(element_type: str) -> list[str]:
    """Section with an orientation, where the type has one."""
    kind = TYPES[element_type]
    if element_type in BEAM:
        return ["*BEAM SECTION, SECTION=RECT, ELSET=BODY, MATERIAL=M", "0.1, 0.2", "0., 0., -1."]
    if element_type in GENERALISED:
        nodes = ["*NODE, NSET=REF", "1000, 0.4, 0.3"]
        return [*nodes, IN_PLANE, "*SOLID SECTION, ELSET=BODY, MATERIAL=M, ORIENTATION=O, REF NODE=REF", "0.3"]
    if element_type in CONTINUUM:
        turned = TURNED if kind.dimension == 3 else IN_PLANE
        return [turned, "*SOLID SECTION, ELSET=BODY, MATERIAL=M, ORIENTATION=O", "0.3"]
    return [IN_PLANE, f"*{kind.section}, ELSET=BODY, MATERIAL=M, ORIENTATION=O", "0.3"]


def deck_of(element_type: str, law: str, *, step: str = "") -> str:
    """A patch, held at its first nodes and pulled at the last one; step: more lines there."""
    nodes, elements = mesh_of(element_type)
    lines = [*body_lines(element_type, nodes, elements), *section_of(element_type)]
    lines += ["*MATERIAL, NAME=M", SOLID_LAWS[law], "*STEP", "*STATIC", "1., 1."]
    lines += ["*CONTROLS, PARAMETERS=FIELD", "1e-9, 1.", *([step] if step else []), "*BOUNDARY"]
    lines += [f"{node}, 1, {6 if element_type in SHELL or element_type in BEAM else 3}" for node in (1, 2, 3)]
    lines += ["1000, 3, 5"] if element_type in GENERALISED else []
    lines += ["*CLOAD", f"{len(nodes)}, 2, 2.", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


@pytest.mark.sample(7)
@pytest.mark.parametrize(("element_type", "law"), CASES)
def test_matrix_times_displacements_is_the_force_of_the_element(tmp_path, monkeypatch, calls, element_type, law):
    """In elements of all types, which are not called again once their matrices are known."""
    deck = tmp_path / "patch.inp"
    deck.write_text(deck_of(element_type, law))
    model = read_deck(deck)
    library = usersub.load(None, job="patch", output_dir=tmp_path)
    system = LinearShortcut(model.mesh, Contributors.of(model, library), model.equations)
    zero = np.zeros(len(system))
    first = system.evaluate(CALL, zero, zero)
    matrix = first.data.copy()
    calls.clear()
    u = np.random.default_rng(2).standard_normal(len(system))
    spared = system.evaluate(CALL, u, u).residual.copy()
    assert not calls
    monkeypatch.setattr(LinearShortcut, "_applies", lambda *_: False)
    called = system.evaluate(CALL, u, u)
    assert calls[element_type] == 1
    scale = np.abs(called.residual).max()
    np.testing.assert_allclose(spared, called.residual, rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(called.data, matrix, rtol=0, atol=1e-10 * np.abs(matrix).max())


@pytest.mark.parametrize("element_type", [name for name in HYBRID if name in TYPES])
def test_anisotropic_hybrid_elements_are_linear(tmp_path, element_type):
    """A zero temperature has them called: the same displacements, and one iteration for a tolerance of 1e-9."""
    found = {}
    for name, step in {"spared": "", "called": "*TEMPERATURE\nALL, 0."}.items():
        deck = tmp_path / f"{name}.inp"
        deck.write_text(deck_of(element_type, "orthotropic", step=step))
        found[name] = uel.run(deck, output_dir=tmp_path)
    for result in found.values():
        assert [line.total_iterations for line in result.status] == [1]
    for name, column in found["called"].history.items():
        scale = max(np.abs(values).max() for values in found["called"].history.values())
        np.testing.assert_allclose(found["spared"].history[name], column, rtol=0, atol=1e-9 * scale)


def test_elements_whose_matrix_is_not_the_derivative_are_called(tmp_path, monkeypatch, calls):
    """Here it is 1 % too large in one entry of one element; all of them then converge as if there were no short cut."""
    evaluate_unassembled = ElementBlock.evaluate_unassembled

    def wrong(self, *arguments):
        report, matrices = evaluate_unassembled(self, *arguments)
        matrices[-1, 0, 0] *= 1.01
        return report, matrices

    monkeypatch.setattr(ElementBlock, "evaluate_unassembled", wrong)
    deck = tmp_path / "patch.inp"
    deck.write_text(deck_of("CPE4", "isotropic"))
    found = uel.run(deck, output_dir=tmp_path)
    passes = calls["CPE4"]
    monkeypatch.setattr(LinearShortcut, "_applies", lambda *_: False)
    expected = uel.run(deck, output_dir=tmp_path / "called")
    assert found.status[-1].total_iterations > 1
    # the pass that begins the analysis, that of the matrices, that of the comparison, and one for each iteration
    assert passes == 3 + found.status[-1].total_iterations
    for name, column in expected.history.items():
        np.testing.assert_allclose(found.history[name], column, rtol=0, atol=1e-8)
