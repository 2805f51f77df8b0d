# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of a few springs, and the mesh of one body."""

from pathlib import Path

import numpy as np


def body_lines(element_type, nodes, elements):
    """*NODE of the set ALL, (n, dimension), and *ELEMENT of the set BODY, which counts the nodes from 0."""
    lines = ["*NODE, NSET=ALL"]
    lines += [", ".join([str(k), *map(repr, map(float, x))]) for k, x in enumerate(nodes, start=1)]
    lines.append(f"*ELEMENT, TYPE={element_type}, ELSET=BODY")
    for k, element in enumerate(elements, start=1):
        numbers = [str(k), *(str(node + 1) for node in element)]
        lines.append(", ".join(numbers[:12]) + ("," if len(numbers) > 12 else ""))
        lines += [", ".join(numbers[12:])] if len(numbers) > 12 else []
    return lines


def snapping(folder: Path, static: str) -> Path:
    """A spring in series with one that fails at once, pulled to 3.15."""
    deck = folder / "snap.inp"
    deck.write_text(
        "*NODE\n1, 0.\n2, 1.\n3, 2.\n*NSET, NSET=END\n3\n"
        "*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=2, I PROPERTIES=1\n1\n"
        "*USER ELEMENT, TYPE=U6, NODES=2, COORDINATES=1, PROPERTIES=3, I PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U1, ELSET=ELASTIC\n1, 1, 2\n*ELEMENT, TYPE=U6, ELSET=FAILING\n2, 2, 3\n"
        "*UEL PROPERTY, ELSET=ELASTIC\n0.5, 0., 0\n*UEL PROPERTY, ELSET=FAILING\n10., 0.1, 1., 0\n"
        f"*STEP, INC=500\n{static}*BOUNDARY\n1, 1\n3, 1, 1, 3.15\n"
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=END\nU1, RF1\n*END STEP\n"
    )
    return deck


def pulled(folder: Path) -> Path:
    """A spring of a user element, with the properties that procedures/springs.f reads, pulled."""
    deck = folder / "pulled.inp"
    deck.write_text(
        "*NODE\n1, 0.\n2, 1.\n*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=2, I PROPERTIES=1\n1\n"
        "*ELEMENT, TYPE=U1, ELSET=ALL\n1, 1, 2\n*UEL PROPERTY, ELSET=ALL\n1., 0., 0\n"
        "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1\n2, 1, 1, 0.1\n*END STEP\n"
    )
    return deck


BAR_ENDS = np.array([[2.0, 2.0, 0.5], [1.0, 2.0, -1.0], [2.0, 0.5, 2.0], [0.3, 1.1, 0.8]])
"""Places of nodes 4 to 7 of `bars`."""

BARS = """*NODE
1, 0., 0., 0.
2, 3., 0., 0.
3, 0., 3., 1.
{nodes}
9, 1.5, 1.0, 3.0
*ELEMENT, TYPE={truss}, ELSET=BARS
1, 1, 4
2, 2, 4
3, 3, 5
4, 1, 5
5, 2, 6
6, 3, 6
7, 4, 6
8, 3, 7
9, 2, 7
*SOLID SECTION, ELSET=BARS, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
100.
*NSET, NSET=BODY
4, 5, 6, 7
*SURFACE, NAME=S, TYPE=NODE
BODY
{constraint}
*STEP, NLGEOM{nlgeom}
*STATIC
1., 1.
*END STEP
*STEP, NLGEOM
*STATIC
1., 1.
*END STEP
"""


def bars(constraint: str, *, space: bool = True, nlgeom: bool = True) -> str:
    """Bars from nodes 1 to 3 to the nodes of the set BODY and the surface S, with a constraint to node 9.

    Another step after the first one has NLGEOM.
    """
    places = BAR_ENDS if space else BAR_ENDS * [1.0, 1.0, 0.0]
    nodes = "\n".join(f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(places.tolist(), start=4))
    truss, switch = "T3D2" if space else "T2D2", "YES" if nlgeom else "NO"
    text = BARS.format(nodes=nodes, truss=truss, nlgeom=f"={switch}", constraint=constraint)
    return text if space else text.replace("3, 0., 3., 1.", "3, 0., 3., 0.").replace("1.5, 1.0, 3.0", "1.5, 1.0, 0.0")
