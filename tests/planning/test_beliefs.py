"""The belief of a search: Bayes' rule against a double loop, instances, repeats, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.planning.belief import Belief
from qsrlang.planning.detecting import Detector
from qsrlang.planning.instances import Instances
from qsrlang.planning.noise import Noise
from qsrlang.planning.outcome import Limits
from qsrlang.planning.repeats import PastLook, Repeats, discounted
from qsrlang.planning.views import Views

seeds = st.integers(0, 2**32 - 1)


def some_belief(rng, count=20, absent=0.2):
    points = rng.uniform(-2, 2, (count, 3))
    return Belief.of_weights(points, rng.random(count) + 0.01, 0.3, absent)


@given(seeds, st.floats(0.0, 0.9), st.floats(0.0, 1.0))
def test_a_belief_sums_to_one_whatever_was_seen(seed, absent, floor):
    rng = np.random.default_rng(seed)
    belief = Belief.of_weights(rng.uniform(-2, 2, (20, 3)), rng.random(20) + 0.01, floor, absent)
    for _ in range(4):
        assert belief.probabilities.sum() + belief.absence_of_one == pytest.approx(1.0)
        belief = belief.after_miss(rng.random(20) * (rng.random(20) < 0.5))
    seen = belief.after_detection(rng.random(20), rng.uniform(-2, 2, 3), Detector(0.8, false_alarms=0.1))
    assert seen.probabilities.sum() + seen.absence_of_one == pytest.approx(1.0)


@given(seeds)
def test_a_miss_is_bayes_rule_and_hidden_places_keep_their_mass(seed):
    rng = np.random.default_rng(seed)
    belief = some_belief(rng)
    rates = rng.random(20) * (rng.random(20) < 0.5)
    after = belief.after_miss(rates)
    hidden = rates == 0.0
    np.testing.assert_allclose(after.mass[hidden], belief.mass[hidden])
    evidence = (belief.mass * (1 - rates)).sum() + belief.absent_mass
    np.testing.assert_allclose(after.probabilities, belief.mass * (1 - rates) / evidence)
    assert after.absence >= belief.absence


@given(seeds, st.floats(0.01, 0.5))
def test_a_report_is_bayes_rule_with_false_alarms(seed, false_alarms):
    rng = np.random.default_rng(seed)
    belief, rates = some_belief(rng), rng.random(20) * (rng.random(20) < 0.7)
    place, detector = belief.points_map[3], Detector(0.9, false_alarms=false_alarms)
    near = [math.exp(-0.5 * math.dist(place[:2], x[:2]) ** 2 / detector.spread**2) for x in belief.points_map]
    stray = false_alarms / max(1, np.count_nonzero(rates))
    weights = [
        b * (d * n / sum(near) * (1 - false_alarms) + (1 - d) * stray)
        for b, d, n in zip(belief.mass, rates, near, strict=True)
    ]
    whole = sum(weights) + belief.absent_mass * stray
    if whole > 0:
        after = belief.after_detection(rates, place, detector)
        np.testing.assert_allclose(after.probabilities, np.array(weights) / whole, rtol=1e-9, atol=1e-12)
        assert after.absence_of_one == pytest.approx(belief.absent_mass * stray / whole)


def test_without_false_alarms_a_report_is_the_place():
    belief = some_belief(np.random.default_rng(1))
    for rates in (np.ones(20), np.zeros(20)):
        after = belief.after_detection(rates, belief.points_map[4], Detector(0.9))
        assert after.absence == 0.0
        assert after.near(belief.points_map[4], 0.31) > 0.98


def test_an_empty_room_becomes_probably_empty():
    belief = some_belief(np.random.default_rng(2), absent=0.05)
    for _ in range(4):
        belief = belief.after_miss(np.full(20, 0.9))
    assert belief.absence > 0.99


@given(st.floats(0.05, 0.6), st.floats(0.05, 0.35), st.integers(1, 4))
def test_known_and_poisson_numbers_against_draws_of_their_own(seen, absent, count):
    """u^n and exp(-n (1 - u)) are those of n independent instances, and of their Poisson mixture."""
    unseen = 1.0 - seen
    known = Instances(count)
    assert float(known.unfound(unseen)) == pytest.approx(unseen**count)
    mixed = sum(math.exp(-count) * count**n / math.factorial(n) * unseen**n for n in range(60))
    assert float(Instances.about(count).unfound(unseen)) == pytest.approx(mixed)
    assert known.none_here(unseen - absent, absent) == pytest.approx((absent / unseen) ** count)


def test_a_second_look_from_the_same_pose_is_discounted():
    views = Views.of_rates([[0, 0, 0], [0, 0.4, 0], [3, 0, 0], [0, 0, 3]], np.full((4, 3), 0.8))
    look = PastLook([0, 0, 0], [0.8, 0.8, 0.0])
    table = discounted(views, [look], Repeats(0.9, 0.5, 0.5)).table()
    np.testing.assert_allclose(table[0], [0.08, 0.08, 0.8], rtol=1e-6)
    assert table[0, 0] < table[1, 0] < 0.8
    np.testing.assert_allclose(table[2:], 0.8)
    assert discounted(views, [look], Repeats(0.0)) is views


def test_detection_falls_with_range_and_rises_with_size():
    detector = Detector(0.9, reach=20.0)
    small, large = detector.rates(np.array([0.5, 2.0, 4.0]), 0.1), detector.rates(np.array([2.0]), 0.3)
    assert (np.diff(small) < 0).all()
    assert small[1] == pytest.approx(0.45)
    assert large[0] > small[1]


@pytest.mark.parametrize(
    "make",
    [
        lambda: Belief.of_weights(np.empty((0, 3)), []),
        lambda: Belief.of_weights(np.zeros((2, 3)), [0.0, 0.0]),
        lambda: Belief.of_weights(np.zeros((2, 3)), [1.0, -1.0]),
        lambda: Belief.of_weights(np.zeros((2, 3)), [1.0, math.nan]),
        lambda: Belief.of_weights(np.full((2, 3), math.nan), [1.0, 1.0]),
        lambda: Belief.of_weights(np.zeros((2, 3)), [1.0, 1.0], floor=1.5),
        lambda: Belief.of_weights(np.zeros((2, 3)), [1.0, 1.0], absent=1.0),
        lambda: Detector(0.0),
        lambda: Detector(0.9, reach=0.0),
        lambda: Detector(0.9, false_alarms=1.0),
        lambda: Detector(0.9, spread=math.inf),
        lambda: Detector(0.9, confidence=1.0),
        lambda: Instances(0),
        lambda: Instances(1.5),
        lambda: Repeats(1.1),
        lambda: Repeats(0.5, length=0.0),
        lambda: Noise(0.0),
        lambda: Noise(1.0, 1.0),
        lambda: Limits(absence=0.0),
        lambda: some_belief(np.random.default_rng(0)).after_miss(np.full(20, 1.5)),
    ],
)
def test_senseless_beliefs_are_refused(make):
    with pytest.raises(ValueRangeError):
        make()
