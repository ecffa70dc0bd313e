"""View cones in the plane: which points a robot at a pose would have in view, occlusion left aside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import ValueRangeError


class ViewCone(Protocol):
    """A region in the robot's frame: x forward, y left [m]."""

    def contains(self, points_robot: FloatArray) -> BoolArray:
        """Return which points (..., 2), in the robot's frame, lie inside: (...,)."""


@dataclass(frozen=True, slots=True)
class Triangle:
    """An isosceles triangle with its apex at the robot: 0 <= x <= length, |y| <= half_width x / length."""

    length: float
    half_width: float

    def __post_init__(self) -> None:
        for what, value in (("length", self.length), ("half width", self.half_width)):
            if not (math.isfinite(value) and value > 0.0):
                raise ValueRangeError(f"the {what} of a view triangle", value, "a positive number of metres")

    def contains(self, points_robot: FloatArray) -> BoolArray:
        """Return which points (..., 2), in the robot's frame, lie inside: (...,)."""
        x, y = points_robot[..., 0], points_robot[..., 1]
        return np.asarray((x >= 0.0) & (x <= self.length) & (np.abs(y) * self.length <= self.half_width * x))


@dataclass(frozen=True, slots=True)
class Sector:
    """A ring sector: near <= r <= far [m], |angle| <= field_of_view / 2 [rad]."""

    near: float
    far: float
    field_of_view: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.near < self.far < math.inf:
            raise ValueRangeError("near and far of a view sector", (self.near, self.far), "0 <= near < far")
        if not 0.0 < self.field_of_view <= 2.0 * math.pi:
            raise ValueRangeError("the field of view", self.field_of_view, "above 0 and at most a full turn")

    def contains(self, points_robot: FloatArray) -> BoolArray:
        """Return which points (..., 2), in the robot's frame, lie inside: (...,)."""
        x, y = points_robot[..., 0], points_robot[..., 1]
        r = np.hypot(x, y)
        within = np.abs(np.arctan2(y, x)) <= 0.5 * self.field_of_view
        return np.asarray((r >= self.near) & (r <= self.far) & within)
