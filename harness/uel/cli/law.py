# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel law`."""

from __future__ import annotations

import argparse
from pathlib import Path

from uel.cli.values import ABOVE_ZERO, FINITE, NOT_NEGATIVE, PART, positive


def add_law(law: argparse.ArgumentParser) -> None:
    """Add the options of `uel law`."""
    law.add_argument("properties", nargs="*", metavar="NAME=VALUE", help="properties (those of the paper's table 2)")
    law.add_argument("--deck", type=Path, metavar="DECK.inp", help="take properties and element type from a deck")
    law.add_argument("--elset", metavar="NAME", help="... from the *UEL PROPERTY of this set (the first)")
    law.add_argument("--element", choices=["U2", "U4", "U5", "U6"], help="element type (U2, or as in the deck)")
    law.add_argument(
        *("--angles", "-a"),
        nargs="+",
        type=FINITE,
        metavar="DEGREES",
        default=[0.0, 30.0, 60.0, 90.0],
        help="directions of the separation in degrees, 0 opening, 90 sliding (0 30 60 90)",
    )
    law.add_argument(
        "--reach", type=ABOVE_ZERO, metavar="LENGTH", help="largest separation (where no traction is left)"
    )
    law.add_argument(
        *("--unload", "-u"), nargs="+", type=PART, metavar="F", default=[], help="unload to 0 at these fractions of it"
    )
    law.add_argument(
        "--close",
        type=NOT_NEGATIVE,
        metavar="F",
        default=0.0,
        help="... and then press together by this fraction of it",
    )
    law.add_argument("--path", metavar="'N,T N,T ...'", help="follow these separations instead")
    law.add_argument(
        "--units", nargs=2, metavar=("LENGTH", "STRESS"), help="for the axes (mm MPa; unknown with --deck)"
    )
    law.add_argument("--surface", action="store_true", help="also draw both tractions over both separations")
    law.add_argument(
        "--increments",
        type=positive,
        default=400,
        metavar="N",
        help="increments per curve, or per line of a path (400)",
    )
    law.add_argument("--duration", type=ABOVE_ZERO, default=1.0, metavar="TIME", help="step time of a curve (1)")
    law.add_argument("--job", default="law", metavar="NAME", help="name of the output files (law)")
    law.add_argument("--output-dir", type=Path, default=Path(), metavar="DIR", help="folder of the files (current)")
    law.set_defaults(function=explore_law)


def properties_first(_: argparse.ArgumentParser, words: list[str]) -> list[str]:
    """Move properties, which may stand anywhere between the options, before these."""
    return sorted(words, key=lambda word: word.startswith("-") or "=" not in word)


def explore_law(options: argparse.Namespace) -> int:
    """Run `uel law`."""
    from rich.console import Console  # noqa: PLC0415

    from uel.delamination.law_report import Exploration, advice, explore, path_points, summary  # noqa: PLC0415

    asked = {
        name: value for name, value in vars(options).items() if name not in ("function", "apart", "element", "path")
    }
    path = None if options.path is None else path_points(options.path)
    element = None if options.element is None else int(options.element[1:])
    asked["units"] = None if options.units is None else tuple(options.units)
    exploration = Exploration(**asked, path=path, element=element)
    curves, files = explore(exploration)
    Console().print(summary(curves))
    if words := advice(exploration):
        print(words)
    print("written:", *files)
    return 0
