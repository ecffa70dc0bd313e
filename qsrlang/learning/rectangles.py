"""How much of a Gaussian lies on a rectangle: what cuts a density to the support it lies on."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr, ndtri

from qsrlang.arrays import FloatArray

_NODES, _NODE_WEIGHTS = np.polynomial.legendre.leggauss(24)
_LEAST = 1e-300


def rectangle_mass(
    means: FloatArray, covariances: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Return the mass (...) of N(mean, covariance) between corners `low` and `high`, all (..., 2), broadcast.

    P = integral over x of phi(x) [Phi((y1 - m(x)) / s) - Phi((y0 - m(x)) / s)], m and s those of y given x; by
    Gauss-Legendre quadrature in the cumulative of x.
    """
    deviation = np.sqrt(covariances[..., 0, 0])
    left = ndtr((low[..., 0] - means[..., 0]) / deviation)
    right = ndtr((high[..., 0] - means[..., 0]) / deviation)
    cumulative = left[..., None] + (right - left)[..., None] * (0.5 * _NODES + 0.5)
    x = ndtri(np.clip(cumulative, _LEAST, 1.0 - 1e-16))
    slope = covariances[..., 0, 1] / deviation
    middle = means[..., 1][..., None] + slope[..., None] * x
    rest = np.sqrt(covariances[..., 1, 1] - slope**2)[..., None]
    inner = ndtr((high[..., 1][..., None] - middle) / rest) - ndtr((low[..., 1][..., None] - middle) / rest)
    return np.asarray(0.5 * (right - left) * (inner @ _NODE_WEIGHTS))


def upright_mass(means: FloatArray, deviations: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return the mass (...) where x and y do not correlate: the product of the two sides', all (..., 2)."""
    sides = ndtr((high - means) / deviations) - ndtr((low - means) / deviations)
    return np.asarray(sides.prod(axis=-1))
