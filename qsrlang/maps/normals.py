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
    return np.asarray(_mean_normals(solid, np.ascontiguousarray(indices), sums, counts))


def facing_up(grid: VoxelGrid, indices: IntArray, max_tilt: float) -> BoolArray:
    """Return which occupied voxels (K, 3) lie on a plane within `max_tilt` [rad] of level, seen from above.

    The plane is that of the least principal component of the NEIGHBOURS nearest occupied voxels (all that tie
    with the last, none beyond REACH voxels). Its free side is up where nothing lies directly above the voxel
    and one of the nine voxels above was seen free; so a thin board counts though it is free below, too.
    At the rim of a plane the components mix it with the wall or front beside it, so a voxel with its free
    side up that touches a voxel of the plane in its own layer belongs to the plane.
    """
    voxels = np.pad(grid.voxels, REACH, constant_values=Cell.UNKNOWN)
    covariances, faces = _scatter(voxels, np.ascontiguousarray(indices) + REACH, *_shells())
    upright = np.zeros(len(indices), dtype=bool)
    least = np.linalg.eigh(covariances[faces])[1][:, :, 0]
    upright[faces] = np.abs(least[:, 2]) >= math.cos(max_tilt)
    return np.asarray(_with_rims(grid.voxels.shape, np.ascontiguousarray(indices), faces, upright))


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
def _mean_normals(solid, indices, sums, counts):  # type: ignore[no-untyped-def]
    normals = np.zeros((len(indices), 3))
    for n in range(len(indices)):
        x, y, z = indices[n]
        count = 0
        for corner in range(8):
            i, j, k = x + (corner >> 2), y + (corner >> 1 & 1), z + (corner & 1)
            cube = 0
            for bit in range(8):
                if solid[i + (bit >> 2), j + (bit >> 1 & 1), k + (bit & 1)]:
                    cube |= 1 << bit
            normals[n] += sums[cube]
            count += counts[cube]
        if count:
            normals[n] /= count
    return normals


@njit(cache=True)
def _scatter(voxels, indices, offsets, squares):  # type: ignore[no-untyped-def]
    covariances, faces = np.zeros((len(indices), 3, 3)), np.zeros(len(indices), dtype=np.bool_)
    sums, products = np.zeros(3), np.zeros((3, 3))
    for n in range(len(indices)):
        x, y, z = indices[n]
        above = voxels[x - 1 : x + 2, y - 1 : y + 2, z + 1]
        if above[1, 1] == _OCCUPIED or not (above == _FREE).any():
            continue
        sums[:], products[:] = 0.0, 0.0
        count = 0
        for m in range(len(offsets)):
            if count >= NEIGHBOURS and squares[m] > squares[m - 1]:
                break
            i, j, k = offsets[m]
            if voxels[x + i, y + j, z + k] == _OCCUPIED:
                count += 1
                for a in range(3):
                    sums[a] += offsets[m, a]
                    for b in range(3):
                        products[a, b] += offsets[m, a] * offsets[m, b]
        if count >= 2:
            faces[n] = True
            for a in range(3):
                for b in range(3):
                    covariances[n, a, b] = products[a, b] / (count + 1) - sums[a] * sums[b] / (count + 1) ** 2
    return covariances, faces


@njit(cache=True)
def _with_rims(shape, indices, faces, upright):  # type: ignore[no-untyped-def]
    plane = np.zeros((shape[0] + 2, shape[1] + 2, shape[2]), dtype=np.bool_)
    whole = upright.copy()
    for n in range(len(indices)):
        x, y, z = indices[n]
        plane[x + 1, y + 1, z] = upright[n]
    for n in range(len(indices)):
        if faces[n] and not upright[n]:
            x, y, z = indices[n]
            whole[n] = plane[x : x + 3, y : y + 3, z].any()
    return whole
