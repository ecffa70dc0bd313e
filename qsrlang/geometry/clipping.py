"""Many convex polygons at once, cut by lines and drawn from: compiled, since a draw takes a microsecond in all."""

from __future__ import annotations

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray


def draw_inside(
    outlines: FloatArray, points: FloatArray, normals: FloatArray, uniforms: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return a uniform draw (P, 2) from what is left of each of P convex polygons (P, V, 2), and its area (P,) [m^2].

    Polygon p is cut by H lines, through `points` (H, P, 2), to the side that `normals` (H, P, 2) point to (Sutherland
    and Hodgman 1974); where nothing is left, the area is 0. A draw is made of two uniform numbers (P, 2).
    """
    draws, areas = np.empty((len(outlines), 2)), np.empty(len(outlines))
    _draw_inside(outlines, points, normals, uniforms, draws, areas)
    return draws, areas


@njit(cache=True)
def _draw_inside(
    outlines: FloatArray,
    points: FloatArray,
    normals: FloatArray,
    uniforms: FloatArray,
    draws: FloatArray,
    areas: FloatArray,
) -> None:  # pragma: no cover
    most = outlines.shape[1] + len(points)
    corners, spare = np.empty((most, 2)), np.empty((most, 2))
    for p in range(len(outlines)):
        count = outlines.shape[1]
        corners[:count] = outlines[p]
        for h in range(len(points)):
            count = _cut(corners, count, points[h, p], normals[h, p], spare)
            corners, spare = spare, corners
        areas[p] = _pick(corners, count, uniforms[p, 0], uniforms[p, 1], draws[p])


@njit(cache=True)
def _cut(
    corners: FloatArray, count: int, point: FloatArray, normal: FloatArray, kept: FloatArray
) -> int:  # pragma: no cover
    """Write the corners on the inner side of a line, and where edges cross it, to `kept`; return how many."""
    found = 0
    for at in range(count):
        x, y = corners[at, 0], corners[at, 1]
        next_x, next_y = corners[(at + 1) % count, 0], corners[(at + 1) % count, 1]
        side = (x - point[0]) * normal[0] + (y - point[1]) * normal[1]
        next_side = (next_x - point[0]) * normal[0] + (next_y - point[1]) * normal[1]
        if side >= 0.0:
            kept[found, 0], kept[found, 1] = x, y
            found += 1
        if (side >= 0.0) != (next_side >= 0.0) and found < len(kept):
            share = side / (side - next_side)
            kept[found, 0], kept[found, 1] = x + share * (next_x - x), y + share * (next_y - y)
            found += 1
    return found


@njit(cache=True)
def _pick(corners: FloatArray, count: int, u: float, v: float, draw: FloatArray) -> float:  # pragma: no cover
    """Write a uniform draw from a polygon, by the triangles that its first corner fans out into; return its area."""
    area = 0.0
    for at in range(1, count - 1):
        area += _triangle(corners, at)
    wanted = u * area
    draw[0], draw[1] = corners[0, 0], corners[0, 1]
    for at in range(1, count - 1):
        own = _triangle(corners, at)
        if wanted <= own or at == count - 2:
            root = np.sqrt(min(max(wanted / own, 0.0), 1.0)) if own > 0.0 else 0.0
            for d in range(2):
                first, one, other = corners[0, d], corners[at, d], corners[at + 1, d]
                draw[d] = first + root * ((1.0 - v) * (one - first) + v * (other - first))
            break
        wanted -= own
    return area


@njit(cache=True, inline="always")
def _triangle(corners: FloatArray, at: int) -> float:  # pragma: no cover
    ax, ay = corners[at, 0] - corners[0, 0], corners[at, 1] - corners[0, 1]
    bx, by = corners[at + 1, 0] - corners[0, 0], corners[at + 1, 1] - corners[0, 1]
    area: float = 0.5 * abs(ax * by - ay * bx)
    return area
