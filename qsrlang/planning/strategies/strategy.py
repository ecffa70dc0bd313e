"""What every way to rank views has in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.planning.problem import ViewProblem


@dataclass(frozen=True, slots=True, eq=False)
class Ranking:
    """What views are worth (N,), the more the better, in `unit`.

    `expected` (N,) is what a plan costs that starts there [s], nan where the strategy looks no further than one view.
    """

    values: FloatArray
    unit: str
    expected: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen_array("the values of views", self.values, (None,)))

    @classmethod
    def myopic(cls, values: FloatArray, unit: str) -> Ranking:
        """Return the ranking of a strategy that looks no further than one view."""
        return cls(values, unit, np.full(len(values), np.nan))


SHORTLIST = 80
"""How many views most strategies think through."""


class Strategy(Protocol):
    """A way to rank views."""

    @property
    def is_farsighted(self) -> bool:
        """Whether it needs the costs between views."""

    @property
    def most(self) -> int:
        """Of how many views it makes its choice at most."""

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return what each view is worth as the next one."""
