"""The probability that a Gaussian vector points into arcs of directions."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ndtr, ndtri, owens_t

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.densities.sectors import Arcs
from qsrlang.mixtures.gaussian import definite

_HALF_TURN = 1e-9
_HEADINGS = 9
_SHARES = 256


def cone_probability(arcs: Arcs, axis: float, hand: float, mean: FloatArray, covariance: FloatArray) -> float:
    """Return P(hand (angle of d - axis) in arcs) for d ~ N(mean (2,), covariance (2, 2)), axis [rad]; hand is +1 or -1.

    A bivariate normal over a cone, by Owen's T function (Owen 1956); what is certain has a spread of MIN_DEVIATION.
    """
    total, covariance = 0.0, definite(covariance)
    for start, width in arcs.arcs:
        low = axis + start if hand > 0.0 else axis - start - width
        total += _sector(low, width, mean, covariance)
    return min(max(total, 0.0), 1.0)


def turning_cone_probability(
    arcs: Arcs, offset: float, hand: float, mean: FloatArray, covariance: FloatArray
) -> float:
    """Return the same for (d, heading) ~ N(mean (3,), covariance (3, 3)) and the axis heading + offset [rad].

    A sum over headings, d given each; exact where the heading is certain.
    """
    variance = covariance[2, 2]
    if variance == 0.0:
        return cone_probability(arcs, mean[2] + offset, hand, mean[:2], covariance[:2, :2])
    slope = covariance[:2, 2] / variance
    rest = definite(covariance[:2, :2] - np.outer(slope, slope) * variance)
    blur = math.sqrt(np.linalg.eigvalsh(rest)[0]) / math.hypot(*mean[:2], 1e-9)
    turns, weights = _turns(math.sqrt(variance), blur)
    found = [
        cone_probability(arcs, mean[2] + turn + offset, hand, mean[:2] + slope * turn, rest) for turn in turns
    ]
    return float(weights @ found / weights.sum())


def _turns(deviation: float, blur: float) -> tuple[FloatArray, FloatArray]:
    """Return how far headings are from their mean, and their weights, for directions that are known up to a blur [rad].

    Gauss-Hermite where what is summed is smooth, else the middles of equal shares.
    """
    if deviation < 0.5 * blur:
        nodes, weights = np.polynomial.hermite_e.hermegauss(_HEADINGS)
        return deviation * nodes, weights
    return deviation * ndtri((np.arange(_SHARES) + 0.5) / _SHARES), np.ones(_SHARES)


def _sector(low: float, width: float, mean: FloatArray, covariance: FloatArray) -> float:
    """Return P(angle of d in [low, low + width])."""
    if width > math.pi + _HALF_TURN:
        return 1.0 - _sector(low + width, 2.0 * math.pi - width, mean, covariance)
    sides = np.array([[-math.sin(low), math.cos(low)], [math.sin(low + width), -math.cos(low + width)]])
    spread = sides @ covariance @ sides.T
    deviations = np.sqrt(np.diag(spread))
    h, k = (sides @ mean / deviations).tolist()
    if width >= math.pi - _HALF_TURN:
        return float(ndtr(h))
    return bivariate_cdf(h, k, float(spread[0, 1] / (deviations[0] * deviations[1])))


def bivariate_cdf(h: float, k: float, correlation: float) -> float:
    """Return P(X <= h, Y <= k) of standard normal X and Y: Owen 1956, equation 3.1."""
    root = math.sqrt(max(1.0 - correlation * correlation, 1e-300))
    if h == 0.0 and k == 0.0:
        return 0.25 + math.asin(max(-1.0, min(correlation, 1.0))) / (2.0 * math.pi)
    across_h = (k / h - correlation) / root if h else math.copysign(math.inf, k)
    across_k = (h / k - correlation) / root if k else math.copysign(math.inf, h)
    apart = 0.0 if (h < 0.0) == (k < 0.0) else 0.5
    tails = owens_t(h, across_h) + owens_t(k, across_k)
    return float(0.5 * (ndtr(h) + ndtr(k)) - tails - apart)
