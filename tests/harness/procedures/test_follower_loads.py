# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pressures and tractions with NLGEOM: they act on the present faces, with their stiffness, and do work."""

from dataclasses import replace

import numpy as np
import pytest
from reference_cells import unit_cell

import uel
from uel import usersub
from uel.assembly import system_of
from uel.deck import read_deck
from uel.elements import Call, Distributed, Flags
from uel.errors import DeckError
from uel.model.element_types import CONTINUUM

YOUNG, NU, DENSITY = 1000.0, 0.25, 2.0
SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
SIDES = [[0, 1], [1, 2], [2, 3], [3, 0]]
NODES = {
    "CPS4": SQUARE,
    "CPE4": SQUARE,
    "CPE3": SQUARE[:3],
    "CAX4": SQUARE,
    "CPE8R": np.vstack([SQUARE, SQUARE[SIDES].mean(axis=1)]),
    "CAX8": np.vstack([SQUARE, SQUARE[SIDES].mean(axis=1)]),
    **{
        name: unit_cell(kind.family.cell)[0]
        for name, kind in CONTINUUM.items()
        if kind.dimension == 3 and not kind.modes
    },
}
FACES = {name: len(CONTINUUM[name].family.faces) for name in NODES}
THICKNESS = 0.5


def deck(element_type, steps, *, nodes=None):
    nodes = NODES[element_type] if nodes is None else nodes
    numbers = [str(k) for k in range(1, len(nodes) + 1)]
    lines = ["*NODE, NSET=ALL", *(", ".join([k, *map(repr, x.tolist())]) for k, x in zip(numbers, nodes, strict=True))]
    lines += [f"*ELEMENT, TYPE={element_type}, ELSET=BODY", ", ".join(["1", *numbers[:10]]) + "," * (len(nodes) > 10)]
    lines += [", ".join(numbers[10:])] if len(nodes) > 10 else []
    lines += ["*SURFACE, NAME=SIDE", "BODY, S2", "*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}"]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {NU}", "*DENSITY", f"{DENSITY}"]
    output = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU, RF\n*ENERGY OUTPUT\n*END STEP"
    return "\n".join([*lines, *(f"{step}\n{output}" for step in steps), ""])


def static(body, *, options=", NLGEOM", procedure="*STATIC, DIRECT\n0.1, 1."):
    return f"*STEP{options}\n{procedure}\n{body}"


def all_faces(element_type, pressure):
    return "*DLOAD\n" + "\n".join(f"BODY, P{k + 1}, {pressure}" for k in range(FACES[element_type]))


DLOAD = """      SUBROUTINE DLOAD(F,KSTEP,KINC,TIME,NOEL,NPT,LAYER,KSPT,
     1     COORDS,JLTYP,SNAME)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION TIME(2),COORDS(3)
      {}
      END
"""


@pytest.fixture
def press(run_deck):
    def press(text, user=None, **options):
        return run_deck(text, user and DLOAD.format(user), **options)

    return press


def nodal(result, name, nodes):
    """(nodes, dimension) of a vector at the end."""
    labels, dofs = range(1, len(nodes) + 1), range(1, nodes.shape[1] + 1)
    return np.array([[result.history[f"{name}{dof}[ALL:{label}]"][-1] for dof in dofs] for label in labels])


TRACTIONS = {
    "pressure": None,
    "TRVEC": "*DSLOAD\nSIDE, TRVEC, 1., 0.6, 0.64, 0.48",
    "TRSHR": "*DSLOAD\nSIDE, TRSHR, 1., 0.6, 0.64, 0.48",
    "by points": "*DLOAD\nBODY, P2NU",
}


