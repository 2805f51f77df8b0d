# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Beams whose material is integrated over the section: points, plastic moments, torsion, tangents, user routines.

Plastic moments are those of limit analysis (S. Timoshenko, Strength of Materials II, 1956, sections 64 and 65).
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uel.elements import Flags, Request
from uel.elements.families.beam_points import rectangle_shear, section_points
from uel.elements.families.beam_profiles import profile_of
from uel.errors import DeckError, Source
from uel.model.element_types import BEAM
from uel.model.mesh import ElementGroup
from uel.model.procedures import Static
from uel.model.properties import BeamSection, Elastic, ElasticType, Material, Plastic
from uel.model.steps import Step

HERE = Path(__file__).parents[1]
SOURCE = Source("test.inp", 7)
E, NU, G, YIELD = 1000.0, 0.25, 400.0, 2.0
DIMENSIONS = {
    "RECT": (0.4, 0.7),
    "CIRC": (0.5,),
    "PIPE": (0.5, 0.02),
    "BOX": (0.8, 0.6, *(0.02,) * 4),
    "I": (0.3, 1.2, 0.8, 0.5, 0.06, 0.05, 0.04),
}
TYPES = ("B21", "B22", "B31", "B32")
IDEAL = np.array([[YIELD, 0.0]])
HARDENING = np.array([[YIELD, 0.0], [3.0, 0.01], [3.5, 0.05]])


def section(profile, table=IDEAL):
    material = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE))
    if table is not None:
        material = replace(material, plastic=Plastic(table, SOURCE))
    return BeamSection("ALL", profile, DIMENSIONS[profile], E, G, 0.0, SOURCE, material=material)


@pytest.fixture
def beam(bound, load, call):
    """Force, tangent and energies of one beam along x by its unknowns, from its committed state."""

    def beam(element_type, of_beam, length=2.0, *, large=False):
        kind = BEAM[element_type]
        x = np.linspace(0, length, kind.nodes)[:, None] * [1.0, 0, 0]
        group = ElementGroup(element_type, np.array([1]), np.arange(kind.nodes)[None], "", of_beam, None, SOURCE)
        steps = (Step(1, "Step-1", Static(), SOURCE, nlgeom=True),) if large else ()
        block, matrix = bound(group, x, load(None), steps)
        used = np.array([6 * node + dof - 1 for node in range(kind.nodes) for dof in kind.dofs(node)])

        def evaluate(u, *, commit=False):
            whole = np.zeros(6 * kind.nodes)
            whole[used] = np.ravel(u)
            residual = np.zeros_like(whole)
            matrix.data[:] = 0
            report = block.evaluate(
                replace(call, flags=Flags(1, large, Request.NORMAL)), whole, whole, residual, matrix.data
            )
            if commit:
                block.commit()
            return -residual[used], matrix.toarray()[np.ix_(used, used)], report.energy

        evaluate.block, evaluate.unknowns, evaluate.x = block, len(used), x
        return evaluate

    return beam


def bent(evaluate, element_type, curvature=0.0, strain=0.0, twist=0.0):
    """Unknowns of a constant state along x: curvature about the local direction 1, which is -z, as that in a plane."""
    x = evaluate.x[:, 0]
    zero = 0 * x
    # a positive SM1 turns the end by a rotation about -z
    found = [strain * x, -curvature * x**2 / 2, zero, twist * x, zero, -curvature * x]
    return np.array(found)[np.array(BEAM[element_type].dofs(0)) - 1].T.ravel()


def values_of(evaluate):
    """Committed variables of the section points of the first integration point, by their names."""
    state = evaluate.block.state(0)
    names = state.variables.names
    sections = state.variables.sections
    return dict(zip(names, state.svars.reshape(-1, len(names))[:sections].T, strict=True))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("profile", DIMENSIONS)
def test_points_have_the_constants_of_the_section(profile, dimension):
    of_beam = section(profile)
    points, expected = section_points(of_beam, dimension), profile_of(of_beam, dimension)
    assert points.area.sum() == pytest.approx(expected.area)
    centroid = points.area @ points.place / expected.area
    arms = points.place - centroid
    second = (points.area * arms.T) @ arms
    if dimension == 3:
        np.testing.assert_allclose(centroid, expected.centroid, atol=1e-12)
        found = second[1, 1], second[0, 0], second[0, 1]
        np.testing.assert_allclose(found, expected.inertia, rtol=1e-12, atol=1e-14)
        assert points.area @ points.lever**2 == pytest.approx(0.0 if profile == "I" else expected.torsion)
    else:
        assert centroid[1] == pytest.approx(expected.centroid[1], abs=1e-12)
        assert second[1, 1] == pytest.approx(expected.inertia[0], rel=1e-12)
    # those of the default output are where an elastic section has them
    for number, *place in expected.points:
        np.testing.assert_allclose(points.place[number - 1], place, atol=1e-12)


