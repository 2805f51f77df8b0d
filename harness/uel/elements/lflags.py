# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LFLAGS: data of the step for elements, and the request of a call."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Self

from uel.model.steps import Step


class Request(IntEnum):
    """LFLAGS(3): request of a call.

    NORMAL                RHS and AMATRX of an iteration
    STIFFNESS, DAMPING, MASS  AMATRX only: the stiffness, the damping matrix of LFLAGS(7), the mass matrix
    RESIDUAL              RHS only, of a state that is not kept: line search, half of an increment of *DYNAMIC
    INITIAL_ACCELERATION  RHS and the mass matrix, at the start of a dynamic step
    PERTURBATION          RHS of a linear step once DU, the perturbation, is known
    INITIAL_STRESSES      the host's own, for built-in elements only: RHS and the state for the given stresses
    BASE_STRESS, ADDED_STRESS  the host's own: AMATRX only, the initial stress matrix of the stresses at U, or of those
                          that a perturbation DU adds to them
    OUTPUT_VARIABLES      the host's own: UVARM at the points, after an increment, in whose end U is and DU is zero
    """

    NORMAL = 1
    STIFFNESS = 2
    DAMPING = 3
    MASS = 4
    RESIDUAL = 5
    INITIAL_ACCELERATION = 6
    PERTURBATION = 100
    INITIAL_STRESSES = -1
    BASE_STRESS = -2
    ADDED_STRESS = -3
    OUTPUT_VARIABLES = -4


class Damping(IntEnum):
    """LFLAGS(7): which damping matrix, if one is requested."""

    NONE = 0
    VISCOUS = 1
    STRUCTURAL = 2


@dataclass(frozen=True, slots=True)
class Flags:
    """The LFLAGS by name.

    procedure     LFLAGS(1), `Procedure.lflag`
    nlgeom        LFLAGS(2), large displacements
    request       LFLAGS(3)
    linear        LFLAGS(4), a perturbation of a base state
    extrapolated  LFLAGS(5), the first pass of an increment that starts from an extrapolation
    damping       LFLAGS(7)
    """

    procedure: int
    nlgeom: bool = False
    request: Request = Request.NORMAL
    linear: bool = False
    extrapolated: bool = False
    damping: Damping = Damping.NONE

    @classmethod
    def of(cls, step: Step, request: Request = Request.NORMAL, damping: Damping = Damping.NONE) -> Self:
        """Return the flags of a step."""
        procedure = step.procedure
        return cls(procedure.lflag, step.nlgeom, request, procedure.linear, damping=damping)

    def asking(self, request: Request, damping: Damping = Damping.NONE) -> Self:
        """Return these flags with another request.

        Parameters
        ----------
        request
            LFLAGS(3).
        damping
            LFLAGS(7), which damping matrix; of use with Request.DAMPING only.
        """
        return replace(self, request=request, damping=damping)

    @property
    def dynamic(self) -> bool:
        """Whether a dynamic step asks."""
        return self.procedure in (11, 12)

    @property
    def lflags(self) -> tuple[int, ...]:
        """LFLAGS(1..7)."""
        told = self.procedure, self.nlgeom, self.request, self.linear, self.extrapolated, 0, self.damping
        return tuple(map(int, told))
