"""Densities on the circle, as nodes of a quadrature and as draws."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import TURN, wrap
from qsrlang.language.syntax import Anywhere, Density, Mix, Normal, Uniform

_REACH_IN_DEVIATIONS = 8.0
_NODES = 256


@dataclass(frozen=True, slots=True)
class Bump:
    """A density on the circle: a wrapped normal, or uniform on an arc of `width` about `mean` [rad]."""

    mean: float
    deviation: float
    width: float

    def pdf(self, angles: npt.ArrayLike) -> FloatArray:
        """Return the density at angles (...): (...,) [1/rad]."""
        off = wrap(np.asarray(angles) - self.mean)
        if self.deviation == 0.0:
            return np.where(np.abs(off) <= 0.5 * self.width, 1.0 / self.width, 0.0)
        turns = np.arange(-3, 4) * TURN
        z = (off[..., None] + turns) / self.deviation
        return np.asarray(np.exp(-0.5 * z**2).sum(axis=-1) / (self.deviation * math.sqrt(TURN)))

    def nodes(self) -> tuple[FloatArray, FloatArray]:
        """Return angles (K,) and weights (K,) of a midpoint rule for integrals against this density."""
        reach = min(0.5 * self.width, _REACH_IN_DEVIATIONS * self.deviation or math.inf)
        offsets = (np.arange(_NODES) + 0.5) / _NODES * 2.0 * reach - reach
        weights = self.pdf(self.mean + offsets)
        return self.mean + offsets, weights / weights.sum()

    def sample(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Return `count` draws (count,) [rad]."""
        if self.deviation == 0.0:
            return np.asarray(self.mean + self.width * (rng.random(count) - 0.5))
        return np.asarray(rng.normal(self.mean, self.deviation, count))

    @property
    def spread(self) -> float:
        """A width to compare terms by [rad]."""
        return min(self.width, 2.0 * self.deviation or math.inf)


def bump(density: Density | None) -> Bump:
    """Return a density on the circle; None says nothing, like `any`.

    Raises ValueRangeError for a `mix`, whose parts are alternatives (`Relation.terms`).
    """
    match density:
        case Normal(mean=mean, deviation=deviation):
            return Bump(mean.value, deviation.value, TURN)
        case Uniform(low=low, high=high):
            return Bump(0.5 * (low.value + high.value), 0.0, min(high.value - low.value, TURN))
        case Mix():
            raise ValueRangeError("an angle", "a mix", "one of its parts")
        case Anywhere() | None:
            return Bump(0.0, 0.0, TURN)
