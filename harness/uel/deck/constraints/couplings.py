# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Couplings of nodes as linear equations between dofs: *MPC, *COUPLING, *KINEMATIC COUPLING, *RIGID BODY, *TIE.

Equations have small rotations. With NLGEOM a node with all displacements coupled to a reference node becomes an arm,
with finite rotations in general steps, and *DISTRIBUTING a coupling with finite rotations in static steps
(`rotating_constraints.py` and `finite_couplings.py` in `harness/uel/assembly`). Other couplings of displacements to
rotations are refused, unless the rotations are zero in all steps.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from uel.deck.constraints.distributing import METHODS, average_motion
from uel.deck.constraints.tie.reader import ROTATIONS, TieReader
from uel.deck.error_report import Problems
from uel.deck.language.blocks import Block, Row
from uel.deck.language.table import INPUT, Keyword, Kind, Option, Where, ignored, one_of, refused
from uel.deck.mesh.flatten import FlatMesh, Owner
from uel.deck.mesh.surfaces import Surfaces
from uel.deck.sections.user_elements import dofs_by_node
from uel.errors import DeckError, Source
from uel.model.arrays import FloatArray, IntArray
from uel.model.couplings import Distributing
from uel.model.element_types import ContinuumType, RigidType
from uel.model.mesh import ElementGroup, is_in_space
from uel.model.model import Arm, Equation
from uel.model.steps import Boundary, Step

Terms = tuple[tuple[int, int, float], ...]


_MPC_TYPES = ("TIE", "PIN", "LINEAR", "BEAM")


