"""The voxels of a place in oblique view, coloured by height (Fig. 5 of the paper, left)."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.errors import ValueRangeError
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.plotting import style
from qsrlang.plotting.canvas import new_figure

MAX_FACES = 1_000_000
"""The most voxel faces a picture holds."""

_SHADES = (0.72, 0.86, 1.0)
_HEIGHT_LIMIT = 5.6
_MARGIN, _BAR_ROOM = 0.1, 0.75


def draw_voxels(
    grid: VoxelGrid,
    *,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    azimuth: float = math.radians(-125.0),
    elevation: float = math.radians(42.0),
) -> Figure:
    """Return an oblique (orthographic) view of the occupied voxels with centres from z_min to z_max [m].

    `azimuth` is the heading from the scene to the viewer, `elevation` the viewer's angle above the floor
    [rad]. Cut the ceiling off with `z_max` to look into a room. Raises ValueRangeError where no voxel is left
    or the viewer is not between floor and zenith.
    """
    if not 0.0 < elevation < 0.5 * math.pi:
        raise ValueRangeError("the elevation of a viewer", elevation, "above 0 and below pi/2 rad")
    occupied = _occupied(grid, z_min, z_max)
    faces, heights, shades = _faces(occupied, azimuth)
    corners = grid.origin + grid.resolution * faces
    right, up, towards = _viewer(azimuth, elevation)
    order = np.argsort(corners.mean(axis=1) @ towards, kind="stable")
    plane = np.stack([corners @ right, corners @ up], axis=-1)[order]
    z = grid.origin[2] + grid.resolution * (heights[order] + 0.5)
    return _picture(plane, z, shades[order])


def _occupied(grid: VoxelGrid, z_min: float, z_max: float) -> BoolArray:
    heights = grid.centres_of(
        np.stack([np.zeros(grid.voxels.shape[2])] * 2 + [np.arange(grid.voxels.shape[2])], -1)
    )
    within = (heights[:, 2] >= z_min) & (heights[:, 2] <= z_max)
    occupied = (grid.voxels == Cell.OCCUPIED) & within
    if not occupied.any():
        raise ValueRangeError(
            "the number of occupied voxels in a picture", 0, "at least 1 between z_min and z_max"
        )
    return np.asarray(np.pad(occupied, 1))


def _faces(padded: BoolArray, azimuth: float) -> tuple[FloatArray, IntArray, FloatArray]:
    sides = (1 if math.cos(azimuth) >= 0.0 else -1, 1 if math.sin(azimuth) >= 0.0 else -1, 1)
    quads, heights, shades = [], [], []
    for axis, side in enumerate(sides):
        bare = np.argwhere(padded & ~np.roll(padded, -side, axis=axis)) - 1
        quads.append(bare[:, None, :] + _quad(axis, side))
        heights.append(bare[:, 2])
        shades.append(np.full(len(bare), _SHADES[axis]))
    count = sum(len(part) for part in quads)
    if count > MAX_FACES:
        raise ValueRangeError("the number of voxel faces in a picture", count, f"at most {MAX_FACES}")
    return np.concatenate(quads), np.concatenate(heights), np.concatenate(shades)


def _quad(axis: int, side: int) -> IntArray:
    corners = np.insert(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]), axis, 1 if side > 0 else 0, axis=1)
    return np.asarray(corners)


def _viewer(azimuth: float, elevation: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    cos, sin = math.cos(azimuth), math.sin(azimuth)
    towards = np.array([cos * math.cos(elevation), sin * math.cos(elevation), math.sin(elevation)])
    right = np.array([-sin, cos, 0.0])
    return right, np.cross(towards, right), towards


def _picture(plane: FloatArray, z: FloatArray, shades: FloatArray) -> Figure:
    low, high = plane.min(axis=(0, 1)), plane.max(axis=(0, 1))
    wide, tall = high - low
    scale = min((style.FIGURE_WIDTH - 2.0 * _MARGIN - _BAR_ROOM) / wide, _HEIGHT_LIMIT / tall)
    width, height = scale * wide + 2.0 * _MARGIN + _BAR_ROOM, scale * tall + 2.0 * _MARGIN
    figure = new_figure(width, height)
    axes = figure.add_axes((_MARGIN / width, _MARGIN / height, scale * wide / width, scale * tall / height))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), autoscale_on=False)
    axes.set_axis_off()
    span = Normalize(float(z.min()), float(max(z.max(), z.min() + 1e-3)))
    colours = np.asarray(style.HEIGHT_COLOURS(span(z)))
    colours[:, :3] *= shades[:, None]
    axes.add_collection(
        PolyCollection(
            list(plane), facecolors=colours, edgecolors="none", antialiaseds=False, rasterized=True
        ),
        autolim=False,
    )
    box = (1.0 - (_BAR_ROOM - 0.15) / width, 1.0 - 1.75 / height, 0.11 / width, 1.2 / height)
    style.add_colour_bar(figure, box, style.HEIGHT_COLOURS, span, "height z\n[m]")
    return figure