@pytest.mark.parametrize("element_type", NODES)
@pytest.mark.parametrize("load", TRACTIONS.values(), ids=TRACTIONS)
def test_stiffness_of_loads(tmp_path, element_type, load):
    """What pressures on all faces, or tractions, add to the matrix: differences of what they add to the residual."""
    text = deck(element_type, [static(load or all_faces(element_type, 1.0))])
    if CONTINUUM[element_type].dimension == 2:
        text = text.replace(", 0.48", "")
    (tmp_path / "deck.inp").write_text(text)
    model = read_deck(tmp_path / "deck.inp")
    library = usersub.load(None, job="job", output_dir=tmp_path)
    system = system_of(model, library)
    counts = [block.points_of_face if block.load.jltyp else 1 for block in system.contributors.followers]
    faces = np.repeat([block.first for block in system.contributors.followers], counts)
    magnitudes = np.linspace(3, 5, len(faces))
    call = Call(
        Flags(1, nlgeom=True), step=1, increment=1, step_time=1.0, total_time=1.0, time_increment=1.0, period=1.0
    )
    loaded = replace(call, distributed=Distributed(faces, np.ones_like(faces), magnitudes, magnitudes))
    rng = np.random.default_rng(1)
    u = 0.1 * rng.normal(size=len(system))

    def parts(u):
        free = system.evaluate(call, u, u)
        plain = system.matrix(free.data.copy()).toarray()
        full = system.evaluate(loaded, u, u)
        return full.residual - free.residual, system.matrix(full.data).toarray() - plain

    _, stiffness = parts(u)
    step = 1e-5
    for d in rng.normal(size=(4, u.size)):
        slope = (parts(u - step * d)[0] - parts(u + step * d)[0]) / (2 * step)
        np.testing.assert_allclose(slope, stiffness @ d, atol=1e-7 * abs(stiffness).max())
    assert abs(stiffness).max() > 0.1
    library.close()


@pytest.mark.parametrize("element_type", ["CPE4", "CPE8R", "CAX4", "CAX8", "C3D8", "C3D20R"])
def test_compression_from_all_sides(press, element_type):
    """The stress is minus the pressure, whatever the shape has become: in each increment
    2 (l_1 - l_0)/(l_1 + l_0) = -(1 - 2 nu) p/E, in plane strain 1 + nu times that; the work is the integral of p dV."""
    pressure, plane = 300.0, element_type.startswith("CPE")
    held = "*BOUNDARY\n1, 1, 3\n4, 1\n2, 2, 3\n"
    if NODES[element_type].shape[1] == 3:
        held = "*BOUNDARY\n1, 1, 3\n4, 1\n4, 3\n2, 2, 3\n"
    accurate = "*CONTROLS, PARAMETERS=FIELD\n1e-7, 1.\n"
    result = press(deck(element_type, [static(accurate + held + all_faces(element_type, pressure))]))
    strain = (1 + NU if plane else 1) * (1 - 2 * NU) * pressure / YOUNG
    stretch = ((1 - strain / 20) / (1 + strain / 20)) ** 10
    nodes = NODES[element_type]
    # a C3D20R by itself has modes without stiffness, in which rounding moves it
    rounding = 1e-6 if element_type == "C3D20R" else 1e-7
    np.testing.assert_allclose(nodal(result, "U", nodes), (stretch - 1) * nodes, atol=rounding)
    volume = {"CPE": THICKNESS, "CAX": np.pi, "C3D": 1.0}[element_type[:3]]
    # V = exp(-rate t), p in proportion to t
    rate = (2 if plane else 3) * strain
    work = pressure * volume * ((1 - np.exp(-rate)) / rate - np.exp(-rate))
    assert result.history["ALLWK"][-1] == pytest.approx(work, rel=2e-3)


def test_pressure_turns_with_its_face(press):
    """A held square turned by 90 degrees: pressure times thickness on the side that then looks up."""
    held = "*BOUNDARY\n1, 1, 2\n2, 1, 1, -1.\n2, 2, 2, 1.\n3, 1, 1, -2.\n4, 1, 1, -1.\n4, 2, 2, -1.\n3, 2, 2, 0.\n"
    turned = press(deck("CPE4", [static(held + "*DSLOAD\nSIDE, P, 4.")]))
    free = press(deck("CPE4", [static(held)]))
    difference = nodal(turned, "RF", SQUARE) - nodal(free, "RF", SQUARE)
    np.testing.assert_allclose(difference, 4 * THICKNESS / 2 * np.array([[0, 0], [0, 1], [0, 1], [0, 0]]), atol=1e-9)


