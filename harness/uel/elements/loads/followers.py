# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Follower loads: pressures on faces of solids, shells and membranes with NLGEOM act
on the current face in each iteration.

A block of faces is called as elements are, with its pressures as distributed loads
(fortran/host/elements/followers.f90).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from uel.elements.call import BlockReport, Distributed
from uel.elements.families.solid import section_depth, solid_of
from uel.elements.loads.load_block import LoadBlock
from uel.elements.loads.vectors import outward_sign, unit_forces
from uel.elements.routine import Routine
from uel.model.arrays import FloatArray, IntArray
from uel.model.element_types import DiscreteKind, Family, ShellType, SurfaceType
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.properties import CompositeSection, ShellSection, SolidSection
from uel.model.restart import Saved
from uel.model.steps import ElementLoad, LoadKind, LoadType
from uel.usersub import Library, _binding, built_in

_TRACTIONS: Final = {LoadKind.TRACTION: 1, LoadKind.SHEAR: 2}
"""`traction` of JPROPS for loads other than pressures."""
SHELL_PRESSURE: Final = 8
"""Terms of the average force that a load normal to a shell is, over the components of its nodal forces."""
_AT_POINTS: Final = 3
"""`traction` of JPROPS for a pressure that differs from point to point, as DLOAD gives it."""


class FollowerBlock(LoadBlock):
    """Faces of elements of one group that loads of one type may act on.

    elements  (m,) their positions in the model
    load      the type of the load
    surface   whether the loads are those of *DSLOAD, else of *DLOAD
    acts      the loads are forces of the model; otherwise the block has the load stiffness for *BUCKLE only
    """

    def __init__(
        self,
        parent: ElementGroup,
        rows: IntArray,
        load: LoadType,
        coordinates: FloatArray,
        library: Library,
        *,
        elements: IntArray,
        surface: bool,
        acts: bool,
    ) -> None:
        nodes = parent.nodes[rows][:, list(load.face)]
        dimension, depth, face, outward, axisymmetric = _face(parent, int(rows[0]), load, coordinates)
        traction = _AT_POINTS if load.jltyp else _TRACTIONS.get(load.kind, 0)
        unknowns = tuple((node, dof) for node in range(nodes.shape[1]) for dof in range(1, dimension + 1))
        routine = Routine(
            address=_binding.address_of("discrete"),
            jtype=DiscreteKind.FACE,
            mcrd=dimension,
            svars=2 * len(unknowns),
            props=built_in.reals("face", depth=depth, direction=load.direction[:dimension]),
            jprops=built_in.integers(
                "face",
                family=face.number,
                points=face.full_points,
                axisymmetric=axisymmetric,
                outward=outward,
                traction=traction,
            ),
        )
        group = replace(parent, labels=parent.labels[rows], nodes=nodes)
        super().__init__(group, coordinates, unknowns, routine, library, unsymmetric=True, variables=None)
        self.elements, self.load, self.surface, self.acts = elements, load, surface, acts
        self._parent = parent.built_in
        self._rule = face.number, face.full_points, face.nodes, face.dimension

    @property
    def points_of_face(self) -> int:
        """Number of points of a face."""
        return self._rule[1]

    def points(self, rows: IntArray, u: FloatArray) -> FloatArray:
        """Compute the places of the points of faces.

        Parameters
        ----------
        rows
            (k,) of the block, from 0.
        u
            (n,) displacements, zero in small ones.

        Returns
        -------
        FloatArray
            (k, points, 3) coordinates.
        """
        _, shapes, _ = _binding.integration_rule(*self._rule)
        x = self._coordinates[self.group.nodes[rows]].copy()
        dimension = self._arrays.coords.shape[2]
        x[:, :, :dimension] += u[self._arrays.equations[rows] - 1].reshape(*x.shape[:2], dimension)
        found: FloatArray = np.einsum("pk,mkd->mpd", shapes, x)
        return found

    def _as_terms(self, report: BlockReport, distributed: Distributed) -> BlockReport:
        """Return the report of a pass with the loads on these faces counted as terms of the average flux.

        Loads normal to shells are SHELL_PRESSURE times the components of their nodal forces, others none.
        """
        if not isinstance(self._parent, ShellType) or self.load.kind is not LoadKind.PRESSURE:
            none = np.zeros_like(self._forces)
            return report._replace(flux=np.zeros(len(none)), flux_count=none, largest=np.zeros(len(none)), entries=none)
        loaded = np.count_nonzero(self.holds(distributed.elements[distributed.kinds == 1]))
        return report._replace(entries=np.where(self._forces > 0, SHELL_PRESSURE * len(self.unknowns) * loaded, 0))

    @property
    def key(self) -> str:
        """Key that distinguishes the blocks of faces of one model, apart from the groups of their elements."""
        return f"{'*DSLOAD' if self.surface else '*DLOAD'} {self.load}"

    def resume_some(self, elements: IntArray, saved: Saved) -> None:
        """Resume the faces that are among those kept; the others had no load so far.

        Parameters
        ----------
        elements
            Of the faces kept.
        saved
            What `kept` returned for them.
        """
        _, here, there = np.intersect1d(self.elements, elements, return_indices=True)
        for name, array in self.kept().items():
            array[here] = saved[name][there]
        self._keep_committed()

    def owners(self, ranks: IntArray) -> IntArray:
        """Return the ranks (m,) that call the faces: those of their elements."""
        owners: IntArray = ranks[self.elements]
        return owners

    def keep(self, rows: IntArray) -> None:
        """Keep these elements only, as in other blocks."""
        super().keep(rows)
        self.elements = self.elements[rows]


def _face(
    parent: ElementGroup, row: int, load: LoadType, coordinates: FloatArray
) -> tuple[int, float, Family, int, bool]:
    """Return dimension, depth, family of the face, sign of the outward normal, and whether it is axisymmetric."""
    section, surface = parent.section, parent.built_in
    if isinstance(surface, SurfaceType):
        # the order of the nodes of a side gives the outward normal
        return surface.dimension, 1.0, surface.family, 1, False
    assert isinstance(section, SolidSection | CompositeSection | ShellSection)
    kind = solid_of(parent)
    depth = section_depth(kind, section)
    outward = outward_sign(parent, row, load.face, coordinates)
    return kind.dimension, depth, kind.family.face_family(load.face), outward, kind.axisymmetric


def follower_blocks(model: Model, library: Library) -> list[FollowerBlock]:
    """Build the blocks of all faces under follower loads; in a model without NLGEOM those of *BUCKLE.

    Raises DeckError if a shear traction is normal to a face.
    """
    found: list[FollowerBlock] = []
    acts = any(step.nlgeom for step in model.steps)
    starts = np.cumsum([0, *(len(group.labels) for group in model.groups)])
    for surface in (False, True):
        under: dict[LoadType, list[ElementLoad]] = {}
        for step in (step for step in model.steps if acts or step.procedure.buckles):
            for entry in step.surface_loads if surface else step.element_loads:
                if entry.type.follows:
                    under.setdefault(entry.type, []).append(entry)
        for load, entries in under.items():
            elements = np.unique(np.concatenate([entry.elements for entry in entries]))
            for group, start, end in zip(model.groups, starts, starts[1:], strict=False):
                mine = elements[(elements >= start) & (elements < end)]
                if len(mine):
                    rows, given = mine - start, model.mesh.coordinates
                    if load.kind is LoadKind.SHEAR:
                        unit_forces(group, rows, entries[0], given)
                    where = {"elements": mine, "surface": surface, "acts": acts}
                    found.append(FollowerBlock(group, rows, load, given, library, **where))
    return found
