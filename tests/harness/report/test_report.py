# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of a job: what it says of model and run, and that it is one file."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from small_decks import pulled, snapping

from uel import run
from uel.cli import main
from uel.deck import read_deck
from uel.errors import UelError
from uel.report import report
from uel.report.model_tables import property_tables
from uel.usersub.layout import element_layouts

FOLDER = Path(__file__).parents[1]
FLAT = FOLDER.parents[1] / "abaqus_inputs" / "patch_horizontal" / "flat_u2.inp"
SPRINGS = FOLDER / "procedures" / "springs.f"
SPRING_IN_C = FOLDER / "usersub" / "spring.c"
VOID = {"meta", "img"}


class Page(HTMLParser):
    """Rows of tables, links, places, pictures and headings of a page whose elements are closed in order."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.text = path.read_text("utf-8")
        self.rows: list[list[str]] = []
        self.headings: list[str] = []
        self.links: list[str] = []
        self.places: list[str] = []
        self.images: list[str] = []
        self._open: list[str] = []
        self.feed(self.text)
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag not in VOID:
            self._open.append(tag)
        self.links += [given["href"]] if "href" in given else []
        self.places += [given["id"]] if "id" in given else []
        self.images += [given["src"]] if "src" in given else []
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag in ("h1", "h2", "h3"):
            self.headings.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        if {"td", "th"} & set(self._open):
            self.rows[-1][-1] += data
        if {"h1", "h2", "h3"} & set(self._open):
            self.headings[-1] += data


def test_page_of_a_completed_job(tmp_path: Path) -> None:
    """Properties of the project's elements by their names, with their lines; pictures inside the file."""
    run(FLAT, output_dir=tmp_path)
    page = Page(report(tmp_path / "flat_u2"))
    assert page.headings[0] == "flat_u2 completed"
    assert ["SIGMAMAX", "30", "mode I strength (stress)"] in page.rows
    (others,) = {tuple(row) for row in page.rows if row[0] == "the others" and "VISCOSITY" in row[2]}
    assert others[1] == "0"
    assert ["U2", "10", element_layouts()[2].meaning] in page.rows
    assert ["1 Step-1", "static analysis", "1", "1", "1", "0"] in page.rows
    assert any(re.fullmatch(r"INTERFACE: U2 flat_u2.inp:\d+", heading) for heading in page.headings)
    assert page.links
    assert {link.removeprefix("#") for link in page.links} <= set(page.places)
    assert len(page.images) >= 4
    assert all(image.startswith("data:image/") for image in page.images)
    assert not re.search(r"(src|href)=\"(?!data:|#)", page.text)
    assert "http" not in re.sub(r"data:[^\"]*", "", page.text)
    assert [row for row in page.rows if row[0] == "processor time in all"]


def test_names_that_a_deck_gives(tmp_path: Path) -> None:
    """Of a user element, and the number of those that have none."""
    deck = pulled(tmp_path)
    deck.write_text(deck.read_text().replace("PROPERTIES=1\n1\n", "PROPERTIES=1\n** PROPERTIES: k [N/mm], cubic\n1\n"))
    run(deck, SPRING_IN_C, output_dir=tmp_path)
    assert ["k [N/mm]", "1", "PROPS(1)"] in Page(report(tmp_path / "pulled")).rows
    deck.write_text(deck.read_text().replace("** PROPERTIES: k [N/mm], cubic\n", ""))
    run(deck, SPRING_IN_C, output_dir=tmp_path)
    assert ["PROPS(1)", "1", ""] in Page(report(tmp_path / "pulled")).rows


