"""A furnished room of boxes, rendered ray by ray, and the maps made of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from qsrlang.arrays import FloatArray
from qsrlang.maps.mapping import VoxelMapper
from qsrlang.maps.voxels import VoxelGrid

RESOLUTION = 0.05


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


@pytest.fixture(scope="session")
def box_room() -> BoxRoom:
    """A worktop, a table on legs, shelves, a cupboard and a chair, with things on them."""
    boxes = [
        ((0.0, 0.0, 0.0), (0.62, 3.0, 0.91)),
        ((0.1, 1.0, 0.91), (0.4, 1.3, 1.21)),
        ((2.5, 1.5, 0.70), (4.1, 2.5, 0.74)),
        ((2.55, 1.55, 0.0), (2.6, 1.6, 0.70)),
        ((4.0, 1.55, 0.0), (4.05, 1.6, 0.70)),
        ((2.55, 2.4, 0.0), (2.6, 2.45, 0.70)),
        ((4.0, 2.4, 0.0), (4.05, 2.45, 0.70)),
        ((3.1, 1.9, 0.74), (3.2, 2.0, 0.86)),
        ((5.6, 0.5, 0.0), (6.0, 1.7, 1.31)),
        ((1.5, 4.65, 0.45), (3.5, 5.0, 0.48)),
        ((1.5, 4.65, 0.95), (3.5, 5.0, 0.98)),
        ((4.6, 3.6, 0.0), (5.1, 4.1, 0.46)),
        ((4.6, 4.05, 0.46), (5.1, 4.1, 0.93)),
    ]
    return BoxRoom(np.array(boxes), np.array([6.0, 5.0, 2.5]))


@pytest.fixture(scope="session")
def box_room_map(box_room: BoxRoom) -> VoxelGrid:
    """The voxel map of the room from 42 views at 1.5 m, offset by half a voxel from its walls."""
    mapper = VoxelMapper((-0.125, -0.125, -0.125), (126, 106, 56), RESOLUTION)
    for x, y in ((1.2, 0.7), (1.3, 3.6), (3.2, 0.8), (3.3, 3.4), (4.8, 2.2), (5.4, 4.6), (1.6, 2.0)):
        eye = np.array([x, y, 1.5])
        for turn in range(6):
            mapper.insert(eye, box_room.depth_points(eye, turn * np.pi / 3 + x, -0.5 if turn % 2 else -0.2))
    return mapper.grid("the box room")
