"""The oracle against results in closed form, and against an engine that is wrong on purpose.

A limit of 5 standard errors lets a right program fail with probability 6e-7 per normal figure; seeds are fixed.
"""

from dataclasses import replace

import numpy as np
import pytest
from comparing_engines import compare, energy_distance
from generated_knowledge import MAKERS, generate
from naive_worlds import naive_worlds
from oracle import consult

import qsrlang as qsr

LIMIT = 5.0


def asked(text, target="A", events=(), **more):
    graph = qsr.parse_knowledge(text).graph
    events = tuple(qsr.parse_formula(event) for event in events)
    return consult(graph, target, events, count=20_000, rng=np.random.default_rng(5), **more)


def near(measured, expected):
    return (np.abs(measured.value - expected) <= LIMIT * measured.error + 1e-12).all()


def test_a_box_on_a_table_is_uniform_where_it_does_not_stand_out():
    found = asked("""
        surface D { size: 100 cm × 60 cm }. dynamic A { size: 20 cm × 10 cm }.
        landmark d : D at (1 m, 2 m) facing 0 deg. observe on(A, D).
    """)
    assert near(found.means, [[1.0, 2.0]])
    assert near(found.covariances, [[0.5**2 / 12.0, 0.0, 0.8**2 / 12.0]])


def test_the_mean_of_a_wrapped_normal_direction_over_a_uniform_way():
    """E cos = exp(-sd^2 / 2), and half of the reach on average."""
    found = asked("""
        static M. dynamic A. relation off(referent, relatum) { angle: normal(90 deg, 30 deg) }.
        landmark m : M at (0 m, 0 m) facing 180 deg. observe off(A, M).
    """)
    assert near(found.means, [[0.0, 0.375 * np.exp(-0.5 * np.radians(30.0) ** 2)]])


def test_two_fits_are_the_product_of_two_gaussians_and_weigh_by_their_agreement():
    """Sources at 0 and 0.3 with variances 0.04 and 0.01; the alternative to the second is at 0.6."""
    found = asked("""
        static M, N. dynamic A.
        landmark m : M at (0 m, 0 m) facing 0 deg. landmark n : N at (0 m, 0 m) facing 0 deg.
        observe behind-of(A, M) wrt absolute ~ normal((0 cm, 0 cm), (20 cm, 20 cm), 0).
        observe 1 × behind-of(A, N) wrt absolute ~ normal((30 cm, 0 cm), (10 cm, 10 cm), 0).
        observe 3 × behind-of(A, N) wrt absolute ~ normal((60 cm, 0 cm), (10 cm, 10 cm), 0).
    """)
    order = np.argsort(found.means.value[:, 1])
    odds = np.array([0.25, 0.75]) * np.exp(-0.5 * np.array([0.3, 0.6]) ** 2 / 0.05)
    assert (np.abs(found.means.value[order, 1] - [0.24, 0.48]) <= LIMIT * found.means.error[order, 1]).all()
    assert (
        np.abs(found.weights.value[order] - odds / odds.sum()) <= LIMIT * found.weights.error[order]
    ).all()
    assert found.covariances.value[:, 0] == pytest.approx(0.008, rel=0.1)


def test_sharp_events_have_the_shares_of_their_sectors():
    text = """
        static M. dynamic A. relation around(referent, relatum) { angle: any, distance: uniform(0 cm, 60 cm) }.
        landmark m : M at (0 m, 0 m) facing 20 deg. believe 0.8 :: around(A, M) | elsewhere.
    """
    found = asked(text, None, ["left-of(A, M)", "close-to(A, M)", "¬left-of(A, M) ∧ close-to(A, M)"])
    assert near(found.events, [0.2, 0.8 * 37.5 / 60.0, 0.6 * 37.5 / 60.0])
    given = asked(text, "A", ["left-of(A, M)"], given=qsr.parse_formula("right-of(A, M) or left-of(A, M)"))
    assert near(given.events, [0.5])
    assert given.elsewhere.value == 0.0


def test_soft_requirements_weigh_by_bayes_rule():
    found = asked(
        """
        static M. dynamic A. landmark m : M at (0 m, 0 m) facing 20 deg.
        believe 0.3 :: left-of(A, M) | 0.7 :: right-of(A, M). require 0.9 :: left-of(A, M).
    """,
        None,
        ["left-of(A, M)"],
    )
    assert found.events.value[0] == pytest.approx(0.27 / 0.34, abs=1e-3)


@pytest.mark.parametrize("kind", MAKERS)
def test_shares_of_the_worlds_of_one_base_sum_to_one(kind):
    base = generate(kind, 3)
    graph = qsr.parse_knowledge(base.text).graph
    assert sum(world.share for world in naive_worlds(graph, (base.target,))) == pytest.approx(1.0)


def test_energy_distance_tells_other_places_and_other_shapes():
    rng = np.random.default_rng(2)
    one, same = rng.standard_normal((2, 800, 2))
    assert abs(energy_distance(one, same)) < 2e-3
    assert energy_distance(one, same + np.array([0.5, 0.0])) > 0.02
    assert energy_distance(one, 1.5 * same) > 0.01


def moved(known):
    """Knowledge of landmarks that stand 4 cm off."""
    return known.with_landmarks(*(replace(one, x=one.x + 0.04) for one in known.landmarks))


def turned(known):
    """Knowledge of landmarks that are turned by 5 deg."""
    return known.with_landmarks(*(replace(one, heading=one.heading + 0.09) for one in known.landmarks))


PLACED_BY_HEADINGS = ("one hop", "chain", "region", "on a desk")
WRONG = [
    *((kind, moved) for kind in (*PLACED_BY_HEADINGS, "fits", "fused fits")),
    *((kind, turned) for kind in PLACED_BY_HEADINGS),
]


@pytest.mark.parametrize(("kind", "wrong"), WRONG)
def test_an_engine_that_is_wrong_is_told(kind, wrong):
    scores = [compare(generate(kind, seed), draws=10, prepare=wrong).z for seed in range(4)]
    assert np.square(np.hstack(scores)).mean() > 3.0
