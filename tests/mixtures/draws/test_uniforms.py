"""Uniform numbers that draws are made of."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.mixtures.draws.uniforms import REPLICATES, independent, lattices

shapes = {"count": st.integers(1, 400), "width": st.integers(1, 30), "seed": st.integers(0, 2**32 - 1)}


@pytest.mark.parametrize("make", [independent, lattices])
@given(**shapes)
@settings(max_examples=40)
def test_numbers_are_inside_of_0_and_1_and_repeat_with_their_seed(make, count, width, seed):
    one, other = (make(count, width, np.random.default_rng(seed)) for _ in range(2))
    assert one.shape[1] == width
    assert len(one) >= count
    assert ((one > 0.0) & (one < 1.0)).all()
    np.testing.assert_array_equal(one, other)


@given(**shapes)
@settings(max_examples=40)
def test_a_lattice_comes_in_runs_of_one_length(count, width, seed):
    found = lattices(count, width, np.random.default_rng(seed))
    assert len(found) % REPLICATES == 0
    assert len(found) < count + REPLICATES


def test_each_run_of_a_lattice_is_unbiased():
    """Over 2,000 seeds, means of x y and of x^2 within 5 standard errors of 1/4 and 1/3."""
    runs = [lattices(48, 2, np.random.default_rng(seed)).reshape(REPLICATES, -1, 2) for seed in range(2000)]
    found = np.array(runs)[:, 3]
    for values, expected in ((found[..., 0] * found[..., 1], 0.25), (found[..., 1] ** 2, 1.0 / 3.0)):
        means = values.mean(axis=1)
        assert abs(means.mean() - expected) < 5.0 * means.std() / np.sqrt(len(means))


def test_a_lattice_fills_space_more_evenly_than_independent_numbers():
    def error(make):
        means = [
            np.cos(6.0 * make(1600, 3, np.random.default_rng(seed))).prod(axis=1).mean() for seed in range(60)
        ]
        return np.std(means)

    assert error(lattices) < 0.3 * error(independent)
