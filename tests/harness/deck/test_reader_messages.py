# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every message of the reader: file:line first, then what is wrong."""

from collections.abc import Callable
from pathlib import Path

import pytest

from uel.errors import DeckError
from uel.model.model import Model

Read = Callable[[str], Model]
Refuse = Callable[[str, tuple[str, str, str]], None]
FLAT = Path(__file__).with_name("flat.inp").read_text()
CAE = Path(__file__).with_name("cae.inp").read_text()

# what to replace in flat.inp, by what, and the line and text of the message
MISTAKES = {
    "unknown keyword": ("*MATERIAL", "*MATERYAL", r"29: unknown keyword \*MATERYAL; did you mean MATERIAL\?"),
    "no keyword": ("*MATERIAL", "*\n*MATERIAL", r"29: a keyword line without a keyword; a comment begins with \*\*$"),
    "no keyword before options": ("*MATERIAL", "* ,\n*MATERIAL", "29: a keyword line without a keyword"),
    "unknown option": (
        "TYPE=U1, NODES",
        "TYPEX=U1, NODES",
        r"7: \*USER ELEMENT: unknown option TYPEX; did you mean TYPE\?",
    ),
    "option that nothing is like": (
        "*END STEP",
        "*INCLUDE, WHERE=more.inp\n*END STEP",
        r"\d+: \*INCLUDE: unknown option WHERE; it takes INPUT, FILE",
    ),
    "option of a keyword without any": (
        "*END STEP",
        "*END STEP, FAST",
        r"\d+: \*END STEP: unknown option FAST; it takes none",
    ),
    "missing option": ("*MATERIAL, NAME=PLY", "*MATERIAL", r"29: \*MATERIAL needs the option NAME"),
    "ambiguous option": ("INC=500", "N=500", r"41: \*STEP: option N is ambiguous .NAME or NLGEOM.; write it out"),
    "option without value": ("NAME=PLY", "NAME=", r"29: \*MATERIAL, NAME needs a value"),
    "option with a quote alone": ("NAME=PLY", 'NAME="', r"29: \*MATERIAL, NAME needs a value"),
    "flag with a value": ("GENERATE", "GENERATE=3", r"25: \*NSET, GENERATE takes no value, found '3'"),
    "switch": ("NLGEOM=NO", "NLGEOM=MAYBE", r"41: \*STEP, NLGEOM=MAYBE: expected one of YES, NO, ON, OFF"),
    "choice": ("TENSOR=PSTRESS", "TENSOR=PSTRES5", r"7: TENSOR=PSTRES5: expected one of .*; did you mean PSTRESS\?"),
    "integer option": ("NODES=4", "NODES=four", r"7: \*USER ELEMENT, NODES: 'four' is not an integer"),
    "unsupported keyword": ("*CLOAD\n", "*DECHARGE\n", r"48: \*DECHARGE is not supported"),
    "unsupported option": ("*STATIC", "*STATIC, ADIABATIC", r"43: \*STATIC: option ADIABATIC is not supported"),
    "unsupported value": (
        "*ELASTIC",
        "*ELASTIC, TYPE=SHEAR",
        r"30: \*ELASTIC, TYPE=SHEAR is not supported \(supported: ISO",
    ),
    "subdivided step": ("INC=500", "SUBDIVIDE", r"41: \*STEP: option SUBDIVIDE is not supported"),
    "stabilize": ("*STATIC", "*STATIC, LONG TERM", r"43: \*STATIC: option LONG TERM is not supported"),
    "coordinate system": (
        "*NODE, NSET=ALL",
        "*NODE, SYSTEM=C",
        r"11: \*NODE, SYSTEM=C is not supported \(supported: R\)",
    ),
    "system": (
        "*NODE, NSET=ALL",
        "*SYSTEM\n0., 0., 0., 1., 0., 0.\n2., 0., 0.\n*NODE, NSET=ALL",
        r"12: \*SYSTEM: the points of the system are collinear",
    ),
    "parameter": ("<width>", "<with>", r"33: parameter <with> is not defined"),
    "expression": ("half = width/2", "half = open('x')", r"6: \*PARAMETER: 'open\('x'\)' is not an expression that"),
    "power": (
        "half = width/2",
        "half = 10.**400",
        r"6: .* 'half = 10.\*\*400' cannot be evaluated: a number is too large",
    ),
    "what is not seen": ("3, 1., 1.\n", "3, 1., 1\x1b[31m\xa02\n", r"14: .* '1\\x1b\[31m\\xa02' is not a number"),
    "a long word": (
        "3, 1., 1.\n",
        f"3, 1., {'x' * 9999}\n",
        r"14: .* coordinate 2: 'x{400,} \.\.\. x{400,}' is not a number",
    ),
    "digits without end": (
        "half = width/2",
        "half = width" + "\nhalf = half*half" * 8,
        r"14: \*PARAMETER: 'half\*half' is too large for a number",
    ),
    "division by zero": ("half = width/2", "half = width/0", r"6: \*PARAMETER: 'half = width/0' cannot be evaluated"),
    "integer division": ("half = width/2", "half = 1/2", r"6: .*'1/2' divides the integers 1 and 2, which depends"),
    "division of integers by names": (
        "half = width/2",
        "half = 3\nquarter = (half+4) / 2 + 1.",
        r"7: .*'\(half\+4\) / 2' divides the integers 7 and 2, which depends on the release of Abaqus; give one",
    ),
    "function": ("half = width/2", "half = 2.*gamma( width )", r"6: .*'gamma\( width \)' is not an expression that"),
    "root": ("half = width/2", "half = (1 -width)**.5", r"6: .*'\(1 -width\)\*\*.5' is not real"),
    "no assignment": ("half = width/2", "half", r"6: 'half' is not of the form name = expression"),
    "missing include": ("*CLOAD\n", "*INCLUDE, INPUT=loads.inp\n*CLOAD\n", r"48: cannot read loads.inp: No such file"),
    "no data lines": ("*END STEP", "*END STEP\n1, 2", r"65: \*END STEP takes no data lines"),
    "step keyword outside": ("*MATERIAL", "*STATIC\n*MATERIAL", r"29: \*STATIC: belongs between \*STEP and \*END STEP"),
    "model keyword in a step": ("*CLOAD", "*MATERIAL, NAME=X\n*CLOAD", r"48: \*MATERIAL: model data within a step"),
    "end without step": (
        "*STEP, NAME=Load, INC=500, NLGEOM=NO\n",
        "",
        r"42: \*STATIC: belongs between \*STEP and \*END STEP",
    ),
    "type of user element": (
        "*User Element, Type=U2",
        "*User Element, Type=V2",
        r"9: TYPE=V2: expected Un with n from 1",
    ),
    "variables": ("VARIABLES=32", "VARIABLES=0", r"7: VARIABLES=0: expected a number from 1"),
    "nodes": ("NODES=4", "NODES=0", r"7: NODES=0: expected a number from 1"),
    "tensor alone": ("INTEGRATION=4, ", "", r"7: INTEGRATION and TENSOR are given together or not at all"),
    "non-numeric coordinate": ("3, 1., 1.\n", "3, 1., one\n", r"14: \*NODE: coordinate 2: 'one' is not a number"),
    "large coordinate": (
        "3, 1., 1.\n",
        "3, 1., 1e101\n",
        r"14: .* '1e101' is too large: numbers up to 1e\+100 are read",
    ),
    "small coordinate": (
        "3, 1., 1.\n",
        "3, 1., 1d-320\n",
        r"14: .* '1d-320' is too small: numbers from 1e-100 on, and 0",
    ),
    "infinite coordinate": ("3, 1., 1.\n", "3, 1., 1e999\n", r"14: \*NODE: coordinate 2: '1e999' is too large"),
    "nan": ("3, 1., 1.\n", "3, 1., nan\n", r"14: \*NODE: coordinate 2: 'nan' is not a number"),
    "node number as a real number": ("3, 1., 1.\n", "3e0, 1., 1.\n", r"14: '3e0' is not an integer"),
    "largest node number": (
        "3, 1., 1.\n",
        "1000000000, 1., 1.\n",
        r"14: 1000000000 is not a node or element number \(1 to 999999999\)",
    ),
    "largest element number": ("\n2, 5, 6", "\n1000000000, 5, 6", r"22: 1000000000 is not a node or element number"),
    "largest number of a set": ("1, 2, 1\n", "1, 1000000000, 999999999\n", r"26: .* 1000000000 is not a node or el"),
    "a word without end": ("*MATERIAL", f"*MATERIAL{'X' * 99}", rf"29: unknown keyword \*MATERIAL{'X' * 99}$"),
    "node number": ("3, 1., 1.\n", "3.5, 1., 1.\n", r"14: '3.5' is not an integer"),
    "negative node number": ("3, 1., 1.\n", "-3, 1., 1.\n", r"14: -3 is not a node or element number"),
    "missing node": ("1, 1, 2, 3, 4", "1, 1, 2, 3, 9", r"21: element 1 uses node 9, which is not defined"),
    "too few nodes": ("1, 1, 2, 3, 4", "1, 1, 2, 3", r"21: element 1 has 3 nodes, but U1 needs 4"),
    "too many nodes": ("1, 1, 2, 3, 4", "1, 1, 2, 3, 4, 5", r"21: element 1 has 5 nodes, but U1 needs 4"),
    "non-numeric connectivity": ("1, 1, 2, 3, 4", "1, 1, 2, x, 4", r"21: \*ELEMENT: 'x' is not a node number"),
    "element type": ("*ELEMENT, TYPE=U2", "*ELEMENT, TYPE=U3", r"23: element type U3 is not defined by \*USER ELEMENT"),
    "built-in type": (
        "*ELEMENT, TYPE=U2",
        "*ELEMENT, TYPE=S8R5",
        r"23: element type S8R5 of Abaqus is not supported here; the nearest are S8R, .*keywords.md, \*ELEMENT,",
    ),
    "misspelt type": (
        "*ELEMENT, TYPE=U2",
        "*ELEMENT, TYPE=CPS4RR",
        r"23: element type CPS4RR is not supported; the nearest are CPS4RT?, CPS4RT?, [A-Z0-9]+; harness",
    ),
    "set member": ("7, 8,\n", "7, NOWHERE\n", r"28: unknown node set NOWHERE"),
    "generate": ("GENERATE\n1, 2, 1", "GENERATE\n2, 1, 1", r"26: \*NSET: cannot generate from 2 to 1 in steps of 1"),
    "generate up": (
        "GENERATE\n1, 2, 1",
        "GENERATE\n1, 2, -1",
        r"26: \*NSET: cannot generate from 1 to 2 in steps of -1",
    ),
    "node set": ("TOP, 1\n", "TOPP, 1\n", r"47: unknown node set TOPP; did you mean TOP\?"),
    "node of a boundary": ("TOP, 1\n", "99, 1\n", r"47: node 99 is not defined"),
    "element set": (
        "*UEL PROPERTY, ELSET=BULK,",
        "*UEL PROPERTY, ELSET=BULL,",
        r"32: unknown element set BULL; did you m",
    ),
    "amplitude": ("AMPLITUDE=GROW", "AMPLITUDE=GROWN", r"45: unknown amplitude GROWN; did you mean GROW\?"),
    "material": ("MATERIAL=PLY", "MATERIAL=PLI", r"32: unknown material PLI; did you mean PLY\?"),
    "orientation": ("MATERIAL=PLY", "ORIENTATION=FIBRE", r"32: unknown orientation FIBRE"),
    "too few properties": (
        "MATERIAL=PLY\n<width>",
        "MATERIAL=PLY\n",
        r"32: 0 values where U1 takes 1 \(PROPERTIES=1\)",
    ),
    "section keyword": (
        "*ELEMENT, TYPE=U2, ELSET=INTERFACE",
        "*ELEMENT, TYPE=CPS4, ELSET=INTERFACE",
        r"34: \*UEL PROPERTY: element set INTERFACE holds elements of type",
    ),
    "second section": (
        "*AMPLITUDE",
        "*UEL PROPERTY, ELSET=BULK\n1.\n*AMPLITUDE",
        r"37: element 1 has a section already, by",
    ),
    "boundary type": ("BOTTOM, PINNED", "BOTTOM, PINED", r"40: unknown boundary type PINED; did you mean PINNED\?"),
    "boundary type of tubes": ("BOTTOM, PINNED", "BOTTOM, NOWARP", r"40: boundary type NOWARP is not supported"),
    "value before the steps": ("BOTTOM, PINNED", "BOTTOM, 1, 1, 0.5", r"40: value 0.5 before the first \*STEP"),
    "dof": ("TOP, 1\n", "TOP, 31\n", r"47: 31 is not a dof \(1 to 30\)"),
    "dof range": ("TOP, 1\n", "TOP, 2, 1\n", r"47: last dof 1 is before the first, 2"),
    "missing dof": ("TOP, 1\n", "TOP\n", r"47: \*BOUNDARY: dof is missing"),
    "too many entries": ("3, 1, 5.\n", "3, 1, 5., 6.\n", r"49: 4 entries, expected at most 3"),
    "acceleration": ("AMPLITUDE=GROW", "TYPE=ACCELERATION", r"45: \*BOUNDARY, TYPE=ACCELERATION is not supported"),
    "keyword without its asterisk": (
        "*BOUNDARY, AMPLITUDE=GROW\n",
        "Boundary, AMPLITUDE=GROW\n",
        r"45: \*STATIC: a second data line, expected only one; is the \* of \*BOUNDARY missing\?",
    ),
    "no procedure": ("*STATIC\n0.1, 1., 1.E-8, 0.25\n", "", r"41: \*STEP: the step has no procedure such as \*STATIC"),
    "increment too large": ("0.1, 1., 1.E-8, 0.25", "2., 1.", r"44: initial increment 2 exceeds the period 1"),
    "increment out of range": (
        "0.1, 1., 1.E-8, 0.25",
        "0.1, 1., 0.2",
        r"44: initial increment 0.1 is outside the smallest",
    ),
    "negative increment": ("0.1, 1., 1.E-8, 0.25", "-0.1, 1.", r"44: increments and period must not be negative"),
    "second line of static": (
        "0.1, 1., 1.E-8, 0.25",
        "0.1, 1.\n0.1",
        r"45: \*STATIC: a second data line, expected only one",
    ),
    "frequency": ("FREQUENCY=10", "FREQUENCY=-1", r"60: \*EL PRINT: FREQUENCY=-1 must not be negative"),
    "monitored node": ("NODE=7, DOF=2", "NODE=TOP, DOF=2", r"62: set TOP has 2 nodes, expected one"),
    "monitored dof": ("NODE=7, DOF=2", "NODE=7, DOF=77", r"62: 77 is not a dof"),
    "request without output": ("*OUTPUT, FIELD, FREQUENCY=5\n", "", r"50: \*NODE OUTPUT: does not follow \*OUTPUT"),
    "elastic constants": ("70000., 0.3", "70000., 0.3, 20., 1.", r"31: 4 entries, expected at most 3"),
    "modulus": ("70000., 0.3", "-70000., 0.3", r"31: E = -70000, nu = 0.3: expected E > 0"),
    "stray elastic": ("*MATERIAL, NAME=PLY\n", "", r"29: \*ELASTIC: does not follow \*MATERIAL"),
    "amplitude times": ("0., 0., 1., 1.\n", "0., 0., 0., 1.\n", r"38: \*AMPLITUDE: times must increase"),
    "amplitude pairs": ("0., 0., 1., 1.\n", "0., 0., 1.\n", r"38: \*AMPLITUDE: expected pairs of time and value"),
    "amplitude kind": ("NAME=GROW", "NAME=GROW, DEFINITION=SPECTRUM", r"37: DEFINITION=SPECTRUM is not supported"),
    "load of a list": ("3, 1, 5.\n", "3, 1, five\n", r"49: \*CLOAD: value: 'five' is not a number"),
    "integer property": ("3, -4\n", "3, -4.5\n", r"36: integer property -4.5 is not an integer"),
    "real property": ("<half>, 1.E6", "<half>, 1.E6e", r"36: \*UEL PROPERTY: property 2: '1.E6e' is not a number"),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=list(MISTAKES))
