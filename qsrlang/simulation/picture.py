"""Colour pictures of a scene, for people."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.simulation.engine import NOTHING, Lens
from qsrlang.simulation.rooms import Room
from qsrlang.simulation.scene import Scene, scene_of_room
from qsrlang.simulation.world import PybulletWorld

MAX_PICTURE_SIDE = 2_000
VERTICAL_FOV = np.radians(45.0)
NEAR, FAR = 0.05, 60.0
SMOOTHING = 2
BACKGROUND = np.array([238, 242, 245], dtype=np.uint8)


def scene_picture(
    place: PybulletWorld | Scene | Room,
    eye: npt.ArrayLike,
    target: npt.ArrayLike,
    size: tuple[int, int] = (960, 640),
    vertical_fov: float = VERTICAL_FOV,
) -> npt.NDArray[np.uint8]:
    """Return a colour picture (height, width, 3) of a place, from `eye` (3,) to `target` (3,), map frame [m].

    A robot is left out of what it sees with its own eye. `size` is (width, height) in pixels.
    Raises ValueRangeError where it is too large or the two points coincide.
    """
    width, height = size
    if not (0 < width <= MAX_PICTURE_SIDE and 0 < height <= MAX_PICTURE_SIDE):
        raise ValueRangeError("the size of a picture", size, f"1 to {MAX_PICTURE_SIDE} pixels a side")
    points = np.asarray(eye, dtype=np.float64), np.asarray(target, dtype=np.float64)
    if isinstance(place, Room):
        scene = scene_of_room(place)
        try:
            return _drawn(scene, *points, size, vertical_fov)
        finally:
            scene.engine.close()
    if isinstance(place, Scene):
        return _drawn(place, *points, size, vertical_fov)
    with place.robot_out_of(points[0]):
        return _drawn(place.scene, *points, size, vertical_fov)


def _drawn(
    scene: Scene, eye: FloatArray, target: FloatArray, size: tuple[int, int], fov: float
) -> npt.NDArray[np.uint8]:
    way = target - eye
    if not np.linalg.norm(way) > 0.0:
        raise ValueRangeError("the target of a picture", target.tolist(), "another point than the eye")
    upward = np.array([0.0, 0.0, 1.0]) if np.hypot(way[0], way[1]) > 1e-3 else np.array([0.0, 1.0, 0.0])
    width, height = size
    lens = Lens(NEAR, FAR, 2.0 * float(np.arctan(np.tan(0.5 * fov) * width / height)), fov)
    fine = scene.engine.render(eye, target, upward, lens, SMOOTHING * width, SMOOTHING * height, shadow=True)
    colours = np.where((fine.bodies == NOTHING)[..., None], BACKGROUND, fine.colours)
    blocks = colours.reshape(height, SMOOTHING, width, SMOOTHING, 3)
    return np.asarray(blocks.mean(axis=(1, 3)).round(), dtype=np.uint8)
