"""Intervals: what a number of trials says about the next one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError

RESAMPLES = 10_000
CONFIDENCE = 0.95
MAX_DRAWS_AT_ONCE = 4_000_000


@dataclass(frozen=True, slots=True)
class Interval:
    """A confidence interval, low to high."""

    low: float
    high: float


def wilson_interval(successes: int, trials: int, confidence: float = CONFIDENCE) -> Interval:
    """Return Wilson's score interval of a success rate.

    With p = k / n and z the normal quantile of (1 + confidence) / 2 (Wilson, 1927):
    (p + z^2 / 2n -+ z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n). 10 of 10 gives [0.72, 1].
    Raises ValueRangeError unless 0 <= successes <= trials and trials > 0.
    """
    if trials < 1 or not 0 <= successes <= trials:
        raise ValueRangeError(
            "the count of successes", f"{successes} of {trials}", "0 to the number of trials"
        )
    z = NormalDist().inv_cdf(0.5 * (1.0 + _checked(confidence)))
    rate = successes / trials
    centre = rate + z * z / (2 * trials)
    spread = z * math.sqrt(rate * (1.0 - rate) / trials + z * z / (4 * trials * trials))
    scale = 1.0 + z * z / trials
    low = 0.0 if successes == 0 else (centre - spread) / scale
    high = 1.0 if successes == trials else (centre + spread) / scale
    return Interval(low, high)


def bootstrap_interval(
    values: npt.ArrayLike, seed: int = 0, confidence: float = CONFIDENCE, resamples: int = RESAMPLES
) -> Interval:
    """Return the percentile bootstrap interval of the mean of `values` (N,).

    The quantiles (1 -+ confidence) / 2 of the means of `resamples` draws of N values with replacement
    (Efron, 1979). The same seed gives the same interval. Raises ValueRangeError where there are no values.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.ndim != 1 or len(sample) == 0:
        raise ValueRangeError("the shape of the values of a mean", sample.shape, "(N,) with N of at least 1")
    tail = 0.5 * (1.0 - _checked(confidence))
    low, high = np.quantile(
        _resampled_means(sample, np.random.default_rng(seed), resamples), [tail, 1.0 - tail]
    )
    return Interval(float(low), float(high))


def paired_interval(
    first: npt.ArrayLike, second: npt.ArrayLike, seed: int = 0, confidence: float = CONFIDENCE
) -> Interval:
    """Return the bootstrap interval of mean(first - second) over trials that share their random numbers (N,)."""
    differences = np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64)
    return bootstrap_interval(differences, seed, confidence)


def _resampled_means(sample: FloatArray, rng: np.random.Generator, resamples: int) -> FloatArray:
    rows = max(1, MAX_DRAWS_AT_ONCE // len(sample))
    chunks = [min(rows, resamples - first) for first in range(0, resamples, rows)]
    return np.concatenate(
        [sample[rng.integers(len(sample), size=(n, len(sample)))].mean(axis=1) for n in chunks]
    )


def _checked(confidence: float) -> float:
    if not 0.0 < confidence < 1.0:
        raise ValueRangeError("a confidence", confidence, "a share above 0 and below 1")
    return confidence
