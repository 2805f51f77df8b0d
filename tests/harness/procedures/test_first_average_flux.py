# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which zeros are terms of the average flux in the first increment: element unknowns, and forces of inertia.

Abaqus 2018 prints 0.186, 0.0720 and 0.0715 in the three iterations of a job with 720 C3D8I and 40 COH3D8 in *DYNAMIC
(NMudunuru/CzmTestKit, Examples/ADCB_AbqImp/point_00), where the sums of all element forces are 10210, 3976 and 3941: of
2 (720 (24 + 13) + 40 24) = 55200 terms they are 0.185, 0.0720 and 0.0714.
"""

import pytest
from small_decks import body_lines

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
MODES = {"C3D8": 0, "C3D8I": 13, "CPE4I": 5, "CPS4I": 4, "CPE4": 0}
TERMS = {"C3D8": 24, "C3D8I": 24, "CPE4I": 8, "CPS4I": 8, "CPE4": 8}
FORCE = 1.3


@pytest.mark.parametrize("element_type", TERMS)
@pytest.mark.parametrize("dynamic", [False, True])
def test_terms(run_deck, tmp_path, element_type, dynamic):
    """A body pulled along 1 by FORCE: its nodes have twice that in all, and nothing else."""
    nodes = CUBE if element_type.startswith("C3D") else SQUARE
    pulled = [k for k, x in enumerate(nodes, start=1) if x[0] == 1]
    others = [k for k, x in enumerate(nodes, start=1) if x[0] == 0]
    lines = body_lines(element_type, nodes, [range(len(nodes))])
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M", "*ELASTIC", "100., 0."]
    lines += ["*DENSITY", "1e-12", "*BOUNDARY", *(f"{k}, 1" for k in others), f"{others[0]}, 2, 3", "2, 2, 3"]
    lines += ["4, 3"] if len(nodes) == 8 else []
    lines += ["*STEP", "*DYNAMIC, APPLICATION=QUASI-STATIC" if dynamic else "*STATIC", "1., 1."]
    lines += ["*CLOAD", *(f"{k}, 1, {FORCE / len(pulled)}" for k in pulled), "*END STEP"]
    run_deck(lines)
    message = (tmp_path / "deck.msg").read_text().splitlines()
    printed = next(line for line in message if line.startswith(" AVERAGE FORCE "))
    terms = (TERMS[element_type] + MODES[element_type]) * (2 if dynamic else 1)
    # printed with three digits
    assert float(printed.split()[2]) == pytest.approx(2 * FORCE / terms, rel=5e-3)
