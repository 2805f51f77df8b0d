# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Built-in continuum shells, element by element: rigid motions, rank, tangent, constant strains, section, mass."""

from dataclasses import replace

import numpy as np
import pytest
from shell_decks import values_of

from uel.elements import Request
from uel.errors import DeckError, KernelError, Source
from uel.model.element_types import CONTINUUM_SHELL
from uel.model.mesh import ElementGroup
from uel.model.properties import (
    Elastic,
    ElasticType,
    Material,
    Orientation,
    Plastic,
    ShellLayer,
    ShellSection,
    UserMaterial,
)

SOURCE = Source("test.inp", 7)
E, NU, T = 1000.0, 0.3, 0.2
G = E / (2 * (1 + NU))
K = 5 / 6 * G
"""Transverse shear stiffness over the thickness."""
TYPES = tuple(CONTINUUM_SHELL)
CORNERS = np.array([[0.0, 0, 0], [2.1, 0.2, 0], [1.8, 1.9, 0], [-0.1, 1.4, 0]])
SHIFTS = np.array([[0.1, 0.0, 0.2], [-0.1, 0.15, 0.35], [0.05, -0.1, 0.25], [0.0, 0.1, 0.3]])
"""From the bottom to the top, of an element that is warped and has another thickness at each node."""
STEEL = Material("M", SOURCE, Elastic(ElasticType.ISOTROPIC, (E, NU), SOURCE), density=5.0)
# E1, E2, nu12, G12, G13, G23
PLY = Material("PLY", SOURCE, Elastic(ElasticType.LAMINA, (1000.0, 50.0, 0.25, 30.0, 30.0, 20.0), SOURCE), density=2.0)
USER = Material("USER", SOURCE, user=UserMaterial(np.ones(1), False, SOURCE))
LAMINATE = tuple(ShellLayer(t, 3, PLY, angle) for t, angle in ((0.05, 0.0), (0.1, 45.0), (0.07, -30.0)))
ONE = (ShellLayer(T, 5, STEEL),)
ROTATED = {1: [0, 3, 7, 4, 1, 2, 6, 5], 2: [0, 4, 5, 1, 3, 7, 6, 2], 3: list(range(8))}
"""Local nodes of the bottom and of the top, by the parent coordinate from the one to the other (Analysis User's Guide,
Shell elements: overview)."""


def shell_section(layers=ONE, *, orientation=None, **options):
    return ShellSection("ALL", tuple(layers), orientation, 0.0, False, SOURCE, **options)


