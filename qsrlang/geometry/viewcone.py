"""View cones in the plane: which points a robot at a pose would have in view, occlusion left aside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import ValueRangeError


class ConeLimits(NamedTuple):
    """What bounds a cone in the robot's frame: near² <= x² + y² <= far², x <= length, |y| across <= x along."""

    near: float
    far: float
    length: float
    across: float
    along: float

    def contain(self, points_robot: FloatArray) -> BoolArray:
        """Return which points (..., 2), in the robot's frame, lie inside: (...,)."""
        x, y = points_robot[..., 0], points_robot[..., 1]
        squares = x * x + y * y
        ring = (squares >= self.near * self.near) & (squares <= self.far * self.far)
        return np.asarray(ring & (x <= self.length) & (np.abs(y) * self.across <= x * self.along))


class ViewCone(Protocol):
    """A region in the robot's frame: x forward, y left [m]."""

    @property
    def limits(self) -> ConeLimits:
        """What bounds it."""


@dataclass(frozen=True, slots=True)
class Triangle:
    """An isosceles triangle with its apex at the robot: 0 <= x <= length, |y| <= half_width x / length."""

    length: float
    half_width: float

    def __post_init__(self) -> None:
        for what, value in (("length", self.length), ("half width", self.half_width)):
            if not (math.isfinite(value) and value > 0.0):
                raise ValueRangeError(f"the {what} of a view triangle", value, "a positive number of metres")

    @property
    def limits(self) -> ConeLimits:
        """What bounds it."""
        return ConeLimits(0.0, math.inf, self.length, self.length, self.half_width)


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

    @property
    def limits(self) -> ConeLimits:
        """What bounds it: sin(angle - h) <= 0 with h half the field of view, so any h up to a half turn will do."""
        half = 0.5 * self.field_of_view
        along = math.sin(half) if half < math.pi else 0.0
        return ConeLimits(self.near, self.far, math.inf, math.cos(half), along)
