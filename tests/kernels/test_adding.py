# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What CONTRIBUTING says of adding a cohesive law and an interface element, done on a copy of the kernels.

The law is branch/plateau.f90, with a property of its own; the element is U2 with the nodes of its top edge from left to
right. Existing decks give what they gave.
"""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from uel import usersub
from uel.errors import KernelError
from uel.usersub.layout import element_layouts, read_layouts

ROOT = Path(__file__).parents[2]
BRANCH = Path(__file__).parent / "branch"

PLATEAU = """
[[reals]]
name = "PLATEAU"
elements = "interfaces"
unit = "1"
range = "below_one"
part = "law"
meaning = "share of the plateau"
laws = [7]
"""

LAW = {
    "cohesive/law.f90": [
        ("only: law_properties, bilinear_law,", "only: law_properties, plateau_law, bilinear_law,"),
        (
            "  use cohesive_ppr,",
            "  use cohesive_plateau, only: plateau_softening, plateau_steepest, plateau_loss\n  use cohesive_ppr,",
        ),
        (
            "      slope = exponential_steepest(law)\n",
            "      slope = exponential_steepest(law)\n    case (plateau_law)\n      slope = plateau_steepest(law)\n",
        ),
        (
            "      call exponential_softening(law, separation, f, e, traction, by_separation, by_f, by_e)\n",
            "      call exponential_softening(law, separation, f, e, traction, by_separation, by_f, by_e)\n"
            "    case (plateau_law)\n"
            "      call plateau_softening(law, separation, f, e, traction, by_separation, by_f, by_e)\n",
        ),
        (
            "      area = exponential_loss(law, direction, stiff, lost)\n",
            "      area = exponential_loss(law, direction, stiff, lost)\n    case (plateau_law)\n"
            "      area = plateau_loss(law, direction, stiff, lost)\n",
        ),
    ],
    "properties.toml": [
        ('"bridging", "table"]', '"bridging", "table", "plateau"]'),
        ("\n# JPROPS\n", PLATEAU + "\n# JPROPS\n"),
    ],
    "meson.build": [("  'cohesive/ppr.f90',\n", "  'cohesive/plateau.f90',\n  'cohesive/ppr.f90',\n")],
}
"""Edits of a file: what is there, what takes its place. The file of the law itself is new."""

ELEMENT = {
    "properties.toml": [
        (
            "top = [21, 24, 25, 22, 33, 30, 34, 27]\n",
            "top = [21, 24, 25, 22, 33, 30, 34, 27]\n"
            '\n[[elements]]\ntype = "U9000"\nmeaning = "U2, left to right"\nfamily = "standard"\n'
            "dimension = 2\nnodes = 4\npoints = 2\nbottom = [1, 2]\ntop = [3, 4]\n",
        ),
    ],
}

FLAT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
ALPHA, STRENGTH, TOUGHNESS, SHARE = 2e4, 30.0, 0.26, 0.4


def edited(text, edits):
    """The text with the edits; each place has to be there once."""
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


@pytest.fixture(scope="module")
def branch(program, tmp_path_factory):
    """A copy of the kernels with the law and the element: its library and its layouts."""
    folder = tmp_path_factory.mktemp("branch")
    shutil.copytree(ROOT / "fortran", folder / "fortran", ignore=shutil.ignore_patterns("host", "*.md", "*.csv"))
    for edits in (LAW, ELEMENT):
        for name, changes in edits.items():
            file = folder / "fortran" / name
            file.write_text(edited(file.read_text(), changes))
    shutil.copy(BRANCH / "plateau.f90", folder / "fortran" / "cohesive")
    properties = (folder / "fortran/properties.toml").read_text()
    generated = [folder / f"{name}.f90" for name in ("layout", "law_properties")]
    for file in generated:
        file.write_text(program(f"generate_{file.stem}").layout(properties))
    build = (folder / "fortran" / "meson.build").read_text()
    names = re.findall(r"^  '(\w+/\w+\.f90)',$", build, re.MULTILINE)
    sources = [*(folder / "fortran" / name for name in names), *generated]
    (folder / "branch.for").write_text(program("amalgamate").amalgamate(sources))
    library = usersub.load(folder / "branch.for", job="branch", output_dir=folder / "job")
    yield library, read_layouts(properties)
    library.close()


def opened(gap, nodes=(2, 3)):
    """(4, 2) displacements of U2 that part its edges by (tau, n)."""
    u = np.zeros((4, 2))
    u[list(nodes)] = gap
    return u


def test_positions_of_existing_decks_stay(branch):
    _, layouts = branch
    for jtype, before in element_layouts().items():
        after = layouts[jtype]
        assert after.reals[: len(before.reals)] == before.reals
        assert [i.name for i in after.reals[len(before.reals) :]] == (["PLATEAU"] if jtype not in (1, 9) else [])
        assert [i.name for i in after.integers] == [i.name for i in before.integers]
        assert after.svars == before.svars


@pytest.mark.parametrize("law", [1, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("jtype, closure", [(2, 0), (4, 0), (4, 1)])
def test_existing_decks_give_what_they_gave(branch, element_of, library, interface, jtype, law, closure):
    """But for the new property, which is 0."""
    options = {"CLOSURE": 1, "BETAN": 1e5, "BETAT": 1e5} if closure else {}
    # LAW 5 and 6 do not exist without theirs
    options |= {5: {"SIGMABRIDGE": 4.0, "GIBRIDGE": 0.1}, 6: {"SEPARATION1": 0.2, "TRACTION1": 0.5}}.get(law, {})
    nodes = interface.four if jtype == 2 else interface.eight
    variants = [(library, element_layouts()), branch]
    items = [element_of(where, jtype, nodes, layouts=known, LAW=law, ETA=1.4, **options) for where, known in variants]
    for number, name in enumerate(("elastic", "softening", "sliding", "mixed")):
        u = interface.displacements(len(nodes), *interface.states[name], number)
        expected, found = [(*item.advance(u), *item.state.values()) for item in items]
        for a, b in zip(found, expected, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-10, atol=1e-12 * abs(b).max())


def test_other_counts_of_properties_are_refused(branch, element_of):
    for count in (43, 45):
        item = element_of(branch[0], 2, FLAT, definition={"properties": count})
        with pytest.raises(KernelError, match=rf"PROPERTIES = {count}: expected 44"):
            item.evaluate(np.zeros(8))


def test_the_property_has_the_last_position(branch, element_of):
    for jtype, position in ((2, 44), (3, 48), (4, 72), (5, 44), (6, 72)):
        layout = branch[1][jtype]
        assert (layout.reals[-1].name, layout.reals[-1].position) == ("PLATEAU", position)
    item = element_of(branch[0], 2, FLAT, layouts=branch[1], LAW=7, PLATEAU=1.0)
    with pytest.raises(KernelError, match=r"PROPS\(44\) PLATEAU = 1.0.*expected zero or a value between 0 and 1"):
        item.evaluate(np.zeros(8))


def test_the_law_has_its_plateau_and_its_area(branch, element_of):
    """G = strength (onset + (failure - onset)(1 + share))/2."""
    item = element_of(branch[0], 2, FLAT, layouts=branch[1], LAW=7, PLATEAU=SHARE, ALPHAT=ALPHA)
    onset = STRENGTH / ALPHA
    failure = onset + (2 * TOUGHNESS / STRENGTH - onset) / (1 + SHARE)
    end = onset + SHARE * (failure - onset)
    gaps = np.linspace(0, 1.1 * failure, 1001)[1:]
    tractions = []
    for gap in gaps:
        item.advance(opened((0, gap)))
        tractions.append(item.state["TN"][0])
    curve = np.interp(gaps, [0, onset, end, failure, 2 * failure], [0, STRENGTH, STRENGTH, 0, 0])
    np.testing.assert_allclose(tractions, curve, atol=1e-9 * STRENGTH)
    assert item.state["DISSI"][0] == pytest.approx(TOUGHNESS, rel=1e-12)


@pytest.mark.parametrize("closure", [0, 1])
@pytest.mark.parametrize("size", [0.003, 0.008, 0.012])
def test_the_tangent_of_the_law(branch, element_of, interface, size, closure):
    """On the plateau and where it falls, in mixed mode, in both ways to take the law."""
    options = {"CLOSURE": 1, "BETAN": 1e5, "BETAT": 1e5} if closure else {}
    jtype, nodes = (4, interface.eight) if closure else (2, interface.four)
    item = element_of(branch[0], jtype, nodes, layouts=branch[1], LAW=7, PLATEAU=SHARE, ETA=1.4, **options)
    u = interface.displacements(len(nodes), (0.5 * size, size), (0.6 * size, 0.9 * size), 3).ravel()
    _, tangent = item.evaluate(u)
    step = 1e-4 * size
    for along in np.eye(u.size):
        samples = [item.evaluate(u + n * step * along)[0] for n in (-2, -1, 1, 2)]
        slope = (samples[0] - 8 * samples[1] + 8 * samples[2] - samples[3]) / (12 * step)
        np.testing.assert_allclose(-slope, tangent @ along, atol=1e-6 * abs(tangent).max())


def test_the_element_is_u2_in_another_order(branch, element_of):
    u = opened((0.004, 0.003))
    order = [0, 1, 3, 2]
    dofs = np.array([[2 * n, 2 * n + 1] for n in order]).ravel()
    expected = element_of(branch[0], 2, FLAT, layouts=branch[1]).evaluate(u)
    found = element_of(branch[0], 9000, FLAT[order], layouts=branch[1]).evaluate(u[order])
    np.testing.assert_allclose(found[0], expected[0][dofs], rtol=1e-12)
    np.testing.assert_allclose(found[1], expected[1][np.ix_(dofs, dofs)], rtol=1e-12)


@pytest.mark.parametrize(
    "row, edits, more",
    [
        ("cohesive law", LAW, {"fortran/cohesive/LAW.f90", "fortran/README.md"}),
        ("interface element between faces", ELEMENT, {"fortran/README.md"}),
    ],
)
def test_contributing_names_these_files(row, edits, more):
    assert len(edits) <= 3
    text = (ROOT / "CONTRIBUTING.md").read_text()
    (line,) = [line for line in text.splitlines() if line.startswith(f"| {row} |")]
    assert set(re.findall(r"`(fortran/[^`]+)`", line)) == {f"fortran/{name}" for name in edits} | more
