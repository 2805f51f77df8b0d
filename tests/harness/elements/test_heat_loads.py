# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fluxes, films and radiation on elements, surfaces and nodes, with DFLUX and FILM, by theory."""

from pathlib import Path

import numpy as np
import pytest
from reference_cells import patch_of
from scipy.optimize import brentq, newton
from small_decks import body_lines

from uel.errors import DeckError, KernelError
from uel.model.element_types import BUILT_IN, COUPLED, HEAT

HERE = Path(__file__).parent
K, THICKNESS = 3.0, 0.5
STEADY = "*HEAT TRANSFER, STEADY STATE\n1., 1."
QUICK = ("DC2D4", "DC2D8", "DCAX4", "DC3D8", "CPE4T", "CAX8T", "C3D20RT")
TYPES = [*HEAT, "CPE4T", "CPS8T", "CAX4RT", "CAX8T", "C3D4T", "C3D8T", "C3D20RT"]
TYPES = [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in TYPES]


class Body:
    """A unit square or cube, about an axis a cylinder, whose end at 0 along direction `axis` is held at 0."""

    def __init__(self, element_type, shift=0.0):
        self.type, self.kind = element_type, BUILT_IN[element_type]
        nodes, self.elements = patch_of(self.kind.family.cell)
        self.nodes = nodes[:, : self.kind.dimension] + shift * np.eye(self.kind.dimension)[0]
        self.axis = 1 if self.kind.axisymmetric else 0
        self.along = self.nodes[:, self.axis] - (0 if self.axis else shift)
        self.area = np.pi if self.kind.axisymmetric else THICKNESS if self.kind.dimension == 2 else 1.0

    @property
    def faces(self):
        """Element and number of each face at the end at 1, counted from 1."""
        return [
            (row + 1, number)
            for row, element in enumerate(self.elements)
            for number, face in enumerate(self.kind.family.faces, start=1)
            if np.all(abs(self.along[element[list(face)]] - 1) < 1e-9)
        ]

    def by_element(self, label, values):
        return "".join(f"{row}, {label[0]}{number}{label[1:]}, {values}\n" for row, number in self.faces)

    @property
    def surface(self):
        return "*SURFACE, NAME=END\n" + "".join(f"{row}, S{number}\n" for row, number in self.faces)

    @property
    def corners(self):
        """Nodes with temperatures."""
        return np.unique(self.elements[:, : self.kind.corners] if self.type in COUPLED else self.elements)

    def deck(self, loads, *, procedure=STEADY, material="", step_options=""):
        held = self.corners[abs(self.along[self.corners]) < 1e-9]
        boundary = "*BOUNDARY\n" + "".join(f"{k + 1}, 11\n" for k in held)
        lines = [*body_lines(self.type, self.nodes, self.elements), self.surface.strip()]
        lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}"]
        if self.type in COUPLED:
            boundary += f"ALL, 1, {self.kind.dimension}\n"
            procedure = procedure.replace("HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT")
            if self.kind.hourglass_control:
                lines += ["*HOURGLASS STIFFNESS", "1."]
        lines += ["*MATERIAL, NAME=M", f"*CONDUCTIVITY\n{K}", "*ELASTIC\n1000., 0.3"]
        lines += [material] if material else []
        lines += [f"*STEP, INC=1000{step_options}", procedure, boundary + loads.strip()]
        lines += ["*OUTPUT, HISTORY", "*NODE OUTPUT, NSET=ALL", "NT, RFL", "*END STEP", ""]
        return "\n".join(lines)


def last(body, result, name="NT11"):
    """Values at the nodes with temperatures."""
    return np.array([result.history[f"{name}[ALL:{k + 1}]"][-1] for k in body.corners])


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("on_surface", [False, True])
def test_a_flux_makes_the_temperature_linear(run_deck, element_type, on_surface):
    """q x/k exactly, whatever the mesh; all heat leaves at the other end."""
    body = Body(element_type)
    text = "*DSFLUX\nEND, S, 6." if on_surface else "*DFLUX\n" + body.by_element("S", 6.0)
    result = run_deck(body.deck(text))
    np.testing.assert_allclose(last(body, result), 6.0 / K * body.along[body.corners], rtol=1e-9, atol=1e-9)
    assert last(body, result, "RFL11").sum() == pytest.approx(-6.0 * body.area, rel=1e-9)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("on_surface", [False, True])