@pytest.mark.parametrize(
    ("load", "force"),
    [("TRVEC, 5., 0.6, 0.8", [-4, 3]), ("TRSHR, 5., 0.6, 0.8", [-5, 0]), ("TRSHR, 5., 0.6, -0.8", [5, 0])],
)
def test_traction_turns_with_its_face(press, load, force):
    """The square of above turned and its side stretched to 1.5: per present length, along the side as it is now."""
    held = "*BOUNDARY\n1, 1, 2\n2, 1, 1, -1.\n2, 2, 2, 1.\n3, 1, 1, -2.5\n4, 1, 1, -1.5\n4, 2, 2, -1.\n3, 2, 2, 0.\n"
    turned = press(deck("CPE4", [static(held + "*DSLOAD\nSIDE, " + load)]))
    free = press(deck("CPE4", [static(held)]))
    difference = nodal(turned, "RF", SQUARE) - nodal(free, "RF", SQUARE)
    expected = -np.outer([0, 1, 1, 0], force) * 1.5 * THICKNESS / 2
    np.testing.assert_allclose(difference, expected, atol=1e-9)


@pytest.mark.parametrize("load", ["TRVEC, 2., 1., 0., 0.", "TRSHR, 2., 1., 0., 1."])
def test_traction_on_a_face_that_is_sheared(press, load):
    """The rotation of the polar decomposition of [1 g; 0 1] is by atan(-g/2), and the area stays."""
    nodes, shear = NODES["C3D8"], 0.8
    up = [k for k, x in enumerate(nodes, start=1) if x[1] == 1]
    held = f"*BOUNDARY\nALL, 1, 3\n{''.join(f'{k}, 1, 1, {shear}' + chr(10) for k in up)}"
    texts = [deck("C3D8", [static(held + body)], nodes=nodes) for body in (f"*DSLOAD\nSIDE, {load}", "")]
    face = nodes[list(CONTINUUM["C3D8"].family.faces[1])]
    assert np.ptp(face[:, 2]) == 0
    found = np.subtract(*(nodal(press(text), "RF", nodes).sum(axis=0) for text in texts))
    angle = np.arctan(-shear / 2)
    np.testing.assert_allclose(found, [-2 * np.cos(angle), -2 * np.sin(angle), 0], atol=1e-9)


def test_pressure_on_a_ring_that_grows(press):
    """All nodes to 1.5 of the radius: p on the present circumference, as far as it is not held twice."""
    nodes = SQUARE + np.array([1.0, 0.0])
    held = "*BOUNDARY\nALL, 2\n" + "".join(f"{k}, 1, 1, {0.5 * x}\n" for k, (x, _) in enumerate(nodes, start=1))
    found = [
        nodal(press(deck("CAX4", [static(held + load)], nodes=nodes)), "RF", nodes)[:, 0].sum()
        for load in ("*DLOAD\nBODY, P4, 4.", "")
    ]
    assert found[1] - found[0] == pytest.approx(4 * 2 * np.pi * 1.5 * 1.0)


def test_pressure_goes_on_from_a_linear_step(press):
    """On the initial face without NLGEOM, the same but for the square of the strain; removed in the last step."""
    held = "*BOUNDARY\n1, 1, 2\n4, 1\n"
    linear = static(held + "*DLOAD\nBODY, P2, -4.", options="")
    last = static("*DLOAD, OP=NEW")
    one = press(deck("CPS4", [linear]))
    ends = [
        nodal(press(deck("CPS4", steps)), "U", SQUARE) for steps in ([linear, static("")], [linear, static(""), last])
    ]
    np.testing.assert_allclose(nodal(one, "U", SQUARE)[1], [4 / YOUNG, 0], atol=1e-12)
    assert ends[0][1, 0] == pytest.approx(4 / YOUNG, abs=2 * (4 / YOUNG) ** 2)
    np.testing.assert_allclose(ends[1], 0, atol=2 * (4 / YOUNG) ** 2)


