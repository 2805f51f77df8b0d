# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of the benchmarks in space is what its command writes; rows and closed forms behind it."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from uel.paper import benchmarks, literature, literature_measures
from uel.paper.benchmarks import DECKS, PAGE, Benchmark, Row, calm_iterations, kept_rows, main, page

PULLED = """*NODE
1, 0., 0., 0.
2, 0., 0., 1.
*ELEMENT, TYPE=SPRINGA, ELSET=SPRING
1, 1, 2
*SPRING, ELSET=SPRING

10.,
*NSET, NSET=TOP
2,
*STEP
*STATIC
0.5, 1., 0.5, 0.5
*BOUNDARY
1, 1, 3
TOP, 1, 2
TOP, 3, 3, 0.1
*OUTPUT, FIELD
*NODE OUTPUT
U
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=TOP
U3, RF3
*END STEP
"""


def test_page_is_that_of_its_rows() -> None:
    rows = kept_rows(PAGE.with_suffix(".json"))
    assert set(rows) == set(DECKS)
    assert PAGE.read_text(encoding="utf-8") == page(rows)


def test_page_says_what_is_not_met() -> None:
    row = Row("", 30, 10, 5, 40, 5.0, 60.0, 90.0, 100.0, {"load (N)": (100.0, 97.0), "nothing": (0.0, 0.1)})
    good = page({"good": row})
    assert "| `good` | 30 | 10 | 5 | 40 | 5.00 | 60 s | 2 min | 100 MB |" in good
    assert "| `good` | load (N) | 100 | 97 | -3.0 % |" in good
    assert "| `good` | nothing | 0 | 0.1 |  |" in good
    assert "not met" not in good
    slow = Row("", 30, 10, 6, 40, 5.0, 60.0, 90.0, 100.0, {})
    assert "5.00, **not met**" in page({"slow": slow})
    ended = Row("too many attempts", 30, 10, 0, 40, 2.0, 60.0, 90.0, 100.0, {})
    assert "`ended` stopped: too many attempts" in page({"ended": ended})


def test_iterations_away_from_snaps() -> None:
    """Load 1, 2, 3, 1 (a snap), 1, 1: attempts given up count for the increment that they belong to."""
    attempts = [
        (1, False, 2),
        (2, False, 2),
        (3, True, 4),
        (3, False, 2),
        (4, False, 50),
        (5, False, 20),
        (6, False, 4),
    ]
    status = [SimpleNamespace(step=1, increment=i, cutback=cut, total_iterations=n) for i, cut, n in attempts]
    result = SimpleNamespace(status=status)
    load = np.array([1.0, 2.0, 3.0, 1.0, 1.0, 1.0])
    assert calm_iterations(result, load) == pytest.approx((2 + 2 + 6 + 4) / 4)  # type: ignore[arg-type]


def test_a_run_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(DECKS, "pulled", lambda: PULLED)
    monkeypatch.setattr(benchmarks, "values_of", lambda name, result: {"name": (1.0, len(name))})
    row = benchmarks.measure(Benchmark("pulled"), tmp_path)
    assert (row.stopped, row.unknowns, row.increments, row.cutbacks) == ("", 6, 2, 0)
    assert row.values == {"name": (1.0, 6.0)}
    assert 10.0 < row.memory < 4000.0
    assert row.cpu > 0.0
    assert benchmarks.read_row(row.to_json()) == row


def test_a_name_that_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["circles"])
    assert "no benchmark circles; expected one of krueger_dcb, mmb_20" in capsys.readouterr().err


def test_loads_of_the_benchmark_itself() -> None:
    """By displacement and by compliance: a run that has the values of the report."""
    moved, force = np.array([(0.0, 0.0), *literature.DCB_CRITICAL.values()]).T
    result = SimpleNamespace(history={"U3[TOP:7]": moved, "RF3[TOP:7]": 0.3 * force, "RF3[TOP:8]": 0.2 * force})
    for function in (literature_measures.loads_at_openings, literature_measures.loads_at_compliances):
        found = function(result)  # type: ignore[arg-type]
        assert found == pytest.approx({length: load for length, (_, load) in literature.DCB_CRITICAL.items()})


def test_circular_delamination_by_its_energy() -> None:
    """The closed form against a numerical derivative of the complementary energy of two clamped plates."""

    def energy(radius: float, load: float) -> float:
        return 2.0 * load**2 * radius**2 / (32.0 * math.pi * literature.circle_bending())

    load = literature.circle_load()
    for radius in (10.0, 30.0):
        step = 1e-4 * radius
        area = 2.0 * math.pi * radius * 2.0 * step
        release = (energy(radius + step, load) - energy(radius - step, load)) / area
        assert release == pytest.approx(literature.CIRCLE_TOUGHNESS, rel=1e-6)
