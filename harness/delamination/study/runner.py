# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs cases on several processes and keeps their rows, so that an interrupted study goes on where it stopped."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import harness.procedures
import harness.solver
from harness.delamination.study.cases import SOLUTIONS, Case
from harness.delamination.study.rows import Row, measure
from harness.errors import ConvergenceError
from harness.job import run
from harness.output import Result
from harness.usersub.amalgam import path_of_amalgam


class Store:
    """Rows by the name of their case, in rows.json, each with the fingerprint of what it was computed from."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._path = folder / "rows.json"
        self._entries: dict[str, dict[str, object]] = {}
        if self._path.exists():
            self._entries = json.loads(self._path.read_text(encoding="utf-8"))

    def get(self, case: Case) -> Row | None:
        """Row of a case; None if there is none, or if its deck, the elements or the solver have changed since."""
        entry = self._entries.get(case.name)
        if entry is None or entry["fingerprint"] != fingerprint(case):
            return None
        row = entry["row"]
        assert isinstance(row, dict)
        return Row.from_json(row)

    def put(self, case: Case, row: Row) -> None:
        """Keep a row; the file is whole at every moment."""
        self._entries[case.name] = {"fingerprint": fingerprint(case), "row": row.to_json()}
        new = self._path.with_suffix(".new")
        new.write_text(json.dumps(self._entries, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        new.replace(self._path)


def fingerprint(case: Case) -> str:
    """Digest of the deck with all its files, and of the sources of the elements and of the solution procedure."""
    digest = hashlib.sha256(path_of_amalgam().read_bytes())
    for package in (harness.procedures, harness.solver):
        for file in sorted(Path(package.__path__[0]).rglob("*.py")):
            digest.update(file.read_bytes())
    for name, content in sorted(case.files().items()):
        digest.update(f"{name}\n{content}".encode())
    return digest.hexdigest()[:16]


def run_case(case: Case, folder: Path) -> Row:
    """Write the deck of a case, run it, and measure what came out.

    Parameters
    ----------
    case
        The row.
    folder
        Gets a folder of the case's name with the deck and all that a job writes but the fields.
    """
    place = folder / case.name
    place.mkdir(parents=True, exist_ok=True)
    for name, content in case.files().items():
        (place / name).write_text(content, encoding="ascii")
    fallback, _ = SOLUTIONS[case.solution]
    started, stopped = time.perf_counter(), ""
    try:
        run(place / f"{case.name}.inp", output_dir=place, fallback=fallback)
    except ConvergenceError as error:
        stopped = str(error)
    row = measure(case, Result(place / case.name), stopped, time.perf_counter() - started)
    # a fiftieth of the rest, and nothing that the table needs
    shutil.rmtree(place / f"{case.name}_vtu", ignore_errors=True)
    return row


def run_cases(cases: Sequence[Case], folder: Path, workers: int) -> Iterator[tuple[Case, Row]]:
    """Run cases on several processes; yields each as it ends. What has begun is finished when the caller stops."""
    # a fresh process: what a Fortran library keeps and where it writes is its process's own
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        futures: dict[Future[Row], Case] = {pool.submit(run_case, case, folder): case for case in cases}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
