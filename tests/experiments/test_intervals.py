import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.experiments import statistics
from qsrlang.experiments.statistics import bootstrap_interval, paired_interval, wilson_interval


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [
        (10, 10, 0.7225, 1.0),
        (0, 10, 0.0, 0.2775),
        (6, 10, 0.3127, 0.8318),
        (8, 10, 0.4902, 0.9433),
        (15, 100, 0.0931, 0.2328),
        (1, 2, 0.0945, 0.9055),
    ],
)
def test_wilson_against_published_values(successes, trials, low, high):
    interval = wilson_interval(successes, trials)
    assert (interval.low, interval.high) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(1, 500), st.data())
def test_wilson_solves_the_equation_of_the_score_test(trials, data):
    successes = data.draw(st.integers(0, trials))
    interval, rate, z = wilson_interval(successes, trials), successes / trials, 1.959963984540054
    assert 0.0 <= interval.low <= rate <= interval.high <= 1.0
    for bound in (interval.low, interval.high):
        assert trials * (rate - bound) ** 2 == pytest.approx(z * z * bound * (1 - bound), abs=1e-9)


def test_wilson_covers_the_truth_as_often_as_it_says():
    """4,000 fixed experiments of 40 trials, exact coverage 0.953: outside [0.94, 0.966] for one seed in 10^4."""
    counts = np.random.default_rng(3).binomial(40, 0.3, 4_000)
    bounds = {count: wilson_interval(int(count), 40) for count in np.unique(counts)}
    covered = np.mean([bounds[count].low <= 0.3 <= bounds[count].high for count in counts])
    assert 0.94 <= covered <= 0.966


def test_bootstrap_of_a_mean_meets_the_normal_interval():
    """400 fixed draws: the percentile interval of a mean is within 5 % of mean -+ 1.96 s / sqrt(n)."""
    values = np.random.default_rng(11).exponential(20.0, 400)
    interval = bootstrap_interval(values, seed=5)
    half = 1.96 * values.std() / np.sqrt(len(values))
    assert interval.low == pytest.approx(values.mean() - half, abs=0.15 * half)
    assert interval.high == pytest.approx(values.mean() + half, abs=0.15 * half)


def test_bootstrap_is_the_same_for_the_same_seed():
    values = np.random.default_rng(1).random(50)
    assert bootstrap_interval(values, seed=1) == bootstrap_interval(values, seed=1)
    assert bootstrap_interval(values, seed=1) != bootstrap_interval(values, seed=2)


def test_chunks_of_a_bootstrap_change_nothing(monkeypatch):
    values = np.random.default_rng(1).random(50)
    whole = bootstrap_interval(values, seed=4)
    monkeypatch.setattr(statistics, "MAX_DRAWS_AT_ONCE", 777)
    assert bootstrap_interval(values, seed=4) == whole


def test_bootstrap_of_one_value_is_that_value():
    assert bootstrap_interval([4.0]).low == bootstrap_interval([4.0]).high == 4.0


def test_paired_differences_are_narrower_than_the_arms():
    rng = np.random.default_rng(2)
    shared = rng.normal(50, 20, 200)
    slower, faster = shared + 5 + rng.normal(0, 1, 200), shared
    interval, alone = paired_interval(slower, faster), bootstrap_interval(slower)
    assert 0 < interval.low < 5.2 and interval.high > 4.8
    assert interval.high - interval.low < 0.2 * (alone.high - alone.low)


@pytest.mark.parametrize("counts", [(1, 0), (-1, 5), (6, 5)])
def test_counts_that_make_no_sense_are_refused(counts):
    with pytest.raises(ValueRangeError):
        wilson_interval(*counts)


def test_no_values_and_no_confidence_are_refused():
    with pytest.raises(ValueRangeError):
        bootstrap_interval([])
    with pytest.raises(ValueRangeError):
        wilson_interval(1, 2, confidence=1.0)
