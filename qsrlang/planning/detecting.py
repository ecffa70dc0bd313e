"""How often a look shows what is in view, and how often it shows what is not there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError

DEFAULT_SPREAD = 0.1
DEFAULT_CONFIDENCE = 0.9
_STEEPNESS = 4.0


@dataclass(frozen=True, slots=True)
class Detector:
    """A detector as the robot assumes it: d(r, s) = rate / (1 + (r / (reach s))^4), 0 where nothing is in view.

    `rate` is the chance to recognise a thing close by; at a range r of `reach` times its size s it is half that
    (infinite: the same at every range). `false_alarms` is the chance that a look reports the target where it is
    not, anywhere in view; reported places err by `spread` [m] (standard
    deviation). A report ends a search where the belief that it is true is at least `confidence`.
    """

    rate: float = 0.9
    reach: float = math.inf
    false_alarms: float = 0.0
    spread: float = DEFAULT_SPREAD
    confidence: float = DEFAULT_CONFIDENCE

    def __post_init__(self) -> None:
        if not 0.0 < self.rate <= 1.0:
            raise ValueRangeError("the detection rate", self.rate, "above 0 and at most 1")
        if not self.reach > 0.0:
            raise ValueRangeError("the reach of a detector", self.reach, "a positive number of sizes")
        if not 0.0 <= self.false_alarms < 1.0:
            raise ValueRangeError("the false alarms of a detector", self.false_alarms, "0 or more, below 1")
        if not 0.0 < self.spread < math.inf:
            raise ValueRangeError("the spread of reported places", self.spread, "a positive number of metres")
        if not 0.0 < self.confidence < 1.0:
            raise ValueRangeError("the confidence of a detector", self.confidence, "above 0, below 1")

    @property
    def is_flat(self) -> bool:
        """Whether the range makes no difference."""
        return math.isinf(self.reach)

    def rates(self, ranges: FloatArray, size: float) -> FloatArray:
        """Return d(r, s) for ranges (...) [m] and a thing of `size` [m]: (...)."""
        if self.is_flat or size == 0.0:
            return np.full(np.shape(ranges), self.rate)
        return np.asarray(self.rate / (1.0 + (ranges / (self.reach * size)) ** _STEEPNESS))
