# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""UMAT in trusses: against *ELASTIC, its arguments, its state and energies."""

from pathlib import Path

import numpy as np
import pytest
from truss_decks import LENGTH, PULL, truss

HERE = Path(__file__).parents[1]
FIELD = "*OUTPUT, FIELD\n*ELEMENT OUTPUT\nE, S, SDV\n*END STEP\n"


UMAT = f"""      INCLUDE '{HERE / "umat.inc"}'
%s
      DDSDDE(1,1) = PROPS(1)
      STRESS(1) = STRESS(1) + PROPS(1)*DSTRAN(1)
      SSE = SSE + (STRESS(1) - 0.5*PROPS(1)*DSTRAN(1))*DSTRAN(1)
      END
"""
USER = "*USER MATERIAL, CONSTANTS=1\n1000.\n*DENSITY\n1e-3\n*DEPVAR\n"
HISTORY = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF\n*ENERGY OUTPUT\n*END STEP\n"


@pytest.mark.parametrize("element_type", ["T2D2", "T3D2"])
@pytest.mark.parametrize(
    "step",
    [
        "*STEP\n*STATIC, DIRECT\n0.25, 1.",
        "*STEP, NLGEOM\n*STATIC, DIRECT\n0.25, 1.",
        "*STEP, NLGEOM\n*STATIC, RIKS\n0.25, 1., , 0.25, 1.",
        "*STEP\n*DYNAMIC, DIRECT, NOHAF\n0.25, 1.",
        "*STEP, NLGEOM\n*VISCO\n0.25, 1.",
    ],
)
def test_elasticity_of_umat_in_trusses(run_deck, element_type, step):
    """Forces, energies and iterations of *ELASTIC."""
    load = "\n*CLOAD\n2, 1, 100.\n" if "RIKS" in step else f"\n{PULL}\n"
    results = []
    for material in (USER + "1", "*ELASTIC\n1000., 0.5\n*DENSITY\n1e-3"):
        results.append(run_deck(truss(element_type, material) + step + load + HISTORY, UMAT.replace("%s", "")))
    found, expected = results
    assert max(map(abs, expected.history["RF2[ALL:2]"])) > 10
    for name, values in expected.history.items():
        np.testing.assert_allclose(found.history[name], values, rtol=1e-9, atol=1e-9 * 100, err_msg=name)
    assert [row.total_iterations for row in found.status] == [row.total_iterations for row in expected.status]


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", ["T2D2", "T3D2"])
def test_arguments_of_umat_in_trusses(run_deck, element_type, options):
    """In the second increment: NDI = 1, NSHR = 0; strains are those along the bar, logarithmic with NLGEOM. Deformation
    gradients are those of solids, membranes and shells (User Subroutines Guide, Deformation gradient): here one."""
    ends = [np.hypot(3 + u, 4) for u in (0.3, 0.6)]
    strains = [np.log(end / LENGTH) if options else u * 0.6 / LENGTH for end, u in zip(ends, (0.3, 0.6), strict=True)]
    expressions = {
        "NDI + 10*NSHR + 100*NTENS + 1000*NSTATV": 1 + 100 + 14000,
        "NOEL + 10*NPT + 100*LAYER + 1000*KSPT": 1111,
        "JSTEP(1) + 10*KINC + 100*JSTEP(2) + 1000*JSTEP(3)": 1 + 20 + 200 + 1000 * bool(options),
        "TIME(1) + 10*TIME(2) + 100*DTIME": 55.5,
        "STRAN(1)": strains[0],
        "DSTRAN(1)": strains[1] - strains[0],
        "STRESS(1)": 1000 * strains[0],
        "COORDS(1) + 100*COORDS(2)": (5 + (0.6 if options else 0)) / 2 + 200,
        "CELENT": ends[1] if options else LENGTH,
        "TEMP + 100*DTEMP": 25 + 500,
        "PREDEF(1) + 100*DPRED(1)": 2 + 200,
        "SUM(ABS(DROT)) + SUM(ABS(DFGRD0)) + SUM(ABS(DFGRD1))": 9,
        "NPROPS + PROPS(1)": 1001,
        "ICHAR(CMNAME(1:1))": 77,
    }
    body = "\n".join(f"      STATEV({k}) = {expression}" for k, expression in enumerate(expressions, 1))
    initial = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n*INITIAL CONDITIONS, TYPE=FIELD\nALL, 0."
    data = f"{PULL}\n*TEMPERATURE\nALL, 30.\n*FIELD\nALL, 4."
    text = truss(element_type, f"{USER}{len(expressions)}\n{initial}")
    text += f"*STEP{options}\n*STATIC, DIRECT\n0.5, 1.\n{data}\n{FIELD}"
    found = run_deck(text, UMAT.replace("%s", body))
    for k, (expression, value) in enumerate(expressions.items(), 1):
        assert found.field(f"SDV{k}") == pytest.approx(value, rel=1e-5), expression


