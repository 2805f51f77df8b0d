# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Generalised plane strain: fibres between two rigid planes, against plane strain, plane stress, solids and theory."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cells import affine, patch_of
from small_decks import body_lines

from uel.elements import REFERENCE, Flags, build_blocks
from uel.errors import DeckError
from uel.model.element_types import GENERALISED, PLANES
from uel.model.mesh import Mesh
from uel.model.model import Model

YOUNG, NU, LENGTH = 1000.0, 0.3, 2.0
ELASTIC = f"*ELASTIC\n{YOUNG}, {NU}"
STRAIGHT = [name for name, kind in GENERALISED.items() if kind.nodes == kind.corners]
SHORT = ("CPEG3", "CPEG4", "CPEG4H", "CPEG4R", "CPEG8")
ALL = [name if name in SHORT else pytest.param(name, marks=pytest.mark.long) for name in GENERALISED]


def deck(element_type, mesh, boundary, *, reference=(0.3, -0.2), nlgeom="", static="*STATIC\n1., 1.", material=ELASTIC):
    """A step of a body whose reference node has the largest number, in the set REF; the length of its fibre is 2."""
    nodes, elements = mesh
    lines = body_lines(element_type, nodes, elements)
    section = "*SOLID SECTION, ELSET=BODY, MATERIAL=M"
    if element_type in GENERALISED:
        lines.insert(len(nodes) + 1, ", ".join(map(repr, [len(nodes) + 1, *map(float, reference)])))
        lines.insert(len(nodes) + 2, f"*NSET, NSET=REF\n{len(nodes) + 1}")
        section += ", REF NODE=REF"
    lines += [f"{section}\n{LENGTH}", f"*MATERIAL, NAME=M\n{material}", f"*STEP, INC=1000{nlgeom}", static]
    lines += [f"*BOUNDARY\n{boundary}", "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF"]
    lines += ["*NODE OUTPUT, NSET=REF\nU, RF"] if element_type in GENERALISED else []
    lines += ["*OUTPUT, FIELD"]
    return "\n".join([*lines, "*ELEMENT OUTPUT\nS, E\n*END STEP", ""])


def moved(nodes, u, first=1):
    """Data lines that move nodes by (nodes, directions)."""
    return "\n".join(
        f"{k}, {dof}, {dof}, {float(x)!r}" for k, row in zip(nodes, u, strict=True) for dof, x in enumerate(row, first)
    )


def last(result, name, count, dofs=(1, 2)):
    return np.array([[result.history[f"{name}{dof}[ALL:{k}]"][-1] for dof in dofs] for k in range(1, count + 1)])


def of_reference(result, name):
    """Of dofs 3, 4 and 5 of the reference node, U or RF."""
    turned = {"U": ("U3", "UR1", "UR2"), "RF": ("RF3", "RM1", "RM2")}[name]
    return np.array([result.history[f"{component}[REF]"][-1] for component in turned])


def grid(n, m, width, height, corner=(0.0, 0.0)):
    """Nodes and elements of a rectangle of n x m quadrilaterals."""
    x, y = np.meshgrid(np.linspace(0, width, n + 1), np.linspace(0, height, m + 1), indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel()]) + corner
    first = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).reshape(-1, 1)
    return nodes, first + np.array([0, m + 1, m + 2, 1])


@pytest.fixture
def element(solid_group, load, call):
    """An element, its unknowns behind each other: force and tangent by U and DU."""

    def element(element_type, *, nlgeom):
        kind = GENERALISED[element_type]
        nodes, _ = affine(kind.family.cell)
        count = len(nodes)
        group = solid_group(element_type, np.arange(count)[None], LENGTH)
        group = replace(group, section=replace(group.section, reference=count))
        places = np.pad(np.vstack([nodes, [2.7, 3.4]]), ((0, 0), (0, 1)))
        mesh = Mesh(np.arange(count + 1) + 1, places, ("",) * (count + 1))
        (block,) = build_blocks(Model(Path("test.inp"), "", mesh, (group,), ()), load(None))
        assert block.unknowns[2 * count :] == tuple((REFERENCE, dof) for dof in PLANES)
        n = len(block.unknowns)
        block.bind(np.arange(n, dtype=np.int32)[None], np.arange(n * n, dtype=np.int32).reshape(1, n, n))
        now = replace(call, flags=Flags(1, nlgeom))

        def evaluate(u, du):
            residual, matrix = np.zeros(n), np.zeros(n * n)
            block.evaluate(now, u, du, residual, matrix)
            return -residual, matrix.reshape(n, n)

        return evaluate, block, nodes

    return element


