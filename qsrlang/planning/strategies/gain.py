"""`belief`: the view likeliest to show the target, whatever it costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.strategy import SHORTLIST, Ranking


@dataclass(frozen=True, slots=True)
class Gain:
    """Ranks views by p(v), the chance that one look finds the target."""

    is_farsighted: bool = False
    most: int = SHORTLIST

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return p(v) of each view."""
        return Ranking.myopic(problem.gains(), "chance to find it")