PLASTIC = f"""      INCLUDE '{HERE / "umat.inc"}'
      TRIAL = STRESS(1) + PROPS(1)*DSTRAN(1)
      F = ABS(TRIAL) - PROPS(2) - PROPS(3)*STATEV(1)
      DDSDDE(1,1) = PROPS(1)
      IF (F .GT. 0) THEN
        P = F/(PROPS(1) + PROPS(3))
        STATEV(1) = STATEV(1) + P
        TRIAL = TRIAL - SIGN(PROPS(1)*P, TRIAL)
        DDSDDE(1,1) = PROPS(1)*PROPS(3)/(PROPS(1) + PROPS(3))
        SPD = SPD + (PROPS(2) + PROPS(3)*STATEV(1))*P
      END IF
      STRESS(1) = TRIAL
      SSE = 0.5*TRIAL**2/PROPS(1)
      END
"""


@pytest.mark.parametrize("options", ["", ", NLGEOM"])
@pytest.mark.parametrize("element_type", ["T2D2", "T3D2"])
def test_plasticity_of_umat_in_trusses(run_deck, element_type, options):
    """Forces, strain energy and iterations of *PLASTIC with the same line: a load that goes and comes."""
    user = "*USER MATERIAL, CONSTANTS=3\n1000., 10., 100.\n*DEPVAR\n1"
    step = f"*AMPLITUDE, NAME=BACK\n0., 0., 0.5, 1., 1., -1.\n*STEP{options}\n*STATIC\n0.1, 1., 1e-5, 0.1\n"
    step += "*BOUNDARY, AMPLITUDE=BACK\n2, 1, 1, 0.6\n"
    results = []
    for material in (user, "*ELASTIC\n1000., 0.5\n*PLASTIC\n10., 0.\n110., 1."):
        results.append(run_deck(truss(element_type, material) + step + HISTORY, PLASTIC))
    found, expected = results
    assert max(expected.history["ALLPD"]) > 0
    for name in ("RF1[ALL:2]", "RF2[ALL:2]", "ALLSE"):
        np.testing.assert_allclose(found.history[name], expected.history[name], rtol=1e-9, atol=1e-9, err_msg=name)
    assert [row.total_iterations for row in found.status] == [row.total_iterations for row in expected.status]


def test_buckling_under_the_stress_of_umat(run_deck):
    """A bar on a spring across its end turns about its foot at P = k L."""
    text = """*NODE, NSET=ALL
1, 0., 0.
2, 5., 0.
*ELEMENT, TYPE=T2D2, ELSET=E
1, 1, 2
*ELEMENT, TYPE=SPRING1, ELSET=ACROSS
2, 2
*SPRING, ELSET=ACROSS
2
7.
*SOLID SECTION, ELSET=E, MATERIAL=M
2.
*MATERIAL, NAME=M
*USER MATERIAL, CONSTANTS=1
1000.
*BOUNDARY
1, 1, 2
*STEP
*BUCKLE
1
*CLOAD
2, 1, -1.
*END STEP
"""
    found = run_deck(text, UMAT.replace("%s", ""))
    assert found.history["EIGVAL"] == pytest.approx([7.0 * LENGTH])
