# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Arguments and results of a pass over the elements."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple, Self

import numpy as np

from uel.elements.lflags import Damping, Flags, Request
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import ContactChanges
from uel.model.couplings import CouplingErrors
from uel.usersub.exchange import Moment, Outcome


@dataclass(frozen=True, slots=True)
class Distributed:
    """Active distributed loads on user elements, and pressures on faces.

    elements   (k,) positions in the model, ascending; faces come after the elements
    kinds      (k,) n for type Un, -n for type UnNU, 1 for faces
    end, increment  (k,) magnitude at the end of the increment and its increment; 0 for UnNU
    """

    elements: IntArray
    kinds: IntArray
    end: FloatArray
    increment: FloatArray


@dataclass(frozen=True, slots=True)
class Predefined:
    """Predefined fields (fields, nodes) at the end of the increment and their increments; temperature is the first.

    initial  (nodes,) temperature at the start of the analysis
    """

    end: FloatArray
    increment: FloatArray
    initial: FloatArray


@dataclass(frozen=True)
class Call:
    """Arguments common to all elements in one pass.

    flags        LFLAGS
    step, increment  KSTEP, KINC
    iteration    equilibrium iteration, for messages; 0 before the first solve
    flux_floor   (fields,) magnitude above which an element nodal force is a term of the average flux; None: all are
    params       PARAMS: alpha, beta and gamma of a dynamic step
    step_time, total_time  at the end of the increment (Abaqus' manual does not say which end TIME refers to)
    unsymmetric  AMATRX of UEL is used as it is, UNSYMM or not, as in coupled temperature-displacement steps: Abaqus
                 2023 says in their message file that it uses unsymmetric storage, and a public element without UNSYMM
                 reproduces its residuals there in one iteration, which it does not with (A + A^T)/2
    load_terms   nodal loads that are terms of the average flux
    """

    flags: Flags
    step: int
    increment: int
    step_time: float
    total_time: float
    time_increment: float
    period: float
    params: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distributed: Distributed | None = None
    predefined: Predefined | None = None
    flux_floor: FloatArray | None = None
    iteration: int = 0
    unsymmetric: bool = False
    load_terms: tuple[BlockReport, ...] = ()

    def asking(self, request: Request, damping: Damping = Damping.NONE) -> Self:
        """Return this call with another request; parameters as in `Flags.asking`."""
        return replace(self, flags=self.flags.asking(request, damping))

    @property
    def extrapolated(self) -> Self:
        """Copy of this call for the first pass of an increment that starts from an extrapolation."""
        return replace(self, flags=replace(self.flags, extrapolated=True))

    @cached_property
    def moment(self) -> Moment:
        """Arguments of the driver that are common to all blocks."""
        time = self.step_time, self.total_time
        lflags = self.flags.lflags
        return Moment(
            self.step, self.increment, self.iteration, time, self.time_increment, self.period, self.params, lflags
        )

    @property
    def place(self) -> str:
        """Step, increment and iteration, for messages."""
        return f"step {self.step}, increment {self.increment}, iteration {self.iteration}"


@dataclass(frozen=True, slots=True)
class Motion:
    """Velocities and accelerations (n,) of all unknowns, V and A."""

    velocity: FloatArray
    acceleration: FloatArray

    def at(self, unknowns: IntArray) -> Motion:
        """Return V and A of some unknowns.

        Parameters
        ----------
        unknowns
            (k,) numbers, from 0.

        Returns
        -------
        Motion
            (k,) in the same order.
        """
        return Motion(self.velocity[unknowns], self.acceleration[unknowns])


@dataclass(frozen=True, slots=True)
class CurrentPass:
    """Arguments of a pass, and the arrays to which contributors add.

    call     arguments common to all elements
    u, du    (n,) estimate of the end of the increment, and the increment; both include prescribed values
    columns  (NRHS, n) residuals: external minus internal force, and increments of loads
    data     (nnz,) CSR values, to which matrices are added; None: no matrix is assembled
    motion   V and A of all unknowns; None: zero
    """

    call: Call
    u: FloatArray
    du: FloatArray
    columns: FloatArray
    data: FloatArray | None
    motion: Motion | None = None

    @property
    def has_forces(self) -> bool:
        """Whether forces are assembled, and not a mass, damping or initial stress matrix alone."""
        return self.call.flags.request in (Request.NORMAL, Request.RESIDUAL)


class BlockReport(NamedTuple):
    """Sums of one pass over one block.

    flux        (fields,) sum of |element nodal force| by field
    flux_count  (fields,) number of terms in it
    pnewdt      smallest PNEWDT; large if no element sets one
    energy      (8,) sum of ENERGY
    damage      energy dissipated by damage of built-in elements (ALLDMD), for which ENERGY has no entry
    largest     (fields,) largest |element nodal force| by field
    entries     (fields,) number of element nodal forces
    contact     changes of a contact pair in the iteration; None for other contributors
    coupling    errors of distributing couplings; None for other contributors
    """

    flux: FloatArray
    flux_count: IntArray
    pnewdt: float
    energy: FloatArray
    damage: float = 0.0
    largest: FloatArray = np.zeros(1)
    entries: IntArray = np.zeros(1, dtype=np.int64)
    contact: ContactChanges | None = None
    coupling: CouplingErrors | None = None

    @classmethod
    def of(cls, outcome: Outcome, entries: IntArray, energy: FloatArray, damage: float) -> Self:
        """Make the report from the sums of a pass."""
        flux, terms, largest = outcome.flux
        return cls(flux, terms.astype(np.int64), outcome.pnewdt, energy, damage, largest, entries)


NOTHING: Final = BlockReport(np.zeros(1), np.zeros(1, dtype=np.int64), np.inf, np.zeros(8))
"""Report of a pass without items."""
