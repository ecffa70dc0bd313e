"""Where the centre of a robot may be: inflation, reachability, random poses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import ndimage

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import BlockedPoseError, NoNavigablePoseError, OutsideMapError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.spreading import MoveArray, open_moves
from qsrlang.maps.voxels import VoxelGrid

_TOUCH = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class NavigationGrid:
    """The cells (H, W) of `grid` on which the centre of a robot that keeps `clearance` [m] may be.

    `moves` (H W,) holds for each flat cell the steps to navigable neighbours, made once for all paths.
    """

    grid: OccupancyGrid
    clearance: float
    navigable: BoolArray
    moves: MoveArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        navigable = frozen_array("the navigable cells", self.navigable, self.grid.cells.shape, np.bool_)
        object.__setattr__(self, "navigable", navigable)
        moves = frozen_array("the moves of cells", open_moves(navigable), (navigable.size,), np.uint8)
        object.__setattr__(self, "moves", moves)
        if not 0.0 <= self.clearance < math.inf:
            raise ValueRangeError("the clearance of a robot", self.clearance, "at least 0 m")

    @classmethod
    def from_occupancy(cls, grid: OccupancyGrid, clearance: float) -> NavigationGrid:
        """Return the cells whose centre is farther than `clearance` [m] from the centre of any cell not free.

        Unknown cells and all that lies outside the map count as obstacles.
        Raises ValueRangeError for a negative clearance and NoNavigablePoseError where no cell is left.
        """
        if not 0.0 <= clearance < math.inf:
            raise ValueRangeError("the clearance of a robot", clearance, "at least 0 m")
        free = np.pad(grid.free, 1, constant_values=False)
        distance = ndimage.distance_transform_edt(free)[1:-1, 1:-1] * grid.resolution
        navigable = distance > clearance + _TOUCH
        if not navigable.any():
            raise NoNavigablePoseError(grid.source, clearance)
        return cls(grid, clearance, navigable)

    def is_navigable(self, points_map: FloatArray) -> BoolArray:
        """Return for points (..., 2) in the map frame whether the robot's centre may be there: (...,)."""
        points = np.asarray(points_map, dtype=np.float64)
        rows, columns = np.moveaxis(self.grid.cells_of(points), -1, 0)
        height, width = self.navigable.shape
        on_grid = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        return np.asarray(on_grid & self.navigable[rows.clip(0, height - 1), columns.clip(0, width - 1)])

    def cell_of(self, point_map: Sequence[float] | FloatArray, what: str = "a pose") -> tuple[int, int]:
        """Return (row, column) of a point (x, y) where the robot may be; `what` names the point in messages.

        Raises OutsideMapError or BlockedPoseError where it may not.
        """
        point = (float(point_map[0]), float(point_map[1]))
        if not (math.isfinite(point[0]) and math.isfinite(point[1])):
            raise ValueRangeError(what, point, "finite numbers")
        row, column = (int(index) for index in self.grid.cells_of(point))
        if not (0 <= row < self.navigable.shape[0] and 0 <= column < self.navigable.shape[1]):
            raise OutsideMapError(what, point, self.grid.bounds, self.grid.source)
        if not self.navigable[row, column]:
            raise BlockedPoseError(
                what, point, self.clearance, self.grid.source, self.nearest_navigable(point)
            )
        return row, column

    def nearest_navigable(self, point_map: Sequence[float] | FloatArray) -> tuple[float, float]:
        """Return the centre (x, y) of the navigable cell nearest to a point [m].

        Raises NoNavigablePoseError where no cell is navigable.
        """
        centres = self.grid.centres_of(self._cells())
        if len(centres) == 0:
            raise NoNavigablePoseError(self.grid.source, self.clearance)
        offsets = centres - np.asarray(point_map, dtype=np.float64)[:2]
        x, y = centres[np.argmin(np.einsum("ij,ij->i", offsets, offsets))]
        return float(x), float(y)

    def reachable_from(self, pose: Pose2, what: str = "the robot's start") -> NavigationGrid:
        """Return only the cells that a robot which never cuts corners reaches from `pose`.

        Raises OutsideMapError or BlockedPoseError where the robot cannot stand at `pose`.
        """
        cell = self.cell_of((pose.x, pose.y), what)
        parts, _ = ndimage.label(self.navigable)
        return NavigationGrid(self.grid, self.clearance, parts == parts[cell])

    def closed_at(self, point_map: FloatArray, radius: float, from_map: FloatArray) -> NavigationGrid:
        """Return the cells that are left when those within `radius` [m] of a point (2,) are closed.

        Only what is connected to the cell nearest to `from_map` (2,) counts. Raises NoNavigablePoseError where
        nothing is left.
        """
        rows, columns = self._cells().T
        offsets = self.grid.centres_of(np.column_stack([rows, columns])) - np.asarray(point_map)
        shut = np.einsum("nd,nd->n", offsets, offsets) <= radius * radius
        navigable = self.navigable.copy()
        navigable[rows[shut], columns[shut]] = False
        if not navigable.any():
            raise NoNavigablePoseError(self.grid.source, self.clearance)
        left = NavigationGrid(self.grid, self.clearance, navigable)
        x, y = left.nearest_navigable(from_map)
        return left.reachable_from(Pose2(x, y))

    def sample_poses(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Return random poses (count, 3) of x, y [m] and yaw [rad]: uniform cell, place in the cell and yaw.

        Raises NoNavigablePoseError where no cell is navigable.
        """
        cells = self._cells()
        if len(cells) == 0:
            raise NoNavigablePoseError(self.grid.source, self.clearance)
        chosen = cells[rng.integers(len(cells), size=count)]
        places = self.grid.centres_of(chosen + rng.random((count, 2)) - 0.5)
        return np.column_stack([places, rng.uniform(-np.pi, np.pi, size=count)])

    def _cells(self) -> IntArray:
        return np.argwhere(self.navigable)


def occupancy_from_voxels(
    voxels: VoxelGrid, floor_z: float, band: tuple[float, float] = (0.1, 1.8), source: str | None = None
) -> OccupancyGrid:
    """Return the plane map of a voxel map whose floor is at `floor_z` [m, map frame].

    A cell is occupied where a voxel with its centre `band` = (low, high) [m] above the floor is, else free
    where one of those was seen free or the floor itself (`floor_z` within a voxel) was, else unknown.
    Raises ValueRangeError where no voxel layer lies in the band.
    """
    low, high = band
    heights = voxels.origin[2] + (np.arange(voxels.voxels.shape[2]) + 0.5) * voxels.resolution - floor_z
    in_band = (heights >= low) & (heights <= high)
    if not in_band.any():
        top = heights[-1] if len(heights) else 0.0
        raise ValueRangeError(
            "the height band", band, f"a band that meets the map, which ends {top:.2f} m up"
        )
    floor = np.abs(heights) <= voxels.resolution
    body = voxels.voxels[:, :, in_band]
    seen = (body == Cell.FREE).any(axis=2) | (voxels.voxels[:, :, floor] != Cell.UNKNOWN).any(axis=2)
    cells = np.where(seen, Cell.FREE, Cell.UNKNOWN).astype(np.uint8)
    cells[(body == Cell.OCCUPIED).any(axis=2)] = Cell.OCCUPIED
    corner = Pose2(float(voxels.origin[0]), float(voxels.origin[1]))
    return OccupancyGrid(cells.T, voxels.resolution, corner, source or voxels.source)
