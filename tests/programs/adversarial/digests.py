# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compare the results of two versions of the code to the bit.

`python tests/programs/adversarial/digests.py FILE [BODY ...]` runs every body of `bodies.py` (element types with
materials, joints) as it is, with NLGEOM and for its frequencies, the decks of tests/programs/fuzz/decks and the quick
decks of abaqus_inputs, and writes a digest of the files of each run into FILE. `--against OTHER` also prints the runs
whose digests differ from those in OTHER, and exits with 1 if there are any. Refactoring keeps all digests.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Final

ROOT = Path(__file__).parents[3]
sys.path.extend(str(ROOT / "tests" / folder) for folder in ("harness", "verification", "programs/adversarial"))

from bodies import Body, bodies  # noqa: E402
from comparisons import Variant, text  # noqa: E402
from reference_values import read_references  # noqa: E402

from uel.errors import UelError  # noqa: E402
from uel.running import job  # noqa: E402
from uel.solver.options import SolverOptions  # noqa: E402

FILES: Final = (".sta", "_history.csv", ".vtu", ".dat", ".msg")
"""Endings of the files that hold results."""
PASSING: Final = re.compile(
    rb"^.*(?:DATE|Date|INPUT FILE|TIME \(SEC\)|MEMORY).*\n"
    rb"|^ \*\*\*(?:WARNING|NOTE).*\n(?: {10,}\S.*\n)*|\S+\.inp",
    re.MULTILINE,
)
"""Parts of .sta, .dat and .msg that two runs do not share: when, how long, and where; remarks name folders."""


def digest(folder: Path) -> str:
    """Digest of the results in a folder: the bytes of tables and fields, and the lines of the text files."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if not path.name.endswith(FILES):
            continue
        content = path.read_bytes()
        if path.suffix in {".sta", ".dat", ".msg"}:
            content = PASSING.sub(b"", content)
        total.update(path.name.encode() + content)
    return total.hexdigest()[:16]


def run(deck: Path, *, fallback: bool = False) -> str:
    """Digest of the run of a deck, with the first line of its error if it has one."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            job.run(deck, output_dir=folder, solver=SolverOptions(fallback=fallback))
        except UelError as error:
            return f"{digest(folder)} {str(error).splitlines()[0].replace(str(deck.parent), '')[-60:]}"
        return digest(folder)


def digests_of_body(body: Body) -> dict[str, str]:
    """Digests of the runs of a body, by their names."""
    forms = [Variant("as it is", nlgeom=body.nlgeom, output=True)]
    if body.vectors and body.large and not body.nlgeom:
        forms.append(Variant("NLGEOM", nlgeom=True, output=True, factor=0.1))
    if body.mass and body.linear and body.vectors:
        forms.append(Variant("frequencies", modes=True))
    with tempfile.TemporaryDirectory() as name:
        deck = Path(name) / "job.inp"
        found = {}
        for form in forms:
            deck.write_text(text(body, form))
            found[f"{body.name}: {form.name}"] = run(deck)
        return found


def digests_of_deck(deck: Path, fallback: bool) -> dict[str, str]:
    """Digest of the run of a deck in a copy of its folder, by its name."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / deck.parent.name
        shutil.copytree(deck.parent, folder)
        return {f"{deck.parent.name}/{deck.name}": run(folder / deck.name, fallback=fallback)}


def decks() -> Iterator[tuple[Path, bool]]:
    """Decks to run, and whether the run takes `--fallback`."""
    for deck in sorted((ROOT / "tests/programs/fuzz/decks").glob("*.inp")):
        yield deck, False
    for page in sorted((ROOT / "abaqus_inputs").glob("*/reference.toml")):
        references, long, fallback, *_ = read_references(page.parent)
        quick = {reference.deck for reference in references} - set(long)
        for deck in sorted(quick):
            yield deck, bool(fallback)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path, help="where the digests go (JSON)")
    parser.add_argument("names", nargs="*", metavar="BODY", help="beginnings of names of bodies and decks (all)")
    parser.add_argument("--against", type=Path, help="digests of another version")
    parser.add_argument("--workers", type=int, default=1, help="processes (1)")
    options = parser.parse_args(arguments)
    begins = tuple(options.names)
    chosen = [body for body in bodies() if not begins or body.name.startswith(begins)]
    others = [deck for deck in decks() if not begins or f"{deck[0].parent.name}/{deck[0].name}".startswith(begins)]
    found: dict[str, str] = {}
    if options.workers > 1:
        with ProcessPoolExecutor(options.workers) as pool:
            for one in pool.map(digests_of_deck, *zip(*others, strict=True)) if others else ():
                found.update(one)
            # bodies hold functions, which cannot be sent and differ from call to call: by position
            names = {body.name for body in chosen}
            for one in pool.map(_body_at, [position for position, body in enumerate(bodies()) if body.name in names]):
                found.update(one)
    else:
        for one in (*(digests_of_deck(*deck) for deck in others), *map(digests_of_body, chosen)):
            found.update(one)
    options.file.write_text(json.dumps(found, indent=0, sort_keys=True) + "\n")
    if options.against is None:
        return 0
    expected = json.loads(options.against.read_text())
    differ = [name for name in found if name in expected and expected[name] != found[name]]
    for name in differ:
        print(f"{name}: {expected[name]}, now {found[name]}")
    print(f"{len(found)} runs, {len(differ)} differ")
    return int(bool(differ))


def _body_at(position: int) -> dict[str, str]:
    return digests_of_body(list(bodies())[position])


if __name__ == "__main__":
    sys.exit(main())
