"""Finds the voxels of supporting planes, and names their connected parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.maps.normals import facing_up, mean_normals
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid

METHODS = ("pca", "mean-normal")
MAX_TILT = math.pi / 8.0


@dataclass(frozen=True, slots=True, eq=False)
class Supports:
    """Voxels of supporting planes: `centres` (K, 3), map frame [m], the `part` (K,) of each, `names` (P,).

    Parts are numbered and named by size, the largest "support-1"; the voxels of a part stand together.
    """

    centres: FloatArray
    part: IntArray
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "centres", frozen_array("the centres of supports", self.centres, (None, 3)))
        part = frozen_array("the parts of supports", self.part, (len(self.centres),), np.int64)
        object.__setattr__(self, "part", part)
        if len(part) and (part.min() < 0 or part.max() >= len(self.names)):
            raise ValueRangeError("a part of supports", part.max(), f"0 to {len(self.names) - 1}")

    def centres_of(self, name: str) -> FloatArray:
        """Return the voxel centres (K, 3) of the support `name` [m]; raises UnknownNameError without it."""
        if name not in self.names:
            raise UnknownNameError("support", name, self.names)
        return np.asarray(self.centres[self.part == self.names.index(name)])


def find_supports(
    grid: VoxelGrid,
    method: str = "pca",
    max_tilt: float = MAX_TILT,
    min_height: float | None = None,
    max_height: float | None = None,
    min_part: int = 1,
) -> Supports:
    """Return the voxels on which things can stand, in connected parts (26 neighbours), the largest first.

    `pca`: occupied voxels with free space above on a plane that principal components put within `max_tilt`
    [rad] of level. `mean-normal`: occupied voxels whose mean marching-cubes normal is within `max_tilt` of
    the vertical, unknown space counted as occupied (Kunze et al. 2014).
    `min_height` and `max_height` bound the centres' z in the map frame [m]; parts of fewer than `min_part`
    voxels are left out. The result is empty where nothing is left.
    Raises UnknownNameError for another method and ValueRangeError for a tilt outside 0 to pi/2.
    """
    if method not in METHODS:
        raise UnknownNameError("method of finding supports", method, METHODS)
    if not 0.0 <= max_tilt < math.pi / 2.0:
        raise ValueRangeError("the tilt of a support", max_tilt, "0 or more and below pi/2 rad")
    indices = _between(grid, grid.indices(Cell.OCCUPIED), min_height, max_height)
    upward = facing_up(grid, indices, max_tilt) if method == "pca" else _upright(grid, indices, max_tilt)
    return _parts(grid, indices[upward], min_part)


def _between(grid: VoxelGrid, indices: IntArray, low: float | None, high: float | None) -> IntArray:
    z = grid.centres_of(indices)[:, 2]
    return indices[(z >= (-math.inf if low is None else low)) & (z <= (math.inf if high is None else high))]


def _upright(grid: VoxelGrid, indices: IntArray, max_tilt: float) -> BoolArray:
    normals = mean_normals(grid, indices)
    lengths = np.linalg.norm(normals, axis=1)
    return np.asarray((lengths > 1e-9) & (normals[:, 2] >= math.cos(max_tilt) * lengths))


def _labels(indices: IntArray) -> IntArray:
    if len(indices) == 0:
        return np.zeros(0, dtype=np.int64)
    inside = tuple((indices - indices.min(axis=0)).T)
    mask = np.zeros([axis.max() + 1 for axis in inside], dtype=bool)
    mask[inside] = True
    labels, _ = ndimage.label(mask, structure=np.ones((3, 3, 3)))
    return np.asarray(labels[inside], dtype=np.int64)


def _parts(grid: VoxelGrid, indices: IntArray, min_part: int) -> Supports:
    label = _labels(indices)
    sizes = np.bincount(label, minlength=1)
    order = [found for found in np.argsort(-sizes, kind="stable") if sizes[found] >= max(min_part, 1)]
    rank = np.full(len(sizes), -1)
    rank[order] = np.arange(len(order))
    part = rank[label]
    kept = np.argsort(part, kind="stable")[np.count_nonzero(part < 0) :]
    names = tuple(f"support-{number}" for number in range(1, len(order) + 1))
    return Supports(grid.centres_of(indices[kept]), part[kept], names)
