# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which runs a batch has, and what their results depend on."""

from pathlib import Path

import pytest
from batch_decks import MESH, PULLED, SPRING

from uel.batch.runs import Settings, list_runs
from uel.errors import CompileError, DeckError, UsageError


def inputs(*, table: bool = False, user: Path = SPRING, options: tuple[str, ...] = ()) -> list[dict[str, str]]:
    """What the results of the runs depend on."""
    rows = Path("values.csv") if table else None
    return [run.files() for run in list_runs([Path("pulled.inp")], rows, Settings([user], options))]


def test_decks_of_a_folder(pulled: Path) -> None:
    """Not those that others include, and not other files; in the order of their names."""
    Path("other.INP").write_text("*HEADING\nnothing\n")
    Path("notes.txt").write_text("nothing")
    Path("empty.inp").write_text("")
    Path("folder.inp").mkdir()
    runs = list_runs([Path()], None, Settings())
    assert [run.name for run in runs] == ["empty", "other", "pulled"]
    assert [run.deck for run in runs] == [Path("empty.inp"), Path("other.INP"), pulled]


def test_rows_of_a_table(pulled: Path) -> None:
    """They are named by their number, or by the table."""
    Path("values.csv").write_text("pull\n1\n2\n")
    runs = list_runs([pulled], Path("values.csv"), Settings())
    assert [(run.name, run.values) for run in runs] == [
        ("pulled-1", (("pull", "1"),)),
        ("pulled-2", (("pull", "2"),)),
    ]
    Path("values.csv").write_text("pull,job\n1,soft\n")
    (run,) = list_runs([pulled], Path("values.csv"), Settings())
    assert (run.name, run.values) == ("soft", (("pull", "1"),))


def test_what_results_depend_on(pulled: Path, tmp_path: Path) -> None:
    before = inputs()
    assert inputs() == before
    user = tmp_path / "user.c"
    user.write_text(SPRING.read_text())
    for change in (
        lambda: pulled.write_text(PULLED.replace("0.1", "0.2")),
        lambda: Path("mesh.inp").write_text(MESH.replace("2, 1.", "2, 3.")),
    ):
        change()
        now = inputs()
        assert now != before
        before = now
    assert inputs(options=("--fallback",)) != before
    # a user file, and what it includes
    for header in ('#include "more.h"\n', '#define MORE "more.h"\n#include MORE\n'):
        user.write_text(header + SPRING.read_text())
        (tmp_path / "more.h").write_text("/* one */")
        before = inputs(user=user)
        (tmp_path / "more.h").write_text("/* two */")
        assert inputs(user=user) != before
    library = tmp_path / "user.so"
    library.write_bytes(b"1")
    before = inputs(user=library)
    library.write_bytes(b"2")
    assert inputs(user=library) != before


@pytest.mark.parametrize("header", ['#include "more.h"\n', '#define MORE "more.h"\n#include MORE\n'])
def test_inputs_are_the_same_on_another_machine(
    pulled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, header: str
) -> None:
    """It has no compiled files yet, or cannot keep them, and has the user files at another place."""
    seen = []
    for machine in ("one", "two"):
        (tmp_path / machine).mkdir()
        (tmp_path / machine / "more.h").write_text("/* more */")
        (tmp_path / machine / "user.c").write_text(header + SPRING.read_text())
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / machine / "cache"))
        seen += [inputs(user=tmp_path / machine / "user.c") for _ in range(2)]
    (tmp_path / "two" / "cache" / "uel" / "compiled").chmod(0o777)
    seen.append(inputs(user=tmp_path / "two" / "user.c"))
    assert seen == [seen[0]] * 5


def test_values_on_which_results_depend(pulled: Path) -> None:
    """And files that a parameter chooses."""
    Path("values.csv").write_text("pull\n1\n2\n")
    first, second = inputs(table=True)
    assert first != second
    pulled.write_text(PULLED.replace("mesh.inp", "mesh<pull>.inp").replace("0.1", "1"))
    for number in (1, 2):
        Path(f"mesh{number}.inp").write_text(MESH)
    first, second = inputs(table=True)
    Path("mesh2.inp").write_text(MESH.replace("2, 1.", "2, 3."))
    assert inputs(table=True)[0] == first
    assert inputs(table=True)[1] != second


def test_mistakes(pulled: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"^none\.inp: no such deck or folder$"):
        list_runs([Path("none.inp")], None, Settings())
    (tmp_path / "sub").mkdir()
    with pytest.raises(UsageError, match=r"^sub: the folder has no decks; expected files that end in \.inp$"):
        list_runs([Path("sub")], None, Settings())
    (tmp_path / "sub" / "pulled.inp").write_text(PULLED)
    message = r"^pulled\.inp and sub/pulled\.inp: two decks have one name, and would write into one folder$"
    with pytest.raises(UsageError, match=message):
        list_runs([pulled, Path("sub")], None, Settings())
    assert len(list_runs([pulled, pulled], None, Settings())) == 1
    Path("values.csv").write_text("pull\n1\n")
    with pytest.raises(UsageError, match=r"^--table values\.csv: expected one deck, found 2$"):
        list_runs([pulled, Path("mesh.inp")], Path("values.csv"), Settings())
    with pytest.raises(CompileError, match=r"^none\.f: no such file$"):
        list_runs([pulled], None, Settings([Path("none.f")]))
    pulled.write_text("")
    with pytest.raises(DeckError, match=r"^pulled\.inp:1: the deck is empty$"):
        list_runs([pulled], Path("values.csv"), Settings())
