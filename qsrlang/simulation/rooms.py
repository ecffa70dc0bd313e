"""Rooms as values: things made of boxes and cylinders, with names, classes, poses and colours."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.geometry.angles import rotation
from qsrlang.geometry.pose import Pose2

MAX_PARTS = 16
Colour = tuple[float, float, float]


class Shape(StrEnum):
    """What a part of a thing is."""

    BOX = "box"
    CYLINDER = "cylinder"


@dataclass(frozen=True, slots=True)
class Part:
    """A box or an upright cylinder: size (x, y, z) [m], and the middle of its underside in its thing."""

    shape: Shape
    size: tuple[float, float, float]
    at: tuple[float, float, float]
    colour: Colour

    def __post_init__(self) -> None:
        if not all(0.0 < side < math.inf for side in self.size):
            raise ValueRangeError(f"the size of a {self.shape}", self.size, "positive numbers of metres")
        if self.shape is Shape.CYLINDER and self.size[0] != self.size[1]:
            raise ValueRangeError("the size of a cylinder", self.size, "as wide as it is deep")

    @property
    def centre(self) -> FloatArray:
        """The centre (3,) in the frame of the thing [m]."""
        x, y, z = self.at
        return np.array([x, y, z + 0.5 * self.size[2]])

    @property
    def volume(self) -> float:
        """The volume [m^3]."""
        box = math.prod(self.size)
        return box if self.shape is Shape.BOX else box * math.pi / 4


@dataclass(frozen=True, slots=True)
class Thing:
    """A thing in a room: its front looks along +x of `pose`, its underside is at `z` [m]; mass 0 is static.

    A camera that recognises it aims at the centre of its first part. It has at most MAX_PARTS parts.
    """

    name: str
    kind: str
    pose: Pose2
    z: float
    parts: tuple[Part, ...]
    mass: float = 0.0
    recognised: bool = False

    def __post_init__(self) -> None:
        if not 1 <= len(self.parts) <= MAX_PARTS:
            raise ValueRangeError(f"the number of parts of {self.name}", len(self.parts), f"1 to {MAX_PARTS}")

    @property
    def movable(self) -> bool:
        """Whether physics moves the thing."""
        return self.mass > 0.0

    @property
    def position(self) -> FloatArray:
        """The middle of its underside (3,), map frame [m]."""
        return np.array([self.pose.x, self.pose.y, self.z])

    @property
    def box(self) -> FloatArray:
        """The box (2, 3) around its parts, lowest and highest corner, in the frame of the thing [m]."""
        return box_around(self.parts)

    @property
    def centroid(self) -> FloatArray:
        """The centre of its volume (3,), in the frame of the thing [m]."""
        return centroid_of(self.parts)

    @property
    def top(self) -> float:
        """The height of its highest point, map frame [m]."""
        return self.z + float(self.box[1, 2])

    @property
    def size(self) -> FloatArray:
        """The size (3,) of its box: depth along its front, width, height [m]."""
        return np.asarray(self.box[1] - self.box[0])


@dataclass(frozen=True, slots=True)
class Room:
    """A furnished room: bounds (x_min, y_min, x_max, y_max) of its floor at z = 0 [m], and its things."""

    name: str
    bounds: tuple[float, float, float, float]
    start: Pose2
    things: tuple[Thing, ...]

    def named(self, name: str) -> Thing:
        """Return the thing of this name; raises UnknownNameError with the names there are."""
        for thing in self.things:
            if thing.name == name:
                return thing
        raise UnknownNameError(
            f"thing in the room '{self.name}'", name, (thing.name for thing in self.things)
        )

    def of_kind(self, kind: str) -> tuple[Thing, ...]:
        """Return the things of this class, in the order of the room."""
        return tuple(thing for thing in self.things if thing.kind == kind)

    @property
    def static_part(self) -> Room:
        """The room without its movable things: what a robot maps."""
        return replace(self, things=tuple(thing for thing in self.things if not thing.movable))


def box_around(parts: Sequence[Part]) -> FloatArray:
    """Return the box (2, 3) around parts, lowest and highest corner, in their frame [m]."""
    centres, halves = np.array([part.centre for part in parts]), 0.5 * np.array([part.size for part in parts])
    return np.stack([(centres - halves).min(axis=0), (centres + halves).max(axis=0)])


def centroid_of(parts: Sequence[Part]) -> FloatArray:
    """Return the centre of volume (3,) of parts, in their frame [m]."""
    volumes = np.array([part.volume for part in parts])
    return np.asarray(volumes @ np.array([part.centre for part in parts]) / volumes.sum())


def turned(yaw: float) -> FloatArray:
    """Return the rotation (3, 3) about the vertical by `yaw` [rad]."""
    matrix = np.eye(3)
    matrix[:2, :2] = rotation(yaw)
    return matrix
