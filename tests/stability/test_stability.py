# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bonded interfaces beside every built-in solid are stable: shares of tests/programs/stability, and its page."""

from pathlib import Path

import bonded_pairs
import numpy as np
import pytest
import stability
from bonded_pairs import BETWEEN, RIGID, SOFT, Measures
from random_pairs import NAMES, kinds, random_ply, random_shapes

from uel import usersub

PAGE = Path(__file__).parents[2] / "fortran" / "beta.md"
KINDS = {kind.name: kind for kind in kinds()}
ALL = pytest.mark.parametrize("name", KINDS)
SEED = 2
"""Another one than that of the page."""


def page_rows():
    """Cells of the page's table by name of the pair."""
    text = PAGE.read_text("utf-8").partition(stability.BEGIN)[2].partition(stability.END)[0]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:3] == "| U"]
    return {" ".join(row[:3]): row for row in cells}


@pytest.mark.sample(3)
@ALL
def test_a_sample_of_each_pair(name):
    """Ten shapes with each stiffness: no negative eigenvalue, symmetric, and beta suffices."""
    row = stability.run_kind(KINDS[name], range(3), SEED, 10)
    assert row.cases == 30
    assert not row.failed, (row.cells, row.further)


@pytest.mark.long
@ALL
def test_many_of_each_pair(name):
    row = stability.run_kind(KINDS[name], range(3, 30), SEED)
    assert not row.failed, (row.cells, row.further)


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", NAMES)
def test_laminates(name):
    """Assembled, as `uel insert` bonds them."""
    assert stability.run_laminates(name, range(2), SEED) > -stability.ROUNDING


def test_every_element_that_owns_its_solids_is_there():
    """U3 and U10 take the stress of others and have no complete form."""
    layouts = bonded_pairs.element_layouts()
    assert {kind.jtype for kind in KINDS.values()} == {jtype for jtype, layout in layouts.items() if layout.solids}


def test_plies_come_close_to_what_the_material_permits():
    """The smallest eigenvalue of the matrix of ones and -nu_ij sqrt(E_j/E_i) is positive, down to 1e-4."""
    rng, smallest = np.random.default_rng(1), []
    for _ in range(300):
        ply = random_ply(rng, 1.0)
        matrix = np.eye(3)
        for i, j in ((1, 2), (1, 3), (2, 3)):
            coupling = ply[f"NU{i}{j}"] * np.sqrt(ply[f"E{j}"] / ply[f"E{i}"])
            matrix[i - 1, j - 1] = matrix[j - 1, i - 1] = -coupling
        smallest.append(np.linalg.eigvalsh(matrix)[0])
    assert 1e-4 * (1 - 1e-9) < min(smallest) < 2e-4
    assert max(smallest) > 0.5


def test_shapes_are_flat_and_tall():
    """Geometry of two quads: areas over the square of the common edge from about 1/50 to 50, in either order."""
    shapes = random_shapes(4, np.random.default_rng(1), 400)
    edge = np.linalg.norm(shapes[:, 2] - shapes[:, 3], axis=1)
    np.testing.assert_allclose(shapes[:, [4, 5]], shapes[:, [3, 2]])
    for quad in (shapes[:, :4], shapes[:, 4:]):
        first, second = quad[:, 2] - quad[:, 0], quad[:, 3] - quad[:, 1]
        height = 0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / edge**2
        assert (height > 0).all()
        assert height.min() < 0.04 and height.max() > 25


# --- what is wrong is seen


@pytest.mark.parametrize(
    "wrong",
    [{"lowest": -1e-11}, {"betti": 2e-10}, {"needed": 1.001}, {"needed": np.inf}],
    ids=["eigenvalue", "unsymmetric", "beta", "infinite beta"],
)
def test_a_row_fails(wrong):
    right = {"lowest": -1e-15, "betti": 1e-16, "needed": 1.0}
    for law in (RIGID, SOFT):
        row = stability.Row(KINDS["U4 CPS4 CPS4"])
        row.add(0, law, Measures(**{name: np.array([value]) for name, value in right.items()}))
        assert not row.failed
        row.add(1, law, Measures(**{name: np.array([0.0, value]) for name, value in (right | wrong).items()}))
        assert row.failed
        assert row.worst == ("1.1" if "needed" in wrong else "0.0")


@pytest.mark.parametrize("name", ["U4 CPS4R CPS4R", "U8 C3D8R C3D8R"])
def test_the_stress_of_another_formulation_is_seen(monkeypatch, capsys, name):
    """Solids of one point beside an interface that takes them for fully integrated: the command fails."""
    monkeypatch.setattr(bonded_pairs, "formulation_of", lambda kind: 0)
    row = stability.run_kind(KINDS[name], range(3), SEED, 10)
    assert row.failed
    assert row.lowest < -stability.ROUNDING
    monkeypatch.setattr(stability, "run_kind", lambda kind, **options: row)
    monkeypatch.setattr(stability, "ProcessPoolExecutor", InThisProcess)
    assert stability.main(["--only", name, "--laminates", "1"]) == 1
    assert name.split()[1] in capsys.readouterr().out


