# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the iteration takes of an unsymmetric DDSDDE without UNSYMM, by residuals of a public run of Abaqus."""

import re
from pathlib import Path

import numpy as np
import pytest
from small_decks import body_lines

HERE = Path(__file__).parent
CUBE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
HELD = ["1, 1, 3", "4, 1", "5, 1", "8, 1", "2, 2", "5, 2", "6, 2", "2, 3", "3, 3", "4, 3"]
PULLED = ["2, 1, 1, 1e-7", "3, 1, 1, 1e-7", "6, 1, 1, 1e-7", "7, 1, 1, 1e-7"]

# Abaqus 2023, a C3D8R of unit length, enhanced hourglass control, E 47000, nu 0.35, pulled by 5e-8 in each increment
# (hasan28742/Abaqus-UMAT-Subroutine, SingleElementElasticy.msg): six iterations, then one
RESIDUALS = [3.077e-4, 7.369e-5, -2.405e-5, -5.759e-6, 1.879e-6, 4.500e-7, -2.937e-7]
PRINTED = ("LARGEST RESIDUAL", "AVERAGE")
AVERAGES = [4.117e-4, 3.502e-4, 3.331e-4, 3.171e-4, 3.149e-4, 3.145e-4, 6.288e-4]


def test_matrix_is_the_half_sum_with_the_transpose(run_deck, tmp_path):
    """DDSDDE has its upper triangle alone. The Abaqus User Subroutines Guide, UMAT, has the half sum: by it the
    residual shrinks by 0.28 in each iteration, by the mirrored triangle it would by 0.41, by the diagonal at once."""
    source = tmp_path / "upper.f"
    source.write_text(
        f"      include '{HERE.parent / 'umat.inc'}'\n"
        "      a = props(1)*props(2)/((1+props(2))*(1-2*props(2)))\n"
        "      ddsdde = 0\n"
        "      do i = 1, 3\n"
        "        ddsdde(i,i:3) = a\n"
        "        ddsdde(i,i) = a + props(1)/(1+props(2))\n"
        "        ddsdde(3+i,3+i) = a\n"
        "      end do\n"
        "      stress = stress + matmul(ddsdde, dstran)\n"
        "      end\n"
    )
    lines = body_lines("C3D8R", CUBE, [range(8)])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M, CONTROLS=C", "", "*SECTION CONTROLS, NAME=C, HOURGLASS=ENHANCED"]
    lines += ["*MATERIAL, NAME=M", "*USER MATERIAL, CONSTANTS=2", "47000., 0.35", "*STEP, NLGEOM"]
    lines += ["*STATIC", "1e-6, 2e-6, 1e-6, 1e-6", "*BOUNDARY", *HELD, *PULLED, "*END STEP"]
    run_deck(lines, user=source)
    text = (tmp_path / "deck.msg").read_text()
    found = {what: list(map(float, re.findall(rf"^ {what} FORCE +(\S+)", text, re.MULTILINE))) for what in PRINTED}
    # the last digit that is printed
    assert found["LARGEST RESIDUAL"] == pytest.approx(RESIDUALS, rel=3e-4)
    assert found["AVERAGE"] == pytest.approx(AVERAGES, rel=3e-4)