@pytest.mark.parametrize("element_type", GENERALISED)
def test_small_displacements_are_linear(element, element_type):
    evaluate, _, nodes = element(element_type, nlgeom=False)
    u = 1e-2 * np.random.default_rng(1).standard_normal(nodes.size + 3)
    force, matrix = evaluate(u, u)
    np.testing.assert_allclose(force, matrix @ u, atol=1e-12 * abs(force).max())
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * abs(matrix).max())
    # rigid in the plane
    for moves in (nodes * 0 + [1.0, 0.0], nodes * 0 + [0.0, 1.0], nodes[:, ::-1] * [-1.0, 1.0]):
        np.testing.assert_allclose(matrix @ [*moves.ravel(), 0, 0, 0], 0.0, atol=1e-11 * abs(matrix).max())


@pytest.mark.parametrize("element_type", STRAIGHT)
def test_tangent_of_large_displacements(element, element_type):
    """From a uniform state, with planes that have turned, along uniform changes: the differences of the forces are
    those of the tangent and what it leaves out, the forces times the change of the volume."""
    evaluate, block, nodes = element(element_type, nlgeom=True)
    random = np.random.default_rng(2)
    start = np.concatenate([(nodes @ (0.1 * random.standard_normal((2, 2)))).ravel(), [0.2, 0.1, -0.15]])
    evaluate(start, start)
    block.commit()
    forces, tangent = evaluate(start, 0 * start)
    now, step = nodes + start[:-3].reshape(-1, 2), 1e-6
    middle = now.mean(axis=0) - [2.7, 3.4]
    length = LENGTH + start[-3] + start[-2] * middle[1] - start[-1] * middle[0]
    for k in range(7):
        a, w = np.eye(7)[k, :4].reshape(2, 2), np.eye(7)[k, 4:]
        d = np.concatenate([((now - now.mean(axis=0) + middle) @ a.T).ravel(), w])
        moves = a @ middle
        longer = w[0] + w[1] * middle[1] - w[2] * middle[0] + start[-2] * moves[1] - start[-1] * moves[0]
        up, down = (evaluate(start + s * step * d, s * step * d)[0] for s in (1, -1))
        found = tangent @ d + forces * (np.trace(a) + longer / length)
        np.testing.assert_allclose((up - down) / (2 * step), found, atol=1e-6 * abs(tangent).max())


@pytest.mark.parametrize("element_type", ALL)
@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
def test_held_planes_are_plane_strain(run_deck, element_type, nlgeom):
    kind = GENERALISED[element_type]
    nodes, elements = patch_of(kind.family.cell)
    u = 0.02 * np.random.default_rng(3).standard_normal(nodes.shape)
    boundary = moved(range(1, len(nodes) + 1), u)
    static = "*STATIC\n0.25, 1., 0.25, 0.25"
    held = run_deck(deck(element_type, (nodes, elements), f"{boundary}\nREF, 3, 5", nlgeom=nlgeom, static=static))
    found = last(held, "RF", len(nodes))
    # what holds the planes: the stress out of the plane
    assert abs(held.history["RF3[REF]"][-1]) > 1.0
    plane = run_deck(
        deck(element_type.replace("CPEG", "CPE"), (nodes, elements), boundary, nlgeom=nlgeom, static=static)
    )
    expected = last(plane, "RF", len(nodes))
    np.testing.assert_allclose(found, expected, atol=1e-10 * abs(expected).max())


@pytest.mark.parametrize("element_type", ALL)
def test_free_planes_are_plane_stress(run_deck, element_type):
    """Patch test: the fibres of a uniform strain are free, and move the planes in parallel."""
    kind = GENERALISED[element_type]
    nodes, elements = patch_of(kind.family.cell)
    gradient = np.array([[1e-3, 4e-4], [-2e-4, 5e-4]])
    outside = np.flatnonzero(((abs(nodes) < 1e-9) | (abs(nodes - 1) < 1e-9)).any(axis=1))
    result = run_deck(deck(element_type, (nodes, elements), moved(outside + 1, nodes[outside] @ gradient.T)))
    e1, e2, shear = gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]
    modulus = YOUNG / (1 - NU**2)
    expected = modulus * (e1 + NU * e2), modulus * (e2 + NU * e1), 0.0, YOUNG / (2 * (1 + NU)) * shear
    for name, value in zip(("S11", "S22", "S33", "S12"), expected, strict=True):
        np.testing.assert_allclose(result.field(name), value, atol=1e-9, err_msg=name)
    np.testing.assert_allclose(last(result, "U", len(nodes)), nodes @ gradient.T, atol=1e-12)
    longer = -NU / (1 - NU) * (e1 + e2) * LENGTH
    np.testing.assert_allclose(of_reference(result, "U"), [longer, 0, 0], atol=1e-12)