def test_a_film_makes_the_temperature_linear(run_deck, element_type, on_surface):
    """k T(1) = h (sink - T(1))."""
    body = Body(element_type)
    text = "*SFILM\nEND, F, 8., 5." if on_surface else "*FILM\n" + body.by_element("F", "8., 5.")
    result = run_deck(body.deck(text))
    expected = 5.0 * 8.0 / (K + 5.0) * body.along[body.corners]
    np.testing.assert_allclose(last(body, result), expected, rtol=1e-9, atol=1e-9)
    assert [line.total_iterations for line in result.status] == [1]


@pytest.mark.parametrize("element_type", TYPES)
def test_heat_into_the_volume(run_deck, element_type):
    body = Body(element_type)
    result = run_deck(body.deck("*DFLUX\nBODY, BF, 4."))
    assert last(body, result, "RFL11").sum() == pytest.approx(-4.0 * body.area, rel=1e-9)


ZERO, BOLTZMANN, EMISSIVITY, AMBIENT = -273.15, 5.67e-8, 0.8, 500.0
CONSTANTS = f"*PHYSICAL CONSTANTS, ABSOLUTE ZERO={ZERO}, STEFAN BOLTZMANN={BOLTZMANN}\n*STEP"
TIGHT = "\n*CONTROLS, PARAMETERS=FIELD, FIELD=GLOBAL\n1e-9"


def radiated(temperature):
    """Heat that enters an area by radiation (J. Stefan, L. Boltzmann)."""
    return EMISSIVITY * BOLTZMANN * ((AMBIENT - ZERO) ** 4 - (temperature - ZERO) ** 4)


def slope_of_radiation(temperature):
    """Derivative of what enters and is conducted away."""
    return -4 * EMISSIVITY * BOLTZMANN * (temperature - ZERO) ** 3 - K


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("form", ["element", "surface"])
def test_radiation_makes_the_temperature_linear(run_deck, element_type, form):
    """k T(1) is what the end gets; all of it leaves at the other one. Newton's method needs as many iterations as for
    this equation alone."""
    body = Body(element_type)
    values = f"{AMBIENT}, {EMISSIVITY}"
    text = f"*SRADIATE\nEND, R, {values}" if form == "surface" else "*RADIATE\n" + body.by_element("R", values)
    result = run_deck(body.deck(text + TIGHT).replace("*STEP", CONSTANTS, 1))
    hot = brentq(lambda t: radiated(t) - K * t, 0.0, AMBIENT, xtol=1e-12)
    np.testing.assert_allclose(last(body, result), hot * body.along[body.corners], rtol=1e-8, atol=1e-8)
    assert last(body, result, "RFL11").sum() == pytest.approx(-K * hot * body.area, rel=1e-8)
    _, alone = newton(lambda t: radiated(t) - K * t, 0.0, full_output=True, rtol=1e-9, fprime=slope_of_radiation)
    assert sum(line.total_iterations for line in result.status) <= alone.iterations


def test_a_body_that_nodes_warm_by_radiation(run_deck):
    """All nodes alike: density x specific heat x volume x the change is the heat of the end of each increment."""
    lines = [*body_lines("DC2D4", np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), [range(4)])]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", f"{THICKNESS}", "*MATERIAL, NAME=M", f"*CONDUCTIVITY\n{K}"]
    lines += ["*DENSITY\n2.", "*SPECIFIC HEAT\n7.", "*AMPLITUDE, NAME=ON\n0., 1., 1., 1."]
    lines += [CONSTANTS, "*HEAT TRANSFER\n0.25, 0.75, 0.25, 0.25", f"*CRADIATE, AMPLITUDE=ON\nALL, 0.3, {AMBIENT}"]
    lines[-1] += f", {EMISSIVITY}{TIGHT}\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nNT\n*END STEP\n"
    history = run_deck(lines).history
    stored, temperature = 2.0 * 7.0 * THICKNESS, 0.0
    for k in range(3):
        before = temperature
        temperature = brentq(lambda t: 4 * 0.3 * radiated(t) - stored * (t - before) / 0.25, before, AMBIENT)  # noqa: B023
        for node in range(1, 5):
            assert history[f"NT11[ALL:{node}]"][k] == pytest.approx(temperature, rel=1e-8)


