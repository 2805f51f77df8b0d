# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause

import csv
import gzip
from pathlib import Path

import pytest

from uel.output.files.sta_file import StatusFile, StatusRow, has_completed, read_status

DATA = Path(__file__).parents[2] / "data"

# lines of public status files: Abaqus 2018 (a failed XFEM job) and 2023
LINES = [
    "   1     1   1U    0     1     1  0.000      0.000      0.2000    ",
    "   1     1   2     0     2     2  0.0466     0.0466     0.04659   ",
    "   1     2   3U    0     1     1  0.0466     0.0466     0.006989  ",
    "   1     5   4U    0     1     1  0.0534     0.0534     0.0002209 ",
    "   1     5   5U    0     1     1  0.0534     0.0534     4.822e-05 ",
    "   1    38   1     0     1     1  3.80e+08   3.80e+08   1.000e+07 ",
    "   1    32   1     0     1     1  0.00320    0.00320    0.0001000 ",
    "   2    36   1     5     3     8  17.7       9.79       0.007919  ",
    "   1  1000   1     0     1     1  1.00e+03   1.00e+03   1.000     ",
]


@pytest.mark.parametrize("line", LINES)
def test_lines_of_abaqus_are_read_and_printed_alike(line: str) -> None:
    row = StatusRow.read(line)
    assert row is not None
    assert str(row) == line


def test_every_status_line_of_abaqus_is_read_back(tmp_path: Path) -> None:
    """Regression: the numbers of 3994 lines of public status files."""
    with gzip.open(DATA / "abaqus_increments.csv.gz", "rt") as file:
        rows = [
            StatusRow(
                int(row["step"]),
                int(row["increment"]),
                int(row["attempt"]),
                row["cutback_attempt"] == "1",
                int(row["equilibrium_iterations"]),
                float(row["total_time"]),
                float(row["step_time"]),
                float(row["time_increment"]),
                severe_discontinuity_iterations=int(row["severe_discontinuity_iterations"]),
            )
            for row in csv.DictReader(file)
        ]
    file = StatusFile(tmp_path / "job.sta")
    for row in rows:
        file.write(row)
    file.close(completed=True)
    assert read_status(tmp_path / "job.sta") == rows


def test_the_file_is_laid_out_as_abaqus_does(tmp_path: Path) -> None:
    path = tmp_path / "job.sta"
    file = StatusFile(path)
    file.write(StatusRow(1, 1, 1, False, 4, 0.1, 0.1, 0.1))
    assert not has_completed(path)
    file.close(completed=True)
    assert path.read_text().splitlines()[1:] == [
        " SUMMARY OF JOB INFORMATION:",
        " STEP  INC ATT SEVERE EQUIL TOTAL  TOTAL      STEP       INC OF       DOF    IF",
        "               DISCON ITERS ITERS  TIME/    TIME/LPF    TIME/LPF    MONITOR RIKS",
        "               ITERS               FREQ",
        "   1     1   1     0     4     4  0.100      0.100      0.1000    ",
        "                          ",
        " THE ANALYSIS HAS COMPLETED SUCCESSFULLY",
    ]
    assert has_completed(path)


def test_a_failed_job_says_so(tmp_path: Path) -> None:
    file = StatusFile(tmp_path / "job.sta")
    file.close(completed=False)
    assert (tmp_path / "job.sta").read_text().endswith("\n THE ANALYSIS HAS NOT BEEN COMPLETED\n")
    assert not has_completed(tmp_path / "job.sta")


def test_the_monitored_dof_stands_in_its_column(tmp_path: Path) -> None:
    row = StatusRow(1, 1, 1, False, 4, 0.1, 0.1, 0.1, monitor=-0.00125)
    assert str(row) == "   1     1   1     0     4     4  0.100      0.100      0.1000    -0.00125  "
    assert StatusRow.read(str(row)) == row


@pytest.mark.parametrize("monitor", [None, -0.00125])
def test_an_increment_along_a_path_has_an_r_below_if_riks(monitor: float | None) -> None:
    row = StatusRow(1, 2, 1, False, 3, 0.2, -0.15, -0.05, monitor, riks=True)
    head = " STEP  INC ATT SEVERE EQUIL TOTAL  TOTAL      STEP       INC OF       DOF    IF"
    assert str(row).index("R") == head.index("IF")
    assert str(row).startswith("   1     2   1     0     3     3  0.200      -0.150     -0.05000")
    assert StatusRow.read(str(row)) == row


def test_an_unfinished_line_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "job.sta"
    path.write_text(f"{LINES[0]}\n{LINES[1][:50]}")
    assert read_status(path) == [StatusRow.read(LINES[0])]
