# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks from before zeros meant the recommended element are told what to write."""

import re
from pathlib import Path

import pytest

from uel.delamination.kernels import uel_property
from uel.running.job import run

DECK = Path(__file__).parents[3] / "abaqus_inputs" / "properties" / "u4_given.inp"
# of each point 18, of the element 4 that are new
BEFORE, NOW = 36, 40
PLY = {"E1": 120000.0, "E2": 10500.0, "E3": 10500.0, "NU12": 0.3, "NU13": 0.3, "NU23": 0.51, "G12": 5520.0}
VALUES = {"THICKNESS": 0.2, "ALPHAN": 1e6, "ALPHAT": 1e6, "SIGMAMAX": 30.0, "TAUMAX": 60.0, "GIC": 0.26, "GIIC": 1.0}
VALUES |= {"LAW": 1} | {f"{name} {side}": value for name, value in PLY.items() for side in ("BOTTOM", "TOP")}

PAPERS = "write CLOSURE = 2 for the paper's law (0 is the consistent law now)"
BOTH = "BETAN = BETAT = -2 for equation (21) (0 is the local eigenvalues now)"


def warnings(folder: Path, variables: int, **values: float) -> list[str]:
    """What a small deck with one U4 is told, with VARIABLES and properties."""
    text = DECK.read_text("ascii").replace(f"VARIABLES={NOW}", f"VARIABLES={variables}")
    lines = uel_property(4, "INTERFACE", VALUES | values)
    text = re.sub(r"\*\* THICKNESS,.*?(?=\*\* the nodes)", "\n".join(lines) + "\n", text, flags=re.DOTALL)
    text = re.sub(r"(?<=\*STATIC\n).*", "1., 1.", text).replace("TOP, 2, 2, 0.05", "TOP, 2, 2, 1e-6")
    (folder / "deck.inp").write_text(text, "ascii")
    result = run(folder / "deck.inp", output_dir=folder)
    # where lines break depends on the length of the folder's name
    told = " ".join((folder / "deck.msg").read_text().split())
    assert ("is from before zeros meant" in told) == bool(result.warnings)
    return list(result.warnings)


@pytest.mark.parametrize(
    ("values", "ways"),
    [
        ({}, f"{PAPERS} and {BOTH}"),
        ({"CLOSURE": 1}, f"write {BOTH}"),
        ({"BETAN": -1.0, "BETAT": -1.0}, PAPERS),
        ({"BETAN": -1.0}, PAPERS),
        ({"BETAN": 1e6, "BETAT": 1e6}, PAPERS),
        ({"CLOSURE": 1, "BETAN": 1e6}, "write BETAT = -2 for equation (21) (0 is the local eigenvalues now)"),
    ],
    ids=str,
)
def test_zeros_of_a_deck_from_before(values: dict[str, float], ways: str, tmp_path: Path) -> None:
    (warning,) = warnings(tmp_path, BEFORE, **values)
    assert f"U4 with VARIABLES={BEFORE} is from before zeros meant the recommended element: {ways}; or" in warning
    assert f"VARIABLES={NOW} if the deck is to take what zeros mean now" in warning
    assert re.match(r"\S*deck\.inp:\d+: ", warning)


@pytest.mark.parametrize(
    "values",
    [
        # nothing is zero that had another meaning
        {"CLOSURE": 1, "BETAN": -1.0, "BETAT": -1.0},
        {"CLOSURE": 1, "BETAN": 1e6, "BETAT": 1e6},
        # the elements refused these
        {"LAW": 0},
        {"ALPHAN": 0.0, "ALPHAT": 0.0},
        {"FRICTION": 0.1},
        {"CLOSURE": 2},
        {"BETAN": -2.0, "BETAT": -2.0},
    ],
    ids=str,
)
def test_zeros_that_cannot_be_from_before(values: dict[str, float], tmp_path: Path) -> None:
    assert warnings(tmp_path, BEFORE, **values) == []


def test_room_for_beta_says_that_zeros_are_meant(tmp_path: Path) -> None:
    assert warnings(tmp_path, NOW) == []
