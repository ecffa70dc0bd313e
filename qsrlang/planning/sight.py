"""What a camera would show of the supports: frustum, height and occlusion, by the robot's own map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.maps.occlusion import clear_rays
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.sensing import Camera


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """A camera in a mapped place; `floor` is the height of the floor in the map frame [m]."""

    camera: Camera
    floor: float
    voxels: VoxelGrid

    def visible(self, poses_map: npt.ArrayLike, points_map: npt.ArrayLike) -> BoolArray:
        """Return which points (K, 3) [m] are in the frustum and hidden by nothing from poses (N, 3): (N, K)."""
        poses = frozen_array("the poses of a camera", poses_map, (None, 3))
        points = frozen_array("the points before a camera", points_map, (None, 3))
        eyes, axes = eyes_of(poses, self.camera, self.floor), axes_of(poses, self.camera)
        seen = np.empty((len(poses), len(points)), dtype=np.bool_)
        for row, eye, turn in zip(seen, eyes, axes, strict=True):
            row[:] = in_frustum(self.camera, (points - eye) @ turn.T)
            inside = np.flatnonzero(row)
            row[inside] = clear_rays(self.voxels, np.broadcast_to(eye, (len(inside), 3)), points[inside])
        return seen


def in_frustum(camera: Camera, points_camera: FloatArray) -> BoolArray:
    """Return which points (..., 3), given as (forward, left, up) [m], lie in the frustum of a camera: (...,)."""
    forward, left, up = points_camera[..., 0], points_camera[..., 1], points_camera[..., 2]
    between = (forward >= camera.near) & (forward <= camera.far)
    wide = np.abs(left) <= np.tan(0.5 * camera.horizontal_fov) * forward
    high = np.abs(up) <= np.tan(0.5 * camera.vertical_fov) * forward
    return np.asarray(between & wide & high)


def eyes_of(poses: FloatArray, camera: Camera, floor: float) -> FloatArray:
    """Return where the camera is (N, 3) when the robot stands at poses (N, 3) of x, y, yaw."""
    return np.column_stack([poses[:, :2], np.full(len(poses), floor + camera.height)])


def axes_of(poses: FloatArray, camera: Camera) -> FloatArray:
    """Return the axes (N, 3, 3) of the camera at poses (N, 3), rows forward, left, up, in the map frame."""
    yaw, zero = poses[:, 2], np.zeros(len(poses))
    cos, sin, lift, flat = np.cos(yaw), np.sin(yaw), np.sin(camera.tilt), np.cos(camera.tilt)
    forward = np.stack([flat * cos, flat * sin, zero + lift], axis=-1)
    left = np.stack([-sin, cos, zero], axis=-1)
    up = np.stack([-lift * cos, -lift * sin, zero + flat], axis=-1)
    return np.stack([forward, left, up], axis=1)
