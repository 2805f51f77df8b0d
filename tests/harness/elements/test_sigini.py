# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*INITIAL CONDITIONS, TYPE=STRESS, USER: SIGINI in columns of soil whose stress carries their own weight."""

import re
from itertools import pairwise, product

import numpy as np
import pytest

from uel.errors import DeckError, KernelError

HEIGHTS, WEIGHT, AT_REST = (0.0, 1.0, 2.5, 4.0), 20.0, 0.4
ELASTIC = "*ELASTIC\n1000., 0.25"
TYPES = ("CPE4", "CPE8R", "CPE4R", "C3D8", "C3D20R", "C3D8I", "CPE4T")
SIGINI = """      SUBROUTINE SIGINI(SIGMA,COORDS,NTENS,NCRDS,NOEL,NPT,LAYER,
     1 KSPT,LREBAR,NAMES)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION SIGMA(NTENS),COORDS(NCRDS)
      CHARACTER NAMES(2)*80
{}
      END
"""
GEOSTATIC = """      SIGMA(2) = -20.D0*(4.D0 - COORDS(2))
      SIGMA(1) = 0.4D0*SIGMA(2)
      SIGMA(3) = SIGMA(1)"""
BY_WEIGHT = SIGINI.format(GEOSTATIC)
UMAT = """      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,RPL,DDSDDT,
     1 DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,
     2 CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     3 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,JSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),DDSDDE(NTENS,NTENS),DSTRAN(NTENS)
      DO K = 1, NTENS
        DDSDDE(K,K) = 1.D3
        STRESS(K) = STRESS(K) + 1.D3*DSTRAN(K)
      END DO
      END
"""


