"""Convex polygons: the outlines of supports and the boxes of objects, seen from above."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.pose import Pose2


@dataclass(frozen=True, slots=True, eq=False)
class ConvexPolygon:
    """A convex polygon by its corners (K, 2) [m], counter-clockwise; `normals` (K, 2) point inwards, one per edge."""

    corners: FloatArray
    normals: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        corners = frozen_array("the corners of a polygon", self.corners, (None, 2))
        object.__setattr__(self, "corners", corners)
        edges = np.roll(corners, -1, axis=0) - corners
        following = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0]
        if len(corners) < 3 or not (turns >= 0.0).all() or not (turns > 0.0).any():
            raise ValueRangeError(
                "a polygon", corners.tolist(), "at least 3 corners, convex, counter-clockwise"
            )
        inward = np.stack([-edges[:, 1], edges[:, 0]], axis=-1)
        normals = inward / np.linalg.norm(inward, axis=-1, keepdims=True)
        object.__setattr__(self, "normals", frozen_array("the normals of a polygon", normals, (None, 2)))

    @classmethod
    def rectangle(cls, pose: Pose2, length: float, width: float) -> ConvexPolygon:
        """Return the rectangle centred at `pose`: `length` along its x, `width` along its y [m]."""
        half = 0.5 * np.array([[-length, -width], [length, -width], [length, width], [-length, width]])
        return cls(pose.transform(half))

    def signed_distances(self, points: npt.ArrayLike) -> FloatArray:
        """Return the distance of points (..., 2) to each edge's line, positive inside: (..., K) [m]."""
        points = np.asarray(points, dtype=np.float64)
        return np.asarray(points @ self.normals.T - np.einsum("kd,kd->k", self.normals, self.corners))

    def contains(self, points: npt.ArrayLike) -> BoolArray:
        """Return which points (..., 2) lie inside or on the border: (...,)."""
        return np.asarray((self.signed_distances(points) >= 0.0).all(axis=-1))

    def ray_lengths(
        self, origins: npt.ArrayLike, directions: npt.ArrayLike, margins: npt.ArrayLike = 0.0
    ) -> FloatArray:
        """Return how far each ray from inside runs to the border: (...,) [m].

        Origins and unit directions broadcast over (..., 2). `margins` (..., K) moves each edge inwards.
        A ray that starts outside the (moved) border gets a negative length or 0.
        """
        slack = self.signed_distances(origins) - np.asarray(margins, dtype=np.float64)
        x, y = np.moveaxis(np.asarray(directions, dtype=np.float64), -1, 0)
        shortest = np.full(np.broadcast_shapes(slack.shape[:-1], x.shape), np.inf)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            for edge, (across, along) in enumerate(self.normals):
                speed = -(x * across + y * along)
                np.minimum(shortest, np.where(speed > 0.0, slack[..., edge] / speed, np.inf), out=shortest)
        return shortest

    def box_reach(self, box_yaw: npt.ArrayLike, half_length: float, half_width: float) -> FloatArray:
        """Return how far boxes turned by `box_yaw` (...) reach from their centres to each edge: (..., K) [m]."""
        yaw = np.asarray(box_yaw, dtype=np.float64)
        along = np.abs(unit(yaw) @ self.normals.T)
        across = np.abs(unit(yaw + 0.5 * np.pi) @ self.normals.T)
        return np.asarray(half_length * along + half_width * across)

    def nearest(self, points: npt.ArrayLike) -> FloatArray:
        """Return the point of the polygon nearest to each point (..., 2): the point itself where it is inside."""
        points = np.asarray(points, dtype=np.float64)
        outside = ~self.contains(points)
        nearest = np.array(points)
        nearest[outside] = self._feet(points[outside])
        return nearest

    def _feet(self, points: FloatArray) -> FloatArray:
        """Return the point of the border nearest to each point (P, 2): (P, 2)."""
        edges = np.roll(self.corners, -1, axis=0) - self.corners
        along = np.einsum("pkd,kd->pk", points[:, None] - self.corners, edges)
        share = np.clip(along / np.einsum("kd,kd->k", edges, edges), 0.0, 1.0)
        feet = self.corners + share[..., None] * edges
        nearest = np.linalg.norm(feet - points[:, None], axis=-1).argmin(axis=-1)
        return np.asarray(feet[np.arange(len(points)), nearest])