def test_turned_planes_bend(run_deck):
    """Uniaxial stress along fibres, E (w1 + w2 (y - Y0) - w3 (x - X0))/t: its resultants hold the reference node. The
    section has the quadratic displacements of a bent beam, which CPEG8 has too."""
    elements = np.arange(8)[None]
    nodes = np.array([[0, 0], [2, 0], [2, 1], [0, 1], [1, 0], [2, 0.5], [1, 1], [0, 0.5]], dtype=float)
    origin, w = np.array([0.3, -0.2]), np.array([0.01, 0.02, -0.03])
    result = run_deck(deck("CPEG8", (nodes, elements), f"{moved(['REF'], [w], 3)}\n1, 1, 2\n2, 2, 2"))
    # first and second moments of the area about the reference node
    area, middle = 2.0, np.array([1.0, 0.5]) - origin
    xx, yy, xy = area * (4 / 12 + middle[0] ** 2), area * (1 / 12 + middle[1] ** 2), area * middle.prod()
    x, y = area * middle
    resultants = np.array([[area, y, -x], [y, yy, -xy], [-x, -xy, xx]]) @ w * YOUNG / LENGTH
    np.testing.assert_allclose(of_reference(result, "RF"), resultants, rtol=1e-9)
    for name in ("S11", "S22", "S12"):
        np.testing.assert_allclose(result.field(name), 0.0, atol=1e-9)


@pytest.mark.parametrize(("element_type", "stress"), [("CPEG4", 1.131e5), ("CPEG4R", 1.125e5)])
def test_verification_guide(run_deck, element_type, stress):
    """Generalized plane strain elements with relative motion of bounding planes (Abaqus Verification Guide 1.3.2): a
    rotation of 0.01 about y of a square of side 1, whose mesh is inferred from the strain; figures as they are printed.
    It shows that the fibres of an element have one strain."""
    nodes, elements = grid(4, 4, 1.0, 1.0, (-0.5, -0.5))
    boundary = "REF, 3, 4\nREF, 5, 5, 0.01\n13, 1, 2\n14, 1, 1"
    text = deck(element_type, (nodes, elements), boundary, reference=(0.0, 0.0), material="*ELASTIC\n3e7, 0.3")
    result = run_deck(text.replace(f"REF NODE=REF\n{LENGTH}", "REF NODE=REF\n1."))
    assert result.field("E33").max() == pytest.approx(3.750e-3, abs=0.5e-6)
    assert result.field("S33").max() == pytest.approx(stress, abs=0.5e2)


def test_slice_of_wedges(run_deck):
    """CPEG3 as C3D6 between its planes, in large displacements: the same strains."""
    nodes, elements = patch_of("triangle")
    count, random = len(nodes), np.random.default_rng(4)
    u, longer = 0.1 * random.standard_normal(nodes.shape), 0.3
    static = "*STATIC\n0.25, 1., 0.25, 0.25"
    boundary = f"{moved(range(1, count + 1), u)}\nREF, 3, 3, {longer}\nREF, 4, 5"
    plane = run_deck(deck("CPEG3", (nodes, elements), boundary, nlgeom=", NLGEOM", static=static))
    found, (along, *_) = last(plane, "RF", count), of_reference(plane, "RF")
    solid = np.vstack([np.column_stack([nodes, np.full(count, z)]) for z in (0.0, LENGTH)])
    moves = np.vstack([np.column_stack([u, np.full(count, w)]) for w in (0.0, longer)])
    wedges = np.hstack([elements, elements + count])
    boundary = moved(range(1, 2 * count + 1), moves)
    space = run_deck(deck("C3D6", (solid, wedges), boundary, nlgeom=", NLGEOM", static=static))
    forces = last(space, "RF", 2 * count, (1, 2, 3))
    np.testing.assert_allclose(found, forces[:count, :2] + forces[count:, :2], atol=1e-9 * abs(found).max())
    assert along == pytest.approx(forces[count:, 2].sum(), rel=1e-9)