class ConstraintReader:
    """Reader of constraints. Each equation eliminates a dof of the dependent node."""

    def __init__(self, flat: FlatMesh, groups: Sequence[ElementGroup], problems: Problems) -> None:
        self._flat = flat
        self._surfaces = Surfaces(flat, groups)
        self._problems = problems
        self._points = flat.mesh.coordinates
        self._solid = is_in_space(self._points, groups)
        self._active = dofs_by_node(len(self._points), groups)
        self._axisymmetric = np.zeros(len(self._points), dtype=np.bool_)
        for group in groups:
            if isinstance(group.built_in, ContinuumType | RigidType) and group.built_in.axisymmetric:
                self._axisymmetric[group.nodes] = True
        self._turning: dict[Source, dict[int, set[int]]] = {}
        """Rotations of reference nodes that enter displacements, by location of the constraint."""
        self._followers: list[Arm] = []
        self._partial: set[tuple[Source, int]] = set()
        self._finite = False
        self._ties = TieReader(flat, self._surfaces, self._solid, problems)
        self._held: dict[int, set[int]] = {}
        self.arms: tuple[Arm, ...] = ()
        self.couplings: list[Distributing] = []

    def adjust(self) -> None:
        """Find the tied nodes, and move them by ADJUST."""
        self._ties.find(self._active, self._axisymmetric)

    def read(self, boundaries: Sequence[Boundary], steps: Sequence[Step]) -> tuple[Equation, ...]:
        """Return the equations of all constraints; boundaries: those before the first step.

        Sets `arms` and `couplings`, the constraints with finite rotations.
        """
        self._finite = any(step.nlgeom for step in steps)
        self._held = _held_at_zero(boundaries, steps)
        self._ties.check(steps)
        equations: list[Equation] = []
        readers = {
            "MPC": self._mpc,
            "KINEMATIC": self._kinematic,
            "DISTRIBUTING": self._distributing,
            "KINEMATIC COUPLING": self._kinematic_coupling,
            "RIGID BODY": self._rigid_body,
            "TIE": self._tie,
        }
        for owner in self._flat.owners:
            coupling: Block | None = None
            for block in owner.blocks:
                with self._problems.gather():
                    if block.name == "COUPLING":
                        coupling = block
                    elif block.name in ("KINEMATIC", "DISTRIBUTING") and coupling is None:
                        raise block.error("does not follow *COUPLING")
                    elif block.name in readers:
                        self._coupling = coupling
                        equations += readers[block.name](block, owner)
        nonlinear = [step for step in steps if step.nlgeom]
        if nonlinear:
            self._turn(nonlinear)
            self._check_couplings(equations, steps)
        return tuple(equations)

    def _turn(self, nonlinear: Sequence[Step]) -> None:
        """Set the arms with finite rotations, and refuse other constraints whose rotations are not fixed at zero."""
        other = next((step for step in nonlinear if step.procedure.linear), None)
        turning: set[tuple[Source, int]] = set()
        for source, references in self._turning.items():
            free = {
                node: dofs for node in references if (dofs := sorted(references[node] - self._held.get(node, set())))
            }
            pairs = {(source, node) for node in free}
            if not (other and free) and not pairs & self._partial:
                turning |= pairs
                continue
            where = f"in *{other.procedure.keyword} ({other.source})" if other else f"({nonlinear[0].source})"
            message = f"a constraint with rotations is not supported with NLGEOM {where}"
            if pairs & self._partial:
                message += " unless all displacements of its nodes follow"
            for node, dofs in free.items():
                name, those = self._flat.mesh.name(node), ", ".join(map(str, dofs))
                message += (
                    f"; expected *BOUNDARY to hold dofs {those} of the reference node {name} at zero in each step"
                )
            self._problems.add(source, message)
        self.arms = tuple(arm for arm in self._followers if (arm.source, arm.reference) in turning)

    def _check_couplings(self, equations: Sequence[Equation], steps: Sequence[Step]) -> None:
        """Refuse distributing couplings with finite rotations of free nodes, or with unsupported procedures."""
        tied = {node for equation in equations for node, _, _ in equation.terms} if self.couplings else set()
        for coupling in self.couplings:
            for node in coupling.nodes.tolist():
                if not self._active[node] and node not in tied:
                    name = self._flat.mesh.name(node)
                    message = f"*DISTRIBUTING: node {name} is free, for no element has it: its force cannot be balanced"
                    self._problems.add(coupling.source, message)
        others = [step for step in steps if step.procedure.linear or step.procedure.inertia]
        for coupling in self.couplings if others else ():
            where = f"*{others[0].procedure.keyword} ({others[0].source}) where a step has NLGEOM"
            self._problems.add(coupling.source, f"*DISTRIBUTING: is not supported with {where}")

    def _mpc(self, block: Block, owner: Owner) -> Iterator[Equation]:
        for row in block.rows():
            kind = row.name(0, "type")
            if kind not in _MPC_TYPES:
                raise row.unsupported(f"type {kind}", _MPC_TYPES)
            count = 3 if kind == "LINEAR" else 2
            if len(row) != count + 1:
                raise row.error(f"{kind} takes {count} nodes or node sets, found {len(row) - 1}")
            for nodes in self._tuples(row, count, owner):
                yield from self._mpc_of(kind, nodes, row.source)

    def _tuples(self, row: Row, count: int, owner: Owner) -> Iterable[tuple[int, ...]]:
        """Pair the nodes of sets in order; a single node is paired with each node of the other sets."""
        sets = [self._flat.nodes(row.name(k, "node or set"), row.source, owner.name) for k in range(1, count + 1)]
        size = len(sets[0])
        if any(len(nodes) not in (1, size) for nodes in sets):
            sizes = ", ".join(str(len(nodes)) for nodes in sets)
            raise row.error(f"the node sets have different sizes ({sizes})")
        return zip(*(np.resize(nodes, size).tolist() for nodes in sets), strict=True)

    def _mpc_of(self, kind: str, nodes: tuple[int, ...], source: Source) -> Iterator[Equation]:
        first, *others = nodes
        active = sorted(self._active[first])
        if kind == "BEAM":
            yield from self._follow(first, others[0], active, source)
        elif kind == "LINEAR":
            a, b = others
            along = self._points[b] - self._points[a]
            if not along.any():
                raise DeckError(source, "*MPC: LINEAR needs two nodes in different places")
            t = float((self._points[first] - self._points[a]) @ along / (along @ along))
            for dof in active:
                yield Equation(((first, dof, 1.0), (a, dof, t - 1.0), (b, dof, -t)), source)
        else:
            yield from self._equal(first, others[0], [dof for dof in active if kind == "TIE" or dof <= 3], source)

    @staticmethod
    def _equal(node: int, other: int, dofs: Iterable[int], source: Source) -> Iterator[Equation]:
        for dof in dofs:
            yield Equation(((node, dof, 1.0), (other, dof, -1.0)), source)

    def _follow(self, node: int, reference: int, dofs: Iterable[int], source: Source) -> Iterator[Equation]:
        """Yield the equations of a rigid link to the reference node: u = u_ref + theta_ref x r."""
        if node == reference:
            return
        x, y, z = (float(c) for c in self._points[node] - self._points[reference])
        turning: dict[int, Terms] = {
            1: ((reference, 5, -z), (reference, 6, y)),
            2: ((reference, 6, -x), (reference, 4, z)),
            3: ((reference, 4, -y), (reference, 5, x)),
        }
        dofs, last = list(dofs), 3 if self._solid else 2
        moving = {dof for dof in dofs if dof <= last}
        if any((x, y, z)) and moving:
            # a rotation about an axis does not change displacements along it
            axes = {axis for axis in ROTATIONS if moving - {axis - 3}} if self._solid else {6}
            self._turning.setdefault(source, {}).setdefault(reference, set()).update(axes)
            self._followers.append(Arm(node, reference, source))
            if len(moving) < last:
                self._partial.add((source, reference))
        for dof in dofs:
            if dof <= last:
                # a finite rotation makes zero coefficients nonzero
                rotations = (t for t in turning[dof] if self._finite or t[2] != 0.0)
                terms = tuple(t for t in rotations if self._solid or t[1] == 6)
                yield Equation(((node, dof, 1.0), (reference, dof, -1.0), *terms), source)
            elif dof in ROTATIONS:
                yield Equation(((node, dof, 1.0), (reference, dof, -1.0)), source)

    def _reference(self, block: Block, owner: Owner) -> int:
        return reference_node(block, owner, self._flat)

    def _kinematic(self, block: Block, owner: Owner) -> Iterator[Equation]:
        coupling = self._coupling
        assert coupling is not None
        nodes, _ = self._coupled(coupling, owner)
        chosen = self._global(_chosen(block), block, owner)
        yield from self._follow_all(nodes, self._reference(coupling, owner), chosen, block.source)

    def _global(self, chosen: set[int], block: Block, owner: Owner) -> set[int]:
        """Return the chosen dofs; warn if a rotated instance mixes them with others."""
        groups = ({1, 2, 3}, set(ROTATIONS)) if self._solid else ({1, 2},)
        if owner.placement.rotates and chosen and any(0 < len(chosen & group) < len(group) for group in groups):
            dofs = ", ".join(map(str, sorted(chosen)))
            message = f"dofs {dofs} are those of the global axes, which do not turn with instance {owner.name}"
            self._problems.warn(block.source, f"*{block.name}: {message}")
        return chosen

    def _coupled(self, coupling: Block, owner: Owner) -> tuple[IntArray, FloatArray]:
        """Return the nodes of *COUPLING and their tributary areas. Raises DeckError without nodes."""
        nodes, areas = self._surfaces.shares(coupling.options.text("SURFACE"), coupling.source, owner.name)
        reference = self._reference(coupling, owner)
        near = nodes != reference
        if coupling.options.has("INFLUENCE RADIUS"):
            radius = coupling.options.real("INFLUENCE RADIUS", 0.0)
            near &= np.linalg.norm(self._points[nodes] - self._points[reference], axis=1) <= radius
        if not near.any():
            raise coupling.error("couples no node")
        return nodes[near], areas[near]

    def _distributing(self, block: Block, owner: Owner) -> Iterator[Equation]:
        coupling = self._coupling
        assert coupling is not None
        nodes, weights = self._coupled(coupling, owner)
        if self._axisymmetric[nodes].any():
            raise block.error("is not supported for axisymmetric elements")
        reference, chosen = self._reference(coupling, owner), self._global(_chosen(block), block, owner)
        distance = np.linalg.norm(self._points[nodes] - self._points[reference], axis=1)
        method = block.options.text("WEIGHTING METHOD")
        if distance.max() > 0.0:
            weights = weights * METHODS[method](distance / distance.max())
        if not weights.sum() > 0.0:
            raise block.error(f"WEIGHTING METHOD={method} gives all nodes the weight 0")
        motion = average_motion(self._points[nodes], weights, self._points[reference])
        dofs = (1, 2, 3) if self._solid else (1, 2)
        turning = [dof for dof in (ROTATIONS if self._solid else (6,)) if not chosen or dof in chosen]
        if turning and motion.axes < (3 if self._solid else 1):
            geometry = "its nodes lie on a line" if motion.axes else "all its nodes are in one place"
            self._problems.warn(block.source, f"*DISTRIBUTING: {geometry}, about which no moment is passed on")
        if self._finite and motion.axes:
            self._turn_with(block, reference, (nodes, weights / weights.sum()), len(turning), motion.axes)
            return
        for dof in (*dofs, *turning):
            factors = motion.displacement[dof - 1] if dof <= 3 else motion.rotation[dof - 4]
            terms = [(node, k, -factors[n, k - 1]) for n, node in enumerate(nodes.tolist()) for k in dofs]
            others = tuple((node, k, float(factor)) for node, k, factor in terms if factor != 0.0)
            yield Equation(((reference, dof, 1.0), *others), block.source)

    def _turn_with(
        self, block: Block, reference: int, cloud: tuple[IntArray, FloatArray], turning: int, axes: int
    ) -> None:
        """Add a distributing coupling with finite rotations. Raises DeckError.

        turning: number of coupled rotations; axes: number of axes with inertia.
        """
        dimension = 3 if self._solid else 2
        if turning < (3 if self._solid else 1):
            raise block.error("released rotations are not supported with NLGEOM; expected all dofs to be coupled")
        if self._solid and axes < dimension:
            raise block.error("its nodes lie on a line, about which they have no rotation: not supported with NLGEOM")
        self.couplings.append(Distributing(reference, *cloud, dimension, block.source))

    def _kinematic_coupling(self, block: Block, owner: Owner) -> Iterator[Equation]:
        reference = self._reference(block, owner)
        for row in block.rows():
            nodes = self._flat.nodes(row.name(0, "node or set"), row.source, owner.name)
            yield from self._follow_all(nodes, reference, self._global(_dofs(row, 1), block, owner), row.source)

    def _follow_all(self, nodes: IntArray, reference: int, chosen: set[int], source: Source) -> Iterator[Equation]:
        """Yield the equations of nodes that follow the reference node in the chosen dofs, by default in all."""
        for node in nodes.tolist():
            dofs = sorted(dof for dof in self._active[node] if not chosen or dof in chosen)
            yield from self._follow(node, reference, dofs, source)

    def _rigid_body(self, block: Block, owner: Owner) -> Iterator[Equation]:
        reference, options = self._reference(block, owner), block.options
        pinned: set[int] = set()
        tied: set[int] = set()
        if options.has("ELSET"):
            elements = self._flat.elements(options.text("ELSET"), block.source, owner.name)
            tied |= self._surfaces.nodes_of(elements)
        for name, nodes in (("PIN NSET", pinned), ("TIE NSET", tied)):
            if options.has(name):
                nodes |= set(self._flat.nodes(options.text(name), block.source, owner.name).tolist())
        if not pinned | tied and not options.has("ANALYTICAL SURFACE"):
            raise block.error("needs ELSET, PIN NSET, TIE NSET or ANALYTICAL SURFACE")
        for node in sorted(pinned | tied):
            dofs = sorted(dof for dof in self._active[node] if dof <= 3 or node in tied)
            yield from self._follow(node, reference, dofs, block.source)

    def _tie(self, block: Block, owner: Owner) -> Iterator[Equation]:
        del owner
        yield from self._ties.read(block, self._held, nlgeom=self._finite)


