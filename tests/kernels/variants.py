# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface elements of each closure, and laws, for the tests of what strengths and toughnesses depend on."""

import numpy as np
from space import nodes_of, opened

ALPHA = 1e6
"""Stiffness of the elements that have one."""
STIFF = {"ALPHAN": ALPHA, "ALPHAT": ALPHA}
LAWS = {
    "linear criterion": {"LAW": 1},
    "Benzeggagh-Kenane": {"LAW": 2, "ETA": 2.284},
    "exponential": {"LAW": 3, "ETA": 1.45},
    "bridging": {"LAW": 5, "SIGMABRIDGE": 3.0, "GIBRIDGE": 0.1},
    "table": {"LAW": 6, "SEPARATION1": 0.4, "TRACTION1": 0.5},
}


def rigid(beta):
    """Properties of the complete form with an infinite stiffness."""
    return {"CLOSURE": 3, "ALPHAN": 0.0, "ALPHAT": 0.0, "BETAN": beta, "BETAT": beta}


def variants(beta, *further):
    """Type and properties by name: standard and stabilised elements in the plane and in space, and further names."""
    found = {
        "U2": (2, STIFF),
        "U4 rigid": (4, rigid(beta)),
        "U4 incomplete": (4, rigid(beta) | STIFF | {"CLOSURE": 1}),
        "U7": (7, STIFF),
        "U8 rigid": (8, rigid(beta)),
    }
    others = {
        "U4 paper": (4, rigid(beta) | STIFF | {"CLOSURE": 2}),
        "U11": (11, STIFF),
        "U12 rigid": (12, rigid(beta)),
    }
    return found | {name: others[name] for name in further}


def nodes_and_unit(jtype, interface, shear):
    """Nodes of an element, and displacements that separate its points by 1, with a share of mode II in the energy."""
    parts = np.sqrt([shear, 1 - shear])
    if jtype > 4:
        axes = np.array([[0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
        return nodes_of(jtype, "flat"), np.ravel(opened(jtype, parts @ axes, 0))
    nodes = interface.four if jtype == 2 else interface.eight
    unit = np.zeros(nodes.shape)
    unit[len(nodes) // 2 :] = parts @ interface.axes
    return nodes, unit.ravel()