def test_numbers_of_points():
    """Analysis User's Guide, Beam cross-section library."""
    counts = {name: [len(section_points(section(name), d).area) for d in (2, 3)] for name in DIMENSIONS}
    assert counts == {"RECT": [5, 25], "CIRC": [5, 17], "PIPE": [5, 8], "BOX": [5, 16], "I": [5, 13]}


def test_shear_strain_of_a_twisted_rectangle():
    """Largest one over twist and shorter side (S. Timoshenko, J. Goodier, Theory of Elasticity, 1951, table 4)."""
    for ratio, expected in ((1, 0.675), (1.5, 0.848), (2, 0.930), (3, 0.985), (10, 1.0)):
        middle = rectangle_shear(1.0, ratio, np.array([0.5]), np.array([0.0]))
        # the table is rounded
        assert middle == pytest.approx(expected, abs=6e-4)
        assert rectangle_shear(ratio, 1.0, np.array([0.0]), np.array([0.5])) == pytest.approx(middle)
    corners = rectangle_shear(1.0, 2.0, np.array([0.5, -0.5]), np.array([1.0, 1.0]))
    np.testing.assert_allclose(corners, 0, atol=1e-12)


@pytest.mark.sample(3)
@pytest.mark.parametrize("profile", DIMENSIONS)
@pytest.mark.parametrize("element_type", TYPES)
def test_below_the_yield_stress_nothing_changes(beam, element_type, profile):
    elastic = beam(element_type, section(profile, None))
    plastic = beam(element_type, section(profile, np.array([[1e3, 0.0]])))
    u = 1e-4 * np.random.default_rng(2).normal(size=elastic.unknowns)
    (force, k, energy), (other, other_k, other_energy) = elastic(u), plastic(u)
    np.testing.assert_allclose(other, force, atol=1e-12 * abs(force).max())
    np.testing.assert_allclose(other_k, k, atol=1e-12 * abs(k).max())
    np.testing.assert_allclose(other_energy, energy, atol=1e-12 * energy[1])


@pytest.mark.parametrize("profile", ["RECT", "BOX"])
@pytest.mark.parametrize("element_type", TYPES)
def test_an_increment_begins_elastically_after_one_with_plastic_strain(beam, element_type, profile):
    """Stresses at the points are the yield stress but for rounding, which would choose the tangent otherwise."""
    evaluate = beam(element_type, section(profile, HARDENING))
    elastic = evaluate(np.zeros(evaluate.unknowns))[1]
    for u in 0.05 * np.random.default_rng(2).normal(size=(10, evaluate.unknowns)):
        assert abs(evaluate(u, commit=True)[1] - elastic).max() > 0.1 * abs(elastic).max()
        np.testing.assert_allclose(evaluate(u)[1], elastic, atol=1e-9 * abs(elastic).max())


def plastic_modulus(profile, dimension):
    """First moments of both halves about the line that halves the area: M/yield."""
    if profile == "RECT":
        a, b = DIMENSIONS["RECT"]
        return a * b**2 / 4
    if profile == "CIRC":
        return 4 / 3 * DIMENSIONS["CIRC"][0] ** 3
    if profile == "PIPE":
        outside, t = DIMENSIONS["PIPE"]
        return 4 * (outside - t / 2) ** 2 * t
    a, b, t = DIMENSIONS["BOX"][:3]
    # lines in the middle of the walls
    return (a - t) * t * (b - t) + 2 * t * (b - t) ** 2 / 4


