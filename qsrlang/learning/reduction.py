"""Fewer Gaussians that say nearly the same, for a file that people read."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.gaussian import GaussianMixture


def reduced(mixture: GaussianMixture, count: int) -> GaussianMixture:
    """Return a mixture of at most `count` Gaussians with the same mean and covariance as a whole.

    The two components are merged, by their moments, whose merging moves the mixture least by Runnalls' bound
    B = ((w_i + w_j) log |P_ij| - w_i log |P_i| - w_j log |P_j|) / 2 (Runnalls 2007), until few enough are left.
    """
    weights, means, covariances = (np.array(a) for a in (mixture.weights, mixture.means, mixture.covariances))
    kept = weights > 0.0
    weights, means, covariances = weights[kept], means[kept], covariances[kept]
    costs = np.stack([_costs(weights, means, covariances, row) for row in range(len(weights))])
    while len(weights) > count:
        i, j = sorted(divmod(int(costs.argmin()), len(costs)))
        weights[i], means[i], covariances[i] = _merged(weights, means, covariances, i, j)
        weights, means, covariances = (np.delete(a, j, axis=0) for a in (weights, means, covariances))
        costs = np.delete(np.delete(costs, j, axis=0), j, axis=1)
        costs[i] = costs[:, i] = _costs(weights, means, covariances, i)
    return GaussianMixture(weights / weights.sum(), means, covariances)


def _merged(
    weights: FloatArray, means: FloatArray, covariances: FloatArray, i: int, j: int
) -> tuple[float, FloatArray, FloatArray]:
    total = weights[i] + weights[j]
    share = weights[j] / total
    off = means[j] - means[i]
    covariance = (
        (1.0 - share) * covariances[i] + share * covariances[j] + share * (1.0 - share) * np.outer(off, off)
    )
    return float(total), means[i] + share * off, covariance


def _costs(weights: FloatArray, means: FloatArray, covariances: FloatArray, row: int) -> FloatArray:
    """Return the cost of merging one component with each of the others, infinite with itself: (M,)."""
    total = weights + weights[row]
    share = weights / total
    off = means - means[row]
    within = (1.0 - share)[:, None, None] * covariances[row] + share[:, None, None] * covariances
    between = (share * (1.0 - share))[:, None, None] * np.einsum("mi,mj->mij", off, off)
    logs = np.log(np.linalg.det(covariances))
    costs = 0.5 * (
        total * np.log(np.linalg.det(within + between)) - weights * logs - weights[row] * logs[row]
    )
    costs[row] = np.inf
    return np.asarray(costs)
