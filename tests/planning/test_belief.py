import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.belief import voxel_weights
from qsrlang.planning.doubt import Doubt

AUTHORS = GaussianMixture(
    weights=np.full(3, 1 / 3),
    means=np.array([[-1.0, 4.7], [2.5, 4.7], [1.0, -2.5]]),
    covariances=np.array([np.diag([0.2, 0.1]), np.diag([0.1, 0.2]), np.diag([0.1, 0.3])]),
)


def test_the_authors_constants():
    peak = sum(
        math.exp(-0.5 * (dx * dx / vx + dy * dy / vy)) / (2 * math.pi * math.sqrt(vx * vy)) / 3
        for dx, dy, vx, vy in ((0, 0, 0.2, 0.1), (-3.5, 0, 0.1, 0.2), (-2.0, 7.2, 0.1, 0.3))
    )
    assert voxel_weights(AUTHORS, [[-1.0, 4.7]], floor=1, gain=10) == pytest.approx([1 + 10 * peak])
    assert voxel_weights(AUTHORS, [[40.0, 40.0]], floor=1, gain=10) == pytest.approx([1.0])


def test_weights_are_not_whole_numbers():
    weights = voxel_weights(AUTHORS, [[-1.0, 4.7], [-0.5, 4.8]], floor=1, gain=10)
    assert (weights != np.floor(weights)).all()


def test_without_a_mixture_every_voxel_weighs_the_floor():
    assert voxel_weights(None, [[0, 0], [1, 1]], floor=0.5, gain=10).tolist() == [0.5, 0.5]
    assert voxel_weights(AUTHORS, np.empty((0, 2)), floor=1, gain=10).shape == (0,)


@given(st.floats(0, 5), st.floats(0, 20), st.floats(0, 1))
def test_weights_are_linear_in_what_is_claimed(floor, gain, claimed):
    places = [[-1.0, 4.7], [0.8, -2.4]]
    weights = voxel_weights(AUTHORS, places, floor, gain, claimed)
    np.testing.assert_allclose(weights, floor + gain * claimed * AUTHORS.pdf(places), rtol=1e-12)


@pytest.mark.parametrize(
    ("floor", "gain", "claimed"), [(-1, 10, 1), (1, -1, 1), (1, math.inf, 1), (1, 10, 1.5)]
)
def test_senseless_weights_are_refused(floor, gain, claimed):
    with pytest.raises(ValueRangeError):
        voxel_weights(AUTHORS, [[0, 0]], floor, gain, claimed)


@given(st.floats(0, 1), st.floats(0, 1), st.floats(1, 5), st.floats(0, 1))
def test_a_doubtful_prior_is_its_three_parts(floor, loose, stretch, claimed):
    """floor / K + (1 - floor) p, of which the loose part is p with its spreads stretched, given that it is here."""
    places = np.random.default_rng(0).uniform([-2.0, -4.0], [4.0, 6.0], (300, 2))
    prior = Doubt(floor, loose, stretch).prior(AUTHORS, places, claimed)
    wide = GaussianMixture(AUTHORS.weights, AUTHORS.means, stretch**2 * AUTHORS.covariances)
    told = (1.0 - loose) * AUTHORS.pdf(places) + loose * wide.pdf(places)
    trusted = claimed * (1.0 - floor)
    np.testing.assert_allclose(prior, trusted * told / told.sum() + (1.0 - trusted) / 300, rtol=1e-9)
    assert prior.sum() == pytest.approx(1.0)


def test_a_prior_of_places_the_statements_say_nothing_of_is_even():
    prior = Doubt(floor=0.1, loose=0.5).prior(AUTHORS, [[1e6, 0.0], [0.0, 1e6]])
    assert prior.tolist() == [0.5, 0.5]


def test_taken_loosely_more_is_left_for_places_not_far_away():
    places = np.array([[2.5, 4.7], [0.8, 4.8], [1.0, 1.0]])
    told, loosely = (Doubt(floor=0.3, loose=loose).prior(AUTHORS, places) for loose in (0.0, 0.5))
    assert loosely[0] < told[0]
    assert loosely[1] - told[1] > loosely[2] - told[2] > 0.0


@pytest.mark.parametrize("wrong", [{"floor": -0.1}, {"loose": 1.5}, {"stretch": 0.5}, {"stretch": math.inf}])
def test_senseless_doubts_are_refused(wrong):
    with pytest.raises(ValueRangeError):
        Doubt(**wrong)
