# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Axes that rotate with a face, and the components of a vector along them, with first and second derivatives.

A jet has vectors that depend on k variables: the components of the tangents of the face at the anchor point. These and
the vector d from there to the secondary node are linear in the displacements: a constant matrix gives the derivatives
by the displacements.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uel.elements.rotations import PERMUTATION
from uel.model.arrays import FloatArray

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])
"""Rotation by a right angle in the plane."""


@dataclass(frozen=True, slots=True)
class Jet:
    """Vectors value (m, d), with first (m, d, k) and second derivatives (m, d, k, k)."""

    value: FloatArray
    first: FloatArray
    second: FloatArray

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.first + other.first, self.second + other.second)

    def times(self, factors: FloatArray) -> Jet:
        """Return the vectors times constants (m,)."""
        column = factors[:, None]
        return Jet(column * self.value, column[..., None] * self.first, column[..., None, None] * self.second)

    def rotated(self) -> Jet:
        """Return vectors of the plane, rotated by a right angle."""
        return Jet(*(np.einsum("de,me...->md...", TURN, array) for array in (self.value, self.first, self.second)))

    def unit(self) -> Jet:
        """Return the vectors over their lengths."""
        length = np.linalg.norm(self.value, axis=1)[:, None]
        n = self.value / length
        along = np.einsum("md,mdk->mk", n, self.first)
        across = self.first - n[..., None] * along[:, None]
        second = self.second - n[..., None, None] * np.einsum("md,mdkl->mkl", n, self.second)[:, None]
        mixed = across[..., None] * along[:, None, None]
        mixed = mixed + mixed.swapaxes(2, 3)
        mixed += n[..., None, None] * np.einsum("mdk,mdl->mkl", across, across)[:, None]
        length = length[..., None]
        return Jet(n, across / length, second / length[..., None] - mixed / length[..., None] ** 2)


def cross(a: Jet, b: Jet) -> Jet:
    """Return a x b."""
    m, _, count = a.first.shape
    left, right = _times(a.value), -_times(b.value)
    mixed = np.einsum("mkeq,mql->mekl", _times(a.first.swapaxes(1, 2)), b.first)
    seconds = left @ b.second.reshape(m, 3, count**2) + right @ a.second.reshape(m, 3, count**2)
    return Jet(
        np.einsum("mij,mj->mi", left, b.value),
        left @ b.first + right @ a.first,
        seconds.reshape(m, 3, count, count) + mixed + mixed.swapaxes(2, 3),
    )


def _times(vectors: FloatArray) -> FloatArray:
    """Return the matrices (..., 3, 3) of the products of vectors (..., 3) with another vector."""
    return np.asarray(np.tensordot(vectors, PERMUTATION, axes=(-1, 1)))


def make_variables(vectors: Sequence[FloatArray], *, constant: bool = False) -> list[Jet]:
    """Return jets of vectors (m, d) whose components are the variables; constant: without derivatives."""
    m, dimension = vectors[0].shape
    count = 0 if constant else len(vectors) * dimension
    jets = []
    for number, vector in enumerate(vectors):
        first = np.zeros((m, dimension, count))
        if not constant:
            first[:, :, number * dimension : (number + 1) * dimension] = np.eye(dimension)
        jets.append(Jet(vector, first, np.zeros((m, dimension, count, count))))
    return jets


def combine(tangents: Sequence[Jet], factors: FloatArray) -> Jet:
    """Return the vectors with these components (m, d) along the tangents of a face and the normal to them."""
    base = [*tangents, tangents[0].rotated() if len(tangents) == 1 else cross(*tangents)]
    total = base[0].times(factors[:, 0])
    for number, vector in enumerate(base[1:], start=1):
        total = total + vector.times(factors[:, number])
    return total


def turning_axes(tangents: Sequence[Jet], normal: FloatArray, first: FloatArray) -> list[Jet]:
    """Return the unit normal and the directions of slip, which rotate with the face.

    Parameters
    ----------
    tangents
        One or two tangents of the face.
    normal, first
        (m, d) components along the base of `combine` of the normal and, in space, of a vector whose part across it is
        the first direction.
    """
    n = combine(tangents, normal).unit()
    if len(tangents) == 1:
        return [n, n.rotated()]
    second = cross(n, combine(tangents, first)).unit()
    return [n, cross(second, n), second]


def components(axes: Sequence[Jet], vector: FloatArray) -> Jet:
    """Return the components of a vector (m, d) along the axes, as vectors (m, axes); its own components are further
    variables, the last ones.
    """
    value, first, second = (np.stack([getattr(axis, name) for axis in axes], axis=1) for name in Jet.__slots__)
    by_axes, count = np.einsum("md,madk->mak", vector, first), first.shape[3]
    total = count + vector.shape[1]
    by_both = np.zeros((*value.shape[:2], total, total))
    by_both[:, :, :count, :count] = np.einsum("md,madkl->makl", vector, second)
    by_both[:, :, count:, :count] = first
    by_both[:, :, :count, count:] = first.swapaxes(2, 3)
    return Jet(np.einsum("md,mad->ma", vector, value), np.concatenate([by_axes, value], axis=2), by_both)
