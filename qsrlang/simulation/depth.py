"""Images of a scene by pybullet's software renderer: depth as points, and which body each pixel shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.frusta import axes_of, eyes_of
from qsrlang.planning.sensing import Camera
from qsrlang.simulation.engine import Engine, Lens

FARTHEST = 1.0 - 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """What a depth camera sees from `eye` (3,): a point (H, W, 3) for each pixel, map frame [m].

    `hit` (H, W) is False where nothing is within `far`; the point then lies at twice `far`. `bodies` (H, W)
    is the body each pixel shows, or NOTHING.
    """

    eye: FloatArray
    points: FloatArray
    hit: BoolArray
    bodies: IntArray


def depth_image(
    engine: Engine, camera: Camera, pose: Pose2, floor: float, width: int, height: int
) -> DepthImage:
    """Render what the camera sees with the robot at a pose, `width` x `height` pixels.

    A pixel's depth along the axis is d = f n / (f - (f - n) z) for the depth buffer's z, near n and far f.
    The renderer samples each pixel at its lower left corner.
    """
    poses = np.array([[pose.x, pose.y, pose.yaw]])
    eye, axes = eyes_of(poses, camera, floor)[0], axes_of(poses, camera)[0]
    lens = Lens(camera.near, camera.far, camera.horizontal_fov, camera.vertical_fov)
    image = engine.render(eye, eye + axes[0], axes[2], lens, width, height)
    near, far = camera.near, camera.far
    hit = image.depth < FARTHEST
    depth = np.where(hit, far * near / (far - (far - near) * np.minimum(image.depth, FARTHEST)), 2.0 * far)
    left = np.tan(0.5 * camera.horizontal_fov) * (1.0 - 2.0 * np.arange(width) / width)
    up = np.tan(0.5 * camera.vertical_fov) * (1.0 - 2.0 * (np.arange(height) + 1.0) / height)
    rays = axes[0] + left[None, :, None] * axes[1] + up[:, None, None] * axes[2]
    return DepthImage(eye, eye + depth[..., None] * rays, hit, image.bodies)
