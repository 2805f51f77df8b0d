# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of properties and variables in comments of a deck."""

from pathlib import Path

import numpy as np
import pytest

from uel import run
from uel.deck import read_deck
from uel.model.properties import ElementNames, UserElement
from uel.project import TEMPLATE

DECK = """\
*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*USER ELEMENT, TYPE=U1, NODES=4, COORDINATES=2, PROPERTIES=3, I PROPERTIES=1, VARIABLES=12
** of a quad{names}
1, 2
** VARIABLES are three stresses of each point
*ELEMENT, TYPE=U1, ELSET=QUAD
** VARIABLES: not, these
1, 1, 2, 3, 4
*UEL PROPERTY, ELSET=QUAD
1000., 0.25, 1., 0
*STEP
*STATIC
1., 1.
*BOUNDARY
1, 1, 2
4, 1
2, 1, 1, 0.02
3, 1, 1, 0.02
*OUTPUT, FIELD
*NODE OUTPUT
U
*EL PRINT
S11, S
*END STEP
"""


def element(folder: Path, *names: str) -> tuple[UserElement, tuple[str, ...]]:
    deck = folder / "quad.inp"
    deck.write_text(DECK.format(names="".join(f"\n** {line}" for line in names)))
    model = read_deck(deck)
    definition = model.groups[0].definition
    assert definition is not None
    return definition, tuple(text.removeprefix(f"{deck}:") for text in model.warnings)


def test_names_with_units(tmp_path: Path) -> None:
    found, warnings = element(
        tmp_path,
        "PROPERTIES: E [N/mm^2], nu,",
        "properties: t [mm]",
        "I PROPERTIES: MISTAKE",
        "Variables: s 11 [MPa], -, S12",
    )
    assert found.names == ElementNames(("E [N/mm^2]", "nu", "t [mm]"), ("MISTAKE",), ("S11", "", "S12"))
    assert found.point_variables is not None
    assert (found.point_variables.points, found.point_variables.names) == (4, ("S11", "", "S12"))
    assert not warnings


def test_deck_without_names(tmp_path: Path) -> None:
    found, warnings = element(tmp_path)
    assert (found.names, found.point_variables, warnings) == (ElementNames(), None, ())


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("PROPERTIES: E, NU", "2 names for PROPERTIES=3; the names of PROPERTIES"),
        ("I PROPERTIES: A, B", "2 names for I PROPERTIES=1; the names of I PROPERTIES"),
        ("VARIABLES: A, B, C, D, E", "5 names for VARIABLES=12, which is no multiple of them; the names of VARIABLES"),
        ("VARIABLES: A [mm], A", "A is named twice; the names of VARIABLES"),
        ("VARIABLES: A,, B", "a name is empty; the names of VARIABLES"),
    ],
)
def test_names_that_do_not_fit(tmp_path: Path, line: str, fault: str) -> None:
    """A deck may have had such comments before."""
    found, warnings = element(tmp_path, "more", line)
    assert found.names == ElementNames()
    assert warnings == (f"9: *USER ELEMENT: {fault} in comments are not used",)


@pytest.mark.parametrize("name", ["S11", ""])
def test_variables_reach_field_output_and_tables(tmp_path: Path, name: str) -> None:
    """The element of `uel new` in tension: sigma = E u/L = 10, without lateral stress."""
    deck = tmp_path / "quad.inp"
    text = DECK.format(names=f"\n** VARIABLES: {name or '-'}, S22 [MPa], -").replace(", I PROPERTIES=1", "")
    deck.write_text(text.replace("1000., 0.25, 1., 0\n", "1000., 0.25, 1.\n"))
    result = run(deck, TEMPLATE / "my_uel.for", output_dir=tmp_path)
    data = result.mesh().cell_data
    assert set(data) == {"S22", "ELEMENT"} | ({name} if name else set())
    assert np.concatenate(data["S22"]) == pytest.approx([0.0], abs=1e-9)
    if name:
        assert result.field("S11") == pytest.approx([10.0], rel=1e-9)
        assert " ".join(result.file(".dat").read_text().split()).count("1 1 10.00 10.00") == 1
    assert any("S11 IS NOT AVAILABLE" in warning for warning in result.warnings) == (not name)