@pytest.mark.sample(3)
@pytest.mark.parametrize("profile", ["RECT", "CIRC", "PIPE", "BOX"])
@pytest.mark.parametrize("element_type", TYPES)
def test_plastic_moment(beam, element_type, profile):
    """Bent until nothing is elastic: 1.5 times the first yield moment of a rectangle, 16/(3 pi) that of a circle."""
    dimension = BEAM[element_type].dimension
    evaluate = beam(element_type, section(profile))
    for curvature in np.linspace(0, 1, 21)[1:]:
        evaluate(bent(evaluate, element_type, curvature), commit=True)
    found = values_of(evaluate)
    # eight parts of a circle instead of all of it: pi/8 (1 + sqrt(2)) of the first moment
    loss = np.pi / 8 * (1 + np.sqrt(2)) if profile == "PIPE" or (profile == "CIRC" and dimension == 3) else 1.0
    modulus = loss * plastic_modulus(profile, dimension)
    # the fibre in the middle stays elastic, but has no arm
    assert found["SM1"][0] == pytest.approx(YIELD * modulus, rel=1e-9)
    if profile == "RECT":
        a, b = DIMENSIONS["RECT"]
        assert found["SM1"][0] == pytest.approx(1.5 * YIELD * a * b**2 / 6, rel=1e-9)
    assert found["S11"].max() == pytest.approx(YIELD)
    place = section_points(section(profile), dimension).place[:, 1]
    np.testing.assert_allclose(found["E11"], place, atol=1e-12)
    yielding = abs(place) > YIELD / E
    np.testing.assert_allclose(found["PE11"], np.where(yielding, place - found["S11"] / E, 0), atol=1e-12)
    np.testing.assert_allclose(found["PEEQ"], abs(found["PE11"]), atol=1e-12)


def test_plastic_moment_of_unequal_flanges(beam):
    """The line of zero stress halves the area: it is in the flange that has more than half of it."""
    evaluate = beam("B31", section("I"))
    free = 0.0
    for curvature in np.linspace(0, 0.5, 51)[1:]:
        # strain of the nodes at which there is no axial force, by Newton
        for _ in range(30):
            force, k, _ = evaluate(bent(evaluate, "B31", curvature, free))
            stretch = bent(evaluate, "B31", 0.0, 1.0)
            if abs(force[6]) < 1e-10:
                break
            free -= force[6] / (k @ stretch)[6]
        evaluate(bent(evaluate, "B31", curvature, free), commit=True)
    points = section_points(section("I"), 3)
    # fully plastic: the sign of the stress changes where the area above is that below
    heights = points.place[:, 1]
    assert abs(values_of(evaluate)["SF1"][0]) < 1e-9
    levels = np.unique(heights.round(9))
    area = np.array([points.area[abs(heights - level) < 1e-6].sum() for level in levels])
    below = np.cumsum(area)
    neutral = levels[np.searchsorted(below, below[-1] / 2)]
    # the fibres at the neutral line have what equilibrium needs, and no arm about it
    expected = YIELD * (area * abs(levels - neutral)).sum()
    assert values_of(evaluate)["SM1"][0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("profile", "limit", "loss"),
    [
        ("CIRC", 2 * np.pi / 3 * 0.5**3, 0.0),
        ("PIPE", 2 * np.pi * 0.49**2 * 0.02, 0.0),
        ("BOX", 2 * 0.78 * 0.58 * 0.02, 0.0),
        # the heap of sand on the rectangle, twice its volume; the points keep the directions of the elastic shear
        ("RECT", 0.4**2 * (3 * 0.7 - 0.4) / 6, 0.05),
    ],
)
def test_plastic_torque(beam, profile, limit, loss):
    """Mises: shear yield stress yield/sqrt(3) (A. Nadai, Theory of Flow and Fracture of Solids I, 1950, chapter 35)."""
    evaluate = beam("B31", section(profile))
    for twist in np.linspace(0, 2, 41)[1:]:
        force, _, energy = evaluate(bent(evaluate, "B31", twist=twist), commit=True)
    found = values_of(evaluate)
    assert found["SM3"][0] == pytest.approx(YIELD / np.sqrt(3) * limit, rel=loss or 1e-9)
    assert force[9] == pytest.approx(found["SM3"][0])
    elastic = YIELD / np.sqrt(3) / G
    lever = section_points(section(profile), 3).lever
    np.testing.assert_allclose(found["PE12"], np.maximum(2 * lever - elastic, 0), atol=1e-12)
    # the work of the torque: trapezoidal rule over the increments
    assert energy[1] + energy[3] == pytest.approx(0.5 * 2 * found["SM3"][0] * 2 * 2, rel=0.02 + loss)


