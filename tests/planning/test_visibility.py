import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Sector, Triangle, ViewCone
from qsrlang.planning.visibility import in_view, view_values

CASES = 1_000


def looked_at(pose, cone, voxel):
    """Whether a voxel lies in a cone, in schoolbook trigonometry; None where it lies within 1e-9 of the border."""
    x, y, yaw = pose
    distance = math.hypot(voxel[0] - x, voxel[1] - y)
    bearing = math.remainder(math.atan2(voxel[1] - y, voxel[0] - x) - yaw, 2 * math.pi)
    if isinstance(cone, Sector):
        slacks = (distance - cone.near, cone.far - distance, cone.field_of_view / 2 - abs(bearing))
    else:
        depth, side = distance * math.cos(bearing), distance * math.sin(bearing)
        slacks = (depth, cone.length - depth, cone.half_width * depth / cone.length - abs(side))
    return None if min(abs(slack) for slack in slacks) < 1e-9 else min(slacks) > 0


def brute_force(poses, cone, voxels, weights):
    """Equation 3 as a double loop."""
    sums = []
    for pose in poses:
        total = 0.0
        for voxel, weight in zip(voxels, weights, strict=True):
            if looked_at(pose, cone, voxel):
                total += weight
        sums.append(total)
    return np.array(sums)


def random_case(rng):
    poses = np.empty((int(rng.integers(1, 8)), 3))
    poses[:, :2] = rng.uniform(-3, 3, (len(poses), 2))
    poses[:, 2] = rng.uniform(-7, 7, len(poses))
    voxels = rng.uniform(-4, 4, (int(rng.integers(0, 40)), 2))
    weights = rng.exponential(5.0, len(voxels))
    cone: ViewCone = Triangle(rng.uniform(0.5, 4), rng.uniform(0.1, 3))
    if rng.random() < 0.5:
        near = rng.uniform(0, 1)
        cone = Sector(near, near + rng.uniform(0.1, 4), rng.uniform(0.1, 2 * math.pi))
    return poses, cone, voxels, weights


def test_a_thousand_random_cases_equal_the_double_loop():
    rng = np.random.default_rng(2014)
    seen = 0
    for _ in range(CASES):
        poses, cone, voxels, weights = random_case(rng)
        expected = brute_force(poses, cone, voxels, weights)
        np.testing.assert_allclose(
            view_values(poses, cone, voxels, weights), expected, rtol=1e-12, atol=1e-12
        )
        assert int(np.argmax(view_values(poses, cone, voxels, weights))) == int(
            np.argmax(np.round(expected, 9))
        )
        seen += int((expected > 0).any())
    assert seen > CASES // 2


def test_values_are_what_is_in_view():
    rng = np.random.default_rng(5)
    poses = np.column_stack([rng.uniform(-3, 3, (50, 2)), rng.uniform(-4, 4, 50)])
    voxels, weights = rng.uniform(-4, 4, (300, 2)), rng.random(300)
    for cone in (Triangle(3, 1), Sector(0.5, 2.5, 1.0), Sector(0.0, 2.0, 5.0)):
        np.testing.assert_allclose(
            view_values(poses, cone, voxels, weights), in_view(poses, cone, voxels) @ weights, rtol=1e-12
        )


def test_weights_below_one_are_not_cut_to_whole_numbers():
    values = view_values([[0, 0, 0]], Triangle(3, 1), [[1, 0], [2, 0]], [0.25, 0.5])
    assert values.tolist() == [0.75]


def test_a_pose_is_worth_the_same_whatever_was_scored_before_it():
    rng = np.random.default_rng(8)
    poses = np.column_stack([rng.uniform(-2, 2, (20, 2)), rng.uniform(-4, 4, 20)])
    voxels, weights = rng.uniform(-3, 3, (200, 2)), 1 + 10 * rng.random(200)
    together = view_values(poses, Triangle(3, 1), voxels, weights)
    alone = np.concatenate([view_values(pose[None], Triangle(3, 1), voxels, weights) for pose in poses])
    np.testing.assert_array_equal(together, alone)
    np.testing.assert_array_equal(view_values(poses[::-1], Triangle(3, 1), voxels, weights), together[::-1])


def test_no_voxels_and_no_poses():
    assert view_values([[0, 0, 0]], Triangle(3, 1), np.empty((0, 2)), []).tolist() == [0.0]
    assert view_values(np.empty((0, 3)), Triangle(3, 1), [[1, 0]], [1.0]).shape == (0,)


def test_in_view_tells_which_voxels():
    seen = in_view([[0, 0, 0], [0, 0, math.pi]], Triangle(3, 1), [[1, 0.3], [1, 0.4], [-1, 0]])
    assert seen.tolist() == [[True, False, False], [False, False, True]]


@given(
    st.integers(0, 2**32 - 1),
    st.builds(Pose2, st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)),
)
def test_moving_room_and_robot_together_changes_nothing(seed, motion):
    rng = np.random.default_rng(seed)
    poses, cone, voxels, _ = random_case(rng)
    clear = [[looked_at(pose, cone, voxel) is not None for voxel in voxels] for pose in poses]
    moved = np.column_stack([motion.transform(poses[:, :2]), poses[:, 2] + motion.yaw])
    before, after = in_view(poses, cone, voxels), in_view(moved, cone, motion.transform(voxels))
    assert (before == after)[np.array(clear, dtype=bool).reshape(before.shape)].all()


@given(st.integers(0, 2**32 - 1))
def test_equation_3_is_additive_over_disjoint_voxels(seed):
    poses, cone, voxels, weights = random_case(np.random.default_rng(seed))
    half = len(voxels) // 2
    parts = view_values(poses, cone, voxels[:half], weights[:half]) + view_values(
        poses, cone, voxels[half:], weights[half:]
    )
    np.testing.assert_allclose(view_values(poses, cone, voxels, weights), parts, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("poses", "voxels", "weights"),
    [
        ([[0, 0]], [[1, 0]], [1.0]),
        ([[0, 0, 0]], [[1, 0, 0]], [1.0]),
        ([[0, 0, 0]], [[1, 0]], [1.0, 2.0]),
        ([[0, 0, math.nan]], [[1, 0]], [1.0]),
        ([[0, 0, 0]], [[1, 0]], [math.inf]),
    ],
)
def test_shapes_that_do_not_fit_are_refused(poses, voxels, weights):
    with pytest.raises(ValueRangeError):
        view_values(poses, Triangle(3, 1), voxels, weights)