def reference_node(block: Block, owner: Owner, flat: FlatMesh) -> int:
    """Return the node that REF NODE names. Raises DeckError unless it is a single node."""
    name = block.options.text("REF NODE")
    return flat.one_node(name, f"REF NODE={name}", block, owner.name)


def bodies_with_surfaces(flat: FlatMesh) -> Iterator[tuple[Block, Owner, str]]:
    """Yield each *RIGID BODY with an analytical surface, its owner, and the name of the surface."""
    for block, owner in flat.blocks("RIGID BODY"):
        if block.options.has("ANALYTICAL SURFACE"):
            yield block, owner, block.options.text("ANALYTICAL SURFACE")


def _held_at_zero(boundaries: Sequence[Boundary], steps: Sequence[Step]) -> dict[int, set[int]]:
    """Return, by node, the dofs that are prescribed as zero in each step."""
    fixed: set[tuple[int, int]] | None = None
    now: set[tuple[int, int]] = set()
    for entries, new in ((boundaries, False), *((step.boundaries, step.new_boundary) for step in steps)):
        if new:
            now = set()
        for entry in entries:
            entry_dofs = {(node, entry.dof) for node in entry.nodes.tolist()}
            now = now - entry_dofs if entry.magnitude or entry.user else now | entry_dofs
        if entries is not boundaries:
            fixed = now if fixed is None else fixed & now
    by_node: dict[int, set[int]] = {}
    for node, dof in fixed or ():
        by_node.setdefault(node, set()).add(dof)
    return by_node


