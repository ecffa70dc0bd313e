"""The layers of pictures of the plane: grids, voxels, ellipses, landmarks, outlines, what was seen."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.image import AxesImage
from matplotlib.patches import Ellipse, Polygon
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.plotting import style
from qsrlang.plotting.labels import Labels
from qsrlang.plotting.outlines import ellipse_axes
from qsrlang.relations.graph import Landmark

MAX_LATTICE = 8192
"""The most voxels a picture shows along one side."""

_GREYS = ListedColormap([style.CELL_GREYS[cell] for cell in sorted(Cell)])
_SAMPLES_PER_CELL = 3
_MAX_SAMPLES = 1600
_SAME_PLACE = 1e-6
_ARROWHEAD = Path([[1.0, 0.0], [-0.75, 0.75], [-0.5, 0.0], [-0.75, -0.75], [1.0, 0.0]], closed=True)
_DISC = 5.0
_TICK = 7.0


def add_grid(axes: Axes, occupancy: OccupancyGrid) -> AxesImage:
    """Draw the cells of a grid in greys; a turned grid is sampled, finer than its cells, over the axes."""
    height, width = occupancy.cells.shape
    origin, size = occupancy.origin, occupancy.resolution
    if origin.yaw == 0.0:
        extent = (origin.x, origin.x + width * size, origin.y, origin.y + height * size)
        return _add_image(axes, _GREYS(occupancy.cells, bytes=True), extent, zorder=0.0)
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    x, y = (cell_centres(low, high, _sample_count(high - low, size)) for low, high in ((x0, x1), (y0, y1)))
    places = np.stack(np.meshgrid(x, y), axis=-1)
    covered, cells = occupancy.covers(places), occupancy.cells_of(places)
    picture = np.zeros((*covered.shape, 4), dtype=np.uint8)
    picture[covered] = _GREYS(occupancy.cells[cells[covered, 0], cells[covered, 1]], bytes=True)
    return _add_image(axes, picture, (x0, x1, y0, y1), zorder=0.0)


def add_voxels(
    axes: Axes, centres: FloatArray, colours: FloatArray, order: FloatArray, lone_size: float
) -> AxesImage | None:
    """Draw voxels with centres (K, 3) as squares of their lattice in colours (K, 4).

    In a column the voxel with the highest `order` (K,) is the one that shows. The side of the squares is the
    spacing of the centres, or `lone_size` [m] where there is only one.
    """
    if not len(centres):
        return None
    size = spacing(centres[:, :2]) or lone_size
    low = centres[:, :2].min(axis=0)
    cells = np.rint((centres[:, :2] - low) / size).astype(np.int64)
    width, height = cells.max(axis=0) + 1
    if max(width, height) > MAX_LATTICE:
        longest = int(max(width, height))
        raise ValueRangeError("the side of a picture in voxels", longest, f"at most {MAX_LATTICE}")
    picture = np.zeros((height, width, 4), dtype=np.uint8)
    upwards = np.argsort(order, kind="stable")
    picture[cells[upwards, 1], cells[upwards, 0]] = np.rint(255.0 * colours[upwards])
    corner = low - 0.5 * size
    extent = (corner[0], corner[0] + width * size, corner[1], corner[1] + height * size)
    return _add_image(axes, picture, extent, zorder=1.0)


def add_ellipses(axes: Axes, means: FloatArray, covariances: FloatArray, *, width: float = 0.9) -> None:
    """Draw 1-sigma (full) and 2-sigma (dashed) ellipses of Gaussians: means (M, 2), covariances (M, 2, 2)."""
    for mean, covariance in zip(means, covariances, strict=True):
        half, middle = ellipse_axes(covariance), (float(mean[0]), float(mean[1]))
        for sigmas, dashes in ((1.0, "solid"), (2.0, (0.0, (4.0, 2.5)))):
            wide, high = 2.0 * sigmas * half.major, 2.0 * sigmas * half.minor
            line = Ellipse(middle, wide, high, angle=float(np.rad2deg(half.heading)), fill=False)
            line.set(edgecolor=style.BELIEF, linewidth=width, linestyle=dashes, zorder=5.0)
            line.set_gid(f"sigma-{sigmas:g}")
            axes.add_patch(line)


def add_supports(axes: Axes, outlines: Iterable[ConvexPolygon]) -> None:
    """Draw the outlines of supports."""
    for outline in outlines:
        line = Polygon(outline.corners, closed=True, fill=False, linewidth=1.0, zorder=2.0)
        line.set(edgecolor=style.SUPPORT, gid="support")
        axes.add_patch(line)


def add_landmarks(axes: Axes, labels: Labels, landmarks: Iterable[Landmark]) -> None:
    """Draw landmarks as black discs, with a tick along a known heading, and keep labels off them."""
    stroke = {"arrowstyle": "-", "linewidth": 1.4, "color": "black", "shrinkA": 0.0, "shrinkB": 0.0}
    for mark in landmarks:
        axes.plot(mark.x, mark.y, "o", color="black", ms=_DISC, mew=0.0, zorder=6.0, gid="landmark")
        labels.keep_clear([[mark.x, mark.y]], 0.6 * _DISC)
        if mark.heading is not None:
            dx, dy = (float(part) for part in _TICK * unit(mark.heading))
            tick = axes.annotate(
                "", (mark.x, mark.y), (dx, dy), textcoords="offset points", arrowprops=stroke
            )
            tick.set(zorder=6.0, gid="heading")


def name_landmarks(labels: Labels, landmarks: Iterable[Landmark]) -> None:
    """Write each landmark's name beside its disc."""
    for mark in landmarks:
        labels.place(mark.name, (mark.x, mark.y), gap=_DISC, must=True)


