# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks of other programs for `uel insert`: `python tests/programs/adversarial/insertions.py [--count N] [--seed N]`.

Each case is a random block of solids, written as Gmsh, Abaqus/CAE, Salome or HyperMesh write their decks, with what
such decks have besides: sets of elements of lower dimension, nodes of no element, numbers with gaps, parts and
instances, constraints, surfaces, orientations, layers. It is cut somewhere, with some interface element. Either the
insertion is refused with an option or a place, or the deck that it writes runs, and bonded elements that are stiff give
the displacements of the uncut deck. The exit code is 1 if a case does neither.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import traceback
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uel import run
from uel.deck.reader import read_deck
from uel.errors import UelError
from uel.insertion.command import insert
from uel.insertion.selection import CutRequest
from uel.model.element_types import CONTINUUM

KINDS = (
    *("CPS4", "CPE4", "CPS4I", "CPS3", "CPS8", "CPE8R", "CPS6", "CPS4R"),
    *("C3D8", "C3D8I", "C3D8R", "C3D6", "C3D4", "C3D10", "C3D15", "C3D20", "C3D20R"),
)
ELEMENTS = (
    *("", "U2", "U4", "U5", "U6", "U7", "U8", "U11", "U12", "U13", "U14", "U33", "U34", "U66", "U404", "U608", "U1010"),
    *("COH2D4", "COH3D6", "COH3D8"),
)
STANDARD = ("U2", "U5", "U7", "U11", "U13", "U14", "COH2D4", "COH3D6", "COH3D8")
FITTING = {
    (2, 2): ("", "U2", "U4", "COH2D4"),
    (2, 3): ("", "U5", "U6"),
    (3, 4): ("", "U7", "U8", "COH3D8"),
    (3, 8): ("", "U11", "U12"),
    (3, 3): ("", "U13", "U404", "COH3D6"),
    (3, 6): ("", "U14", "U1010"),
}
"""Those between faces by the dimension of the solids and the nodes of a face."""
SYSTEMS = ("RECTANGULAR", "Z RECTANGULAR", "CYLINDRICAL", "SPHERICAL", "NODES", "OFFSET")
LAW = ("SIGMAMAX=1e5", "TAUMAX=1e5", "GIC=1e9", "GIIC=1e9")
STIFF = 1e8
"""Stiffness of standard elements: 1e4 times that of the solids, whose modulus is 1e4 and whose size is 1."""
SOFT, ROUNDING = 2e-3, 1e-8
"""Largest difference of displacements, over the largest one, with standard elements, and where doubles are tied."""


@dataclass
class Case:
    """A deck, and how it is cut.

    fixed  nodes that are held at one end
    notes  what is in the deck
    """

    lines: list[str]
    wanted: CutRequest
    element: str
    values: list[str]
    fixed: set[int]
    notes: list[str]


