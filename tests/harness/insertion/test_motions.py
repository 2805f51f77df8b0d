# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stabilised interfaces between unlike plies in *FREQUENCY, *STEADY STATE DYNAMICS and *DYNAMIC.

A laminate that the elements hold together is the bonded mesh but for what a finite mesh leaves of the gap, which
vanishes with the square of the element size (A. Hansbo, P. Hansbo, Computer Methods in Applied Mechanics and
Engineering 191 (2002) 5537). So each quantity is compared with that of the same mesh without interface, on two meshes.
"""

import numpy as np
import pytest
from solid_grids import grid, inserted

import uel
from uel.model.element_types import CONTINUUM

LENGTH, HEIGHT, WIDTH = 10.0, 1.0, 1.0
DENSITY = 1.6e-9
# along the fibres 120,000, across 10,500 MPa; below they run out of the plane
PLIES = {
    "LOW": "10500., 10500., 120000., 0.51, 0.02625, 0.02625, 3480., 5250., 5250.",
    "HIGH": "120000., 10500., 10500., 0.3, 0.3, 0.51, 5250., 5250., 3480.",
}
STRONG = ("SIGMAMAX=1e6", "TAUMAX=1e6", "GIC=1e9", "GIIC=1e9")
KINDS = ("CPS4I", "CPE4I", "CPS8R", "C3D8I", "C3D20R")
# its end is held in its direction: by about an eighth of the strain of its buckling, pi^2 I/(A (L/2)^2)
PRESSED = ["*STEP, NLGEOM", "*STATIC", "*BOUNDARY", "END, 1, 1, -0.01", "*END STEP"]
END = ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=TIP", "U", "*END STEP"]


@pytest.fixture
def both(tmp_path):
    """Histories of a cantilever with its plies sharing nodes and with stabilised elements between them."""

    def both(kind, refinement, steps):
        dimension = CONTINUUM[kind].family.dimension
        coarse = 2 if CONTINUUM[kind].family.nodes > 2**dimension else 1
        counts = tuple(count * refinement // coarse for count in (10, 1, 2))
        sizes = (LENGTH, WIDTH, HEIGHT)
        mesh = grid(kind, counts if dimension == 3 else counts[::2], sizes if dimension == 3 else sizes[::2])
        low = mesh.cell[:, -1] < mesh.cell[:, -1].max() / 2
        mesh.sets = {"LOW": low, "HIGH": ~low}
        tip = mesh.end(0, 1) & mesh.end(dimension - 1, 1) & (mesh.end(1, 0) if dimension == 3 else True)
        mesh.node_sets = {"ROOT": mesh.end(0, 0), "END": mesh.end(0, 1), "TIP": tip}
        lines = mesh.lines()
        for name, constants in PLIES.items():
            values = constants.rsplit(", ", 1)
            lines += [f"*ORIENTATION, NAME=O{name}", "1., 0., 0., 0., 1., 0.", "1, 0."] if dimension == 3 else []
            lines += [
                f"*SOLID SECTION, ELSET={name}, MATERIAL={name}" + (f", ORIENTATION=O{name}" if dimension == 3 else ""),
                "1.",
                f"*MATERIAL, NAME={name}",
                "*ELASTIC, TYPE=ENGINEERING CONSTANTS",
                values[0],
                values[1],
                "*DENSITY",
                f"{DENSITY}",
            ]
        lines += ["*BOUNDARY", f"ROOT, 1, {dimension}", *steps, ""]
        whole, cut = tmp_path / f"whole_{refinement}.inp", tmp_path / f"cut_{refinement}.inp"
        whole.write_text("\n".join(lines))
        inserted(whole, cut, STRONG, between=[("LOW", "HIGH")])
        return [uel.run(path, output_dir=tmp_path, quiet=True).history for path in (whole, cut)]

    return both


def differences(both, kind, steps, measure):
    """Relative differences of the laminate with an interface from the bonded one, on meshes of h and h/2."""
    found = []
    for refinement in (2, 4):
        bonded, cut = (measure(history) for history in both(kind, refinement, steps))
        found.append(float(np.max(np.abs(cut / bonded - 1))))
    return found


def assert_bonded(errors):
    """Half a per cent at most on the finer mesh, and a third of what it is on the coarser one."""
    assert errors[1] < min(0.005, errors[0] / 3)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("base", [[], PRESSED], ids=["at rest", "pressed"])
def test_frequencies(both, kind, base):
    """At rest, and about the state of a pressed column."""
    steps = [*base, "*STEP", "*FREQUENCY", "4", *END]
    assert_bonded(differences(both, kind, steps, lambda history: history["EIGFREQ"][-4:]))


@pytest.mark.parametrize("kind", KINDS)
def test_steady_state_response(both, kind):
    """The range holds no frequency of the cantilever: a resonance makes any difference large."""
    dimension = CONTINUUM[kind].family.dimension
    sweep = ["*STEP", "*STEADY STATE DYNAMICS, DIRECT", "100., 5000., 5, 1.", "*CLOAD", f"TIP, {dimension}, 1.", *END]
    assert_bonded(differences(both, kind, sweep, lambda history: history[f"U{dimension}[TIP]"]))


@pytest.mark.parametrize("kind", KINDS)
def test_motion_after_release(both, kind):
    """Bent by a force and let go: the same motion over a tenth of the first period, and the energy stays."""
    dimension = CONTINUUM[kind].family.dimension
    steps = [
        *("*STEP", "*STATIC", "*CLOAD", f"TIP, {dimension}, 1.", *END),
        *("*STEP", "*DYNAMIC, ALPHA=0., DIRECT", "1e-6, 2e-5", "*CLOAD, OP=NEW"),
        *(*END[:-1], "*ENERGY OUTPUT", "ALLKE, ALLSE", END[-1]),
    ]
    energies = []

    def deflections(history):
        energies.append((history["ALLKE"] + history["ALLSE"])[1:])
        return history[f"U{dimension}[TIP]"][1:]

    assert_bonded(differences(both, kind, steps, deflections))
    for energy in energies:
        assert np.ptp(energy) < 1e-6 * energy[0]