class InThisProcess:
    """Pool of processes that calls functions at once."""

    def __init__(self, workers):
        self.map = map

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        pass


@pytest.mark.parametrize("name", ["U4 CPE4 CPE4R", "U68 CPS6 CPS8R", "U8 C3D8I C3D8R", "U1010 C3D10 C3D10"])
def test_needed_multiple(tmp_path, name):
    """With 1 % more of beta there is no negative eigenvalue, with 1 % less there is one."""
    kind, rng = KINDS[name], np.random.default_rng(3)
    library = usersub.load(None, job="stability", output_dir=tmp_path)
    batches = {law: bonded_pairs.make_batch(library, kind, rng, 4, law) for law in (RIGID, SOFT)}
    rigid, soft = batches[RIGID], batches[SOFT]
    normal, shear = bonded_pairs.jump_matrices(library, kind, rigid.shapes, rigid.integration)
    jumps = rigid.beta[:, :1, None] * normal + rigid.beta[:, 1:, None] * shear
    needed = {RIGID: bonded_pairs.needed_rigid(library, kind, rigid), SOFT: bonded_pairs.needed_soft(kind, soft)}
    library.close()
    for share, stable in ((1.01, True), (0.99, False)):
        factor = {law: (share * values)[:, None, None] for law, values in needed.items()}
        for whole in (
            0.5 * rigid.solids + rigid.own + (factor[RIGID] - 1.0) * jumps,
            0.5 * soft.solids + soft.own / factor[SOFT],
        ):
            values = np.linalg.eigvalsh(0.5 * (whole + whole.transpose(0, 2, 1)))
            assert ((values[:, 0] > -1e-13 * values[:, -1]) == stable).all()


def test_energy_grows_with_the_stiffness(tmp_path):
    """So that a law between the infinite and the smallest stiffness needs no more than the latter."""
    kind = KINDS["U43 CPE4I CPE3"]
    library = usersub.load(None, job="stability", output_dir=tmp_path)
    batches = [bonded_pairs.make_batch(library, kind, np.random.default_rng(3), 4, law) for law in (SOFT, RIGID)]
    library.close()
    soft, rigid = (0.5 * (batch.own + batch.own.transpose(0, 2, 1)) for batch in batches)
    values = np.linalg.eigvalsh(rigid - soft)
    assert (values[:, 0] > -1e-12 * values[:, -1]).all()
    assert BETWEEN not in (SOFT, RIGID)


# --- page and command


def test_page_has_every_pair():
    rows = page_rows()
    assert list(rows) == list(KINDS)
    for row in rows.values():
        assert int(row[3]) >= 1000
        assert float(row[4]) <= float(row[5]) <= 1.0


@pytest.mark.sample(3)
@ALL
def test_worst_cases_of_the_page(name):
    """Their batch again: to the digits of the page."""
    _, _, _, _, _, needed, worst = page_rows()[name]
    batch, case = map(int, worst.split("."))
    row = stability.run_kind(KINDS[name], [batch], stability.SEED)
    assert row.soft == pytest.approx(float(needed), abs=1e-3)
    assert 0 <= case < bonded_pairs.BATCH


def test_page_is_written_between_its_marks(monkeypatch, tmp_path):
    row = stability.Row(KINDS["U4 CPS4 CPS4"])
    row.add(4, RIGID, Measures(np.array([-1e-16]), np.array([2e-16]), np.array([0.75])))
    monkeypatch.setattr(stability, "run_kind", lambda kind, **options: row)
    monkeypatch.setattr(stability, "run_laminates", lambda name, **options: -3e-16)
    monkeypatch.setattr(stability, "ProcessPoolExecutor", InThisProcess)
    page = tmp_path / "page.md"
    page.write_text(f"above\n{stability.BEGIN}old\n{stability.END}below\n")
    assert stability.main(["--page", str(page)]) == 0
    text = page.read_text()
    assert "old" not in text and text.startswith(f"above\n{stability.BEGIN}") and text.endswith("below\n")
    assert "| U4 | CPS4 | CPS4 | 1 | 0.750 | 0.750 | 4.0 |" in text
    assert "-3e-16 or more" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--only", "CPS5"], "--only CPS5: no pair has that in its name, such as U4 CPS4 CPS4"),
        (["--only", "CPS4", "--page", "page.md"], "--page: expected all pairs, without --only"),
    ],
)
def test_wrong_arguments(capsys, arguments, message):
    with pytest.raises(SystemExit):
        stability.main(arguments)
    assert message in capsys.readouterr().err
