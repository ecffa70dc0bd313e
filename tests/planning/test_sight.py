"""What a camera would show: against a slow walk along each ray, and the laws of the belief that rests on it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.occlusion import clear_rays
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.raymarching import clear_rays_plainly
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.belief import Belief
from qsrlang.planning.detecting import Detector
from qsrlang.planning.frusta import Extent, eyes_of, planes_of
from qsrlang.planning.goals import Goal
from qsrlang.planning.planners.paper import QSRPlanner
from qsrlang.planning.seeing import mark_in_view, mark_plainly
from qsrlang.planning.sensing import Camera
from qsrlang.planning.sight import Sight

CAMERA = Camera(0.3, 2.5, math.radians(57.0), math.radians(50.0), 1.2, math.radians(-20.0))
seeds = st.integers(0, 10_000)


def place(rng, share=0.03):
    voxels = np.full((30, 30, 15), Cell.FREE, dtype=np.uint8)
    voxels[rng.random(voxels.shape) < share] = Cell.OCCUPIED
    voxels[rng.random(voxels.shape) < 0.1] = Cell.UNKNOWN
    return VoxelGrid(voxels, 0.1, np.array([-1.5, -1.5, 0.0]), "test")


def walked(grid, start, end):
    """Return what a walk in small steps says: clear, hidden, or None where it only grazes a voxel."""
    steps = start + np.linspace(0.0, 1.0, 4_000)[:, None] * (end - start)
    cells = grid.indices_of(steps)
    inside = ((cells >= 0) & (cells < grid.voxels.shape)).all(axis=1)
    passed = cells[inside]
    goal = grid.indices_of(end)
    passed = passed[~(passed == goal).all(axis=1)]
    hits = grid.voxels[tuple(passed.T)] == Cell.OCCUPIED
    if not hits.any():
        return True
    return False if hits.sum() > 3 else None


@given(seeds)
def test_rays_agree_with_a_slow_walk(seed):
    rng = np.random.default_rng(seed)
    grid = place(rng)
    starts = rng.uniform([-2.0, -2.0, 0.1], [2.0, 2.0, 1.4], (40, 3))
    ends = rng.uniform([-1.4, -1.4, 0.1], [1.4, 1.4, 1.4], (40, 3))
    for start, end, clear in zip(starts, ends, clear_rays(grid, starts, ends), strict=True):
        expected = walked(grid, start, end)
        if expected is False:
            assert not clear
        elif clear is False:
            assert expected is None


def test_a_wall_hides_what_is_behind_it_and_not_itself():
    voxels = np.full((20, 20, 20), Cell.FREE, dtype=np.uint8)
    voxels[10] = Cell.OCCUPIED
    grid = VoxelGrid(voxels, 0.1, np.zeros(3), "wall")
    eye = np.array([0.25, 1.0, 1.0])
    ends = np.array([[0.95, 1.0, 1.0], [1.05, 1.0, 1.0], [1.15, 1.0, 1.0], [1.95, 0.4, 1.6]])
    assert clear_rays(grid, np.tile(eye, (4, 1)), ends).tolist() == [True, True, False, False]


@given(seeds)
def test_rays_do_not_depend_on_how_voxels_lie_in_memory_and_match_plain_numpy(seed):
    rng = np.random.default_rng(seed)
    grid = place(rng, rng.choice([0.0005, 0.03]))
    turned = VoxelGrid(np.asfortranarray(grid.voxels), grid.resolution, grid.origin, "turned")
    starts, ends = (rng.uniform([-2.5, -2.5, -0.2], [2.5, 2.5, 1.8], (60, 3)) for _ in range(2))
    clear = clear_rays(grid, starts, ends)
    assert (clear_rays(turned, starts, ends) == clear).all()
    assert (clear_rays_plainly(grid, starts, ends) == clear).all()


def test_frustum_near_far_height_and_tilt_decide():
    empty = VoxelGrid(np.full((2, 2, 2), Cell.FREE, dtype=np.uint8), 0.1, np.zeros(3), "empty")
    level = Sight(Camera(0.8, 2.5, math.radians(57.0), math.radians(44.3), 1.76), -0.37, empty)
    points = np.array(
        [[2.0, 0.0, 1.39], [0.7, 0.0, 1.39], [2.6, 0.0, 1.39], [1.5, 0.0, 0.5], [2.4, 0.0, 0.5]]
    )
    points = np.vstack([points, [2.0, 1.0, 1.39], [2.0, 1.2, 1.39], [-2.0, 0.0, 1.39]])
    assert level.visible([[0.0, 0.0, 0.0]], points)[0].tolist() == [
        True,
        False,
        False,
        False,
        True,
        True,
        False,
        False,
    ]
    tilted = Sight(
        Camera(0.8, 2.5, math.radians(57.0), math.radians(44.3), 1.76, math.radians(-30.0)), -0.37, empty
    )
    assert tilted.visible([[0.0, 0.0, 0.0]], points)[0].tolist()[3:5] == [True, False]


def goal(sight, points, weights, rate):
    return Goal("Cup", Belief.of_weights(points, weights), sight, Detector(rate))


@settings(max_examples=10)
@given(seeds, st.floats(0.1, 1.0))
def test_values_are_a_double_loop_and_belief_never_grows(seed, rate):
    rng = np.random.default_rng(seed)
    sight = Sight(CAMERA, 0.0, place(rng))
    points, weights = rng.uniform([-1.4, -1.4, 0.1], [1.4, 1.4, 1.0], (60, 3)), rng.random(60)
    poses = np.column_stack([rng.uniform(-1.5, 1.5, (8, 2)), rng.uniform(-math.pi, math.pi, 8)])
    before = goal(sight, points, weights, rate)
    views = before.views_from(poses)
    for pose, value in zip(poses, views.values(before.belief.mass), strict=True):
        slow = sum(
            rate * b * bool(sight.visible([pose], [x])[0, 0])
            for x, b in zip(points, before.belief.mass, strict=True)
        )
        assert value == pytest.approx(slow, rel=1e-6)
    after = before.after_look(Pose2(*poses[0]), ())
    seen = sight.visible(poses[:1], points)[0]
    np.testing.assert_allclose(
        after.belief.mass, before.belief.mass * np.where(seen, 1.0 - rate, 1.0), rtol=1e-6, atol=1e-9
    )


def test_overlapping_views_are_not_counted_twice():
    """The fifth fault of the original: with a camera that never misses, the same view is worth nothing again."""
    rng = np.random.default_rng(5)
    sight = Sight(CAMERA, 0.0, place(rng, share=0.0))
    points = rng.uniform([-1.0, -1.0, 0.4], [1.0, 1.0, 0.6], (200, 3))
    before = goal(sight, points, np.ones(200), 1.0)
    views = np.array([[-1.4, 0.0, 0.0], [-1.4, 0.0, 0.3]])
    values = before.views_from(views).values(before.belief.mass)
    after = before.after_look(Pose2(*views[0]), ())
    again = after.views_from(views).values(after.belief.mass)
    both = sight.visible(views, points).any(axis=0).mean()
    assert again[0] == 0.0
    assert values[0] + again[1] == pytest.approx(both)
    assert again[1] < values[1]


def test_hidden_voxels_keep_their_weight():
    voxels = np.full((30, 30, 15), Cell.FREE, dtype=np.uint8)
    voxels[15] = Cell.OCCUPIED
    sight = Sight(CAMERA, 0.0, VoxelGrid(voxels, 0.1, np.array([-1.5, -1.5, 0.0]), "wall"))
    points = np.array([[-0.3, 0.0, 0.6], [0.5, 0.0, 0.6]])
    after = goal(sight, points, np.ones(2), 0.9).after_look(Pose2(-1.45, 0.0), ())
    np.testing.assert_allclose(after.belief.mass, [0.05, 0.5], rtol=1e-6)


@given(seeds, st.booleans())
def test_numpy_and_compiled_kernels_see_the_same(seed, thick):
    rng = np.random.default_rng(seed)
    extent = Extent(0.1, 0.1) if thick else Extent()
    sight = Sight(CAMERA, 0.0, place(rng), extent)
    points = rng.uniform([-1.4, -1.4, 0.1], [1.4, 1.4, 1.0], (80, 3))
    poses = np.column_stack([rng.uniform(-1.5, 1.5, (10, 2)), rng.uniform(-math.pi, math.pi, 10)])
    planes, eyes = planes_of(poses, CAMERA, 0.0, extent), eyes_of(poses, CAMERA, 0.0)
    plain, compiled = np.empty((10, 80), dtype=bool), np.empty((10, 80), dtype=bool)
    mark_plainly(planes, eyes, points, sight.voxels, plain)
    mark_in_view(planes, eyes, sight.reach, points, sight.voxels, compiled)
    np.testing.assert_array_equal(plain, compiled)


def test_the_paper_s_planners_learn_nothing_from_an_empty_view():
    planner = QSRPlanner(None, np.zeros((1, 2)), np.ones(1))
    assert planner.after_look(Pose2(0.0, 0.0), ()) is planner


@pytest.mark.parametrize("rate", [0.0, 1.1, math.nan])
def test_senseless_detection_rates_are_refused(rate):
    with pytest.raises(ValueRangeError, match="detection rate"):
        Detector(rate)