class Maker:
    """Writes one deck."""

    def __init__(self, seed: int) -> None:
        self.seed, self.rng = seed, np.random.default_rng(seed)
        self.notes: list[str] = []

    def some(self, share: float, note: str) -> bool:
        """Whether this deck has something."""
        if self.rng.random() >= share:
            return False
        self.notes.append(note)
        return True

    def case(self) -> Case:
        """A deck with everything."""
        kind = str(self.rng.choice(KINDS))
        flat = CONTINUUM[kind].family.dimension
        counts = [int(self.rng.integers(2, 4)), *([1] if flat == 3 else []), int(self.rng.integers(2, 4))]
        from solid_grids import grid  # noqa: PLC0415 (of the tests, see main)

        self.mesh = grid(kind, counts, [float(n) for n in counts], 0.15 * self.rng.random(), self.seed)
        self.ends = [np.flatnonzero(self.mesh.end(0, side)) for side in (0, 1)]
        if self.some(0.3, "curved"):
            self._roll()
        self._number()
        self.notes.insert(0, kind)
        mesh_lines = self._mesh_lines()
        sets = self._set_lines()
        sections = self._sections()
        materials = self._materials()
        parted = self.some(0.35, "parts")
        inside = [*mesh_lines, *sets, *self._dimensions(), *sections]
        at = "ONE." if parted else ""
        model = self._model(at)
        if parted:
            twice = self.some(0.5, "two instances")
            turn = [f"0., 0., 0., 0., 0., 1., {float(self.rng.choice([0.0, 90.0, 30.0]))}"] if twice else []
            place = ["40., 0., 0.", *turn]
            head = [
                "*PART, NAME=P",
                *inside,
                "*END PART",
                "*ASSEMBLY, NAME=A",
                "*INSTANCE, NAME=ONE, PART=P",
                "*END INSTANCE",
            ]
            second = ["*INSTANCE, NAME=TWO, PART=P", *place, "*END INSTANCE"] if twice else []
            held = ["*NSET, NSET=HELD, INSTANCE=TWO", "ALL"] if twice else []
            lines = [*head, *second, *held, *model, "*END ASSEMBLY", *materials]
            supports = ["HELD, 1, 3"] if twice else []
        else:
            lines, supports = [*inside, *model, *materials], []
        lines += [
            *self._initial(at),
            "*STEP",
            "*STATIC",
            "1., 1.",
            "*BOUNDARY",
            f"{at}FIX, 1, 3",
            *supports,
            *self._loads(at),
        ]
        lines += ["*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"]
        fit = FITTING.get((flat, len(CONTINUUM[kind].family.faces[-1])), ("",))
        element = str(self.rng.choice(fit if self.rng.random() < 0.9 else ELEMENTS))
        values = [*LAW, *([f"ALPHAN={STIFF}"] if element in STANDARD else [])]
        fixed = set(self.labels[self.ends[0]].tolist())
        return Case(lines, self._wanted(), element, values, fixed, [*self.notes, element])

    def _roll(self) -> None:
        x, z = self.mesh.nodes[:, 0], self.mesh.nodes[:, -1]
        angle, radius = x / 6.0, 5.0 + z
        self.mesh.nodes = np.column_stack(
            [
                radius * np.sin(angle),
                *([self.mesh.nodes[:, 1]] if self.mesh.nodes.shape[1] == 3 else []),
                radius * np.cos(angle),
            ]
        )

    def _number(self) -> None:
        count = len(self.mesh.nodes)
        self.labels = np.arange(1, count + 1)
        if self.some(0.5, "gaps"):
            self.labels = np.sort(self.rng.choice(5 * count, count, replace=False)) + 1
        if self.some(0.3, "shuffled"):
            self.labels = self.rng.permutation(self.labels)
        self.numbers = np.arange(1, len(self.mesh.elements) + 1) * int(self.rng.integers(1, 4)) + int(
            self.rng.integers(0, 50)
        )
        layers = self.mesh.cell[:, -1]
        self.low = layers == 0
        self.left = self.mesh.cell[:, 0] == 0

    def _mesh_lines(self) -> list[str]:
        points = [(label, *map(float, x)) for label, x in zip(self.labels.tolist(), self.mesh.nodes, strict=True)]
        if self.some(0.3, "orphans"):
            points += [(90000 + k, 7.0 + k, 1.0, *([2.0] if self.mesh.nodes.shape[1] == 3 else [])) for k in range(2)]
        name = "" if self.some(0.5, "plain *NODE") else ", NSET=ALL"
        lines = [f"*NODE{name}", *(", ".join(map(repr, row)) for row in points)]
        groups = (
            [("LOW", self.low), ("HIGH", ~self.low)]
            if self.some(0.5, "blocks by layer")
            else [("BODY", self.low | ~self.low)]
        )
        for name, inside in groups:
            lines.append(f"*ELEMENT, TYPE={self.mesh.kind}, ELSET={name}")
            for number, nodes in zip(self.numbers[inside].tolist(), self.mesh.elements[inside].tolist(), strict=True):
                words = [str(number), *(str(self.labels[node]) for node in nodes)]
                rows = [words[k : k + 9] for k in range(0, len(words), 9)]
                lines += [", ".join(row) + ("," if k < len(rows) - 1 else "") for k, row in enumerate(rows)]
        self.grouped = len(groups) == 2
        return lines if "NSET=ALL" in lines[0] else [*lines, "*NSET, NSET=ALL", *map(str, self.labels.tolist())]

    def _set_lines(self) -> list[str]:
        lines = []
        if not self.grouped:
            lines += ["*ELSET, ELSET=LOW", *map(str, self.numbers[self.low].tolist())]
            lines += ["*ELSET, ELSET=HIGH", *map(str, self.numbers[~self.low].tolist())]
        else:
            lines += ["*ELSET, ELSET=BODY", "LOW, HIGH"]
        lines += ["*ELSET, ELSET=LEFT", *map(str, self.numbers[self.left].tolist())]
        lines += ["*ELSET, ELSET=RIGHT", *map(str, self.numbers[~self.left].tolist())]
        for name, label in (("FIX", 0), ("PULL", 1)):
            lines += [f"*NSET, NSET={name}", *map(str, self.labels[self.ends[label]].tolist())]
        self.middle = np.isin(np.arange(len(self.labels)), self.mesh.elements[self.low]) & np.isin(
            np.arange(len(self.labels)), self.mesh.elements[~self.low]
        )
        lines += ["*NSET, NSET=MIDDLE", *map(str, self.labels[self.middle].tolist())]
        if self.some(0.3, "set twice"):
            lines += ["*NSET, NSET=FIX", str(self.labels[self.ends[0][0]])]
        if self.some(0.3, "set of elements' nodes"):
            lines += ["*NSET, NSET=UPPER, ELSET=HIGH"]
        if self.some(0.4, "surface"):
            lines += ["*SURFACE, NAME=SIDE, TYPE=ELEMENT", "LOW, S1", "*SURFACE, NAME=POINTS, TYPE=NODE", "MIDDLE, 1."]
        return lines

    def _dimensions(self) -> list[str]:
        """Elements of a lower dimension, as meshes have them for groups of faces, edges and points."""
        family, first = CONTINUUM[self.mesh.kind].family, 50000
        lines: list[str] = []
        face = family.faces[int(self.rng.integers(len(family.faces)))]
        flat = family.dimension == 3
        kinds = {
            3: ("CPS3", "S3", "M3D3"),
            4: ("CPS4", "S4R", "M3D4", "R3D4"),
            6: ("CPS6", "M3D6"),
            8: ("CPS8", "S8R", "M3D8"),
        }
        if flat and self.some(0.35, "faces without section"):
            kind = str(self.rng.choice(kinds[len(face)]))
            self.notes.append(kind)
            lines.append(f"*ELEMENT, TYPE={kind}, ELSET=FACES")
            for k, nodes in enumerate(self.mesh.elements[:, list(face)].tolist()):
                lines.append(", ".join([str(first + k), *(str(self.labels[node]) for node in nodes)]))
        if self.some(0.25, "edges without section"):
            lines.append(f"*ELEMENT, TYPE={'T3D2' if flat else 'T2D2'}, ELSET=EDGES")
            lines += [
                f"{60000 + k}, {self.labels[a]}, {self.labels[b]}"
                for k, (a, b) in enumerate(self.mesh.elements[:, :2].tolist())
            ]
        if self.some(0.2, "skin with section") and flat and len(face) in (3, 4):
            kind = "M3D4" if len(face) == 4 else "M3D3"
            lines.append(f"*ELEMENT, TYPE={kind}, ELSET=SKIN")
            side = np.flatnonzero(~self.low)[:2]
            top = family.faces[1]
            if len(top) == len(face):
                for k, nodes in enumerate(self.mesh.elements[side][:, list(top)].tolist()):
                    lines.append(", ".join([str(70000 + k), *(str(self.labels[node]) for node in nodes)]))
                lines += ["*MEMBRANE SECTION, ELSET=SKIN, MATERIAL=STEEL", "0.01"]
            else:
                lines.pop()
        if self.some(0.2, "spring"):
            lines += [
                "*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS",
                f"80000, {self.labels[0]}",
                "*SPRING, ELSET=SPRINGS",
                "1",
                "1e-3",
            ]
        if "edges without section" in self.notes:
            lines += ["*SOLID SECTION, ELSET=EDGES, MATERIAL=STEEL", "1e-6"]
        if "faces without section" in self.notes and self.some(0.5, "faces have a section"):
            name = next(note for note in self.notes if note in sum(kinds.values(), ()))
            section = {"S": "SHELL", "M": "MEMBRANE"}.get(name[0])
            if section:
                lines += [f"*{section} SECTION, ELSET=FACES, MATERIAL=STEEL", "1e-5"]
        return lines

    def _sections(self) -> list[str]:
        flat = CONTINUUM[self.mesh.kind].family.dimension
        lines: list[str] = []
        self.orientations: list[str] = []
        sets = ("LOW", "HIGH") if self.some(0.6, "two sections") else ("BODY",)
        for k, name in enumerate(sets):
            option = ""
            if self.some(0.5, "orientation"):
                which = str(self.rng.choice(SYSTEMS if flat == 3 else ("RECTANGULAR", "CYLINDRICAL", "NODES")))
                self.notes.append(which)
                polar = "0., 0., -9., 0., 1., -9." if flat == 3 else "-9., -9., 0., -9., -9., 1."
                if which == "NODES":
                    lines += [
                        f"*ORIENTATION, NAME=O{k}, DEFINITION=NODES",
                        ", ".join(map(str, self.labels[self.mesh.elements[0, [1, 2, 0]]])),
                    ]
                elif which == "OFFSET":
                    lines += [f"*ORIENTATION, NAME=O{k}, DEFINITION=OFFSET TO NODES", "2, 3, 1"]
                elif "RECT" in which:
                    lines += [f"*ORIENTATION, NAME=O{k}, SYSTEM={which}", "1., 0., 0., 0., 1., 0."]
                else:
                    lines += [f"*ORIENTATION, NAME=O{k}, SYSTEM={which}", polar]
                polar_axis = flat == 3 and which in ("CYLINDRICAL", "SPHERICAL")
                axis = int(self.rng.integers(1, 4)) if polar_axis else 3
                if which != "NODES":
                    lines.append(f"{axis}, {float(self.rng.choice([0.0, 30.0, 90.0]))}")
                option = f", ORIENTATION=O{k}"
            material = str(self.rng.choice(["STEEL", "PLY"]))
            if flat == 3 and CONTINUUM[self.mesh.kind].layered and self.some(0.3, "layers"):
                angle = "45." if option else ""
                lines += [
                    f"*SOLID SECTION, ELSET={name}, COMPOSITE{option}",
                    "0.5, 1, PLY, ",
                    f"0.5, 3, STEEL, {angle}",
                ]
            else:
                lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL={material}{option}", "1."]
        return lines

    def _materials(self) -> list[str]:
        flat = CONTINUUM[self.mesh.kind].family.dimension
        lines = ["*MATERIAL, NAME=STEEL", "*ELASTIC", "1e4, 0.3"]
        if flat == 2 and CONTINUUM[self.mesh.kind].tensor == 3:
            lines += ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=LAMINA", "3e4, 8e3, 0.3, 4e3, 4e3, 3e3"]
        else:
            lines += ["*MATERIAL, NAME=PLY", "*ELASTIC, TYPE=ENGINEERING CONSTANTS"]
            lines += ["3e4, 8e3, 7e3, 0.3, 0.25, 0.3, 4e3, 4e3", "3e3"]
        if self.some(0.1, "expansion"):
            lines += ["*EXPANSION", "1e-5"]
        if self.some(0.1, "plastic"):
            lines += ["*MATERIAL, NAME=OTHER", "*ELASTIC", "1., 0.3", "*PLASTIC", "1., 0."]
        return lines

    def _initial(self, at: str) -> list[str]:
        if self.some(0.1, "initial stress"):
            return ["*INITIAL CONDITIONS, TYPE=STRESS", f"{at}LOW, 1e-3"]
        return []

    def _model(self, at: str) -> list[str]:
        lines: list[str] = []
        ends = self.labels[self.ends[1]].tolist()
        if self.some(0.2, "equation") and len(ends) > 2:
            lines += ["*EQUATION", "2", f"{at}{ends[0]}, 1, 1., {at}{ends[1]}, 1, -1."]
        elif self.some(0.2, "mpc") and len(ends) > 2:
            lines += ["*MPC", f"PIN, {at}{ends[0]}, {at}{ends[1]}"]
        elif self.some(0.2, "coupling"):
            lines += [
                "*NODE, NSET=REFERENCE",
                "95000, 9., 1., 1." if self.mesh.nodes.shape[1] == 3 else "95000, 9., 1.",
            ]
            lines += [
                "*SURFACE, NAME=END, TYPE=NODE",
                f"{at}PULL",
                "*COUPLING, CONSTRAINT NAME=C, REF NODE=REFERENCE, SURFACE=END",
                "*KINEMATIC",
                "1, 1",
            ]
        return lines

    def _loads(self, at: str) -> list[str]:
        lines = ["*CLOAD", f"{at}PULL, 1, 1.", f"{at}{self.labels[self.ends[1][0]]}, 2, -0.5"]
        if self.some(0.2, "body force"):
            lines += ["*DLOAD", f"{at}HIGH, BX, 0.1"]
        if "surface" in self.notes and self.some(0.5, "pressure"):
            lines += ["*DSLOAD", f"{at}SIDE, P, 0.01"]
        if self.some(0.15, "temperature"):
            lines += ["*TEMPERATURE", f"{at}ALL, 10."]
        return lines

    def _wanted(self) -> CutRequest:
        ways = [
            CutRequest(between=[("LOW", "HIGH")], crack=["MIDDLE"] if self.rng.random() < 0.05 else []),
            CutRequest(between=[("LOW", "HIGH"), ("LEFT", "RIGHT")]),
            CutRequest(nodes=["MIDDLE"]),
            CutRequest(plies=("LOW", "HIGH")),
            CutRequest(inside=["BODY"]),
            *([CutRequest(surfaces=["SIDE"])] if "surface" in self.notes else []),
            *([CutRequest(plies=())] if "two sections" in self.notes else []),
        ]
        return ways[int(self.rng.integers(len(ways)))]


