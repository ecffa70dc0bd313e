"""The body of a simulated robot: it goes along its path step by step and stops before it touches."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import wrap
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.simulation.engine import Engine
from qsrlang.simulation.rooms import Part, Shape, centroid_of

MAX_RADIUS = 0.3
SHARE_OF_CLEARANCE = 0.8
GROUND_GAP = 0.1
MAX_STEP = 0.1
MASS = 40.0
BASE_HEIGHT, MAST_RADIUS = 0.32, 0.14
OUT_OF_SIGHT = 100.0
SHELL, TRIM, LENS = (0.90, 0.45, 0.10), (0.93, 0.93, 0.90), (0.10, 0.11, 0.12)


class RobotBody:
    """A round base, a little narrower than the robot's clearance, and a mast as high as the camera."""

    def __init__(self, engine: Engine, robot: Robot, camera: Camera, floor: float) -> None:
        self.radius = min(MAX_RADIUS, SHARE_OF_CLEARANCE * robot.clearance)
        self._engine, self._bottom = engine, floor + GROUND_GAP
        height = max(camera.height - GROUND_GAP, 0.1)
        solid = _solid(self.radius, height)
        self._middle = centroid_of(solid)[2]
        self._body = engine.add_ghost(solid, MASS, _looks(self.radius, height))

    def put(self, pose: Pose2) -> None:
        """Set the robot down at a pose."""
        self._engine.put(self._body, np.array([pose.x, pose.y, self._bottom + self._middle]), pose.yaw)

    def vanish(self) -> None:
        """Take the robot out of sight, far below the floor, until it is put down again."""
        self._engine.put(self._body, np.array([0.0, 0.0, self._bottom - OUT_OF_SIGHT]), 0.0)

    def fits(self, pose: Pose2) -> bool:
        """Return whether the robot touches nothing at a pose; it stands there afterwards."""
        self.put(pose)
        return not self._engine.touches(self._body)

    def follow(self, start: Pose2, path: FloatArray, yaw: float) -> tuple[Pose2, float, float]:
        """Drive along the points (K, 2) of a path and turn to `yaw`.

        Returns the pose reached, the length driven [m] and the angle turned [rad]. It turns on the spot at
        every corner. It stops short of the first touch, and makes the last turn there.
        """
        place, heading, travel, turn = start.position, start.yaw, 0.0, 0.0
        for point in path:
            way = point - place
            if not way.any():
                continue
            towards = float(np.arctan2(way[1], way[0]))
            reached = self._advance(place, point, towards)
            travel, turn = travel + float(np.hypot(*(reached - place))), turn + _between(heading, towards)
            place, heading = reached, towards
            if (reached != point).any():
                break
        pose = Pose2(float(place[0]), float(place[1]), yaw)
        self.put(pose)
        return pose, travel, turn + _between(heading, yaw)

    def _advance(self, start: FloatArray, end: FloatArray, yaw: float) -> FloatArray:
        """Move from point (2,) to point until something would be touched; return the place reached."""
        steps = max(int(np.ceil(np.hypot(*(end - start)) / MAX_STEP)), 1)
        reached = start
        for place in np.linspace(start, end, steps + 1)[1:]:
            if not self.fits(Pose2(float(place[0]), float(place[1]), yaw)):
                return reached
            reached = place
        return end


def _solid(radius: float, height: float) -> tuple[Part, ...]:
    base, mast = min(BASE_HEIGHT, height), min(MAST_RADIUS, radius)
    return (
        Part(Shape.CYLINDER, (2 * radius, 2 * radius, base), (0.0, 0.0, 0.0), SHELL),
        Part(Shape.CYLINDER, (2 * mast, 2 * mast, height), (0.0, 0.0, 0.0), TRIM),
    )


def _looks(radius: float, height: float) -> tuple[Part, ...]:
    """Return wheels, base, a column and a head whose two lenses look along +x."""
    wide, base, head = 2 * radius, min(BASE_HEIGHT, height), min(0.16, 0.5 * height)
    return (
        Part(Shape.CYLINDER, (0.9 * wide, 0.9 * wide, 0.08), (0.0, 0.0, 0.02 - GROUND_GAP), LENS),
        Part(Shape.CYLINDER, (wide, wide, base), (0.0, 0.0, 0.0), SHELL),
        Part(Shape.CYLINDER, (0.8 * wide, 0.8 * wide, 0.03), (0.0, 0.0, base), TRIM),
        Part(Shape.BOX, (0.10, 0.14, height), (0.0, 0.0, 0.0), TRIM),
        Part(Shape.BOX, (0.16, 0.26, head), (0.02, 0.0, height - 0.5 * head), SHELL),
        Part(Shape.BOX, (0.02, 0.05, 0.05), (0.105, 0.06, height - 0.02), LENS),
        Part(Shape.BOX, (0.02, 0.05, 0.05), (0.105, -0.06, height - 0.02), LENS),
    )


def _between(first: float, second: float) -> float:
    return abs(float(wrap(second - first)))
