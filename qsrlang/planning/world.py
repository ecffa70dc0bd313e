"""The only door to a robot, simulated or real."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2


@dataclass(frozen=True, slots=True)
class Detection:
    """One object a camera recognised: its name, its class and its position (x, y, z) in the map frame [m]."""

    name: str
    kind: str
    position: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Drive:
    """What a drive cost: the pose reached, path length [m], angle turned [rad] and time [s]."""

    reached: Pose2
    travel: float
    turn: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Look:
    """What one look showed, and the time it took [s]."""

    detections: tuple[Detection, ...]
    seconds: float


class World(Protocol):
    """A robot in a place; poses are in the map frame."""

    @property
    def robot_pose(self) -> Pose2:
        """Where the robot stands."""

    def drive(self, path: FloatArray, yaw: float) -> Drive:
        """Drive along the points (K, 2) of a path, first its own place, and turn to `yaw` at the end."""

    def look(self, tilt: float | None = None) -> Look:
        """Dwell, look once, and return what was recognised; `tilt` [rad] stands in for that of the camera."""
