"""`tour`: the best of many sampled tours, as in the authors' later planner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from qsrlang.arrays import IntArray
from qsrlang.errors import ValueRangeError
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.rollout import saved
from qsrlang.planning.strategies.simulating import follow_orders
from qsrlang.planning.strategies.strategy import SHORTLIST, Ranking

MAX_TOURS = 1_000_000


@dataclass(frozen=True, slots=True)
class Tour:
    """Ranks views by the best of `tours` sampled tours that start with them.

    The sampling of viper (Kunze et al. 2016): P(next view) ~ (value + 0.5) exp(-cost), `looks` views a tour. Values
    are of views on their own, relative to the best; the cost of a tour counts overlapping views once.
    """

    tours: int = 1_000
    looks: int = 10
    is_farsighted: bool = True
    most: int = SHORTLIST

    def __post_init__(self) -> None:
        for what, value in (("tours", self.tours), ("looks of a tour", self.looks)):
            if not 1 <= value <= MAX_TOURS:
                raise ValueRangeError(f"the number of {what}", value, f"1 to {MAX_TOURS}")

    def rank(self, problem: ViewProblem, rng: np.random.Generator) -> Ranking:
        """Return the seconds that the best sampled tour from each first view saves; views of no tour come last."""
        orders = sample_tours(problem, self.tours, self.looks, rng)
        expected = np.full(len(problem), np.inf)
        np.minimum.at(expected, orders[:, 0], follow_orders(problem, orders))
        return Ranking(saved(expected, problem), "seconds saved", expected)


def sample_tours(problem: ViewProblem, tours: int, looks: int, rng: np.random.Generator) -> IntArray:
    """Return tours as rows of views (T, L); -1 where no view is left that there is a way to."""
    gains = problem.gains()
    values = gains / gains.max() if gains.max() > 0.0 else gains
    orders = np.full((tours, min(looks, len(problem))), -1, dtype=np.int64)
    _sample(values + 0.5, problem.first, problem.between, rng.random(orders.shape), orders)
    return orders


@njit(cache=True)
def _sample(worth, first, between, draws, orders):  # type: ignore[no-untyped-def]
    weights = np.empty(len(worth))
    for tour in range(len(orders)):
        used = np.zeros(len(worth), dtype=np.bool_)
        view = -1
        for look in range(orders.shape[1]):
            costs = first if view < 0 else between[view]
            least, total = np.inf, 0.0
            for other in range(len(worth)):
                if not used[other]:
                    least = min(least, costs[other])
            if least == np.inf:
                break
            for other in range(len(worth)):
                weights[other] = 0.0 if used[other] else worth[other] * np.exp(least - costs[other])
                total += weights[other]
            draw, view = draws[tour, look] * total, -1
            for other in range(len(worth)):
                if weights[other] > 0.0:
                    view = other
                    draw -= weights[other]
                    if draw < 0.0:
                        break
            used[view] = True
            orders[tour, look] = view
