# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial of a circular delamination in meshes of Gmsh: its commands, its closed form and its table."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import guide
import numpy as np
import pytest

from uel.delamination.keywords import element_block, node_block, node_set, text
from uel.delamination.solid_blocks import block
from uel.output import Result
from uel.paper import literature
from uel.running.job import run

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "circle.md"
REQUIRED = 0.03
"""Relative deviation of the load from the closed form."""
MESHES = ("tetrahedra", "bricks")


def test_closed_form_of_the_rim() -> None:
    """Compare with Timoshenko's thin plates; the first term in h/a, -(1 - nu) chi, is theirs by hand."""
    thin = literature.circle_load()
    assert literature.circle_load_with_rim(1e6) == pytest.approx(thin, rel=1e-5)
    share = 1.0 - literature.circle_load_with_rim(1e4) / thin
    assert share == pytest.approx(0.7 * 0.6728 * literature.CIRCLE_ARM / 1e4, rel=1e-3)


def test_constant_of_the_rim(tmp_path: Path) -> None:
    """From the compliance of one arm of a double cantilever beam, dC/da = 12 (a + chi h)^2/(E h^3), of two lengths.

    The error of the released energy falls with the size of the elements: twice the finer less the coarser.
    """

    def compliance(crack: float, rows: int) -> float:
        grid = block("CPS8", [np.linspace(0.0, 16.0, 16 * rows + 1), np.linspace(0.0, 1.0, rows + 1)])
        labels, (x, y) = np.arange(1, len(grid.nodes) + 1), grid.nodes.T
        lines = node_block(labels, grid.nodes) + element_block("CPS8", "ARM", labels[grid.elements], 1)
        lines += node_set("BONDED", labels[(y < 1e-9) & (x > crack - 1e-9)]) + node_set(
            "FIXED", labels[x > 16.0 - 1e-9]
        )
        lines += node_set("LOADED", labels[(x < 1e-9) & np.isclose(y, 0.5)])
        lines += ["*SOLID SECTION, ELSET=ARM, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", "1., 0.3"]
        lines += ["*BOUNDARY", "BONDED, 2", "FIXED, 1", "*STEP", "*STATIC", "*CLOAD", "LOADED, 2, 1."]
        lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=LOADED", "U2", "*END STEP"]
        deck = tmp_path / f"arm{rows}_{crack:.0f}.inp"
        deck.write_text(text(lines))
        return float(run(deck, output_dir=tmp_path, quiet=True).history["U2[LOADED]"][-1])

    found = []
    for rows in (6, 12):
        grown = compliance(9.0, rows) - compliance(7.0, rows)
        # 4 ((9 + chi)^3 - (7 + chi)^3) = 24 chi^2 + 384 chi + 1544
        found.append(np.roots([24.0, 384.0, 1544.0 - grown]).max())
    assert 2.0 * found[1] - found[0] == pytest.approx(literature.RIM, rel=5e-3)


def test_closed_form_and_the_circle_of_bricks() -> None:
    """The other problem, of the same plates, has radii and loads on its page, of which a test compares the last one."""
    rows = re.findall(
        r"^\| (\d\d\.\d) \| (\d{3}\.\d) \|", (PAGE.parents[1] / "abaqus_inputs/circle/README.md").read_text(), re.M
    )
    assert len(rows) == 5
    for radius, load in rows:
        assert float(load) == pytest.approx(literature.circle_load_with_rim(float(radius)), rel=0.01)


def grown(result: Result) -> list[tuple[float, float]]:
    """Radius (mm) by the energy spent, and load of the whole plates (N), where the delamination grows."""
    history = result.history
    load = 4.0 * sum(values for name, values in history.items() if name.startswith("RF3[TOP"))
    radius = np.sqrt(literature.CIRCLE_CRACK**2 + 4.0 * history["ALLPD"] / (np.pi * literature.CIRCLE_TOUGHNESS))
    # the process zone has formed
    running = radius > literature.CIRCLE_CRACK + 1.0
    return list(zip(radius[running].tolist(), load[running].tolist(), strict=True))


def page() -> dict[str, list[tuple[float, float, float]]]:
    """Radius, load and the closed form's of the rows of the page, by mesh."""
    rows = re.findall(
        r"^\| (\w+) \| (\d\d\.\d\d) \| (\d{3}\.\d) \| (\d{3}\.\d) \|", PAGE.read_text("utf-8"), re.MULTILINE
    )
    return {mesh: [tuple(map(float, row[1:])) for row in rows if row[0] == mesh] for mesh in MESHES}


@pytest.mark.parametrize("mesh", MESHES)
def test_table_of_the_page(mesh: str) -> None:
    rows = page()[mesh]
    assert len(rows) >= 2
    for radius, load, closed in rows:
        assert closed == pytest.approx(literature.circle_load_with_rim(radius), abs=0.1)
        # as the page says
        assert load == pytest.approx(closed, rel=0.02)


@pytest.mark.long
@pytest.mark.parametrize("mesh", MESHES)
def test_commands_of_the_page(mesh: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another version of Gmsh makes another mesh: loads to 2 %, the waves as the front passes the elements."""
    pytest.importorskip("gmsh", exc_type=ImportError)
    monkeypatch.chdir(tmp_path)
    guide.write_files(PAGE)
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    commands = [line for line in re.findall(r"^\$ (.*)$", PAGE.read_text("utf-8"), re.MULTILINE) if mesh in line]
    assert len(commands) == 4
    for command in commands:
        subprocess.run(shlex.split(command), check=True, capture_output=True, env=environment)
    found = grown(Result(tmp_path / mesh))
    # a run with cutbacks has more
    assert len(found) >= 2
    for radius, load in found:
        assert load == pytest.approx(literature.circle_load_with_rim(radius), rel=REQUIRED)
    front = np.genfromtxt(f"{mesh}_front.csv", delimiter=",", names=True)
    last = front[front["increment"] == front["increment"][-1]]
    radii = np.hypot(last["X"], last["Y"])
    np.testing.assert_allclose(radii, radii.mean(), rtol=5e-3)
    assert radii.mean() == pytest.approx(found[-1][0], rel=0.01)
    released = last["GI"] + last["GII"] + last["GIII"]
    np.testing.assert_allclose(released, literature.CIRCLE_TOUGHNESS, rtol=REQUIRED)
    # regression
    mean = np.mean([load for _, load in found])
    assert mean == pytest.approx(np.mean([load for _, load, _ in page()[mesh]]), rel=0.02)
