# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The single file for Abaqus does what the installed kernels do: every law, element and option, and the messages."""

from functools import partial

import numpy as np
import pytest
from hypothesis import strategies as st
from random_states import (
    CASES,
    DTIME,
    IN_SPACE,
    SPACE_CASES,
    VARIANTS,
    Crowd,
    SpaceCrowd,
    options,
    properties,
    run_examples,
    separations,
)

STATIC, NLGEOM, DYNAMIC = (1, 0, 0, 0), (1, 1, 0, 0), (11, 0, 0, 0)
ALPHA = -0.2
PARAMS = (ALPHA, 0.25 * (1 - ALPHA) ** 2, 0.5 - ALPHA)
QUAD = [[0.0, 0.0], [1.1, 0.2], [0.9, 1.3], [-0.2, 0.8]]
BRICK = [[0, 0, 0], [1, 0, 0.1], [1.1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 0.8, 1], [0, 1, 0.9]]


def crowd_of(element_of, library, interface, variant, seed, values):
    """Like elements of a library; the same ones for the same seed."""
    jtype, closure = (VARIANTS | IN_SPACE)[variant]
    rng, make = np.random.default_rng(seed), partial(element_of, library)
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    values = options(rng, jtype, closure) | values
    return SpaceCrowd(make, rng, jtype, **values) if variant in IN_SPACE else Crowd(make, interface, jtype, **values)


def assert_same(one, other):
    """RHS, AMATRX, SVARS and ENERGY to rounding: the two are not compiled with the same options."""
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-9 * np.abs(b).max(initial=0.0))


def compare(libraries, element_of, tools, variant, kind, extra, data):
    """Two static increments at random states, then one with NLGEOM and one of *DYNAMIC."""
    _, closure = (VARIANTS | IN_SPACE)[variant]
    values = data.draw(properties(tools.reference, kind, closure, extra))
    seed = data.draw(st.integers(0, 2**32 - 1))
    found = []
    for library in libraries:
        crowd = crowd_of(element_of, library, tools.interface, variant, seed, values)
        rng = np.random.default_rng(seed)
        results = []
        for flags in (STATIC, STATIC, NLGEOM, DYNAMIC):
            ends = separations(rng, values)
            noise = 0.1 * np.linalg.norm(ends, axis=-1).max() * rng.normal(size=(len(ends), crowd.nodes, crowd.dim))
            u = crowd.displacements(ends, noise)
            results += crowd.call("advance", u, DTIME, flags=flags, params=PARAMS)
            results += [crowd.item.block.state(0).svars.copy(), crowd.item.energy.copy()]
        found.append(results)
    assert_same(*found)


@pytest.mark.sample(4)
@pytest.mark.parametrize(("variant", "kind", "extra"), CASES + SPACE_CASES)
def test_interfaces(installed, amalgam, element_of, tools, variant, kind, extra):
    check = partial(compare, (installed, amalgam), element_of)
    run_examples(check, 1, tools, variant, kind, extra, again=True)


@pytest.mark.parametrize(
    ("jtype", "given"),
    [(1, {"PLANE": 0}), (1, {"PLANE": 1}), *((9, {"FORMULATION": k}) for k in (0, 1, 2))],
    ids=lambda value: " ".join(f"{k}={v}" for k, v in value.items()) if isinstance(value, dict) else f"U{value}",
)
def test_continuum_elements(installed, amalgam, element_of, jtype, given):
    coordinates = np.array(QUAD if jtype == 1 else BRICK, dtype=float)
    found = []
    for library in (installed, amalgam):
        item, rng, results = element_of(library, jtype, coordinates, **given), np.random.default_rng(3), []
        for flags in (STATIC, NLGEOM, DYNAMIC):
            u = 1e-2 * rng.normal(size=coordinates.shape)
            results += [*item.advance(u, flags=flags, params=PARAMS), item.block.state(0).svars.copy(), item.energy]
        found.append(results)
    assert_same(*found)
