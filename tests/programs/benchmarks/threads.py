# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Element loops on one thread and on several, on models in space; on a machine that has nothing else to do.

Each pass calls all elements of a block and assembles their matrices. One thread, several threads, and as many processes
that share nothing take turns in one run. Judged is what threads gain over one in the element loop of a deck, which goes
over its blocks: the medians of the passes, added. The gain of a block is the median of that of neighbouring passes.
What processes gain is what the machine gives: two processors of a virtual machine may do 1.5 times the work of one.
`--check` compares the sums of one thread and several, to the bit.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Flags
from uel.model.arrays import FloatArray
from uel.paper.bricks import CONSISTENT, STANDARD, dcb_of_bricks

BRICKS = (120, 8, 2)
BLOCKS = 2
"""Of each model."""
SMALLEST_GAIN = 1.7
"""Of two threads over one, in the element loop of a deck."""
LEAST = 30.0
"""Seconds of passes over a block: the processors of a virtual machine may be slow for seconds."""

UMAT = """\
      subroutine umat(stress,statev,ddsdde,sse,spd,scd,rpl,ddsddt,drplde,
     &  drpldt,stran,dstran,time,dtime,temp,dtemp,predef,dpred,cmname,ndi,
     &  nshr,ntens,nstatv,props,nprops,coords,drot,pnewdt,celent,dfgrd0,
     &  dfgrd1,noel,npt,layer,kspt,jstep,kinc)
      include 'aba_param.inc'
      character*80 cmname
      dimension stress(ntens), ddsdde(ntens,ntens), dstran(ntens), props(*)
      ddsdde = 0
      ddsdde(1:ndi,1:ndi) = props(1)
      do i = 1, ntens
        ddsdde(i,i) = ddsdde(i,i) + merge(2, 1, i <= ndi)*props(2)
      end do
      stress = stress + matmul(ddsdde, dstran)
      end
"""


def models(folder: Path) -> Iterator[tuple[str, Path, list[Path]]]:
    """What is measured: a name, a deck, and user files."""
    deck = folder / "solids.inp"
    deck.write_text(dcb_of_bricks("C3D8I", CONSISTENT, BRICKS))
    yield "C3D8I and U8", deck, []
    text = dcb_of_bricks("C3D8", replace(STANDARD, type="COH3D8"), BRICKS)
    start, end = text.index("*ELASTIC"), text.index("*", text.index("*ELASTIC") + 1)
    deck = folder / "material.inp"
    material = "*USER MATERIAL, CONSTANTS=2\n40384.6, 26923.1\n"
    deck.write_text(text[:start] + material + text[end:])
    user = folder / "umat.f"
    user.write_text(UMAT)
    yield "C3D8 with UMAT", deck, [user]


class Loop:
    """Passes over a block of a deck.

    residual, data  what a pass adds to: the sums of the system, residual and entries of the matrix, which have their
                    memory from pass to pass, as in a job
    """

    def __init__(self, deck: Path, user: list[Path], folder: Path, place: int) -> None:
        model = read_deck(deck)
        own = Path(tempfile.mkdtemp(dir=folder))
        self.library = usersub.load(user or None, job="threads", output_dir=own, deck=deck)
        self._system = system_of(model, self.library)
        self.block = self._system.blocks[place]
        self._u = 1e-4 * np.random.default_rng(1).normal(size=len(self._system))
        self._call = Call(Flags(1, nlgeom=True), 1, 1, 1.0, 1.0, 0.01, 1.0)
        self.residual, self.data = np.zeros(len(self._system)), np.zeros(len(self._system.indices))

    def clear(self) -> None:
        """Set the sums to zero."""
        self.residual.fill(0.0)
        self.data.fill(0.0)

    def __call__(self, *, parallel: bool) -> None:
        self.block.parallel = parallel
        self.block.evaluate(self._call, self._u, self._u, self.residual, self.data)


def serve(asked: Connection, *model: Any) -> None:
    """Passes on one thread of a process of its own, each when asked for."""
    loop = Loop(*model)
    asked.send(True)
    while asked.recv():
        loop(parallel=False)
        asked.send(True)
    loop.library.close()


@contextmanager
def processes(count: int, *model: Any) -> Iterator[list[Connection]]:
    """Some that serve passes."""
    context, ends = get_context("spawn"), []
    for _ in range(count):
        here, there = context.Pipe()
        context.Process(target=serve, args=(there, *model), daemon=True).start()
        ends.append(here)
    for end in ends:
        end.recv()
    yield ends
    for end in ends:
        end.send(False)
        end.close()


def measure(loop: Loop, others: list[Connection], passes: int, *, check: bool) -> FloatArray:
    """Seconds (rows, 3) of a pass on one thread, of one on several, and of one in each of as many processes."""

    def timed(*, parallel: bool) -> float:
        loop.clear()
        start = time.perf_counter()
        loop(parallel=parallel)
        return time.perf_counter() - start

    rows: list[list[float]] = []
    while len(rows) <= passes or sum(map(sum, rows)) < LEAST:
        row = [timed(parallel=False)]
        one = loop.residual.copy(), loop.data.copy()
        row.append(timed(parallel=True))
        if check and not all(map(np.array_equal, one, (loop.residual, loop.data))):
            sys.exit(f"{loop.block.group.type}: several threads have other sums than one")
        start = time.perf_counter()
        for other in others:
            other.send(True)
        loop(parallel=False)
        for other in others:
            other.recv()
        row.append(time.perf_counter() - start)
        rows.append(row)
    # the first pass sets things up
    return np.array(rows[1:])


def main() -> int:
    """Run the benchmark; returns 1 if a gain of two threads is below its bound."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cpus", type=int, default=2, help="threads (2)")
    parser.add_argument("--passes", type=int, default=30, help="of each kind at least (30)")
    parser.add_argument("--check", action="store_true", help="compare the sums")
    options = parser.parse_args()
    console, good = Console(width=120), True
    if options.cpus > len(os.sched_getaffinity(0)):
        console.print(f"threads: this process has fewer than {options.cpus} cores: nothing to measure")
        return 0
    number = options.cpus
    table = Table(
        *("elements", "one thread, ms", f"gain of {number} threads", f"gain of {number} processes"),
        title="Passes with NLGEOM",
        title_justify="left",
    )
    usersub.set_threads(number)
    with tempfile.TemporaryDirectory() as name:
        for what, deck, user in models(Path(name)):
            loops = np.zeros(3)
            for place in range(BLOCKS):
                model = deck, user, Path(name), place
                loop = Loop(*model)
                with processes(number - 1, *model) as others:
                    times = measure(loop, others, options.passes, check=options.check)
                loop.library.close()
                loops += np.median(times, axis=0)
                group = loop.block.group
                one, several, apart = times.T
                table.add_row(
                    f"{what}: {len(group.labels)} x {group.type}",
                    f"{1e3 * np.median(one):.2f}",
                    f"{np.median(one / several):.2f}",
                    f"{np.median(number * one / apart):.2f}",
                )
            one, several, apart = loops
            enough = one / several >= SMALLEST_GAIN
            table.add_row(
                f"{what}: all",
                f"{1e3 * one:.2f}",
                f"{one / several:.2f}" if enough else f"[bold red]{one / several:.2f} < {SMALLEST_GAIN}[/]",
                f"{number * one / apart:.2f}",
                end_section=True,
            )
            good &= bool(enough)
    console.print(table)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
