"""Mixture reduction: what it keeps, and that it merges what a slow search would."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.mixtures.answers import Component, mixture_of
from qsrlang.mixtures.reduction import reduced

seeds = st.integers(0, 2**32 - 1)


def random_components(seed, count):
    rng = np.random.default_rng(seed)
    roots = rng.normal(scale=0.3, size=(count, 2, 2))
    covariances = roots @ roots.transpose(0, 2, 1) + 0.01 * np.eye(2)
    weights, means = rng.dirichlet(np.ones(count)), rng.normal(size=(count, 2))
    return [
        Component(*one, (f"statement {at}",))
        for at, one in enumerate(zip(weights.tolist(), means, covariances, strict=True))
    ]


def together(one, other):
    """Two components as one Gaussian, by the law of total variance."""
    weight = one.weight + other.weight
    mean = (one.weight * one.mean + other.weight * other.mean) / weight
    spread = sum(
        part.weight * (part.covariance + np.outer(part.mean - mean, part.mean - mean))
        for part in (one, other)
    )
    return Component(weight, mean, spread / weight, one.statements + other.statements)


def cost(one, other):
    """Runnalls' bound B(i, j)."""
    logs = [
        part.weight * np.linalg.slogdet(part.covariance)[1] for part in (together(one, other), one, other)
    ]
    return 0.5 * (logs[0] - logs[1] - logs[2])


def slowly_reduced(components, limit):
    kept = list(components)
    while len(kept) > limit:
        one, other = min(combinations(kept, 2), key=lambda pair: cost(*pair))
        kept = [part for part in kept if part is not one and part is not other] + [together(one, other)]
    return sorted(kept, key=lambda part: -part.weight)


def assert_moments_are_kept(before, after):
    (mean, covariance), (other, spread) = mixture_of(before).moments(), mixture_of(after).moments()
    np.testing.assert_allclose(other, mean, atol=1e-10)
    np.testing.assert_allclose(spread, covariance, atol=1e-10)
    assert sum(one.weight for one in after) == pytest.approx(sum(one.weight for one in before))


@given(seeds, st.integers(1, 40), st.integers(1, 12))
@settings(max_examples=60)
def test_mean_covariance_and_mass_are_kept_and_the_limit_honoured(seed, count, limit):
    before = random_components(seed, count)
    after = reduced(before, limit)
    assert len(after) == min(count, limit)
    assert_moments_are_kept(before, after)
    assert [one.weight for one in after] == sorted((one.weight for one in after), reverse=True)
    assert {said for one in after for said in one.statements} == {f"statement {at}" for at in range(count)}


@given(seeds, st.integers(2, 9), st.integers(1, 6))
@settings(max_examples=40)
def test_what_is_merged_is_what_a_slow_search_merges(seed, count, limit):
    before = random_components(seed, count)
    for one, other in zip(reduced(before, limit), slowly_reduced(before, limit), strict=True):
        assert one.weight == pytest.approx(other.weight)
        np.testing.assert_allclose(one.mean, other.mean, atol=1e-9)
        np.testing.assert_allclose(one.covariance, other.covariance, atol=1e-9)
        assert set(one.statements) == set(other.statements)


@given(seeds, st.integers(2, 12))
@settings(max_examples=20)
def test_the_order_of_components_does_not_matter(seed, count):
    before = random_components(seed, count)
    turned = [before[at] for at in np.random.default_rng(seed).permutation(count)]
    for one, other in zip(reduced(before, 4), reduced(turned, 4), strict=True):
        np.testing.assert_allclose(one.mean, other.mean, atol=1e-9)


def test_equal_components_cost_nothing_and_go_first():
    one, *others = random_components(5, 4)
    twice = [Component(0.5 * one.weight, one.mean, one.covariance, one.statements)] * 2
    found = reduced([*twice, *others], 4)
    np.testing.assert_allclose(
        [part.weight for part in found], sorted(p.weight for p in (one, *others))[::-1]
    )


def test_many_are_reduced_in_batches():
    before = random_components(7, 1500)
    after = reduced(before, 10)
    assert len(after) == 10
    assert_moments_are_kept(before, after)
