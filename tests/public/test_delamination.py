# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Double cantilever beams of NMudunuru/CzmTestKit with the loads that Abaqus 2018 found, unmodified.

C3D8I, COH3D8 with BK, NLGEOM, kinematic couplings with free rotations, *DYNAMIC, APPLICATION=QUASI-STATIC, ten
increments: Examples/ADCB_AbqImp, three decks that differ in the exponent of BK.
"""

import os
from pathlib import Path

import numpy as np
import pytest

import uel

FOLDER = os.environ.get("UEL_PUBLIC", "")
DECKS = Path(FOLDER) / "CzmTestKit" / "Examples" / "ADCB_AbqImp"


def published(point):
    """Displacements and reactions of the loaded node, from the file beside the deck.

    Its first three rows are names, the fourth zeros.
    """
    rows = [line.split(",") for line in (DECKS / point / "ADCB_AbqImp.csv").read_text().splitlines() if line]
    return np.array([[float(row[5]), float(row[2])] for row in rows[4:]]).T


@pytest.mark.long
@pytest.mark.skipif(not DECKS.is_dir(), reason="UEL_PUBLIC names no folder with CzmTestKit")
@pytest.mark.parametrize("point", ["point_00", "point_01", "point_02"])
def test_loads_of_a_delamination(tmp_path, point):
    """Ten increments without a cutback, as Abaqus, and its loads to 1 %.

    Residuals of 5 % of the average force are accepted, which is 0.5 % of the load. In the last increment of point_00
    the crack snaps: its load is left out.
    """
    result = uel.run(DECKS / point / "ADCB_AbqImp.inp", output_dir=tmp_path)
    displacement, load = published(point)
    assert result.completed
    np.testing.assert_allclose(result.history["U3[TOPL]"], displacement, rtol=1e-6)
    compared = slice(0, 9 if point == "point_00" else 10)
    np.testing.assert_allclose(result.history["RF3[TOPL]"][compared], load[compared], rtol=1e-2)
