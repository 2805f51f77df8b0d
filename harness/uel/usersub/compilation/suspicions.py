# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Suspicions of the compilers about a user's files: certain mistakes, and code that is worth a look.

A mistake is certain if it is wrong whenever it is executed. Correct code in the style of Fortran 77 gives no warnings:
implicit types by the first letter, unused arguments, arrays declared with a bound of 1, REAL work arrays.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Final

from uel.errors import CompileError
from uel.usersub.compilation import argument_ranks
from uel.usersub.compilation.compiler import Opinion, build, listen
from uel.usersub.compilation.diagnostics import warnings_of
from uel.usersub.compilation.units import Unit, unit_at, units

_CHECKED: Final = re.compile(rb"At line (\d+) of file ([^\0]+)\0")

_BOUNDS: Final = re.compile(r"Array reference at \(1\) is out of bounds \((-?\d+) ([<>]) (-?\d+)\) in dimension (\d+)")
_TYPES: Final = re.compile(
    r"Type mismatch in argument '(\w+)' at \(1\); passed (REAL|INTEGER)\((\d+)\) to (REAL|INTEGER)\((\d+)\)"
)
_UNDECLARED: Final = re.compile(r"Symbol '(\w+)' at \(1\) has no IMPLICIT type")
_NEAR: Final = 0.8
"""Similarity of two names, one of which may be the other misspelt."""

_LONG: Final = 4
"""Least number of letters of a name that may be misspelt: shorter ones are all alike."""

_CONSTANT: Final = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+)(?![\w.])")
_FUNCTION: Final = re.compile(
    r"\b(sqrt|exp|log|log10|sin|cos|tan|asin|acos|atan)\(\s*(-?(?:\d+\.\d*|\.\d+))\s*\)", re.IGNORECASE
)
"""An intrinsic function of a single-precision constant."""
_QUOTIENT: Final = re.compile(r"(?<![\w.*/])(?:(\d+\.\d*|\.\d+)/(\d+\.?\d*|\.\d+)|(\d+)/(\d+\.\d*|\.\d+))(?![\w.])")
"""A quotient of constants, at least one of which is of single precision."""
_INTRINSIC: Final = frozenset(
    ("abs", "sqrt", "exp", "log", "log10", "sin", "cos", "tan", "asin", "acos", "atan", "max", "min", "dble", "real")
)
"""Functions whose argument is a number, not an index."""
_ASSIGNED: Final = re.compile(r"^\s*\d*\s*(?:if\s*\(.*\)\s*)?([a-z]\w*)\s*(?:\([^=]*\)\s*)?=(?!=)(.*)$", re.IGNORECASE)

_COUNT: Final = "give as many arguments as the routine has"
_OPTIONS: Final = {
    "-Winteger-division": "the quotient of integers is truncated to an integer: write 1.d0/3.d0",
    "-Wmaybe-uninitialized": "give it a value on every path that leads here",
    "-Wreturn-type": "assign a value to the name of the function on every path",
    "-Wdo-subscript": "check the first and the last pass of the loop",
    "-Waggressive-loop-optimizations": "the loop runs past the end of an array",
    "-Warray-bounds": "indices in C run from 0 to the size minus one",
    "-Wline-truncation": "the rest of the line is not read: continue it on another one",
    "-Wunused-result": "the function returns whether it succeeded",
    "-Wunused-value": "the statement has no effect",
    "-Wimplicit-function-declaration": "declare the function, or include its header",
    "-Wint-conversion": "an integer and an address are not the same",
    "-Wincompatible-pointer-types": "the argument is of another type than the parameter",
    "-Wformat": "the format does not match what is printed",
}
"""Warnings that are reported, and what to do; others are style."""

_SENTENCES: Final = (
    ("More actual than formal arguments|Missing actual argument", _COUNT),
    ("too few elements", "the routine may read and write the memory after it"),
)
"""Sentences for warnings without an option."""


