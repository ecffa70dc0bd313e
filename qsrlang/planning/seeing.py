"""The kernels of visibility: which points lie between planes, with no occupied voxel on the way."""

from __future__ import annotations

import numpy as np
from numba import config, njit

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.maps.occlusion import is_clear, occupied_blocks
from qsrlang.maps.raymarching import clear_rays_plainly
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.frusta import PLANES
from qsrlang.planning.threads import over_rows

COMPILED = not getattr(config, "DISABLE_JIT", False)
_SLACK = 1e-12
_MARGIN = 1e-6


def mark_in_view(
    planes: FloatArray, eyes: FloatArray, reach: float, points: FloatArray, voxels: VoxelGrid, seen: BoolArray
) -> None:
    """Set `seen` (N, K): whether points (K, 3) lie inside planes (N, 6, 4) and a free ray leads to them from eyes.

    No point that lies between the planes is farther from the eye than `reach` [m].
    """
    if not COMPILED:
        mark_plainly(planes, eyes, points, voxels, seen)
        return
    scale = 1.0 / voxels.resolution
    starts, ends = (eyes - voxels.origin) * scale, (points - voxels.origin) * scale
    square = (scale * (reach + _MARGIN)) ** 2
    cells, blocks = voxels.voxels, occupied_blocks(voxels)
    over_rows(
        lambda first, last: _mark(planes, points, cells, blocks, starts, ends, square, seen, first, last),
        len(planes),
        seen.size,
    )


def mark_clear(
    eyes: FloatArray, points: FloatArray, voxels: VoxelGrid, reach: float, clear: BoolArray
) -> None:
    """Set `clear` (P, K): whether points (K, 3) are within `reach` [m] of eyes (P, 3) and a free ray leads there."""
    square = reach * reach
    if not COMPILED:
        for row, eye in zip(clear, eyes, strict=True):
            row[:] = ((points - eye) ** 2).sum(axis=1) <= square
            inside = np.flatnonzero(row)
            row[inside] = clear_rays_plainly(voxels, np.broadcast_to(eye, (len(inside), 3)), points[inside])
        return
    scale = 1.0 / voxels.resolution
    starts, ends = (eyes - voxels.origin) * scale, (points - voxels.origin) * scale
    cells, blocks, square = voxels.voxels, occupied_blocks(voxels), square * scale * scale
    over_rows(
        lambda first, last: _clear(cells, blocks, starts, ends, square, clear, first, last),
        len(eyes),
        10 * clear.size,
    )


def mark_between(
    planes: FloatArray, points: FloatArray, places: IntArray, clear: BoolArray, seen: BoolArray
) -> None:
    """Set `seen` (N, K): whether points lie inside planes (N, 6, 4) and are `clear` (P, K) from the view's place."""
    if COMPILED:
        over_rows(
            lambda first, last: _between(planes, points, places, clear, seen, first, last),
            len(planes),
            seen.size,
        )
        return
    for row, plane, place in zip(seen, planes, places, strict=True):
        row[:] = _inside(plane, points) & clear[place]


def mark_plainly(
    planes: FloatArray, eyes: FloatArray, points: FloatArray, voxels: VoxelGrid, seen: BoolArray
) -> None:
    """Do what `mark_in_view` does in plain numpy: where nothing can be compiled, and as its oracle."""
    for row, plane, eye in zip(seen, planes, eyes, strict=True):
        row[:] = _inside(plane, points)
        inside = np.flatnonzero(row)
        row[inside] = clear_rays_plainly(voxels, np.broadcast_to(eye, (len(inside), 3)), points[inside])


def _inside(plane: FloatArray, points: FloatArray) -> BoolArray:
    return np.asarray((points @ plane[:, :3].T >= plane[:, 3] - _SLACK).all(axis=1))


@njit(cache=True)
def _is_inside(planes, n, x, y, z):  # type: ignore[no-untyped-def]
    for side in range(PLANES):
        reach = planes[n, side, 0] * x + planes[n, side, 1] * y + planes[n, side, 2] * z
        if reach < planes[n, side, 3] - _SLACK:
            return False
    return True


@njit(cache=True, nogil=True)
def _mark(planes, points, voxels, blocks, starts, ends, square, seen, first, last):  # type: ignore[no-untyped-def]
    for n in range(first, last):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        for k in range(len(points)):
            dx, dy, dz = ends[k, 0] - x, ends[k, 1] - y, ends[k, 2] - z
            near = dx * dx + dy * dy + dz * dz <= square
            inside = near and _is_inside(planes, n, points[k, 0], points[k, 1], points[k, 2])
            seen[n, k] = inside and is_clear(voxels, blocks, x, y, z, dx, dy, dz)


@njit(cache=True, nogil=True)
def _clear(voxels, blocks, starts, ends, square, clear, first, last):  # type: ignore[no-untyped-def]
    for n in range(first, last):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        for k in range(len(ends)):
            dx, dy, dz = ends[k, 0] - x, ends[k, 1] - y, ends[k, 2] - z
            near = dx * dx + dy * dy + dz * dz <= square
            clear[n, k] = near and is_clear(voxels, blocks, x, y, z, dx, dy, dz)


@njit(cache=True, nogil=True)
def _between(planes, points, places, clear, seen, first, last):  # type: ignore[no-untyped-def]
    for n in range(first, last):
        for k in range(len(points)):
            seen[n, k] = clear[places[n], k] and _is_inside(
                planes, n, points[k, 0], points[k, 1], points[k, 2]
            )
