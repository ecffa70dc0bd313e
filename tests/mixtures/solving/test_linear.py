"""Linear equations: exact for turning factors, else statistical, settled where they depend on the answer."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.geometry.angles import rotation
from qsrlang.mixtures.densities.conditional import Turning
from qsrlang.mixtures.solving import posterior
from qsrlang.mixtures.solving.linear import Factor, cubature, semidefinite_root
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.plans import plan_world

headings = st.floats(-math.pi, math.pi)
offsets = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
SPREAD = np.array([[0.04, 0.01], [0.01, 0.02]])


def turning_factor(mean):
    return Factor(
        np.array([4, 5]),
        np.array([1, 2, 3]),
        None,
        Turning(np.array(mean), SPREAD),
        bends=True,
        orientation=0.0,
    )


@given(offsets, headings, st.floats(0.0, 0.3))
@settings(max_examples=60)
def test_a_turning_factor_has_the_moments_of_quadrature(offset, heading, variance):
    """Gauss-Hermite over the heading: mean, covariance, and covariance with the heading, of R(h) (m + noise)."""
    mean, covariance = np.array([0.3, -0.2, heading]), np.diag([0.01, 0.02, variance])
    found = turning_factor(offset).linearised(mean, covariance)
    nodes, weights = np.polynomial.hermite_e.hermegauss(40)
    weights = weights / weights.sum()
    turns = rotation(heading + math.sqrt(variance) * nodes)
    each = turns @ np.array(offset)
    expected = weights @ each
    second = np.einsum("k,kij->ij", weights, turns @ SPREAD @ turns.transpose(0, 2, 1))
    second += np.einsum("k,ki,kj->ij", weights, each, each) - np.outer(expected, expected)
    np.testing.assert_allclose(found.slope @ mean + found.offset, expected + mean[:2], atol=1e-9)
    whole = found.slope @ covariance @ found.slope.T + found.covariance
    np.testing.assert_allclose(whole, second + covariance[:2, :2], atol=1e-9)
    cross = weights @ (each * (math.sqrt(variance) * nodes)[:, None])
    np.testing.assert_allclose(found.slope[:, 2] * variance, cross, atol=1e-9)
    assert (np.linalg.eigvalsh(found.covariance) > 0.0).all()


@given(st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(0, 9), headings)
@settings(max_examples=60)
def test_a_cubature_has_the_moments_of_its_gaussian(seed, things, rank, orientation):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3 * things, min(rank, 3 * things)))
    mean, covariance = rng.normal(size=3 * things), root @ root.T
    states = cubature(mean, covariance, orientation)
    np.testing.assert_allclose(states.mean(axis=0), mean, atol=1e-9)
    np.testing.assert_allclose((states - mean).T @ (states - mean) / len(states), covariance, atol=1e-8)
    found = semidefinite_root(covariance)
    np.testing.assert_allclose(found @ found.T, covariance, atol=1e-8)


LOOP = """
static M { front: yes }, N { front: yes }. dynamic A, B { front: yes }.
landmark m : M at (0 m, 0 m) facing 20 deg ± (2 cm, 2 cm, 5 deg).
landmark n : N at (1 m, 0.3 m) facing -40 deg ± (2 cm, 2 cm, 5 deg).
"""


@pytest.mark.parametrize(
    "text",
    [
        "observe left-of(A, M) wrt intrinsic. observe behind-of(A, N) wrt absolute.",
        "observe left-of(A, M). observe left-of(B, A). observe right-of(B, N) wrt intrinsic.",
        "observe between(A, M, N). observe close-to(A, M).",
        "observe left-of(A, M). observe close-to(B, A). observe close-to(A, B). observe left-of(B, N).",
    ],
)
def test_equations_settle_about_their_own_solution(text, monkeypatch):
    """Twice as many passes change nothing more."""
    graph = qsr.parse_knowledge(LOOP + text).graph

    def means():
        found = []
        for world in enumerate_worlds(graph, "A", "B"):
            plan = plan_world(graph, world, "A", "B")
            found.append(posterior.posterior_of(graph, plan, None).mean)
        return np.concatenate(found)

    once = means()
    monkeypatch.setattr(posterior, "MAX_PASSES", 2 * posterior.MAX_PASSES)
    np.testing.assert_allclose(means(), once, atol=1e-4)
