# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the tests on clean clones as on several machines, and write the table of docs/testing.md.

    PYTHONS="python3.11 python3.12 python3.13" make test-matrix

Each run varies several things at once, so that every value of each occurs in few runs.
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LOGS = ROOT / "build" / "matrix"
BEGIN, END = "<!-- rows of tests/programs/matrix.py -->", "<!-- end of the rows -->"
SUMMARY = re.compile(r"^=* ?(\d+ (?:passed|failed|errors?|skipped|deselected).*) in (\d+)\.\d+s\b", re.MULTILINE)


@dataclass(frozen=True)
class Configuration:
    """A run: a target of make, the Python, the machine that machine.py imitates, and the order of the tests."""

    target: str
    python: str
    processor: str
    cores: str
    seed: str

    @property
    def words(self) -> list[str]:
        """Command, with the Python as it was given."""
        machine = {"PROCESSOR": self.processor, "CORES": self.cores} | ({"WORKERS": "1"} if self.cores == "1" else {})
        values = {"PYTHON": self.python} | machine | {"SEED": self.seed}
        return ["make", self.target, *(f"{name}={value}" for name, value in values.items())]

    @property
    def command(self) -> str:
        """Command as it is shown: no folder of this machine in it."""
        return shlex.join(word.replace(self.python, f"python{self.version}") for word in self.words)

    @property
    def version(self) -> str:
        """The version of Python, such as 3.12."""
        say = "import sys; print('%d.%d' % sys.version_info[:2])"
        return subprocess.run([self.python, "-c", say], capture_output=True, text=True, check=True).stdout.strip()


def configurations(
    targets: list[str], pythons: list[str], processors: list[str], cores: list[str], seeds: list[str]
) -> list[Configuration]:
    """As few runs of each target as the longest list has values."""
    count = max(map(len, (pythons, processors, cores, seeds)))
    return [
        Configuration(
            target,
            pythons[i % len(pythons)],
            processors[(i + turn) % len(processors)],
            cores[(i + turn) % len(cores)],
            seeds[i % len(seeds)],
        )
        for turn, target in enumerate(targets)
        for i in range(count)
    ]


def outcome(output: str, code: int) -> tuple[str, str]:
    """What passed, and the time, from pytest's last summary line."""
    found = SUMMARY.findall(output)
    if not found:
        return "**no tests ran**", ""
    text, seconds = found[-1]
    return text if code == 0 else f"**{text}**", f"{int(seconds) // 60} min {int(seconds) % 60} s"


def run(configuration: Configuration, log: Path, select: str) -> tuple[str, int]:
    """Make the target in a clean clone with an empty cache; returns its row and exit code."""
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        commit = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"], cwd=clone, capture_output=True, text=True, check=True
        ).stdout.strip()
        arguments = ["-q", *(["-k", select] if select else [])]
        with log.open("w", encoding="utf-8") as file:
            done = subprocess.run(
                [*configuration.words, f"PYTEST_ARGS={shlex.join(arguments)}"],
                cwd=clone,
                stdout=file,
                stderr=subprocess.STDOUT,
                env=os.environ | {"XDG_CACHE_HOME": str(Path(folder) / "cache")},
                check=False,
            )
    result, time = outcome(log.read_text(encoding="utf-8", errors="replace"), done.returncode)
    cells = [configuration.version, configuration.processor, configuration.cores, configuration.seed]
    return f"| {' | '.join([*cells, result, time, commit])} | `{configuration.command}` |", done.returncode


def written(page: str, row: str) -> str:
    """The page with a row: it replaces that of the same command, or follows the others."""
    before, rest = page.split(BEGIN)
    table, after = rest.split(END)
    *_, command, _ = row.split("|")
    rows = table.strip().splitlines()
    known = next((n for n, line in enumerate(rows) if line.endswith(f"|{command}|")), len(rows))
    rows[known : known + 1] = [row]
    return f"{before}{BEGIN}\n{chr(10).join(rows)}\n{END}{after}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, values in (
        ("targets", "test-all test-debug"),
        ("pythons", "python3"),
        ("processors", "this Haswell Nehalem"),
        ("cores", "all 1"),
        ("seeds", "1 2 3"),
    ):
        given = os.environ.get(name.upper(), values)
        parser.add_argument(
            f"--{name}", default=given, help=f"also by the environment variable {name.upper()} ({given})"
        )
    parser.add_argument("--list", action="store_true", help="print the commands and run nothing")
    parser.add_argument("--page", type=Path, help="the file that gets the rows (docs/testing.md; none with -k)")
    parser.add_argument("-k", dest="select", default="", metavar="EXPRESSION", help="only tests that pytest -k selects")
    options = parser.parse_args()
    lists = [getattr(options, name).split() for name in ("targets", "pythons", "processors", "cores", "seeds")]
    page: Path | None = options.page or (None if options.select else ROOT / "docs/testing.md")
    LOGS.mkdir(parents=True, exist_ok=True)
    failed = 0
    for number, configuration in enumerate(configurations(*lists)):
        print(configuration.command, flush=True)
        if options.list:
            continue
        log = LOGS / f"{number}.log"
        row, code = run(configuration, log, options.select)
        print(row if code == 0 else f"{row}\nexit code {code}, see {log.relative_to(ROOT)}", flush=True)
        failed += code != 0
        if page:
            page.write_text(written(page.read_text(encoding="utf-8"), row), encoding="utf-8")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
