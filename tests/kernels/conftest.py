# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Single elements of the project's kernels, driven as a job would drive them."""

import ctypes
import importlib
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
import reference as independent
from random_states import Tools

from uel import usersub
from uel.elements import Call, Flags, Request, build_blocks
from uel.elements.call import Predefined
from uel.errors import Source
from uel.model.mesh import ElementGroup, Mesh
from uel.model.model import Model
from uel.model.procedures import Static
from uel.model.properties import Elastic, ElasticType, Material, Orientation, SolidSection, UserElement, UserProperty
from uel.model.steps import Step
from uel.usersub.layout import element_layouts
from uel.usersub.own_kernels import path_of_amalgam

SOURCE = Source("test.inp", 1)

# HTA/6376C (table 1) and its cohesive parameters, with a stiffness that keeps every length of the law comparable
LAW = {
    "THICKNESS": 2.0,
    "ALPHAN": 2.0e4,
    "ALPHAT": 3.0e4,
    "SIGMAMAX": 30.0,
    "TAUMAX": 60.0,
    "GIC": 0.26,
    "GIIC": 1.002,
    "LAW": 1,
}
PLY = {"E1": 1.2e5, "E2": 1.05e4, "E3": 1.05e4, "NU12": 0.3, "NU13": 0.3, "NU23": 0.51, "G12": 5.52e3}
PLIES = {f"{name} {side}": value for name, value in PLY.items() for side in ("BOTTOM", "TOP")}
LAW_3D = {name: value for name, value in LAW.items() if name != "THICKNESS"}
PLIES_3D = {
    **PLIES,
    **{f"{name} {side}": value for name, value in (("G13", 5.52e3), ("G23", 3.48e3)) for side in ("BOTTOM", "TOP")},
}
# the closure and the estimate of beta that `reference.py` has
PAPER = {"CLOSURE": 2, "BETAN": -2.0, "BETAT": -2.0}
DEFAULTS = {1: {"THICKNESS": 2.0}, 2: LAW, 3: LAW | PAPER, 5: LAW, 7: LAW_3D, 9: {}, 10: LAW_3D | PAPER}
DEFAULTS |= dict.fromkeys((11, 13, 14), LAW_3D)
DEFAULTS |= {
    jtype: (LAW | PLIES if layout.dimension == 2 else LAW_3D | PLIES_3D) | PAPER
    for jtype, layout in element_layouts().items()
    if layout.solids
}
TENSORS = {(1, 0): "PSTRESS", (1, 1): "PSTRAIN", (9, 0): "THREED"}  # of continuum elements, by type and PLANE
ENGINEERING = (1.2e5, 1.05e4, 1.05e4, 0.3, 0.3, 0.51, 5.52e3, 5.52e3, 3.48e3)
PLY_MATERIAL = Material("PLY", SOURCE, Elastic(ElasticType.ENGINEERING_CONSTANTS, ENGINEERING, SOURCE))


@pytest.fixture(scope="session")
def installed(tmp_path_factory):
    """The kernels as they are installed."""
    loaded = usersub.load(None, job="kernels", output_dir=tmp_path_factory.mktemp("job"))
    yield loaded
    loaded.close()


@pytest.fixture(scope="session")
def amalgam(tmp_path_factory):
    """The kernels as Abaqus would compile them."""
    loaded = usersub.load(path_of_amalgam(), job="kernels", output_dir=tmp_path_factory.mktemp("job"))
    yield loaded
    loaded.close()


@pytest.fixture
def library(request):
    """The installed kernels, or those that a test asks for by the name of their fixture."""
    return request.getfixturevalue(getattr(request, "param", "installed"))


