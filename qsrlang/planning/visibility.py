"""Equation 3 of the paper: what a pose has in view, and what that view is worth."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.geometry.viewcone import ViewCone

MAX_PAIRS_AT_ONCE = 2_000_000


def in_view(poses_map: npt.ArrayLike, cone: ViewCone, voxels_map: npt.ArrayLike) -> BoolArray:
    """Return In(v_i, Viewcone(psi_n)) of equation 3: whether voxel i lies in the view cone of pose n, (N, K).

    Poses (N, 3) are x, y [m] and yaw [rad]; voxels (K, 2) are centres [m]; both in the map frame. The cone is
    given in the robot's frame. Occlusion and height are left aside, as in the paper.
    """
    poses = frozen_array("the poses of a view", poses_map, (None, 3))
    voxels = frozen_array("the voxels of a view", voxels_map, (None, 2))
    cos, sin = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
    dx = voxels[:, 0] - poses[:, :1]
    dy = voxels[:, 1] - poses[:, 1:2]
    return cone.contains(np.stack([cos * dx + sin * dy, cos * dy - sin * dx], axis=-1))


def view_values(
    poses_map: npt.ArrayLike, cone: ViewCone, voxels_map: npt.ArrayLike, weights: npt.ArrayLike
) -> FloatArray:
    """Return sum_i P(v_i) In(v_i, Viewcone(psi_n)) for every pose n: (N,).

    The sum of equation 3 (Kunze et al. 2014): poses (N, 3) in the map frame [m, rad], voxels (K, 2) [m], weights
    P (K,) of any scale. Every pose starts from the same weights and nothing is rounded. Raises ValueRangeError
    where the shapes do not fit.
    """
    poses = frozen_array("the poses of a view", poses_map, (None, 3))
    voxels = frozen_array("the voxels of a view", voxels_map, (None, 2))
    shares = frozen_array("the weights of the voxels", weights, (len(voxels),))
    values = np.zeros(len(poses))
    chunk = max(1, MAX_PAIRS_AT_ONCE // max(1, len(voxels)))
    for first in range(0, len(poses), chunk):
        seen = in_view(poses[first : first + chunk], cone, voxels)
        values[first : first + chunk] = np.where(seen, shares, 0.0).sum(axis=1)
    return values
