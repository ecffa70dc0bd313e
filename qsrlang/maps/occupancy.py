"""Occupancy grids in the plane."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2

_FAR = 1e15


class Cell(IntEnum):
    """What is known of a cell or a voxel."""

    UNKNOWN = 0
    FREE = 1
    OCCUPIED = 2


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """A grid of cells (H, W): rows along the grid's y, columns along its x; `origin` is the corner of [0, 0].

    `source` names the file or room the grid came from, for messages.
    """

    cells: npt.NDArray[np.uint8]
    resolution: float
    origin: Pose2
    source: str

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "cells", frozen_array("the cells of a grid", self.cells, (None, None), np.uint8)
        )
        if not 0.0 < self.resolution < np.inf:
            raise ValueRangeError("the resolution of a grid", self.resolution, "a positive number of metres")

    @property
    def free(self) -> BoolArray:
        """Which cells are free (H, W)."""
        return np.asarray(self.cells == Cell.FREE)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The box (x_min, y_min, x_max, y_max) around the grid in the map frame [m]."""
        height, width = self.cells.shape
        corners = np.array([[0, 0], [width, 0], [0, height], [width, height]]) * self.resolution
        corners_map = self.origin.transform(corners)
        (x0, y0), (x1, y1) = corners_map.min(axis=0), corners_map.max(axis=0)
        return float(x0), float(y0), float(x1), float(y1)

    def cells_of(self, points_map: npt.ArrayLike) -> IntArray:
        """Return (row, column) of the cells (..., 2) that hold points (..., 2); may lie outside the grid."""
        inside = self.origin.transform_inverse(points_map) / self.resolution
        return np.asarray(np.floor(inside[..., ::-1].clip(-_FAR, _FAR)), dtype=np.int64)

    def centres_of(self, cells: npt.ArrayLike) -> FloatArray:
        """Return the centres (..., 2) in the map frame of cells (..., 2) given as (row, column)."""
        steps = np.asarray(cells, dtype=np.float64)[..., ::-1] + 0.5
        return self.origin.transform(steps * self.resolution)

    def covers(self, points_map: npt.ArrayLike) -> BoolArray:
        """Return which points (..., 2) lie on the grid: (...,)."""
        cells = self.cells_of(points_map)
        return np.asarray(((cells >= 0) & (cells < np.array(self.cells.shape))).all(axis=-1))
