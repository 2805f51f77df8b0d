# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of two masses in a row and of a bar, for vibrations, and their results."""

import numpy as np

PAIR = """*NODE, NSET=ALL
1, 0.
2, 1.
3, 2.
*ELEMENT, TYPE=SPRINGA, ELSET=S
1, 1, 2
2, 2, 3
*SPRING, ELSET=S

8.
*ELEMENT, TYPE=MASS, ELSET=M
3, 2
4, 3
*MASS, ELSET=M
2.
*BOUNDARY
ALL, 2, 3
1, 1
"""


def bar(elements, *, more=""):
    """A bar of length 1, E = 4, density 1, held at both ends or as `more` says: wave speed 2."""
    nodes = "".join(f"{k + 1}, {k / elements}, 0.\n" for k in range(elements + 1))
    trusses = "".join(f"{k}, {k}, {k + 1}\n" for k in range(1, elements + 1))
    return (
        f"*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=T2D2, ELSET=BAR\n{trusses}*SOLID SECTION, ELSET=BAR, MATERIAL=M\n1.\n"
        f"*MATERIAL, NAME=M\n*ELASTIC\n4.\n*DENSITY\n1.\n*BOUNDARY\nALL, 2\n{more}"
    )


def harmonic(history, name):
    """Complex values of a column."""
    return history[name] * np.exp(1j * np.deg2rad(history[f"P{name}"]))
