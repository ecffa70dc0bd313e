"""The cells of one pair as Gaussians, each place with the same weight however often it was seen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.summing import CELL
from qsrlang.learning.sums import PlacementSums


@dataclass(frozen=True, slots=True, eq=False)
class PairCells:
    """M cells at P places: `means` (M, 2) and `spreads` (M, 2, 2) of the placements in each, in the relatum's frame.

    `shares` (M,) is the part of a place's placements that a cell holds, so they sum to P; `places` (M,) are the
    places' numbers in `words`; `low`, `high` (M, 2) and `turns` (M,) tell of the support as in Placements, averaged;
    `hours` (M, 24) is each share by the hour of the day.
    """

    means: FloatArray
    spreads: FloatArray
    shares: FloatArray
    places: IntArray
    low: FloatArray
    high: FloatArray
    turns: FloatArray
    hours: FloatArray
    words: tuple[str, ...]
    counts: FloatArray

    def __len__(self) -> int:
        return len(self.means)

    @property
    def place_count(self) -> int:
        """How many places there are."""
        return len(np.unique(self.places))

    @property
    def areas(self) -> FloatArray:
        """The area of the support of each cell: (M,) [m^2]."""
        return np.asarray((self.high - self.low).prod(axis=1))

    @property
    def means_on_support(self) -> FloatArray:
        """The means in the frame of the support, about the relatum: (M, 2) [m]."""
        return np.asarray(np.einsum("mij,mj->mi", rotation(self.turns), self.means))

    def take(self, chosen: BoolArray) -> PairCells:
        """Return some of the cells."""
        columns = {name: getattr(self, name)[chosen] for name in _COLUMNS}
        return replace(self, **columns)


_COLUMNS = ("means", "spreads", "shares", "places", "low", "high", "turns", "hours", "counts")


def cells_of(sums: PlacementSums) -> PairCells:
    """Return the cells of the sums over one pair."""
    counts = sums.counts
    moments = sums.moments / counts[:, None]
    means = moments[:, :2] + CELL * sums.keys[:, 3:]
    xx, xy, yy = moments[:, 2:5].T - _products(moments[:, 0], moments[:, 1])
    spreads = np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
    places = sums.keys[:, 2]
    totals = np.bincount(places, weights=counts)[places]
    return PairCells(
        means=means,
        spreads=spreads,
        shares=counts / totals,
        places=places,
        low=moments[:, 5:7],
        high=moments[:, 7:9],
        turns=np.arctan2(moments[:, 10], moments[:, 9]),
        hours=sums.hours / totals[:, None],
        words=sums.words,
        counts=counts,
    )


def _products(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.stack([x * x, x * y, y * y])
