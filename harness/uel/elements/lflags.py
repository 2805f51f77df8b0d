# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""LFLAGS: the step, and the request of a call."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Self

from uel.model.steps import Step


class Request(IntEnum):
    """LFLAGS(3): request of a call.

    NORMAL                RHS and AMATRX of an iteration
    STIFFNESS, DAMPING, MASS  AMATRX only: the stiffness, the damping matrix of LFLAGS(7), the mass matrix
    RESIDUAL              RHS only, of a state that is not stored: line search, half-increment residual of *DYNAMIC
    INITIAL_ACCELERATION  RHS and the mass matrix, at the start of a dynamic step
    PERTURBATION          RHS of a linear step for the perturbation DU

    Abaqus does not have the negative requests, which the host makes of built-in elements:

    INITIAL_STRESSES      RHS and the state for the initial stresses
    BASE_STRESS, ADDED_STRESS  AMATRX only: the initial stress matrix (geometric stiffness) of the stresses at U, or of
                          those that a perturbation DU adds
    OUTPUT_VARIABLES      calls of UVARM after an increment: U is that of its end, DU is zero
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
    """LFLAGS(7): the damping matrix that is requested."""

    NONE = 0
    VISCOUS = 1
    STRUCTURAL = 2


@dataclass(frozen=True, slots=True)
class Flags:
    """LFLAGS by name.

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
            LFLAGS(7), the damping matrix of Request.DAMPING.
        """
        return replace(self, request=request, damping=damping)

    @property
    def dynamic(self) -> bool:
        """Whether the step is dynamic."""
        return self.procedure in (11, 12)

    @property
    def lflags(self) -> tuple[int, ...]:
        """LFLAGS(1..7)."""
        values = self.procedure, self.nlgeom, self.request, self.linear, self.extrapolated, 0, self.damping
        return tuple(map(int, values))