def _chosen(block: Block) -> set[int]:
    """Return the dofs of all data lines; empty: all dofs."""
    return set().union(*(_dofs(row, 0) for row in block.rows()))


def _dofs(row: Row, start: int) -> set[int]:
    """Return the dofs of a data line, first to last; empty: all dofs. Raises DeckError."""
    if row.blank(start):
        return set()
    first = row.integer(start, "first dof")
    last = row.integer(start + 1, "last dof", first)
    if not 1 <= first <= last <= 6:
        raise row.error(f"dofs {first} to {last}: expected 1 to 6")
    return set(range(first, last + 1))


_REF_NODE = Option("REF NODE", Kind.NAME, "reference node, or set of one node", required=True)

KEYWORDS = (
    Keyword(
        "MPC",
        "Multi-point constraints; the first node is eliminated. Sets stand for their nodes in order.",
        Where.MODEL,
        (INPUT, *refused("MODE", "USER")),
        "TIE, PIN or BEAM and two nodes; or LINEAR and three",
    ),
    Keyword(
        "COUPLING",
        "Couple the nodes of a surface to a reference node, as the *KINEMATIC or *DISTRIBUTING after it says.",
        Where.MODEL,
        (
            Option("CONSTRAINT NAME", Kind.NAME, "name", required=True),
            _REF_NODE,
            Option("SURFACE", Kind.NAME, "surface", required=True),
            Option("INFLUENCE RADIUS", Kind.REAL, "largest distance of a node from the reference node"),
            *refused("ALPHA", "ORIENTATION"),
        ),
    ),
    Keyword(
        "KINEMATIC",
        "Dofs that *COUPLING couples. With NLGEOM, in general steps, nodes follow finite rotations of the reference "
        "node, as those of *KINEMATIC COUPLING, *RIGID BODY and *MPC, BEAM do. *BOUNDARY may prescribe displacements "
        "of these nodes, which then determine those of the reference node; where both are determined, they must "
        "agree.",
        Where.MODEL,
        data="first dof, last dof; none: all",
    ),
    Keyword(
        "DISTRIBUTING",
        "The reference node of *COUPLING moves as the nodes of the surface do on average; its forces are spread over "
        "them. Weights are tributary areas. Abaqus does not document those of quadratic faces, which are cut at the "
        "middles of edges here. With NLGEOM, in static steps, it turns by any angle, as the theory manual says.",
        Where.MODEL,
        (
            one_of(
                "COUPLING",
                "what the motion of the nodes is; rotations of the nodes do not count",
                ("CONTINUUM",),
                refused=("STRUCTURAL",),
                default="CONTINUUM",
            ),
            one_of("WEIGHTING METHOD", "how weights fall with the distance", tuple(METHODS), default="UNIFORM"),
        ),
        "first dof, last dof of the reference node; none: all. Displacements are always coupled",
    ),
    Keyword(
        "KINEMATIC COUPLING",
        "Couple nodes to a reference node.",
        Where.MODEL,
        (_REF_NODE, *refused("ORIENTATION")),
        "node or set, first dof, last dof",
    ),
    Keyword(
        "RIGID BODY",
        "Nodes that move with a reference node.",
        Where.MODEL,
        (
            _REF_NODE,
            Option("ELSET", Kind.NAME, "elements that are rigid: R2D2, RAX2, R3D3, R3D4, or any others"),
            Option("PIN NSET", Kind.NAME, "nodes whose displacements follow"),
            Option("TIE NSET", Kind.NAME, "nodes whose displacements and rotations follow"),
            Option("ANALYTICAL SURFACE", Kind.NAME, "analytical rigid surface, for contact"),
            *ignored("ISOTHERMAL"),
            *refused("POSITION"),
        ),
    ),
)
