# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One truss, whose second node moves along its axis 1."""

TRUSS = """*NODE, NSET=ALL
1, 1., 0.{z}
2, 4., 4.{z}
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2
*SOLID SECTION, ELSET=E, MATERIAL=M
2.
*MATERIAL, NAME=M
{material}
*BOUNDARY
1, 1, 3
2, 2, 3
"""
PULL = "*BOUNDARY\n2, 1, 1, 0.6"
LENGTH = 5.0


def truss(element_type, material):
    """The deck before its steps."""
    return TRUSS.format(type=element_type, z="" if element_type == "T2D2" else ", 0.", material=material)