PLACE = re.compile(r":\d+: |^--\w+|[A-Z]\w*=VALUE|^say where|^no face gets")


def without_groups(text: str) -> str:
    """A deck without the elements that stand for groups of faces, which have no section and do not run."""
    if re.search(r"SECTION, ELSET=FACES", text):
        return text
    return re.sub(r"^\*ELEMENT, TYPE=\w+, ELSET=FACES\n([^*].*\n)*", "", text, flags=re.MULTILINE)


def with_ties(text: str, fixed: set[int]) -> str:
    """A deck that was cut, with each double tied to its node, unless both are held.

    Elements that own their solids then leave the equations of the uncut deck: on coarse meshes of unlike plies, bonds
    that hold by the stress of the solids are tens of per cent softer.
    """
    lines = text.splitlines()
    start = lines.index("** nodes doubled by uel insert") + 2
    stop = next(k for k in range(start, len(lines)) if lines[k].startswith("*"))
    places: dict[tuple[float, ...], int] = {}
    for line in lines[: start - 2]:
        words = line.split(",")
        if len(words) in (3, 4) and re.fullmatch(r" *\d+ *", words[0]) and "." in words[1]:
            places.setdefault(_place(words[1:]), int(words[0]))
    # of two instances, all nodes of the second one are held
    owner = "ONE." if "*PART, NAME=P" in lines else ""
    ties = ["*MPC"]
    for line in lines[start:stop]:
        label, *point = line.split(",")
        origin = places[_place(point)]
        ties += [f"TIE, {owner}{label}, {owner}{origin}"] if origin not in fixed else []
    at = lines.index("*END ASSEMBLY" if "*END ASSEMBLY" in lines else "*STEP")
    return "\n".join([*lines[:at], *(ties if len(ties) > 1 else []), *lines[at:]]) + "\n"