def prism(element_type, shift=(0.0, 0.0, T), warp=(0.0, 0.0, 0.0, 0.0)):
    """(nodes, 3) an element between two alike faces."""
    bottom = CORNERS[: CONTINUUM_SHELL[element_type].nodes // 2].copy()
    bottom[:, 2] += warp[: len(bottom)]
    return np.vstack([bottom, bottom + shift])


def distorted(element_type):
    bottom = prism(element_type, warp=(0.1, -0.2, 0.15, 0.05))[: CONTINUUM_SHELL[element_type].nodes // 2]
    return np.vstack([bottom, bottom + SHIFTS[: len(bottom)]])


@pytest.fixture
def shell(response):
    """Force, tangent and energies of an element by its displacements, node by node."""

    def shell(element_type, section, x, *, nlgeom=False, user=None):
        group = ElementGroup(element_type, np.array([1]), np.arange(len(x))[None], "", section, None, SOURCE)
        return response(group, x, nlgeom=nlgeom, user=user)

    return shell


def rigid_motions(x):
    """(6, unknowns) displacements of three translations and three rotations."""
    translations = [np.tile(axis, len(x)) for axis in np.eye(3)]
    return np.array([*translations, *(np.cross(axis, x).ravel() for axis in np.eye(3))])


def rotation(seed):
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return axes * np.linalg.det(axes)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("layers", [ONE, LAMINATE], ids=["one", "laminate"])
@pytest.mark.parametrize("shape", [prism, distorted])
def test_rigid_motions_are_all_that_cost_nothing(shell, element_type, layers, shape):
    x = shape(element_type)
    force, k, _ = shell(element_type, shell_section(layers), x)(np.zeros(x.size))
    assert not force.any()
    np.testing.assert_allclose(k, k.T, atol=1e-12 * abs(k).max())
    np.testing.assert_allclose(k @ rigid_motions(x).T, 0, atol=1e-11 * abs(k).max())
    scale = np.sqrt(np.diag(k))
    values = np.linalg.eigvalsh(k / np.outer(scale, scale))
    assert (values < 1e-10).sum() == 6
    assert values.min() > -1e-10


def constant_strain(seed=11):
    """(3, 3) gradient of the displacements, its symmetric part, and plane-stress strains 11, 22, 12."""
    gradient = 1e-3 * np.random.default_rng(seed).normal(size=(3, 3))
    e = (gradient + gradient.T) / 2
    return gradient, e, np.array([e[0, 0], e[1, 1], 2 * e[0, 1]])


def plane_stress():
    return E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("shift", [(0.0, 0.0, T), (0.15, -0.1, T)], ids=["upright", "tilted"])
@pytest.mark.parametrize("poisson", [None, 0.2, "ELASTIC"])
def test_constant_strain(shell, element_type, shift, poisson):
    """Stresses of plane stress, and the energy of all: that of the stress across and of the transverse shear too.

    The thickness modulus is twice the shear modulus, Poisson's ratio 0.5 by default (Keywords Guide, *SHELL SECTION).
    """
    x = prism(element_type, shift)
    gradient, e, plane = constant_strain()
    section = shell_section(poisson=poisson, slenderness=0.0)
    evaluate = shell(element_type, section, x)
    force, _, energy = evaluate(x @ gradient.T)
    stress = plane_stress() @ plane
    np.testing.assert_allclose(values_of(evaluate, "S11", "S22", "S12"), np.tile(stress, (5, 1)), rtol=1e-9)
    nu = {None: 0.5, "ELASTIC": NU}.get(poisson, poisson)
    effective = e[2, 2] + nu / (1 - nu) * (e[0, 0] + e[1, 1])
    per_volume = 0.5 * (stress @ plane + 2 * G * effective**2 + K * (2 * e[:2, 2]) @ (2 * e[:2, 2]))
    volume = T * area_of(x)
    assert energy[1] == pytest.approx(per_volume * volume, rel=1e-9)
    assert energy[5] == pytest.approx(0, abs=1e-12 * energy[1])
    assert 0.5 * force @ (x @ gradient.T).ravel() == pytest.approx(energy[1], rel=1e-9)


def area_of(x):
    px, py = x[: len(x) // 2, :2].T
    return 0.5 * (px @ np.roll(py, -1) - py @ np.roll(px, -1))


@pytest.mark.parametrize("direction", [1, 2, 3])
def test_stack_direction(shell, direction):
    """The element with its nodes in another order, and the direction that belongs to it, is the same."""
    x = distorted("SC8R")
    order = ROTATED[direction]
    other = np.empty_like(x)
    other[order] = x
    u = 1e-3 * np.random.default_rng(3).normal(size=x.shape)
    v = np.empty_like(u)
    v[order] = u
    force, _, energy = shell("SC8R", shell_section(LAMINATE), x)(u)
    found, _, same = shell("SC8R", shell_section(LAMINATE, stack=direction), other)(v)
    np.testing.assert_allclose(found.reshape(-1, 3)[order].ravel(), force, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(same, energy, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("upright", [True, False])
def test_stack_direction_by_an_orientation(shell, element_type, upright):
    """It points along the axis of the orientation: the first layer is where that comes from.

    The axis is direction 3; numbered from the other side the element has the same stresses.
    """
    x = prism(element_type)
    if not upright:
        x = x[{"SC8R": [4, 7, 6, 5, 0, 3, 2, 1], "SC6R": [3, 5, 4, 0, 2, 1]}[element_type]]
    orientation = Orientation("O", np.eye(3), SOURCE, normal=3)
    soft = replace(STEEL, name="SOFT", elastic=Elastic(ElasticType.ISOTROPIC, (E / 10, NU), SOURCE))
    section = shell_section([ShellLayer(0.1, 3, soft), ShellLayer(0.1, 3, STEEL)], orientation=orientation, stack=None)
    evaluate = shell(element_type, section, x)
    evaluate(x @ np.diag([1e-3, 0, 0]))
    stress = E / (1 - NU**2) * 1e-3
    expected = np.repeat([stress / 10, stress], 3)
    np.testing.assert_allclose(values_of(evaluate, "S11")[:, 0], expected, rtol=1e-9)


@pytest.mark.parametrize("direction", [0, 1])
def test_stack_direction_by_an_orientation_along_an_edge(shell, direction):
    """Of a cube the parent coordinate along the axis is the one across."""
    x = np.array([[i, j, k] for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    orientation = Orientation("O", np.eye(3), SOURCE, normal=direction + 1)
    evaluate = shell("SC8R", shell_section(orientation=orientation, stack=None, poisson=0.0), x)
    strain = np.zeros((3, 3))
    strain[direction, direction] = 1e-3
    _, _, energy = evaluate(x @ strain)
    # only the thickness modulus resists what is across
    assert energy[1] == pytest.approx(0.5 * 2 * G * 1e-6)


@pytest.mark.parametrize("element_type", TYPES)
def test_large_rotation_costs_nothing(shell, element_type):
    x, turn = distorted(element_type), rotation(5)
    evaluate = shell(element_type, shell_section(LAMINATE), x, nlgeom=True)
    force, k, energy = evaluate(x @ (turn - np.eye(3)).T)
    np.testing.assert_allclose(force, 0, atol=1e-12 * abs(k).max())
    np.testing.assert_allclose(energy, 0, atol=1e-20 * abs(k).max())


@pytest.mark.parametrize("element_type", TYPES)
def test_forces_turn_with_the_element(shell, element_type):
    x, turn = distorted(element_type), rotation(5)
    u = 0.02 * np.random.default_rng(7).normal(size=x.shape)
    evaluate = shell(element_type, shell_section(LAMINATE), x, nlgeom=True)
    force, _, energy = evaluate(u)
    turned, k, same = evaluate((x + u) @ turn.T - x)
    np.testing.assert_allclose(turned.reshape(-1, 3), force.reshape(-1, 3) @ turn.T, atol=1e-11 * abs(k).max())
    np.testing.assert_allclose(same, energy, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("plastic", [False, True])
def test_tangent_is_the_derivative_of_the_forces(shell, element_type, nlgeom, plastic):
    hardening = Plastic(np.array([[1.0, 0.0], [11.0, 0.1]]), SOURCE) if plastic else None
    section = shell_section([ShellLayer(T, 5, replace(STEEL, plastic=hardening))])
    x = distorted(element_type)
    evaluate, step = shell(element_type, section, x, nlgeom=nlgeom), 1e-7
    u = 3e-3 * np.random.default_rng(7).normal(size=x.size)
    if nlgeom:
        u = ((x + u.reshape(x.shape)) @ rotation(5).T - x).ravel()
    _, k, energy = evaluate(u)
    assert (energy[3] > 1e-3 * energy[1]) == plastic
    found = np.array([evaluate(u + d)[0] - evaluate(u - d)[0] for d in step * np.eye(len(u))]).T / (2 * step)
    np.testing.assert_allclose(k, found, atol=1e-6 * abs(k).max())


def ply_stiffness(angle):
    """(3, 3) stiffness of plane stress along the section's directions, by turning the tensor."""
    e1, e2, nu12, g12 = PLY.elastic.constants[:4]
    q = np.linalg.inv([[1 / e1, -nu12 / e1, 0], [-nu12 / e1, 1 / e2, 0], [0, 0, 1 / g12]])
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    return turn.T @ q @ turn


def laminate_stiffness(thickness):
    """(6, 6) A, B and D of classical laminate theory of the layers in proportion, about the middle."""
    scale = thickness / sum(layer.thickness for layer in LAMINATE)
    bottom, found = -thickness / 2, np.zeros((6, 6))
    for layer in LAMINATE:
        top = bottom + scale * layer.thickness
        parts = [(top**n - bottom**n) / n for n in (1, 2, 3)]
        found += np.kron([[parts[0], parts[1]], [parts[1], parts[2]]], ply_stiffness(layer.angle))
        bottom = top
    return found


@pytest.mark.parametrize("element_type", TYPES)
@pytest.mark.parametrize("thickness", [0.22, 0.3])
def test_laminate(shell, element_type, thickness):
    """Constant strains and curvatures give the forces and moments of classical laminate theory.

    Layers share the distance of the faces in proportion to their thicknesses.
    """
    x = prism(element_type, (0.0, 0.0, thickness))
    x[:, 2] -= thickness / 2
    strains = 1e-3 * np.array([1.0, -0.4, 0.7, 2.0, -1.5, 0.8])
    e, k = ((np.array([[a, c / 2], [c / 2, b]])) for a, b, c in strains.reshape(2, 3))
    u = np.zeros((len(x), 3))
    u[:, :2] = x[:, :2] @ e + x[:, 2:] * (x[:, :2] @ k)
    u[:, 2] = -0.5 * np.einsum("ni,ij,nj->n", x[:, :2], k, x[:, :2])
    evaluate = shell(element_type, shell_section(LAMINATE), x)
    evaluate(u)
    expected = laminate_stiffness(thickness) @ strains
    found = values_of(evaluate, "SF1", "SF2", "SF3", "SM1", "SM2", "SM3")
    np.testing.assert_allclose(found, np.tile(expected, (len(found), 1)), rtol=1e-9)


def test_thickness_modulus_of_layers(shell):
    """The stress across is the same in all layers: half the harmonic mean of their shear moduli, twice each."""
    soft = replace(STEEL, name="SOFT", elastic=Elastic(ElasticType.ISOTROPIC, (E / 10, NU), SOURCE))
    layers = [ShellLayer(0.05, 3, soft), ShellLayer(0.15, 3, STEEL)]
    x = prism("SC8R")
    _, _, energy = shell("SC8R", shell_section(layers), x)(x @ np.diag([0, 0, 1e-3]))
    modulus = T / (0.05 / (2 * G / 10) + 0.15 / (2 * G))
    assert energy[1] == pytest.approx(0.5 * modulus * 1e-6 * T * area_of(x))


def test_thickness_modulus_of_the_deck(shell):
    x = prism("SC8R")
    _, _, energy = shell("SC8R", shell_section(modulus=70.0), x)(x @ np.diag([0, 0, 1e-3]))
    assert energy[1] == pytest.approx(0.5 * 70 * 1e-6 * T * area_of(x))


@pytest.mark.parametrize("given", [False, True])
def test_transverse_shear(shell, given):
    """Stiffness by force and strain; that of elastic layers is of the thickness of the element."""
    thickness = 0.3
    x = prism("SC8R", (0.0, 0.0, thickness))
    section = shell_section(shear=(7.0, 5.0, 1.0) if given else (), slenderness=0.01)
    evaluate = shell("SC8R", section, x)
    evaluate(np.column_stack([0 * x[:, 0], 0 * x[:, 0], 1e-3 * x[:, 0]]))
    expected = 1e-3 * (np.array([7.0, 1.0]) if given else np.array([K * thickness, 0.0]))
    expected = expected / (1 + 0.01 * area_of(x) / thickness**2)
    np.testing.assert_allclose(values_of(evaluate, "SF4", "SF5"), np.tile(expected, (5, 1)), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("element_type", TYPES)
def test_mass(shell, element_type):
    """Volume times the mean density of the layers in each direction, lumped."""
    x = prism(element_type, (0.15, -0.1, T))
    layers = [ShellLayer(0.1, 3, STEEL), ShellLayer(0.3, 3, PLY)]
    _, mass, _ = shell(element_type, shell_section(layers), x)(np.zeros(x.size), request=Request.MASS)
    np.testing.assert_allclose(mass, np.diag(np.diag(mass)))
    density = (0.1 * 5 + 0.3 * 2) / 0.4
    expected = density * T * area_of(x)
    np.testing.assert_allclose(np.diag(mass).reshape(-1, 3).sum(axis=0), expected, rtol=1e-12)


def test_inside_out(shell):
    """Faces in the wrong order are an error that names the element."""
    x = prism("SC8R")[[4, 5, 6, 7, 0, 1, 2, 3]]
    with pytest.raises(KernelError, match="no thickness, or is inside out along its stack direction"):
        shell("SC8R", shell_section(), x)(np.zeros(x.size))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, r"type SC8R with \*USER MATERIAL need \*TRANSVERSE SHEAR STIFFNESS after \*SHELL SECTION"),
        ({"shear": (1.0, 1.0, 0.0)}, r"type SC8R with \*USER MATERIAL need THICKNESS MODULUS \(material USER\)"),
        (
            {"shear": (1.0, 1.0, 0.0), "modulus": 1.0},
            r"type SC8R with \*USER MATERIAL need \*HOURGLASS STIFFNESS after \*SHELL SECTION",
        ),
        (
            {"shear": (1.0, 1.0, 0.0), "modulus": 1.0, "poisson": "ELASTIC"},
            r"POISSON=ELASTIC of elements of type SC8R is supported for one isotropic \*ELASTIC; expected a number",
        ),
    ],
)
def test_what_a_user_material_needs(shell, options, message):
    user = "      subroutine umat()\n      end\n"
    with pytest.raises(DeckError, match=message):
        shell("SC8R", shell_section([ShellLayer(T, 5, USER)], **options), prism("SC8R"), user=user)
