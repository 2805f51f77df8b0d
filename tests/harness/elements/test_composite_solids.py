# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*SOLID SECTION with STACK DIRECTION."""

import numpy as np
import pytest

import harness

CUBE = """*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 2., 0., 1.
7, 2., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*ORIENTATION, NAME=O
0.8, 0.6, 0., -0.6, 0.8, 0.
*SOLID SECTION, ELSET=E, MATERIAL=M, ORIENTATION=O{}
*MATERIAL, NAME=M
*ELASTIC, TYPE=ENGINEERING CONSTANTS
9e3, 800., 500., 0.2, 0.1, 0.3, 90., 80.
70.
*STEP
*STATIC
*BOUNDARY
1, 1, 3
4, 1
5, 1, 2
8, 1
2, 1, 1, 0.02
3, 1, 1, 0.03
*END STEP
"""


@pytest.mark.parametrize("direction", [1, 2, 3])
def test_stack_direction_without_layers(tmp_path, direction):
    """As Abaqus/CAE writes it for a section whose orientation has a direction of the stack."""
    found = []
    for option in ("", f", STACK DIRECTION={direction}"):
        (tmp_path / "cube.inp").write_text(CUBE.format(option))
        result = harness.run(tmp_path / "cube.inp", output_dir=tmp_path)
        found.append(result.field("U").copy())
    np.testing.assert_array_equal(*found)
