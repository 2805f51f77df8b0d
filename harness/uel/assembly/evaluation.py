# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Result of one pass over all contributors of a system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from uel.elements import FIELD_NAMES, BlockReport
from uel.model.arrays import FloatArray, IntArray
from uel.model.contact import ContactChanges
from uel.model.couplings import CouplingErrors


@dataclass(frozen=True, slots=True)
class Evaluation:
    """Result of one pass: sums over the elements of all ranks, but the matrix of the elements of this rank.

    residual    (n,) sum of RHS: external minus internal force
    data        (nnz,) CSR values of the matrix, None if not requested; overwritten by the next pass with a matrix
    flux        (fields,) sum of |element nodal force| by field, in the order of FIELD_NAMES, and of the loads that
                count in the average flux
    flux_count  (fields,) number of terms in `flux` above the floor of the call
    pnewdt      smallest PNEWDT of an element
    energy      (8,) sum of ENERGY; `LinearShortcut` adds that of linear elements that were not called
    load        (n,) sum of column 2 of RHS, increments of the loads that elements apply; None unless NRHS = 2
    damage      energy dissipated by damage of built-in elements
    largest     (fields,) largest |element nodal force|
    entries     (fields,) number of element nodal forces, and of terms of loads
    contact     changes in each contact pair by the iteration
    coupling    errors of distributing couplings, None without any
    """

    residual: FloatArray
    data: FloatArray | None
    flux: FloatArray
    flux_count: IntArray
    pnewdt: float
    energy: FloatArray
    load: FloatArray | None = None
    damage: float = 0.0
    largest: FloatArray = field(default_factory=lambda: np.zeros(len(FIELD_NAMES)))
    entries: IntArray = field(default_factory=lambda: np.zeros(len(FIELD_NAMES), dtype=np.int64))
    contact: tuple[ContactChanges, ...] = ()
    coupling: CouplingErrors | None = None

    @classmethod
    def of(cls, reports: Sequence[BlockReport], columns: FloatArray, data: FloatArray | None) -> Self:
        """Sum the reports of a pass with right-hand sides (NRHS, n) and matrix (nnz,)."""
        fields = len(FIELD_NAMES)
        return cls(
            residual=columns[0],
            data=data,
            flux=sum((report.flux for report in reports), np.zeros(fields)),
            flux_count=sum((report.flux_count for report in reports), np.zeros(fields, dtype=np.int64)),
            # NaN, of which .msg warns, requests nothing
            pnewdt=min((report.pnewdt for report in reports if report.pnewdt <= np.inf), default=np.inf),
            energy=sum((report.energy for report in reports), np.zeros(8)),
            load=columns[1] if len(columns) > 1 else None,
            damage=float(sum(report.damage for report in reports)),
            largest=np.max([np.zeros(fields), *(report.largest * np.ones(fields) for report in reports)], axis=0),
            entries=sum((report.entries for report in reports), np.zeros(fields, dtype=np.int64)),
            contact=tuple(report.contact for report in reports if report.contact is not None),
            coupling=next((report.coupling for report in reports if report.coupling is not None), None),
        )
