import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import multivariate_normal
from strategies import poses

from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture

MIXTURE = GaussianMixture(
    [0.15, 0.85], [[0.5, -0.2], [-1.0, 2.0]], [[[0.2, 0.05], [0.05, 0.1]], [[0.3, -0.1], [-0.1, 0.4]]]
)
POINTS = np.random.default_rng(0).normal(size=(50, 2))


def test_pdf_is_equation_2():
    expected = sum(
        w * multivariate_normal(m, c).pdf(POINTS)
        for w, m, c in zip(MIXTURE.weights, MIXTURE.means, MIXTURE.covariances, strict=True)
    )
    np.testing.assert_allclose(MIXTURE.pdf(POINTS), expected, rtol=1e-12)
    np.testing.assert_allclose(MIXTURE.logpdf(POINTS), np.log(expected), rtol=1e-10)


def test_pdf_integrates_to_one():
    axis = np.linspace(-8.0, 8.0, 801)
    grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    assert MIXTURE.pdf(grid).sum() * (axis[1] - axis[0]) ** 2 == pytest.approx(1.0, abs=1e-9)


@given(poses)
def test_a_rigid_motion_moves_the_density_with_it(pose):
    moved = MIXTURE.transformed(pose)
    np.testing.assert_allclose(moved.pdf(pose.transform(POINTS)), MIXTURE.pdf(POINTS), rtol=1e-7)


def test_draws_have_the_mixture_s_moments():
    """False-alarm rate below 1e-4: five standard errors of a mean."""
    draws = MIXTURE.sample(100_000, np.random.default_rng(1))
    mean, covariance = MIXTURE.moments()
    error = np.sqrt(np.diag(covariance) / len(draws))
    assert (np.abs(draws.mean(axis=0) - mean) < 5.0 * error).all()
    np.testing.assert_allclose(np.cov(draws.T), covariance, atol=0.03)


@given(st.floats(0.01, 4.0), st.floats(0.01, 4.0))
def test_entropy_of_one_gaussian_is_the_closed_form(a, b):
    one = GaussianMixture([1.0], [[3.0, 1.0]], [[[a, 0.0], [0.0, b]]])
    assert one.entropy() == pytest.approx(0.5 * math.log((2 * math.pi * math.e) ** 2 * a * b), abs=1e-9)


def test_entropy_of_two_far_apart_adds_the_choice():
    far = GaussianMixture([0.5, 0.5], [[0.0, 0.0], [100.0, 0.0]], [np.eye(2), np.eye(2)])
    assert far.entropy() == pytest.approx(math.log(2 * math.pi * math.e) + math.log(2.0), abs=1e-9)


@pytest.mark.parametrize(
    ("weights", "covariance", "message"),
    [
        ([0.9], np.eye(2), "sum"),
        ([1.0], [[1.0, 2.0], [2.0, 1.0]], "definite"),
        ([1.0], [[1.0, 0.1], [0.0, 1.0]], "symm"),
    ],
)
def test_a_mixture_refuses_nonsense(weights, covariance, message):
    with pytest.raises(ValueRangeError, match=message):
        GaussianMixture(weights, [[0.0, 0.0]], [covariance])


def test_a_mixture_keeps_its_own_read_only_arrays():
    weights = np.array([1.0])
    mixture = GaussianMixture(weights, [[0.0, 0.0]], [np.eye(2)])
    weights[0] = 7.0
    assert mixture.weights[0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        mixture.means[0, 0] = 1.0
