"""What hides what: lines of sight through a voxel grid."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import BoolArray, frozen_array
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.stepping import clip_all, enter, onward
from qsrlang.maps.voxels import VoxelGrid

_OCCUPIED = int(Cell.OCCUPIED)
BLOCK = 4
"""Voxels along the side of a block; a power of two, so that voxels lie in the same blocks in all arithmetic."""
_SLACK = 1e-12


def clear_rays(grid: VoxelGrid, starts_map: npt.ArrayLike, ends_map: npt.ArrayLike) -> BoolArray:
    """Return which rays from starts (R, 3) to ends (R, 3) [m] meet no occupied voxel before the one they end in: (R,).

    What lies outside the grid, or is unknown, hides nothing. Rays pass from block to block of BLOCK^3 voxels, and voxel
    by voxel through those alone that hold something.
    """
    starts = frozen_array("the starts of rays", starts_map, (None, 3))
    ends = frozen_array("the ends of rays", ends_map, (len(starts), 3))
    clear = np.empty(len(starts), dtype=np.bool_)
    scale = 1.0 / grid.resolution
    first, last = (starts - grid.origin) * scale, (ends - grid.origin) * scale
    _look(grid.voxels, occupied_blocks(grid), first, last, clear)
    return clear


@lru_cache(maxsize=8)
def occupied_blocks(grid: VoxelGrid) -> BoolArray:
    """Return which blocks of BLOCK^3 voxels hold an occupied one."""
    missing = [(0, -size % BLOCK) for size in grid.voxels.shape]
    occupied = np.pad(grid.voxels == _OCCUPIED, missing)
    nx, ny, nz = (size // BLOCK for size in occupied.shape)
    blocks = occupied.reshape(nx, BLOCK, ny, BLOCK, nz, BLOCK).any(axis=(1, 3, 5))
    blocks.setflags(write=False)
    return np.asarray(blocks)


@njit(cache=True, nogil=True)
def _look(voxels, blocks, starts, ends, clear):  # type: ignore[no-untyped-def]
    for n in range(len(starts)):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        clear[n] = is_clear(voxels, blocks, x, y, z, ends[n, 0] - x, ends[n, 1] - y, ends[n, 2] - z)


@njit(cache=True)
def is_clear(voxels, blocks, x, y, z, dx, dy, dz):  # type: ignore[no-untyped-def]
    """Return whether no occupied voxel lies between (x, y, z) and (x + dx, y + dy, z + dz), in voxels, but the last."""
    nx, ny, nz = voxels.shape
    first, last = clip_all(x, y, z, dx, dy, dz, voxels.shape, 1.0)
    if first > last:
        return True
    i, j, k = math.floor(x + dx), math.floor(y + dy), math.floor(z + dz)
    goal = (i * ny + j) * nz + k if 0 <= i < nx and 0 <= j < ny and 0 <= k < nz else -1
    start, way = (x / BLOCK, y / BLOCK, z / BLOCK), (dx / BLOCK, dy / BLOCK, dz / BLOCK)
    here, count, steps, waits, left, borders = enter(*start, *way, blocks.shape, first, last)
    flat, since = blocks.ravel(), first
    for _ in range(count):
        until = min(borders)
        if flat[here] and not _is_free(voxels, x, y, z, dx, dy, dz, since - _SLACK, until + _SLACK, goal):
            return False
        since = until
        here, left, borders = onward(here, steps, waits, left, borders)
    return not flat[here] or _is_free(voxels, x, y, z, dx, dy, dz, since - _SLACK, last, goal)


@njit(cache=True)
def _is_free(voxels, x, y, z, dx, dy, dz, first, last, goal):  # type: ignore[no-untyped-def]
    """Return whether no voxel on the part [first, last] of a way is occupied but that of number `goal`."""
    first, last = max(first, 0.0), min(last, 1.0)
    here, count, steps, waits, left, borders = enter(x, y, z, dx, dy, dz, voxels.shape, first, last)
    flat = voxels.ravel()
    for _ in range(count):
        if flat[here] == _OCCUPIED:
            return here == goal
        here, left, borders = onward(here, steps, waits, left, borders)
    return flat[here] != _OCCUPIED or here == goal
