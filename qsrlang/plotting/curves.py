"""Curves of one measure against another, each named at its end."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.plotting import style
from qsrlang.plotting.canvas import new_figure
from qsrlang.plotting.statistics import spread

Curve = tuple[npt.ArrayLike, npt.ArrayLike]

_WIDTH, _HEIGHT = 5.6, 3.0
_BOX = (0.1, 0.155, 0.62, 0.8)
_LABEL_STEP = 0.06


def draw_curves(
    curves: Mapping[str, Curve],
    x_label: str,
    y_label: str,
    *,
    log: bool = False,
    limit: float | None = None,
    lowest: float = 0.0,
    bold: str | None = None,
) -> Figure:
    """Return lines y(x), each a pair of arrays (N,) with its name at its end; `log` scales both axes by tens.

    `limit` ends the x axis; without `log` the y axis starts at `lowest`; the curve named `bold` stands out. Raises
    ValueRangeError where no curve is given, or one has no points or not as many y as x.
    """
    if not curves:
        raise ValueRangeError("the number of curves in a picture", 0, "at least 1")
    lines = {name: _line(name, curve) for name, curve in curves.items()}
    figure = new_figure(_WIDTH, _HEIGHT)
    axes = figure.add_axes(_BOX)
    style.dress(axes)
    style.label_axes(axes, x_label, y_label)
    if log:
        axes.set(xscale="log", yscale="log")
    colours = dict(zip(lines, cycle(style.PARTS), strict=False))
    if bold is not None:
        colours[bold] = style.INK
    for name, (x, y) in lines.items():
        mark, width = "o" if len(x) <= 12 else "", 3.0 if name == bold else 1.5
        axes.plot(x, y, color=colours[name], linewidth=width, marker=mark, markersize=3.0, gid="curve")
    if limit is not None:
        axes.set_xlim(0.0, limit)
    if not log:
        axes.set_ylim(bottom=lowest)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    _name_ends(axes, lines, colours)
    return figure


def _line(name: str, curve: Curve) -> tuple[FloatArray, FloatArray]:
    x = frozen_array(f"the curve '{name}'", curve[0], (None,))
    y = frozen_array(f"the curve '{name}'", curve[1], (len(x),))
    if len(x) == 0:
        raise ValueRangeError(f"the number of points of the curve '{name}'", 0, "at least 1")
    return x, y


def _name_ends(
    axes: Axes, lines: Mapping[str, tuple[FloatArray, FloatArray]], colours: Mapping[str, str]
) -> None:
    ends = {name: _end_height(axes, *line) for name, line in lines.items()}
    order = sorted(ends, key=lambda name: ends[name])
    heights = spread(np.array([ends[name] for name in order]), _LABEL_STEP)
    for name, height in zip(order, heights, strict=True):
        label = axes.annotate(
            name,
            (1.0, height),
            xycoords="axes fraction",
            xytext=(5.0, 0.0),
            textcoords="offset points",
            va="center",
            color=colours[name],
            **style.text(style.SMALL_SIZE),
        )
        label.set_gid("name")


def _end_height(axes: Axes, x: FloatArray, y: FloatArray) -> float:
    """Return how high the curve is where it leaves the axes, from 0 at the bottom to 1 at the top."""
    inside = np.flatnonzero(x <= axes.get_xlim()[1])
    last = int(inside[-1]) if len(inside) else 0
    place = axes.transData.transform((float(x[last]), float(y[last])))
    return float(np.clip(axes.transAxes.inverted().transform(place)[1], 0.0, 1.0))
