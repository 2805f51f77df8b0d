# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What CONTRIBUTING says of adding kinematics of continuum elements, done on a copy of the host.

branch/selective.f90 takes the place of the mean dilatation in C3D8: the volume strain of all points is that in the
middle (T.J.R. Hughes, Int. J. for Numerical Methods in Engineering 15 (1980) 1413). In a brick that is the mean, too.
"""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from uel.usersub._extension import host

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[3]
SOURCE = Path(__file__).parent / "branch" / "selective.f90"
SOLID = "fortran/host/elements/solid/solid.f90"

EDITS = {
    "fortran/host/meson.build": [
        ("  'elements/solid/solid.f90',\n", "  'elements/solid/selective.f90',\n  'elements/solid/solid.f90',\n")
    ],
    SOLID: [
        ("  use host_shape,", "  use host_selective, only: selective_t\n  use host_shape,"),
        (
            "  !$omp threadprivate(standard, ",
            "  type(selective_t), target, save :: selective\n  !$omp threadprivate(selective, standard, ",
        ),
        ("      kinematics => mean_dilatation\n", "      kinematics => selective\n"),
    ],
}
"""Edits of a file: what is there, what takes its place. The file of the kinematics itself is new."""

FORCES = """
import json, sys
from pathlib import Path
import numpy as np
from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags

deck = Path(sys.argv[1])
model = read_deck(deck)
library = usersub.load(None, job="job", output_dir=deck.parent, deck=deck)
system = system_of(model, library)
u = np.array(json.loads(sys.argv[2]))
found = system.evaluate(Call(Flags(1), 1, 1, 1.0, 1.0, 1.0, 1.0), u, u)
print(json.dumps(found.residual.tolist()))
"""
"""Program that prints the residual of the element of a deck at given displacements."""

CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=float
)
BRICK = CORNERS * [2.0, 1.0, 0.5]
DISTORTED = CORNERS + 0.15 * np.sin(1.0 + np.arange(24.0).reshape(8, 3))
YOUNG, POISSON = 1000.0, 0.45


@pytest.fixture(scope="module")
def branch(tmp_path_factory):
    """Folder of a package whose host has the kinematics."""
    folder = tmp_path_factory.mktemp("branch")
    shutil.copytree(ROOT / "fortran", folder / "fortran")
    shutil.copytree(ROOT / "harness" / "uel", folder / "uel", ignore=shutil.ignore_patterns("__pycache__"))
    for table in (ROOT / "fortran").glob("*.toml"):
        shutil.copy(table, folder / "uel" / "usersub")
    shutil.copy(SOURCE, folder / "fortran" / "host" / "elements" / "solid")
    for name, edits in EDITS.items():
        text = (folder / name).read_text()
        for old, new in edits:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        (folder / name).write_text(text)
    whole = (ROOT / "meson.build").read_text()
    (folder / "meson.build").write_text(whole.partition("install_subdir(")[0])
    programs = Path(sys.executable).parent
    tools = os.environ | {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    libraries = [f"fortran/host/{Path(host.__file__).name}", "fortran/kernels.so"]
    for command in (["meson", "setup", "build", "-Dbuildtype=plain"], ["ninja", "-C", "build", *libraries]):
        run = subprocess.run(
            [programs / command[0], *command[1:]], cwd=folder, env=tools, capture_output=True, check=False
        )
        assert run.returncode == 0, run.stdout.decode()
    for library in libraries:
        shutil.copy(folder / "build" / library, folder / "uel" / "usersub")
    return folder


@pytest.fixture(scope="module")
def forces(branch, tmp_path_factory):
    """Forces of a C3D8 with corners x (8, 3) and displacements u (8, 3), in the branch."""

    def found(x, u):
        deck = tmp_path_factory.mktemp("job") / "job.inp"
        nodes = [f"{k}, {', '.join(map(repr, map(float, place)))}" for k, place in enumerate(x, start=1)]
        deck.write_text(
            "\n".join(["*NODE", *nodes, "*ELEMENT, TYPE=C3D8, ELSET=ALL", "1, 1, 2, 3, 4, 5, 6, 7, 8"])
            + "\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n"
            + f"{YOUNG}, {POISSON}\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n1, 1, 3\n*END STEP\n"
        )
        # without the file that makes an editable package importable
        paths = os.pathsep.join([str(branch), *{sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}])
        command = [sys.executable, "-S", "-c", FORCES, str(deck), json.dumps(u.ravel().tolist())]
        run = subprocess.run(
            command, env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True, check=False
        )
        assert run.returncode == 0, run.stderr
        return np.array(json.loads(run.stdout)).reshape(8, 3)

    return found


def strain_matrix(x, at):
    """Strains by the displacements of the corners at parent coordinates, (6, 24), and the Jacobian."""
    signs = 2 * CORNERS - 1
    ones = 1 + signs * at
    slopes = signs * np.column_stack([ones[:, 1] * ones[:, 2], ones[:, 2] * ones[:, 0], ones[:, 0] * ones[:, 1]]) / 8
    jacobian = x.T @ slopes
    g = slopes @ np.linalg.inv(jacobian)
    b = np.zeros((6, 8, 3))
    for i in range(3):
        b[i, :, i] = g[:, i]
    for k, (i, j) in enumerate([(0, 1), (0, 2), (1, 2)], start=3):
        b[k, :, i], b[k, :, j] = g[:, j], g[:, i]
    return b.reshape(6, 24), np.linalg.det(jacobian)


def expected(x, u, *, middle=True):
    """Forces with the volume strain in the middle, or with its mean."""
    shear = YOUNG / (2 * (1 + POISSON))
    lame = 2 * shear * POISSON / (1 - 2 * POISSON)
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lame
    points = [strain_matrix(x, np.array(at) / np.sqrt(3)) for at in product((-1, 1), repeat=3)]
    common = sum(j * b[:3].sum(axis=0) for b, j in points) / sum(j for _, j in points)
    if middle:
        common = strain_matrix(x, np.zeros(3))[0][:3].sum(axis=0)
    force = np.zeros(24)
    for b, j in points:
        b[:3] += (common - b[:3].sum(axis=0)) / 3
        force += j * b.T @ law @ b @ u.ravel()
    return force.reshape(8, 3)


@pytest.mark.parametrize("x", [BRICK, DISTORTED], ids=["brick", "distorted"])
def test_forces_are_those_of_selective_integration(forces, x):
    u = 0.01 * np.cos(np.arange(24.0)).reshape(8, 3)
    force = expected(x, u)
    # rounding of sums over eight points
    np.testing.assert_allclose(-forces(x, u), force, atol=1e-12 * np.abs(force).max())


def test_the_middle_has_the_mean_of_a_brick_alone():
    u = 0.01 * np.cos(np.arange(24.0)).reshape(8, 3)
    np.testing.assert_allclose(expected(BRICK, u), expected(BRICK, u, middle=False), atol=1e-12)
    assert np.abs(expected(DISTORTED, u) - expected(DISTORTED, u, middle=False)).max() > 1e-3
