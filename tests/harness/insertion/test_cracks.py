# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Initial cracks whose faces touch: `uel insert --crack SET --contact`."""

import numpy as np
import pytest
from solid_grids import grid, inserted

import uel
from uel.cli import main
from uel.deck.reader import read_deck
from uel.errors import UsageError
from uel.usersub.layout import element_layouts

YOUNG, POISSON, MU = 1.0e4, 0.3, 0.25
SIZES = (3.0, 1.0, 2.0)
STRONG = ("SIGMAMAX=1e3", "TAUMAX=1e3", "GIC=1e3", "GIIC=1e3")
ALPHA = 1.0e7
"""Stiffness of standard elements: less than 1e-3 of the compliance of the solids, which are 2 long."""
KINDS = {"CPS4": ("U2", "U4"), "CPS8": ("U5", "U6"), "C3D8": ("U7", "U8"), "C3D10": ("U1010",), "C3D6": ("U13", "U606")}
PAIRS = [(kind, element) for kind, elements in KINDS.items() for element in elements]
STANDARD = ("U2", "U5", "U7", "U13")


def laminate(kind, counts=(6, 2), cracked=3.0):
    """Two plies LOW and HIGH with an interface in the middle, MID, a CRACK up to x = `cracked`, and the ends BASE, TOP,
    LEFT and RIGHT.
    """
    sizes = SIZES if kind.startswith("C3D") else SIZES[::2]
    mesh = grid(kind, (counts[0], *[1] * (len(sizes) - 2), counts[1]), sizes)
    low = mesh.cell[:, -1] < counts[1] // 2
    mesh.sets = {"LOW": low, "HIGH": ~low}
    last = len(sizes) - 1
    middle = np.isclose(mesh.nodes[:, last], 1.0)
    mesh.node_sets = {"BASE": mesh.end(last, 0), "TOP": mesh.end(last, 1), "LEFT": mesh.end(0, 0)}
    mesh.node_sets |= {"RIGHT": mesh.end(0, 1), "MID": middle, "CRACK": middle & (mesh.nodes[:, 0] < cracked + 1e-6)}
    return mesh