def add_stars(axes: Axes, places: FloatArray, size: float) -> None:
    """Draw what was seen at places (N, 2) [m] as stars of `size` typographic points."""
    x, y = places.T
    axes.plot(x, y, "*", ms=size, mfc=style.SEEN, mec="white", mew=0.6, zorder=8.0, gid="detections")


def add_robot(axes: Axes, pose: npt.ArrayLike, *, size: float, filled: bool = True) -> None:
    """Draw a robot's pose (3,) of x, y [m] and yaw [rad] as an arrowhead of `size` typographic points."""
    x, y, yaw = np.asarray(pose, dtype=np.float64)
    head = _ARROWHEAD.transformed(Affine2D().rotate(float(yaw)))
    face, edge = (style.INK, "white") if filled else ("white", style.INK)
    axes.plot(x, y, marker=head, ms=size, mfc=face, mec=edge, mew=0.7, zorder=7.0, gid="robot")


def add_outlines(
    axes: Axes, outlines: FloatArray, colours: FloatArray, widths: npt.ArrayLike
) -> LineCollection:
    """Draw closed outlines (N, K, 2) with colours (N, 4) and line widths (N,) [typographic points]."""
    closed = np.concatenate([outlines, outlines[:, :1]], axis=1)
    lines = LineCollection(list(closed), colors=colours, linewidths=widths, zorder=3.0, capstyle="round")
    axes.add_collection(lines, autolim=False)
    return lines


def spacing(coordinates: FloatArray) -> float:
    """Return the smallest step between different values in the columns of (K, D), 0 where none differ."""
    gaps = np.concatenate([np.diff(np.unique(column)) for column in coordinates.T])
    return float(min(gaps[gaps > _SAME_PLACE], default=0.0))


def cell_centres(low: float, high: float, count: int) -> FloatArray:
    """Return the centres (count,) of equal cells between two bounds."""
    return np.asarray(low + (np.arange(count) + 0.5) * (high - low) / count)


def _sample_count(side: float, size: float) -> int:
    return int(min(_MAX_SAMPLES, np.ceil(_SAMPLES_PER_CELL * side / size)))


def _add_image(
    axes: Axes, picture: npt.NDArray[np.uint8], extent: tuple[float, float, float, float], zorder: float
) -> AxesImage:
    image = AxesImage(axes, interpolation="nearest", origin="lower", extent=extent, zorder=zorder)
    image.set_data(picture)
    image.set_transform(axes.transData)
    image.set_clip_path(axes.patch)
    axes.add_image(image)
    return image
