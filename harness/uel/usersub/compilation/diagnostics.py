# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Diagnostics of the compilers: the first error as a message, with a hint if it is for another compiler; warnings."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

_LOCATION = re.compile(r"^(?P<file>.+?):(?P<line>\d+):(?P<column>\d+):")
# gfortran puts the location on its own line, then the source, then this
_ERROR = re.compile(r"(?:Fatal )?Error: ")
# gcc and g++ begin with all of it, and the source follows
_C_ERROR = re.compile(r"^(?P<file>[^:\n]+):(?P<line>\d+):(?P<column>\d+): (?:fatal )?error: (?P<sentence>.*)$")
_C_CONTEXT = re.compile(r"^ *\d* \| ")
_LOCATED: Final = re.compile(r"^(?P<file>[^\s:][^:\n]*):(?P<line>\d+):(?P<column>\d+):\s*(?P<rest>.*)$")
_WARNING: Final = re.compile(r"^(?:Warning|Error): (?P<text>.*?)(?: \[(?P<option>-W[\w=+-]+)\])?$")
_C_WARNING: Final = re.compile(r"^warning: (?P<text>.*?)(?: \[(?P<option>-W[\w=+-]+)\])?$")

_HINTS: Final = (
    (
        r"Cannot open module file '(?:ifport|ifcore|iflport|ifposix|dflib|dfport)\.mod'",
        "it belongs to Intel's compiler: use Fortran's own routines, or Abaqus' STDB_ABQERR and XIT",
    ),
    (
        r"module file '(?:lapack95|blas95|f95_precision|mkl\w*)\.mod'|included file '(?:mkl|lapack)\w*\.(?:fi|f90)'",
        "it belongs to Intel's MKL: LAPACK and BLAS are linked here without it; call them by name, such as DGESV",
    ),
    (
        r"included file 'vaba_param",
        "it belongs to Abaqus/Explicit, whose VUEL, VUMAT and other routines are not called here",
    ),
    (r"\.(?:h|hpp|hh|hxx): No such file|/\w+: No such file", "name its folder in the environment variable CPATH"),
    (
        r"already being used as a SUBROUTINE|FUNCTION attribute conflicts with SUBROUTINE|Unexpected use of subroutine",
        "a subroutine has no value to use in an expression: CALL it and use what it returns in an argument, or turn it "
        "into a FUNCTION",
    ),
    (
        r"Return type mismatch of function",
        "it is not declared where it is called, so its first letter gives it a type: declare it there",
    ),
    (r"requires a scalar LOGICAL", "write the comparison out, such as i /= 0"),
    (
        r"must be compared with \.n?eqv\.",
        "Abaqus' compiler accepts this; write .eqv. or .neqv., with parentheses around the comparison",
    ),
)
"""Errors that point to another compiler, and what to do."""

_NO_MODULE: Final = re.compile(r"Cannot open module file '(\w+)\.mod'")

_TWICE: Final = re.compile(
    r"([\w.-]+):(?:\([^)]*\)|\d+): multiple definition of `(\w+)'; [^\n]*?([\w.-]+):(?:\(|\d+: first)"
)
_OTHER_FORM: Final = (
    r"Non-numeric character in statement label|Invalid character in name|Unclassifiable statement"
    r"|Bad continuation line|Unexpected end of file|Expecting|Syntax error"
)
_FREE_STATEMENT: Final = re.compile(
    r"^ {0,4}(?:module|subroutine|function|program|end|use|implicit|integer|real)\b", re.IGNORECASE | re.MULTILINE
)
# not where column 6 continues the line too, which is valid in both forms
_FREE_CONTINUATION: Final = re.compile(r"^(?![cC*!])[^!\n]*&[ \t]*\n(?! {5}[^ 0\n])", re.MULTILINE)
_FIXED_CONTINUATION: Final = re.compile(r"^ {5}[1-9&+]", re.MULTILINE)


