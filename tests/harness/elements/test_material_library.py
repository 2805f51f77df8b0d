# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The host's library of materials holds as many as a graded mesh has sections, and those of open jobs alone."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from uel import usersub
from uel.assembly import System, system_of
from uel.deck import read_deck
from uel.elements import Call, Flags

PROGRAM = """
import numpy as np
from uel.usersub import _materials

for _ in range(20000):
    number = _materials.define_material(np.eye(3), np.eye(3), np.zeros(3), np.eye(3), (1.0, 0.0), np.zeros((1, 2)))
print(number)
"""


def test_many_materials():
    """In a process of its own: a copy of all of them on the stack ends it by a segmentation fault."""
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, "20000")


TRUSS = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
*ELEMENT, TYPE=T3D2, ELSET=BAR
1, 1, 2
*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL
2.
*MATERIAL, NAME=STEEL
*ELASTIC
1000., 0.3
*STEP
*STATIC
*END STEP
"""


def _truss(folder: Path, job: str) -> tuple[System, usersub.Library]:
    deck = folder / f"{job}.inp"
    deck.write_text(TRUSS)
    model = read_deck(deck)
    library = usersub.load(None, job=job, output_dir=folder, deck=deck)
    return system_of(model, library), library


def _pull(system: System) -> float:
    u = np.array([0.0, 0.0, 0.0, 0.01, 0.0, 0.0])
    evaluation = system.evaluate(Call(Flags(1), 1, 1, 1.0, 1.0, 1.0, 1.0), u, np.zeros(6))
    return float(np.abs(evaluation.residual).max())


PROGRAM_OF_JOBS = """
import sys
from pathlib import Path
from test_material_library import _pull, _truss
from uel.errors import UelError
folder = Path(sys.argv[1])
first, one = _truss(folder, "one")
second, two = _truss(folder, "two")
print(_pull(first), _pull(second))
one.close()
third, three = _truss(folder, "three")
print(_pull(second), _pull(third))
two.close()
three.close()
fourth, four = _truss(folder, "four")
print(_pull(fourth))
try:
    _pull(third)
except UelError as error:
    print(error)
"""


def test_materials_of_jobs_that_have_ended(tmp_path):
    """In a process of its own, where no other job is open."""
    path = [str(Path(__file__).parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    variables = os.environ | {"PYTHONPATH": os.pathsep.join(path)}
    command = [sys.executable, "-c", PROGRAM_OF_JOBS, str(tmp_path)]
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    *pulls, lost = done.stdout.splitlines()
    assert pulls == ["20.0 20.0", "20.0 20.0", "20.0"]
    assert "the material of these elements was that of a job that has ended" in lost
