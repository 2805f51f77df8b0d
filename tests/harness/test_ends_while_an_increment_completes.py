# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs that end while a converged increment is completed.

An increment that FREQUENCY leaves out is written where the run ends with it, unless the states of the next increment
have replaced its own.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from uel.cli import main
from uel.output import Result

USER = Path(__file__).with_name("ends_of_increments.f90")
DECK = """\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*NSET, NSET=END
2
*ELEMENT, TYPE=CPS4, ELSET=ALL
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=ALL, MATERIAL={material}
1.
*MATERIAL, NAME={material}
*ELASTIC
1000., 0.3
*USER OUTPUT VARIABLES
1
*STEP
*STATIC, DIRECT
0.25, 1.
*BOUNDARY
1, 1, 2
4, 1, 1
2, 1, 1, 0.01
3, 1, 1, 0.01
*OUTPUT, FIELD, FREQUENCY=99
*NODE OUTPUT
U
*ELEMENT OUTPUT
S
*OUTPUT, HISTORY, FREQUENCY=99
*NODE OUTPUT, NSET=END
U1
*END STEP
"""


def increments(stem: Path) -> list[int]:
    """Those that the status file names."""
    return [row.increment for row in Result(stem).status]


def test_xit_at_the_end_of_an_increment(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """UEXTERNALDB (LOP=2) is called when the increment is recorded, which is then the last one of the run."""
    stem = tmp_path / "ended"
    stem.with_suffix(".inp").write_text(DECK.format(material="PLAIN"))
    assert main(["run", f"{stem}.inp", "--user", str(USER), "--output-dir", str(tmp_path), "--quiet"]) == 1
    assert "ended after increment 3 of step 1 (of 1), step time 0.75 of 1" in capsys.readouterr().err
    assert increments(stem) == [1, 2, 3]
    assert list(Result(stem).history["increment"]) == [3]
    assert len(list((tmp_path / "ended_vtu").iterdir())) == 1
    assert "WRITTEN FOR THE LAST CONVERGED INCREMENT" in " ".join(stem.with_suffix(".msg").read_text().split())


def test_xit_while_the_states_change(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In UVARM; all that is lost is the output that is still owed, and the files say so."""
    stem = tmp_path / "ended"
    stem.with_suffix(".inp").write_text(DECK.format(material="UVARM"))
    assert main(["run", f"{stem}.inp", "--user", str(USER), "--output-dir", str(tmp_path), "--quiet"]) == 1
    said = capsys.readouterr().err
    assert said.startswith("uel: element 1 (type CPS4): UVARM at integration point 1 stopped the analysis (XIT)")
    assert "ended after increment 2 of step 1 (of 1), step time 0.5 of 1; what was written is readable" in said
    assert increments(stem) == [1, 2]
    message = " ".join(stem.with_suffix(".msg").read_text().split())
    assert "THE OUTPUT REQUESTED FOR INCREMENT 2 OF STEP 1 COULD NOT BE WRITTEN." in message
    assert "LAST CONVERGED INCREMENT" not in message
    assert stem.with_suffix(".sta").read_text().endswith(" THE ANALYSIS HAS NOT BEEN COMPLETED\n")


SIGNAL = """
import os, signal, sys
from uel import cli, interrupts
from uel.assembly import system
interrupts.raise_interrupts()
commit = system.System.commit
def committing(self):
    commit(self)
    committing.calls += 1
    if committing.calls == 3:
        os.kill(os.getpid(), signal.SIGTERM)
committing.calls = 0
system.System.commit = committing
sys.exit(cli.main(["run", "--same-process", "--quiet", sys.argv[1], "--output-dir", sys.argv[2]]))
"""


def test_signal_while_an_increment_is_completed(tmp_path: Path) -> None:
    """It waits until the increment is recorded."""
    stem = tmp_path / "ended"
    stem.with_suffix(".inp").write_text(DECK.format(material="PLAIN").replace("*USER OUTPUT VARIABLES\n1\n", ""))
    command = [sys.executable, "-c", SIGNAL, f"{stem}.inp", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stderr.splitlines() == [
        "uel: ended by a user or the system (SIGTERM)",
        "uel: ended ended after increment 3 of step 1 (of 1), step time 0.75 of 1; what was written is readable",
    ]
    assert increments(stem) == [1, 2, 3]
    assert list(Result(stem).history["increment"]) == [3]
