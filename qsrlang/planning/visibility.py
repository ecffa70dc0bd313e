"""Equation 3 of the paper: what a pose has in view, and what that view is worth."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.planning.threads import over_rows


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
    return cone.limits.contain(np.stack([cos * dx + sin * dy, cos * dy - sin * dx], axis=-1))


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
    xs, ys, limits = voxels[:, 0].copy(), voxels[:, 1].copy(), cone.limits
    kernel = _sum_in_wedge if limits.near == 0.0 and math.isinf(limits.far) else _sum_in_view
    over_rows(
        lambda first, last: kernel(poses, xs, ys, shares, *limits, values, first, last),
        len(poses),
        len(poses) * len(voxels),
    )
    return values


# Sums may be regrouped, which lets the compiler take several voxels at once; conditions without branches, likewise.
@njit(cache=True, nogil=True, fastmath={"reassoc"})
def _sum_in_view(poses, xs, ys, shares, near, far, length, across, along, values, start, end):  # type: ignore[no-untyped-def]
    least, most = near * near, far * far
    for n in range(start, end):
        cos, sin, total = math.cos(poses[n, 2]), math.sin(poses[n, 2]), 0.0
        for k in range(len(xs)):
            dx, dy = xs[k] - poses[n, 0], ys[k] - poses[n, 1]
            x, y = cos * dx + sin * dy, cos * dy - sin * dx
            square = x * x + y * y
            inside = (square >= least) & (square <= most) & (x <= length) & (abs(y) * across <= x * along)
            total += shares[k] if inside else 0.0
        values[n] = total


# The same without near and far, which a triangle does not have: half the arithmetic.
@njit(cache=True, nogil=True, fastmath={"reassoc"})
def _sum_in_wedge(poses, xs, ys, shares, near, far, length, across, along, values, start, end):  # type: ignore[no-untyped-def]
    for n in range(start, end):
        cos, sin, total = math.cos(poses[n, 2]), math.sin(poses[n, 2]), 0.0
        for k in range(len(xs)):
            dx, dy = xs[k] - poses[n, 0], ys[k] - poses[n, 1]
            x, y = cos * dx + sin * dy, cos * dy - sin * dx
            inside = (x <= length) & (abs(y) * across <= x * along)
            total += shares[k] if inside else 0.0
        values[n] = total
