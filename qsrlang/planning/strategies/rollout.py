"""`rollout`: one step of lookahead on the index, the default."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.simulating import follow_index
from qsrlang.planning.strategies.strategy import SHORTLIST, Ranking


@dataclass(frozen=True, slots=True)
class Rollout:
    """Ranks views by the cost of looking there and then wherever an index p^a / c says, belief and way updated.

    A one-step rollout (Bertsekas, Tsitsiklis and Wu 1997) on the best of several indices, one for each of `powers` a:
    small ones collect what is near, great ones make for the best view. `depth` bounds the looks that are simulated.
    """

    depth: int = 10
    powers: tuple[float, ...] = (0.5, 1.0, 1.5)
    is_farsighted: bool = True
    most: int = SHORTLIST

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return the seconds that each first view saves against never finding the target."""
        expected = follow_index(problem, self.depth, self.powers)
        return Ranking(saved(expected, problem), "seconds saved", expected)


def saved(expected: FloatArray, problem: ViewProblem) -> FloatArray:
    """Return how far expected costs (N,) [s] are below those of never finding anything."""
    worst = problem.seconds * len(problem.instances)
    finite = expected[np.isfinite(expected)]
    ceiling = worst if np.isfinite(worst) else (float(finite.max()) if len(finite) else 0.0)
    return np.asarray(np.where(np.isfinite(expected), ceiling - expected, -1.0e9))
