# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Distributed loads on built-in elements: their resultants and moments over faces and volumes."""

import numpy as np
import pytest
from reference_cells import FACES, affine, area_vector, face_of, integral, patch_of, shape_of, share_of_nodes

import uel
from uel.errors import DeckError, UelError
from uel.model.element_types import CONTINUUM

THICKNESS, DENSITY = 0.5, 3.0
TYPES = {
    # nodes of one element of edges 2, 1 (and 3), corners first; faces by the load type: outward normal and area
    "CPE4": 4,
    "CPS8R": 8,
    "C3D8": 8,
    "C3D20R": 20,
}
CORNERS = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 0, 3], [2, 0, 3], [2, 1, 3], [0, 1, 3.0]])
EDGES = [*((0, 1), (1, 2), (2, 3), (3, 0)), *((4, 5), (5, 6), (6, 7), (7, 4)), *((0, 4), (1, 5), (2, 6), (3, 7))]
PLANE_FACES = {1: ((0, -1), 2.0), 2: ((1, 0), 1.0), 3: ((0, 1), 2.0), 4: ((-1, 0), 1.0)}
SPACE_FACES = {
    **{1: ((0, 0, -1), 2.0), 2: ((0, 0, 1), 2.0), 3: ((0, -1, 0), 6.0)},
    **{4: ((1, 0, 0), 3.0), 5: ((0, 1, 0), 6.0), 6: ((-1, 0, 0), 3.0)},
}

DLOAD = """      SUBROUTINE DLOAD(F,KSTEP,KINC,TIME,NOEL,NPT,LAYER,KSPT,
     1     COORDS,JLTYP,SNAME)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 SNAME
      DIMENSION TIME(2),COORDS(3)
%s
      END
"""


def nodes_of(element_type):
    dimension = 3 if element_type.startswith("C3D") else 2
    corners = CORNERS[: 2**dimension, :dimension]
    middles = [corners[list(edge)].mean(axis=0) for edge in EDGES if max(edge) < len(corners)]
    return np.vstack([corners, *middles])[: TYPES[element_type]]


def deck(element_type, load, *, step="", options=""):
    nodes = nodes_of(element_type)
    lines = ["*NODE, NSET=ALL"]
    lines += [", ".join([str(k), *map(repr, x.tolist())]) for k, x in enumerate(nodes, start=1)]
    numbers = [str(k) for k in range(1, len(nodes) + 1)]
    lines += [f"*ELEMENT, TYPE={element_type}, ELSET=BODY", ", ".join(["1", *numbers[:10]]) + "," * (len(nodes) > 10)]
    lines += [", ".join(numbers[10:])] if len(nodes) > 10 else []
    lines += ["*SURFACE, NAME=SIDE", "BODY, S2", "*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.3", "*DENSITY", f"{DENSITY}"]
    lines += [f"*STEP{options}", "*STATIC", "1., 1.", "*BOUNDARY", "ALL, 1, 3", load]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "RF", "*END STEP", step, ""]
    return "\n".join(line for line in lines if line) + "\n"


@pytest.fixture
def forces(tmp_path):
    def forces(element_type, load, *, user=None, **options):
        """Forces (nodes, dimension) of the load at the end: all displacements are held."""
        (tmp_path / "load.inp").write_text(deck(element_type, load, **options))
        if user is not None:
            (tmp_path / "dload.f").write_text(DLOAD.replace("%s", user))
        routines = tmp_path / "dload.f" if user is not None else None
        history = uel.run(tmp_path / "load.inp", routines, output_dir=tmp_path).history
        nodes = nodes_of(element_type)
        dofs, labels = range(1, nodes.shape[1] + 1), range(1, len(nodes) + 1)
        return -np.array([[history[f"RF{dof}[ALL:{label}]"][-1] for dof in dofs] for label in labels])

    return forces


