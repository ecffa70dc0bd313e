"""What a robot is: its base and its camera, as the planner assumes them and as a simulated world builds them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from qsrlang.errors import ValueRangeError


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera on the robot's axis: field of view [rad], near and far [m], height above the floor [m], tilt [rad].

    A positive tilt looks up. `near` and `far` bound the distance along the viewing axis.
    """

    near: float
    far: float
    horizontal_fov: float
    vertical_fov: float
    height: float
    tilt: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < self.near < self.far < math.inf:
            raise ValueRangeError("near and far of a camera", (self.near, self.far), "0 < near < far")
        for what, value in (("horizontal", self.horizontal_fov), ("vertical", self.vertical_fov)):
            if not 0.0 < value < math.pi:
                raise ValueRangeError(f"the {what} field of view", value, "above 0 and below pi rad")
        if not 0.0 < self.height < math.inf:
            raise ValueRangeError("the height of a camera", self.height, "a positive number of metres")
        if not abs(self.tilt) < math.pi / 2:
            raise ValueRangeError("the tilt of a camera", self.tilt, "within a quarter turn")


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot's base: clearance it keeps from obstacles [m], speed [m/s], turn rate [rad/s], dwell at a look [s]."""

    clearance: float
    speed: float
    turn_rate: float
    dwell: float

    def __post_init__(self) -> None:
        for what in ("clearance", "speed", "turn_rate"):
            value = getattr(self, what)
            if not 0.0 < value < math.inf:
                raise ValueRangeError(f"the {what.replace('_', ' ')} of a robot", value, "a positive number")
        if not 0.0 <= self.dwell < math.inf:
            raise ValueRangeError("the dwell of a robot", self.dwell, "at least 0 s")
