"""Shortest paths over navigable cells, and what driving them costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import wrap
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.spreading import ParentArray, spread
from qsrlang.maps.tracing import trace_lengths, trace_path


@dataclass(frozen=True, slots=True, eq=False)
class DistanceField:
    """Shortest paths from one start: `parents` (H W,) holds the flat parent of each flat cell, -1 where none.

    Paths are any-angle (Lazy Theta*, Nash et al. 2010, then pulled straight): their corners are cell centres,
    they never cut corners, and they are never longer than the shortest 8-connected path between the ends.
    """

    navigation: NavigationGrid
    start: FloatArray
    parents: ParentArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", frozen_array("the start of a path", self.start, (2,)))
        parents = frozen_array(
            "the parents of cells", self.parents, (self.navigation.navigable.size,), np.int32
        )
        object.__setattr__(self, "parents", parents)

    @classmethod
    def from_start(cls, navigation: NavigationGrid, start_xy: npt.ArrayLike) -> DistanceField:
        """Return the paths from a start (x, y) [m].

        Raises OutsideMapError or BlockedPoseError where the start is not navigable.
        """
        start = np.asarray(start_xy, dtype=np.float64)[:2]
        cell = _flat(navigation, start, "the start of a path")
        return cls(navigation, start, spread(navigation.navigable, navigation.moves, cell)[1])

    def lengths_to(self, points_map: npt.ArrayLike) -> FloatArray:
        """Return the lengths (N,) [m] of the paths to points (N, 2), infinite where there is no way."""
        points = frozen_array("the goals of paths", points_map, (None, 2))
        lengths = np.full(len(points), np.inf)
        reached, start, goals = self.in_cells(points)
        steps = trace_lengths(self.navigation.navigable, self.parents, start, goals)
        lengths[reached] = steps * self.navigation.grid.resolution
        return lengths

    def in_cells(self, points_map: FloatArray) -> tuple[BoolArray, FloatArray, FloatArray]:
        """Return which points (N, 2) have a way to them, and in cells the start (2,) and those points (R, 2)."""
        reached = self._reached(points_map)
        return reached, self._steps(self.start[None])[0], self._steps(points_map[reached])

    def path_to(self, point_map: npt.ArrayLike) -> FloatArray:
        """Return the corners (K, 2) [m] of the path to a point (x, y), the exact start first, the point last.

        Raises OutsideMapError or BlockedPoseError where the point is not navigable, and ValueRangeError where
        it is cut off from the start.
        """
        point = np.asarray(point_map, dtype=np.float64)[:2]
        self.navigation.cell_of(point, "the end of a path")
        if not self._reached(point[None])[0]:
            place = f"({point[0]:.2f} m, {point[1]:.2f} m)"
            raise ValueRangeError("the end of a path", place, "a place that can be reached from its start")
        start, goal = self._steps(np.stack([self.start, point]))
        steps = trace_path(self.navigation.navigable, self.parents, start, goal)
        corners = self.navigation.grid.origin.transform(steps * self.navigation.grid.resolution)
        corners[0], corners[-1] = self.start, point
        return corners

    def _steps(self, points_map: FloatArray) -> FloatArray:
        # Points on the grid in cells, none rounded over the border of its cell or of the grid. To a billionth of a
        # cell, so that among equally short paths the same one is found wherever the grid lies.
        grid = self.navigation.grid
        cells = np.clip(grid.cells_of(points_map), 0, np.array(grid.cells.shape) - 1)[:, ::-1]
        steps = np.round(grid.origin.transform_inverse(points_map) / grid.resolution, 9)
        return np.clip(steps, cells, np.nextafter(cells + 1.0, cells))

    def _reached(self, points_map: FloatArray) -> BoolArray:
        reached = self.navigation.is_navigable(points_map)
        rows, columns = self.navigation.grid.cells_of(points_map[reached]).T
        reached[reached] = self.parents[rows * self.navigation.navigable.shape[1] + columns] >= 0
        return reached


def shortest_path(navigation: NavigationGrid, start_xy: npt.ArrayLike, end_xy: npt.ArrayLike) -> FloatArray:
    """Return the corners (K, 2) [m] of the path from start to end, both (x, y), by one search.

    Raises what `DistanceField.path_to` raises.
    """
    start, end = (np.asarray(point, dtype=np.float64)[:2] for point in (start_xy, end_xy))
    begin, goal = _flat(navigation, start, "the start of a path"), _flat(navigation, end, "the end of a path")
    parents = spread(navigation.navigable, navigation.moves, begin, goal)[1]
    return DistanceField(navigation, start, parents).path_to(end)


def path_length(path: npt.ArrayLike) -> float:
    """Return the length of a polyline (K, 2) [m]; 0 for fewer than two points."""
    points = np.asarray(path, dtype=np.float64).reshape(-1, 2)
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def turn_angles(path: npt.ArrayLike, start_yaw: float, end_yaw: float) -> FloatArray:
    """Return the signed turns [rad, in (-pi, pi]] of a robot that drives the legs of a polyline (K, 2).

    The first turns from `start_yaw` into the first leg, the last from the last leg to `end_yaw`; legs of no
    length count for nothing. The total turning is the sum of the absolute values.
    """
    legs = np.diff(np.asarray(path, dtype=np.float64).reshape(-1, 2), axis=0)
    legs = legs[np.hypot(legs[:, 0], legs[:, 1]) > 0.0]
    headings = np.concatenate([[start_yaw], np.arctan2(legs[:, 1], legs[:, 0]), [end_yaw]])
    return wrap(np.diff(headings))


def _flat(navigation: NavigationGrid, point_map: FloatArray, what: str) -> int:
    row, column = navigation.cell_of(point_map, what)
    return row * int(navigation.navigable.shape[1]) + column