class Element:
    """One element, or `copies` of it with consecutive labels; its state is that of the last committed increment.

    Arrays of copies have one axis more, the first. `layouts` are those of a library other than the installed one;
    `material` is that of a continuum element.
    """

    def __init__(
        self,
        library,
        jtype,
        coordinates,
        *,
        label=1,
        copies=None,
        definition=None,
        layouts=None,
        material=None,
        **values,
    ):
        layout = (layouts or element_layouts())[jtype]
        given = {**DEFAULTS.get(jtype, LAW), **values}
        if -1 in (values.get("BETAN"), values.get("BETAT")):
            # one estimate for both
            given |= {name: values.get(name, 0.0) for name in ("BETAN", "BETAT")}
        self.names = [item.name for item in layout.variables]
        self.points = layout.points
        reals = [float(given.pop(item.name, 0.0)) for item in layout.reals]
        integers = [int(given.pop(item.name, 0)) for item in layout.integers]
        assert not given, f"no properties of U{jtype}: {given}"
        tensor = TENSORS.get((jtype, int(values.get("PLANE", 0) == 1)), "")
        options = {
            "nodes": layout.nodes,
            "coordinates": layout.dimension,
            "variables": layout.svars,
            "unsymmetric": True,
            "integration": layout.points if tensor else 0,
            "tensor": tensor,
            "properties": len(reals),
            "integer_properties": len(integers),
            "dofs": tuple((node, dof) for node in range(layout.nodes) for dof in range(1, 1 + layout.dimension)),
            **(definition or {}),
        }
        self.copies = copies
        count = copies or 1
        number = jtype
        user = UserElement(number, source=SOURCE, **options)
        section = UserProperty(
            "ALL",
            SOURCE,
            np.resize(np.array(reals), user.properties),
            np.resize(np.array(integers), user.integer_properties),
            (material or PLY_MATERIAL) if tensor else None,
        )
        self._build(library, f"U{number}", np.tile(coordinates, (count, 1)), count, label, section, user)

    def _build(self, library, name, coordinates, count, label, section, definition, *, steps=()):
        coordinates = np.asarray(coordinates, dtype=float)
        nodes = np.arange(len(coordinates)).reshape(count, -1)
        group = ElementGroup(name, label + np.arange(count), nodes, "", section, definition, SOURCE)
        xyz = np.zeros((nodes.size, 3))
        xyz[:, : coordinates.shape[1]] = coordinates
        mesh = Mesh(np.arange(1, len(xyz) + 1), xyz, ("",) * len(xyz))
        (self.block,) = build_blocks(Model(Path("test.inp"), "", mesh, (group,), steps), library)
        n = self.n = len(self.block.unknowns)
        # row-major positions, so that the matrix comes back dense
        equations, entries = (np.arange(count * size, dtype=np.int32) for size in (n, n * n))
        self.block.bind(equations.reshape(count, n), entries.reshape(count, n, n))

    def evaluate(
        self,
        u,
        *,
        du=None,
        dtime=1.0,
        request=1,
        flags=(1, 0, 0, 0),
        step=1,
        increment=1,
        params=(0.0, 0.0, 0.0),
        fields=None,
    ):
        """RHS and AMATRX at u; flags LFLAGS(1), (2), (4), (5), params PARAMS, fields the predefined ones (n, nodes)."""
        told = Flags(flags[0], bool(flags[1]), Request(request), bool(flags[2]), bool(flags[3]))
        call = Call(
            told, step, increment, step_time=dtime, total_time=dtime, time_increment=dtime, period=1.0, params=params
        )
        if fields is not None:
            call = replace(call, predefined=Predefined(fields, np.zeros_like(fields), np.zeros(fields.shape[1])))
        u = np.ascontiguousarray(u, dtype=float).ravel()
        du = u if du is None else np.ascontiguousarray(du, dtype=float).ravel()
        rhs, amatrx = np.zeros(u.size), np.zeros(u.size * self.n)
        self.report = self.block.evaluate(call, u, du, rhs, amatrx)
        leading = (self.copies,) if self.copies else ()
        return rhs.reshape(*leading, self.n), amatrx.reshape(*leading, self.n, self.n)

    def advance(self, u, **options):
        """A converged increment."""
        outcome = self.evaluate(u, **options)
        self.block.commit()
        return outcome

    def follow(self, path):
        """Advance to each target of a path in three parts; after each of them, the trapezoidal work of RHS so far."""
        u, rhs, work = np.zeros(self.n), np.zeros(self.n), 0.0
        for target in path:
            start = u
            for fraction in (0.3, 0.6, 1.0):
                new = start + fraction * (target.ravel() - start)
                new_rhs, _ = self.advance(new, dtime=0.1)
                work += -0.5 * (rhs + new_rhs) @ (new - u)
                u, rhs = new, new_rhs
                yield work

    @property
    def state(self):
        """Committed SVARS by name, one value per point."""
        svars = self.block.state(0).svars
        table = svars[:, : self.points * len(self.names)].reshape(-1, self.points, len(self.names))
        return dict(zip(self.names, np.moveaxis(table if self.copies else table[0], -1, 0), strict=True))

    @property
    def energy(self):
        """Committed ENERGY(1:8)."""
        energy = self.block.state(0).energy
        return energy if self.copies else energy[0]


class BuiltIn(Element):
    """A built-in continuum element; strains and stresses are in `state`, incompatible modes are not."""

    def __init__(self, library, name, coordinates, material=PLY_MATERIAL, thickness=1.0, axes=None):
        self.copies = None
        orientation = None if axes is None else Orientation("PLY", axes, SOURCE)
        section = SolidSection("ALL", material, orientation, thickness, SOURCE)
        # axes turn with the material where a step has large displacements
        steps = () if axes is None else (Step(1, "Step-1", Static(), SOURCE, nlgeom=True),)
        self._build(library, name, coordinates, 1, 1, section, None, steps=steps)
        self.names, self.points = self.block.state(0).variables.names, self.block.state(0).variables.points

    @property
    def state(self):
        """Committed strains and stresses by name, one value per point."""
        table = self.block.state(0).svars[0, : self.points * len(self.names)].reshape(self.points, -1)
        return dict(zip(self.names, table.T, strict=True))


