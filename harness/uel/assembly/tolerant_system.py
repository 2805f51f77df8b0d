# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""System of an ordinary run: it continues after mistakes of user elements that Abaqus does not notice."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import suppress
from typing import Any

from uel.assembly.contributors import Contributors
from uel.assembly.evaluation import Evaluation
from uel.assembly.linear_shortcut import LinearShortcut
from uel.elements import Call
from uel.errors import NotFiniteError
from uel.model.arrays import FloatArray
from uel.model.model import Model
from uel.parallel.ranks import ALONE, Ranks
from uel.usersub import ARRAYS, AS_GOOD_AS_ZERO, Library, guard_values, set_guard_values


class TolerantSystem(LinearShortcut):
    """System whose elements may read outside their arrays: after a NaN from there they read zeros."""

    def __init__(self, model: Model, library: Library, linear: Collection[str] = (), ranks: Ranks = ALONE) -> None:
        """Build the contributors of a model; linear: types of user elements that the user declares linear."""
        contributors = Contributors.of(model, library, strict=False, zeros=True, linear=linear)
        super().__init__(model.mesh, contributors, model.equations, ranks=ranks)
        self._library = library
        self._tolerated = False

    def evaluate(self, call: Call, u: FloatArray, du: FloatArray, **options: Any) -> Evaluation:
        """Evaluate as `System` does; warn once of reads outside arrays.

        After the warning the guards hold practically zero, until the `guard_values` around the run ends.

        Parameters
        ----------
        call, u, du
            As in `System.evaluate`.
        **options
            `matrix`, `nrhs` and `motion`, as there.

        Returns
        -------
        Evaluation
            Sums over all elements.

        Raises
        ------
        NotFiniteError
            An element returns NaN or infinity for another reason.
        KernelError, CallLimitError
            As in `System.evaluate`.
        """
        try:
            return super().evaluate(call, u, du, **options)
        except NotFiniteError as error:
            names = () if self._tolerated else self._read_outside(call, u, du, options)
            if not names:
                raise
            self._tolerated = True
            where = names[0] if len(names) == 1 else "its arrays"
            self._library.warn(f"{error}: it reads outside {where}, see uel check; the run goes on with zeros there")
        set_guard_values(dict.fromkeys(ARRAYS, AS_GOOD_AS_ZERO))
        return super().evaluate(call, u, du, **options)

    def _read_outside(self, call: Call, u: FloatArray, du: FloatArray, options: dict[str, Any]) -> tuple[str, ...]:
        """Return the array around which zeros let the pass succeed, or all arrays if only several do; else ()."""
        for names in (*((name,) for name in ARRAYS), ARRAYS):
            with guard_values(dict.fromkeys(names, AS_GOOD_AS_ZERO)), suppress(NotFiniteError):
                super().evaluate(call, u, du, **options)
                return names
        return ()
