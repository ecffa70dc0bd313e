"""Voxel grids: what is known of space, cube by cube."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.maps.occupancy import Cell


@dataclass(frozen=True, slots=True, eq=False)
class VoxelGrid:
    """A grid of voxels (X, Y, Z) of `Cell` values; `origin` (3,) is the corner of [0, 0, 0] [m]."""

    voxels: npt.NDArray[np.uint8]
    resolution: float
    origin: FloatArray
    source: str

    def __post_init__(self) -> None:
        voxels = frozen_array(
            "the voxels of a grid", np.ascontiguousarray(self.voxels), (None, None, None), np.uint8
        )
        object.__setattr__(self, "voxels", voxels)
        object.__setattr__(self, "origin", frozen_array("the origin of a voxel grid", self.origin, (3,)))
        if not 0.0 < self.resolution < np.inf:
            raise ValueRangeError(
                "the resolution of a voxel grid", self.resolution, "a positive number of metres"
            )

    def indices(self, state: Cell) -> IntArray:
        """Return the indices (K, 3) of all voxels in this state."""
        flat = np.flatnonzero(self.voxels.reshape(-1) == state)
        return np.stack(np.unravel_index(flat, self.voxels.shape), axis=-1)

    def centres_of(self, indices: npt.ArrayLike) -> FloatArray:
        """Return the centres (..., 3) in the map frame of voxel indices (..., 3) [m]."""
        return np.asarray(self.origin + (np.asarray(indices) + 0.5) * self.resolution)

    def indices_of(self, points_map: npt.ArrayLike) -> IntArray:
        """Return the indices (..., 3) of the voxels that hold points (..., 3); may lie outside the grid."""
        return np.floor((np.asarray(points_map) - self.origin) / self.resolution).astype(np.int64)