def check(element_type, found, traction, volume_or_area, centre):
    """The forces have the resultant of a constant load, and its moments about all axes."""
    nodes = nodes_of(element_type)
    np.testing.assert_allclose(found.sum(axis=0), traction * volume_or_area, atol=1e-12)
    np.testing.assert_allclose(nodes.T @ found, np.outer(centre, traction) * volume_or_area, atol=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_pressure_on_every_face(forces, element_type):
    faces = SPACE_FACES if element_type.startswith("C3D") else PLANE_FACES
    middle = nodes_of(element_type)[: 2 ** len(faces[1][0])].mean(axis=0)
    for face, (outward, area) in faces.items():
        normal = np.array(outward, dtype=float)
        half = np.array([1.0, 0.5, 1.5])[: len(normal)]
        scale = area * (THICKNESS if len(normal) == 2 else 1.0)
        check(
            element_type,
            forces(element_type, f"*DLOAD\nBODY, P{face}, 4."),
            -4.0 * normal,
            scale,
            middle + normal * half,
        )


@pytest.mark.parametrize("element_type", TYPES)
def test_loads_of_the_volume(forces, element_type):
    nodes = nodes_of(element_type)
    dimension = nodes.shape[1]
    volume, middle = (2 * THICKNESS if dimension == 2 else 6.0), nodes[: 2**dimension].mean(axis=0)
    down = np.eye(dimension)[1] * -9.8
    check(element_type, forces(element_type, "*DLOAD\nBODY, GRAV, 9.8, 0., -2."), DENSITY * down, volume, middle)
    check(element_type, forces(element_type, "*DLOAD\nBODY, BX, 7."), np.eye(dimension)[0] * 7, volume, middle)


PLAIN = [name for name, kind in CONTINUUM.items() if not kind.axisymmetric]


def copies(element_type, loads, options=""):
    """Deck of separate copies of an element in one place, one for each load; all displacements are held."""
    kind = CONTINUUM[element_type]
    nodes, _ = affine(kind.family.cell)
    lines, elements, surfaces = ["*NODE, NSET=ALL"], [f"*ELEMENT, TYPE={element_type}, ELSET=BODY"], []
    for copy in range(len(loads)):
        first = copy * kind.nodes + 1
        lines += [", ".join([str(first + k), *map(repr, x)]) for k, x in enumerate(nodes.tolist())]
        numbers = [str(copy + 1), *(str(first + k) for k in range(kind.nodes))]
        elements += [", ".join(numbers[:12]) + "," * (len(numbers) > 12), ", ".join(numbers[12:])]
        surfaces += [f"*SURFACE, NAME=FACE{copy + 1}", f"{copy + 1}, S{copy + 1}"]
    lines += [line for line in elements if line] + surfaces * any("DSLOAD" in load for load in loads)
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}", "*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.3"]
    lines += ["*DENSITY", f"{DENSITY}", f"*STEP{options}", "*STATIC", "*BOUNDARY", "ALL, 1, 3", *loads]
    lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "RF", "*END STEP", ""]
    return "\n".join(lines)


def forces_of_copies(folder, element_type, loads, options=""):
    """Forces (copies, nodes, dimension) of the loads at the end."""
    (folder / "copies.inp").write_text(copies(element_type, loads, options))
    history = uel.run(folder / "copies.inp", output_dir=folder).history
    kind = CONTINUUM[element_type]
    names = [[f"RF{d}[ALL:{k}]" for d in range(1, kind.dimension + 1)] for k in range(1, len(loads) * kind.nodes + 1)]
    found = -np.array([[history[name][-1] for name in of_node] for of_node in names])
    return found.reshape(len(loads), kind.nodes, kind.dimension)


