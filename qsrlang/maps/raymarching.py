"""Lines of sight through a voxel grid in plain numpy: all rays step at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid


def clear_rays_plainly(grid: VoxelGrid, starts_map: npt.ArrayLike, ends_map: npt.ArrayLike) -> BoolArray:
    """Return what `occlusion.clear_rays` returns, voxel by voxel (Amanatides and Woo 1987): (R,)."""
    scale = 1.0 / grid.resolution
    starts = (frozen_array("the starts of rays", starts_map, (None, 3)) - grid.origin) * scale
    ends = (frozen_array("the ends of rays", ends_map, (len(starts), 3)) - grid.origin) * scale
    step, sides = ends - starts, np.array(grid.voxels.shape)
    first, last = _part_inside(starts, step, sides)
    clear = np.ones(len(starts), dtype=np.bool_)
    going = np.flatnonzero(first <= last)
    cell = _cells(starts, step, first, sides)
    left = _cells(starts, step, last, sides) - cell
    sign = np.where(left > 0, 1, -1)
    with np.errstate(divide="ignore", invalid="ignore"):
        border = np.where(left != 0, ((cell + (step > 0.0)) - starts) / step, np.inf)
        wait = np.where(left != 0, 1.0 / np.abs(step), np.inf)
    left, goal = np.abs(left), np.floor(ends).astype(np.int64)
    while len(going):
        there = (cell[going] == goal[going]).all(axis=1)
        blocked = ~there & (grid.voxels[tuple(cell[going].T)] == Cell.OCCUPIED)
        clear[going[blocked]] = False
        going = going[~there & ~blocked & (left[going].sum(axis=1) > 0)]
        axis = border[going].argmin(axis=1)
        cell[going, axis] += sign[going, axis]
        left[going, axis] -= 1
        onward = left[going, axis] > 0
        border[going, axis] = np.where(onward, border[going, axis] + wait[going, axis], np.inf)
    return clear


def _part_inside(
    starts: FloatArray, step: FloatArray, sides: npt.NDArray[np.int64]
) -> tuple[FloatArray, FloatArray]:
    with np.errstate(divide="ignore", invalid="ignore"):
        enter, leave = -starts / step, (sides - starts) / step
    still, within = step == 0.0, (starts >= 0.0) & (starts < sides)
    low = np.where(still, np.where(within, 0.0, 1.0), np.minimum(enter, leave))
    high = np.where(still, np.where(within, 1.0, 0.0), np.maximum(enter, leave))
    return np.maximum(low.max(axis=1), 0.0), np.minimum(high.min(axis=1), 1.0)


def _cells(
    starts: FloatArray, step: FloatArray, at: FloatArray, sides: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64]:
    return np.clip(np.floor(starts + at[:, None] * step).astype(np.int64), 0, sides - 1)
