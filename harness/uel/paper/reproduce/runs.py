# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the cases, kept on disk, and the values read from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from pathlib import Path

import numpy as np
from rich.console import Console

from uel.batch.engine import Store, StoredRow, complete
from uel.delamination.damage import stiffness_lost, toughness_spent
from uel.errors import UelError
from uel.model.arrays import FloatArray
from uel.output import Result
from uel.output.files.sta_file import StatusRow
from uel.paper.reproduce.cases import PEAK_STEP, PaperCase
from uel.paper.reproduce.patch_cases import PatchCase
from uel.paper.run_deck import run_deck
from uel.paper.study.rows import bonded_part

AnyCase = PaperCase | PatchCase
Profile = dict[str, FloatArray]


@dataclass(frozen=True, slots=True)
class Entry(StoredRow):
    """Ending of a run.

    stopped   why it stopped early; empty for a run that finished
    increments, iterations, cutbacks  including the iterations of abandoned attempts
    seconds   wall-clock time
    """

    stopped: str
    increments: int
    iterations: int
    cutbacks: int
    seconds: float

    def __str__(self) -> str:
        end = f"stopped: {self.stopped}" if self.stopped else "finished"
        counts = f"{self.increments} increments, {self.iterations} iterations, {self.cutbacks} cutbacks"
        return f"{end}, {counts}, {self.seconds:.0f} s"


class Run:
    """Run of a case, read from its files.

    Loads and displacements are positive in the direction of loading and start at 0, before the first increment.
    """

    def __init__(self, case: PaperCase, entry: Entry, folder: Path) -> None:
        self.case = case
        self.entry = entry
        self._result = Result(folder / case.name / case.name)

    @cached_property
    def history(self) -> dict[str, FloatArray]:
        """Columns of the history."""
        return self._result.history

    @cached_property
    def status(self) -> list[StatusRow]:
        """Lines of the status file."""
        return self._result.status

    @cached_property
    def displacement(self) -> FloatArray:
        """Displacement of the loaded node (mm)."""
        return self._column("U2")

    @cached_property
    def load(self) -> FloatArray:
        """Load (N)."""
        return self._column("RF2")

    def _column(self, name: str) -> FloatArray:
        kind = self.case.kind
        return np.concatenate([[0.0], kind.sign * self.history[f"{name}[{kind.load}]"]])

    @property
    def peak(self) -> tuple[float, float]:
        """Largest load before the end of the crack's way, where it rises again, and its displacement: N, mm."""
        k = self.peak_index
        return float(self.load[k]), float(self.displacement[k])

    @cached_property
    def peak_index(self) -> int:
        """Index of the first load that is followed by a fall of a twentieth."""
        highest = np.maximum.accumulate(self.load)
        fallen = np.flatnonzero(self.load < 0.95 * highest)
        return int(self.load[: fallen[0] if fallen.size else None].argmax())

    @property
    def around_peak(self) -> PaperCase | None:
        """Case that passes the peak in small increments, from the increment before to that after; None at an end.

        The increments of a run miss up to what the load rises in one of them, which differs from run to run.
        """
        k = self.peak_index
        if k < 2 or k + 1 == len(self.load):
            return None
        start, peak, end = (float(self.displacement[j]) for j in (k - 1, k, k + 1))
        return replace(self.case, window=(start, end, min(PEAK_STEP * peak, end - start)))

    @cached_property
    def profiles(self) -> list[Profile]:
        """Profiles along the interface, in time.

        DAMAGE is what the element writes. LOST and SOFTENED mean the same for every element: the share of its stiffness
        that a point has lost, the paper's damage (9), and the damage of the consistent law.
        """
        law = self.case.law
        profiles = self._result.interfaces()
        for profile in profiles:
            written = profile["DAMAGE"]
            if self.case.own_separation:
                profile |= {"LOST": stiffness_lost(written, law), "SOFTENED": written}
            else:
                profile |= {"LOST": written, "SOFTENED": toughness_spent(written, law)}
        return profiles

    def at(self, displacement: float) -> Profile:
        """Return the profile nearest to a displacement (mm)."""
        times = np.array([profile["time"][0] for profile in self.profiles])
        return self.profiles[int(np.argmin(np.abs(times * self.case.displacement - displacement)))]

    @cached_property
    def bonded(self) -> list[Profile]:
        """Process zone and bonded part at every moment."""
        return [bonded_part(profile) for profile in self.profiles]


