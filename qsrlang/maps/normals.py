"""Which occupied voxels face up: by marching-cubes normals, or by principal components of neighbours."""

from __future__ import annotations

import itertools
import math
from functools import cache

import numpy as np
from numba import njit

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid

NEIGHBOURS = 14
REACH = 3
_CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))
_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
_FREE, _OCCUPIED = int(Cell.FREE), int(Cell.OCCUPIED)
_Edge = tuple[int, int]


def mean_normals(grid: VoxelGrid, indices: IntArray, unknown_is_occupied: bool = True) -> FloatArray:
    """Return the mean unit normal (K, 3) of the marching-cubes triangles around voxels (K, 3), else zero.

    The triangles are those of the eight cubes whose corners are the centres of the voxel and of its 26
    neighbours, vertices half-way along the edges, normals towards free space, as in OctoMap's getNormals
    (`unknown_is_occupied` is its unknownStatus). Two differences: the triangles come from `cube_normals`, not
    from a printed table, so some loops are fanned otherwise; and all eight cubes count, where OctoMap stops
    at the first one without a surface.
    """
    solid = grid.voxels == Cell.OCCUPIED
    if unknown_is_occupied:
        solid |= grid.voxels == Cell.UNKNOWN
    solid = np.pad(solid, 1, constant_values=unknown_is_occupied)
    sums, counts = cube_normals()
    normals = np.zeros((len(indices), 3))
    _mean_normals(solid, np.ascontiguousarray(indices), sums, counts, normals)
    return normals


def facing_up(grid: VoxelGrid, indices: IntArray, max_tilt: float) -> BoolArray:
    """Return which occupied voxels (K, 3) lie on a plane within `max_tilt` [rad] of level, seen from above.

    The plane is that of the least principal component of the NEIGHBOURS nearest occupied voxels (all that tie
    with the last, none beyond REACH voxels). Its free side is up where nothing lies directly above the voxel
    and one of the nine voxels above was seen free; so a thin board counts though it is free below, too.
    At the rim of a plane the components mix it with the wall or front beside it, so a voxel with its free
    side up that touches a voxel of the plane in its own layer belongs to the plane.
    """
    voxels = np.pad(grid.voxels, REACH, constant_values=Cell.UNKNOWN)
    covariances, faces = np.zeros((len(indices), 3, 3)), np.zeros(len(indices), dtype=bool)
    _scatter(voxels, np.ascontiguousarray(indices) + REACH, *_shells(), covariances, faces)
    upright = np.zeros(len(indices), dtype=bool)
    least = np.linalg.eigh(covariances[faces])[1][:, :, 0]
    upright[faces] = np.abs(least[:, 2]) >= math.cos(max_tilt)
    return _with_rims(grid.voxels.shape, indices, faces, upright)


@cache
def cube_normals() -> tuple[FloatArray, IntArray]:
    """Return for the 256 cubes the sum of unit triangle normals (256, 3) and the number of triangles (256,).

    Bit c of a cube's number tells whether corner c, at (c >> 2 & 1, c >> 1 & 1, c & 1), is solid. On each
    face the surface cuts off every run of solid corners (so two across the diagonal are separate); the cuts
    of all faces close into loops, and every loop is a fan of triangles from its first vertex.
    """
    sums, counts = np.zeros((256, 3)), np.zeros(256, dtype=np.int64)
    for cube in range(256):
        solid = [bool(cube >> corner & 1) for corner in range(8)]
        for loop in _loops(solid):
            points = np.array([_CORNERS[a] + _CORNERS[b] for a, b in loop]) / 2.0
            normals = np.cross(points[1:-1] - points[0], points[2:] - points[0])
            sums[cube] += (normals / np.linalg.norm(normals, axis=1, keepdims=True)).sum(axis=0)
            counts[cube] += len(normals)
    return sums, counts


