# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shells do not depend on the node with which the connectivity of an element begins."""

import numpy as np
import pytest
from shell_decks import ShellDeck

import uel

OUTPUT = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=END\nU"
LOADS = "*BOUNDARY\nFIX, 1, 6\n*CLOAD\nEND, 1, 2.\nEND, 2, 1.\nEND, 3, 0.2"
ROUNDING = 1e-10
"""Of the largest displacement: sums come in another order, and membranes are far stiffer than bending."""


class Turned(ShellDeck):
    """Elements that begin with another of their nodes."""

    start = 0

    def elements(self):
        """Nodes of the elements."""
        return [nodes[self.start :] + nodes[: self.start] for nodes in super().elements()]


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize(("kind", "control"), [("S4", ""), ("S4R", ""), ("S4R", "ENHANCED")])
def test_warped_plate(tmp_path, kind, control, nlgeom):
    """A hyperbolic paraboloid of 2 x 2 irregular quadrilaterals, none of them flat, in all four ways."""

    def found(start):
        section = "*SHELL SECTION, ELSET=SHELL, MATERIAL=M"
        before = ""
        if control:
            before, section = f"*SECTION CONTROLS, NAME=C, HOURGLASS={control}\n", section + ", CONTROLS=C"
        deck = Turned(
            kind,
            *(2, 2),
            lambda a, b: (2 * a, 1.5 * b + 0.2 * a, 0.8 * a * b),
            f"{section}\n0.1",
            "*ELASTIC\n1e4, 0.3",
            before,
            {(1, 1): (0.06, -0.04)},
        )
        deck.start = start
        step = f"*STEP{', NLGEOM' * nlgeom}\n*STATIC\n1., 1.\n{LOADS}\n{OUTPUT}\n*END STEP"
        file = tmp_path / f"plate{start}.inp"
        file.write_text(deck.text(step, {"FIX": deck.side(i=0), "END": deck.side(i=2)}))
        history = uel.run(file, output_dir=tmp_path).history
        return np.array([values[-1] for name, values in history.items() if name.startswith("U")])

    first = found(0)
    for start in (1, 2, 3):
        np.testing.assert_allclose(found(start), first, rtol=0, atol=ROUNDING * np.abs(first).max())
