"""A wedge of directions from a thing, in each of many states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.supports import Seat


@dataclass(frozen=True, slots=True)
class Wedge:
    """Directions from an `apex`, over `width` < pi counter-clockwise from `start` [rad] past `turning`'s heading."""

    apex: Seat
    turning: Seat
    start: float
    width: float

    def lines(self, layout: Layout, states: FloatArray) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """Return its two sides in each state (P, n): a point (P, 2) on each, and the normal (P, 2) to its inside."""
        x, _ = layout.place(self.apex)
        points = states[:, x : x + 2]
        low = states[:, layout.pose(self.turning)[2]] + self.start
        high = low + self.width
        sides = ((-np.sin(low), np.cos(low)), (np.sin(high), -np.cos(high)))
        return tuple((points, np.stack(side, axis=-1)) for side in sides)