def _loops(solid: list[bool]) -> list[list[_Edge]]:
    after: dict[_Edge, _Edge] = {}
    for face in _FACES:
        for first in range(4):
            if solid[face[first]] and not solid[face[first - 1]]:
                last = next(k for k in range(first, first + 4) if not solid[face[(k + 1) % 4]])
                enter = (face[first - 1], face[first])
                leave = (face[last % 4], face[(last + 1) % 4])
                after[_edge(enter)] = _edge(leave)
    loops = []
    while after:
        loop = [min(after)]
        while loop[-1] in after:
            loop.append(after.pop(loop[-1]))
        loops.append(loop[:-1])
    return loops


def _edge(ends: _Edge) -> _Edge:
    return min(ends), max(ends)


@cache
def _shells() -> tuple[IntArray, IntArray]:
    span = range(-REACH, REACH + 1)
    offsets = np.array([offset for offset in itertools.product(span, repeat=3) if any(offset)])
    squares = (offsets**2).sum(axis=1)
    order = np.argsort(squares, kind="stable")
    order = order[squares[order] <= REACH**2]
    return offsets[order], squares[order]


@njit(cache=True)
def _mean_normals(solid, indices, sums, counts, normals):  # type: ignore[no-untyped-def]
    for n in range(len(indices)):
        x, y, z = indices[n, 0], indices[n, 1], indices[n, 2]
        count = 0
        for corner in range(8):
            i, j, k = x + (corner >> 2), y + (corner >> 1 & 1), z + (corner & 1)
            cube = 0
            for bit in range(8):
                if solid[i + (bit >> 2), j + (bit >> 1 & 1), k + (bit & 1)]:
                    cube |= 1 << bit
            count += counts[cube]
            for axis in range(3):
                normals[n, axis] += sums[cube, axis]
        for axis in range(3):
            normals[n, axis] /= max(count, 1)


@njit(cache=True)
def _scatter(voxels, indices, offsets, squares, covariances, faces):  # type: ignore[no-untyped-def]
    for n in range(len(indices)):
        x, y, z = indices[n, 0], indices[n, 1], indices[n, 2]
        free = 0
        for i in range(-1, 2):
            for j in range(-1, 2):
                free += voxels[x + i, y + j, z + 1] == _FREE
        if voxels[x, y, z + 1] == _OCCUPIED or free == 0:
            continue
        count, sx, sy, sz, xx, yy, zz, xy, xz, yz = 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
        for m in range(len(offsets)):
            if count >= NEIGHBOURS and squares[m] > squares[m - 1]:
                break
            i, j, k = offsets[m, 0], offsets[m, 1], offsets[m, 2]
            if voxels[x + i, y + j, z + k] == _OCCUPIED:
                count += 1
                sx, sy, sz = sx + i, sy + j, sz + k
                xx, yy, zz = xx + i * i, yy + j * j, zz + k * k
                xy, xz, yz = xy + i * j, xz + i * k, yz + j * k
        faces[n] = count >= 2
        size = count + 1.0
        covariances[n, 0, 0] = xx / size - (sx / size) ** 2
        covariances[n, 1, 1] = yy / size - (sy / size) ** 2
        covariances[n, 2, 2] = zz / size - (sz / size) ** 2
        covariances[n, 0, 1] = covariances[n, 1, 0] = xy / size - sx * sy / size**2
        covariances[n, 0, 2] = covariances[n, 2, 0] = xz / size - sx * sz / size**2
        covariances[n, 1, 2] = covariances[n, 2, 1] = yz / size - sy * sz / size**2


def _with_rims(shape: tuple[int, ...], indices: IntArray, faces: BoolArray, upright: BoolArray) -> BoolArray:
    plane = np.zeros((shape[0] + 2, shape[1] + 2, shape[2]), dtype=bool)
    x, y, z = indices[upright].T
    plane[x + 1, y + 1, z] = True
    x, y, z = indices[faces].T
    beside = [plane[x + i, y + j, z] for i, j in itertools.product(range(3), repeat=2)]
    whole = upright.copy()
    whole[faces] |= np.any(beside, axis=0)
    return whole
