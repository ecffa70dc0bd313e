"""Labels beside what they name, none over another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.text import Annotation, Text

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.plotting import style

_DIRECTIONS = np.array(
    [[1, 0], [1, 1], [1, -1], [0, 1], [0, -1], [-1, 1], [-1, -1], [-1, 0]], dtype=np.float64
)
_REACHES = np.array([1.0, 1.7, 2.8, 4.2, 6.0, 8.0])
_LEADER_FROM = 2.8
_LEAST_GAP = 2.0
_PADDING = 0.8
_SQUARE = 1.5
_OUTSIDE = 2


@dataclass(frozen=True, slots=True, eq=False)
class _Places:
    """Where a label could go: anchors (P, 2), boxes (P, 4) as x0, y0, x1, y1 [pixels] and reaches (P,)."""

    anchors: FloatArray
    boxes: FloatArray
    reaches: FloatArray


class Labels:
    """Places the labels of one pair of axes, first come, first served, where there is room.

    What is taken is a grid of small squares over the axes; its integral image sums it over boxes at once.
    """

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._scale = axes.figure.dpi / style.POINTS_PER_INCH
        width, height = np.ceil(np.asarray(axes.bbox.size) / _SQUARE).astype(np.int64)
        self._taken = np.zeros((width, height), dtype=np.bool_)

    def keep_clear(self, points: npt.ArrayLike, radius: float) -> None:
        """Keep labels off squares of half side `radius` [typographic points] around points (N, 2) in metres."""
        centres = self._axes.transData.transform(np.asarray(points, dtype=np.float64).reshape(-1, 2))
        reach = self._pixels(radius)
        self._take(np.hstack([centres - reach, centres + reach]))

    def place(
        self,
        text: str,
        at: npt.ArrayLike,
        *,
        gap: float = 4.0,
        size: float = style.SMALL_SIZE,
        colour: str = style.INK,
        bold: bool = False,
        must: bool = False,
    ) -> Annotation | None:
        """Write `text` beside a point (2,), or the best of points (A, 2) [m]; None where nothing is free.

        `gap` is the distance in typographic points, 0 centres the text on the point. With `must` it is
        written at the place that hides least. A label far from its point gets a thin leader.
        """
        label = self._write(text, style.text(size, bold=bold), colour)
        extent = Text.get_window_extent(label)
        anchors = self._axes.transData.transform(np.asarray(at, dtype=np.float64).reshape(-1, 2))
        places = self._places(anchors, np.array([extent.width, extent.height]), gap)
        hidden = self._hidden(places.boxes)
        best = int(np.argmin(hidden))
        if hidden[best] > 0 and not must:
            label.remove()
            return None
        self._put(label, places.anchors[best], places.boxes[best], float(places.reaches[best]))
        return label

    def _write(self, text: str, setting: style.TextSetting, colour: str) -> Annotation:
        return self._axes.annotate(
            text,
            (0.0, 0.0),
            xytext=(0.0, 0.0),
            textcoords="offset points",
            ha="left",
            va="bottom",
            color=colour,
            path_effects=style.halo(),
            annotation_clip=True,
            zorder=10.0,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": colour, "shrinkA": 1.0, "shrinkB": 2.0},
            **setting,
        )

    def _put(self, label: Annotation, anchor: FloatArray, box: FloatArray, reach: float) -> None:
        x, y = self._axes.transData.inverted().transform(anchor)
        label.xy = (float(x), float(y))
        dx, dy = (box[:2] - anchor) / self._pixels(1.0)
        label.set_position((float(dx), float(dy)))
        if label.arrow_patch is not None:
            label.arrow_patch.set_visible(reach >= _LEADER_FROM)
        self._take(box[None])

    def _pixels(self, points: float) -> float:
        return points * self._scale

    def _places(self, anchors: FloatArray, size: FloatArray, gap: float) -> _Places:
        away = _DIRECTIONS / np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)
        steps = self._pixels(max(gap, _LEAST_GAP)) * _REACHES[:, None, None, None] * away
        centres = (anchors[:, None] + 0.5 * size * _DIRECTIONS + steps).reshape(-1, 2)
        reaches = np.repeat(_REACHES, len(anchors) * len(_DIRECTIONS))
        origins = np.broadcast_to(anchors[None, :, None], (len(_REACHES), len(anchors), len(_DIRECTIONS), 2))
        if gap == 0.0:
            centres, reaches = np.concatenate([anchors, centres]), np.append(np.zeros(len(anchors)), reaches)
            origins = np.concatenate([anchors, origins.reshape(-1, 2)])
        boxes = np.hstack([centres - 0.5 * size, centres + 0.5 * size])
        return _Places(origins.reshape(-1, 2), boxes, reaches)

    def _take(self, boxes: FloatArray) -> None:
        for x0, y0, x1, y1 in self._squares(boxes)[1]:
            self._taken[x0:x1, y0:y1] = True

    def _hidden(self, boxes: FloatArray) -> IntArray:
        pad = self._pixels(_PADDING) * np.array([-1.0, -1.0, 1.0, 1.0])
        whole, inside = self._squares(boxes + pad)
        total = np.pad(self._taken.cumsum(axis=0, dtype=np.int64).cumsum(axis=1), ((1, 0), (1, 0)))
        x0, y0, x1, y1 = inside.T
        taken = total[x1, y1] - total[x0, y1] - total[x1, y0] + total[x0, y0]
        return np.asarray(taken + _OUTSIDE * (_areas(whole) - _areas(inside)))

    def _squares(self, boxes: FloatArray) -> tuple[IntArray, IntArray]:
        corner = np.tile(self._axes.bbox.min, 2)
        steps = (boxes - corner) / _SQUARE
        whole = np.hstack([np.floor(steps[:, :2]), np.ceil(steps[:, 2:])]).astype(np.int64)
        return whole, np.clip(whole, 0, np.tile(self._taken.shape, 2))


def _areas(boxes: IntArray) -> IntArray:
    return np.asarray((boxes[:, 2:] - boxes[:, :2]).prod(axis=1))
