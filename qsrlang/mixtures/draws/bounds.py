"""What bounds a draw to a convex part of its region, in each of many states: lines, and their inner sides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import few, unit
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.supports import Seat

Lines: TypeAlias = tuple[tuple[FloatArray, FloatArray], ...]


class Bound(Protocol):
    """A convex part of the plane that depends on the state."""

    def lines(self, layout: Layout, states: FloatArray) -> Lines:
        """Return its sides in each state (P, n): a point (P, 2) on each, and the normal to its inside (P, 2), or (1, 2)
        where that is the same in all.
        """


@dataclass(frozen=True, slots=True)
class Wedge:
    """Directions from an `apex`, over `width` < pi counter-clockwise from `start` [rad] past `turning`'s heading."""

    apex: Seat
    turning: Seat
    start: float
    width: float

    def lines(self, layout: Layout, states: FloatArray) -> Lines:
        """Return its two sides."""
        x, _ = layout.place(self.apex)
        points = states[:, x : x + 2]
        low = few(states[:, layout.pose(self.turning)[2]]) + self.start
        high = low + self.width
        sides = ((-np.sin(low), np.cos(low)), (np.sin(high), -np.cos(high)))
        return tuple((points, np.stack(side, axis=-1)) for side in sides)


@dataclass(frozen=True, slots=True)
class Near:
    """Up to a `share` of the way from an `apex` to the edge of a `holder`, and `slack` [m] more, in any direction.

    The holder's own box, of half length and half width `half` [m], shrunk about the apex: what is at
    r <= share x edge + slack along each direction lies inside.
    """

    apex: Seat
    holder: Seat
    half: tuple[float, float]
    share: float
    slack: float

    def lines(self, layout: Layout, states: FloatArray) -> Lines:
        """Return its four sides."""
        (x, _), (centre, _, heading) = layout.place(self.apex), layout.pose(self.holder)
        apex, middle = states[:, x : x + 2], states[:, centre : centre + 2]
        headings, found = few(states[:, heading]), []
        for turn in range(4):
            outwards = unit(headings + 0.5 * math.pi * turn)
            side = middle + self.half[turn % 2] * outwards
            reach = self.share * ((side - apex) * outwards).sum(axis=1) + self.slack
            found.append((apex + reach[:, None] * outwards, -outwards))
        return tuple(found)
