import math

import numpy as np
import pytest
from hypothesis import given
from strategies import points, poses

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2

IDENTITY = Pose2(0.0, 0.0)


def close(a: Pose2, b: Pose2) -> bool:
    return math.dist(a.position, b.position) < 1e-9 and abs(math.remainder(a.yaw - b.yaw, math.tau)) < 1e-9


@given(poses, poses, poses)
def test_poses_form_a_group(a, b, c):
    assert close((a @ b) @ c, a @ (b @ c))
    assert close(a @ IDENTITY, a)
    assert close(a @ a.inverse(), IDENTITY)
    assert close(a.inverse() @ a, IDENTITY)


@given(poses, poses, points)
def test_poses_act_on_points(a, b, point):
    np.testing.assert_allclose((a @ b).transform(point), a.transform(b.transform(point)), atol=1e-9)
    np.testing.assert_allclose(a.transform_inverse(a.transform(point)), point, atol=1e-9)


def test_a_pose_is_finite():
    with pytest.raises(ValueRangeError, match="finite"):
        Pose2(math.nan, 0.0)