class PatchRun:
    """Run of a patch test."""

    def __init__(self, case: PatchCase, entry: Entry, folder: Path) -> None:
        self.case = case
        self.entry = entry
        self._result = Result(folder / case.name / case.name)

    @cached_property
    def profile(self) -> Profile:
        """Profile along the interface at the end."""
        return self._result.interface()

    @property
    def traction(self) -> FloatArray:
        """Normal traction at the integration points (MPa)."""
        return self.profile["TN"]

    def displacements(self) -> tuple[FloatArray, FloatArray]:
        """Return the places and displacements of all nodes (n, 2), in mm."""
        return self._result.mesh().points[:, :2], self._result.field("U")[:, :2]


class Runs:
    """All runs by their cases.

    Parameters
    ----------
    entries, folder
        How the runs ended, and the folder that has them.
    around_peaks
        Cases of the runs that pass the peaks of others in small increments, by these.
    """

    def __init__(
        self, entries: Mapping[AnyCase, Entry], folder: Path, around_peaks: Mapping[PaperCase, PaperCase] | None = None
    ) -> None:
        self._entries = entries
        self._around_peaks = around_peaks or {}
        self._folder = folder
        self._read: dict[AnyCase, Run | PatchRun] = {}

    def __contains__(self, case: AnyCase) -> bool:
        return case in self._entries

    def entries(self) -> dict[AnyCase, Entry]:
        """Return the endings of the runs."""
        return dict(self._entries)

    def deck(self, case: AnyCase) -> Path:
        """Return the path of the deck that was run."""
        return self._folder / case.name / f"{case.name}.inp"

    def __getitem__(self, case: PaperCase) -> Run:
        """Run of a delamination test."""
        run = self._read.get(case)
        if run is None:
            run = self._read[case] = Run(case, self._entry(case), self._folder)
        assert isinstance(run, Run)
        return run

    def peak(self, case: PaperCase) -> float:
        """Return the peak load (N), found in small increments if that has been run."""
        return self[self._around_peaks.get(case, case)].peak[0]

    def patch(self, case: PatchCase) -> PatchRun:
        """Run of a patch test."""
        run = self._read.get(case)
        if run is None:
            run = self._read[case] = PatchRun(case, self._entry(case), self._folder)
        assert isinstance(run, PatchRun)
        return run

    def _entry(self, case: AnyCase) -> Entry:
        if case not in self._entries:
            raise UelError(f"{case.name}: this case was not run")
        return self._entries[case]


def run_case(case: AnyCase, folder: Path) -> Entry:
    """Run a case in a folder of its name below `folder`."""
    outcome = run_deck(case, folder, fallback=case.fallback, fields=isinstance(case, PatchCase))
    status = outcome.result.status
    return Entry(
        stopped=outcome.stopped,
        increments=sum(not line.cutback for line in status),
        iterations=sum(line.total_iterations for line in status),
        cutbacks=sum(line.cutback for line in status),
        seconds=outcome.seconds,
    )


def run_cases(
    cases: Sequence[AnyCase], folder: Path, workers: int, console: Console, *, peaks: Sequence[PaperCase] = ()
) -> Runs:
    """Run the cases that are not in `folder`, on several processes, and keep each as it ends.

    peaks: of the cases, those whose peak loads are compared and so are run once more, in small increments about them.
    """
    entries, place = _run_missing(cases, folder, workers, console), folder / "runs"
    if not peaks:
        return Runs(entries, place)
    runs = Runs(entries, place)
    around = {case: passing for case in peaks if (passing := runs[case].around_peak) is not None}
    console.print("peak loads that are compared, in small increments:", highlight=False)
    return Runs(entries | _run_missing(list(around.values()), folder, workers, console), place, around)


def _run_missing(cases: Sequence[AnyCase], folder: Path, workers: int, console: Console) -> dict[AnyCase, Entry]:
    store = Store(folder / "runs.json", Entry.from_json)
    place = folder / "runs"
    return complete(
        cases, store, run_case, place, workers=workers, console=console, describe=str, work=attrgetter("work")
    )