@pytest.mark.parametrize(
    ("element_type", "options"),
    [(name, options) for options in ("", ", NLGEOM") for name in PLAIN if not (options and CONTINUUM[name].modes)],
)
@pytest.mark.parametrize("keyword", ["DLOAD", "DSLOAD"])
def test_consistent_forces_of_a_pressure(tmp_path, element_type, keyword, options):
    """On each face of Abaqus, - p times its area in the direction out of the element, in the shares of its nodes."""
    cell = CONTINUUM[element_type].family.cell
    nodes, _ = affine(cell)
    count = len(FACES[shape_of(cell)])
    loads = [
        f"*DLOAD\n{k}, P{k}, 4." if keyword == "DLOAD" else f"*DSLOAD\nFACE{k}, P, 4." for k in range(1, count + 1)
    ]
    found = forces_of_copies(tmp_path, element_type, loads, options)
    for number in range(count):
        face, shares = face_of(cell, number)
        corners = nodes[list(FACES[shape_of(cell)][number])]
        area = area_vector(corners) * (THICKNESS if len(corners) == 2 else 1.0)
        area *= np.sign(area @ (corners.mean(axis=0) - nodes.mean(axis=0)))
        expected = np.zeros_like(nodes)
        expected[face] = -4.0 * np.outer(shares, area)
        np.testing.assert_allclose(found[number], expected, atol=1e-12)


@pytest.mark.parametrize("element_type", PLAIN)
def test_consistent_forces_of_loads_of_the_volume(tmp_path, element_type):
    kind = CONTINUUM[element_type]
    cell, d = kind.family.cell, kind.dimension
    volume = affine(cell)[1] * integral(cell, (0,) * d) * (THICKNESS if d == 2 else 1.0)
    found = forces_of_copies(tmp_path, element_type, ["*DLOAD\n1, GRAV, 9.8, 0., -2.", "*DLOAD\n2, BX, 7."])
    for forces, force in zip(found, (-9.8 * DENSITY * np.eye(d)[1], 7.0 * np.eye(d)[0]), strict=True):
        np.testing.assert_allclose(forces, volume * np.outer(share_of_nodes(cell), force), atol=1e-12)


@pytest.mark.parametrize("element_type", PLAIN)
def test_body_pulled_at_one_side(run_deck, element_type):
    """A unit square or cube of distorted elements under a traction of 4 on x = 1: stress 4 everywhere, u = 4 x/E."""
    kind = CONTINUUM[element_type]
    cell, d = kind.family.cell, kind.dimension
    nodes, elements = patch_of(cell)
    corners = FACES[shape_of(cell)]
    loaded = [
        (e, f)
        for e, row in enumerate(elements)
        for f, face in enumerate(corners)
        if (nodes[row[list(face)], 0] == 1).all()
    ]
    lines = ["*NODE, NSET=ALL", *(", ".join([str(k), *map(repr, x)]) for k, x in enumerate(nodes.tolist(), start=1))]
    lines += [f"*ELEMENT, TYPE={element_type}, ELSET=BODY"]
    for k, row in enumerate((elements + 1).tolist(), start=1):
        lines += [f"{k}, " + ", ".join(map(str, row[:9])) + "," * (len(row) > 9), ", ".join(map(str, row[9:]))]
    lines += ["*SURFACE, NAME=SIDE", *(f"{e + 1}, S{f + 1}" for e, f in loaded)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}", "*MATERIAL, NAME=M", "*ELASTIC", "1000., 0."]
    lines += ["*STEP", "*STATIC", "*BOUNDARY"]
    lines += [f"{k}, {axis + 1}" for axis in range(d) for k in np.flatnonzero(nodes[:, axis] == 0) + 1]
    lines += [
        "*DSLOAD",
        "SIDE, TRVEC, 4., 1.",
        "*OUTPUT, HISTORY",
        "*NODE OUTPUT, NSET=ALL",
        "U",
        "*OUTPUT, FIELD",
        "*ELEMENT OUTPUT",
        "S",
    ]
    result = run_deck(line for line in [*lines, "*END STEP"] if line)
    found = [[result.history[f"U{axis + 1}[ALL:{k + 1}]"][-1] for axis in range(d)] for k in range(len(nodes))]
    np.testing.assert_allclose(found, np.outer(nodes[:, 0] * 4e-3, np.eye(d)[0]), atol=1e-14)
    np.testing.assert_allclose(result.field("S11"), 4.0, rtol=1e-11)


