"""What was learned of a pair: a mixture of Gaussians in the relatum's frame, and a share that is anywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.cells import PairCells
from qsrlang.learning.experts import BANDWIDTHS, LEAST_MASS, wide_gaussian
from qsrlang.learning.rectangles import rectangle_mass
from qsrlang.mixtures.gaussian import GaussianMixture

_UNIFORM, _WIDE = 0, 1
_CHUNK = 64
# Beyond this squared Mahalanobis distance a Gaussian is below 1e-11 of its peak.
_FAR = 50.0


@dataclass(frozen=True, slots=True, eq=False)
class PairDensity:
    """p(x) = anywhere / area + sum over experts of their share of `mixture`, each cut to the support.

    `groups` (M,) tells to which expert a component of the mixture belongs; x is in the relatum's frame [m].
    """

    anywhere: float
    mixture: GaussianMixture | None
    groups: IntArray

    def pdf(self, points: FloatArray, low: FloatArray, high: FloatArray, turns: FloatArray) -> FloatArray:
        """Return the density (N,) [1/m^2] of points (N, 2) in the relatum's frame, cut to supports.

        `low`, `high` (N, 2) and `turns` (N,) tell of the supports as in Placements.
        """
        chunks = [slice(at, at + _CHUNK) for at in range(0, len(points), _CHUNK)]
        parts = [self._pdf(points[one], low[one], high[one], turns[one]) for one in chunks]
        return np.concatenate([np.zeros(0), *parts])

    def _pdf(self, points: FloatArray, low: FloatArray, high: FloatArray, turns: FloatArray) -> FloatArray:
        density = self.anywhere / (high - low).prod(axis=1)
        if self.mixture is None:
            return np.asarray(density)
        weighed = self._masses(low, high, turns) * self.mixture.weights
        for group, height in enumerate(self.heights(points).T):
            own = self.groups == group
            share = self.mixture.weights[own].sum() * (1.0 - self.anywhere)
            density = density + share * height / np.maximum(weighed[:, own].sum(axis=1), LEAST_MASS)
        return np.asarray(density)

    def heights(self, points: FloatArray) -> FloatArray:
        """Return what the components of each expert add up to at points (N, 2), not cut: (N, experts) [1/m^2]."""
        assert self.mixture is not None
        inverses = np.linalg.inv(self.mixture.covariances)
        peaks = self.mixture.weights / (2.0 * np.pi * np.sqrt(np.linalg.det(self.mixture.covariances)))
        heights = np.zeros((len(points), int(self.groups.max()) + 1))
        _add_heights(np.ascontiguousarray(points), self.mixture.means, inverses, peaks, self.groups, heights)
        return heights

    def _masses(self, low: FloatArray, high: FloatArray, turns: FloatArray) -> FloatArray:
        assert self.mixture is not None
        turn = rotation(turns)
        means = np.einsum("nij,mj->nmi", turn, self.mixture.means)
        covariances = np.einsum("nij,mjk,nlk->nmil", turn, self.mixture.covariances, turn)
        return rectangle_mass(means, covariances, low[:, None], high[:, None])


def density_of(cells: PairCells, weights: FloatArray) -> PairDensity:
    """Return the density of the experts that all places teach, weighted by `weights` (E,)."""
    anywhere = float(weights[_UNIFORM])
    if anywhere >= 1.0 - LEAST_MASS:
        return PairDensity(1.0, None, np.zeros(0, dtype=np.int64))
    mean, covariance = wide_gaussian(cells, np.ones(len(cells)))
    shares = cells.shares / cells.shares.sum()
    gaussians = [(weights[_WIDE : _WIDE + 1], mean[None], covariance[None])]
    for weight, h in zip(weights[_WIDE + 1 :], BANDWIDTHS, strict=True):
        gaussians.append((weight * shares, cells.means, cells.spreads + h * h * np.eye(2)))
    mixed, means, covariances = (np.concatenate(part) for part in zip(*gaussians, strict=True))
    groups = np.repeat(np.arange(len(gaussians)), [len(one[0]) for one in gaussians])
    return PairDensity(anywhere, GaussianMixture(mixed / mixed.sum(), means, covariances), groups)


@njit(cache=True)
def _add_heights(points, means, inverses, peaks, groups, heights):  # type: ignore[no-untyped-def]
    for m in range(len(means)):
        a, b, c = inverses[m, 0, 0], inverses[m, 0, 1], inverses[m, 1, 1]
        for n in range(len(points)):
            x, y = points[n, 0] - means[m, 0], points[n, 1] - means[m, 1]
            square = a * x * x + 2.0 * b * x * y + c * y * y
            if square < _FAR:
                heights[n, groups[m]] += peaks[m] * np.exp(-0.5 * square)
