# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks damaged at random: whatever a file holds, the reader returns a model or raises DeckError."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from uel.deck import read_deck
from uel.errors import DeckError

DECKS = [Path(__file__).with_name(name).read_text() for name in ("flat.inp", "cae.inp")]
LINES = [line for deck in DECKS for line in deck.splitlines()]
WORDS = (
    "",
    ",",
    "*",
    "**",
    "=",
    "<x>",
    "<width>",
    '"',
    "-1",
    "0",
    "1e999",
    "99999999999",
    "1.5",
    "x",
    ".",
    "..",
    "A.1",
)
EXTRA = (
    *("*NGEN\n1, 4", "*NFILL\nALL, ALL, 2, 10", "*NCOPY, OLD SET=ALL, CHANGE=100, SHIFT\n1.", "*ELGEN\n1, 3, 1, 1"),
    *(
        "*EQUATION\n2\n1, 1, 1., 2, 1, -1.",
        "*PARAMETER\nx = 1 + 'a'",
        "*PARAMETER\nx = 9**99",
        "*INCLUDE, INPUT=deck.inp",
    ),
    *("*AMPLITUDE, NAME=B, DEFINITION=PERIODIC\n1, 1., 0., 0.\n1., 1.", "*ORIENTATION, NAME=P\n1,0,0,0,1,0\n3, 30."),
    *("*PLASTIC\n1., 0.", "*CONTROLS, PARAMETERS=FIELD\n, 1.", "*CONTROLS, RESET", "*NSET, NSET=A, ELSET=BULK"),
    *(
        "*NSET, NSET=G, GENERATE\n1, 9, 2",
        "*ELEMENT, TYPE=CPS3\n77, 1, 2, 3",
        "*SOLID SECTION, ELSET=BULK, MATERIAL=PLY",
    ),
)


@st.composite
def damaged(draw: st.DrawFn) -> str:
    lines = draw(st.sampled_from(DECKS)).splitlines()
    for _ in range(draw(st.integers(1, 4))):
        index = draw(st.integers(0, len(lines) - 1))
        match draw(st.sampled_from(("drop", "double", "insert", "extra", "field", "cut", "text"))):
            case "drop":
                del lines[index]
            case "double":
                lines.insert(index, lines[index])
            case "insert":
                lines.insert(index, draw(st.sampled_from(LINES)))
            case "extra":
                lines.insert(index, draw(st.sampled_from(EXTRA)))
            case "field":
                fields = lines[index].split(",")
                fields[draw(st.integers(0, len(fields) - 1))] = draw(st.sampled_from(WORDS))
                lines[index] = ",".join(fields)
            case "cut":
                lines[index] = lines[index][: draw(st.integers(0, len(lines[index])))]
            case "text":
                lines[index] = draw(st.text(max_size=20))
        lines = lines or [""]
    return "\n".join(lines)


HARMLESS = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
"""Each example writes its own file; how long that takes depends on what else the machine does."""


@settings(max_examples=300, deadline=None, suppress_health_check=HARMLESS)
@given(text=damaged())
def test_damaged_decks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deck.inp").write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        model = read_deck(Path("deck.inp"))
    except DeckError as error:
        assert all(line.startswith("deck.inp:") for line in str(error).splitlines())
    else:
        assert model.groups


@settings(max_examples=100, deadline=None, suppress_health_check=HARMLESS)
@given(content=st.binary(max_size=200))
def test_any_bytes(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "deck.inp"
    path.write_bytes(content)
    with pytest.raises(DeckError, match=r"deck.inp:\d+: "):
        read_deck(path)