@dataclass(frozen=True, slots=True)
class Suspicion:
    """A warning: bare name of the file, line from 1, what is wrong, the source line, what to do.

    certain: wrong whenever it is executed.
    """

    file: str
    line: int
    sentence: str
    source: str
    hint: str
    certain: bool

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.file} line {self.line}: {self.sentence}: {self.source}{hint}"


def suspicions(files: Sequence[Path], include: Sequence[Path] = ()) -> list[Suspicion]:
    """List what the compilers suspect in a user's files.

    Parameters
    ----------
    files
        Sources in Fortran, C or C++, in the order of compilation.
    include
        Folders in which INCLUDE lines are looked up, after those of the sources.

    Returns
    -------
    list[Suspicion]
        Each once; certain ones first, then in the order of the files and their lines.

    Raises
    ------
    CompileError
        A file cannot be read or does not compile.
    """
    opinion = listen(files, include)
    diagnosis = _Diagnosis(opinion, _checked_lines(files, include))
    suspicions = dict.fromkeys(
        [*diagnosis.warnings(), *diagnosis.misspelt(), *diagnosis.truncated(), *diagnosis.single_precision()]
    )
    names = [file.name for file in files]
    order = {name: number for number, name in enumerate(names)}
    return sorted(suspicions, key=lambda one: (not one.certain, order.get(one.file, len(names)), one.line))


def _checked_lines(files: Sequence[Path], include: Sequence[Path]) -> set[tuple[str, int]]:
    """Return the lines of Fortran in which a debug build checks an index: not those that are never reached."""
    try:
        library = build(files, include, debug=True).library.read_bytes()
    except CompileError:
        return set()
    return {(Path(name.decode(errors="replace")).name, int(line)) for line, name in _CHECKED.findall(library)}


