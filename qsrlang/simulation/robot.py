"""The body of a simulated robot: it is set along its path, step by step, and stops where it would touch something."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import wrap
from qsrlang.geometry.pose import Pose2
from qsrlang.search.sensing import Camera, Robot
from qsrlang.simulation.engine import Engine
from qsrlang.simulation.rooms import Part, Shape

MAX_RADIUS = 0.3
SHARE_OF_CLEARANCE = 0.8
GROUND_GAP = 0.1
MAX_STEP = 0.1
MASS = 40.0
OUT_OF_SIGHT = 100.0
SHELL, TRIM, LENS = (0.90, 0.45, 0.10), (0.93, 0.93, 0.90), (0.10, 0.11, 0.12)


class RobotBody:
    """A cylinder in an engine, as tall as the camera is high and a little narrower than its clearance."""

    def __init__(self, engine: Engine, robot: Robot, camera: Camera, floor: float) -> None:
        self.radius = min(MAX_RADIUS, SHARE_OF_CLEARANCE * robot.clearance)
        self._engine, self._bottom = engine, floor + GROUND_GAP
        self._height = max(camera.height - GROUND_GAP, 0.1)
        size = (2 * self.radius, 2 * self.radius, self._height)
        solid = (Part(Shape.CYLINDER, size, (0.0, 0.0, 0.0), SHELL),)
        self._body = engine.add_ghost(solid, MASS, _looks(self.radius, self._height))

    def put(self, pose: Pose2) -> None:
        """Set the robot down at a pose."""
        centre = np.array([pose.x, pose.y, self._bottom + 0.5 * self._height])
        self._engine.put(self._body, centre, pose.yaw)

    def vanish(self) -> None:
        """Take the robot out of sight, far below the floor, until it is put down again."""
        self._engine.put(self._body, np.array([0.0, 0.0, self._bottom - OUT_OF_SIGHT]), 0.0)

    def fits(self, pose: Pose2) -> bool:
        """Return whether the robot touches nothing at a pose; it stands there afterwards."""
        self.put(pose)
        return not self._engine.touches(self._body)

    def follow(self, start: Pose2, path: FloatArray, yaw: float) -> tuple[Pose2, float, float]:
        """Drive along the points (K, 2) of a path and turn to `yaw`: the pose reached, path length [m], angle turned [rad].

        It turns on the spot at every corner, and stops short of the first touch, without the last turn.
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
                yaw = heading
                break
        pose = Pose2(float(place[0]), float(place[1]), yaw)
        self.put(pose)
        return pose, travel, turn + _between(heading, yaw)

    def _advance(self, start: FloatArray, end: FloatArray, yaw: float) -> FloatArray:
        """Move along a straight line between points (2,) until something would be touched; return the place reached."""
        steps = max(int(np.ceil(np.hypot(*(end - start)) / MAX_STEP)), 1)
        reached = start
        for place in np.linspace(start, end, steps + 1)[1:]:
            if not self.fits(Pose2(float(place[0]), float(place[1]), yaw)):
                return reached
            reached = place
        return end


def _looks(radius: float, height: float) -> tuple[Part, ...]:
    """Return a wheeled base, a column and a head whose lens looks along +x, within the body's cylinder."""
    wide, head = 2 * radius, min(0.16, 0.5 * height)
    base = min(0.32, 0.4 * height)
    return (
        Part(Shape.CYLINDER, (0.9 * wide, 0.9 * wide, 0.08), (0.0, 0.0, 0.02 - GROUND_GAP), LENS),
        Part(Shape.CYLINDER, (wide, wide, base), (0.0, 0.0, 0.0), SHELL),
        Part(Shape.CYLINDER, (0.8 * wide, 0.8 * wide, 0.03), (0.0, 0.0, base), TRIM),
        Part(Shape.BOX, (0.10, 0.14, height - base), (0.0, 0.0, base), TRIM),
        Part(Shape.BOX, (0.16, 0.26, head), (0.02, 0.0, height - 0.5 * head), SHELL),
        Part(Shape.CYLINDER, (0.05, 0.05, 0.03), (0.09, 0.06, height - 0.02), LENS),
        Part(Shape.CYLINDER, (0.05, 0.05, 0.03), (0.09, -0.06, height - 0.02), LENS),
    )


def _between(first: float, second: float) -> float:
    return abs(float(wrap(second - first)))