@pytest.mark.parametrize("element_type", ["CPEG3", "CPEG4", "CPEG4H", "CPEG6", "CPEG8", "CPEG8RH"])
def test_another_reference_node(run_deck, element_type):
    """The same planes by a node elsewhere, in large displacements: same forces in the plane, moments about the other
    node."""
    nodes, elements = patch_of(GENERALISED[element_type].family.cell)
    u, w = 0.03 * np.random.default_rng(5).standard_normal(nodes.shape), np.array([0.1, 0.05, -0.08])
    shift = np.array([1.5, -0.7])
    results = []
    for origin in (np.zeros(2), shift):
        planes = [w[0] + w[1] * origin[1] - w[2] * origin[0], *w[1:]]
        boundary = f"{moved(range(1, len(nodes) + 1), u)}\n{moved(['REF'], [planes], 3)}"
        static = "*STATIC\n0.25, 1., 0.25, 0.25"
        text = deck(element_type, (nodes, elements), boundary, reference=origin, nlgeom=", NLGEOM", static=static)
        result = run_deck(text)
        results.append((last(result, "RF", len(nodes)), of_reference(result, "RF")))
    (forces, (force, *moments)), (others, (same, *turned)) = results
    np.testing.assert_allclose(others, forces, atol=1e-10 * abs(forces).max())
    assert same == pytest.approx(force, rel=1e-10)
    expected = moments[0] - force * shift[1], moments[1] + force * shift[0]
    np.testing.assert_allclose(turned, expected, atol=1e-10 * abs(force))


@pytest.mark.parametrize("element_type", ["CPEG4", "CPEG8R"])
def test_stretched_fibres(run_deck, element_type):
    """E ln(t/t0) on the section that has become thinner by ln(t/t0) nu in both directions; equilibrium is found in few
    iterations."""
    nodes, elements = patch_of(GENERALISED[element_type].family.cell)
    boundary = f"1, 1, 2\n2, 2, 2\nREF, 3, 3, {0.5 * LENGTH}\nREF, 4, 5"
    text = deck(element_type, (nodes, elements), boundary, nlgeom=", NLGEOM", static="*STATIC\n0.01, 1., 0.01, 0.01")
    result = run_deck(text)
    stretch = np.log(1.5)
    expected = YOUNG * stretch * np.exp(-2 * NU * stretch)
    # strains of 100 increments, each at the middle of its own
    assert result.history["RF3[REF]"][-1] == pytest.approx(expected, rel=1e-5)
    assert sum(line.total_iterations for line in result.status) <= 200


def body(element_type="CPEG4", section=", REF NODE=5", length="1.", material=ELASTIC, step="*STATIC\n1., 1."):
    return (
        "*NODE, NSET=ALL\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., 0.\n"
        f"*ELEMENT, TYPE={element_type}, ELSET=BODY\n1, 1, 2, 3, 4\n"
        f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{section}\n{length}\n*MATERIAL, NAME=M\n{material}\n"
        f"*STEP, NLGEOM\n{step}\n*BOUNDARY\n1, 1, 2\n*END STEP\n"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (body(section=""), r"deck.inp:9: \*SOLID SECTION: elements of type CPEG4 need REF NODE"),
        (body("CPE4"), r"REF NODE goes with elements in generalised plane strain \(CPEG3, .*BODY holds CPE4"),
        (body(section=", REF NODE=ALL"), r"\*SOLID SECTION: REF NODE=ALL has 5 nodes, expected one"),
        (body(section=", REF NODE=6"), r"node 6 is not defined"),
        (body(length="1., 0., 0.1"), r"deck.inp:10: .*an initial rotation of the bounding planes about y is not sup"),
        (
            body(material="*HYPERELASTIC, NEO HOOKE\n1., 0.1"),
            r"deck.inp:12: \*HYPERELASTIC is not supported for elements of type CPEG4",
        ),
        (
            body("CPEG4H", material="*ELASTIC\n1., 0.5"),
            r"\*ELASTIC with nu = 0.5 is not supported for elements of type CPEG4H",
        ),
        (
            body(material=f"{ELASTIC}\n*DENSITY\n1.", step="*DYNAMIC\n0.1, 1."),
            r"\*DYNAMIC is not supported for elements of type CPEG4: it needs a mass",
        ),
    ],
)
def test_what_is_refused(run_deck, text, message):
    with pytest.raises(DeckError, match=message):
        run_deck(text)