def deck(path, mesh, steps, poisson=0.0):
    """A deck with these steps: the boundary conditions of each."""
    lines = [*mesh.lines(), "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "1.", "*MATERIAL, NAME=M"]
    lines += ["*ELASTIC", f"{YOUNG}, {poisson}"]
    for loads in steps:
        lines += ["*STEP, INC=200, UNSYMM=YES", "*STATIC", "0.25, 1., 1e-4, 0.25", "*BOUNDARY", *loads]
        lines += ["*OUTPUT, HISTORY, FREQUENCY=1", "*NODE OUTPUT, NSET=TOP", "RF", "*ENERGY OUTPUT"]
        lines += ["ALLSE, ALLIE, ALLPD, ALLWK, ETOTAL"]
        lines += ["*OUTPUT, FIELD", "*NODE OUTPUT", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")
    return path


def law_of(element):
    return [*STRONG, f"ALPHAN={ALPHA}"] if element in STANDARD else list(STRONG)


def run(path):
    return uel.run(path, output_dir=path.parent, quiet=True)


def force(result, dof, end=-1):
    """Sum of the reactions of TOP along an axis."""
    return sum(values[end] for name, values in result.history.items() if name.startswith(f"RF{dof}[TOP:"))


def held(dimension, across, along=0.0):
    """BASE is held and TOP moved."""
    still = [f"TOP, {k}, {k}, 0." for k in range(2, dimension)]
    return [f"BASE, 1, {dimension}", f"TOP, 1, 1, {along!r}", *still, f"TOP, {dimension}, {dimension}, {across!r}"]


@pytest.mark.parametrize(("kind", "element"), PAIRS)
def test_a_crack_that_is_pressed_shut_answers_as_the_uncracked_block(tmp_path, kind, element):
    """E A u/H without contraction; a standard element adds the compliance 1/alpha to H/E (fortran/laws.md)."""
    mesh = laminate(kind)
    dimension = mesh.nodes.shape[1]
    path = deck(tmp_path / "uncut.inp", mesh, [held(dimension, -0.01)])
    cut = tmp_path / "cut.inp"
    done = inserted(path, cut, law_of(element), nodes=["MID"], crack=["CRACK"], contact=True, element=element)
    assert done.contact == done.elements == done.crack
    uncut, pressed = run(path), run(cut)
    area = 3.0 * (SIZES[1] if dimension == 3 else 1.0)
    whole = -0.01 * area / (2.0 / YOUNG)
    assert force(uncut, dimension) == pytest.approx(whole, rel=1e-9)
    compliance = 2.0 / YOUNG + (1.0 / ALPHA if element in STANDARD else 0.0)
    assert force(pressed, dimension) == pytest.approx(-0.01 * area / compliance, rel=1e-9)
    assert pressed.history["ALLPD"][-1] == 0.0


@pytest.mark.parametrize(("kind", "element"), [pair for pair in PAIRS if pair[1] not in STANDARD])
def test_pressed_faces_slide_at_the_coefficient_of_friction(tmp_path, kind, element):
    """All points slide, so that the forces have Coulomb's ratio, wherever the pressure is. It dissipates the force
    times the way of the top, less what the shear of the plies takes of it: mu p H/G with G = E/2, 0.005 of 0.1 here.
    """
    mesh = laminate(kind)
    dimension = mesh.nodes.shape[1]
    path = deck(tmp_path / "uncut.inp", mesh, [held(dimension, -0.01), held(dimension, -0.01, 0.1)])
    cut = tmp_path / "cut.inp"
    values = [*law_of(element), f"FRICTION={MU}"]
    inserted(path, cut, values, nodes=["MID"], crack=["CRACK"], contact=True, element=element)
    slid = run(cut)
    pressed = -force(slid, dimension)
    assert pressed > 0
    assert force(slid, 1) == pytest.approx(MU * pressed, rel=1e-6)
    # increments that slide from their start to their end, of 0.025
    for start, end in ((4, 5), (5, 7)):
        way = 0.025 * (end - start)
        dissipated = slid.history["ALLPD"][end] - slid.history["ALLPD"][start]
        # in a mesh without symmetry the shear across the way still settles
        assert dissipated == pytest.approx(MU * pressed * way, rel=5e-4)
        assert slid.history["ETOTAL"][end] == pytest.approx(slid.history["ETOTAL"][start], abs=5e-4 * dissipated)


def peeled(folder, element, counts, contact, across, values=()):
    """Return the load, the least and the largest jump of a laminate that is cracked over half of its length, and whose
    upper ply is moved across at that end.
    """
    folder.mkdir()
    mesh = laminate("CPS4", counts, cracked=1.5)
    ends = [np.flatnonzero(mesh.node_sets["LEFT"] & mesh.node_sets[name])[0] + 1 for name in ("BASE", "TOP")]
    loads = ["RIGHT, 1, 2", f"{ends[0]}, 1, 2", f"{ends[1]}, 1, 1", f"{ends[1]}, 2, 2, {across!r}"]
    path = deck(folder / "uncut.inp", mesh, [loads], POISSON)
    cut = folder / "cut.inp"
    done = inserted(
        path, cut, [*law_of(element), *values], nodes=["MID"], crack=["CRACK"], contact=contact, element=element
    )
    assert (done.elements, done.contact) == (counts[0], counts[0] // 2) if contact else (counts[0] // 2, 0)
    result = run(cut)
    u = result.field("U")[:, 1]
    model = read_deck(cut)
    origins = {tuple(point): k for k, point in enumerate(model.mesh.coordinates[: len(mesh.nodes)].tolist())}
    doubles = range(len(mesh.nodes), len(u))
    jumps = [u[k] - u[origins[tuple(model.mesh.coordinates[k].tolist())]] for k in doubles]
    return force(result, 2), min(jumps), max(jumps)


@pytest.mark.parametrize(("element", "values"), [("U2", ()), ("U4", ("CLOSURE=1",))])
def test_an_open_crack_has_free_faces(tmp_path, element, values):
    free, touching = (
        peeled(tmp_path / str(contact), element, (12, 4), contact, 0.02, values) for contact in (False, True)
    )
    assert free[2] > 0.9 * 0.02
    assert touching == pytest.approx(free, rel=1e-9, abs=1e-12)


def test_the_complete_form_has_free_faces_in_the_limit_of_the_mesh(tmp_path):
    """It also asks for no stress of the solids at the faces, which a mesh gives but for its error."""
    differences = []
    for n in (1, 2, 4):
        free, touching = (
            peeled(tmp_path / f"{n}{contact}", "U4", (6 * n, 2 * n), contact, 0.02) for contact in (False, True)
        )
        differences.append(abs(touching[0] / free[0] - 1.0))
    assert differences[0] < 0.05
    # of the order of the element size
    assert differences[2] < 0.6 * differences[1] < 0.36 * differences[0]


@pytest.mark.parametrize("element", ["U2", "U4"])
def test_a_crack_that_is_bent_shut_does_not_let_its_faces_pass(tmp_path, element):
    """Free ones do, by what the ply is bent. Contact leaves the gap of a stiff interface, which refinement removes."""
    passed = []
    for n in (1, 4):
        free, touching = (
            peeled(tmp_path / f"{n}{contact}", element, (6 * n, 2 * n), contact, -0.02) for contact in (False, True)
        )
        assert free[1] < -0.9 * 0.02
        # the lower ply carries too
        assert touching[0] < 2.0 * free[0] < 0.0
        passed.append(-touching[1])
    assert passed[0] < 0.02 * 0.02
    assert passed[1] < 0.6 * passed[0]


def both(tmp_path, **options):
    """A deck whose interface has a crack up to the middle of its four faces."""
    path = deck(tmp_path / "uncut.inp", laminate("CPS4", (4, 2), cracked=1.5), [held(2, -0.01)])
    return path, inserted(path, tmp_path / "cut.inp", nodes=["MID"], crack=["CRACK"], contact=True, **options)


def test_elements_on_the_crack_have_properties_and_a_set_of_their_own(tmp_path):
    _, done = both(tmp_path, values=[*STRONG, "FRICTION=0.3"])
    assert (done.kinds, done.elements, done.contact, done.crack) == ({"U4": 4}, 4, 2, 2)
    assert done.lines("INTERFACE")[-1] == "4 elements U4 in INTERFACE, 2 of them on an initial crack, 5 nodes doubled"
    model = read_deck(tmp_path / "cut.inp")
    groups = [group for group in model.groups if group.type == "U4"]
    # FRICTION is the twelfth of the reals (fortran/README.md)
    cracked = [item.name for item in element_layouts()[4].integers].index("CRACKED")
    assert [(int(group.section.integers[cracked]), float(group.section.values[11])) for group in groups] == [
        (0, 0.3),
        (1, 0.3),
    ]
    crack = next(group for group in groups if group.section.integers[cracked])
    places = model.mesh.coordinates[crack.nodes[:, [3, 2]]]
    assert (places[..., 1] == 1.0).all() and places[..., 0].max() == pytest.approx(1.5)
    elements = {name: sorted(model.elsets[name].tolist()) for name in ("INTERFACE", "INTERFACE-CRACK")}
    assert len(elements["INTERFACE"]) == 4 and len(elements["INTERFACE-CRACK"]) == 2
    assert set(elements["INTERFACE-CRACK"]) < set(elements["INTERFACE"])


def test_without_contact_a_crack_has_no_elements(tmp_path):
    path = deck(tmp_path / "uncut.inp", laminate("CPS4", (4, 2), cracked=1.5), [held(2, -0.01)])
    done = inserted(path, tmp_path / "cut.inp", STRONG, nodes=["MID"], crack=["CRACK"])
    assert (done.elements, done.crack, done.contact) == (2, 2, 0)
    assert "CRACK\n" not in (tmp_path / "cut.inp").read_text().replace("NSET=CRACK\n", "")


def test_the_command_has_the_option(tmp_path, capsys):
    path = deck(tmp_path / "uncut.inp", laminate("CPS4", (4, 2), cracked=1.5), [held(2, -0.01)])
    words = ["insert", str(path), "--nodes", "MID", "--crack", "CRACK", "--contact", *STRONG]
    assert main([*words, "-o", str(tmp_path / "cut.inp")]) == 0
    assert "2 of them on an initial crack" in capsys.readouterr().out
    assert "INTERFACE-CRACK" in (tmp_path / "cut.inp").read_text()


@pytest.mark.parametrize(
    ("wanted", "values", "message"),
    [
        ({"nodes": ["MID"]}, STRONG, "--contact is between the faces of a crack: say where it is, by --crack SET"),
        (
            {"nodes": ["MID"], "crack": ["CRACK"], "element": "COH2D4"},
            [*STRONG, "ALPHAN=1e6"],
            "--contact: COH2D4 cannot fail from the start, the elements of the project can",
        ),
        (
            {"nodes": ["MID"], "crack": ["CRACK"], "element": "U2"},
            [*STRONG, "ALPHAN=1e6", "FRICTION=0.3"],
            "U2 has no property FRICTION",
        ),
        ({"nodes": ["MID"], "crack": ["MID"]}, (), "U4 needs SIGMAMAX=VALUE"),
        (
            {"nodes": ["MID"], "crack": ["CRACK"], "elset": "OLD"},
            STRONG,
            "--elset OLD: the deck has an element set OLD-CRACK",
        ),
    ],
)
def test_errors(tmp_path, wanted, values, message):
    mesh = laminate("CPS4", (4, 2), cracked=1.5)
    mesh.sets["OLD-CRACK"] = mesh.sets["LOW"]
    path = deck(tmp_path / "uncut.inp", mesh, [held(2, -0.01)])
    with pytest.raises(UsageError, match=message):
        inserted(path, tmp_path / "cut.inp", values, contact=True, **wanted)
    assert not (tmp_path / "cut.inp").exists()
