# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of bodies that touch: boxes of a regular mesh, one on the other."""

import numpy as np

YOUNG = 1000.0


class Box:
    """A rectangle or a cuboid of regular elements; `nodes` (n, dimension) go along x first, then y, then z."""

    def __init__(self, name, element_type, low, high, counts, first=1):
        self.name, self.type, self.first = name, element_type, first
        axes = [np.linspace(a, b, n + 1) for a, b, n in zip(low, high, counts, strict=True)]
        self.grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        self.numbers = first + np.arange(self.grid[..., 0].size).reshape(self.grid.shape[:-1])
        self.nodes = self.grid.reshape(-1, len(counts))

    def elements(self):
        n = self.numbers
        if n.ndim == 2:
            return np.stack([n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]], axis=-1).reshape(-1, 4)
        bottom = [n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]]
        lower, upper = [k[..., :-1] for k in bottom], [k[..., 1:] for k in bottom]
        return np.stack(lower + upper, axis=-1).reshape(-1, 8)

    def lines(self):
        name = self.name
        lines = ["*NODE"]
        lines += [", ".join([str(self.first + k), *map(repr, x)]) for k, x in enumerate(self.nodes.tolist())]
        lines.append(f"*ELEMENT, TYPE={self.type}, ELSET={name}")
        lines += [", ".join(map(str, [self.first + k, *row])) for k, row in enumerate(self.elements().tolist())]
        for side, chosen in {
            "LEFT": self.numbers[0],
            "RIGHT": self.numbers[-1],
            "FRONT": self.numbers[:, 0],
            "BOTTOM": self.numbers[..., 0],
            "TOP": self.numbers[..., -1],
        }.items():
            lines.append(f"*NSET, NSET={name}_{side}")
            lines += [f"{k}," for k in chosen.ravel().tolist()]
        cells = self.first + np.arange(len(self.elements())).reshape([n - 1 for n in self.numbers.shape])
        high = "S3" if self.nodes.shape[1] == 2 else "S2"
        for end, face, chosen in (("LOW", "S1", cells[..., 0]), ("HIGH", high, cells[..., -1])):
            lines += [f"*ELSET, ELSET={name}_{end}", *(f"{k}," for k in chosen.ravel().tolist())]
            lines.append(f"*SURFACE, NAME={name}_{end}\n{name}_{end}, {face}")
        return [*lines, f"*SOLID SECTION, ELSET={name}, MATERIAL=M", "1.5" if self.nodes.shape[1] == 2 else ""]


def two_boxes(lower, upper, steps, *, nu=0.3, behavior="", pair="SMALL SLIDING", model="", law=None):
    """The box UPPER, whose lower side is the secondary surface, on the box LOWER."""
    lines = [
        "*HEADING",
        "two bodies",
        *lower.lines(),
        *upper.lines(),
        "*MATERIAL, NAME=M",
        law or f"*ELASTIC\n{YOUNG}, {nu}",
    ]
    lines += ["*SURFACE INTERACTION, NAME=TOUCH", *([behavior] if behavior else [])]
    lines += [f"*CONTACT PAIR, INTERACTION=TOUCH, {pair}", "UPPER_LOW, LOWER_HIGH", *([model] if model else [])]
    return "\n".join([*lines, *steps]) + "\n"


def step(procedure, *lines, options="", output=""):
    """A step whose history has U and RF of both ends."""
    ends = "*NODE OUTPUT, NSET=UPPER_TOP\nU, RF\n*NODE OUTPUT, NSET=LOWER_BOTTOM\nU, RF"
    written = ["*OUTPUT, HISTORY", *([output] if output else []), ends, "*OUTPUT, FIELD"]
    return "\n".join([f"*STEP{options}", "*STATIC", procedure, *lines, *written, "*END STEP"])


def plane(gap=0.0, *, lower=2, upper=2, element_type="CPE4", width=2.0):
    """Two rectangles of height 1."""
    return (
        Box("LOWER", element_type, (0, 0), (width, 1), (lower, 1)),
        Box("UPPER", element_type, (0, 1 + gap), (width, 2 + gap), (upper, 1), first=1001),
    )


def total(result, variable, *sets):
    """Sum of a variable of the history over the nodes of sets."""
    chosen = tuple(f"{variable}[{name}" for name in sets)
    return sum(values for name, values in result.history.items() if name.startswith(chosen))
