"""`index`: chance over cost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.strategy import SHORTLIST, Ranking


@dataclass(frozen=True, slots=True)
class Index:
    """Ranks views by p(v) / c(v), with c = travel + turn + dwell [s].

    For views that do not overlap and are equally far from each other this order is optimal (Blackwell, in Chew 1967).
    """

    is_farsighted: bool = False
    most: int = SHORTLIST

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return p(v) / c(v) of each view [1/s]."""
        return Ranking.myopic(problem.gains() / problem.first, "chance per second")
