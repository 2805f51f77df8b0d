# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Path of the increments of a general step: time, or (in `load_factor`) a path with an unknown load factor."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from uel.model.arrays import FloatArray
from uel.model.records import FieldCheck, Record
from uel.model.restart import Saved
from uel.procedures.context import StepContext
from uel.procedures.general.convergence_checks import was_linear
from uel.procedures.general.extrapolation import Extrapolation
from uel.procedures.general.incrementation import IncrementControl
from uel.procedures.general.step_parts import Part
from uel.solver.descent import Descent
from uel.solver.newton import Increment, Iterate, Newton


@dataclass(frozen=True, slots=True)
class Reached:
    """End of a converged increment.

    load, released  (n,) loads and fading forces
    size            change of the step time
    load_factor     load factor if it is part of the solution, else None
    """

    load: FloatArray
    released: FloatArray
    step_time: float
    total_time: float
    size: float
    load_factor: float | None = None


class Path(ABC):
    """Path of the increments of a step.

    control  sizes of increments along it
    """

    def __init__(self, context: StepContext, control: IncrementControl) -> None:
        self.control = control
        self._context = context

    @property
    def search(self) -> Descent | None:
        """Descent search for when Newton's method fails; None without --fallback."""
        return None

    @property
    @abstractmethod
    def finished(self) -> bool:
        """True if the end of the step is reached."""

    def start(self) -> Iterable[Record]:
        """Return the records before the first increment."""
        return ()

    def end(self, size: float) -> float:
        """Return the step time at the end of an increment; an estimate where the load factor is unknown.

        Parameters
        ----------
        size
            Size of the increment along the path.
        """
        return self._context.step_time + size

    @property
    def obstacle(self) -> str:
        """Reason why *RESTART cannot keep the state, as the end of a sentence; '' if it can."""
        return "the load factor is part of the solution"

    def kept(self) -> Saved:
        """Return the data of earlier increments that the next one needs, for *RESTART."""
        return {}

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        assert not saved, self.obstacle

    @abstractmethod
    def begin(self, size: float) -> tuple[Iterator[Iterate], bool]:
        """Begin an attempt.

        Parameters
        ----------
        size
            Size of the increment along the path.

        Returns
        -------
        tuple[Iterator[Iterate], bool]
            Iterates without end, whose errors (KernelError, SingularMatrixError) end the attempt or the run; and True
            if they start from an extrapolation.
        """

    @abstractmethod
    def reach(self, last: Iterate, size: float, checks: Sequence[FieldCheck]) -> Reached:
        """Return the end of a converged increment, and set the step time of the context to it.

        Parameters
        ----------
        last
            State after the last iteration.
        size
            Size of the increment along the path.
        checks
            Checks of the last iteration; all of them accept it.
        """


class TimePath(Path):
    """Increments of time, by Newton's method, and with `fallback` by a descent search if that fails.

    The parts of the step add to the definition of an increment.
    """

    def __init__(self, context: StepContext, parts: Sequence[Part], *, fallback: bool = False) -> None:
        step = context.step
        super().__init__(context, IncrementControl(step.procedure, step.controls.time))
        self._parts = parts
        arguments = context.system, context.constraints, context.solver, step.controls.line_search
        self._newton = Newton(*arguments)
        self._descent = Descent(*arguments, context.state.majoriser) if fallback else None
        self._extrapolation = Extrapolation(step.extrapolation, step.controls.time.d_e)
        # size of the last increment if its response was linear
        self._linear: float | None = None

    @property
    def search(self) -> Descent | None:
        """Descent search; none in a part of an increment, which needs the nearby equilibrium."""
        return None if self.control.in_parts else self._descent

    @property
    def obstacle(self) -> str:
        """Reason why *RESTART cannot keep the state: the search needs the matrix at the start of the analysis."""
        reason = "the search of --fallback compares with the start of the analysis; to keep states, run without it"
        return "" if self._descent is None else reason

    def kept(self) -> Saved:
        """Return sizes, extrapolation, and the matrix if the next increment may reuse it."""
        factorised = None if self._linear is None else self._newton.kept()
        self._newton.resume(factorised)
        return {
            "control": self.control.kept(),
            "extrapolation": self._extrapolation.kept(),
            "linear": self._linear,
            "factorised": factorised,
        }

    def resume(self, saved: Saved) -> None:
        """Restore what `kept` returned."""
        self.control.resume(saved["control"])
        self._extrapolation.resume(saved["extrapolation"])
        self._linear = saved["linear"]
        self._newton.resume(saved["factorised"])

    @property
    def finished(self) -> bool:
        """True if the period has ended, or UAMP concludes the step."""
        return self.control.finished(self._context.step_time) or self._context.amplitudes.concluded

    def end(self, size: float) -> float:
        """Return the sum of the increments, or the period if they differ only by rounding."""
        end = self._context.step_time + size
        return self._context.step.procedure.period if self.control.finished(end) else end

    def begin(self, size: float) -> tuple[Iterator[Iterate], bool]:
        """Begin at the start state, or at an extrapolation."""
        increment = self._increment(size)
        if self.search is not None:
            return self.search.iterates(increment), increment.guess is not None
        # Abaqus does not form the matrix again if the response was linear in the last increment: public message files
        # show it for increments of equal size, and abaqus_inputs/dcb_3d is cut back as in Abaqus only if that holds for
        # all sizes. The contributions of parts to the matrix depend on the size.
        alike = self._linear is not None and (self._linear == size or not self._parts)
        # the inertia of nodes on arms refers to rotation vectors and changes with each rotation: without other
        # supports, an old matrix enlarges the errors of the rotations of a body about other axes
        rotating = self._context.step.procedure.inertia and self._context.constraints.arms
        reuse = alike and self.control.attempts == 1 and not rotating
        return self._newton.iterates(increment, same_matrix=reuse), increment.guess is not None

    def _increment(self, size: float) -> Increment:
        """Define the increment by loads and prescribed values at its end, with the additions of the parts."""
        context, end = self._context, self.end(size)
        u = context.state.displacement
        context.load.increment = context.increment
        increment = Increment(
            call=context.call(size, end, context.start + end),
            u=u,
            guess=self._extrapolation.guess(size),
            du_p=(context.prescribed_at(end) - u)[context.unknowns],
            f_ext=context.steady_at(end),
            dependent=partial(context.dependent_loads, end) if context.load.by_user else None,
        )
        for part in self._parts:
            increment = part.add_to(increment, size)
        return increment

    def reach(self, last: Iterate, size: float, checks: Sequence[FieldCheck]) -> Reached:
        """Return the end of the increment."""
        self._linear = size if was_linear(checks) else None
        context, end = self._context, self.end(size)
        total = context.start + end
        self._extrapolation.converged(last.du, size)
        load = context.loads_at(end, context.state.displacement + last.du)
        context.step_time = end
        return Reached(load, context.released.at(end, total), end, total, size)
