"""The view cones of the candidates of a step, coloured by value, the chosen one bold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.patches import Polygon

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.planning.outcome import SearchStep
from qsrlang.plotting import layers, style
from qsrlang.plotting.labels import Labels
from qsrlang.plotting.outlines import blind_edges, cone_outlines

MAX_VIEWS = 40
"""Of more candidates than this only the most valuable are drawn, and the caption says so."""

_APEX = 2.6
_PLAIN_SHADE = 0.45


@dataclass(frozen=True, slots=True, eq=False)
class Views:
    """The views of a step: outlines (N, K, 2) [m], shades (N,) from 0 to 1, `blind` lines (L, 2, 2).

    `others` (at most MAX_VIEWS) are those to draw besides the chosen one, the best last.
    """

    step: SearchStep
    outlines: FloatArray
    blind: FloatArray
    scale: Normalize
    shades: FloatArray
    others: IntArray

    @classmethod
    def of(cls, step: SearchStep, cone: ViewCone) -> Views:
        """Return the views of a step; values that are all the same get one plain colour."""
        scale = Normalize(float(min(0.0, step.values.min())), float(step.values.max()) or 1.0)
        same = bool(np.ptp(step.values) == 0.0)
        others = [index for index in step.ranking[:MAX_VIEWS] if index != step.chosen][::-1]
        return cls(
            step=step,
            outlines=cone_outlines(cone, step.candidates),
            blind=blind_edges(cone, step.pose),
            scale=scale,
            shades=np.full(len(step.values), _PLAIN_SHADE) if same else np.asarray(scale(step.values)),
            others=np.array(others, dtype=np.int64),
        )

    @property
    def colours(self) -> FloatArray:
        """The colour of each view (N, 4)."""
        return np.asarray(style.VALUE_COLOURS(self.shades))


def add_views(axes: Axes, views: Views) -> None:
    """Draw the outlines of the views, a dot where the robot would stand, and the chosen view on top."""
    others = views.others
    widths = 0.7 + 0.6 * views.shades[others]
    layers.add_outlines(axes, views.outlines[others], views.colours[others], widths)
    if not len(views.blind):
        x, y = views.step.candidates[others, :2].T
        axes.scatter(x, y, s=_APEX**2, c=views.colours[others], linewidths=0.0, zorder=3.1, gid="apexes")
    _add_chosen(axes, views)


def write_value(labels: Labels, views: Views, index: int, *, bold: bool) -> None:
    """Write the value of one view at a corner of its outline, if there is room."""
    value = value_text(float(views.step.values[index]))
    labels.place(value, views.outlines[index], gap=2.5, colour=style.ROBOT, bold=bold)


def value_text(value: float) -> str:
    """Return a value with the digits a reader can use: three, or all before the point."""
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def _add_chosen(axes: Axes, views: Views) -> None:
    chosen = views.step.chosen
    shape = Polygon(views.outlines[chosen], closed=True, joinstyle="round", zorder=4.0)
    shape.set(facecolor=(*views.colours[chosen, :3], 0.15), edgecolor=style.ROBOT, linewidth=2.2)
    shape.set(gid="chosen-view")
    axes.add_patch(shape)
    edges = LineCollection(list(views.blind), colors=style.ROBOT, linewidths=0.8, zorder=4.0)
    axes.add_collection(edges, autolim=False)
