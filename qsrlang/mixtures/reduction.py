"""Mixture reduction: the pair of components whose merging changes the mixture least is merged, again and again."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.answers import Component

MAX_COMPONENTS = 64
_BATCH = 256


def reduced(components: Sequence[Component], limit: int) -> tuple[Component, ...]:
    """Return a mixture of at most `limit` components, heaviest first, with the mean and covariance of the whole.

    Runnalls 2007: merging i and j raises the Kullback-Leibler divergence by at most
    B(i, j) = ((w_i + w_j) log |S_ij| - w_i log |S_i| - w_j log |S_j|) / 2, S_ij the covariance of both as one. More
    than _BATCH are reduced batch by batch first, so that the work grows with their number, not its square.
    """
    kept = sorted(components, key=lambda one: (-one.weight, *one.mean))
    size = max(_BATCH, 2 * limit)
    while len(kept) > size:
        batches = [kept[at : at + size] for at in range(0, len(kept), size)]
        kept = [one for batch in batches for one in _merged(batch, min(len(batch), size // 2))]
    return tuple(sorted(_merged(kept, limit), key=lambda one: (-one.weight, *one.mean)))


def _merged(components: Sequence[Component], limit: int) -> list[Component]:
    kept = list(components)
    if len(kept) <= limit:
        return kept
    table = np.array([_row(one) for one in kept]).T
    costs = _costs(table[:, :, None], table[:, None, :])
    costs[np.tri(len(kept), dtype=bool)] = np.inf
    alive = np.ones(len(kept), dtype=bool)
    for _ in range(len(kept) - limit):
        first, second = divmod(int(costs.argmin()), len(kept))
        merged = _together(kept[first], kept[second])
        kept[first], alive[second], table[:, first] = merged, False, _row(merged)
        costs[second], costs[:, second] = np.inf, np.inf
        fresh = np.where(alive, _costs(table[:, [first]], table), np.inf)
        costs[first, first + 1 :], costs[:first, first] = fresh[first + 1 :], fresh[:first]
    return [one for one, is_alive in zip(kept, alive, strict=True) if is_alive]


def _row(one: Component) -> tuple[float, ...]:
    """Return weight w, mean x and y, covariance xx, xy and yy, and w log |S|."""
    (xx, xy), (_, yy) = one.covariance.tolist()
    x, y = one.mean.tolist()
    return one.weight, x, y, xx, xy, yy, one.weight * math.log(xx * yy - xy * xy)


def _costs(one: FloatArray, others: FloatArray) -> FloatArray:
    """Return B of rows (7, …) as `_row` gives them, beside each other."""
    weight, x, y, xx, xy, yy, own = one
    weights, xs, ys, xxs, xys, yys, owns = others
    pair = weight + weights
    share = weights / pair
    rest, across = 1.0 - share, share * (1.0 - share)
    off_x, off_y = xs - x, ys - y
    both_xx = rest * xx + share * xxs + across * off_x * off_x
    both_yy = rest * yy + share * yys + across * off_y * off_y
    both_xy = rest * xy + share * xys + across * off_x * off_y
    return np.asarray(0.5 * (pair * np.log(both_xx * both_yy - both_xy * both_xy) - own - owns))


def _together(one: Component, other: Component) -> Component:
    weight = one.weight + other.weight
    share = other.weight / weight
    off = other.mean - one.mean
    covariance = (1.0 - share) * one.covariance + share * other.covariance
    covariance = covariance + share * (1.0 - share) * np.outer(off, off)
    statements = tuple(dict.fromkeys((*one.statements, *other.statements)))
    return Component(weight, one.mean + share * off, covariance, statements)
