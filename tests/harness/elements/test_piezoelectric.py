# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Piezoelectric elements: patches against the constitutive law in numpy, bars in closed form, resonances, energies.

S = C e - b^T E, D = b e + d E with E = -grad(potential) (Abaqus Theory Guide, Piezoelectric analysis); with TYPE=E the
strain of a free body is that of its columns times E (J.F. Nye, Physical Properties of Crystals, chapter 7).
"""

import numpy as np
import pytest
from reference_cells import patch_of
from small_decks import body_lines

from uel.errors import DeckError
from uel.model.element_types import PIEZOELECTRIC, Tensor

PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
YOUNG, POISSON = (60.0, 50.0, 80.0), (0.3, 0.25, 0.2)
SHEAR = (20.0, 22.0, 25.0)
TURN = 0.4
AXES = np.array([[np.cos(TURN), np.sin(TURN), 0], [-np.sin(TURN), np.cos(TURN), 0], [0, 0, 1]])
RANDOM = np.random.default_rng(5)
STRESSES = RANDOM.normal(size=(3, 6))
PERMITTIVITY = np.array([[2.0, 0.3, 0.1], [0.3, 3.0, -0.2], [0.1, -0.2, 2.5]])
TYPES = list(PIEZOELECTRIC)
PLANE = [name for name in TYPES if name.startswith(("CPS", "CPE"))]
SPACE = [name for name in TYPES if name.startswith("C3D")]


def lines_of(values):
    """Data lines of eight values."""
    return "\n".join(", ".join(f"{value!r}" for value in values[k : k + 8]) for k in range(0, len(values), 8))


def material(piezo=None, kind="S", permittivity=PERMITTIVITY):
    d = permittivity
    aniso = [d[0, 0], d[0, 1], d[1, 1], d[0, 2], d[1, 2], d[2, 2]]
    coupling = [float(value) for value in np.ravel(STRESSES if piezo is None else piezo)]
    return (
        f"*MATERIAL, NAME=M\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{lines_of([*YOUNG, *POISSON, *SHEAR])}\n"
        f"*PIEZOELECTRIC, TYPE={kind}\n{lines_of(coupling)}\n"
        f"*DIELECTRIC, TYPE=ANISO\n{lines_of([float(value) for value in aniso])}\n*DENSITY\n2.\n"
    )


def deck(element_type, nodes, elements, given, *, step, orientation="", thickness=0.7, before=""):
    lines = [*body_lines(element_type, nodes, elements)]
    if orientation:
        lines += ["*ORIENTATION, NAME=O", orientation]
    named = ", ORIENTATION=O" if orientation else ""
    lines += [f"*SOLID SECTION, ELSET=BODY, MATERIAL=M{named}", f"{thickness}", given.strip(), before.strip() or "**"]
    lines += [step.strip(), "*OUTPUT, FIELD", "*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "U, RF, EPOT, RCHG, CECHG"]
    return "\n".join([*lines, "*ENERGY OUTPUT, VARIABLE=ALL", "*END STEP", ""])


def compliance():
    """(6, 6) in the axes of the material, for engineering strains 11, 22, 33, 12, 13, 23."""
    found = np.diag([1 / e for e in (*YOUNG, *SHEAR)])
    for (i, j), nu in zip([(0, 1), (0, 2), (1, 2)], POISSON, strict=True):
        found[i, j] = found[j, i] = -nu / YOUNG[i]
    return found


def strain_turn(axes):
    """(6, 6): engineering strains along axes (rows) from those along the global ones."""
    found = np.zeros((6, 6))
    for row, (i, j) in enumerate(PAIRS):
        for column, (k, m) in enumerate(PAIRS):
            shares = axes[i, k] * axes[j, m] + (axes[i, m] * axes[j, k] if k != m else 0)
            found[row, column] = shares * (1 if i == j else 2) * (1 if k == m else 0.5)
    return found


def law(axes, tensor):
    """Stiffness, stress coefficients and permittivity in global directions, of all components."""
    turn = strain_turn(axes)
    stiffness = turn.T @ np.linalg.inv(compliance()) @ turn
    coupling = axes.T @ STRESSES @ turn
    permittivity = axes.T @ PERMITTIVITY @ axes
    if tensor is Tensor.PLANE_STRESS:
        # the strain along 3 that leaves no stress there
        ratio = stiffness[2] / stiffness[2, 2]
        permittivity = permittivity + np.outer(coupling[:, 2], coupling[:, 2]) / stiffness[2, 2]
        coupling = coupling - np.outer(coupling[:, 2], ratio)
        stiffness = stiffness - np.outer(stiffness[:, 2], ratio)
    return stiffness, coupling, permittivity


def held(nodes, values, dof):
    return "".join(f"{k + 1}, {dof}, {dof}, {float(v)!r}\n" for k, v in zip(nodes, values, strict=True))


@pytest.mark.parametrize("element_type", PLANE + SPACE)
@pytest.mark.parametrize("turned", [False, True])
def test_patch(run_deck, element_type, turned):
    """Linear displacements and potentials at the boundary: constant stress and electrical displacement in the body."""
    kind = PIEZOELECTRIC[element_type]
    dim = kind.dimension
    nodes, elements = patch_of(kind.family.cell)
    gradient = 1e-2 * np.array([[1.0, 0.4, -0.3], [0.2, -0.7, 0.5], [0.6, 0.1, 0.8]])[:dim, :dim]
    slope = np.array([0.5, -0.3, 0.4])[:dim]
    outside = np.flatnonzero(((nodes == 0) | (nodes == 1)).any(axis=1))
    step = "*STEP\n*STATIC\n*BOUNDARY\n"
    for k in range(dim):
        step += held(outside, nodes[outside] @ gradient[k], k + 1)
    step += held(outside, nodes[outside] @ slope, 9)
    orientation = f"{lines_of(AXES[0].tolist() + AXES[1].tolist())}\n" if turned else ""
    result = run_deck(deck(element_type, nodes, elements, material(), step=step, orientation=orientation.strip()))
    strain = np.zeros(6)
    for place, (i, j) in enumerate(PAIRS):
        if max(i, j) < dim:
            strain[place] = gradient[i, i] if i == j else gradient[i, j] + gradient[j, i]
    stiffness, coupling, permittivity = law(AXES if turned else np.eye(3), kind.tensor)
    field = np.zeros(3)
    field[:dim] = -slope
    stress = stiffness @ strain - coupling.T @ field
    displaced = coupling @ strain + permittivity @ field
    volume = 0.7 if dim == 2 else 1.0
    stored = 0.5 * volume * (strain @ stiffness @ strain + field @ permittivity @ field)
    if turned:
        # values are in the directions of the orientation
        stress = np.linalg.inv(strain_turn(AXES).T) @ stress
        slope, displaced = AXES[:dim, :dim] @ slope, AXES @ displaced
    for place, component in enumerate(("11", "22", "33", "12", "13", "23")):
        if component in kind.components and not (kind.tensor is Tensor.PLANE_STRESS and component == "33"):
            np.testing.assert_allclose(result.field(f"S{component}"), stress[place], rtol=1e-9, err_msg=component)
    for k in range(dim):
        np.testing.assert_allclose(result.field(f"EPG{k + 1}"), slope[k], rtol=1e-9)
        np.testing.assert_allclose(result.field(f"EFLX{k + 1}"), displaced[k], rtol=1e-9)
    # the work of forces and charges is stored
    assert result.history["ALLWK"][-1] == pytest.approx(stored, rel=1e-9)
    assert result.history["ALLIE"][-1] == pytest.approx(stored, rel=1e-9)
    # charges of the boundary: what the electrical displacement brings in adds up to nothing
    charges = np.array([result.history[f"RCHG[ALL:{k + 1}]"][-1] for k in outside])
    assert abs(charges.sum()) < 1e-9 * abs(charges).max()


STRAINS = np.zeros((3, 6))
STRAINS[2, :3] = -0.002, -0.003, 0.006
STRAINS[0, 4] = STRAINS[1, 5] = 0.009
POLED = {"along": 2, "piezo": STRAINS}


def along_axis(dim):
    """Strain coefficients of a body that is poled along its last axis, and the place of that strain."""
    if dim == 3:
        return STRAINS
    found = np.zeros((3, 6))
    found[1, :3] = -0.002, 0.006, -0.003
    return found


def column(element_type):
    """Nodes and elements of a body from 0 to 1 along each axis, the bottom and the top."""
    kind = PIEZOELECTRIC[element_type]
    nodes, elements = patch_of(kind.family.cell)
    last = kind.dimension - 1
    return nodes, elements, np.flatnonzero(nodes[:, last] == 0), np.flatnonzero(nodes[:, last] == 1)


def supports(nodes, dim):
    """Planes of symmetry."""
    return "*BOUNDARY\n" + "".join(
        held(np.flatnonzero(nodes[:, k] == 0), 0 * nodes[nodes[:, k] == 0, k], k + 1) for k in range(dim)
    )


@pytest.mark.parametrize("element_type", [name for name in TYPES if not name.startswith("CPE")])
def test_a_free_body_between_electrodes(run_deck, element_type):
    """Strain d E; about an axis the radial strain is that around it, here where both coefficients are the same."""
    dim = PIEZOELECTRIC[element_type].dimension
    nodes, elements, bottom, top = column(element_type)
    d = along_axis(dim)
    if element_type.startswith("CAX"):
        d[1, 2] = d[1, 0]
    permittivity = np.diag([2.0, 3.0, 2.5])
    given = material(d, "E", permittivity)
    if element_type.startswith("CAX"):
        # isotropic across the axis: E1 = E3, nu13 = 0.3
        given = given.replace(lines_of([*YOUNG, *POISSON, *SHEAR]), "60., 80., 60., 0.2, 0.3, 0.25, 20., 20.\n25.")
    step = "*STEP\n*STATIC\n*BOUNDARY\n" + held(bottom, 0 * bottom, 9) + held(top, 5.0 + 0 * top, 9)
    result = run_deck(deck(element_type, nodes, elements, given, step=step, before=supports(nodes, dim)))
    last = dim - 1
    for k in range(dim):
        found = [result.history[f"U{k + 1}[ALL:{n + 1}]"][-1] for n in range(len(nodes))]
        np.testing.assert_allclose(found, -5.0 * d[last, k] * nodes[:, k], atol=1e-12)
    if dim == 3:
        # the permittivity at constant stress: that at constant strain and d C d
        free = permittivity[2, 2] + d[2] @ np.linalg.inv(compliance()) @ d[2]
        charge = sum(result.history[f"RCHG[ALL:{n + 1}]"][-1] for n in top)
        assert charge == pytest.approx(5.0 * free)


@pytest.mark.parametrize("element_type", ["C3D8E", "C3D20RE"])
@pytest.mark.parametrize("circuit", ["open", "short", "charged"])
def test_a_bar_that_is_pulled(run_deck, element_type, circuit):
    """Short circuit: strain s T, charge d33 T; open: E = -d33 T over the free permittivity, which stiffens the bar."""
    nodes, elements, bottom, top = column(element_type)
    permittivity = np.diag([2.0, 2.0, 2.5])
    stress, charge = 0.8, 0.3
    free = permittivity[2, 2] + STRAINS[2] @ np.linalg.inv(compliance()) @ STRAINS[2]
    step = "*STEP\n*STATIC\n*BOUNDARY\n" + held(bottom, 0 * bottom, 9)
    electrode = "".join(f"*EQUATION\n2\n{n + 1}, 9, 1., {top[0] + 1}, 9, -1.\n" for n in top[1:])
    electrode += "".join(f"*EQUATION\n2\n{n + 1}, 3, 1., {top[0] + 1}, 3, -1.\n" for n in top[1:])
    step += {"open": "", "short": held(top[:1], [0.0], 9), "charged": f"*CECHARGE\n{top[0] + 1}, 9, {charge}\n"}[
        circuit
    ]
    step += f"*CLOAD\n{top[0] + 1}, 3, {stress}\n"
    before = electrode + supports(nodes, 3)
    result = run_deck(
        deck(element_type, nodes, elements, material(STRAINS, "E", permittivity), step=step, before=before)
    )
    history = {name: values[-1] for name, values in result.history.items()}
    on_it = {"open": 0.0, "charged": charge}
    displaced = -on_it[circuit] if circuit in on_it else STRAINS[2, 2] * stress
    field = (displaced - STRAINS[2, 2] * stress) / free
    strain = stress * compliance()[2, 2] + STRAINS[2, 2] * field
    assert history[f"U3[ALL:{top[0] + 1}]"] == pytest.approx(strain)
    assert history[f"EPOT[ALL:{top[0] + 1}]"] == pytest.approx(-field, abs=1e-12)
    if circuit == "short":
        assert history[f"RCHG[ALL:{top[0] + 1}]"] == pytest.approx(-displaced)
    if circuit == "charged":
        assert history[f"CECHG[ALL:{top[0] + 1}]"] == pytest.approx(charge)
    assert history["ALLWK"] == pytest.approx(history["ALLIE"])
    expected = 0.5 * (stress * strain + (charge * -field if circuit == "charged" else 0.0))
    assert history["ALLWK"] == pytest.approx(expected)


@pytest.mark.parametrize("how", ["*FREQUENCY", "*STEADY STATE DYNAMICS"])
def test_the_resonance_of_an_open_circuit_is_higher(run_deck, how):
    """A column without lateral strain: its stiffness goes from C33 to C33 + b33^2/d33 where no charge flows."""
    nodes, elements, bottom, top = column("C3D8E")
    piezo = np.zeros((3, 6))
    piezo[2, 2] = 8.0
    permittivity = np.diag([2.0, 2.0, 2.5])
    c33 = np.linalg.inv(compliance())[2, 2]
    before = "*BOUNDARY\nALL, 1, 2\n" + held(bottom, 0 * bottom, 3) + held(bottom, 0 * bottom, 9)
    inner = np.setdiff1d(np.arange(len(nodes)), np.concatenate([bottom, top]))
    # one linear function over the height
    for n in (*inner, *top[1:]):
        height = float(nodes[n, 2])
        before += "".join(f"*EQUATION\n2\n{n + 1}, {dof}, 1., {top[0] + 1}, {dof}, {-height!r}\n" for dof in (3, 9))
    found = []
    for circuit in ("", held(top[:1], [0.0], 9)):
        if how == "*FREQUENCY":
            step = "*STEP\n*FREQUENCY\n1,\n"
            result = run_deck(
                deck(
                    "C3D8E",
                    nodes,
                    elements,
                    material(piezo, "S", permittivity),
                    step=step,
                    before=before + "*BOUNDARY\n" * bool(circuit) + circuit,
                )
            )
            found.append(result.history["EIGVAL"][0])
        else:
            step = f"*STEP\n{how}, DIRECT\n0.\n*CLOAD\n{top[0] + 1}, 3, 1.\n"
            result = run_deck(
                deck(
                    "C3D8E",
                    nodes,
                    elements,
                    material(piezo, "S", permittivity),
                    step=step,
                    before=before + "*BOUNDARY\n" * bool(circuit) + circuit,
                )
            )
            found.append(1 / result.history[f"U3[ALL:{top[0] + 1}]"][0])
    assert found[0] / found[1] == pytest.approx(1 + piezo[2, 2] ** 2 / permittivity[2, 2] / c33)


def test_modes_leave_electricity_alone(run_deck):
    """*MODAL DYNAMIC of a piezoelectric column runs, with the stiffness of its circuit in the frequency of its mode."""
    nodes, elements, bottom, top = column("CPE4E")
    before = supports(nodes, 2) + held(bottom, 0 * bottom, 9)
    text = deck(
        "CPE4E",
        nodes,
        elements,
        material(),
        step=f"*STEP\n*MODAL DYNAMIC\n0.05, 1.\n*CLOAD\n{top[0] + 1}, 2, 1.\n",
        before=before + "*STEP\n*FREQUENCY\n40,\n*END STEP\n",
    )
    static = deck(
        "CPE4E", nodes, elements, material(), step=f"*STEP\n*STATIC\n*CLOAD\n{top[0] + 1}, 2, 1.\n", before=before
    )
    # undamped, the motion is about the static displacement
    dynamic = run_deck(text).history[f"U2[ALL:{top[0] + 1}]"]
    rest = run_deck(static).history[f"U2[ALL:{top[0] + 1}]"][-1]
    assert np.nanmax(dynamic) > 1.2 * rest


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "*STATIC",
            "*DYNAMIC\n0.1, 1.",
            r"\*DYNAMIC is not supported for elements of type C3D8E.*supported: \*STATIC, ",
        ),
        ("*STEP\n", "*STEP, NLGEOM\n", "C3D8E: their potential is that of small displacements"),
        ("*STATIC", "*BUCKLE\n1", "C3D8E: their potential is that of small displacements"),
        ("*STATIC", "*STATIC, RIKS", "C3D8E: their potential is that of small displacements"),
        ("*DENSITY\n2.", "*PLASTIC\n1.", r"\*PLASTIC is not supported for elements of type C3D8E"),
        ("*DENSITY\n2.", "*EXPANSION\n1.", r"\*EXPANSION is not supported for elements of type C3D8E"),
        (
            "*DIELECTRIC, TYPE=ANISO\n2.0, 0.3, 3.0, 0.1, -0.2, 2.5\n",
            "",
            r"material M has no \*DIELECTRIC, which elements of type C3D8E need",
        ),
        ("*DIELECTRIC, TYPE=ANISO\n2.0", "*DIELECTRIC, TYPE=ANISO\n-2.0", "must be positive definite"),
        ("*DIELECTRIC, TYPE=ANISO\n2.0, 0.3, 3.0, 0.1, -0.2, 2.5", "*DIELECTRIC\n2., 20.", "2 values, expected 1"),
        ("*DIELECTRIC, TYPE=ANISO\n2.0, 0.3, 3.0, 0.1, -0.2, 2.5", "*DIELECTRIC", r"\*DIELECTRIC: needs a data line"),
        ("*STATIC", "*STATIC\n*CECHARGE\n1, 3, 1.", "charges belong to dof 9, found 3"),
        ("*STATIC", "*STATIC\n*CECHARGE, AMPLITUDE=A\n1, 9, 1.", "an amplitude with VALUE=ABSOLUTE is not supported"),
        ("**axes", "*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 1.", "differ from point to point"),
    ],
)
def test_what_is_wrong_is_named(run_deck, old, new, message):
    nodes, elements, bottom, _ = column("C3D8E")
    before = "**axes\n*AMPLITUDE, NAME=A, VALUE=ABSOLUTE\n0., 1.\n" + supports(nodes, 3) + held(bottom, 0 * bottom, 9)
    text = deck("C3D8E", nodes, elements, material(), step="*STEP\n*STATIC", before=before)
    assert old in text
    text = text.replace(old, new, 1)
    if "*ORIENTATION" in new:
        text = text.replace("MATERIAL=M\n", "MATERIAL=M, ORIENTATION=O\n", 1)
    with pytest.raises(DeckError, match=message):
        run_deck(text)