def first_error(output: str, texts: Mapping[str, str]) -> str:
    """Return the compiler's first error: sentence, location, the source line with its column marked, and a hint.

    texts: contents of the user's files by bare name, for the hint.
    """
    location: re.Match[str] | None = None
    context: list[str] = []
    lines = output.splitlines()
    for number, line in enumerate(lines):
        if match := _C_ERROR.match(line):
            context = [text for text in lines[number + 1 : number + 3] if _C_CONTEXT.match(text)]
            return _message(match["sentence"], match, context, texts)
        if match := _ERROR.match(line):
            return _message(line[match.end() :], location, context, texts)
        if found_location := _LOCATION.match(line):
            location, context = found_location, []
        elif line.strip():
            context = [*context, line]
    if twice := _TWICE.search(output):
        return f"{twice[2].removesuffix('_').upper()} is defined twice, in {twice[3]} and in {twice[1]}"
    return f"does not compile or link:\n{output.strip()}"


def _message(sentence: str, location: re.Match[str] | None, context: list[str], texts: Mapping[str, str]) -> str:
    head = f"does not compile: {sentence.replace(' at (1)', '')}"
    if location is None:
        return head
    name = Path(location["file"]).name
    hint = _hint(sentence, name, texts)
    where = f"{name}, line {location['line']}, column {location['column']}"
    return "\n".join([f"{head} ({where})", *context, *([f"Hint: {hint}."] if hint else [])])


def _hint(sentence: str, name: str, texts: Mapping[str, str]) -> str:
    for pattern, hint in _HINTS:
        if re.search(pattern, sentence, re.IGNORECASE):
            return hint
    if match := _NO_MODULE.search(sentence):
        return _missing_module(match[1], name, texts)
    text, free = texts.get(name, ""), name.lower().endswith(".f90")
    if re.search(_OTHER_FORM, sentence):
        if not free and _looks_free(text):
            return "it looks like free form: call it .f90, or begin it with !DIR$ FREEFORM"
        if free and _FIXED_CONTINUATION.search(text):
            return "it looks like fixed form: call it .for"
    return ""


def _missing_module(module: str, name: str, texts: Mapping[str, str]) -> str:
    """Say where to find a module that a file uses and that is not compiled yet."""
    definition = re.compile(rf"^\s*module\s+{module}\s*(?:!.*)?$", re.IGNORECASE | re.MULTILINE)
    files = [file for file, text in texts.items() if definition.search(text)]
    if not files:
        return f"none of the files defines the module {module}: give the file that does before this one"
    if name in files:
        return f"the module {module} is further down: move it to the top of the file"
    return f"{files[0]} defines the module {module}: give it before {name}"


def _looks_free(text: str) -> bool:
    """Return whether statements go on after a & at the end of a line, or many begin in the first five columns.

    There fixed form has only labels, and it continues lines by column 6.
    """
    if len(_FREE_STATEMENT.findall(text)) > 1 or _FREE_CONTINUATION.search(text):
        return True
    lines = [line for line in text.splitlines() if line.strip() and line[0] not in "cC*!#dD"]
    early = [line for line in lines if not line[:5].strip().isdigit() and line[:5].strip() and "\t" not in line[:6]]
    return len(early) > len(lines) / 4


def warnings_of(output: str) -> Iterator[tuple[str, int, int, str, str]]:
    """Yield the bare file name, line, column, text and option of each message of gfortran, gcc or g++."""
    location: re.Match[str] | None = None
    for row in output.splitlines():
        if match := _LOCATED.match(row):
            if warning := _C_WARNING.match(match["rest"]):
                yield (*_coordinates(match), warning["text"], warning["option"] or "")
            elif not match["rest"] and location is None:
                # the first of several locations is (1)
                location = match
        elif warning := _WARNING.match(row):
            if location is not None:
                yield (*_coordinates(location), warning["text"], warning["option"] or "")
            location = None
        elif row.startswith("note: "):
            location = None


def _coordinates(location: re.Match[str]) -> tuple[str, int, int]:
    return Path(location["file"]).name, int(location["line"]), int(location["column"])
