"""`nearest`: the view that is reached first of those that show anything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.strategy import SHORTLIST, Ranking


@dataclass(frozen=True, slots=True)
class Nearest:
    """Ranks views that show anything by 1 / c(v)."""

    is_farsighted: bool = False
    most: int = SHORTLIST

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return 1 / c(v) of each view that shows anything, else 0."""
        return Ranking.myopic(np.where(problem.gains() > 0.0, 1.0 / problem.first, 0.0), "1/s")
