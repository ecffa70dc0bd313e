"""Labels beside what they name, none over another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from qsrlang.arrays import FloatArray
from qsrlang.plotting import style

_DIRECTIONS = np.array(
    [[1, 0], [1, 1], [1, -1], [0, 1], [0, -1], [-1, 1], [-1, -1], [-1, 0]], dtype=np.float64
)
_REACHES = np.array([1.0, 1.7, 2.8, 4.2, 6.0, 8.0])
_LEADER_FROM = 2.8
_LEAST_GAP = 2.0
_PADDING = 1.5


@dataclass(frozen=True, slots=True, eq=False)
class _Places:
    """Where a label could go: anchors (P, 2), boxes (P, 4) as x0, y0, x1, y1 [pixels] and reaches (P,)."""

    anchors: FloatArray
    boxes: FloatArray
    reaches: FloatArray


class Labels:
    """Places the labels of one pair of axes, first come, first served, where there is room."""

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._scale = axes.figure.dpi / style.POINTS_PER_INCH
        self._taken = np.zeros((0, 4))

    def keep_clear(self, points: npt.ArrayLike, radius: float) -> None:
        """Keep labels off discs of `radius` [typographic points] around points (N, 2) in metres."""
        centres = self._axes.transData.transform(np.asarray(points, dtype=np.float64).reshape(-1, 2))
        reach = self._pixels(radius)
        self._taken = np.concatenate([self._taken, np.hstack([centres - reach, centres + reach])])

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
        extent = label.get_window_extent()
        anchors = self._axes.transData.transform(np.asarray(at, dtype=np.float64).reshape(-1, 2))
        places = self._places(anchors, np.array([extent.width, extent.height]), gap)
        hidden = self._hidden(places.boxes)
        best = int(np.argmin(hidden))
        if hidden[best] > 0.0 and not must:
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
        self._taken = np.concatenate([self._taken, box[None]])

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

    def _hidden(self, boxes: FloatArray) -> FloatArray:
        pad = self._pixels(_PADDING) * np.array([-1.0, -1.0, 1.0, 1.0])
        padded, frame = boxes + pad, self._axes.bbox
        out = np.stack(
            [
                frame.x0 - padded[:, 0],
                frame.y0 - padded[:, 1],
                padded[:, 2] - frame.x1,
                padded[:, 3] - frame.y1,
            ]
        )
        overlap = np.minimum(padded[:, None, 2:], self._taken[:, 2:]) - np.maximum(
            padded[:, None, :2], self._taken[:, :2]
        )
        area = np.maximum(overlap, 0.0).prod(axis=-1).sum(axis=-1)
        return np.asarray(area + np.maximum(out, 0.0).sum(axis=0) * (boxes[:, 3] - boxes[:, 1]))
