# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""A patch of four quads, pulled, whose element has the mistake that is asked for."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from uel.check.examine import examine
from uel.check.finding import Finding

QUAD = Path(__file__).parent / "quad.f"

PATCH = """\
*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1.1, 1.2
6, 2., 1.
7, 0., 2.
8, 1., 2.
9, 2., 2.
*USER ELEMENT, TYPE=U1, NODES=4, COORDINATES=2, PROPERTIES=3, I PROPERTIES=1, VARIABLES=12
1, 2
*ELEMENT, TYPE=U1, ELSET=ALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
3, 4, 5, 8, 7
4, 5, 6, 9, 8
*UEL PROPERTY, ELSET=ALL
1000., 0.3, 2., {mistake}
*STEP
*STATIC, DIRECT
0.5, 1.
*BOUNDARY
1, 1, 2
3, 2
4, 1
7, 1
3, 1, 1, 0.01
6, 1, 1, 0.01
9, 1, 1, 0.01
*END STEP
"""


@pytest.fixture
def patch(tmp_path):
    """Path of a deck for quad.f; the number is that of the mistake, replacements are made in the deck's text."""

    def patch(mistake=0, *replacements):
        text = PATCH.format(mistake=mistake)
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        deck = tmp_path / "patch.inp"
        deck.write_text(text)
        return deck

    return patch


@pytest.fixture
def findings() -> Callable[..., Mapping[str, Finding]]:
    """Findings about the only element type of a deck, by check; options as those of `examine`."""

    def findings(deck: Path, user: Path = QUAD, **options: object) -> Mapping[str, Finding]:
        (report,) = examine(deck, user, **options).types
        return report.findings

    return findings
