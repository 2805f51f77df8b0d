# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether the files of a run, however it ended, can be read and agree with its status file."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from xml.etree import ElementTree

import meshio

from uel.output import Result

TEXTS = (".sta", ".msg", ".dat", "_history.csv", "_interface.csv")


def complaints(stem: Path, *, outputs_each: bool = True) -> list[str]:
    """What is wrong with the files; outputs_each: every increment writes to each of them."""
    found = []
    for ending in TEXTS:
        path = stem.with_name(stem.name + ending)
        if path.exists() and (data := path.read_bytes()) and not data.endswith(b"\n"):
            found.append(f"{path.name}: its last line is no whole one")
    for ending in TEXTS[3:]:
        found += _rows(stem.with_name(stem.name + ending))
    if not stem.with_name(f"{stem.name}.sta").exists():
        return found
    result = Result(stem)
    increments = [row.increment for row in result.status if not row.cutback]
    if increments != list(range(1, len(increments) + 1)):
        found.append(f"{stem.name}.sta: increments {increments}")
    pvd = stem.with_name(f"{stem.name}.pvd")
    if pvd.exists():
        ElementTree.parse(pvd)
    for frame in result.frames:
        if not len(meshio.read(frame.path).points):
            found.append(f"{frame.path.name}: no points")
    if outputs_each and increments:
        found += _lacking(stem, result, increments)
    return found


def _rows(path: Path) -> list[str]:
    """Rows of a table that have as many fields as its header."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return [f"{path.name}: row {k} is cut off" for k, row in enumerate(rows, 1) if len(row) != len(rows[0])]


def _lacking(stem: Path, result: Result, increments: list[int]) -> list[str]:
    """Increments of the status file that another file lacks."""
    message = stem.with_name(f"{stem.name}.msg").read_text("utf-8")
    data = stem.with_name(f"{stem.name}.dat").read_text("utf-8")
    held = {
        "history": [int(k) for k in result.history["increment"]],
        "pvd": [frame.increment for frame in result.frames],
        "interface": [int(block["increment"][0]) for block in result.interfaces()],
        "msg": list(range(1, 1 + message.count("ITERATION SUMMARY FOR THE INCREMENT"))),
        "dat": [int(k) for k in re.findall(r"INCREMENT +(\d+) SUMMARY", data)],
    }
    return [f"{name} lacks increments {lack}" for name, has in held.items() if (lack := set(increments) - set(has))]