def test_mistake(refuse: Refuse, mistake: tuple[str, str, str]) -> None:
    refuse(FLAT, mistake)


STRUCTURE = {
    "missing end of a step": ("*End Step\n", "", r"80: \*STEP without \*END STEP"),
    "missing end of a part": ("*End Part\n", "", r"8: \*PART without \*END PART; \*ASSEMBLY follows at deck.inp:31"),
    "missing end of the assembly": ("*End Assembly\n", "", r"32: \*ASSEMBLY without \*END ASSEMBLY; \*STEP follows"),
    "missing end of an instance": ("*End Instance\n", "", r"34: \*INSTANCE without \*END INSTANCE; \*INSTANCE follows"),
    "end without beginning": ("*Part, name=Plate\n", "", r"27: \*END PART: no \*PART to end"),
    "instance outside": ("*Assembly, name=Assembly\n", "", r"33: \*INSTANCE belongs between \*ASSEMBLY and \*END ASS"),
    "unknown part": ("part=Plate\n", "part=Plato\n", r"34: \*INSTANCE: unknown part PLATO; did you mean PLATE\?"),
    "instance twice": (
        "name=Plate-2, part",
        "name=plate-1, part",
        r"37: \*INSTANCE: PLATE-1 is defined already, at deck",
    ),
    "second assembly": (
        "*End Assembly\n",
        "*End Assembly\n*Assembly, name=A\n*End Assembly\n",
        r"67: \*ASSEMBLY: the as",
    ),
    "model data after a step": ("*End Step\n", "*End Step\n*Nset, nset=X\n1\n", r"90: \*NSET: model data after the"),
    "material in a part": ("*End Part\n", "*Material, name=X\n*End Part\n", r"28: \*MATERIAL: does not belong between"),
    "part after a step": (
        "*End Step\n",
        "*End Step\n*Part, name=X\n",
        r"90: \*PART: model data after the first \*STEP",
    ),
    "unknown instance": (
        "instance=Plate-1\n 1, 4",
        "instance=Plat-1\n 1, 4",
        r"44: \*NSET: unknown instance PLAT-1; did",
    ),
    "node of an instance": ("Plate-2.4, 1, 2", "Plate-2.9, 1, 2", r"85: node PLATE-2.9 is not defined"),
    "set of an instance": (
        "Plate-1.Set-1, ENC",
        "Plate-1.Set-2, ENC",
        r"77: unknown node set PLATE-1.SET-2; did you mean",
    ),
    "connectivity": ("1, Plate-1.3, Plate-2.1", "1, Plate-1.3, Plate-2.9", r"59: node PLATE-2.9 is not defined"),
    "same axis points": ("5.,           0.,           1.,          90.", "5., 0., 0., 90.", r"39: .*axis are the same"),
    "translation": (
        "          5.,           0.,           0.\n",
        "five\n",
        r"38: \*INSTANCE: translation: 'five' is not",
    ),
    "third line": ("1.,          90.\n", "1., 90.\n1.\n", r"40: \*INSTANCE: expected one line with a translation"),
    "no section": ("*Solid Section, elset=Set-1,", "*Solid Section, elset=None,", r"26: unknown element set NONE"),
    "points on a line": (
        "1., 0., 0., 0., 1., 0.\n",
        "1., 0., 0., 2., 0., 0.\n",
        r"23: .*the points a, b and c are collinear",
    ),
    "axis": ("\n 3, 0.\n", "\n 4, 0.\n", r"24: \*ORIENTATION: axis 4 is not 1, 2 or 3"),
    "number of terms": ("2\nSet-1, 2, 1.", "3\nSet-1, 2, 1.", r"63: \*EQUATION: expected 3 terms, found 2"),
    "too many terms": (
        "2\nSet-1, 2, 1.",
        "1\nSet-1, 2, 1., RP, 2, 1.",
        r"63: \*EQUATION: expected 1 terms, found 2",
    ),
    "no number of terms": (
        "2\nSet-1, 2, 1.",
        "Set-1, 2, 1.",
        r"63: \*EQUATION: number of terms: 'Set-1' is not an inte",
    ),
    "half a term": ("Set-1, 2, 1.\n", "Set-1, 2\n", r"64: \*EQUATION: expected node or set, dof, coefficient"),
    "zero coefficient": ("Set-1, 2, 1.\n", "Set-1, 2, 0.\n", r"63: \*EQUATION: the coefficient of the first term, whi"),
    "sizes": ("Plate-1.2, 2, -1.", "Plate-1.All, 2, -1.", r"63: \*EQUATION: the node sets of the terms have different"),
    "density": ("7.8e-09,", "0.,", r"72: \*DENSITY: density 0 must be positive"),
    "densities": ("7.8e-09,", "7.8e-09, 20.", r"71: \*DENSITY: needs one data line with the density"),
    "thickness": ("20.,\n", "-20.,\n", r"27: \*SOLID SECTION: thickness -20 must be positive"),
    "material twice": (
        "*Boundary\n",
        "*Material, name=Steel\n*Boundary\n",
        r"76: \*MATERIAL: STEEL is defined already",
    ),
}


