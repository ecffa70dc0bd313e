"""Bivariate normals over cones, beside numerical integration and draws."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ndtr
from scipy.stats import multivariate_normal, norm

from qsrlang.geometry.angles import TURN
from qsrlang.mixtures.densities.sectors import Arcs
from qsrlang.mixtures.solving.cones import bivariate_cdf, cone_probability, turning_cone_probability

limits = st.floats(-4.0, 4.0)
spreads = st.floats(0.05, 2.0)
correlations = st.floats(-0.95, 0.95)
angles = st.floats(-math.pi, math.pi)
means = st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))


def covariance_of(sx, sy, rho):
    return np.array([[sx * sx, rho * sx * sy], [rho * sx * sy, sy * sy]])


def integrated(h, k, rho):
    """P(X <= h, Y <= k) by quadrature over X."""
    root = math.sqrt(1.0 - rho * rho)
    return quad(lambda x: norm.pdf(x) * ndtr((k - rho * x) / root), -9.0, h, epsabs=1e-11, limit=200)[0]


def by_polar_quadrature(start, width, mean, covariance, count=2000):
    """P(angle in an arc) by the density of the direction, the way integrated in closed form (projected normal)."""
    precision = np.linalg.inv(covariance)
    theta = start + width * (np.arange(count) + 0.5) / count
    u = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    a = np.einsum("ni,ij,nj->n", u, precision, u)
    b = u @ precision @ mean
    c = mean @ precision @ mean
    z = b / np.sqrt(a)
    along = np.exp(-0.5 * c) / a + np.sqrt(TURN) * b / a**1.5 * np.exp(0.5 * (z * z - c)) * ndtr(z)
    return float(along.sum() * width / count / (TURN * math.sqrt(np.linalg.det(covariance))))


@given(limits, limits, correlations)
@settings(max_examples=40)
@example(7e-57, -2e-305, 0.0)
@example(5e-324, 5e-324, -0.5)
@example(0.0, 0.0, 0.5)
@example(0.0, 1.0, -0.5)
@example(0.0, -1.0, -0.5)
@example(1.0, 0.0, 0.5)
@example(-1.0, 0.0, 0.5)
@example(-1.0, 1.0, 0.0)
def test_the_cdf_is_that_of_numerical_integration(h, k, rho):
    assert bivariate_cdf(h, k, rho) == pytest.approx(integrated(h, k, rho), abs=1e-8)


@given(limits, limits)
@settings(max_examples=40)
def test_the_cdf_without_correlation_is_a_product_and_in_its_limit_a_minimum(h, k):
    assert bivariate_cdf(h, k, 0.0) == pytest.approx(float(ndtr(h) * ndtr(k)), abs=1e-12)
    assert bivariate_cdf(h, k, 1.0) == pytest.approx(float(min(ndtr(h), ndtr(k))), abs=1e-9)
    assert bivariate_cdf(h, k, -1.0) == pytest.approx(max(float(ndtr(h) + ndtr(k)) - 1.0, 0.0), abs=1e-9)


@settings(max_examples=40)
@given(angles, st.floats(0.01, TURN - 0.01), angles, means, spreads, spreads, correlations)
def test_a_wedge_has_the_mass_of_its_directions(start, width, axis, mean, sx, sy, rho):
    mean, covariance = np.array(mean), covariance_of(sx, sy, rho)
    narrow = min(sx, sy) * math.sqrt(1.0 - rho * rho)
    found = cone_probability(Arcs(((start, width),)), axis, 1.0, mean, covariance)
    expected = by_polar_quadrature(axis + start, width, mean, covariance, 20_000)
    assert found == pytest.approx(expected, abs=2e-3 * max(1.0, 0.05 * np.linalg.norm(mean) / narrow))


@given(st.lists(st.floats(0.01, 1.0), min_size=1, max_size=6), angles, means, spreads, spreads, correlations)
def test_wedges_around_the_circle_sum_to_one(shares, start, mean, sx, sy, rho):
    widths = TURN * np.array(shares) / sum(shares)
    starts = start + np.cumsum(widths) - widths
    mean, covariance = np.array(mean), covariance_of(sx, sy, rho)
    arcs = zip(starts.tolist(), widths.tolist(), strict=True)
    found = [cone_probability(Arcs((one,)), 0.3, 1.0, mean, covariance) for one in arcs]
    assert sum(found) == pytest.approx(1.0, abs=1e-7)


@pytest.mark.parametrize("width", [math.pi - 1e-12, math.pi, math.pi + 1e-12, TURN])
def test_half_and_full_turns(width):
    mean, covariance = np.array([0.2, 0.1]), np.diag([0.3, 0.4])
    found = cone_probability(Arcs(((0.0, width),)), 0.0, 1.0, mean, covariance)
    assert found == pytest.approx(1.0 if width == TURN else float(ndtr(0.1 / math.sqrt(0.4))), abs=1e-9)
    assert cone_probability(Arcs(()), 0.0, 1.0, mean, covariance) == 0.0


@given(angles, st.floats(0.1, 3.0), angles, means, spreads, spreads, correlations)
def test_a_mirrored_hand_sees_the_mirrored_gaussian(start, width, axis, mean, sx, sy, rho):
    mirror = np.diag([1.0, -1.0])
    mean, covariance = np.array(mean), covariance_of(sx, sy, rho)
    left = cone_probability(Arcs(((start, width),)), axis, -1.0, mean, covariance)
    right = cone_probability(Arcs(((start, width),)), -axis, 1.0, mirror @ mean, mirror @ covariance @ mirror)
    assert left == pytest.approx(right, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_uncertain_headings_agree_with_draws(seed):
    """A limit of 5 standard errors, and 1e-3 for a quadrature of nine headings."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3)) * [[0.3], [0.3], [0.15]]
    mean, covariance = rng.uniform(-1.0, 1.0, 3), root @ root.T + 1e-3 * np.eye(3)
    arcs, offset, hand = Arcs(((-0.8, 1.6), (1.5, 0.5))), rng.uniform(-3.0, 3.0), rng.choice([-1.0, 1.0])
    x, y, heading = multivariate_normal(mean, covariance).rvs(400_000, random_state=rng).T
    held = arcs.contain(hand * (np.arctan2(y, x) - heading - offset)).mean()
    found = turning_cone_probability(arcs, offset, hand, mean, covariance)
    assert abs(found - held) < 5.0 * math.sqrt(0.25 / 400_000) + 1e-3


