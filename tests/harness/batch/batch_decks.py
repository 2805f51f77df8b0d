# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks with parameters, and their user files."""

from pathlib import Path

HARNESS = Path(__file__).parents[1]
SPRING = HARNESS / "usersub" / "spring.c"
CRASHES = HARNESS / "usersub" / "crashes.f"

PULLED = """\
*PARAMETER
pull = 0.1
half = pull/2
*INCLUDE, INPUT=mesh.inp
*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1
2, 1, 1, <pull>
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=END
U1, RF1
*END STEP
"""
MESH = """\
*NODE
1, 0.
2, 1.
*NSET, NSET=END
2
*USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=1, PROPERTIES=1
1
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2
*UEL PROPERTY, ELSET=ALL
1.
"""
CRASHING = """\
*PARAMETER
way = 0
*USER ELEMENT, TYPE=U1, NODES=2, I PROPERTIES=2
1
*NODE
1, 0.
2, 1.
*ELEMENT, TYPE=U1, ELSET=ALL
7, 1, 2
*UEL PROPERTY, ELSET=ALL
<way>, 0
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1
2, 1, 1, 1.
*END STEP
"""
