"""Mixture reduction: the pair of components whose merging changes the mixture least is merged, again and again."""

from __future__ import annotations

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
    weights = np.array([one.weight for one in kept])
    means = np.array([one.mean for one in kept])
    covariances = np.array([one.covariance for one in kept])
    costs = np.full((len(kept), len(kept)), np.inf)
    for at in range(len(kept) - 1):
        costs[at, at + 1 :] = _costs(at, slice(at + 1, None), weights, means, covariances)
    alive = np.ones(len(kept), dtype=bool)
    for _ in range(len(kept) - limit):
        first, second = divmod(int(costs.argmin()), len(kept))
        merged = _together(kept[first], kept[second])
        kept[first], alive[second] = merged, False
        weights[first], means[first], covariances[first] = merged.weight, merged.mean, merged.covariance
        costs[second], costs[:, second] = np.inf, np.inf
        fresh = np.where(alive, _costs(first, slice(None), weights, means, covariances), np.inf)
        costs[first, first + 1 :], costs[:first, first] = fresh[first + 1 :], fresh[:first]
    return [one for one, is_alive in zip(kept, alive, strict=True) if is_alive]


def _costs(
    at: int, others: slice, weights: FloatArray, means: FloatArray, covariances: FloatArray
) -> FloatArray:
    """Return B(at, j) of the others."""
    pair = weights[others] + weights[at]
    share = (weights[others] / pair)[:, None, None]
    off = means[others] - means[at]
    both = (1.0 - share) * covariances[at] + share * covariances[others]
    both = both + share * (1.0 - share) * off[:, :, None] * off[:, None, :]
    alone = weights[at] * np.log(_determinants(covariances[at]))
    rest = weights[others] * np.log(_determinants(covariances[others]))
    return np.asarray(0.5 * (pair * np.log(_determinants(both)) - alone - rest))


def _determinants(covariances: FloatArray) -> FloatArray:
    return np.asarray(
        covariances[..., 0, 0] * covariances[..., 1, 1] - covariances[..., 0, 1] * covariances[..., 1, 0]
    )


def _together(one: Component, other: Component) -> Component:
    weight = one.weight + other.weight
    share = other.weight / weight
    off = other.mean - one.mean
    covariance = (1.0 - share) * one.covariance + share * other.covariance
    covariance = covariance + share * (1.0 - share) * np.outer(off, off)
    statements = tuple(dict.fromkeys((*one.statements, *other.statements)))
    return Component(weight, one.mean + share * off, covariance, statements)
