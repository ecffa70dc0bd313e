"""Moments beside those of draws, and densities beside their sums over a grid."""

from __future__ import annotations

import math

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.densities.conditional import Conditional

DRAWS = 60_000


def assert_draws_have_the_moments(conditional: Conditional, state: FloatArray, seed: int = 7) -> None:
    """Check mean and covariance; false-alarm rate below 1e-5: five standard errors, from the draws' own spread."""
    uniforms = np.random.default_rng(seed).random((DRAWS, 3))
    draws = conditional.sample(np.tile(state, (DRAWS, 1)), uniforms)
    (mean,), (covariance,) = conditional.moments(state[None])
    centred = draws - mean
    assert (np.abs(centred.mean(axis=0)) <= 5.0 * centred.std(axis=0) / math.sqrt(DRAWS)).all()
    products = np.einsum("ni,nj->nij", centred, centred)
    error = products.std(axis=0) / math.sqrt(DRAWS)
    assert (np.abs(products.mean(axis=0) - covariance) <= 5.0 * error + 1e-6).all()


def grid_moments(
    conditional: Conditional, state: FloatArray, centre: FloatArray, half: float, step: float
) -> tuple[float, FloatArray, FloatArray]:
    """Return mass, mean (2,) and covariance (2, 2) of a density by its sum over a square grid."""
    axis = np.arange(-half, half, step) + 0.5 * step
    points = centre + np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    mass = conditional.pdf(points, np.tile(state, (len(points), 1))) * step**2
    return float(mass.sum()), mass @ points / mass.sum(), np.cov(points.T, aweights=mass, ddof=0)
