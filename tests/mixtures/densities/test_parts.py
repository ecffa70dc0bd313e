"""Relations of several components: parts of equal mass whose mixture has the moments of the whole."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.mixtures.densities.density import Rays

ANGLES = st.one_of(
    st.builds("normal({:.2f} deg, {:.2f} deg)".format, st.floats(-180.0, 180.0), st.floats(5.0, 60.0)),
    st.builds(
        lambda low, width: f"uniform({low:.2f} deg, {low + width:.2f} deg)",
        st.floats(-180.0, 180.0),
        st.floats(20.0, 300.0),
    ),
    st.just("any"),
)
TEXT = """
surface T {{ size: 160 cm × 90 cm }}. static M {{ size: 20 cm × 10 cm, front: yes, on: T }}.
dynamic A {{ size: 8 cm × 6 cm, on: T }}, B {{ size: 5 cm × 5 cm, on: T }}.
landmark t : T at (1 m, 0 m) facing 10 deg. landmark m : M at (1.1 m, 0.1 m) facing -30 deg{spread}.
relation r(a, b) {{ angle: {angle}, distance: uniform(0 %, 60 %), components: {count} }}.
observe r(A, M). observe r(B, A).
"""


def where(target, angle, count, spread=""):
    text = TEXT.format(angle=angle, count=count, spread=spread)
    return qsr.parse_knowledge(text).where(target, max_components=1000)


@given(ANGLES, st.integers(2, 9))
@settings(max_examples=30)
def test_parts_have_equal_mass_and_together_the_moments_of_the_whole(angle, count):
    """With the edge of a support along every direction."""
    whole, parts = where("A", angle, 1), where("A", angle, count)
    assert len(whole.weights) == 1
    np.testing.assert_allclose(parts.weights, np.full(count, 1.0 / count), atol=1e-12)
    for one, other in zip(whole.mixture.moments(), parts.mixture.moments(), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_more_parts_are_narrower():
    spreads = [
        np.linalg.det(where("A", "uniform(0 deg, 270 deg)", count).covariances).max()
        for count in (1, 2, 4, 8)
    ]
    assert spreads == sorted(spreads, reverse=True)


def test_a_chain_of_parts_has_every_combination():
    assert len(where("B", "normal(40 deg, 40 deg)", 3, " ± (1 cm, 1 cm, 2 deg)").weights) == 9


@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
@settings(max_examples=40)
def test_parts_of_rays_share_their_mass(seed, count):
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet(np.ones(20), size=3)
    rays = Rays(np.zeros((3, 20)), weights, np.zeros((3, 20)), np.ones((3, 20)), 0.1)
    parts = [rays.part(number, count).weights for number in range(count)]
    for one in parts:
        np.testing.assert_allclose(one.sum(axis=1), 1.0, atol=1e-9)
    np.testing.assert_allclose(sum(parts) / count, weights, atol=1e-9)


def test_a_probability_does_not_depend_on_the_number_of_parts():
    """The true density is the same, whatever its Gaussians are."""
    found = [
        qsr.parse_knowledge(TEXT.format(angle="normal(70 deg, 40 deg)", count=count, spread="")).prob(
            "left-of(A, M)"
        )
        for count in (1, 4)
    ]
    assert found[0].method == found[1].method == "exact"
    assert found[0].value == pytest.approx(found[1].value, abs=1e-9)
    assert math.isclose(found[0].value, 0.6, abs_tol=0.2)
