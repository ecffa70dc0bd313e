import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Sector, Triangle
from qsrlang.plotting.outlines import (
    along_edges,
    blind_edges,
    cone_outline,
    cone_outlines,
    ellipse_axes,
    ellipse_outline,
)

FEW = settings(max_examples=30, deadline=None)
LENGTH = st.floats(0.1, 20.0)
ANGLE = st.floats(-math.pi, math.pi)
POSE = st.builds(Pose2, st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), ANGLE)
TRIANGLE = st.builds(Triangle, LENGTH, LENGTH)
SECTOR = st.builds(
    lambda near, depth, fov: Sector(near, near + depth, fov),
    st.one_of(st.just(0.0), st.floats(0.05, 5.0)),
    st.floats(0.1, 5.0),
    st.floats(0.1, 2.0 * math.pi),
)
CONE = st.one_of(TRIANGLE, SECTOR)


def covariances():
    return st.builds(_covariance, st.floats(0.01, 5.0), st.floats(0.01, 5.0), ANGLE)


def _covariance(a, b, heading):
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    return turn @ np.diag([a * a, b * b]) @ turn.T


def _area(outline):
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


@FEW
@given(covariances())
def test_half_axes_are_the_roots_of_the_eigenvalues_along_the_eigenvectors(covariance):
    half = ellipse_axes(covariance)
    low, high = np.linalg.eigvalsh(covariance)
    assert abs(half.major - math.sqrt(high)) < 1e-9 and abs(half.minor - math.sqrt(low)) < 1e-9
    along = np.array([math.cos(half.heading), math.sin(half.heading)])
    assert np.allclose(covariance @ along, high * along, atol=1e-9 * max(1.0, high))


@FEW
@given(covariances(), st.floats(0.5, 3.0))
def test_ellipse_outline_has_one_mahalanobis_distance(covariance, sigmas):
    points = ellipse_outline([3.0, -1.0], covariance, sigmas, 16) - [3.0, -1.0]
    squared = np.einsum("ni,ij,nj->n", points, np.linalg.inv(covariance), points)
    assert np.allclose(squared, sigmas**2, rtol=1e-6)


def test_triangle_corners_are_exact():
    corners = cone_outline(Triangle(3.0, 1.0), Pose2(1.0, 2.0, math.pi / 2.0))
    assert np.allclose(corners, [[1.0, 2.0], [2.0, 5.0], [0.0, 5.0]], atol=1e-15)


@FEW
@given(CONE, POSE, POSE)
def test_outlines_move_with_the_pose(cone, motion, pose):
    moved = motion.transform(cone_outline(cone, pose))
    assert np.allclose(cone_outline(cone, motion @ pose), moved, atol=1e-9)


@FEW
@given(CONE, st.lists(POSE, min_size=1, max_size=4))
def test_many_outlines_are_the_single_ones(cone, poses):
    many = cone_outlines(cone, [[pose.x, pose.y, pose.yaw] for pose in poses])
    assert np.allclose(many, [cone_outline(cone, pose) for pose in poses], atol=1e-12)


@FEW
@given(CONE)
def test_outline_lies_on_the_border_and_runs_counter_clockwise(cone):
    outline = cone_outline(cone, Pose2(0.0, 0.0, 0.0))
    assert _area(outline) > 0.0
    r, angle = np.hypot(*outline.T), np.arctan2(outline[:, 1], outline[:, 0])
    if isinstance(cone, Sector):
        on_arc = np.isclose(r, cone.far) | np.isclose(r, cone.near)
        assert on_arc.all() and (np.abs(angle)[r > 1e-9] <= 0.5 * cone.field_of_view + 1e-9).all()
    else:
        assert cone.limits.contain(0.999 * outline[1:] + 0.001 * outline.mean(axis=0)).all()


@FEW
@given(SECTOR)
def test_sector_area_is_that_of_the_ring(sector):
    outline = cone_outline(sector, Pose2(0.0, 0.0, 0.0))
    ring = 0.5 * sector.field_of_view * (sector.far**2 - sector.near**2)
    assert _area(outline) == pytest.approx(ring, rel=2e-3)
    assert _area(outline) <= ring + 1e-9 or sector.near > 0.0


def test_blind_edges_join_robot_and_near_corners():
    sector = Sector(0.5, 2.0, math.pi / 2.0)
    edges = blind_edges(sector, Pose2(1.0, 0.0, math.pi))
    outline = cone_outline(sector, Pose2(1.0, 0.0, math.pi))
    assert np.allclose(edges[:, 0], [1.0, 0.0])
    assert np.allclose(sorted(edges[:, 1].tolist()), sorted(outline[[len(outline) // 2, -1]].tolist()))
    for cone in (Triangle(3.0, 1.0), Sector(0.0, 2.0, 1.0)):
        assert len(blind_edges(cone, Pose2(0.0, 0.0))) == 0


def test_edges_are_sampled_evenly():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    points = along_edges(square, 4)
    assert len(points) == 16 and {(0.5, 0.0), (2.0, 1.5), (0.0, 1.0)} <= {tuple(point) for point in points}


def test_unknown_cone_is_refused():
    with pytest.raises(ValueRangeError, match="Triangle or Sector"):
        cone_outline("a cone", Pose2(0.0, 0.0))