class _Diagnosis:
    """The compilers' texts, read."""

    def __init__(self, opinion: Opinion, checked: set[tuple[str, int]]) -> None:
        self._opinion = opinion
        self._checked = checked
        self._lines = {name: text.splitlines() for name, text in opinion.texts.items()}
        self._units: dict[str, list[Unit]] = {
            name: units(text, free=name in opinion.free) for name, text in opinion.texts.items()
        }

    def warnings(self) -> Iterator[Suspicion]:
        """Yield what is wrong, or worth a look."""
        for file, line, column, text, option in warnings_of(self._opinion.warnings):
            if judged := self._judge(file, line, column, text, option):
                yield self._at(file, line, *judged)

    def misspelt(self) -> Iterator[Suspicion]:
        """Yield the names that are declared nowhere and occur once in their routine."""
        for file, line, _, text, _ in warnings_of(self._opinion.undeclared):
            match = _UNDECLARED.search(text)
            unit = unit_at(self._units.get(file, []), line)
            if match is None or unit is None or not unit.single(match[1]):
                continue
            name = match[1]
            others = (unit.names.keys() | unit.dummies) - {name}
            near = get_close_matches(name, others, n=1, cutoff=_NEAR) if len(name) >= _LONG else []
            # a variable that is set and not used, or an unused argument, is no mistake by itself
            if name not in unit.read and not near:
                continue
            meant = f" for '{near[0]}'" if near else ""
            yield self._at(file, line, f"'{match[1]}' is declared nowhere and used once: misspelt{meant}?", "", False)

    def truncated(self) -> Iterator[Suspicion]:
        """Yield real values assigned to variables that are integers by their first letter, and used as real numbers."""
        for file, line, _, text, option in warnings_of(self._opinion.warnings):
            if option != "-Wconversion" or not re.search(r"from REAL\(\d+\) to INTEGER", text):
                continue
            unit, assigned = unit_at(self._units.get(file, []), line), _ASSIGNED.match(self._code(file, line)[6:])
            if assigned is None:
                continue
            name, value = assigned[1].lower(), assigned[2]
            # an entry of PROPS or SVARS alone may well hold an integer
            if self._declared(file, unit, name) or not re.search(r"[*/+-]", value.strip()):
                continue
            yield self._at(
                file,
                line,
                f"'{name}' is an integer by its first letter, and what it gets is cut off",
                f"declare it: real*8 {name}; or write int(...) if that is meant",
                "*" in value and self._is_factor(file, unit, name),
            )

    def _declared(self, file: str, unit: Unit | None, name: str) -> bool:
        """Return whether a name has a declaration, anywhere in the file if the head of its unit is in another one."""
        if unit is not None:
            return name in unit.declared or name in unit.dummies
        declaration = rf"^\s*(?:integer|real|double\s*precision|dimension|common)\b.*\b{name}\b"
        return re.search(declaration, self._opinion.texts.get(file, ""), re.IGNORECASE | re.MULTILINE) is not None

    def _is_factor(self, file: str, unit: Unit | None, name: str) -> bool:
        """Return whether a name is multiplied as a real number wherever it becomes one."""
        uses = []
        for other, line, column, text, option in warnings_of(self._opinion.warnings):
            same = other == file and unit_at(self._units[file], line) is unit and option == "-Wconversion-extra"
            row = self._row(file, line)[:column].lower()
            if same and "from INTEGER" in text and re.search(rf"(?<!\w){name}$", row.rstrip()):
                rest, before = self._row(file, line)[column:].lstrip(), row.rstrip()[: -len(name)].rstrip()
                uses.append(rest.startswith("*") or before.endswith("*"))
        return bool(uses) and all(uses)

    def single_precision(self) -> Iterator[Suspicion]:
        """Yield constants that lose digits on their way into a variable of double precision: one message per file."""
        constants: dict[str, list[tuple[int, str, str]]] = {}
        for file, line, _, _, option in warnings_of(self._opinion.warnings):
            if option == "-Wconversion-extra":
                for constant, better in _short(self._code(file, line)):
                    if (line, constant, better) not in constants.setdefault(file, []):
                        constants[file].append((line, constant, better))
        for file, lines in constants.items():
            if lines:
                line, constant, better = lines[0]
                sentence = f"{constant} is a single-precision constant, with 7 digits"
                others = f"; there are {len(lines)} of them" if len(lines) > 1 else ""
                yield self._at(file, line, sentence, f"write {better}{others}", False)

    def _judge(self, file: str, line: int, column: int, text: str, option: str) -> tuple[str, str, bool] | None:
        """Return the sentence, hint and whether the mistake is certain; None for style."""
        if match := _BOUNDS.search(text):
            return self._outside(file, line, column, match)
        if match := _TYPES.search(text):
            actual, dummy = f"{match[2]}({match[3]})", f"{match[4]}({match[5]})"
            # a real array that a routine uses for integers is a work array, as in LAPACK
            certain = match[3] != match[5] and match[4] == "REAL"
            return (
                f"{actual} is passed for the argument '{match[1]}', which is {dummy}",
                "use one type in both",
                certain,
            )
        if argument := argument_ranks.array_argument(text):
            constant = argument_ranks.is_constant(self._opinion.texts.get(file, ""), line, column)
            actual_argument = "a constant" if constant else "a single value"
            return (
                f"{actual_argument} is passed for the argument '{argument}', which is an array",
                argument_ranks.HINT,
                constant,
            )
        if option.endswith("uninitialized") and self._internal(file, text):
            return None
        if option == "-Wuninitialized":
            name = match[0] if (match := re.match(r"'\w+'", text)) else "a local variable"
            return f"{name} is used before it has a value", "", True
        hint = _OPTIONS.get(option) or next((hint for pattern, hint in _SENTENCES if re.search(pattern, text)), "")
        certain = hint == _COUNT or (option == "-Winteger-division" and self._of_reals(file, line, column))
        return (text.replace(" at (1)", ""), hint, certain) if hint else None

    def _internal(self, file: str, text: str) -> bool:
        """Return whether a warning names a variable that the compiler made.

        Such as the bounds of an intermediate array; or a value of a derived type, 'ply.9', by the name of the type.
        """
        match = re.match(r"'(\w+)(\.\d+)?", text)
        text_of_file = self._opinion.texts.get(file, "")
        if match is None:
            return False
        kind = r"^\s*type\b[^(\n]*" if match[2] else ""
        there = re.search(rf"{kind}\b{match[1]}\b", text_of_file, re.IGNORECASE | re.MULTILINE) is not None
        return there if match[2] else not there

    def _of_reals(self, file: str, line: int, column: int) -> bool:
        """Return whether a quotient of integers is part of a real variable's value, and of no index or argument."""
        code = self._code(file, line)
        unit, assigned = unit_at(self._units.get(file, []), line), _ASSIGNED.match(code[6:])
        if assigned is None or column - 1 < 6 + assigned.start(2):
            return False
        name = assigned[1].lower()
        if name[0] in "ijklmn" or (unit is not None and name in unit.integers):
            return False
        depth = 0
        for position in range(column - 2, 6 + assigned.start(2) - 1, -1):
            depth += (code[position] == ")") - (code[position] == "(")
            if depth < 0:
                before = re.search(r"([a-z]\w*)\s*$", code[:position], re.IGNORECASE)
                if before and before[1].lower() not in _INTRINSIC:
                    return False
                depth = 0
        return True

    def _outside(self, file: str, line: int, column: int, match: re.Match[str]) -> tuple[str, str, bool] | None:
        index, side, bound, dimension = match.groups()
        name = self._array(file, line, column)
        unit = unit_at(self._units.get(file, []), line)
        dummy = unit is not None and name in unit.dummies
        if dummy and bound == "1":
            return None
        if (file, line) not in self._checked:
            # after an IF that is never true
            return None
        bounds = "below its lower" if side == "<" else "above its upper"
        sentence = f"index {index} of dimension {dimension} of '{name}' is {bounds} bound of {bound}"
        return sentence, "" if not dummy else "declare the argument with its actual size", not dummy

    def _array(self, file: str, line: int, column: int) -> str:
        """Return the name of the array whose index is at a column (from 1)."""
        row = self._row(file, line)[:column]
        depth = 0
        for position in range(len(row) - 1, -1, -1):
            depth += (row[position] == ")") - (row[position] == "(")
            if depth < 0:
                name = re.search(r"(\w+)\s*$", row[:position])
                return name[1].lower() if name else ""
        return ""

    def _row(self, file: str, line: int) -> str:
        rows = self._lines.get(file, [])
        return rows[line - 1] if 1 <= line <= len(rows) else ""

    def _code(self, file: str, line: int) -> str:
        return re.sub(r"'[^']*'|!.*", "", self._row(file, line))

    def _at(self, file: str, line: int, sentence: str, hint: str, certain: bool) -> Suspicion:
        return Suspicion(file, line, sentence, " ".join(self._row(file, line).split()), hint, certain)


def _short(code: str) -> Iterator[tuple[str, str]]:
    """Yield the numbers in a line whose single precision loses digits, and how to write them in double precision."""
    for constant in _CONSTANT.findall(code):
        if _rounded(float(constant)) != float(constant):
            yield constant, f"{constant}d0"
    for match in _FUNCTION.finditer(code):
        function, argument = match[1].lower(), match[2]
        with suppress(ValueError):
            value = getattr(math, function)(float(argument))
            if _rounded(value) != value and _rounded(float(argument)) == float(argument):
                yield match[0], f"{match[1]}({argument}d0)"
    for match in _QUOTIENT.finditer(code):
        above, below = match[1] or match[3], match[2] or match[4]
        if float(below) and _rounded(float(above) / float(below)) != float(above) / float(below):
            yield match[0], f"{above if '.' in above else above + '.'}d0/{below if '.' in below else below + '.'}d0"


def _rounded(value: float) -> float:
    """Round a number to single precision."""
    short: float = struct.unpack("f", struct.pack("f", value))[0]
    return short