def _place(words: list[str]) -> tuple[float, ...]:
    return (*map(float, words), 0.0)[:3]


def judge(case: Case, folder: Path) -> str:
    """Verdict of a case: 'runs', 'refused: ...', 'uncut deck: ...', or 'WRONG: ...'."""
    deck, plain, cut = (folder / f"{name}.inp" for name in ("deck", "plain", "cut"))
    text = "\n".join(case.lines) + "\n"
    deck.write_text(text)
    plain.write_text(without_groups(text))
    try:
        before = run(plain, output_dir=folder, quiet=True)
    except UelError as error:
        return f"uncut deck: {str(error).splitlines()[0]}"
    try:
        text, done = insert([deck], case.wanted, element=case.element, values=case.values)
    except UelError as error:
        message = str(error)
        return f"refused: {message}" if PLACE.search(message) else f"WRONG: no place: {message}"
    constrained = {"equation", "mpc", "coupling"}.intersection(case.notes)
    standard = bool(done.kinds.keys() & set(STANDARD))
    tied = not standard and not constrained and not done.crack
    cut.write_text(with_ties(without_groups(text), case.fixed) if tied else without_groups(text))
    try:
        after = run(cut, output_dir=folder, quiet=True)
    except UelError as error:
        return f"WRONG: does not run: {str(error).splitlines()[0]}"
    if done.crack or (constrained and not standard):
        return "runs, not compared"
    before_mesh, after_mesh = (read_deck(path).mesh for path in (plain, cut))
    rows = {after_mesh.name(k): k for k in range(len(after_mesh.labels))}
    same = [rows[before_mesh.name(k)] for k in range(len(before_mesh.labels))]
    old, new = before.field("U"), after.field("U")[same]
    apart = np.abs(new - old).max() / np.abs(old).max()
    kinds = " and ".join(done.kinds)
    return f"runs, {kinds}" if apart < (ROUNDING if tied else SOFT) else f"WRONG: {kinds} {100 * apart:.3g} % off"


def try_case(seed: int) -> tuple[str, Case | None]:
    """Judge the case of a seed."""
    case = None
    try:
        case = Maker(seed).case()
        with tempfile.TemporaryDirectory() as folder:
            return judge(case, Path(folder)), case
    except Exception:  # a traceback is what is looked for
        return "WRONG: " + traceback.format_exc().strip().replace("\n", "\n    "), case


def main() -> int:
    """Try all cases; print a table, and those that are wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first case")
    parser.add_argument("--verbose", action="store_true", help="print each case")
    options = parser.parse_args()
    tests = Path(__file__).parents[2] / "harness"
    sys.path[:0] = [str(tests / "insertion"), str(tests)]
    table: Counter[str] = Counter()
    for seed in range(options.seed, options.seed + options.count):
        outcome, case = try_case(seed)
        kind = outcome.partition(":")[0]
        table[kind] += 1
        if kind == "WRONG" or options.verbose:
            print(f"seed {seed}: {', '.join(case.notes) if case else ''}\n  {case.wanted if case else ''}\n  {outcome}")
    for kind, count in sorted(table.items()):
        print(f"{count:6d} {kind}")
    return 1 if table["WRONG"] else 0


if __name__ == "__main__":
    sys.exit(main())
