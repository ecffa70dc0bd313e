"""`exact`: dynamic programming over sets of views, the oracle of the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.strategy import Ranking

MAX_VIEWS = 13


@dataclass(frozen=True, slots=True)
class Exact:
    """Ranks views by the least cost of any order of all views that starts with them.

    J(S, v) = min_u c(v, u) M(S) + J(S + u, u), with M(S) the chance that looks S have not found the target; for at
    most 13 views and without a time limit, on which the best order would depend.
    """

    is_farsighted: bool = True
    most: int = MAX_VIEWS

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return minus the least cost [s] of each first view."""
        expected = least_costs(problem)
        return Ranking(-expected, "- seconds", expected)


def least_costs(problem: ViewProblem) -> FloatArray:
    """Return the least cost [s] of looking from all views, for each first view: (N,). Raises ValueRangeError."""
    count = len(problem)
    if not 1 <= count <= MAX_VIEWS:
        raise ValueRangeError("the number of views of an exact plan", count, f"1 to {MAX_VIEWS}")
    left = chances_left(problem)
    future = np.zeros((1 << count, count))
    for looked in range((1 << count) - 2, 0, -1):
        ahead = [view for view in range(count) if not looked >> view & 1]
        behind = [view for view in range(count) if looked >> view & 1]
        onward = np.array([future[looked | 1 << view, view] for view in ahead])
        costs = problem.between[np.ix_(behind, ahead)] * left[looked] + onward
        future[looked, behind] = costs.min(axis=1)
    return np.array([problem.first[view] * left[0] + future[1 << view, view] for view in range(count)])


def chances_left(problem: ViewProblem) -> FloatArray:
    """Return sum_g phi_g(S) / phi_g(0) for every set S of views, as bits: (2^N,)."""
    count, misses = len(problem), 1.0 - problem.views.table()
    masses = np.empty((1 << count, problem.views.places))
    masses[0] = problem.mass
    for looked in range(1, 1 << count):
        lowest = (looked & -looked).bit_length() - 1
        masses[looked] = masses[looked & looked - 1] * misses[lowest]
    left = np.zeros(1 << count)
    for goal, one in enumerate(problem.instances):
        chances = one.unfound(problem.absent[goal] + masses[:, problem.goal_of == goal].sum(axis=1))
        left += chances / chances[0] if chances[0] > 0.0 else 0.0
    return left
