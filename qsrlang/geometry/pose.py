"""Poses in the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import rotation, wrap


@dataclass(frozen=True, slots=True)
class Pose2:
    """A pose in the plane: x, y [m] and heading yaw [rad], kept in (-pi, pi]."""

    x: float
    y: float
    yaw: float = 0.0

    def __post_init__(self) -> None:
        if not all(math.isfinite(value) for value in (self.x, self.y, self.yaw)):
            raise ValueRangeError("a pose", (self.x, self.y, self.yaw), "finite numbers")
        object.__setattr__(self, "yaw", float(wrap(self.yaw)))

    @property
    def position(self) -> FloatArray:
        """The position (2,) [m]."""
        return np.array([self.x, self.y])

    def __matmul__(self, other: Pose2) -> Pose2:
        """Compose: `a @ b` is the pose b, given in the frame of a, in the frame a is given in."""
        x, y = self.transform(other.position)
        return Pose2(float(x), float(y), self.yaw + other.yaw)

    def inverse(self) -> Pose2:
        """Return the pose p^-1 with p @ p^-1 = identity."""
        x, y = -rotation(-self.yaw) @ self.position
        return Pose2(float(x), float(y), -self.yaw)

    def transform(self, points: npt.ArrayLike) -> FloatArray:
        """Return points (..., 2), given in this pose's frame, in the frame the pose is given in."""
        return np.asarray(np.asarray(points, dtype=np.float64) @ rotation(self.yaw).T + self.position)

    def transform_inverse(self, points: npt.ArrayLike) -> FloatArray:
        """Return points (..., 2), given in the outer frame, in this pose's frame."""
        return np.asarray((np.asarray(points, dtype=np.float64) - self.position) @ rotation(self.yaw))
