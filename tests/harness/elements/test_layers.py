# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Layers with a thickness between solids, as decks: U2 and U7 with points at the nodes are COH2D4 and COH3D8."""

import numpy as np
import pytest

from uel.delamination.kernels import uel_property, user_element

YOUNG, LENGTH, PLY, LAYER, LOAD = 1.0e4, 40.0, 1.0, 0.2, 1.0
SOFT, SHEAR = 100.0, 50.0
"""Moduli of the layer, without contraction: in tension and in shear."""
STIFFNESS = {"ALPHAN": SOFT / LAYER, "ALPHAT": SHEAR / LAYER}
STRONG = {"SIGMAMAX": 1e6, "TAUMAX": 1e6, "GIC": 1e12, "GIIC": 1e12, "THICKNESS": 1.0, "INTEGRATION": 1}
FLAT = [0.0, PLY, PLY + LAYER, 2.0 * PLY + LAYER]


def cohesive(width):
    """Sections of the elements of Abaqus, elastic."""
    lines = ["*COHESIVE SECTION, ELSET=LAYER, MATERIAL=GLUE, RESPONSE=TRACTION SEPARATION"]
    moduli = f"{STIFFNESS['ALPHAN']}, {STIFFNESS['ALPHAT']}, {STIFFNESS['ALPHAT']}"
    return [*lines, f"1., {width}" if width else "1.", "*MATERIAL, NAME=GLUE", "*ELASTIC, TYPE=TRACTION", moduli]


def sandwich(kind, count, *, nlgeom=False):
    """A cantilever of two plies with a layer between them, in space of width 1: held at x = 0, bent at its end."""
    space = kind in ("U7", "COH3D8", "C3D8I")
    width = [0.0, 1.0] if space else [0.0]
    solid = "C3D8I" if space else "CPS4I"
    x = np.linspace(0.0, LENGTH, count + 1)
    rows = len(x) * len(width)
    nodes = [(a, y, b) if space else (a, y) for y in FLAT for b in width for a in x]
    # in space y is up, and the faces are counter-clockwise seen from there
    lines = ["*NODE", *(f"{k}, " + ", ".join(map(repr, map(float, node))) for k, node in enumerate(nodes, 1))]

    def face(level, k):
        first = level * rows + k + 1
        return [first, first + len(x), first + len(x) + 1, first + 1] if space else [first, first + 1]

    def element(label, level, k):
        bottom, top = face(level, k), face(level + 1, k)
        return ", ".join(map(str, [label, *bottom, *(top if space else top[::-1])]))

    layer = kind if kind[0] in "U" or kind.startswith("COH") else solid
    if kind[0] == "U":
        lines += user_element(int(kind[1:]))
    lines += [f"*ELEMENT, TYPE={solid}, ELSET=PLIES"]
    lines += [element(1 + level * count + k, level, k) for level in (0, 2) for k in range(count)]
    lines += [f"*ELEMENT, TYPE={layer}, ELSET=LAYER", *(element(1 + count + k, 1, k) for k in range(count))]
    lines += ["*SOLID SECTION, ELSET=PLIES, MATERIAL=PLY", *([] if space else ["1."])]
    lines += ["*MATERIAL, NAME=PLY", "*ELASTIC", f"{YOUNG}, 0."]
    if kind[0] == "U":
        lines += uel_property(int(kind[1:]), "LAYER", STIFFNESS | STRONG)
    elif kind.startswith("COH"):
        lines += cohesive("" if space else "1.")
    else:
        lines += ["*SOLID SECTION, ELSET=LAYER, MATERIAL=GLUE", *([] if space else ["1."]), "*MATERIAL, NAME=GLUE"]
        lines += ["*ELASTIC", f"{SOFT}, 0."]
    places = np.array(nodes)
    for name, at in (("ROOT", 0.0), ("TIP", LENGTH)):
        lines += [f"*NSET, NSET={name}", *(str(k + 1) for k in np.flatnonzero(places[:, 0] == at))]
    tip = np.flatnonzero(places[:, 0] == LENGTH)
    step = "*STEP, INC=100, NLGEOM=YES, UNSYMM=YES" if nlgeom else "*STEP, UNSYMM=YES"
    lines += [
        "*BOUNDARY",
        f"ROOT, 1, {places.shape[1]}",
        step,
        "*STATIC",
        "0.25, 1., 1e-5, 0.25" if nlgeom else "1., 1.",
    ]
    lines += ["*CLOAD", *(f"{k + 1}, 2, {LOAD / len(tip)!r}" for k in tip)]
    return [*lines, "*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"], tip


def deflection(run_deck, kind, count, *, nlgeom=False):
    lines, tip = sandwich(kind, count, nlgeom=nlgeom)
    return float(run_deck(lines).field("U")[tip, 1].mean())


def theory():
    """Deflection of a cantilever of two equal plies with a soft core (H.G. Allen, Analysis and Design of Structural
    Sandwich Panels, 1969, thick faces): the plies bend about their own axes, and together as far as the core lets them.

    With the distance d of their middles, D_f = 2 E t^3/12 of the plies alone, D = E t d^2/2 + D_f of all, the shear
    stiffness S = G d^2/h of the core and a^2 = S D/(D_f (D - D_f)), where no shear is let at the root,

        w = P L^3/(3 D) + P L (1 - D_f/D)^2/S (1 - tanh(a L)/(a L)).
    """
    d = PLY + LAYER
    own = 2.0 * YOUNG * PLY**3 / 12.0
    whole = YOUNG * PLY * d**2 / 2.0 + own
    shear = SHEAR * d**2 / LAYER
    a = np.sqrt(shear * whole / (own * (whole - own)))
    held = 1.0 - np.tanh(a * LENGTH) / (a * LENGTH)
    return LOAD * LENGTH**3 / (3.0 * whole) + LOAD * LENGTH * (1.0 - own / whole) ** 2 / shear * held


@pytest.mark.parametrize("kind", ["U2", "COH2D4", "CPS4I", "U7", "COH3D8"])
def test_a_bonded_beam_bends_as_a_sandwich(run_deck, kind):
    """The plies shear by themselves too, which the theory leaves out: by no more than P L/(5/6 E/2 2 t), 0.2 %.

    If the jump of the displacements were the separation, d would be t, and the deflection a third larger.
    """
    found = deflection(run_deck, kind, 80)
    assert theory() < found < theory() + LOAD * LENGTH / (5.0 / 6.0 * YOUNG * PLY)


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize(("own", "built_in"), [("U2", "COH2D4"), ("U7", "COH3D8")])
def test_the_elements_of_the_project_are_those_of_the_host(run_deck, own, built_in, nlgeom):
    found = [deflection(run_deck, kind, 20, nlgeom=nlgeom) for kind in (own, built_in)]
    assert found[0] == pytest.approx(found[1], rel=1e-9)