def test_radiation_without_its_constant(run_deck):
    body = Body("DC2D4")
    text = body.deck("*SRADIATE\nEND, R, 500., 0.8")
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*SRADIATE needs \*PHYSICAL CONSTANTS, STEFAN BOLTZMANN="):
        run_deck(text)
    with pytest.raises(DeckError, match=r"\*PHYSICAL CONSTANTS: STEFAN BOLTZMANN=-1 must not be negative"):
        run_deck(text.replace("*STEP", "*PHYSICAL CONSTANTS, STEFAN BOLTZMANN=-1\n*STEP", 1))


def test_films_at_nodes(run_deck):
    """As a film on the face whose area they share."""
    body = Body("DC2D4")
    ends = body.corners[abs(body.along[body.corners] - 1) < 1e-9]
    text = "*CFILM\n" + "".join(f"{k + 1}, {THICKNESS / 2}, 8., 5.\n" for k in ends)
    result = run_deck(body.deck(text))
    np.testing.assert_allclose(last(body, result), 5.0 * 8.0 / (K + 5.0) * body.along, rtol=1e-9, atol=1e-9)


def test_magnitudes_follow_amplitudes_and_steps(run_deck):
    """A sink that follows its amplitude, a coefficient that does not ramp; then OP=NEW leaves nothing of it."""
    body = Body("DC2D4")
    text = body.deck("*SFILM\nEND, F, 8., 5.", procedure="*HEAT TRANSFER, STEADY STATE\n0.5, 1., 0.5, 0.5")
    text = text.replace("*STEP", "*AMPLITUDE, NAME=HALF\n0., 0.5, 1., 0.5\n*STEP", 1)
    scaled = text.replace("*SFILM", "*SFILM, AMPLITUDE=HALF, FILM AMPLITUDE=HALF")
    again = "*STEP\n*HEAT TRANSFER, STEADY STATE\n1., 1.\n*SFILM, OP=NEW\n*DSFLUX\nEND, S, 6.\n*END STEP\n"
    # the steady state of the ramped step: half the sink temperature, all of the coefficient
    ramped = run_deck(text + again)
    end = int(np.flatnonzero(body.along == 1)[0]) + 1
    values = list(ramped.history[f"NT11[ALL:{end}]"])[-3:]
    assert values == pytest.approx([0.5 * 40 / (K + 5), 40 / (K + 5), 6 / K])
    values = run_deck(scaled).history[f"NT11[ALL:{end}]"][-2:]
    assert list(values) == pytest.approx([2.5 * 4 / (K + 2.5)] * 2)


@pytest.mark.parametrize("element_type", ["DC2D4", "DC2D8", "DC3D8", "CPE8T"])
@pytest.mark.parametrize("on_surface", [False, True])
def test_fluxes_of_dflux(run_deck, element_type, on_surface):
    """k T(1) = 2 (2 + 1 - 3 T(1)); FLUX(2) is in the matrix."""
    body = Body(element_type)
    text = "*DSFLUX\nEND, SNU, 2." if on_surface else "*DFLUX\n" + body.by_element("SNU", 2.0)
    result = run_deck(body.deck(text), HERE / "enters.f")
    np.testing.assert_allclose(last(body, result), 6.0 / (K + 6.0) * body.along[body.corners], rtol=1e-9, atol=1e-9)
    assert [line.total_iterations for line in result.status] == [1]


