"""Where things are that are placed by one step each, which says the same wherever its relatum is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.mixtures.solving.linear import Factor, Linear
from qsrlang.mixtures.worlds.layout import Layout

NOWHERE = -1


class _Way(NamedTuple):
    """Steps from x or y (axis 0 or 1) of a thing back, and the column of a landmark they end at, or NOWHERE."""

    steps: IntArray
    axis: int
    end: int


@dataclass(frozen=True, slots=True, eq=False)
class Paths:
    """x_i = x_r(i) + s_i h_i + b_i + noise_i for the steps i in the order of the columns they place.

    `relata` are the first columns of x_r, or NOWHERE where a step depends on nothing open; `headings` (F,) the columns
    of h, which are those of landmarks; `slopes` s (F, 2), `offsets` b (F, 2) and `noises` (F, 2, 2).
    """

    layout: Layout
    relata: Sequence[int]
    headings: IntArray
    slopes: FloatArray
    offsets: FloatArray
    noises: FloatArray

    @classmethod
    def of(cls, factors: Sequence[Factor], equations: Sequence[Linear], layout: Layout) -> Paths:
        """Return the paths of factors, each of which turns with its relatum, or depends on nothing open."""
        relata = [one.columns.item(0) if one.turning is not None else NOWHERE for one in factors]
        headings = np.array([one.columns.item(2) for one in factors], dtype=np.int64)
        slopes = np.array([one.slope[:, 2] for one in equations]).reshape(-1, 2)
        offsets = np.array([one.offset for one in equations]).reshape(-1, 2)
        noises = np.array([one.covariance for one in equations]).reshape(-1, 2, 2)
        return cls(layout, relata, headings, slopes, offsets, noises)

    def mean(self) -> FloatArray:
        """Return where everything is (n,)."""
        ways = (self.slopes * self.layout.mean[self.headings, None] + self.offsets).tolist()
        mean = self.layout.mean.tolist()
        at = self._first
        for relatum, (x, y) in zip(self.relata, ways, strict=True):
            is_placed = relatum != NOWHERE
            mean[at] = x + mean[relatum] if is_placed else x
            mean[at + 1] = y + mean[relatum + 1] if is_placed else y
            at += 2
        return np.array(mean)

    def covariance(self, columns: IntArray) -> FloatArray:
        """Return the joint covariance (K, K) of some columns.

        Cov(x_i, x_j) = sum of the noises on both paths from i and j to their landmarks + B_i V B_j^T, V the prior
        covariance of landmarks and B the sums of what each path reads of them.
        """
        ways = [self._way(column) for column in columns.tolist()]
        read = np.array([self._read(way) for way in ways])
        joint: FloatArray = (read * self.layout.variance[: self._first]) @ read.T
        for (i, one), (j, other) in product(enumerate(ways), repeat=2):
            shared = np.intersect1d(one.steps, other.steps)
            joint[i, j] += self.noises[shared, one.axis, other.axis].sum()
        return joint

    @property
    def _first(self) -> int:
        return self.layout.size - 2 * len(self.relata)

    def _way(self, column: int) -> _Way:
        """Return the steps from a column back to the column of a landmark, which a step may do without."""
        first = self._first
        axis = (column - first) % 2
        at, steps = column - axis, []
        if column < first:
            return _Way(np.array([], dtype=np.int64), 0, column)
        while at >= first:
            steps.append((at - first) // 2)
            at = self.relata[steps[-1]]
        return _Way(np.array(steps), axis, NOWHERE if at == NOWHERE else at + axis)

    def _read(self, way: _Way) -> FloatArray:
        """Return the weights of the columns of landmarks in a column."""
        weights = np.zeros(self._first)
        np.add.at(weights, self.headings[way.steps], self.slopes[way.steps, way.axis])
        if way.end != NOWHERE:
            weights[way.end] += 1.0
        return weights
