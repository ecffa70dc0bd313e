"""A furnished room and the voxel map made of it."""

from __future__ import annotations

import numpy as np
import pytest
from box_rooms import BoxRoom

from qsrlang.maps.mapping import VoxelMapper
from qsrlang.maps.voxels import VoxelGrid


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
    mapper = VoxelMapper((-0.125, -0.125, -0.125), (126, 106, 56), 0.05)
    for x, y in ((1.2, 0.7), (1.3, 3.6), (3.2, 0.8), (3.3, 3.4), (4.8, 2.2), (5.4, 4.6), (1.6, 2.0)):
        eye = np.array([x, y, 1.5])
        for turn in range(6):
            mapper.insert(eye, box_room.depth_points(eye, turn * np.pi / 3 + x, -0.5 if turn % 2 else -0.2))
    return mapper.grid("the box room")