def test_page_of_a_job_that_failed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = snapping(tmp_path, "*STATIC\n0.1, 1., 1e-5, 0.1\n")
    deck.write_text(
        deck.read_text().replace("1, 1\n3, 1", "1, 1\n1, 2\n3, 1").replace("*NODE\n", "*HEADING\n<b>&\n*NODE\n")
    )
    assert main(["run", str(deck), "--user", str(SPRINGS), "--quiet", "--output-dir", str(tmp_path)]) == 1
    assert main(["report", str(tmp_path / "snap"), "-o", str(tmp_path / "page.html")]) == 0
    assert capsys.readouterr().out == f"written: {tmp_path}/page.html\n"
    page = Page(tmp_path / "page.html")
    assert page.headings[:3] == ["snap not completed", "Errors (2)", "Warnings (1)"]
    assert "TOO MANY ATTEMPTS MADE FOR THIS INCREMENT" in page.text
    # the warning of a boundary condition without effect leads to its line
    line = deck.read_text().splitlines().index("1, 2", 20) + 1
    assert f'<a href="#L{line}">{deck}:{line}</a>: *BOUNDARY has no effect' in page.text
    assert f"L{line}" in page.places
    assert "<b>&amp;" not in page.text
    assert "&lt;b&gt;&amp;" in page.text


def test_deck_that_has_changed_or_is_gone(tmp_path: Path) -> None:
    """With the parameters of the run."""
    deck = pulled(tmp_path)
    text = deck.read_text().replace("ELSET=ALL\n1., ", "ELSET=ALL\n<k>, ")
    deck.write_text(f"*PARAMETER\nk = 1.\n{text}")
    run(deck, SPRING_IN_C, output_dir=tmp_path, parameters={"k": 2.0})
    page = Page(report(tmp_path / "pulled"))
    assert ["PROPS(1)", "2", ""] in page.rows
    assert "has changed since the run" not in page.text
    deck.write_text(deck.read_text() + "** another line\n")
    assert (
        "pulled.inp has changed since the run: tables show it as it is now." in report(tmp_path / "pulled").read_text()
    )
    deck.unlink()
    page = Page(report(tmp_path / "pulled"))
    assert "The deck cannot be read any more: " in page.text
    assert "Model" not in page.headings


def test_job_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(UelError, match=r"nothing\.sta: no such job"):
        report(tmp_path / "nothing")


def test_layers_of_a_shell(tmp_path: Path) -> None:
    deck = tmp_path / "shell.inp"
    deck.write_text(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n*ELEMENT, TYPE=S3, ELSET=ALL\n1, 1, 2, 3\n"
        "*MATERIAL, NAME=PLY\n*ELASTIC\n100., 0.3\n*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 0.\n"
        "*SHELL SECTION, ELSET=ALL, COMPOSITE, OFFSET=SPOS, ORIENTATION=O\n0.25, 3, PLY, 45.\n0.5, 5, PLY\n"
        "*STEP\n*STATIC\n*END STEP\n"
    )
    (table,) = property_tables(read_deck(deck))
    assert table.rows == [
        ("thickness of PLY", "0.25", "layer 1, 45 degrees, 3 section points"),
        ("thickness of PLY", "0.5", "layer 2, 0 degrees, 5 section points"),
        ("offset", "0.5", "of the thickness"),
        ("orientation", "O", ""),
        ("E", "100", "*ELASTIC, TYPE=ISOTROPIC"),
        ("nu", "0.3", ""),
    ]


@pytest.mark.parametrize(
    ("kind", "rows"),
    [("CPE4", [("material", "M", ""), ("thickness", "2", "")]), ("C3D8", [("material", "M", "")])],
)
def test_only_solids_in_the_plane_have_a_thickness(tmp_path: Path, kind: str, rows: list[tuple[str, ...]]) -> None:
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))][: int(kind[-1])]
    nodes = "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(corners, 1))
    deck = tmp_path / "solid.inp"
    deck.write_text(
        f"*NODE\n{nodes}*ELEMENT, TYPE={kind}, ELSET=ALL\n1, {', '.join(map(str, range(1, len(corners) + 1)))}\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n100., 0.3\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n2.\n"
        "*STEP\n*STATIC\n*END STEP\n"
    )
    (table,) = property_tables(read_deck(deck))
    assert [*table.rows] == [*rows, ("E", "100", "*ELASTIC, TYPE=ISOTROPIC"), ("nu", "0.3", "")]
