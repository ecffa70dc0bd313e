"""What hides what: lines of sight through a voxel grid."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import BoolArray, frozen_array
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.stepping import axis, clip
from qsrlang.maps.voxels import VoxelGrid

_OCCUPIED = int(Cell.OCCUPIED)


def clear_rays(grid: VoxelGrid, starts_map: npt.ArrayLike, ends_map: npt.ArrayLike) -> BoolArray:
    """Return which rays from starts (R, 3) to ends (R, 3) [m] meet no occupied voxel before the one they end in: (R,).

    What lies outside the grid, or is unknown, hides nothing.
    """
    starts = frozen_array("the starts of rays", starts_map, (None, 3))
    ends = frozen_array("the ends of rays", ends_map, (len(starts), 3))
    clear = np.empty(len(starts), dtype=np.bool_)
    scale = 1.0 / grid.resolution
    _look(grid.voxels, (starts - grid.origin) * scale, (ends - grid.origin) * scale, clear)
    return clear


@njit(cache=True, nogil=True)
def _look(voxels, starts, ends, clear):  # type: ignore[no-untyped-def]
    for n in range(len(starts)):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        clear[n] = is_clear(voxels, x, y, z, ends[n, 0] - x, ends[n, 1] - y, ends[n, 2] - z)


@njit(cache=True)
def is_clear(voxels, x, y, z, dx, dy, dz):  # type: ignore[no-untyped-def]
    """Return whether no occupied voxel lies between (x, y, z) and (x + dx, y + dy, z + dz), in voxels, but the last."""
    nx, ny, nz = voxels.shape
    first, last = clip(x, dx, nx, 0.0, 1.0)
    first, last = clip(y, dy, ny, first, last)
    first, last = clip(z, dz, nz, first, last)
    if first > last:
        return True
    i, left_i, next_i, wait_i = axis(x, dx, nx, first, last)
    j, left_j, next_j, wait_j = axis(y, dy, ny, first, last)
    k, left_k, next_k, wait_k = axis(z, dz, nz, first, last)
    goal_i, goal_j, goal_k = math.floor(x + dx), math.floor(y + dy), math.floor(z + dz)
    arrives = i + left_i == goal_i and j + left_j == goal_j and k + left_k == goal_k
    step_i, step_j, step_k = (
        ny * nz if left_i > 0 else -ny * nz,
        nz if left_j > 0 else -nz,
        1 if left_k > 0 else -1,
    )
    left_i, left_j, left_k = abs(left_i), abs(left_j), abs(left_k)
    cells, here = voxels.ravel(), (i * ny + j) * nz + k
    for _ in range(left_i + left_j + left_k):
        if cells[here] == _OCCUPIED:
            return False
        if next_i <= next_j and next_i <= next_k:
            here += step_i
            left_i -= 1
            next_i = next_i + wait_i if left_i > 0 else math.inf
        elif next_j <= next_k:
            here += step_j
            left_j -= 1
            next_j = next_j + wait_j if left_j > 0 else math.inf
        else:
            here += step_k
            left_k -= 1
            next_k = next_k + wait_k if left_k > 0 else math.inf
    return arrives or cells[here] != _OCCUPIED