def column(type):
    """Nodes by their numbers, and elements one above the other; corners first, then the middles of edges."""
    plane = not type.startswith("C3D")
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners = [(x, y, 0) for x, y in square] if plane else [(x, y, z) for z in (0, 1) for x, y in square]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0)]
    if not plane:
        edges += [(4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    quadratic = ("8R" in type and plane) or "20" in type
    cell = corners + [tuple(np.add(corners[a], corners[b]) / 2) for a, b in edges if quadratic]
    numbers, elements = {}, []
    for low, high in pairwise(HEIGHTS):
        places = [(x, low + (high - low) * y, z) for x, y, z in cell]
        elements.append([numbers.setdefault(place, len(numbers) + 1) for place in places])
    return numbers, elements


def deck(type, *, material=ELASTIC, conditions="", more="", step="", static="1., 1."):
    numbers, elements = column(type)
    dimension = 3 if type.startswith("C3D") else 2
    lines = ["*NODE, NSET=ALL", *(f"{k}, {x}, {y}, {z}" for (x, y, z), k in numbers.items())]
    lines += ["*NSET, NSET=LOW", *(f"{k}," for (_, y, _), k in numbers.items() if y == 0)]
    lines += [f"*ELEMENT, TYPE={type}, ELSET=SOIL"]
    for k, nodes in enumerate(elements):
        row = [str(n) for n in (k + 1, *nodes)]
        lines += [
            ", ".join(row[:15]) + ("," if len(row) > 15 else ""),
            *([", ".join(row[15:])] if len(row) > 15 else []),
        ]
    lines += ["*SOLID SECTION, ELSET=SOIL, MATERIAL=SOIL", "1.", "*MATERIAL, NAME=SOIL", material]
    if type.endswith("T"):
        lines += ["*CONDUCTIVITY", "1."]
    lines += [f"*INITIAL CONDITIONS, TYPE=STRESS, USER{conditions}", more, f"*STEP{step}"]
    lines += [*(["*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE"] if type.endswith("T") else ["*STATIC"]), static]
    lines += ["*BOUNDARY", "ALL, 1", "LOW, 2", *(["ALL, 3"] if dimension == 3 else [])]
    lines += ["ALL, 11"] if type.endswith("T") else []
    lines += ["*DLOAD", f"SOIL, BY, {-WEIGHT}", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U2", "*OUTPUT, FIELD"]
    return "\n".join([line for line in lines if line] + ["*ELEMENT OUTPUT", "S", "*END STEP", ""])


@pytest.mark.parametrize("conditions", ["", ", UNBALANCED STRESS=STEP"])
@pytest.mark.parametrize("type", TYPES)
def test_the_stress_of_its_weight_keeps_soil_at_rest(run_deck, type, conditions):
    """S22 = -w (H - y) is in equilibrium with the body force, whatever the lateral stress between fixed sides."""
    result = run_deck(deck(type, conditions=conditions), BY_WEIGHT)
    settled = WEIGHT * HEIGHTS[-1] ** 2 / (2 * 1200.0)  # without initial stress: E (1 - nu)/((1 + nu)(1 - 2 nu)) = 1200
    moved = [values[-1] for name, values in result.history.items() if name.startswith("U2")]
    np.testing.assert_allclose(moved, 0.0, atol=1e-9 * settled)
    bottom, middle, top = np.array([result.field(f"S{k}{k}") for k in (1, 2, 3)]).T.reshape(3, -1, 3).mean(axis=1)
    for stress, (low, high) in zip((bottom, middle, top), pairwise(HEIGHTS), strict=True):
        vertical = -WEIGHT * (HEIGHTS[-1] - (low + high) / 2)
        assert stress == pytest.approx([AT_REST * vertical, vertical, AT_REST * vertical], rel=1e-9)


def test_umat_begins_with_the_stress(run_deck):
    result = run_deck(deck("C3D8", material="*USER MATERIAL, CONSTANTS=0"), SIGINI.format(GEOSTATIC) + UMAT)
    moved = [values[-1] for name, values in result.history.items() if name.startswith("U2")]
    np.testing.assert_allclose(moved, 0.0, atol=1e-10)


@pytest.mark.parametrize(
    "step", [", NLGEOM\n*STATIC\n1., 1.", "\n*STATIC\n1., 1.", "\n*DYNAMIC\n1., 1.", ", PERTURBATION\n*STATIC"]
)
@pytest.mark.parametrize("type", ["CPS4", "CPE4R", "C3D8"])
def test_arguments_of_sigini(run_deck, tmp_path, type, step):
    """Each argument at each point, once, before the first step, after UEXTERNALDB has begun the analysis."""
    body = """      WRITE(6,'(A,7I4,2(A,1X),9F10.5)') 'SIGINI ', NTENS, NCRDS, NOEL,
     1 NPT, LAYER, KSPT, LREBAR, ' '//TRIM(NAMES(2)), '<'//
     2 TRIM(NAMES(1))//'>', COORDS, SIGMA"""
    database = """      SUBROUTINE UEXTERNALDB(LOP,LRESTART,TIME,DTIME,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION TIME(2)
      WRITE(6,'(A,I2)') 'SIGINI after', LOP
      END
"""
    text = deck(type, material=f"{ELASTIC}\n*DENSITY\n1.")
    text = re.sub(r"\*STEP\n\*STATIC\n1., 1.", f"*STEP{step}", text)
    run_deck(text, SIGINI.format(body) + database)
    dat = (tmp_path / "deck.dat").read_text().splitlines()
    printed = [line.split()[1:] for line in dat if line.lstrip().startswith("SIGINI ")]
    assert printed[0] == ["after", "0"]
    points = {"CPS4": 4, "CPE4R": 1, "C3D8": 8}[type]
    tensor, dimension = {"CPS4": (3, 2), "CPE4R": (4, 2), "C3D8": (6, 3)}[type]
    calls, rest = printed[1 : 1 + 3 * points], printed[1 + 3 * points :]
    assert all(line[0] == "after" for line in rest)
    places = np.array([0.5]) if points == 1 else np.array([0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5])
    expected = product(range(1, 4), places[: 1 if dimension == 2 else 2], places, places)
    for k, (call, (element, z, y, x)) in enumerate(zip(calls, expected, strict=True)):
        assert call[:7] == [str(n) for n in (tensor, dimension, element, k % points + 1, 1, 1, 0)]
        assert call[7:9] == [type, "<>"]
        low, high = HEIGHTS[element - 1 : element + 1]
        coords = [x, low + (high - low) * y, z][:dimension]
        assert [float(number) for number in call[9:]] == pytest.approx([*coords, *[0.0] * tensor], abs=1e-5)


def test_elements_without_material_points_are_passed_over(run_deck):
    """Springs, masses and user elements have no stress; only the soil asks."""
    more = "*ELEMENT, TYPE=MASS, ELSET=M\n90, 1\n*MASS, ELSET=M\n1.\n*ELEMENT, TYPE=SPRING1, ELSET=K\n91, 1\n"
    result = run_deck(deck("CPE4", more=more + "*SPRING, ELSET=K\n2\n1."), BY_WEIGHT)
    assert result.completed


def test_sigini_writes_outside_sigma(run_deck):
    result = run_deck(deck("CPE4"), SIGINI.format(GEOSTATIC + "\n      SIGMA(5) = 1"))
    message = "element 1: SIGINI writes outside SIGMA: entry 5 of 4 (NTENS) at integration point 1; the run goes on"
    assert any(message in warning for warning in result.warnings)


@pytest.mark.parametrize(
    ("elements", "section", "message"),
    [
        ("T2D2, ELSET=T\n90, 1, 3", "*SOLID SECTION, ELSET=T, MATERIAL=SOIL\n1.", "T2D2"),
        ("S4, ELSET=T\n90, 1, 2, 3, 4", "*SHELL SECTION, ELSET=T, MATERIAL=SOIL\n1.", "S4"),
    ],
)
def test_elements_whose_stress_cannot_be_set_are_refused(run_deck, elements, section, message):
    more = f"*ELEMENT, TYPE={elements}\n{section}"
    with pytest.raises(
        DeckError, match=rf"deck\.inp:\d+: .*TYPE=STRESS is not supported for elements of type {message} "
    ):
        run_deck(deck("CPE4", more=more), BY_WEIGHT)


def test_a_job_without_sigini(run_deck):
    with pytest.raises(
        DeckError, match=r"deck\.inp:\d+: .*TYPE=STRESS, USER needs SIGINI, which the job does not have"
    ):
        run_deck(deck("CPE4"))


def test_data_lines_beside_sigini(run_deck):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*USER: SIGINI gives the stresses; expected no data lines"):
        run_deck(deck("CPE4", more="SOIL, 1."), BY_WEIGHT)


def test_sigini_may_end_the_analysis(run_deck):
    with pytest.raises(KernelError, match=r"element 2 \(type CPE4\): SIGINI at integration point 3 stopped"):
        run_deck(deck("CPE4"), SIGINI.format("      IF (NOEL .EQ. 2 .AND. NPT .EQ. 3) CALL XIT"))
