import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from strategies import angles, poses

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2

SQUARE = ConvexPolygon.rectangle(Pose2(0.0, 0.0), 2.0, 2.0)
inside = st.tuples(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9))


@given(inside, angles)
def test_a_ray_from_inside_ends_on_the_border(start, angle):
    end = np.array(start) + SQUARE.ray_lengths(start, unit(angle)) * unit(angle)
    assert np.abs(end).max() == pytest.approx(1.0)


@given(poses, inside, angles)
def test_ray_lengths_do_not_change_under_rigid_motions(pose, start, angle):
    moved = ConvexPolygon(pose.transform(SQUARE.corners))
    before = SQUARE.ray_lengths(start, unit(angle))
    assert moved.ray_lengths(pose.transform(start), unit(angle + pose.yaw)) == pytest.approx(before)


@given(st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)))
def test_the_nearest_point_is_the_clipped_one(point):
    np.testing.assert_allclose(SQUARE.nearest(point), np.clip(point, -1.0, 1.0), atol=1e-12)


@given(angles, st.floats(0.05, 0.4), st.floats(0.05, 0.4), angles)
def test_a_box_stopped_at_its_margin_touches_the_border(yaw, half_length, half_width, direction):
    margins = SQUARE.box_reach(yaw, half_length, half_width)
    length = SQUARE.ray_lengths((0.0, 0.0), unit(direction), margins)
    assume(length > 0.0)
    corners = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]) * [half_length, half_width]
    box = Pose2(*(length * unit(direction)), yaw).transform(corners)
    assert np.abs(box).max() == pytest.approx(1.0)


def test_a_polygon_is_convex_and_counter_clockwise():
    with pytest.raises(ValueRangeError, match="counter-clockwise"):
        ConvexPolygon(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]))
    with pytest.raises(ValueRangeError):
        ConvexPolygon(np.array([[0.0, 0.0], [math.inf, 1.0], [1.0, 0.0]]))
