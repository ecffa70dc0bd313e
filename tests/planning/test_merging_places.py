"""Places that all views show alike, taken together: fewer of them, and every plan costs what it did."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.planning.instances import ONE, Instances
from qsrlang.planning.merging import merged
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.views import Views, beside

seeds = st.integers(0, 2**32 - 1)


def problem_of_few_kinds(rng, goals=2, views=5, places=60, kinds=4):
    """Return a problem whose places are of `kinds` kinds, each shown by the views at rates of its own."""
    rates = np.where(rng.random((views, kinds)) < 0.6, rng.choice([0.5, 0.9], (views, kinds)), 0.0)
    tables = [rates[:, rng.integers(kinds, size=places)] for _ in range(goals)]
    mass = rng.random(goals * places)
    return ViewProblem(
        views=beside([Views.of_rates(np.zeros((views, 3)), table) for table in tables]),
        mass=mass / mass.sum(),
        first=rng.uniform(1, 5, views),
        between=rng.uniform(1, 5, (views, views)),
        seconds=20.0,
        goal_of=np.repeat(np.arange(goals), places),
        absent=np.full(goals, 0.1),
        instances=(ONE, Instances(3))[:goals],
    )


@given(seeds, st.integers(1, 2))
def test_plans_cost_the_same_with_places_merged(seed, goals):
    rng = np.random.default_rng(seed)
    problem = problem_of_few_kinds(rng, goals)
    fewer = merged(problem)
    assert fewer.views.places <= 4 * goals
    np.testing.assert_allclose(fewer.unseen, problem.unseen, rtol=1e-9)
    np.testing.assert_allclose(fewer.gains(), problem.gains(), rtol=1e-9, atol=1e-12)
    for _ in range(5):
        order = rng.permutation(5)
        np.testing.assert_allclose(fewer.cost_of(order), problem.cost_of(order), rtol=1e-9)


@given(seeds)
def test_the_places_merged_are_those_with_equal_columns(seed):
    problem = problem_of_few_kinds(np.random.default_rng(seed))
    columns = np.vstack([problem.views.table(), problem.goal_of])
    kept = merged(problem)
    told = np.vstack([kept.views.table(), kept.goal_of])
    assert set(map(tuple, told.T)) == set(map(tuple, columns.T))
    assert told.shape[1] == len(set(map(tuple, columns.T)))


def test_places_that_differ_stay_apart():
    rng = np.random.default_rng(0)
    rates = rng.random((6, 50))
    problem = ViewProblem.of_one(
        Views.of_rates(np.zeros((6, 3)), rates), np.full(50, 0.02), np.ones(6), np.ones((6, 6))
    )
    assert merged(problem).views.places == 50
