"""A map from above: the occupancy grid and the support voxels on it (Figs. 5 and 6 of the paper)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, to_rgba_array
from matplotlib.figure import Figure

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.supports import Supports
from qsrlang.plotting import layers, style
from qsrlang.plotting.canvas import Ground, bar_box, plane_figure
from qsrlang.plotting.labels import Labels

WEIGHT_LABEL = "voxel\nweight"

_MARGIN = 0.25
_LABELLED = len(style.PARTS)


def draw_map(
    occupancy: OccupancyGrid, supports: Supports | None = None, weights: npt.ArrayLike | None = None
) -> Figure:
    """Return a grid in greys with its support voxels coloured by part, or by `weights` (K,) where given.

    The largest parts bear a colour and a name of their own, the others share one colour. Raises
    ValueRangeError where the weights do not fit the supports or the picture would be too large.
    """
    shares = None if weights is None else voxel_shares(supports, weights)
    graded = shares is not None and is_graded(shares)
    figure, axes = plane_figure(known_ground(occupancy, supports), frame="map", bars=int(graded))
    layers.add_grid(axes, occupancy)
    if supports is None or not len(supports.centres):
        return figure
    if shares is None:
        _add_parts(axes, supports, occupancy.resolution)
        return figure
    scale = add_weighted_voxels(axes, supports, shares, occupancy.resolution)
    if graded:
        style.add_colour_bar(figure, bar_box(figure, axes, 0), style.WEIGHT_COLOURS, scale, WEIGHT_LABEL)
    return figure


def known_ground(occupancy: OccupancyGrid, supports: Supports | None = None) -> Ground:
    """Return the box around what a grid knows and all support voxels; all of an unknown grid."""
    known = np.argwhere(occupancy.cells != Cell.UNKNOWN)
    cells = (
        _corner_cells(known)
        if len(known)
        else _corner_cells(np.array([[0, 0], occupancy.cells.shape]) - [[0], [1]])
    )
    points = occupancy.centres_of(cells)
    if supports is not None and len(supports.centres):
        points = np.concatenate([points, supports.centres[:, :2]])
    return Ground.around(points, _MARGIN + 0.5 * occupancy.resolution)


def voxel_shares(supports: Supports | None, weights: npt.ArrayLike) -> FloatArray:
    """Return the weights as an array (K,), one for each support voxel; raises ValueRangeError otherwise."""
    count = 0 if supports is None else len(supports.centres)
    return frozen_array("the weights of the support voxels", weights, (count,))


def is_graded(weights: FloatArray) -> bool:
    """Return whether weights (K,) differ, so that their colours say something."""
    return len(weights) > 0 and float(np.ptp(weights)) > 0.0


def add_weighted_voxels(axes: Axes, supports: Supports, weights: FloatArray, lone_size: float) -> Normalize:
    """Draw support voxels coloured by weight (K,), the heaviest of a column on top; return the scale."""
    low = float(weights.min(initial=np.inf))
    scale = Normalize(low, float(weights.max()) if is_graded(weights) else low + 1.0)
    layers.add_voxels(axes, supports.centres, style.WEIGHT_COLOURS(scale(weights)), weights, lone_size)
    return scale


def _corner_cells(cells: IntArray) -> IntArray:
    (row0, column0), (row1, column1) = cells.min(axis=0), cells.max(axis=0)
    return np.array([[row0, column0], [row0, column1], [row1, column0], [row1, column1]])


def _add_parts(axes: Axes, supports: Supports, lone_size: float) -> None:
    palette = to_rgba_array([*style.PARTS, style.OTHER_PART])
    colours = palette[np.minimum(supports.part, len(style.PARTS))]
    layers.add_voxels(axes, supports.centres, colours, supports.centres[:, 2], lone_size)
    labels = Labels(axes)
    for index, name in enumerate(supports.names[:_LABELLED]):
        place = _middle_voxel(supports.centres[supports.part == index, :2])
        labels.place(name, place, gap=0.0, must=True)


def _middle_voxel(centres: FloatArray) -> FloatArray:
    return np.asarray(centres[np.argmin(np.linalg.norm(centres - centres.mean(axis=0), axis=1))])
