# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bad input stops the analysis with a message that names element, property, value and what is expected."""

from dataclasses import replace

import numpy as np
import pytest

from uel.errors import KernelError

QUAD = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
FLAT = QUAD[[0, 1, 1, 0]]
EIGHT = np.array([[0, -1], [1, -1], [1, 0], [0, 0], [0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
NODES = {1: QUAD, 2: FLAT, 3: FLAT, 4: EIGHT}


# the texts of the single file have other line ends
@pytest.mark.parametrize("library", ["installed", "amalgam"], indirect=True)
@pytest.mark.parametrize(
    ("jtype", "values", "message"),
    [
        (1, {"THICKNESS": 0.0}, r"U1 element 42: PROPS\(1\) THICKNESS = 0.*: expected a positive value"),
        (1, {"PLANE": 2}, r"U1 element 42: JPROPS\(1\) PLANE = 2: expected 0 to 1"),
        (1, {"FACE": 5}, r"JPROPS\(2\) FACE = 5: expected 0 to 4"),
        (2, {"ALPHAN": -1.0}, r"U2 element 42: PROPS\(2\) ALPHAN = -1.*: expected zero or a positive value"),
        (2, {"ALPHAT": 0.0}, r"PROPS\(3\) ALPHAT = 0.*: expected a positive value"),
        (2, {"ALPHAN": 0.0, "ALPHAT": 0.0}, r"ALPHAN = 0.*: expected.*positive value; 0, an infinite.*CLOSURE = 1"),
        (4, {"ALPHAN": 0.0, "ALPHAT": 0.0}, r"ALPHAN = 0.*: expected.*positive value; 0, an infinite.*CLOSURE = 1"),
        (4, {"ALPHAN": 0.0, "CLOSURE": 1}, r"PROPS\(2\) ALPHAN = 0.*and 0 in both directions"),
        (4, {"ALPHAT": 0.0, "CLOSURE": 1}, r"PROPS\(3\) ALPHAT = 0.*and 0 in both directions"),
        (4, {"BLEND": 1.1}, r"PROPS\(17\) BLEND = 1.1.*a value from 0 to 1"),
        (2, {"BLEND": -0.1}, r"PROPS\(13\) BLEND = -.*a value from 0 to 1"),
        (4, {"FRICTION": -0.1, "CLOSURE": 1}, r"PROPS\(12\) FRICTION = -.*zero or a positive value"),
        (4, {"FRICTION": 0.1}, r"FRICTION = 0.1.*: without the consistent law .CLOSURE = 1 or 3., expected 0"),
        (4, {"CLOSURE": 4}, r"JPROPS\(2\) CLOSURE = 4: expected 0 to 3"),
        (2, {"SIGMAMAX": -30.0}, r"PROPS\(4\) SIGMAMAX = -30.*positive"),
        (2, {"TAUMAX": 0.0}, r"PROPS\(5\) TAUMAX = 0.*positive"),
        (2, {"GIC": -0.1}, r"PROPS\(6\) GIC = -.*positive"),
        (2, {"GIIC": 0.0}, r"PROPS\(7\) GIIC = 0.*positive"),
        (2, {"VISCOSITY": -1.0}, r"PROPS\(12\) VISCOSITY = -1.*zero or a positive value"),
        pytest.param(2, {"ALPHAN": np.nan}, r"PROPS\(2\) ALPHAN = NaN", marks=pytest.mark.nan),
        (2, {"LAW": -1}, r"JPROPS\(1\) LAW = -1: expected 0 to 6"),
        (2, {"INTEGRATION": 2}, r"JPROPS\(2\) INTEGRATION = 2: expected 0 to 1"),
        (2, {"TANGENT": -1}, r"JPROPS\(3\) TANGENT = -1: expected 0 to 1"),
        (
            4,
            {"BETAN": -3.0},
            r"U4 element 42: PROPS\(13\) BETAN = -3.*zero, a positive value, -2, or -1 in a self-contained element",
        ),
        (
            4,
            {"BETAN": -2.0, "BETAT": 0.0},
            r"PROPS\(13\) BETAN = -2.*, equation \(21\), but the other beta is 0 or -1, local eigenvalues: expect",
        ),
        (
            4,
            {"BETAN": 0.0, "BETAT": -2.0},
            r"PROPS\(14\) BETAT = -2.*, equation \(21\), but the other beta is 0 or -1, local eigenvalues: expect",
        ),
        (
            3,
            {"BETAN": -1.0},
            r"U3 element 42: PROPS\(13\) BETAN = -1.*zero, a positive value, -2, or -1 in a self-contained element",
        ),
        (4, {"BETAT": -0.5}, r"PROPS\(14\) BETAT = -0?.5.*zero, a positive value"),
        (4, {"GAMMABOT": 1.0}, r"PROPS\(15\) GAMMABOT = 1.*between 0 and 1"),
        (4, {"E1 BOTTOM": 0.0}, r"PROPS\(18\) E1 BOTTOM = 0.*positive"),
        (4, {"G12 TOP": -5.0}, r"PROPS\(32\) G12 TOP = -5.*positive"),
        (4, {"NU12 TOP": np.inf}, r"PROPS\(29\) NU12 TOP = .*a finite value"),
        (4, {"SAMPLING": 3}, r"JPROPS\(5\) SAMPLING = 3: expected 0 to 2"),
        (4, {"PLANE": 7}, r"JPROPS\(3\) PLANE = 7: expected 0 to 1"),
    ],
    ids=lambda value: " ".join(f"{k}={v}" for k, v in value.items()) if isinstance(value, dict) else "",
)
def test_properties_out_of_range(element, jtype, values, message):
    item = element(jtype, NODES[jtype], label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize(("jtype", "values"), [(1, {"THICKNESS": 0.0}), *((k, {"GIC": -0.1}) for k in (2, 3, 4))])
def test_whatever_is_asked_for_properties_are_checked(element, jtype, values):
    item = element(jtype, NODES[jtype], label=42, **values)
    for request in (2, 3, 4, 5, 6):
        with pytest.raises(KernelError, match=rf"U{jtype} element 42: PROPS\(\d\) {next(iter(values))} = "):
            item.evaluate(np.zeros(item.n), request=request)


@pytest.mark.parametrize(
    ("jtype", "values", "message"),
    [
        # sigma_max^2/(2 alpha_n) = 0.0225, tau_max^2/(2 alpha_tau) = 0.06
        (
            2,
            {"GIC": 0.0225},
            r"U2 element 42: PROPS\(6\) GIC = 2.25.*E-02.*too brittle.*expected more than 2.25.*E-02",
        ),
        (2, {"GIIC": 0.05}, r"PROPS\(7\) GIIC = 5.0.*E-02.*too brittle.*expected more than 6.0.*E-02"),
        (4, {"ALPHAN": 1000.0}, r"U4 element 42: PROPS\(6\) GIC = 0.26.*too brittle.*expected more than 0.45"),
        (
            4,
            {"NU12 BOTTOM": 4.0},
            r"PROPS\(21\) NU12 BOTTOM = 4.*not positive definite; -0.4.* must be positive",
        ),
        (4, {"NU12 TOP": -4.0}, r"PROPS\(29\) NU12 TOP = -4.*not positive definite"),
        (4, {"E3 TOP": 0.0, "PLANE": 1}, r"NU12 TOP = 0.3.*not positive definite; 0"),
        (4, {"NU23 BOTTOM": 1.1, "PLANE": 1}, r"PROPS\(21\) NU12 BOTTOM = 0.3.*not positive definite"),
    ],
)
def test_properties_that_do_not_go_together(element, jtype, values, message):
    item = element(jtype, NODES[jtype], label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


def test_brittleness_bound_is_sharp(element):
    """delta_u > delta_c in both pure modes and in every mix just above the bound."""
    item = element(2, FLAT, GIC=0.0225 * 1.0001, GIIC=0.06 * 1.0001)
    for angle in np.linspace(0, np.pi / 2, 20):
        u = np.zeros((4, 2))
        u[2:] = 0.1 * np.array([np.sin(angle), np.cos(angle)])
        item.evaluate(u)
        item.block.commit()
    assert (item.state["DAMAGE"] == 1).all()


@pytest.mark.parametrize(
    ("jtype", "coordinates", "message"),
    [
        (1, QUAD[::-1], r"U1 element 42: quad is inside out or degenerate.*counter-clockwise; it is -"),
        (1, QUAD[[0, 1, 1, 0]], r"U1 element 42: quad is inside out or degenerate"),
        (2, QUAD[[0, 0, 0, 0]], r"U2 element 42: the interface has no length"),
        (2, QUAD[[0, 1, 0, 1]], r"U2 element 42: the interface has no length or area, or folds back on itself"),
        (3, QUAD[[0, 1, 0, 1]], r"U3 element 42: the two faces .* do not coincide: node 4 must lie on 1 and 3 on 2"),
        (3, [*FLAT[:2], [1, 1e-3], FLAT[3]], r"they are 1.0.*E-03 apart, expected at most 1.0.*E-04, since the stress"),
        (4, EIGHT[[1, 0, 3, 2, 5, 4, 7, 6]], r"U4 element 42: .* quad is inside out"),
        (4, [*EIGHT[:4], *(EIGHT[4:] * [1, -1])], r"U4 element 42: top quad is inside out"),
        (4, [*(EIGHT[:4] * [1, -1]), *EIGHT[4:]], r"U4 element 42: bottom quad is inside out"),
        (4, EIGHT[[0, 1, 2, 3, 5, 4, 7, 6]], r"U4 element 42: the two faces .* node 5 must lie on 4 and 6 on 3"),
        # the quad has a positive area, but not where its stress is taken
        (4, [*EIGHT[:4], [0, 0], [1, 0], [0.5, 3], [0.45, -0.5]], r"U4 element 42: top quad is inside out"),
    ],
)
def test_geometry(element, jtype, coordinates, message):
    values = {"SAMPLING": 1, "INTEGRATION": 1} if jtype == 4 else {}
    item = element(jtype, np.asarray(coordinates, dtype=float), label=42, **values)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


@pytest.mark.parametrize(
    ("jtype", "definition", "message"),
    [
        (1, {"properties": 2}, r"U1 element 42: \*USER ELEMENT has PROPERTIES = 2: expected 1"),
        (2, {"properties": 7}, r"PROPERTIES = 7: expected 43"),
        (4, {"integer_properties": 4}, r"I PROPERTIES = 4: expected 11"),
        (2, {"variables": 25}, r"VARIABLES = 25: expected at least 44"),
        (4, {"variables": 43}, r"VARIABLES = 43: expected at least 50"),
        (1, {"variables": 31}, r"VARIABLES = 31: expected at least 32"),
        (2, {"dofs": tuple((node, dof) for node in range(4) for dof in (1, 2, 3))}, r"unknowns 12: expected 8"),
        (2, {"dofs": tuple((node, 1) for node in range(4)) * 2, "coordinates": 1}, r"COORDINATES = 1: expected 2"),
    ],
)
def test_counts(element, jtype, definition, message):
    item = element(jtype, NODES[jtype], label=42, definition=definition)
    with pytest.raises(KernelError, match=message):
        item.evaluate(np.zeros(item.n))


def test_wrong_number_of_nodes(element):
    dofs = tuple((node, dof) for node in range(2) for dof in (1, 2)) * 2
    item = element(2, FLAT[:2], label=42, definition={"nodes": 2, "dofs": dofs})
    with pytest.raises(KernelError, match=r"U2 element 42: \*USER ELEMENT has NODES = 2: expected 4"):
        item.evaluate(np.zeros(item.n))


def test_state_of_stress_of_the_material_must_fit(element):
    for plane, tensor in ((0, "PSTRAIN"), (1, "PSTRESS")):
        item = element(1, QUAD, label=42, PLANE=plane, definition={"tensor": tensor})
        with pytest.raises(KernelError, match=rf"JPROPS\(1\) PLANE = {plane}, but the material has a different number"):
            item.evaluate(np.zeros(8))


def test_unknown_types(library, element):
    item = element(2, FLAT, label=42)
    item.block._routine = replace(item.block._routine, jtype=15)
    with pytest.raises(
        KernelError, match="U15 element 42: is not an element of this file, which has U1 to U14, U33 to"
    ):
        item.evaluate(np.zeros(8))
    item.block._routine = replace(item.block._routine, jtype=1)
    with pytest.raises(KernelError, match="U1 element 42: takes its stress from a material: specify MATERIAL="):
        item.evaluate(np.zeros(8))
    quad = element(1, QUAD, label=42)
    for jtype in (2, 11):
        quad.block._routine = replace(quad.block._routine, jtype=jtype)
        message = f"U{jtype} element 42: is not an element with a material: specify MATERIAL= for U1 and U9 only"
        with pytest.raises(KernelError, match=message):
            quad.evaluate(np.zeros(8))
