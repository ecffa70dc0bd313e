"""How what is known grows with what was seen: one curve for each thing learned."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.plotting import style
from qsrlang.plotting.canvas import new_figure

_WIDTH, _HEIGHT = 5.6, 3.4
_BOX = (0.095, 0.13, 0.64, 0.83)
_NAME_STEP = 0.062
_NAME_SIZE = 7.0


def draw_learning_curves(
    amounts: npt.ArrayLike, gains: Mapping[str, npt.ArrayLike], amount: str, gain: str
) -> Figure:
    """Return one curve of gains (K,) over amounts (K,) for each name, its name at its end; the last one is bold.

    `amount` and `gain` name the two axes. Raises ValueRangeError where there is no curve or a length differs.
    """
    x = np.asarray(amounts, dtype=np.float64)
    curves = {name: _curve(name, values, len(x)) for name, values in gains.items()}
    if not curves or len(x) < 2:
        raise ValueRangeError("the number of curves and points", (len(curves), len(x)), "at least (1, 2)")
    figure = new_figure(_WIDTH, _HEIGHT)
    axes = figure.add_axes(_BOX)
    style.dress(axes)
    style.label_axes(axes, amount, gain)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    low = min(0.0, *(float(curve.min()) for curve in curves.values()))
    high = max(float(curve.max()) for curve in curves.values())
    axes.set(xlim=(x[0], x[-1]), ylim=(low - 0.03 * (high - low), high + 0.03 * (high - low)))
    axes.set_xticks(x)
    axes.axhline(0.0, color=style.INK, lw=0.6)
    places = _spread({name: float(curve[-1]) for name, curve in curves.items()}, _NAME_STEP * (high - low))
    for (name, curve), colour in zip(curves.items(), cycle(style.PARTS)):
        bold = name == list(curves)[-1]
        shade = style.INK if bold else colour
        axes.plot(x, curve, color=shade, lw=2.4 if bold else 1.2, clip_on=False, gid=name)
        axes.text(1.02 * x[-1], places[name], name, fontsize=_NAME_SIZE, va="center", color=shade)
    return figure


def _curve(name: str, values: npt.ArrayLike, length: int) -> FloatArray:
    curve = np.asarray(values, dtype=np.float64)
    if curve.shape != (length,) or not np.isfinite(curve).all():
        raise ValueRangeError(f"the curve '{name}'", curve.shape, f"{length} finite numbers")
    return curve


def _spread(heights: Mapping[str, float], step: float) -> dict[str, float]:
    """Return heights for names, in the order of their curves' ends and at least a step apart."""
    placed: dict[str, float] = {}
    at = -np.inf
    for name, height in sorted(heights.items(), key=lambda item: item[1]):
        at = max(height, at + step)
        placed[name] = at
    return placed
