# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Element loops on one thread and on several, on models in space; on a machine that has nothing else to do.

Each pass calls all elements and assembles their matrices. One thread and several take turns in one run; the median of
the ratios of neighbouring passes is judged, so that what other processes take affects both alike. `--check` compares
the sums of both, to the bit.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from harness import usersub
from harness.assembly import System
from harness.deck import read_deck
from harness.delamination.bricks import CONSISTENT, STANDARD, dcb_of_bricks
from harness.elements import Call, ElementBlock, Flags, build_blocks

BRICKS = (120, 8, 2)
SMALLEST_GAIN = 1.7
"""Of two threads over one."""
LEAST = 20.0
"""Seconds of passes over a block: two cores of a virtual machine may be slower than one for seconds."""

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


def gains(block: ElementBlock, system: System, number: int, passes: int, *, check: bool) -> tuple[float, float]:
    """Median time of a pass on one thread in ms, and median gain of several."""
    rng = np.random.default_rng(1)
    u = 1e-4 * rng.normal(size=len(system))
    call, sums = Call(Flags(1, nlgeom=True), 1, 1, 1.0, 1.0, 0.01, 1.0), []
    rows: list[list[float]] = []
    while len(rows) <= passes or sum(map(sum, rows)) < LEAST:
        row = [0.0, 0.0]
        for k in range(2):
            block.parallel = k == 1
            residual, data = np.zeros(len(system)), np.zeros(len(system.indices))
            start = time.perf_counter()
            block.evaluate(call, u, u, residual, data)
            row[k] = time.perf_counter() - start
            sums.append((residual, data))
            del sums[:-2]
        if check and not all(np.array_equal(*pair) for pair in zip(*sums, strict=True)):
            sys.exit(f"{block.group.type}: {number} threads have other sums than one")
        rows.append(row)
    # the first pass sets things up
    seconds = np.array(rows[1:])
    return 1e3 * float(np.median(seconds[:, 0])), statistics.median(seconds[:, 0] / seconds[:, 1])


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
    table = Table(
        "elements", "one thread, ms", f"gain of {options.cpus}", title="Passes with NLGEOM", title_justify="left"
    )
    usersub.set_threads(options.cpus)
    with tempfile.TemporaryDirectory() as name:
        for what, deck, user in models(Path(name)):
            model = read_deck(deck)
            library = usersub.load(user or None, job="threads", output_dir=Path(name), deck=deck)
            system = System(model.mesh, build_blocks(model, library), model.equations)
            for block in system.blocks:
                milliseconds, gain = gains(block, system, options.cpus, options.passes, check=options.check)
                enough = gain >= SMALLEST_GAIN
                shown = f"{gain:.2f}" if enough else f"[bold red]{gain:.2f} < {SMALLEST_GAIN}[/]"
                count = len(block.group.labels)
                table.add_row(f"{what}: {count} x {block.group.type}", f"{milliseconds:.2f}", shown)
                good &= enough
            library.close()
    console.print(table)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
