# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs that are killed at random moments, several at once: `python tests/programs/adversarial/kills.py --count 200`.

Each run gets a signal, sent to its parent, its child or both. Then the program reads its files and runs the same job
again, to completion.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

from readable import complaints

from uel.output import Result
from uel.output.files.sta_file import NOT_COMPLETED

SOURCE = Path(__file__).parents[3] / "abaqus_inputs" / "patch_horizontal"
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
TARGETS = ("parent", "child", "group")
INCREMENTS = 60
LONGEST = 300.0
"""Seconds after which a run counts as hanging."""

_forking = threading.Lock()


def write_deck(folder: Path) -> Path:
    """A small deck of many increments, each of which writes to all files."""
    for part in SOURCE.glob("flat_*.inp"):
        (folder / part.name).write_text(part.read_text())
    text = (SOURCE / "flat_u2.inp").read_text()
    step = 1.0 / INCREMENTS
    text = text.replace("INC=1,", f"INC={INCREMENTS},").replace("1., 1., 1., 1.", f"{step!r}, 1., {step!r}, {step!r}")
    before, _, _ = text.partition("*OUTPUT, FIELD")
    requests = (
        "*OUTPUT, FIELD, FREQUENCY=1\n*NODE OUTPUT\nU, RF\n*ELEMENT OUTPUT\nS\n*OUTPUT, HISTORY, FREQUENCY=1\n"
        "*NODE OUTPUT, NSET=CROWN\nU2, RF2\n*NODE PRINT, NSET=CROWN, FREQUENCY=1\nU\n*END STEP\n"
    )
    deck = folder / "pressed.inp"
    deck.write_text(before + requests)
    return deck


def trial(number: int, seed: int, longest: float) -> list[str]:
    """Kill a run and inspect what it leaves; returns what is wrong."""
    chance = random.Random(seed * 100003 + number)
    signum, target = chance.choice(SIGNALS), chance.choice(TARGETS)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = write_deck(folder)
        command = [sys.executable, "-m", "uel.cli", "run", deck.name, "--quiet"]
        with _forking:
            run = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True, start_new_session=True)
        time.sleep(chance.uniform(0.0, longest))
        hit = _send(run, signum, target)
        try:
            said = run.communicate(timeout=LONGEST)[1]
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            return [f"{signum.name} to {target}: hangs"]
        _settle(run.pid)
        what = f"{signum.name} to {target}, exit code {run.returncode}"
        stem = folder / deck.stem
        found = complaints(stem)
        if "Traceback" in said:
            found.append("a traceback: " + said.strip().splitlines()[-1])
        # killed together with its child, a run cannot report anything
        silent = signum == signal.SIGKILL and target != "child"
        if hit and run.returncode == 1 and stem.with_suffix(".sta").exists():
            verdict = stem.with_suffix(".sta").read_text().splitlines()[-1]
            if not silent and verdict != NOT_COMPLETED:
                found.append(f"no verdict, but {verdict!r}")
        if run.returncode == 0 and not Result(stem).completed:
            found.append("exit code 0 of a run that has not completed")
        with _forking:
            again = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
        said = again.communicate(timeout=LONGEST)[1]
        if again.returncode or said or not Result(stem).completed:
            found.append(f"the job does not run again: {said}")
        found += complaints(stem)
        left = sorted(
            path.name for path in folder.glob("pressed*") if path.suffix in (".lck", ".tmp", ".unit6", ".unit7")
        )
        if left:
            found.append(f"left over: {left}")
    return [f"{what}: {complaint}" for complaint in found]


def _child(parent: int) -> int | None:
    """The process of a run, by its module: importing an editable installation briefly starts another child."""
    with suppress(OSError):
        for word in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
            if b"uel.running.worker" in Path(f"/proc/{word}/cmdline").read_bytes():
                return int(word)
    return None


def _send(run: subprocess.Popen[str], signum: int, target: str) -> bool:
    """Send the signal; returns whether the run was still there to receive it."""
    receiver = _child(run.pid) if target == "child" else run.pid
    if receiver is None or run.poll() is not None:
        return False
    try:
        os.killpg(run.pid, signum) if target == "group" else os.kill(receiver, signum)
    except ProcessLookupError:
        return False
    return True


def _settle(group: int) -> None:
    """Wait until no process of the run is left."""
    began = time.monotonic()
    while time.monotonic() - began < LONGEST:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.02)


def main(count: int, jobs: int, seed: int, longest: float) -> int:
    """Make the trials; returns the number that found something."""
    # from now on the cache has the compiled files
    with tempfile.TemporaryDirectory() as name:
        command = [sys.executable, "-m", "uel.cli", "run", str(write_deck(Path(name))), "--quiet"]
        subprocess.run([*command, "--output-dir", name], check=True)
    bad = 0
    with ThreadPoolExecutor(jobs) as pool:
        for done, outcome in enumerate(pool.map(lambda number: trial(number, seed, longest), range(count)), 1):
            bad += bool(outcome)
            for complaint in outcome:
                print(f"{done}: {complaint}", flush=True)
    print(f"{count} kills, {bad} with complaints")
    return bad


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=3, help="simultaneous runs (3)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=6.0, help="latest time of the signal, in seconds (6)")
    asked = parser.parse_args()
    sys.exit(bool(main(asked.count, asked.jobs, asked.seed, asked.longest)))
