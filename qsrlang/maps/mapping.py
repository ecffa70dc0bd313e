"""Builds voxel maps from clouds of depth points: log-odds occupancy with full rays."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.stepping import clip_all, enter, onward
from qsrlang.maps.voxels import VoxelGrid

LOG_ODDS_HIT, LOG_ODDS_MISS = 0.85, -0.4
LOG_ODDS_MIN, LOG_ODDS_MAX = -2.0, 3.5
MAX_MAPPED_VOXELS = 200_000_000
_PASSED, _HIT = 1, 2


class VoxelMapper:
    """A voxel map that grows cloud by cloud (Hornung et al. 2013, equations 2 and 4, OctoMap's constants).

    L(v) <- clip(L(v) + l, -2, 3.5) with l = 0.85 where a point of the cloud ends in v, else -0.4 where a ray
    passes v; each voxel is updated once a cloud, and a hit outweighs all passing rays. Of the points that end
    in one voxel the first stands for all (OctoMap's discretisation). A voxel is occupied where L >= 0, free
    where L < 0 and unknown where no ray ever came.
    """

    def __init__(self, origin: npt.ArrayLike, shape: tuple[int, int, int], resolution: float) -> None:
        """Cover `shape` (X, Y, Z) voxels of `resolution` [m] from the corner `origin` (3,), map frame [m].

        Surfaces that lie exactly on voxel borders fall to either side: shift the origin by half a voxel.
        Raises ValueRangeError for a resolution, shape or origin that makes no sense.
        """
        if not 0.0 < resolution < math.inf:
            raise ValueRangeError("the resolution of a voxel map", resolution, "a positive number of metres")
        if min(shape) < 1 or math.prod(shape) > MAX_MAPPED_VOXELS:
            raise ValueRangeError("the shape of a voxel map", shape, f"1 to {MAX_MAPPED_VOXELS:,} voxels")
        self._origin = frozen_array("the origin of a voxel map", origin, (3,))
        self._resolution = float(resolution)
        self._log_odds = np.full(shape, np.nan, dtype=np.float32)
        self._marks = np.zeros(shape, dtype=np.uint8)

    def insert(
        self, sensor_origin_map: npt.ArrayLike, points_map: npt.ArrayLike, max_range: float = math.inf
    ) -> None:
        """Integrate one cloud (N, 3) seen from `sensor_origin_map` (3,), map frame [m].

        A ray longer than `max_range` [m] hit nothing: it frees space up to `max_range` and marks no hit, so a
        pixel without depth is given as any point beyond `max_range`. Parts outside the map are left out.
        Raises ValueRangeError where a point is not finite or `max_range` is not positive.
        """
        if not max_range > 0.0:
            raise ValueRangeError("the largest range of a cloud", max_range, "a positive number of metres")
        sensor = frozen_array("the origin of a sensor", sensor_origin_map, (3,))
        points = frozen_array("the points of a cloud", points_map, (None, 3))
        start = (sensor - self._origin) / self._resolution
        ends = (points - self._origin) / self._resolution
        _mark(self._marks, start, ends, max_range / self._resolution)
        _update(self._log_odds, self._marks, LOG_ODDS_HIT, LOG_ODDS_MISS, LOG_ODDS_MIN, LOG_ODDS_MAX)

    def grid(self, source: str) -> VoxelGrid:
        """Return what is known now; `source` names the map in messages."""
        voxels = np.zeros(self._log_odds.shape, dtype=np.uint8)
        voxels[self._log_odds < 0.0] = Cell.FREE
        voxels[self._log_odds >= 0.0] = Cell.OCCUPIED
        return VoxelGrid(voxels, self._resolution, self._origin, source)


@njit(cache=True)
def _mark(marks, start, ends, reach):  # type: ignore[no-untyped-def]
    nx, ny, nz = marks.shape
    for n in range(len(ends)):
        dx, dy, dz = ends[n, 0] - start[0], ends[n, 1] - start[1], ends[n, 2] - start[2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        last = 1.0 if length <= reach else reach / length
        if length <= reach:
            i, j, k = math.floor(ends[n, 0]), math.floor(ends[n, 1]), math.floor(ends[n, 2])
            if 0 <= i < nx and 0 <= j < ny and 0 <= k < nz:
                if marks[i, j, k] == _HIT:
                    continue
                marks[i, j, k] = _HIT
        _pass(marks, start[0], start[1], start[2], dx, dy, dz, last)


@njit(cache=True)
def _pass(marks, x, y, z, dx, dy, dz, last):  # type: ignore[no-untyped-def]
    first, last = clip_all(x, y, z, dx, dy, dz, marks.shape, last)
    if first > last:
        return
    here, count, steps, waits, left, borders = enter(x, y, z, dx, dy, dz, marks.shape, first, last)
    flat = marks.ravel()
    for _ in range(count):
        if flat[here] == 0:
            flat[here] = _PASSED
        here, left, borders = onward(here, steps, waits, left, borders)
    if flat[here] == 0:
        flat[here] = _PASSED


@njit(cache=True)
def _update(log_odds, marks, hit, miss, low, high):  # type: ignore[no-untyped-def]
    flat_odds, flat_marks = log_odds.reshape(-1), marks.reshape(-1)
    for n in range(flat_marks.size):
        mark = flat_marks[n]
        if mark:
            flat_marks[n] = 0
            before = 0.0 if math.isnan(flat_odds[n]) else flat_odds[n]
            flat_odds[n] = min(max(before + (hit if mark == _HIT else miss), low), high)