def test_what_is_certain_lies_in_the_cone_or_does_not():
    arcs = Arcs(((-0.7, 1.4),))
    for mean, expected in (((1.0, 0.2), 1.0), ((0.2, 1.0), 0.0)):
        assert cone_probability(arcs, 0.0, 1.0, np.array(mean), np.zeros((2, 2))) == expected


@pytest.mark.parametrize("angle", [-0.8, -0.6, 0.0, 0.5, 0.66])
def test_where_the_heading_alone_is_uncertain_it_alone_decides(angle):
    mean = np.array([math.cos(angle), math.sin(angle), 0.0])
    found = turning_cone_probability(Arcs(((-0.7, 1.4),)), 0.0, 1.0, mean, np.diag([0.0, 0.0, 0.04]))
    expected = ndtr((angle + 0.7) / 0.2) - ndtr((angle - 0.7) / 0.2)
    assert found == pytest.approx(float(expected), abs=4e-3)


def test_a_certain_heading_is_a_cone_about_it():
    arcs, mean, covariance = Arcs(((-0.7, 1.4),)), np.array([0.4, 0.2, 0.6]), np.diag([0.2, 0.1, 0.0])
    found = turning_cone_probability(arcs, 0.3, 1.0, mean, covariance)
    expected = cone_probability(arcs, 0.9, 1.0, mean[:2], covariance[:2, :2])
    assert found == pytest.approx(expected, abs=1e-12)