def test_dynamic_pressure_is_a_dead_traction_where_nothing_turns(press):
    procedure = "*DYNAMIC, DIRECT\n0.01, 0.1"
    held = "*BOUNDARY\nALL, 2\n"
    loads = "*DLOAD\nBODY, P4, 4.", "*SURFACE, NAME=LEFT\nBODY, S4\n*DSLOAD, FOLLOWER=NO\nLEFT, TRVEC, 4., 1."
    texts = [
        deck("CPE4", [static(held + load, procedure=procedure)]) for load in (loads[0], loads[1].split("\n", 2)[2])
    ]
    texts[1] = texts[1].replace("*SURFACE, NAME=SIDE\nBODY, S2", "*SURFACE, NAME=LEFT\nBODY, S4")
    found = [press(text).history["U1[ALL:1]"] for text in texts]
    np.testing.assert_allclose(found[0], found[1], rtol=1e-6)
    # the middle of the mass: p t^2/(2 density)
    ends = [nodal(press(text), "U", SQUARE)[:, 0].mean() for text in texts]
    np.testing.assert_allclose(ends, 4 * 0.1**2 / (2 * DENSITY), rtol=1e-6)


HELD = "*BOUNDARY\nALL, 2\n1, 1\n4, 1\n"
"""A bar of length 1, whose area does not change."""
EXACT = "*CONTROLS, PARAMETERS=FIELD\n1e-9, 1e-9\n"
MODULUS = YOUNG * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
RIKS = "*STATIC, RIKS\n0.25, 1., 0.25, 0.25, 1."


def stress_along(result):
    """Stress and length of the bar at the ends of increments: it sums strains over the length in the middle of each."""
    length = 1 + result.history["U1[ALL:2]"]
    before = np.concatenate([[1.0], length[:-1]])
    return MODULUS * np.cumsum(2 * (length - before) / (length + before)), length


@pytest.mark.parametrize("procedure", ["*STATIC\n0.5, 1.", "*STATIC, STABILIZE\n0.5, 1."])
def test_pressure_of_dload_at_the_present_place(press, procedure):
    """A pressure of 200 x on the end, which is at x: that of the deck is 200, and no amplitude acts on it."""
    text = deck("CPE4", [static(HELD + EXACT + "*DLOAD\nBODY, P2NU, 200.", procedure=procedure)])
    stress, length = stress_along(press(text, "F = F*COORDS(1)"))
    # the damping is small, not zero
    np.testing.assert_allclose(stress, -200 * length, rtol=1e-3 if "STABILIZE" in procedure else 1e-6)


@pytest.mark.parametrize("load", ["*DLOAD\nBODY, P2, 200.", "*DSLOAD\nSIDE, P, 200."])
def test_pressure_along_a_path(press, load):
    """Riks' method: the pressure on the present face is the load factor times that of the deck."""
    result = press(deck("CPE4", [static(HELD + EXACT + load, procedure=RIKS)]))
    factors = result.history["LPF"]
    assert len(factors) > 3
    np.testing.assert_allclose(stress_along(result)[0], -200 * factors, rtol=1e-6)


@pytest.mark.parametrize("load", ["P2NU, 200.", "BXNU, -400."])
def test_loads_of_dload_along_a_path(press, load):
    """F is a function of the load factor, which is TIME(1), and here not proportional to it.

    A body force acts on the initial volume; one half of it on the two nodes at the end.
    """
    result = press(
        deck("CPE4", [static(HELD + EXACT + f"*DLOAD\nBODY, {load}", procedure=RIKS)]), "F = F*TIME(1)*(1+TIME(1))/2"
    )
    factors = result.history["LPF"]
    assert factors[-1] >= 1
    np.testing.assert_allclose(stress_along(result)[0], -100 * factors * (1 + factors), rtol=1e-6)


@pytest.mark.parametrize("load", ["*DLOAD\nBODY, P2, 200.", "*DLOAD\nBODY, BXNU, 200."])
def test_energy_control_refuses_loads_on_elements(press, load):
    message = (
        "loads on user elements, those that follow the surface and those of DLOAD are not supported with --control"
    )
    with pytest.raises(DeckError, match=message):
        press(deck("CPE4", [static(HELD + load)]), "F = F", solver=uel.SolverOptions(energy_control=True))


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        ([static("*DSLOAD\nSIDE, TRSHR, 1., 1.")], r"deck.inp:\d+: TRSHR: the direction is normal to the surface"),
        (
            [static("*DLOAD\nBODY, P2, 1."), "*STEP\n*FREQUENCY\n1"],
            r"load type P follows .* beside a perturbation step \(.*deck.inp:\d+\)",
        ),
    ],
)
def test_what_is_not_followed_is_refused(press, steps, message):
    with pytest.raises(DeckError, match=message):
        press(deck("CPE4", steps))