TRIANGLE = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 1., 0.
5, 2., 0.5
6, 1., 0.5
*ELEMENT, TYPE=CPE6, ELSET=BODY
1, 1, 2, 3, 4, 5, 6
*SOLID SECTION, ELSET=BODY, MATERIAL=M
0.5
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*STEP
*STATIC
*BOUNDARY
ALL, 1, 2
*DLOAD
BODY, {load}
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
RF
*END STEP
"""


@pytest.mark.parametrize(("load", "force"), [("P2, 6.", [0, -0.5, -0.5, 0, -2, 0]), ("BX, 6.", [0, 0, 0, 1, 1, 1])])
def test_loads_of_a_quadratic_triangle(run_deck, load, force):
    """Of a side 1/6, 1/6 and 2/3 go to its ends and middle; of the area a third to the middle of each side."""
    history = run_deck(TRIANGLE.format(load=load)).history
    found = [-history[f"RF1[ALL:{label}]"][-1] for label in range(1, 7)]
    # the nodes' order in the side of P2 is 2, 3, middle 5
    assert found == pytest.approx(force, abs=1e-12)


def test_tractions_of_a_surface(forces):
    """S2 is the side x = 2: a vector as it is, a shear traction its part in the surface at full size."""
    side, area = np.array([2.0, 0.5]), THICKNESS
    check("CPE4", forces("CPE4", "*DSLOAD\nSIDE, TRVEC, 5., 3., 4."), np.array([3.0, 4.0]), area, side)
    check("CPE4", forces("CPE4", "*DSLOAD\nSIDE, TRSHR, 5., 3., -4."), np.array([0.0, -5.0]), area, side)
    check("CPE4", forces("CPE4", "*DSLOAD\nSIDE, P, 5."), np.array([-5.0, 0.0]), area, side)


def test_dead_tractions_with_large_displacements(forces):
    load = "*DSLOAD, FOLLOWER=NO\nSIDE, TRVEC, 5., 1."
    check("C3D8", forces("C3D8", load, options=", NLGEOM"), np.array([5.0, 0, 0]), 2.0, np.array([1.0, 0.5, 3.0]))


def test_distributed_loads_go_on_until_they_are_replaced(forces):
    """A second step replaces the pressure of *DLOAD by half of it, and drops the surface loads."""
    step = "*STEP\n*STATIC\n1., 1.\n*DLOAD\nBODY, P2, 2.\n*DSLOAD, OP=NEW\n*END STEP"
    load = "*DLOAD\nBODY, P2, 4.\n*DSLOAD\nSIDE, TRVEC, 9., 0., 1."
    check("CPE4", forces("CPE4", load, step=step), np.array([-2.0, 0.0]), THICKNESS, np.array([2.0, 0.5]))


def test_amplitude(forces):
    load = "*AMPLITUDE, NAME=A\n0., 0., 1., 0.25\n*DLOAD, AMPLITUDE=A\nBODY, P2, 4."
    check("CPE4", forces("CPE4", load), np.array([-1.0, 0.0]), THICKNESS, np.array([2.0, 0.5]))


@pytest.mark.parametrize("element_type", TYPES)
def test_pressure_of_dload_over_a_face(forces, element_type):
    """F = 2 y on the side x = 2: resultant of the pressure -2 y over 0 < y < 1, and its moment, exactly."""
    height = 3.0 if element_type.startswith("C3D") else THICKNESS
    face = 4 if element_type.startswith("C3D") else 2
    found = forces(element_type, f"*DLOAD\nBODY, P{face}NU", user="      F = 2*COORDS(2)")
    nodes = nodes_of(element_type)
    np.testing.assert_allclose(found.sum(axis=0)[:2], [-height, 0.0], atol=1e-12)
    np.testing.assert_allclose(nodes[:, 1] @ found[:, 0], -2 / 3 * height, rtol=1e-12)
    assert found[nodes[:, 0] < 2] == pytest.approx(0.0, abs=1e-12)


def test_body_force_of_dload(forces):
    """F = x in direction 2 over 0 < x < 2, added to the magnitude of the deck, 4."""
    found = forces("CPE4", "*DLOAD\nBODY, BYNU, 4.", user="      F = F + COORDS(1)")
    np.testing.assert_allclose(found.sum(axis=0), [0.0, (4 * 2 + 2) * THICKNESS], atol=1e-12)


def test_arguments_of_dload(forces):
    """Element 1, points 1 and 2 of a face, JLTYP 22, step 2, increment 1, at its end; removed by OP=NEW in step 3."""
    step = "*STEP\n*STATIC\n1., 1.\n*END STEP\n"
    user = (
        "      F = 0\n      IF (NOEL.EQ.1 .AND. JLTYP.EQ.22) F = NPT + 10*KINC\n"
        "     1  + 100*KSTEP + 1000*TIME(1) + 10000*TIME(2)"
    )
    found = forces("CPE4", "*DLOAD\nBODY, P2NU", user=user, step=step)
    mean = 1.5 + 10 + 200 + 1000 + 20000
    np.testing.assert_allclose(found.sum(axis=0), [-mean * THICKNESS, 0.0], rtol=1e-12, atol=1e-9)
    gone = forces("CPE4", "*DLOAD\nBODY, P2NU", user=user, step=step.replace("1., 1.\n", "1., 1.\n*DLOAD, OP=NEW\n"))
    assert gone == pytest.approx(0.0)


def test_dload_may_end_the_analysis(forces):
    with pytest.raises(UelError, match=r"DLOAD stopped the analysis.* \(element 1, step 1\)"):
        forces("CPE4", "*DLOAD\nBODY, P2NU", user="      CALL XIT")


@pytest.mark.parametrize(
    ("load", "options", "message"),
    [
        ("*DLOAD\nBODY, HP, 1.", "", r"load.inp:\d+: \*DLOAD: load type HP is not supported \(supported: Un and UnNU"),
        ("*DLOAD\nBODY, P2NU", "", r"load.inp:\d+: \*DLOAD: nonuniform loads need DLOAD, which the job does not have"),
        ("*DLOAD\nBODY, CENTRIF, 1., 0., 0., 0., 1.", "", "load type CENTRIF is not supported"),
        ("*DLOAD\nBODY, GRAVNU, 1.", "", "load type GRAVNU is not supported"),
        ("*DLOAD\nBODY, P5, 1.", "", r"load.inp:\d+: \*DLOAD: elements of type CPE4 have no face S5"),
        ("*DLOAD\nBODY, GRAV, 1.", "", r"\*DLOAD: GRAV needs a direction, entries 4 to 6"),
        ("*DLOAD\nBODY, U1, 1.", "", r"load type U1 on elements that are not user elements \(1\)"),
        ("*DLOAD\nBODY, P1, 1., 2.", "", "4 entries, expected at most 3"),
        ("*DSLOAD\nSIDE, HP, 1.", "", r"\*DSLOAD: load type HP is not supported \(supported: P, TRVEC, TRSHR, EDLD"),
        ("*DSLOAD\nSIDES, P, 1.", "", "unknown surface SIDES"),
        ("*DSLOAD\nSIDE, TRSHR, 1., 1.", "", r"load.inp:\d+: TRSHR: the direction is normal to the surface"),
        ("*DSLOAD, CONSTANT RESULTANT=YES\nSIDE, P, 1.", "", "option CONSTANT RESULTANT is not supported"),
    ],
)
def test_what_is_wrong_is_named(forces, monkeypatch, tmp_path, load, options, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DeckError, match=message):
        forces("CPE4", load, options=options)
