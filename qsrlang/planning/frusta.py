"""Frusta of a camera as planes, for points and for things of some size. Half spaces: normal . x >= offset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.planning.sensing import Camera

PLANES = 6


@dataclass(frozen=True, slots=True)
class Extent:
    """How far a thing reaches from its centre: sideways (a radius) and up or down [m]; zeros for a point."""

    radius: float = 0.0
    half_height: float = 0.0

    def __post_init__(self) -> None:
        for what, value in (("radius", self.radius), ("half height", self.half_height)):
            if not 0.0 <= value < np.inf:
                raise ValueRangeError(f"the {what} of a thing", value, "at least 0 m")

    @property
    def size(self) -> float:
        """The diameter of the ball of the same reach [m]."""
        return 2.0 * float(np.hypot(self.radius, self.half_height))


POINT = Extent()


def eyes_of(poses: FloatArray, camera: Camera, floor: float) -> FloatArray:
    """Return where the camera is (N, 3) when the robot stands at poses (N, 3) of x, y, yaw."""
    return np.column_stack([poses[:, :2], np.full(len(poses), floor + camera.height)])


def axes_of(poses: FloatArray, camera: Camera, tilts: npt.ArrayLike | None = None) -> FloatArray:
    """Return the axes (N, 3, 3) of the camera at poses (N, 3), rows forward, left, up, in the map frame.

    `tilts` (N,) [rad] stand in for the camera's own.
    """
    yaw, zero = poses[:, 2], np.zeros(len(poses))
    tilt = zero + camera.tilt if tilts is None else np.asarray(tilts, dtype=np.float64)
    cos, sin, lift, flat = np.cos(yaw), np.sin(yaw), np.sin(tilt), np.cos(tilt)
    forward = np.stack([flat * cos, flat * sin, lift], axis=-1)
    left = np.stack([-sin, cos, zero], axis=-1)
    up = np.stack([-lift * cos, -lift * sin, flat], axis=-1)
    return np.stack([forward, left, up], axis=1)


def planes_of(
    poses: FloatArray,
    camera: Camera,
    floor: float,
    extent: Extent = POINT,
    tilts: npt.ArrayLike | None = None,
) -> FloatArray:
    """Return the planes (N, 6, 4) of the frusta at poses (N, 3): three of the normal, then the offset.

    A thing is in view unless it lies wholly behind one of them, as in the simulator of Kunze et al. 2014
    (`boxInsideFrustum`): each plane is moved out by how far the thing reaches along its normal.
    """
    axes = axes_of(poses, camera, tilts)
    forward, left, up = axes[:, 0], axes[:, 1], axes[:, 2]
    wide, high = np.tan(0.5 * camera.horizontal_fov), np.tan(0.5 * camera.vertical_fov)
    normals = np.stack(
        [
            forward,
            -forward,
            wide * forward - left,
            wide * forward + left,
            high * forward - up,
            high * forward + up,
        ],
        axis=1,
    )
    least = np.array([camera.near, -camera.far, 0.0, 0.0, 0.0, 0.0])
    reach = extent.radius * np.hypot(normals[..., 0], normals[..., 1]) + extent.half_height * np.abs(
        normals[..., 2]
    )
    eyes = eyes_of(poses, camera, floor)
    offsets = least + np.einsum("npd,nd->np", normals, eyes) - reach
    return np.concatenate([normals, offsets[..., None]], axis=-1)
