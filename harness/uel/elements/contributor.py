# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Interface of the contributors to the system: elements, loads on faces, heat exchange, contact, couplings."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from uel.elements.call import BlockReport, CurrentPass
from uel.model.arrays import IntArray
from uel.model.restart import Saved

Find = Callable[[IntArray, IntArray | int], IntArray]
"""Numbers of the unknowns of nodes and dofs, broadcast against each other; -1 for none."""


class Contributor(ABC):
    """Like items that add forces and their derivatives to the system: elements, loaded faces, contact points, pairs of
    coupled nodes.

    unknowns  (local node, dof) of each unknown of an item, in the order of its forces. The local node after the last
              one is the item itself, which has pressures or multipliers; REFERENCE is the reference node
    first     number of the first item in the model, where elements come before the items of other contributors
    rows      (m,) number of each item on this rank, less `first`
    """

    unknowns: tuple[tuple[int, int], ...]
    first: int
    rows: IntArray
    _equations: NDArray[np.int32]

    @property
    @abstractmethod
    def nodes(self) -> IntArray:
        """Nodes (m, k) of the items, indices into the mesh."""

    @property
    @abstractmethod
    def names(self) -> list[str]:
        """Names (m,) of the items, for messages."""

    @property
    def reference(self) -> int:
        """Index of the reference node, -1 without one."""
        return -1

    def number(self, find: Find, equations: NDArray[np.int32]) -> None:
        """Set the numbers of the unknowns in the system, from 0.

        Parameters
        ----------
        find
            Numbers of the unknowns of nodes and dofs.
        equations
            (m, unknowns) numbers of the unknowns of the items.
        """
        del find
        self._equations = equations

    def couplings(self) -> NDArray[np.int32]:
        """Return (r, k) numbers of unknowns; those of a row are coupled in the matrix."""
        return self._equations

    @abstractmethod
    def locate(self, indptr: NDArray[np.int32], indices: NDArray[np.int32]) -> None:
        """Locate the entries of `couplings` in a CSR pattern."""

    def track(self, now: CurrentPass) -> bool:
        """Prepare for a pass. Return whether the pattern has the current `couplings`, if a matrix is assembled."""
        del now
        return True

    @abstractmethod
    def contribute(self, now: CurrentPass) -> BlockReport:
        """Add forces and matrices to the arrays of a pass; store the trial state for `commit`.

        Returns
        -------
        BlockReport
            Sums over the items.

        Raises
        ------
        KernelError, CallLimitError
            An item fails; residuals and matrix are then incomplete.
        """

    @abstractmethod
    def commit(self) -> None:
        """Commit the state of the last normal pass at the end of a converged increment. Raises KernelError."""

    @abstractmethod
    def kept(self) -> Saved:
        """Return the committed state, not copied."""

    @abstractmethod
    def resume(self, saved: Saved) -> None:
        """Restore the state that `kept` returned. Raises ValueError if it is not of these items."""
