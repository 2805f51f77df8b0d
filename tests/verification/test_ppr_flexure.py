# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The PPR law in a structure: in mode II, with exponent 2 and infinite stiffness, it is the bilinear law."""

from pathlib import Path

import numpy as np
import pytest

from uel.delamination import flexure, specimens
from uel.delamination.blocks import BY_EQUATION_21, Interface, Specimen
from uel.delamination.materials import PLY_0, TABLE_2
from uel.delamination.steps import Increments
from uel.paper.measures import iterations
from uel.running.job import run

INCREMENTS = Increments(initial=0.02, smallest=1e-7, largest=0.02, limit=200)


@pytest.mark.long
def test_end_notched_flexure(tmp_path: Path) -> None:
    # coarse: the process zone of mode II is long
    mesh = flexure.enf_mesh(0.5, 0.0)
    interface = Interface("U4", TABLE_2.with_stiffness(0.0), BY_EQUATION_21)
    deck = flexure.enf_deck(
        "ENF", Specimen("mesh", mesh, interface, specimens.WIDTH, PLY_0, PLY_0), 4.0, INCREMENTS, 100
    )
    for name, content in specimens.mesh_files("mesh", mesh, (8,)).items():
        (tmp_path / name).write_text(content, encoding="ascii")
    results = {}
    for law in (1, 4):
        words, changed = "\n0., 1, ", f"\n0., {law}, "
        assert deck.count(words) == 1
        (tmp_path / f"law_{law}.inp").write_text(deck.replace(words, changed), encoding="ascii")
        results[law] = run(tmp_path / f"law_{law}.inp", output_dir=tmp_path)
    loads = {law: -result.history["RF2[MIDSPAN]"] for law, result in results.items()}
    # opening is small beside sliding, but not nothing
    assert loads[4].max() == pytest.approx(loads[1].max(), rel=1e-3)
    assert loads[4][-1] == pytest.approx(loads[1][-1], rel=1e-3)
    profiles = {law: result.interface() for law, result in results.items()}
    np.testing.assert_allclose(profiles[4]["TT"], profiles[1]["TT"], atol=0.6)
    assert (profiles[4]["DAMAGE"] == 1).sum() >= 10
    assert iterations(results[4]) <= 1.2 * iterations(results[1])
