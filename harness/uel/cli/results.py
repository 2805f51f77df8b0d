# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Commands about jobs that have run: `uel plot`, `uel report`, `uel front`."""

from __future__ import annotations

import argparse
from pathlib import Path

from uel.cli.values import NOT_NEGATIVE, PART, positive


def add_plot(plot: argparse.ArgumentParser) -> None:
    """Add the options of `uel plot`."""
    plot.epilog = (
        "load: load over displacement, or the columns --y of NAME_history.csv over --x; energies: of the whole model; "
        "iterations: of each increment, and its size; interface: tractions and damage along an interface in the plane; "
        "mesh: the deformed mesh of one job, with a field; in space PyVista draws it where it is installed, as .png."
    )
    plot.add_argument("jobs", nargs="+", type=Path, metavar="JOB", help="names of jobs that have run, with folders")
    plot.add_argument(
        "--kind", choices=("load", "energies", "iterations", "interface", "mesh"), default="load", help="what (load)"
    )
    plot.add_argument("--x", default="", metavar="COLUMN", help="of the history, such as U2[TIP], 2*U2[TIP] (time)")
    plot.add_argument("--y", nargs="+", default=[], metavar="COLUMN", help="of the history, such as RF2[TIP] ALLSE")
    plot.add_argument(
        "--csv",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="draw a measured curve too: two columns, or those named as the axes, whose factors (2*U2[TIP]) are "
        "taken out; repeat for each file",
    )
    plot.add_argument("--step", type=positive, metavar="N", help="of a profile or mesh (the last one)")
    plot.add_argument("--increment", type=positive, default=-1, metavar="N", help="... (the last one written)")
    plot.add_argument("--field", default="U", metavar="NAME", help="on the mesh: U, U1, S22, SPENT, ... (U)")
    plot.add_argument(
        "--scale", type=NOT_NEGATIVE, metavar="F", help="of its displacements (1, or more where they would not be seen)"
    )
    plot.add_argument(
        *("-o", "--output"), type=Path, metavar="FILE", help="picture: .png, .svg or .pdf (JOB_KIND.png, of the first)"
    )
    plot.set_defaults(function=plot_jobs)


def plot_jobs(options: argparse.Namespace) -> int:
    """Run `uel plot`."""
    from uel.output.pictures.jobs import PictureOptions, draw  # noqa: PLC0415
    from uel.output.results import Result  # noqa: PLC0415

    results = [Result(job) for job in options.jobs]
    shown = options.increment, options.step, options.field, options.scale
    asked = PictureOptions(options.x, options.y, options.csv, *shown, tell=print)
    path = options.output or results[0].file(f"_{options.kind}.png")
    print(f"written: {draw(options.kind, results, path, asked)}")
    return 0


def add_report(report: argparse.ArgumentParser) -> None:
    """Add the options of `uel report`."""
    report.add_argument("job", type=Path, metavar="JOB", help="name of a job that has run, with its folder")
    report.add_argument("-o", "--output", type=Path, metavar="FILE.html", help="the page (JOB.html)")
    report.set_defaults(function=write_report)


def write_report(options: argparse.Namespace) -> int:
    """Run `uel report`."""
    from uel.report import report  # noqa: PLC0415

    print(f"written: {report(options.job, options.output)}")
    return 0


def add_front(front: argparse.ArgumentParser) -> None:
    """Add the options of `uel front`."""
    front.epilog = "Written: JOB_front.csv and JOB_front.png, next to the files of the job."
    front.add_argument("job", type=Path, metavar="JOB", help="name of a job that has run, with its folder")
    front.add_argument("--damage", type=PART, default=0.5, metavar="D", help="damage at the front (0.5)")
    front.set_defaults(function=trace_front)


def trace_front(options: argparse.Namespace) -> int:
    """Run `uel front`."""
    from uel.output.pictures.front import draw_fronts, fronts, write_fronts  # noqa: PLC0415
    from uel.output.pictures.tips import are_lines, draw_tips, tips, write_tips  # noqa: PLC0415
    from uel.output.results import Result  # noqa: PLC0415

    result = Result(options.job)
    table, picture = result.file("_front.csv"), result.file("_front.png")
    if are_lines(result):
        places = tips(result, options.damage)
        write_tips(table, places)
        draw_tips(picture, places)
    else:
        lines = fronts(result, options.damage)
        write_fronts(table, lines)
        draw_fronts(picture, lines)
    print(f"written: {table} {picture}")
    return 0
