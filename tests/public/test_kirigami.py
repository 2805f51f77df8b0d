# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The independent host of the kirigami rows, on a sheet of two elements, and its figures where the deck is there."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import kirigami
import measure
import numpy as np
import pytest
from scipy.optimize import minimize

FOLDER = os.environ.get("UEL_PUBLIC", "")

KIRIGAMI = """\
*Heading
** a sheet of two elements with a slanting side between them
*Node
1, 0., 0.
2, 0.4, 0.
3, 1., 0.
4, 0., 1.
5, 0.6, 1.
6, 1., 1.
7, 0.2, 0.
8, 0.5, 0.5
9, 0.3, 1.
10, 0., 0.5
11, 0.7, 0.
12, 1., 0.5
13, 0.8, 1.
*User element, type=U1, nodes=8, coordinates=2, properties=5, variables=1
1, 2, 11
*Element, type=U1
1, 1, 2, 5, 4, 7, 8, 9, 10
2, 2, 3, 6, 5, 11, 12, 13, 8
*Nset, nset=all, generate
1, 13, 1
*Nset, nset=left
1, 4, 10
*Nset, nset=corner
1
*Nset, nset=right
3, 6
12
*Uel property, elset=all
2., 0.1, 0.05, -0.9, 0.7
*Boundary
left, 1, 1
corner, 1, 2
right, 1, 1, 0.2
"""


@pytest.fixture
def sheet(tmp_path):
    (tmp_path / "sheet.inp").write_text(KIRIGAMI)
    return kirigami.read(tmp_path / "sheet.inp")


def test_host_of_a_uniform_state(sheet):
    """A sheet free at the sides: the stretch across and the angle make the energy of one point smallest."""

    def point(across, angle, along=1.2):
        return kirigami.energy(np.array([along, 0, 0, across, angle, 0, 0]), sheet.properties)

    found = minimize(lambda x: point(*x), [1.1, 0.2], method="BFGS", options={"gtol": 1e-9})
    across, angle = found.x
    assert angle > 0.1
    host = kirigami.Host(sheet)
    values = host.solve(sheet.prescribed)
    assert host.energy(values) == pytest.approx(found.fun, rel=1e-10)
    assert values[sheet.dofs("all", 11)] == pytest.approx(angle, rel=1e-5)
    assert values[sheet.dofs("all", 2)] == pytest.approx((across - 1) * sheet.coordinates[:, 1], abs=1e-5)
    force = (point(across, angle, 1.2 + 1e-5) - point(across, angle, 1.2 - 1e-5)) / 2e-5
    assert host.forces(values)[sheet.dofs("right", 1)].sum() == pytest.approx(force, rel=1e-5)


def test_host_of_a_state_that_is_not_uniform(sheet):
    """The force on a pulled node is the derivative of the energy with respect to its displacement."""
    host = kirigami.Host(sheet)
    (pulled,) = (dof for dof in sheet.dofs("right", 1) if sheet.coordinates[dof // 3, 1] == 0.5)
    held = {dof: value for dof, value in sheet.prescribed.items() if dof not in sheet.dofs("right", 1)}

    def solved(pull):
        return host.solve(held | {int(pulled): pull})

    change = host.energy(solved(0.2001)) - host.energy(solved(0.1999))
    values = solved(0.2)
    assert np.ptp(values[sheet.dofs("all", 11)]) > 0.01
    assert host.forces(values)[pulled] == pytest.approx(change / 2e-4, rel=1e-6)


def test_mechanism_costs_no_energy(sheet):
    """The panels turn by the angle, and the sheet as a whole by another."""
    host = kirigami.Host(replace(sheet, properties=sheet.properties * [1, 0, 1, 1, 1]))
    angle, turn = 0.3, 0.5
    stretch = np.diag([np.cos(angle) + 0.9 * np.sin(angle), np.cos(angle) + 0.7 * np.sin(angle)])
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    values = np.full((13, 3), angle)
    values[:, :2] = sheet.coordinates @ (rotation @ stretch - np.eye(2)).T
    assert host.energy(values.ravel()) == pytest.approx(0, abs=1e-14)
    assert np.abs(host.forces(values.ravel())).max() < 1e-14


def test_host_without_equilibrium(sheet):
    with pytest.raises(RuntimeError, match="no equilibrium at step 1 of 1"):
        kirigami.Host(sheet).solve(sheet.prescribed, steps=1, tolerance=0.0)


def test_figures_and_the_manifest(monkeypatch, capsys):
    """Exit code 1 where the manifest has another figure."""
    figures = {name: measure.rows()[name]["expected"] for name in ("kirigami", "kirigami-angle")}
    monkeypatch.setattr(sys, "argv", ["kirigami.py", "folder"])
    monkeypatch.setattr(kirigami, "figures", lambda deck: figures)
    assert kirigami.main() == 0
    figures["kirigami"] *= 1.001
    assert kirigami.main() == 1
    assert "kirigami 0.021303878 manifest: 0.021282595" in capsys.readouterr().out


@pytest.mark.long
@pytest.mark.skipif(not FOLDER, reason="UEL_PUBLIC names no folder of public user elements")
def test_figures_are_made_again():
    absent = measure.missing(Path(FOLDER), measure.rows()["kirigami"])
    if absent:
        pytest.skip(f"{FOLDER} has no {absent[0]}")
    result = subprocess.run([sys.executable, kirigami.__file__, FOLDER], capture_output=True, check=False)
    assert result.returncode == 0, result.stdout
