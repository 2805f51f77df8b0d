# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The manufactured field is a solution, and the elements converge to it at the rates of bilinear elements."""

from pathlib import Path

import numpy as np
import pytest
from manufactured import Field, errors, plate, write_plate_deck

from uel.running.job import run

FIELD = Field()


def test_field_is_in_equilibrium_and_compatible() -> None:
    rng = np.random.default_rng(1)
    x, y = rng.random((2, 20))
    step = 1e-5

    def slopes(function, axis):
        shift = np.array([step, 0.0] if axis == 0 else [0.0, step])
        return (function(x + shift[0], y + shift[1]) - function(x - shift[0], y - shift[1])) / (2.0 * step)

    by_x, by_y = slopes(FIELD.stress, 0), slopes(FIELD.stress, 1)
    scale = np.abs(by_x).max()
    assert np.abs(by_x[:, 0] + by_y[:, 2]).max() < 1e-8 * scale
    assert np.abs(by_x[:, 2] + by_y[:, 1]).max() < 1e-8 * scale
    u_x, u_y = slopes(FIELD.displacement, 0), slopes(FIELD.displacement, 1)
    strain = np.stack([u_x[:, 0], u_y[:, 1], u_x[:, 1] + u_y[:, 0]], axis=-1)
    assert strain == pytest.approx(FIELD.stress(x, y) @ FIELD.compliance, rel=1e-6, abs=1e-10)


@pytest.mark.parametrize("interface", [False, True])
def test_errors_of_the_interpolant(interface: bool) -> None:
    # the nodal interpolant itself has the rates of approximation theory, so `errors` measures what it says
    norms = []
    for n in (8, 16, 32):
        body = plate(n, interface=interface)
        norms.append(errors(body, FIELD, FIELD.displacement(*body.points.T)))
    rates = np.log2(np.array(norms[:-1]) / np.array(norms[1:]))
    assert rates[-1] == pytest.approx([2.0, 1.0], abs=0.05)


@pytest.mark.parametrize(
    ("quads", "interface"), [("U1", None), ("CPS4", None), ("U1", "U2"), ("U1", "U4"), ("CPS4", "U4")]
)
def test_rates_of_convergence(quads: str, interface: str | None, tmp_path: Path) -> None:
    # bilinear elements: order 2 in L2, order 1 in energy; a stiff interface through the middle changes neither
    norms = []
    for n in (8, 16, 32):
        folder = tmp_path / str(n)
        folder.mkdir()
        deck = write_plate_deck(folder, n, FIELD, quads=quads, interface=interface)
        result = run(deck, output_dir=folder)
        body = plate(n, interface=interface is not None)
        norms.append(errors(body, FIELD, result.field("U")[:, :2]))
    rates = np.log2(np.array(norms[:-1]) / np.array(norms[1:]))
    assert rates[-1] == pytest.approx([2.0, 1.0], abs=0.08)
    assert norms[-1][0] < 1e-3
