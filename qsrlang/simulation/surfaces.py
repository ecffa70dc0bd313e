"""Surfaces on which things can stand, found by rays up and down: where objects are put, and what maps are held to."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.simulation.engine import NOTHING, Engine

STEEPEST = math.cos(math.radians(25.0))
SKY = 20.0
UNDERGROUND = 1.0
MAX_CROSSINGS = 60
SKIN = 1e-3
COLUMN_STRIDE = 1_000.0
STANDING_ROOM = 0.1
SUPPORT_HEIGHTS = (0.3, 1.5)
SMALLEST_SUPPORT = 40


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """Open surfaces under N points: heights (S,), map frame [m], and the index (S,) of the point above each."""

    points: IntArray
    heights: FloatArray

    def highest(self, count: int, below: float) -> FloatArray:
        """Return the highest surface not above `below` [m] under each of `count` points, nan where there is none."""
        highest = np.full(count, np.nan)
        chosen = self.heights <= below
        np.fmax.at(highest, self.points[chosen], self.heights[chosen])
        return highest


def surfaces_under(engine: Engine, points: FloatArray, floor: float, room_above: float) -> Surfaces:
    """Return all surfaces under points (N, 2) that look up, within 25 deg, and have `room_above` [m] of free space.

    Rays down meet the tops of bodies, rays up their undersides; a top lies inside a body where more tops than
    undersides are above it.
    """
    column, top, normal = _crossings(engine, points, floor + SKY, floor - UNDERGROUND)
    under_column, underside, _ = _crossings(engine, points, floor - UNDERGROUND, floor + SKY)
    tops, undersides = np.sort(_keys(column, top)), np.sort(_keys(under_column, underside))
    open_above = _count(tops, column, top + SKIN, SKY) <= _count(undersides, column, top - SKIN, SKY)
    free = _count(undersides, column, top - SKIN, top + room_above) == 0
    standing = open_above & free & (normal >= STEEPEST)
    return Surfaces(column[standing], top[standing])


def supporting_voxels(engine: Engine, grid: VoxelGrid, floor: float) -> BoolArray:
    """Return which voxels (X, Y, Z) of a grid hold a support, by rays under the centre of each column.

    A support looks up within 25 deg, is 0.3 to 1.5 m above the floor, has STANDING_ROOM above it and belongs to a
    connected part of at least 40 voxels. A map made by a robot is held against it.
    """
    nx, ny, nz = grid.voxels.shape
    columns = np.stack(np.unravel_index(np.arange(nx * ny), (nx, ny)), axis=-1)
    centres = grid.centres_of(np.column_stack([columns, np.zeros(nx * ny, dtype=np.int64)]))[:, :2]
    found = surfaces_under(engine, centres, floor, STANDING_ROOM)
    low, high = SUPPORT_HEIGHTS
    chosen = (found.heights - floor > low) & (found.heights - floor < high)
    layer = np.floor((found.heights[chosen] - SKIN - grid.origin[2]) / grid.resolution).astype(np.int64)
    inside = (layer >= 0) & (layer < nz)
    held = np.zeros((nx, ny, nz), dtype=bool)
    held[(*columns[found.points[chosen][inside]].T, layer[inside])] = True
    labels, _ = ndimage.label(held, structure=np.ones((3, 3, 3)))
    large = np.bincount(labels.ravel()) >= SMALLEST_SUPPORT
    large[0] = False
    return np.asarray(large[labels])


def _crossings(
    engine: Engine, points: FloatArray, start: float, end: float
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return where vertical rays at points (N, 2) enter bodies: index of the point, height and normal's z, (C,) each.

    A ray that starts within a box or cylinder does not meet it again, save at its start, which does not count;
    of a concave mesh it meets every face, so that every other one is an exit.
    """
    height, active, within = (
        np.full(len(points), start),
        np.arange(len(points)),
        np.zeros(len(points), dtype=bool),
    )
    parts: list[tuple[IntArray, FloatArray, FloatArray]] = []
    for _ in range(MAX_CROSSINGS):
        ends = np.column_stack([points[active], np.full(len(active), end)])
        hits = engine.rays(np.column_stack([points[active], height[active]]), ends)
        met = hits.bodies != NOTHING
        active, heights = active[met], hits.points[met, 2]
        crosses = hits.fractions[met] > 0.0
        concave = np.isin(hits.bodies[met], engine.concave) & crosses
        enters = crosses & ~(concave & within[active])
        parts.append((active[enters], heights[enters], np.abs(hits.normals[met, 2])[enters]))
        within[active] ^= concave
        height[active] = heights + math.copysign(SKIN, end - start)
        if not len(active):
            break
    columns, tops, normals = zip(*parts, strict=True)
    return np.concatenate(columns), np.concatenate(tops), np.concatenate(normals)


def _keys(column: IntArray, height: FloatArray) -> FloatArray:
    return np.asarray(column * COLUMN_STRIDE + height)


def _count(keys: FloatArray, column: IntArray, low: FloatArray, high: FloatArray | float) -> IntArray:
    """Return how many of the sorted keys lie in each column between the heights."""
    upper = np.searchsorted(keys, _keys(column, np.broadcast_to(high, low.shape)), side="right")
    return np.asarray(upper - np.searchsorted(keys, _keys(column, low), side="left"))