@pytest.mark.parametrize(
    ("element_type", "form"),
    [
        *((element_type, form) for element_type in ("DC2D4", "DC2D8", "CPE8T") for form in ("element", "surface")),
        *((element_type, "node") for element_type in ("DC2D4", "DC3D8", "CPE4T")),
    ],
)
def test_films_of_film(run_deck, element_type, form):
    """k T(1) = 5 (1 + T(1)/10) (8 + 1 - T(1)); H(2) is in the matrix."""
    body = Body(element_type)
    ends = body.corners[abs(body.along[body.corners] - 1) < 1e-9]
    text = {
        "element": "*FILM\n" + body.by_element("FNU", "8., 5."),
        "surface": "*SFILM\nEND, FNU, 8., 5.",
        "node": "*CFILM, USER\n" + "".join(f"{k + 1}, {body.area / len(ends)}, 8., 5.\n" for k in ends),
    }[form]
    result = run_deck(body.deck(text + "\n*CONTROLS, PARAMETERS=FIELD, FIELD=GLOBAL\n1e-9"), HERE / "enters.f")
    hot = max(np.roots([-0.5, -0.5 - K, 45.0]))
    np.testing.assert_allclose(last(body, result), hot * body.along[body.corners], rtol=1e-7, atol=1e-9)
    assert sum(line.total_iterations for line in result.status) <= 5


PROCEDURES = [
    (element_type, f"*HEAT TRANSFER{steady}\n0.25, 0.5, 0.25, 0.25")
    for element_type in ("DC2D4", "CPE4T")
    for steady in (", STEADY STATE", "")
]


def printed(tmp_path, routine):
    """What the routine printed in its last call, in numbers, and the text behind them."""
    lines = [line.split() for line in (tmp_path / "deck.dat").read_text().splitlines() if line.startswith(routine)]
    return np.array([float(word) for word in lines[-1][1:] if word != "END"]), lines[-1][-1]


def given_to_routine(body, loads, procedure):
    """A deck of two steps; the nodes are at 1 in all of it."""
    stores = "*DENSITY\n2.\n*SPECIFIC HEAT\n0.7"
    text = body.deck(loads + "\n*BOUNDARY\nALL, 11, 11, 1.", procedure=procedure, material=stores)
    text = text.replace("*STEP, ", "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1\nALL, 4.\n*STEP, AMPLITUDE=STEP, ", 1)
    if body.type in COUPLED:
        procedure = procedure.replace("HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT")
    return f"{text}*STEP, AMPLITUDE=STEP\n{procedure}\n*END STEP\n"


@pytest.mark.parametrize(("element_type", "procedure"), PROCEDURES)
@pytest.mark.parametrize("form", ["face", "volume", "surface"])
def test_what_dflux_is_given(run_deck, tmp_path, element_type, procedure, form):
    """In its last call: increment 2 of step 2 ends at the time 0.5 of the step, 1.0 in total."""
    body = Body(element_type)
    ((row, number),) = body.faces
    loads, point, jltyp = {
        "face": (f"*DFLUX\n{row}, S{number}NU, 2.", 2, 10 + number),
        "volume": (f"*DFLUX\n{row}, BFNU, 2.", 4, 1),
        "surface": ("*DSFLUX\nEND, SNU, 2.", 2, 0),
    }[form]
    run_deck(given_to_routine(body, loads, procedure), HERE / "enters.f")
    found, surface = printed(tmp_path, "DFLUX")
    np.testing.assert_allclose(found[:5], [2.0, 0.0, 1.0, 0.5, 1.0])  # FLUX on entry, SOL, TIME of the end
    nodes = body.nodes[body.elements[row - 1]]
    if form != "volume":
        # the second corner of the face
        np.testing.assert_allclose(found[5:7], nodes[body.kind.family.faces[number - 1][1]])
    else:
        assert (nodes.min(axis=0) < found[5:7]).all()
        assert (found[5:7] < nodes.max(axis=0)).all()
    np.testing.assert_array_equal(found[7:13], [0, 2, 2, row, point, jltyp])  # KSTEP, KINC, NOEL, NPT, JLTYP
    assert (surface == "END") == (form == "surface")