def test_tension_and_torsion_of_a_tube(beam):
    """Ideally plastic, far along one direction: the plastic strains have it, and S11 : 3 S12 are as their rates."""
    evaluate = beam("B31", section("PIPE"))
    radius = 0.49
    for size in np.geomspace(1e-3, 1.0, 60):
        evaluate(bent(evaluate, "B31", strain=size, twist=size / radius), commit=True)
    found = values_of(evaluate)
    norm = np.sqrt(1 + 1 / 3)
    np.testing.assert_allclose(found["S11"], YIELD / norm, rtol=1e-6)
    np.testing.assert_allclose(found["S12"], YIELD / 3 / norm, rtol=1e-6)
    mises = np.sqrt(found["S11"] ** 2 + 3 * found["S12"] ** 2)
    np.testing.assert_allclose(mises, YIELD, rtol=1e-9)


def test_hardening_in_combined_stress_is_that_of_space(beam, forces_of_solid_path):
    """The same strains 11 and 12 in a solid that is free sideways: its own return mapping."""
    evaluate = beam("B31", section("PIPE", HARDENING))
    for strain, shear in forces_of_solid_path.path:
        evaluate(bent(evaluate, "B31", strain=strain, twist=shear / 0.49), commit=True)
        found = values_of(evaluate)
        expected = forces_of_solid_path(strain, shear)
        np.testing.assert_allclose([found["S11"][0], found["S12"][0]], expected, atol=1e-7 * YIELD)


@pytest.fixture
def forces_of_solid_path():
    """S11 and S12 of three-dimensional Mises plasticity with zero other stresses, increment by increment."""

    class Solid:
        path = ((0.001, 0.001), (0.004, 0.002), (0.006, 0.010), (0.003, 0.015), (-0.01, 0.0))

        def __init__(self):
            self.plastic, self.equivalent = np.zeros(6), 0.0

        def __call__(self, strain, shear):
            bulk = E / (3 * (1 - 2 * NU))
            lateral = -NU * strain
            for _ in range(100):
                # tensor components 11, 22, 33, 12, 13, 23
                total = np.array([strain, lateral, lateral, shear / 2, 0, 0])
                elastic = total - self.plastic
                mean = elastic[:3].sum() / 3
                deviator = 2 * G * (elastic - mean * np.array([1, 1, 1, 0, 0, 0]))
                norm = np.sqrt((deviator[:3] ** 2).sum() + 2 * (deviator[3:] ** 2).sum())
                q, multiplier = np.sqrt(1.5) * norm, 0.0
                if q > np.interp(self.equivalent, HARDENING[:, 1], HARDENING[:, 0]):
                    low, high = 0.0, q / (3 * G)
                    for _ in range(200):
                        multiplier = (low + high) / 2
                        flow = np.interp(self.equivalent + multiplier, HARDENING[:, 1], HARDENING[:, 0])
                        low, high = (multiplier, high) if q - 3 * G * multiplier > flow else (low, multiplier)
                factor = 1 - 3 * G * multiplier / q if q else 1.0
                stress = factor * deviator + 3 * bulk * mean * np.array([1, 1, 1, 0, 0, 0])
                if abs(stress[1]) < 1e-10:
                    break
                # secant in the lateral strain; between the shear and the bulk response
                lateral -= stress[1] / (2 * (bulk + G / 3))
            self.plastic = self.plastic + 1.5 * multiplier * deviator / (q or 1.0)
            self.equivalent += multiplier
            return stress[0], stress[3]

    return Solid()


@pytest.mark.sample(3)
@pytest.mark.parametrize("large", [False, True], ids=["small", "NLGEOM"])
@pytest.mark.parametrize("profile", DIMENSIONS)
@pytest.mark.parametrize("element_type", TYPES)
def test_tangent_is_the_derivative_of_the_forces(beam, element_type, profile, large):
    """In the second plastic increment, in all unknowns."""
    evaluate = beam(element_type, section(profile, HARDENING), large=large)
    random = np.random.default_rng(4)
    first = 0.01 * random.normal(size=evaluate.unknowns)
    evaluate(first, commit=True)
    u = first + 0.01 * random.normal(size=evaluate.unknowns)
    assert values_of(evaluate)["PEEQ"].max() > 1e-3
    _, k, _ = evaluate(u)
    step = 1e-7
    pairs = [(evaluate(u + d)[0], evaluate(u - d)[0]) for d in step * np.eye(len(u))]
    slopes = np.array([one - other for one, other in pairs]).T / (2 * step)
    np.testing.assert_allclose(k, slopes, atol=2e-6 * abs(k).max())