@pytest.mark.parametrize("mistake", STRUCTURE.values(), ids=list(STRUCTURE))
def test_mistake_in_structure(refuse: Refuse, mistake: tuple[str, str, str]) -> None:
    refuse(CAE, mistake)


def test_element_without_section(read: Read) -> None:
    start, end = FLAT.index("*UEL PROPERTY, ELSET=BULK"), FLAT.index("*UEL PROPERTY, ELSET=INTERFACE")
    with pytest.raises(DeckError, match=r"^deck.inp:21: element 1 and 1 more of type U1 have no section: no \*UEL"):
        read(FLAT[:start] + FLAT[end:])


def test_no_elements(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:1: the deck has no elements"):
        read("*NODE\n1, 0., 0.\n*STEP\n*STATIC\n*END STEP\n")


def test_no_step(read: Read) -> None:
    with pytest.raises(DeckError, match=r"^deck.inp:1: the deck has no \*STEP"):
        read(FLAT[: FLAT.index("*STEP")])


def test_missing_step_keyword_is_one_line_of_many(read: Read) -> None:
    text = FLAT.replace("*STEP, NAME=Load, INC=500, NLGEOM=NO\n", "")
    with pytest.raises(DeckError) as caught:
        read(text)
    assert str(caught.value).splitlines()[-1] == "deck.inp:63: *END STEP: no *STEP to end"


def test_all_places_are_reported_at_once(read: Read) -> None:
    text = (
        FLAT.replace("*CLOAD\n", "*DECHARGE\n")
        .replace("*MATERIAL", "*MATERYAL")
        .replace("*STATIC", "*STATIC, ADIABATIC")
    )
    with pytest.raises(DeckError) as caught:
        read(text)
    assert str(caught.value).splitlines() == [
        "deck.inp:29: unknown keyword *MATERYAL; did you mean MATERIAL?",
        "deck.inp:43: *STATIC: option ADIABATIC is not supported",
        "deck.inp:48: *DECHARGE is not supported",
    ]


def test_elements_of_abaqus_are_refused_beside_options(read: Read) -> None:
    """A shell with temperatures is refused for its type, not only for an option of its section."""
    shells = "*ELEMENT, TYPE=SC8RT, ELSET=PLIES\n8, 1, 2, 3, 4, 5, 6, 7, 8\n" * 2
    section = "*SHELL SECTION, ELSET=PLIES, MATERIAL=PLY, DENSITY=3.\n1.\n"
    with pytest.raises(DeckError) as caught:
        read(FLAT.replace("*MATERIAL", shells + section + "*MATERIAL", 1))
    option, element = str(caught.value).splitlines()
    assert option == "deck.inp:33: *SHELL SECTION: option DENSITY is not supported"
    assert element.startswith("deck.inp:29: element type SC8RT of Abaqus is not supported here; the nearest are SC8R, ")


def test_no_message_about_a_name_that_is_missing(read: Read) -> None:
    """*INSTANCE without PART=, *PART without NAME=: one message each, none about a part without a name."""
    with pytest.raises(DeckError) as caught:
        read(CAE.replace("name=Plate-1, part=Plate", "name=Plate-1"))
    assert str(caught.value) == "deck.inp:34: *INSTANCE needs the option PART"
    with pytest.raises(DeckError) as caught:
        read(CAE.replace("*Part, name=Plate", "*Part").replace("part=Plate", "part=Other"))
    assert "part  " not in str(caught.value)


def test_one_wrong_line_gives_one_message(read: Read) -> None:
    """No message about what only follows from another."""
    for old, new, message in MISTAKES.values():
        if "STEP and" in message or "no \\*STEP" in message:
            continue
        with pytest.raises(DeckError) as caught:
            read(FLAT.replace(old, new, 1))
        assert len(str(caught.value).splitlines()) == 1, new


def test_very_many_errors_are_counted(read: Read) -> None:
    with pytest.raises(DeckError, match=r"and 50 more errors$") as caught:
        read("*FOO\n" * 100)
    assert len(str(caught.value).splitlines()) == 51
