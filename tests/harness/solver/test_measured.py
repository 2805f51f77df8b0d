# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of the linear solvers is what its command writes, and `auto` goes by its times."""

from itertools import groupby

import scaling

from uel.solver.linear.choice import SOLVERS
from uel.solver.linear.measured import PAGE, Measured, page, read


def test_page_has_the_rows_kept() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert page(text, read()) == text


def cost(row: Measured) -> float:
    """Of an iteration while a crack grows."""
    assert row.full is not None
    return row.solution + (row.full if row.part is None else row.part)


def test_auto_takes_one_of_the_fastest_solvers() -> None:
    """At most half as long again as the other on each matrix measured, whichever of the sparse solvers is installed."""
    _, rows = read()
    compared = 0
    for (matrix, _), group in groupby(rows, key=lambda row: (row.matrix, row.unknowns)):
        times = {row.solver: row for row in group if row.solver in SOLVERS}
        for other in times.keys() - {"band"}:
            if "band" not in times:
                continue
            band, sparse = times["band"], times[other]
            narrow = band.width <= SOLVERS[other].widest_band[matrix.startswith("3D")]
            taken = band if narrow else sparse
            assert cost(taken) <= 1.5 * min(cost(band), cost(sparse)), (taken, other)
            compared += 1
    assert compared >= 10


def test_page_has_the_rows_of_the_sizes_kept() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert scaling.page(text, scaling.read()) == text


def test_iterations_cost_no_more_than_their_factorisation() -> None:
    rows = scaling.read()[1]
    assert rows.keys() == scaling.CASES.keys()
    assert all(row.ratio <= scaling.LARGEST_RATIO for row in rows.values())


def test_a_million_unknowns_in_space_fit_into_memory() -> None:
    row = scaling.read()[1]["3D, path, 1 M"]
    assert row.unknowns >= 1e6
    assert row.memory <= 16 * 1024