def test_unloading_is_elastic(beam):
    """After a plastic hinge the moment falls along EI; then stresses in equilibrium remain."""
    evaluate = beam("B21", section("RECT"))
    a, b = DIMENSIONS["RECT"]
    bending = E * a * b**3 / 12
    top = 6 * YIELD / (E * b / 2)
    for curvature in np.linspace(0, top, 13)[1:]:
        evaluate(bent(evaluate, "B21", curvature), commit=True)
    loaded = values_of(evaluate)
    back = top - loaded["SM1"][0] / bending
    _, _, energy = evaluate(bent(evaluate, "B21", back), commit=True)
    left = values_of(evaluate)
    assert left["SM1"][0] == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(left["PE11"], loaded["PE11"], atol=1e-15)
    # the stress at the surface is what the elastic moment takes from the yield stress
    assert left["S11"][-1] == pytest.approx(YIELD - loaded["SM1"][0] * b / 2 * E / bending)
    area = section_points(section("RECT"), 2).area
    assert area @ left["S11"] == pytest.approx(0, abs=1e-14)
    # what the residual stresses store
    assert energy[1] == pytest.approx(2.0 * area @ left["S11"] ** 2 / (2 * E))
    assert energy[3] > 0


COLUMN = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE={type}, ELSET=BEAM
{elements}
*NSET, NSET=ROOT
1
*NSET, NSET=END
{last}
*MATERIAL, NAME=STUFF
{material}
*BEAM SECTION, ELSET=BEAM, MATERIAL=STUFF, SECTION={section}
0., 0., -1.
{shear}
{before}
*STEP{options}
*STATIC
0.1, 1., 1e-5, 0.1
*BOUNDARY
{held}
{step}
*OUTPUT, FIELD
*ELEMENT OUTPUT
E, S, PE, PEEQ, SDV, SF
*OUTPUT, HISTORY
*NODE OUTPUT, NSET=ALL
U, RF
*END STEP
"""
PLASTIC = "*ELASTIC\n1000., 0.25\n*PLASTIC\n2., 0."


@pytest.fixture
def run_beams(run_deck):
    """Run beams along x."""

    def run_beams(element_type="B31", count=1, length=2.0, *, user=None, **more):
        text = {
            "material": PLASTIC,
            "section": "RECT\n0.4, 0.7",
            "held": "ROOT, ENCASTRE",
            "step": "",
            "before": "",
            "options": "",
            "shear": "",
        } | more
        per = BEAM[element_type].nodes - 1
        last = per * count + 1
        nodes = "\n".join(f"{k + 1}, {length * k / (last - 1)!r}, 0., 0." for k in range(last))
        elements = "\n".join(", ".join(map(str, (k + 1, *range(per * k + 1, per * (k + 1) + 2)))) for k in range(count))
        return run_deck(COLUMN.format(nodes=nodes, elements=elements, last=last, type=element_type, **text), user)

    return run_beams


@pytest.mark.parametrize("element_type", ["B21", "B31"])
def test_collapse_of_a_clamped_beam(run_beams, element_type):
    """Hinges at both ends and in the middle, where linear elements have their points: P (L/2 - h) = 4 M."""
    count, length = 8, 8.0
    middle = count // 2 + 1
    # by symmetry the middle does not turn: with a hinge on both sides nothing else would hold it
    held = f"ROOT, ENCASTRE\nEND, ENCASTRE\n{middle}, 2, 2, -0.5\n{middle}, 6"
    found = run_beams(element_type, count, length, held=held).history
    hinge, h = YIELD * 0.4 * 0.7**2 / 4, length / count
    # first-order convergence towards 8 M/L; the hinges harden by nothing
    assert -found[f"RF2[ALL:{middle}]"][-1] == pytest.approx(4 * hinge / (length / 2 - h), rel=1e-6)


@pytest.mark.sample(2)
@pytest.mark.parametrize("element_type", TYPES)
def test_output_at_section_points(run_beams, element_type):
    found = run_beams(element_type, held="ROOT, ENCASTRE\nEND, 1, 1, 0.01")
    numbers = (1, 5) if BEAM[element_type].dimension == 2 else (1, 5, 21, 25)
    for number in numbers:
        assert float(found.field(f"S11_SP{number}")[0]) == pytest.approx(2.0, rel=1e-6)
        assert float(found.field(f"PE11_SP{number}")[0]) == pytest.approx(0.003, rel=1e-6)
        assert float(found.field(f"PEEQ_SP{number}")[0]) == pytest.approx(0.003, rel=1e-6)
    assert float(found.field("SF1")[0]) == pytest.approx(2.0 * 0.28, rel=1e-6)


@pytest.mark.sample(2)
@pytest.mark.parametrize("element_type", TYPES)
def test_thermal_expansion(run_beams, element_type):
    """Free: the thermal strain and no stress; held: the stress -E alpha dT until it yields."""
    material = "*ELASTIC\n1000., 0.25\n*EXPANSION\n1e-4"
    heat = "*TEMPERATURE\nALL, 15."
    free = run_beams(element_type, material=material, step=heat)
    last = BEAM[element_type].nodes
    assert free.history[f"U1[ALL:{last}]"][-1] == pytest.approx(2 * 1e-4 * 15, rel=1e-9)
    assert float(free.field("S11_SP1")[0]) == pytest.approx(0, abs=1e-9)
    held = run_beams(element_type, material=material, step=heat, held="ROOT, ENCASTRE\nEND, ENCASTRE")
    assert held.history["RF1[ALL:1]"][-1] == pytest.approx(1000 * 1e-4 * 15 * 0.28, rel=1e-9)
    beyond = run_beams(
        element_type, material=f"{material}\n*PLASTIC\n1., 0.", step=heat, held="ROOT, ENCASTRE\nEND, ENCASTRE"
    )
    assert float(beyond.field("S11_SP5")[0]) == pytest.approx(-1.0, rel=1e-6)
    assert float(beyond.field("PE11_SP5")[0]) == pytest.approx(-(1e-4 * 15 - 1e-3), rel=1e-5)


def test_temperature_that_varies_along_the_axis(run_beams):
    """Of three nodes the strain of each point is that between them: the mean is (1 + 4 + 1)/6 of theirs."""
    heat = "*TEMPERATURE\n1, 0.\n2, 30.\n3, 15."
    found = run_beams("B32", material="*ELASTIC\n1000., 0.25\n*EXPANSION\n1e-4", step=heat).history
    assert found["U1[ALL:3]"][-1] == pytest.approx(2 * 1e-4 * (4 * 30 + 15) / 6, rel=1e-9)


def test_moduli_by_a_field(run_beams):
    """*ELASTIC, DEPENDENCIES: the field is given at the nodes."""
    material = "*ELASTIC, DEPENDENCIES=1\n1000., 0.25, , 0.\n500., 0.25, , 1."
    field = "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1\nALL, 0.5"
    found = run_beams("B31", material=material, before=field, step="*CLOAD\nEND, 1, 2.\nEND, 4, 0.3").history
    assert found["U1[ALL:2]"][-1] == pytest.approx(2 * 2.0 / (750 * 0.28), rel=1e-9)
    twist = 2 * 0.3 / (750 / 2.5 * profile_of(section("RECT"), 3).torsion)
    assert found["UR1[ALL:2]"][-1] == pytest.approx(twist, rel=1e-9)


USDFLD = f"""      INCLUDE '{HERE / "usdfld.inc"}'
      CALL GETVRM('E',ARRAY,JARRAY,FLGRAY,JRCD,JMAC,JMATYP,MATLAYO,LACCFLA)
      FIELD(1) = MAX(ABS(ARRAY(1)), STATEV(1))
      STATEV(1) = FIELD(1)
      STATEV(2) = NPT + 10*KSPT + 1000*LAYER + 10000*NDI + 100000*NSHR
      STATEV(3) = COORD(2) + 100*COORD(3)
      IF (ABS(DIRECT(1,1) - 1) + ABS(DIRECT(3,2) + 1) .GT. 1E-12) CALL XIT
      END
