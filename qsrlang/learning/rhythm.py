"""How shares change over the day: Fourier terms, only where they say more of what was held out.

share_s(t) = sum_h n_sh K(t - h) / sum_sh n_sh K(t - h), with Fejer's kernel K(t) = 1 + 2 sum_k (1 - k / (k_max + 1))
cos(2 pi k t / 24 h): never negative, and right where some hours were seen more often than others. The spectrum of a
binary state that this smooths is that of FreMEn (Krajnik et al. 2017). Order 0 is no rhythm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.learning.cells import PairCells
from qsrlang.learning.summing import HOURS

ORDERS = (0, 1, 2, 4, 8)
DIRECTIONS = ("behind-of", "left-of", "in-front-of", "right-of")
# A Dirichlet prior worth this part of all sightings, so that a direction never seen at an hour is not impossible.
_PRIOR = 0.02
_MIN_PLACES = 3
_TINY = 1e-3
# How often a rhythm is seen where there is none; several orders are tried, so each has its part (Bonferroni).
FALSE_ALARM = 0.05


def direction_numbers(points: FloatArray) -> IntArray:
    """Return which of DIRECTIONS points (N, 2), in the relatum's frame, lie in: (N,)."""
    angles = np.arctan2(points[:, 1], points[:, 0])
    return np.asarray(
        np.floor(np.mod(angles + 0.25 * np.pi, 2.0 * np.pi) / (0.5 * np.pi)).astype(np.int64) % 4
    )


@dataclass(frozen=True, slots=True, eq=False)
class Rhythm:
    """The order of the Fourier terms (0 for none) and the shares of the directions by the hour: (24, 4)."""

    order: int
    shares: FloatArray

    def ratios(self, hour: float) -> FloatArray:
        """Return by how much each direction is likelier at an hour of the day than over the whole of it: (4,)."""
        return np.asarray(self.shares[int(hour) % HOURS] / self.shares.mean(axis=0))


def rhythm_of(cells: PairCells) -> Rhythm:
    """Return the rhythm of a pair, its order chosen on places held out or, with fewer than three, on hours."""
    counts = direction_counts(cells)
    folds = list(_folds(counts))
    scores = {order: np.array([_score(rest, out, order) for rest, out in folds]) for order in ORDERS}
    order = max(ORDERS, key=lambda one: float(scores[one].sum()))
    order = order if _is_sure(scores[order] - scores[0]) else 0
    return Rhythm(order, shares_by_hour(counts.sum(axis=0), order))


def _is_sure(gains: FloatArray) -> bool:
    """Return whether gains (F,) over no rhythm are above 0 by Student's test, at FALSE_ALARM over all orders."""
    count, spread = len(gains), gains.std(ddof=1) if len(gains) > 1 else 0.0
    if spread == 0.0:
        return False
    bound = student.ppf(1.0 - FALSE_ALARM / (len(ORDERS) - 1), count - 1)
    return bool(gains.mean() > bound * spread / np.sqrt(count))


def direction_counts(cells: PairCells) -> FloatArray:
    """Return the share of each place's sightings by hour and direction: (P, 24, 4)."""
    _, places = np.unique(cells.places, return_inverse=True)
    counts = np.zeros((places.max(initial=-1) + 1, HOURS, len(DIRECTIONS)))
    for place, direction, hours in zip(places, direction_numbers(cells.means), cells.hours, strict=True):
        counts[place, :, direction] += hours
    return counts


def shares_by_hour(counts: FloatArray, order: int) -> FloatArray:
    """Return the shares (24, 4) that counts (24, 4) give by Fejer's kernel of an order."""
    smoothed = _kernel(order) @ counts + _PRIOR * (counts.sum(axis=0) + _TINY * counts.sum() + _TINY)
    return np.asarray(smoothed / smoothed.sum(axis=1, keepdims=True))


def _kernel(order: int) -> FloatArray:
    hours = np.arange(HOURS)
    kernel = np.ones((HOURS, HOURS))
    for k in range(1, order + 1):
        kernel += 2.0 * (1.0 - k / (order + 1)) * np.cos(2.0 * np.pi * k * (hours[:, None] - hours) / HOURS)
    return np.asarray(np.maximum(kernel, 0.0))


def _folds(counts: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield what is known and what is held out, each (24, 4)."""
    total = counts.sum(axis=0)
    if len(counts) >= _MIN_PLACES:
        yield from ((total - own, own) for own in counts)
        return
    for hour in np.flatnonzero(total.sum(axis=1)):
        own = np.zeros_like(total)
        own[hour] = total[hour]
        yield total - own, own


def _score(rest: FloatArray, out: FloatArray, order: int) -> float:
    return float((out * np.log(shares_by_hour(rest, order))).sum())
