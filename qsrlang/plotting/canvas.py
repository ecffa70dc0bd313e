"""Where pictures live: a figure with one plane of the right size, and the file it is saved to."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Figure

from qsrlang.arrays import FloatArray
from qsrlang.errors import FileError, ValueRangeError
from qsrlang.files import write_whole
from qsrlang.plotting import style

SUFFIXES = (".pdf", ".png", ".svg")
MAX_EXTENT = 1e5
"""The longest side of a picture's ground [m]."""

_LEFT, _BOTTOM, _TOP, _RIGHT = 0.50, 0.45, 0.12, 0.12
_CAPTION_LINE = 0.17
_BAR_COLUMN = 0.80
_BAR_WIDTH, _BAR_HEIGHT, _BAR_GAP = 0.11, 1.15, 0.50
_HEIGHT_LIMIT = 7.2
_LONGEST_ASPECT = 5.0
_CAPTION_WIDTH = 5.0
_WRITING: dict[str, dict[str, Any]] = {
    ".pdf": {"metadata": {"CreationDate": None}},
    ".png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 4}},
    ".svg": {"metadata": {"Date": None}},
}


@dataclass(frozen=True, slots=True)
class Ground:
    """The rectangle of the plane a picture shows [m]."""

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @classmethod
    def around(cls, points: FloatArray, margin: float) -> Ground:
        """Return the box around points (N, 2) with a margin [m], no side below a fifth of the other."""
        low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
        side = high - low
        half = 0.5 * np.maximum(side, side.max() / _LONGEST_ASPECT)
        middle = 0.5 * (low + high)
        (x0, y0), (x1, y1) = middle - half, middle + half
        return cls(float(x0), float(x1), float(y0), float(y1))

    def __post_init__(self) -> None:
        expected = f"above 0 and at most {MAX_EXTENT:g} m"
        for side in (self.x_max - self.x_min, self.y_max - self.y_min):
            if not 0.0 < side <= MAX_EXTENT:
                raise ValueRangeError("a side of the ground of a picture", side, expected)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty white figure [inches] with its own canvas, outside any global state."""
    figure = Figure(figsize=(width, height), dpi=style.DOTS_PER_INCH, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def plane_figure(ground: Ground, *, frame: str, caption_lines: int = 0, bars: int = 0) -> tuple[Figure, Axes]:
    """Return a figure and axes in metres, of equal aspect, with room for caption lines and colour bars."""
    right = _BAR_COLUMN if bars else _RIGHT
    top = _TOP + _CAPTION_LINE * caption_lines
    wide, high = ground.x_max - ground.x_min, ground.y_max - ground.y_min
    scale = min((style.FIGURE_WIDTH - _LEFT - right) / wide, _HEIGHT_LIMIT / high)
    height = max(scale * high, bars * (_BAR_HEIGHT + _BAR_GAP))
    least = _CAPTION_WIDTH if caption_lines else 0.0
    size = np.array([max(_LEFT + scale * wide + right, least), _BOTTOM + height + top])
    figure = new_figure(*size)
    lower = _BOTTOM + height - scale * high
    axes = figure.add_axes((_LEFT / size[0], lower / size[1], scale * wide / size[0], scale * high / size[1]))
    axes.set(xlim=(ground.x_min, ground.x_max), ylim=(ground.y_min, ground.y_max), autoscale_on=False)
    axes.set_aspect("equal", adjustable="box")
    style.dress(axes)
    style.label_axes(axes, f"x in the {frame} frame [m]", f"y in the {frame} frame [m]")
    style.add_scale_bar(axes)
    return figure, axes


def bar_box(figure: Figure, axes: Axes, number: int) -> tuple[float, float, float, float]:
    """Return the place of the colour bar `number` (0 at the top) right of the axes, in figure shares."""
    width, height = figure.get_size_inches()
    position = axes.get_position()
    top = position.y1 - (0.20 + number * (_BAR_HEIGHT + _BAR_GAP)) / height
    return (position.x1 + 0.12 / width, top - _BAR_HEIGHT / height, _BAR_WIDTH / width, _BAR_HEIGHT / height)


def save_figure(figure: Figure, path: Path | str) -> Path:
    """Write the figure whole or not at all, as .png, .svg or .pdf by the suffix, and return its path.

    Raises FileError where the suffix is another one or the place cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        remedy = f"end the name in {', '.join(SUFFIXES)}"
        raise FileError(path, "pictures are not written in this format", remedy)
    drawn = BytesIO()
    figure.savefig(drawn, format=suffix[1:], **_WRITING[suffix])
    write_whole(path, drawn.getvalue())
    return path