"""


def test_damage_by_the_largest_strain(run_beams):
    """USDFLD at the section points: the field is the strain at the start of the increment."""
    material = "*ELASTIC, DEPENDENCIES=1\n1000., 0.25, , 0.\n500., 0.25, , 0.01\n*USER DEFINED FIELD\n*DEPVAR\n3"
    step = "*CLOAD\nEND, 1, 1.4"
    found = run_beams("B31", material=material, step=step, user=USDFLD)
    largest = 0.0
    for k in range(1, 11):
        strain, stress = (float(found.field(f"{name}_SP25", increment=k)[0]) for name in ("E11", "S11"))
        assert stress == pytest.approx(np.interp(largest, [0, 0.01], [1000, 500]) * strain, rel=1e-6)
        # within the tolerance of the iteration
        assert stress == pytest.approx(1.4 * k / 10 / 0.28, rel=5e-3)
        largest = max(largest, strain)
    assert float(found.field("SDV2_SP21")[0]) == 1 + 10 * 21 + 1000 + 10000 + 100000
    # direction 1 is -z, direction 2 is y
    assert float(found.field("SDV3_SP5")[0]) == pytest.approx(-0.35 - 100 * 0.2, rel=1e-6)


UMAT = f"""      INCLUDE '{HERE / "umat.inc"}'
      DO I = 1, NTENS
        DO J = 1, NTENS
          DDSDDE(I,J) = 0
        END DO
        DDSDDE(I,I) = PROPS(MIN(I,2))
      END DO
      DO I = 1, NTENS
        STRESS(I) = STRESS(I) + DDSDDE(I,I)*DSTRAN(I)
        SSE = SSE + STRESS(I)*DSTRAN(I)
      END DO
      STATEV(1) = NDI + 10*NSHR + 100*NTENS + 1000*NPT + 10000*KSPT
      STATEV(2) = STRAN(1) + DSTRAN(1)
      END
