# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faces, volumes and nodes under loads: blocks that are called as elements are, where loads act."""

from __future__ import annotations

from abc import abstractmethod

from uel.elements.block import ElementBlock
from uel.elements.call import NOTHING, BlockReport, CurrentPass, Distributed


class LoadBlock(ElementBlock):
    """Items under loads of one type, which are no elements of the model."""

    def contribute(self, now: CurrentPass) -> BlockReport:
        """Run one pass, if there are distributed loads."""
        if now.call.distributed is None:
            return NOTHING
        report = self.evaluate(now.call, now.u, now.du, now.columns, now.data, now.motion)
        return self._as_terms(report, now.call.distributed)

    @abstractmethod
    def _as_terms(self, report: BlockReport, distributed: Distributed) -> BlockReport:
        """Return the report of a pass with the loads on these items counted as terms of the average flux."""
