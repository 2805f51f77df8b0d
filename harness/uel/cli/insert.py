# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel insert`."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from uel.errors import UsageError, tell


def add_insert(insert: argparse.ArgumentParser) -> None:
    """Add the options of `uel insert`."""
    insert.description = (
        "The mesh is cut where the options say, and the nodes there are doubled; loads, sets, surfaces and constraints "
        "of the deck follow. See harness/uel/insertion/README.md."
    )
    insert.epilog = "Properties of the elements, NAME=VALUE, may stand anywhere: SIGMAMAX=30 TAUMAX=60 GIC=0.26 GIIC=1."
    insert.add_argument(
        "files", nargs="+", type=Path, metavar="FILE", help="a deck (.inp); or a mesh (.msh, ...), and its deck"
    )
    insert.add_argument("-o", "--output", type=Path, required=True, metavar="OUT.inp", help="the deck that is written")
    where = insert.add_argument_group("where; repeat an option to name several interfaces")
    where.add_argument(
        *("--between", "-b"),
        nargs=2,
        action="append",
        default=[],
        metavar=("BELOW", "ABOVE"),
        help="between two element sets",
    )
    where.add_argument("--surface", action="append", default=[], metavar="NAME", help="along a surface of elements")
    where.add_argument(
        "--nodes", action="append", default=[], metavar="NSET", help="along the faces whose nodes are in a node set"
    )
    where.add_argument(
        "--plies",
        nargs="*",
        metavar="ELSET",
        help="between all plies: element sets from the lowest to the highest (those of the sections)",
    )
    where.add_argument("--all", action="append", default=[], metavar="ELSET", help="between all elements of a set")
    where.add_argument(
        "--crack",
        action="append",
        default=[],
        metavar="SET",
        help="initial crack: no elements where these faces are in a node set, at an element set or in a surface",
    )
    where.add_argument(
        "--contact",
        action="store_true",
        help="elements there too, failed from the start: the faces of the crack press, and rub with FRICTION=VALUE",
    )
    insert.add_argument(
        "--element", default="", metavar="TYPE", help="COH2D4, COH3D8, U2, U4, ... (the recommended one at each face)"
    )
    insert.add_argument("--elset", default="INTERFACE", metavar="NAME", help="set that takes them (INTERFACE)")
    insert.add_argument(
        "--solids",
        action="append",
        default=[],
        metavar="TYPE",
        help="continuum element for cells of a mesh; repeat for each shape (CPS4, C3D8, ...)",
    )
    insert.add_argument("--property", action="append", default=[], help=argparse.SUPPRESS)
    insert.set_defaults(function=insert_elements)


def mark_properties(_: argparse.ArgumentParser, words: list[str]) -> list[str]:
    """Turn properties, which may stand anywhere, into an option: other options take any number of names."""
    return [f"--property={word}" if re.match(r"\w[\w ]*=", word) else word for word in words]


def insert_elements(options: argparse.Namespace) -> int:
    """Run `uel insert`."""
    from uel.insertion.command import insert  # noqa: PLC0415
    from uel.insertion.selection import CutRequest  # noqa: PLC0415

    if any(options.output.resolve() == file.resolve() for file in options.files):
        raise UsageError(f"-o {options.output}: is what is read; write to another file")
    pairs = [(below, above) for below, above in options.between]
    wanted = CutRequest(
        pairs, options.surface, options.nodes, options.plies, options.all, options.crack, options.contact
    )
    text, done = insert(
        options.files,
        wanted,
        element=options.element,
        elset=options.elset,
        solids=options.solids,
        values=options.property,
    )
    options.output.write_text(text, encoding="utf-8")
    for line in done.lines(options.elset):
        tell(line)
    tell(f"written: {options.output}")
    return 0
