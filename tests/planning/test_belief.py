import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.belief import voxel_weights

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
