import math

import numpy as np
import pytest
from hypothesis import given
from strategies import angles, points, poses

from qsrlang.geometry.angles import relative_angle, rotation, unit, wrap, wrap_positive


@given(angles)
def test_wrap_keeps_the_direction_and_the_range(angle):
    for wrapped, low, high in ((wrap(angle), -math.pi, math.pi), (wrap_positive(angle), 0.0, 2 * math.pi)):
        assert low <= wrapped <= high
        np.testing.assert_allclose(unit(wrapped), unit(angle), atol=1e-12)


def test_a_hair_below_zero_does_not_become_a_full_turn():
    assert wrap_positive(-1e-16) == 0.0
    assert wrap_positive(2 * math.pi) == 0.0
    assert wrap(-math.pi) == math.pi


@pytest.mark.parametrize(
    ("referent", "expected"),
    [((0, 3), 0.0), ((-1, 2), math.pi / 2), ((0, 1), math.pi), ((1, 2), 3 * math.pi / 2)],
)
def test_equation_1_in_all_quadrants(referent, expected):
    assert relative_angle((0, 0), (0, 2), referent) == pytest.approx(expected)


@given(poses, points, points, points)
def test_equation_1_does_not_change_under_rigid_motions(pose, origin, relatum, referent):
    if math.dist(origin, relatum) < 1e-3 or math.dist(relatum, referent) < 1e-3:
        return
    before = relative_angle(origin, relatum, referent)
    after = relative_angle(*(pose.transform(p) for p in (origin, relatum, referent)))
    np.testing.assert_allclose(unit(before), unit(after), atol=1e-9)


def test_rotation_turns_counter_clockwise():
    np.testing.assert_allclose(rotation(math.pi / 2) @ [1.0, 0.0], [0.0, 1.0], atol=1e-15)
