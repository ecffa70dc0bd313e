"""Voxel grids as triangle meshes: the faces between occupied and other voxels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid

MAX_QUADS = 4_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Quads (Q, 4) of indices into vertices (V, 3), map frame [m]; counter-clockwise seen from outside."""

    vertices: FloatArray
    quads: IntArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen_array("the vertices of a mesh", self.vertices, (None, 3)))
        object.__setattr__(
            self, "quads", frozen_array("the quads of a mesh", self.quads, (None, 4), np.int64)
        )


def clear_boxes(grid: VoxelGrid, boxes: Sequence[npt.ArrayLike]) -> BoolArray:
    """Return which voxels (X, Y, Z) are occupied once those with their centre in a box (2, 3) are cut out.

    A box is widened by half a voxel to its sides and upwards, so that nothing reaches into what stands in it.
    """
    occupied = np.asarray(grid.voxels == Cell.OCCUPIED)
    below, above = np.array([[0.5, 0.5, 0.0], [0.5, 0.5, 0.5]]) * grid.resolution
    for box in boxes:
        low, high = np.asarray(box, dtype=np.float64)
        first = np.ceil((low - below - grid.origin) / grid.resolution - 0.5).astype(np.int64)
        last = np.floor((high + above - grid.origin) / grid.resolution - 0.5).astype(np.int64)
        inside = tuple(slice(max(a, 0), max(b + 1, 0)) for a, b in zip(first, last, strict=True))
        occupied[inside] = False
    return occupied


def mesh_of(occupied: BoolArray, resolution: float, origin: FloatArray) -> Mesh:
    """Return the surface of the occupied voxels (X, Y, Z), faces in one plane merged to rectangles.

    Raises ValueRangeError where nothing is occupied or more than MAX_QUADS faces are left.
    """
    if not occupied.any():
        raise ValueRangeError("the number of occupied voxels of a map", 0, "at least 1")
    rectangles = [_rectangles(occupied, axis, side) for axis in range(3) for side in (0, 1)]
    corners = np.concatenate(rectangles).reshape(-1, 3)
    if len(corners) > 4 * MAX_QUADS:
        raise ValueRangeError("the number of faces of a voxel map", len(corners) // 4, f"at most {MAX_QUADS}")
    lattice = np.array(occupied.shape) + 1
    keys, quads = np.unique(np.ravel_multi_index(tuple(corners.T), tuple(lattice)), return_inverse=True)
    vertices = np.stack(np.unravel_index(keys, tuple(lattice)), axis=-1)
    return Mesh(origin + vertices * resolution, quads.reshape(-1, 4))


def _rectangles(occupied: BoolArray, axis: int, side: int) -> IntArray:
    """Return corners (R, 4, 3), in lattice steps, of faces that look along +axis (side 1) or -axis (0)."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    solid = np.pad(occupied.transpose(axis, u, v), ((1, 1), (0, 0), (0, 0)))
    inner, outer = (solid[1:-1], solid[2:]) if side else (solid[1:-1], solid[:-2])
    faces = inner & ~outer
    if not faces.any():
        return np.empty((0, 4, 3), dtype=np.int64)
    layer, low, high = _merged(faces)
    corners = np.empty((len(layer), 4, 3), dtype=np.int64)
    corners[..., axis] = (layer + side)[:, None]
    order = ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0))
    ends = np.stack([low, high])
    for corner, (at_u, at_v) in enumerate(order):
        corners[:, corner, u], corners[:, corner, v] = ends[at_u, :, 0], ends[at_v, :, 1]
    return corners


def _merged(faces: BoolArray) -> tuple[IntArray, IntArray, IntArray]:
    """Merge faces (L, U, V) to rectangles: runs along v, then equal runs side by side along u.

    Returns the layer (R,), the lower corner (R, 2) and the upper corner (R, 2), in steps of (u, v).
    """
    steps = np.diff(np.pad(faces.astype(np.int8), ((0, 0), (0, 0), (1, 1))), axis=-1)
    starts, ends = np.argwhere(steps == 1), np.argwhere(steps == -1)
    runs = np.column_stack([starts[:, 0], starts[:, 2], ends[:, 2], starts[:, 1]])
    runs = runs[np.lexsort(runs.T[::-1])]
    same = np.zeros(len(runs), dtype=bool)
    same[1:] = (runs[1:, :3] == runs[:-1, :3]).all(axis=1) & (runs[1:, 3] == runs[:-1, 3] + 1)
    first = np.flatnonzero(~same)
    last = np.append(first[1:], len(runs)) - 1
    low = np.column_stack([runs[first, 3], runs[first, 1]])
    high = np.column_stack([runs[last, 3] + 1, runs[first, 2]])
    return runs[first, 0], low, high


def write_obj(mesh: Mesh, path: Path) -> None:
    """Write the mesh as an OBJ file of triangles."""
    quads = mesh.quads + 1
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    with path.open("w", encoding="ascii") as file:
        file.writelines(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in mesh.vertices.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in triangles.tolist())
