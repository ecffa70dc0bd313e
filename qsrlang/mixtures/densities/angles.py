"""Densities on the circle, as nodes of a quadrature and as draws."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

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
        return _nodes(self)

    @property
    def cell(self) -> float:
        """The width of the cell about each node [rad]."""
        return 2.0 * self._half_range / _NODES

    def quantile(self, shares: FloatArray) -> FloatArray:
        """Return the angles (P,) below which shares (P,) of the mass lie, counted from the far side [rad]."""
        if self.deviation == 0.0:
            return np.asarray(self.mean + self.width * (shares - 0.5))
        return np.asarray(self.mean + self.deviation * ndtri(shares))

    @property
    def spread(self) -> float:
        """A width to compare terms by [rad]."""
        return min(self.width, 2.0 * self.deviation or math.inf)

    @property
    def _half_range(self) -> float:
        return min(0.5 * self.width, _REACH_IN_DEVIATIONS * self.deviation or math.inf)


@lru_cache(maxsize=256)
def _nodes(density: Bump) -> tuple[FloatArray, FloatArray]:
    angles = density.mean + ((np.arange(_NODES) + 0.5) / _NODES * 2.0 - 1.0) * density._half_range
    weights = density.pdf(angles)
    weights /= weights.sum()
    for array in (angles, weights):
        array.setflags(write=False)
    return angles, weights


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
