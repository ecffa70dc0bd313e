"""Systems of linear equations with Gaussian noise, beside Gaussian products on full matrices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import multivariate_normal

from qsrlang.mixtures.solving import system
from qsrlang.mixtures.solving.linear import Factor, Linear
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.relations.graph import Landmark

seeds = st.integers(0, 2**32 - 1)


def landmark(number, rng, spread=0.1):
    x, y = rng.normal(size=2)
    return Landmark(f"m{number}", "M", x, y, None, 0.3, (spread, spread, 0.05))


def said(layout, referent, relatum, rng):
    """x = slope s + offset + noise, of an object, about a landmark or another object."""
    start = layout.starts[relatum]
    heading = start + 2 if relatum.startswith("m") else 0
    columns = np.array([start, start + 1, heading])
    at = layout.starts[referent]
    root = rng.normal(scale=0.4, size=(2, 2))
    slope = np.hstack([np.eye(2) + 0.1 * rng.normal(size=(2, 2)), rng.normal(scale=0.3, size=(2, 1))])
    equation = Linear(slope, rng.normal(size=2), root @ root.T + 0.01 * np.eye(2))
    return Factor(np.array([at, at + 1]), columns, None, None, False, 0.0), equation


def random_system(rng, objects, extra):
    names = [f"o{number}" for number in range(objects)]
    layout = Layout.of([landmark(0, rng), landmark(1, rng)], names)
    before = ["m0", "m1", *names]
    pairs = [(name, before[rng.integers(2 + at)]) for at, name in enumerate(names)]
    for _ in range(extra):
        one = rng.integers(objects)
        pairs.append((names[one], before[rng.integers(2 + one)]))
    factors, equations = zip(*(said(layout, *pair, rng) for pair in pairs), strict=True)
    return layout, list(factors), list(equations)


def slow_product(layout, factors, equations):
    """The same posterior, on full matrices; the evidence is the density of all residuals being zero, where objects
    have a prior of huge variance v, by whose density at its middle it is divided in the end.
    """
    vague, size = 1e6, layout.size
    prior = np.where(layout.open, vague, layout.variance)
    rows, offsets, noises = [], [], []
    for factor, equation in zip(factors, equations, strict=True):
        row = np.zeros((2, size))
        row[[0, 1], factor.referent] = 1.0
        for column, slope in zip(factor.columns, equation.slope.T, strict=True):
            row[:, column] -= slope
        rows.append(row)
        offsets.append(equation.offset)
        noises.append(equation.covariance)
    jacobian, offset = np.vstack(rows), np.hstack(offsets)
    noise = np.zeros((len(offset),) * 2)
    for at, one in enumerate(noises):
        noise[2 * at : 2 * at + 2, 2 * at : 2 * at + 2] = one
    free = np.flatnonzero(prior)
    information = np.diag(np.where(layout.open, 0.0, 1.0 / np.where(prior, prior, 1.0))[free])
    information += jacobian[:, free].T @ np.linalg.inv(noise) @ jacobian[:, free]
    covariance = np.zeros((size, size))
    covariance[np.ix_(free, free)] = np.linalg.inv(information)
    residual = offset - jacobian @ layout.mean
    mean = layout.mean + covariance @ jacobian.T @ np.linalg.inv(noise) @ residual
    log = multivariate_normal(np.zeros(len(offset)), jacobian @ np.diag(prior) @ jacobian.T + noise).logpdf(
        residual
    )
    return mean, covariance, log + 0.5 * layout.open.sum() * np.log(2.0 * np.pi * vague)


@given(seeds, st.integers(1, 6), st.integers(0, 4))
@settings(max_examples=40)
def test_dense_is_the_slow_product(seed, objects, extra):
    layout, factors, equations = random_system(np.random.default_rng(seed), objects, extra)
    found = system.solve(layout, factors, equations, layout.mean)
    mean, covariance, log = slow_product(layout, factors, equations)
    np.testing.assert_allclose(found.mean, mean, atol=1e-8)
    np.testing.assert_allclose(found.covariance(np.arange(layout.size)), covariance, atol=1e-8)
    assert found.log_evidence == pytest.approx(log, abs=1e-2)


@given(seeds, st.integers(1, 8), st.integers(0, 8))
@settings(max_examples=30)
def test_sparse_is_dense(seed, objects, extra):
    rng = np.random.default_rng(seed)
    layout, factors, equations = random_system(rng, objects, extra)
    dense = system.solve(layout, factors, equations, layout.mean)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(system, "DENSE", 0)
        sparse = system.solve(layout, factors, equations, layout.mean)
    assert dense.inverse is not None
    assert sparse.inverse is None
    np.testing.assert_allclose(sparse.mean, dense.mean, atol=1e-9)
    assert sparse.log_evidence == pytest.approx(dense.log_evidence, abs=1e-8)
    columns = rng.integers(0, layout.size, 6)
    np.testing.assert_allclose(sparse.covariance(columns), dense.covariance(columns), atol=1e-9)


@given(seeds)
@settings(max_examples=20)
def test_where_it_starts_and_in_which_order_does_not_matter(seed):
    rng = np.random.default_rng(seed)
    layout, factors, equations = random_system(rng, 5, 4)
    first = system.solve(layout, factors, equations, layout.mean)
    order = rng.permutation(len(factors))
    start = layout.mean + np.where(layout.free, rng.normal(size=layout.size), 0.0)
    again = system.solve(layout, [factors[at] for at in order], [equations[at] for at in order], start)
    np.testing.assert_allclose(again.mean, first.mean, atol=1e-8)
    assert again.log_evidence == pytest.approx(first.log_evidence, abs=1e-7)


def test_a_chain_with_nothing_fused_has_the_evidence_of_a_density():
    layout, factors, equations = random_system(np.random.default_rng(3), 4, 0)
    assert system.solve(layout, factors, equations, layout.mean).log_evidence == pytest.approx(0.0, abs=1e-9)


def test_two_equations_on_one_object_have_the_evidence_of_their_difference():
    """integral of N(x; a, P) N(x; b, Q) dx = N(a; b, P + Q)."""
    layout = Layout.of([Landmark("m0", "M", 0.0, 0.0, None, 0.0)], ["o0"])
    at = layout.starts["o0"] + np.arange(2)
    places, spreads = ([0.3, 0.1], [-0.2, 0.4]), (np.diag([0.2, 0.1]), np.array([[0.3, 0.1], [0.1, 0.2]]))
    factors = [Factor(at, np.array([0, 0, 0]), None, None, False, 0.0)] * 2
    equations = [
        Linear(np.zeros((2, 3)), np.array(place), spread)
        for place, spread in zip(places, spreads, strict=True)
    ]
    found = system.solve(layout, factors, equations, layout.mean)
    expected = multivariate_normal(places[0], spreads[0] + spreads[1]).logpdf(places[1])
    assert found.log_evidence == pytest.approx(expected)
    precision = [np.linalg.inv(one) for one in spreads]
    np.testing.assert_allclose(found.covariance(at), np.linalg.inv(sum(precision)), rtol=1e-9)
