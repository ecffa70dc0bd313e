"""Densities as the language states them: counts of relations, each with a metric fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.learning.cells import PairCells
from qsrlang.learning.density import PairDensity
from qsrlang.learning.experts import WIDE_DEVIATION
from qsrlang.learning.learner import LearnedPair
from qsrlang.learning.rhythm import DIRECTIONS, direction_numbers
from qsrlang.mixtures import reduction
from qsrlang.mixtures.answers import Component
from qsrlang.mixtures.gaussian import GaussianMixture

# Gaussians for what is told precisely, and one more for all that is not.
PRECISE = 4
# What general knowledge weighs beside the sightings at one place, in sightings; half of a first one is chance.
STRENGTH = 0.6
# Components at least this wide [m] tell little more than about where; they are written as one Gaussian.
WIDE = 0.3
_MIN_COUNT = 0.05
_FREEDOM = 4.0
# How far a thing wanders about its usual place on a desk before any was measured there [m].
PLACE_DEVIATION = 0.06


@dataclass(frozen=True, slots=True)
class FittedCount:
    """`observe count × relation(X, L) ~ normal(mean, deviation, correlation)`, in metres."""

    count: float
    relation: str
    mean: tuple[float, float]
    deviation: tuple[float, float]
    correlation: float

    def scaled(self, factor: float) -> FittedCount:
        """Return the same fit with another count."""
        return FittedCount(self.count * factor, self.relation, self.mean, self.deviation, self.correlation)


def general_fits(one: LearnedPair) -> list[FittedCount]:
    """Return the density of a pair as counts that sum to how much of it was seen, the largest first."""
    return fits_of(written_mixture(one.density), float(one.cells.counts.sum()))


def written_mixture(density: PairDensity) -> GaussianMixture:
    """Return the few Gaussians that stand for a density in a file; what is anywhere goes to the widest of them."""
    assert density.mixture is not None
    weights = density.mixture.weights * (1.0 - density.anywhere)
    means, covariances = density.mixture.means, density.mixture.covariances
    wide = np.linalg.det(covariances) ** 0.25 >= WIDE
    parts = []
    if weights[~wide].sum() > 0.0:
        precise = GaussianMixture(weights[~wide] / weights[~wide].sum(), means[~wide], covariances[~wide])
        parts.append((float(weights[~wide].sum()), reduced(precise, PRECISE)))
    rest = _rest(density.mixture, wide & (weights > 0.0))
    parts.append((float(weights[wide].sum()) + density.anywhere, rest))
    return mixed([part for part in parts if part[0] > 0.0])


def _rest(mixture: GaussianMixture, wide: BoolArray) -> GaussianMixture:
    """Return one Gaussian for the wide components; without any, for all, as much wider as those would be."""
    if wide.any():
        weights = mixture.weights[wide] / mixture.weights[wide].sum()
        return reduced(GaussianMixture(weights, mixture.means[wide], mixture.covariances[wide]), 1)
    mean, covariance = mixture.moments()
    return GaussianMixture(np.ones(1), mean[None], covariance[None] + WIDE_DEVIATION**2 * np.eye(2))


def reduced(mixture: GaussianMixture, count: int) -> GaussianMixture:
    """Return a mixture of at most `count` Gaussians with the same mean and covariance as a whole (Runnalls 2007)."""
    columns = zip(mixture.weights.tolist(), mixture.means, mixture.covariances, strict=True)
    few = reduction.reduced([Component(*one, ()) for one in columns if one[0] > 0.0], count)
    weights = np.array([one.weight for one in few])
    means, covariances = np.stack([one.mean for one in few]), np.stack([one.covariance for one in few])
    return GaussianMixture(weights / weights.sum(), means, covariances)


def mixed(parts: Sequence[tuple[float, GaussianMixture]]) -> GaussianMixture:
    """Return mixtures as one, each with its weight."""
    total = sum(weight for weight, _ in parts)
    return GaussianMixture(
        np.concatenate([weight / total * mixture.weights for weight, mixture in parts]),
        np.concatenate([mixture.means for _, mixture in parts]),
        np.concatenate([mixture.covariances for _, mixture in parts]),
    )


def fits_of(mixture: GaussianMixture, count: float) -> list[FittedCount]:
    """Return a mixture's components as counts, each under the direction its mean lies in."""
    directions = direction_numbers(mixture.means)
    fits = [
        _fit(count * weight, DIRECTIONS[direction], mean, covariance)
        for weight, direction, mean, covariance in zip(
            mixture.weights, directions, mixture.means, mixture.covariances, strict=True
        )
    ]
    return sorted((fit for fit in fits if fit.count >= _MIN_COUNT), key=lambda fit: -fit.count)


def place_fits(cells: PairCells, general: GaussianMixture) -> list[FittedCount]:
    """Return what was seen at one place as a count and fit for each direction, and general knowledge beside it.

    A fit has its own mean, and the covariance of an inverse-Wishart posterior: Psi + S over nu + n, where Psi is that
    of PLACE_DEVIATION and nu is 4.
    """
    mean, covariance = general.moments()
    directions = direction_numbers(cells.means)
    fits = []
    for number in np.unique(directions):
        own = directions == number
        fits.append(_posterior(cells, own, DIRECTIONS[number]))
    return [*fits, *fits_of(GaussianMixture(np.ones(1), mean[None], covariance[None]), STRENGTH)]


def _posterior(cells: PairCells, own: BoolArray, relation: str) -> FittedCount:
    counts = cells.counts[own]
    mean = counts @ cells.means[own] / counts.sum()
    off = cells.means[own] - mean
    scatter = np.einsum("m,mij->ij", counts, cells.spreads[own]) + off.T @ (counts[:, None] * off)
    covariance = (scatter + _FREEDOM * PLACE_DEVIATION**2 * np.eye(2)) / (counts.sum() + _FREEDOM)
    return _fit(float(counts.sum()), relation, mean, covariance)


def _fit(count: float, relation: str, mean: FloatArray, covariance: FloatArray) -> FittedCount:
    deviation = np.sqrt(np.diag(covariance))
    correlation = float(np.clip(covariance[0, 1] / deviation.prod(), -0.95, 0.95))
    (x, y), (dx, dy) = mean.tolist(), deviation.tolist()
    return FittedCount(float(count), relation, (x, y), (dx, dy), correlation)
