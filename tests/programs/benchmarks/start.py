# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a small job costs before it computes, and reading a large deck: `make start`.

Each is measured in processes of its own, in an environment that has the package as pip installs it, in turns with the
libraries that every job loads. Seconds are those of the processor in all processes. Judged is the least: what else runs
on the machine, or on the one below a virtual machine, only adds to it; the median tells how much.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import sysconfig
import tempfile
import venv
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from solvers import in_plane

import uel
from uel.delamination import specimens
from uel.delamination.steps import Increments

FACTOR = 6
"""Each quad of DCB-ref is cut into FACTOR x FACTOR ones: 172,800, and 3,090 interface elements."""
TURNS = 12
LIBRARIES = (
    "import os; os.environ['OPENBLAS_NUM_THREADS'] = '1'; import numpy, scipy.linalg, scipy.sparse.linalg, meshio"
)
READ = "import sys; from pathlib import Path; import uel.deck; uel.deck.read_deck(Path(sys.argv[1]))"


def environment(folder: Path) -> Path:
    """Python of an environment with the packages of this one, and with the harness from where it is imported here.

    An editable package is looked for by each process anew, which takes time.
    """
    venv.create(folder, with_pip=False)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(folder), "platbase": str(folder)}))
    packages.joinpath("all.pth").write_text(f"{Path(uel.__file__).parents[1]}\n{sysconfig.get_path('purelib')}\n")
    return folder / "bin" / "python"


def small(folder: Path) -> Path:
    """The patch test of section 4.1.1 in ten increments: 100 quads and 10 interface elements."""
    mesh = specimens.patch_mesh(0.0)
    specimen = specimens.patch_specimen("patch", mesh, "U3", specimens.PATCH_BETA)
    for name, content in specimens.mesh_files("patch", mesh, (4,)).items():
        (folder / name).write_text(content, encoding="ascii")
    deck = folder / "patch.inp"
    text = specimens.patch_deck("patch", specimen, -0.1, Increments(0.1, 1e-5, 0.1, 100), slide=False)
    deck.write_text(text, encoding="ascii")
    return deck


def seconds(command: list[str], folder: Path) -> float:
    """Time of the processor that a command takes, its processes included."""
    variables = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, env=variables, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main() -> int:
    """Run the benchmark; returns 1 if a bound is passed."""
    console, good = Console(width=120), True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        python = str(environment(folder / "environment"))
        command = [python, "-m", "uel"]
        large = str(in_plane(FACTOR, "U2", folder))
        cases: dict[str, tuple[float, list[str]]] = {
            "numpy, scipy and meshio alone": (np.inf, [python, "-c", LIBRARIES]),
            "uel --help": (0.3, [*command, "--help"]),
            "uel run: 110 elements, 10 increments": (1.0, [*command, "run", str(small(folder)), "--quiet"]),
            "reading 175,890 elements, imports included": (2.0, [python, "-c", READ, large]),
        }
        times = np.array([[seconds(command, folder) for _, command in cases.values()] for _ in range(TURNS + 1)])[1:]
    table = Table("seconds of CPU", "least", "median", "at most")
    for (what, (bound, _)), column in zip(cases.items(), times.T, strict=True):
        enough = column.min() <= bound
        least = f"{column.min():.2f}"
        table.add_row(
            what,
            least if enough else f"[bold red]{least}[/]",
            f"{np.median(column):.2f}",
            f"{bound:g}" if bound < np.inf else "",
        )
        good &= bool(enough)
    console.print(table)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