"""
USER = "*USER MATERIAL, CONSTANTS=2\n1000., 400.\n*DEPVAR\n2"
SHEAR = "*TRANSVERSE SHEAR STIFFNESS\n95.2, 95.2"
"""0.85 G A of the rectangle."""


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("element_type", "profile", "code"),
    [
        ("B21", "RECT\n0.4, 0.7", 1 + 100 + 1000),
        ("B32", "RECT\n0.4, 0.7", 1 + 10 + 200 + 1500),
        ("B31", "CIRC\n0.3", 1 + 10 + 200 + 1000),
        ("B22", "I\n0.3, 0.7, 0.4, 0.3, 0.02, 0.02, 0.01", 1 + 100 + 1500),
    ],
)
def test_user_material(run_beams, element_type, profile, code):
    """An elastic UMAT makes an elastic beam; NDI, NSHR and the points are those of Abaqus."""
    loads = "*CLOAD\nEND, 2, 0.05\nEND, 6, 0.02\nEND, 1, 0.3"
    if BEAM[element_type].dimension == 3:
        loads += "\nEND, 4, 0.03\nEND, 3, 0.04"
    given = {"section": profile, "shear": SHEAR, "step": loads}
    elastic = run_beams(element_type, material="*ELASTIC\n1000., 0.25", **given).history
    user = run_beams(element_type, material=USER, user=UMAT, **given)
    for name, values in elastic.items():
        np.testing.assert_allclose(user.history[name], values, rtol=1e-8, atol=1e-11, err_msg=name)
    # the mean over the integration points
    point = 3 if "CIRC" in profile else 5
    assert float(user.field(f"SDV1_SP{point}")[0]) == pytest.approx(code + 10000 * point)


@pytest.mark.parametrize(
    ("element_type", "more", "message"),
    [
        ("B31", {"material": USER}, r"elements of type B31 with \*USER MATERIAL need \*TRANSVERSE SHEAR STIFFNESS"),
        (
            "B31",
            {"material": USER, "section": "I\n0.3, 0.7, 0.4, 0.3, 0.02, 0.02, 0.01", "shear": SHEAR},
            r"\*USER MATERIAL is not supported for elements of type B31 with SECTION=I: their torsion needs the shear",
        ),
        (
            "B31",
            {
                "material": USER,
                "shear": SHEAR,
                "before": "*INITIAL CONDITIONS, TYPE=SOLUTION, USER",
            },
            r"SDVINI is not supported for elements of type B31",
        ),
        ("B31", {"material": "*ELASTIC\n1., 0.\n*PLASTIC\n-1., 0."}, r"\*PLASTIC"),
    ],
)
def test_what_is_refused(run_beams, element_type, more, message):
    with pytest.raises(DeckError, match=r"deck\.inp:\d+: .*" + message):
        run_beams(element_type, user=UMAT if "USER" in more.get("material", "") else None, **more)
