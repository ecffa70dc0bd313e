"""A furnished room of boxes, rendered ray by ray."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.maps.voxels import VoxelGrid


@dataclass(frozen=True)
class BoxRoom:
    """Boxes (B, 2, 3) of lowest and highest corners inside a room from (0, 0, 0) to `size`."""

    boxes: FloatArray
    size: FloatArray

    def depth_points(self, eye: FloatArray, yaw: float, tilt: float) -> FloatArray:
        """Return what a camera of 120 x 90 rays and 80 degrees across sees: points (N, 3)."""
        u, v = np.meshgrid(np.linspace(-0.84, 0.84, 120), np.linspace(-0.63, 0.63, 90))
        rays = np.stack([np.ones_like(u), u, v], axis=-1).reshape(-1, 3)
        (c, s), (ct, st) = (np.cos(yaw), np.sin(yaw)), (np.cos(tilt), np.sin(tilt))
        pitch = np.array([[ct, 0.0, -st], [0.0, 1.0, 0.0], [st, 0.0, ct]])
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        rays = rays @ (turn @ pitch).T
        walls = np.where(rays > 0, (self.size - eye) / rays, -eye / rays).min(axis=1)
        near = (self.boxes[None, :, 0] - eye) / rays[:, None]
        far = (self.boxes[None, :, 1] - eye) / rays[:, None]
        enter, leave = np.minimum(near, far).max(axis=2), np.maximum(near, far).min(axis=2)
        hits = np.where((enter <= leave) & (enter > 0), enter, np.inf).min(axis=1)
        return np.asarray(eye + rays * np.minimum(walls, hits)[:, None])

    def support_columns(self, grid: VoxelGrid, low: float, high: float) -> list[tuple[int, int, float]]:
        """Return (x index, y index, z) of every open upward face between two heights, by the middle of columns."""
        found = []
        for i, j in np.ndindex(grid.voxels.shape[:2]):
            x, y, _ = grid.centres_of((i, j, 0))
            inside = ((self.boxes[:, 0, :2] <= (x, y)) & ((x, y) <= self.boxes[:, 1, :2])).all(axis=1)
            for top in self.boxes[inside, 1, 2]:
                above = self.boxes[inside, 0, 2] - top
                covered = ((above < 0.1) & (self.boxes[inside, 1, 2] > top)).any()
                if low < top < high and not covered:
                    found.append((i, j, float(top)))
        return found
