# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`uel batch`."""

from __future__ import annotations

import argparse
from pathlib import Path

from uel.cli.run_options import add_run_options, settings_of
from uel.cli.values import part, positive


def add_batch(batch: argparse.ArgumentParser) -> None:
    """Add the options of `uel batch`."""
    batch.formatter_class = argparse.RawDescriptionHelpFormatter
    batch.description = (
        "Each run has a folder of its own in the output folder, and a line of its table results.csv. The same command\n"
        "again runs what has not completed, and what has other inputs than before: deck, included files, user files,\n"
        "values, options, or another version of this program."
    )
    batch.epilog = (
        "On a cluster each task of a job array runs a part; all have one output folder:\n"
        "  Slurm  --part $SLURM_ARRAY_TASK_ID/20   after sbatch --array=1-20\n"
        "  PBS    --part $PBS_ARRAY_INDEX/20       after qsub -J 1-20\n"
        "  LSF    --part $LSB_JOBINDEX/20          after bsub -J 'NAME[1-20]'\n"
        "Exit code: 0 all runs (of the part) have completed; 1 one has not, or nothing could be run; 2 wrong usage."
    )
    batch.add_argument(
        "decks",
        nargs="+",
        type=Path,
        metavar="DECK.inp",
        help="decks, or folders: all their decks that no other includes",
    )
    batch.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="values for the parameters of one deck's *PARAMETER: their names in the first line, then a line for each "
        "run; a column `job` names the runs (DECK-1, DECK-2, ...)",
    )
    batch.add_argument(
        *("-o", "--output-dir"), type=Path, default=Path("batch"), metavar="DIR", help="folder of the output (batch)"
    )
    batch.add_argument("--cpus", type=positive, metavar="N", help="runs at a time (one for each core)")
    batch.add_argument(
        "--part", type=part, default=(1, 1), metavar="I/N", help="run the I-th of N parts only, I from 1 to N"
    )
    batch.add_argument(
        "--keep-failed", action="store_true", help="do not repeat runs that did not complete, if nothing has changed"
    )
    batch.add_argument("--collect", action="store_true", help="run nothing: write the table of what has run")
    batch.add_argument("--quiet", action="store_true", help="neither progress nor a summary")
    batch.set_defaults(function=run_batch, of_runs=add_run_options(batch))


def run_batch(options: argparse.Namespace) -> int:
    """Run `uel batch`."""
    from uel.batch.command import batch  # noqa: PLC0415

    completed = batch(
        options.decks,
        options.output_dir,
        settings_of(options),
        table=options.table,
        part=options.part,
        workers=options.cpus,
        keep_failed=options.keep_failed,
        collect=options.collect,
        quiet=options.quiet,
    )
    return 0 if completed else 1