@pytest.mark.parametrize(("element_type", "procedure"), PROCEDURES)
@pytest.mark.parametrize("form", ["face", "node", "surface"])
def test_what_film_is_given(run_deck, tmp_path, element_type, procedure, form):
    body = Body(element_type)
    ((row, number),) = body.faces
    corner = body.elements[row - 1][body.kind.family.faces[number - 1][1]]
    loads, place, area = {
        "face": (f"*FILM\n{row}, F{number}NU, 8., 5.", [row, 2, 10 + number, 1, 0], THICKNESS / 2),
        "node": (f"*CFILM, USER\n{corner + 1}, 0.3, 8., 5.", [0, 0, 0, 1, corner + 1], 0.3),
        "surface": ("*SFILM\nEND, FNU, 8., 5.", [row, 2, 0, 1, 0], THICKNESS / 2),
    }[form]
    run_deck(given_to_routine(body, loads, procedure), HERE / "enters.f")
    found, surface = printed(tmp_path, "FILM")
    # H, SINK, TEMP, TIME of the end, COORDS, FIELD(1), AREA
    np.testing.assert_allclose(found[:6], [5.0, 0.0, 8.0, 1.0, 0.5, 1.0])
    np.testing.assert_allclose(found[6:11], [*body.nodes[corner], 0.0, 4.0, area])
    np.testing.assert_array_equal(found[11:], [2, 2, *place])  # KSTEP, KINC, NOEL, NPT, JLTYP, NFIELD, NODE
    assert (surface == "END") == (form == "surface")


@pytest.mark.parametrize(
    ("element_type", "loads", "message"),
    [
        ("DC2D4", "*DSFLUX\nEND, SNU, 2.", r"deck.inp:\d+: \*DSFLUX: nonuniform loads need DFLUX; .* has UEL"),
        ("DC2D4", "*CFILM, USER\n1, 1., 2., 3.", r"deck.inp:\d+: \*CFILM: nonuniform loads need FILM; .* has UEL"),
        ("DC2D4", "*DFLUX\nBODY, S9, 2.", r"\*DFLUX: elements of type DC2D4 have no face S9 \(faces: S1, S2, S3, S4\)"),
        ("DC2D4", "*DFLUX\nBODY, F2, 2.", r"load type F2 is not supported \(supported: BF, Sn; with NU, as in SNU\)"),
        ("DC2D4", "*FILM\nBODY, S2, 2., 1.", r"load type S2 is not supported \(supported: Fn; with NU, as in FNU\)"),
        ("DC2D4", "*SFILM\nEND, F1, 2., 1.", r"load type F1 is not supported \(supported: F; with NU, as in FNU\)"),
        ("DC2D4", "*DSFLUX\nEND, BF, 2.", r"load type BF is not supported \(supported: S; with NU, as in SNU\)"),
        ("DC2D4", "*CFILM\n1, -1., 2., 3.", r"area -1 must be positive"),
        ("DC2D4", "*SRADIATE\nEND, AVG, , 0.8", r"load type AVG is not supported \(supported: R\)"),
        ("DC2D4", "*SRADIATE\nEND, RNU, 500., 0.8", r"load type RNU is not supported \(supported: R\)"),
        ("DC2D4", "*RADIATE\nBODY, F2, 500., 0.8", r"load type F2 is not supported \(supported: Rn\)"),
        ("DC2D4", "*SRADIATE\nEND, R, 500., -0.8", r"emissivity -0.8 must not be negative"),
        ("CPE8T", "*CFILM\nALL, 1., 2., 3.", r"deck.inp:\d+: \*CFILM: node \d+ has no temperature"),
    ],
)
def test_what_does_not_fit_is_refused(run_deck, element_type, loads, message):
    with pytest.raises(DeckError, match=message):
        run_deck(Body(element_type).deck(loads))


def test_heat_into_elements_without_temperatures(run_deck):
    text = Body("DC2D4").deck("*DFLUX\nBODY, BF, 2.").replace("=DC2D4", "=CPE4")
    with pytest.raises(
        DeckError, match="load type BF on elements of type CPE4, which are not built-in elements with heat"
    ):
        run_deck(text)


@pytest.mark.parametrize(
    ("loads", "routine"), [("*DSFLUX\nEND, SNU, 2.", "DFLUX"), ("*SFILM\nEND, FNU, 8., 5.", "FILM")]
)
def test_xit(run_deck, loads, routine):
    text = Body("DC2D4", shift=100.0).deck(loads)
    with pytest.raises(KernelError, match=rf"\(type DC2D4\): {routine} at integration point 1 stopped the analysis"):
        run_deck(text, HERE / "enters.f")