@pytest.fixture
def built_in(library):
    """Make a built-in element: built_in(name, coordinates, material, thickness, axes of the material)."""

    def make(*arguments, **options):
        return BuiltIn(library, *arguments, **options)

    return make


@pytest.fixture
def element(library):
    """Make an element: element(jtype, coordinates, NAME=value, ...)."""

    def make(jtype, coordinates, **values):
        return Element(library, jtype, coordinates, **values)

    return make


@pytest.fixture
def element_of():
    """Make an element of any library: element_of(library, jtype, coordinates, NAME=value, ...)."""
    return Element


@pytest.fixture(scope="session")
def program():
    """Module of a program of fortran/ that the build calls: program(name)."""
    return importlib.import_module


@pytest.fixture(scope="session")
def compiled(tmp_path_factory):
    """Make a shared library of Fortran files: of this folder, and before it of fortran/, or generated there."""

    def compiled(file, sources):
        folder, here = tmp_path_factory.mktemp(file), Path(__file__).parent
        kernels = here.parents[1] / "fortran"
        generated = folder / "law_properties.f90"
        table = (kernels / "properties.toml").read_text()
        generated.write_text(importlib.import_module("generate_law_properties").layout(table))
        own = {generated.stem: generated}
        files = [*(own.get(name, kernels / f"{name}.f90") for name in sources), here / f"{file}.f90"]
        library = folder / f"{file}.so"
        subprocess.run(["gfortran", "-O2", "-shared", "-fPIC", "-o", library, *files], cwd=folder, check=True)
        return ctypes.CDLL(str(library))

    return compiled


@pytest.fixture(scope="session")
def reference():
    """Module reference.py of this folder."""
    return independent


@pytest.fixture
def tools(element, interface, library, reference):
    """What a check of random states works with."""
    return Tools(element, interface, library, reference)


@pytest.fixture(scope="session")
def law():
    """Properties of the cohesive law that elements have by default."""
    return dict(LAW)


@pytest.fixture(scope="session")
def ply():
    """Elastic constants that quads have by default."""
    return dict(PLY)


class Interface:
    """An inclined interface between two distorted quads, and displacements that open it as wanted.

    edge     (2, 2) left and right end
    four     (4, 2) nodes of U2 and U3
    eight    (8, 2) nodes of U4: bottom quad, top quad
    """

    edge = np.array([[0.1, 0.2], [1.0, 0.5]])
    four = edge[[0, 1, 1, 0]]
    eight = np.array([[0.2, -0.7], [1.2, -0.4], edge[1], edge[0], edge[0], edge[1], [0.9, 1.4], [-0.1, 1.2]])
    owned = (3, 2, 5, 4)  # nodes 1 to 4 of U2 among those of U4

    # separations (tau, n) at the left and right end; the law softens from 0.002 and 0.0015 on, fails at 0.033 and 0.017
    states: ClassVar = {
        "elastic": ((0.0005, 0.0003), (-0.0004, 0.0007)),
        "softening": ((0.004, 0.003), (0.007, 0.002)),
        "sliding": ((0.006, -0.0015), (0.008, -0.0020)),
        "closed": ((0.0004, -0.0020), (-0.0006, -0.0025)),
        "failed": ((0.05, 0.03), (0.06, 0.04)),
        "mixed": ((0.05, 0.03), (-0.002, -0.030)),
    }

    axes = np.array([[0.3, 0.1], [-0.1, 0.3]]) / np.sqrt(0.1)  # tangent of the edge and its normal

    def displacements(self, nodes, left, right, seed):
        """(nodes, 2) displacements with the given separations (tau, n) at both ends, otherwise random."""
        rng = np.random.default_rng(seed)
        u = 1e-3 * rng.normal(size=(nodes, 2))
        bottom, top = ([0, 1], [3, 2]) if nodes == 4 else ([3, 2], [4, 5])
        noise = 1 + 0.05 * rng.normal(size=(2, 2))
        u[top] = u[bottom] + (np.array([left, right]) * noise) @ self.axes
        return u

    def apart(self, *gap):
        """(8, 2) displacements that part the quads of U4 by a gap (tau, n) without straining them."""
        u = np.zeros((8, 2))
        u[4:] = np.asarray(gap) @ self.axes
        return u


@pytest.fixture(scope="session")
def interface():
    """Geometry and states of an interface."""
    return Interface()
