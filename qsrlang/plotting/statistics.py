"""How soon the object is found: the share of trials found by each time, per arm."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.plotting import style
from qsrlang.plotting.canvas import new_figure

CONFIDENCE = 0.95

_WIDTH, _HEIGHT = 5.6, 3.0
_BOX = (0.085, 0.145, 0.645, 0.815)
_LABEL_STEP = 0.055
_NOTE_SIZE = 6.0


def draw_found_by_time(times_by_arm: Mapping[str, npt.ArrayLike], limit: float) -> Figure:
    """Return step curves of P(found by t) for each arm, its name and number of trials at the curve's end.

    `times_by_arm` holds for each arm the seconds to the find (trials,), inf where nothing was found; `limit`
    is the time limit [s]. The bands hold the whole curve with 95 % confidence, their half width is
    sqrt(ln(2 / 0.05) / (2 n)) (Dvoretzky, Kiefer and Wolfowitz 1956, with the constant of Massart 1990).
    Raises ValueRangeError where no arm or no trial is given, or a time is negative or not a number.
    """
    if not 0.0 < limit < np.inf:
        raise ValueRangeError("the time limit of a picture", limit, "a positive number of seconds")
    arms = {arm: _times(arm, times) for arm, times in times_by_arm.items()}
    if not arms:
        raise ValueRangeError("the number of arms in a picture", 0, "at least 1")
    figure = new_figure(_WIDTH, _HEIGHT)
    axes = figure.add_axes(_BOX)
    axes.set(xlim=(0.0, limit), ylim=(0.0, 1.0), autoscale_on=False)
    style.dress(axes)
    style.label_axes(axes, "time t [s]", "found by time t [% of trials]")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=""))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    colours = dict(zip(arms, cycle(style.PARTS), strict=False))
    curves = {
        arm: (_add_curve(axes, times, limit, colours[arm]), colours[arm]) for arm, times in arms.items()
    }
    _add_names(axes, arms, curves)
    _add_note(figure, "bands: 95 % confidence, whole curve")
    return figure


def _times(arm: str, times: npt.ArrayLike) -> FloatArray:
    array = np.asarray(times, dtype=np.float64)
    if array.ndim != 1 or not len(array) or np.isnan(array).any() or (array < 0.0).any():
        raise ValueRangeError(
            f"the times of arm '{arm}'", array.tolist(), "at least one time of at least 0 s"
        )
    return np.sort(array)


def _add_curve(axes: Axes, times: FloatArray, limit: float, colour: str) -> float:
    found = times[times <= limit]
    t = np.concatenate([[0.0], found, [limit]])
    share = np.concatenate([[0.0], np.arange(1, len(found) + 1), [len(found)]]) / len(times)
    half = np.sqrt(np.log(2.0 / (1.0 - CONFIDENCE)) / (2.0 * len(times)))
    low, high = np.maximum(share - half, 0.0), np.minimum(share + half, 1.0)
    axes.fill_between(t, low, high, step="post", color=colour, alpha=0.12, linewidth=0.0)
    axes.plot(
        t, share, drawstyle="steps-post", color=colour, linewidth=1.5, clip_on=False, solid_joinstyle="miter"
    )
    return float(share[-1])


def _add_names(axes: Axes, arms: Mapping[str, FloatArray], curves: Mapping[str, tuple[float, str]]) -> None:
    order = sorted(curves, key=lambda arm: curves[arm][0])
    heights = spread(np.array([curves[arm][0] for arm in order]), _LABEL_STEP)
    for arm, height in zip(order, heights, strict=True):
        end, colour = curves[arm]
        label = axes.annotate(
            f"{arm}  {100.0 * end:.3g} % of {len(arms[arm])}",
            (1.0, height),
            xycoords="axes fraction",
            xytext=(5.0, 0.0),
            textcoords="offset points",
            va="center",
            color=colour,
            **style.text(style.SMALL_SIZE),
        )
        label.set_gid("arm")


def spread(heights: FloatArray, step: float, highest: float = 1.0) -> FloatArray:
    """Return ascending heights (N,) moved apart to `step` and down to `highest`, no more than needed.

    Least squares under the order: pool adjacent violators on heights less their rank times `step`.
    """
    ranks = step * np.arange(len(heights))
    blocks: list[list[float]] = []
    for value in heights - ranks:
        blocks.append([float(value), 1.0])
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            mean, count = blocks.pop()
            below = blocks[-1]
            blocks[-1] = [(below[0] * below[1] + mean * count) / (below[1] + count), below[1] + count]
    pooled = np.repeat([mean for mean, _ in blocks], [int(count) for _, count in blocks])
    return np.asarray(np.minimum(pooled, highest - ranks[-1]) + ranks)


def _add_note(figure: Figure, note: str) -> None:
    figure.text(0.99, 0.02, note, ha="right", va="bottom", color=style.MUTED, **style.text(_NOTE_SIZE))
