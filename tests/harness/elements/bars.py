# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bars with dof 11, which is a temperature or a concentration."""

import numpy as np

from uel.model.element_types import BUILT_IN


def held(nodes, values, dof=11):
    return "*BOUNDARY\n" + "".join(f"{k + 1}, {dof}, {dof}, {float(v)!r}\n" for k, v in zip(nodes, values, strict=True))


def column(history, name, count):
    """(rows, nodes) of a nodal variable."""
    return np.array([history[f"{name}[ALL:{k}]"] for k in range(1, count + 1)]).T


def bar(element_type, count):
    """Nodes and elements of a bar of length 1 and sides 0.4 in cells of four or eight nodes, and places along it."""
    kind = BUILT_IN[element_type]
    x = np.linspace(0.0, 1.0, count + 1)
    section = np.array([[0, 0.0], [0, 0.4]])
    if kind.dimension == 3:
        section = np.array([[0, 0, 0], [0, 0.4, 0], [0, 0.4, 0.4], [0, 0, 0.4]])
    n = len(section)
    nodes = np.vstack([section + place * np.eye(kind.dimension)[0] for place in x])
    cell = [0, n, n + 1, 1] if n == 2 else [0, n, n + 1, 1, 3, n + 3, n + 2, 2]
    elements = np.array([np.array(cell) + n * k for k in range(count)])
    if kind.axisymmetric:
        nodes = np.stack([0.4 - nodes[:, 1], nodes[:, 0]], axis=1)
    return nodes, elements, np.repeat(x, n)
