"""How many instances of a target there may be, any one of which will do."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError

MAX_INSTANCES = 10_000.0


@dataclass(frozen=True, slots=True)
class Instances:
    """A number of instances, placed independently by one belief: exactly `count`, or Poisson with that mean.

    With u the share of one instance's mass that the looks so far would not have shown (places not seen, and
    "not here"), none was shown with probability u^n, or exp(-n (1 - u)) for a Poisson number of mean n.
    """

    count: float = 1.0
    poisson: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.count <= MAX_INSTANCES:
            raise ValueRangeError(
                "the number of instances", self.count, f"above 0, at most {MAX_INSTANCES:g}"
            )
        if not self.poisson and self.count != math.floor(self.count):
            raise ValueRangeError(
                "the number of instances", self.count, "a whole number, or the mean of a Poisson number"
            )

    @classmethod
    def about(cls, mean: float) -> Instances:
        """Return a Poisson number of instances with this mean."""
        return cls(mean, poisson=True)

    def unfound(self, unseen: npt.ArrayLike) -> FloatArray:
        """Return the chance that no instance was shown where one instance's unseen mass is u (...): (...)."""
        share = np.asarray(unseen, dtype=np.float64)
        return np.exp(-self.count * (1.0 - share)) if self.poisson else share**self.count

    def none_here(self, mass: float, absent: float) -> float:
        """Return P(no instance is here | none was shown): `mass` of one is here unseen, `absent` is elsewhere.

        (absent / (mass + absent))^n, or exp(-n mass) for a Poisson number.
        """
        if self.poisson:
            return math.exp(-self.count * mass)
        whole = mass + absent
        return (absent / whole) ** self.count if whole > 0.0 else 1.0


ONE = Instances()
