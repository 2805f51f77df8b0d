# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damaged decks: `python tests/programs/fuzz/fuzz.py [--count N] [--seed S] [--workers W] [FOLDER ...]`.

Takes the decks of the folders (default: the project's own), damages one for each trial, and lets the harness read it;
for one deck in ten the harness also checks and builds the model, and tries one increment if the model is small. A
traceback, an end of the process, more than 10 s of processor time, more than 1 GiB, or an error that names no place in
the deck is a finding: its deck is kept in the folder --output, and the exit code is 1. `--case N` repeats one trial in
this process; `--first N` continues where an earlier campaign ended. With the same decks, a trial is determined by the
seed and its number.
"""

from __future__ import annotations

import argparse
import faulthandler
import gc
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from typing import Any

# threads of the linear algebra would each reserve memory, and share the processors with the other workers
os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", MKL_NUM_THREADS="1")

import trial
from corpus import Corpus

ROOT = Path(__file__).parents[3]
OWN_DECKS = (ROOT / "abaqus_inputs", ROOT / "tests")
SECONDS = 10
"""Processor time, so that a busy machine causes no findings."""
WAIT = 180
"""Seconds after which a waiting trial is ended."""
BYTES = 1 << 30
TRIALS_OF_A_PROCESS = 4000
"""Limited because each run keeps a library loaded."""
TRIALS_OF_A_MESSAGE = 50
"""A worker sends its outcomes in batches, since each message may cause a context switch."""
GOOD = ("runs", "reads", "refused", "stopped")


@dataclass
class Worker:
    """A process that makes the trials `numbers`; `later` are those of the next one, `at` is where it is."""

    process: multiprocessing.process.BaseProcess
    connection: Connection
    numbers: list[int]
    later: range
    at: Synchronized[int]
    trace: Path


@dataclass
class Findings:
    """Outcomes by kind; the first trial of each kind is kept as files."""

    corpus: Corpus
    seed: int
    folder: Path
    kinds: Counter[str] = field(default_factory=Counter)

    def add(self, number: int, kind: str, text: str) -> None:
        """Count an outcome, and keep its deck if it is the first finding of its kind."""
        self.kinds[kind] += 1
        if kind in GOOD or self.kinds[kind] > 1:
            return
        case = self.corpus.case(self.seed, number)
        place = self.folder / f"{self.seed}-{number}"
        for name, content in case.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)
        (place / "finding.txt").write_text(f"{case.path}\n{kind}\n{text}", encoding="utf-8", errors="replace")
        print(f"trial {number} of {case.path}: {kind}; kept in {place}", flush=True)

    @property
    def found(self) -> int:
        """Number of trials that are findings."""
        return sum(count for kind, count in self.kinds.items() if kind not in GOOD)


def work(
    corpus: Corpus, seed: int, numbers: Sequence[int], connection: Connection, at: Synchronized[int], trace: Path
) -> None:
    """Run trials and send (number, kind, text) in batches; the other side sees what ends this process."""
    # what exists by now stays: the garbage collector need not scan it repeatedly
    gc.freeze()
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_DATA, (BYTES, BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    outcomes: list[tuple[int, str, str]] = []
    with tempfile.TemporaryDirectory() as folder, trace.open("w") as log:
        # what the Fortran library prints before it ends the process goes there too
        os.dup2(log.fileno(), 2)
        faulthandler.enable(log)
        for number in (signal.SIGPROF, signal.SIGALRM):
            faulthandler.register(number, log, chain=True)
        for number in numbers:
            log.truncate(0)
            at.value = number
            case = corpus.case(seed, number)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            signal.setitimer(signal.ITIMER_REAL, WAIT)
            outcome = trial.run(case, Path(folder) / str(number))
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.setitimer(signal.ITIMER_PROF, 0)
            shutil.rmtree(Path(folder) / str(number), ignore_errors=True)
            outcomes.append((number, *outcome))
            if len(outcomes) == TRIALS_OF_A_MESSAGE or number == numbers[-1]:
                connection.send(outcomes)
                outcomes = []


def start(corpus: Corpus, seed: int, numbers: Sequence[int], later: range, traces: Path) -> Worker:
    """A process for these trials, or for the first of the later ones."""
    if not numbers:
        numbers, later = later[:TRIALS_OF_A_PROCESS], later[TRIALS_OF_A_PROCESS:]
    receiving, sending = multiprocessing.Pipe(duplex=False)
    trace = traces / f"{numbers[0]}.txt"
    at = multiprocessing.Value("q", numbers[0])
    context = multiprocessing.get_context("fork")
    # a process that also holds the receiving end would not notice that its parent is gone
    process = context.Process(target=_only_sending, args=(receiving, corpus, seed, numbers, sending, at, trace))
    process.start()
    sending.close()
    return Worker(process, receiving, list(numbers), later, at, trace)


def _only_sending(receiving: Connection, *arguments: Any) -> None:
    receiving.close()
    work(*arguments)


def trials(corpus: Corpus, seed: int, numbers: range, workers: int) -> Iterator[tuple[int, str, str]]:
    """(number, kind, text) of all trials, in the order in which they end."""
    with tempfile.TemporaryDirectory() as traces:
        shares = [numbers[first::workers] for first in range(workers)]
        running = [start(corpus, seed, (), share, Path(traces)) for share in shares if share]
        while running:
            ready = wait([worker.connection for worker in running])
            for worker in [worker for worker in running if worker.connection in ready]:
                try:
                    outcomes = worker.connection.recv()
                    del worker.numbers[: len(outcomes)]
                    yield from outcomes
                    continue
                except EOFError:
                    worker.process.join()
                running.remove(worker)
                if worker.process.exitcode:
                    # the trials before it that were not reported run again
                    worker.numbers.remove(worker.at.value)
                    yield worker.at.value, *ended(worker)
                worker.connection.close()
                if worker.numbers or worker.later:
                    running.append(start(corpus, seed, worker.numbers, worker.later, Path(traces)))


def ended(worker: Worker) -> tuple[str, str]:
    """Kind and text of a trial that has ended its process."""
    text = worker.trace.read_text("utf-8", errors="replace")
    frame = trial.OWN_FRAME.search(text)
    where = f" at {':'.join(frame.groups())}" if frame else ""
    code = worker.process.exitcode
    return f"{'timeout' if code in (-signal.SIGPROF, -signal.SIGALRM) else f'exit code {code}'}{where}", text


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, default=OWN_DECKS, metavar="FOLDER", help="folders with decks")
    parser.add_argument("--count", type=int, default=1000, metavar="N", help="number of trials (1000)")
    parser.add_argument("--first", type=int, default=0, metavar="N", help="number of the first trial (0)")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="seed of the damage (1)")
    parser.add_argument("--workers", type=int, default=1, metavar="W", help="number of processes (1)")
    parser.add_argument("--output", type=Path, default=Path("fuzz-findings"), metavar="DIR", help="folder of findings")
    parser.add_argument("--case", type=int, metavar="N", help="run only this trial and print its outcome")
    options = parser.parse_args()
    corpus = Corpus(options.folders)
    if not corpus.decks:
        parser.error("no decks in these folders")
    if options.case is not None:
        case = corpus.case(options.seed, options.case)
        with tempfile.TemporaryDirectory() as folder:
            print(case.path, *trial.run(case, Path(folder)), sep="\n")
        return 0
    began = time.perf_counter()
    findings = Findings(corpus, options.seed, options.output)
    numbers = range(options.first, options.first + options.count)
    for done, (number, kind, text) in enumerate(trials(corpus, options.seed, numbers, options.workers), start=1):
        findings.add(number, kind, text)
        if done % 1000 == 0:
            print(f"{done} trials, {findings.found} findings, {time.perf_counter() - began:.0f} s", flush=True)
    seconds = time.perf_counter() - began
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"{options.count} trials of {len(corpus.decks)} decks in {seconds:.0f} s, largest process {largest:.0f} MiB")
    for kind, count in findings.kinds.most_common():
        print(f"{count:8d} {kind}")
    return int(findings.found > 0)


if __name__ == "__main__":
    sys.exit(main())
