"""The columns of a world's state: what is placed where in one vector."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.mixtures.densities.standpoint import Anchor
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import Landmark

NOTHING = 0


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Where each thing's columns start: x, y and heading of a landmark, x and y of an object; column 0 is always 0.

    `mean` and `variance` (n,) are what is known before any step, that of landmarks; of objects, whose columns are
    `open` (n,), nothing is. Columns (n,) that are not certain are `free`.
    """

    starts: Mapping[str, int]
    mean: FloatArray
    variance: FloatArray
    open: BoolArray
    free: BoolArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "free", self.open | (self.variance > 0.0))

    @classmethod
    def of(cls, landmarks: Sequence[Landmark], placed: Sequence[str]) -> Layout:
        """Return the layout of landmarks, then of objects in the order they are placed."""
        starts = {landmark.name: 1 + 3 * at for at, landmark in enumerate(landmarks)}
        first = 1 + 3 * len(landmarks)
        starts |= {name: first + 2 * at for at, name in enumerate(placed)}
        mean, variance = np.zeros((2, first + 2 * len(placed)))
        for landmark in landmarks:
            at = starts[landmark.name]
            mean[at : at + 3] = landmark.x, landmark.y, landmark.heading or 0.0
            variance[at : at + 3] = np.square(landmark.deviation)
        return cls(starts, mean, variance, np.arange(len(mean)) >= first)

    @property
    def size(self) -> int:
        """The number of columns."""
        return len(self.mean)

    def place(self, seat: Seat) -> tuple[int, int]:
        """Return the columns of x and y of a thing."""
        start = self.starts[seat.block]
        return start, start + 1

    def pose(self, seat: Seat) -> tuple[int, int, int]:
        """Return the columns of x, y and heading of a thing, which has the heading of the landmark it hangs on."""
        heading = NOTHING if seat.root.heading is None else self.starts[seat.root.name] + 2
        return (*self.place(seat), heading)

    def anchor(self, seat: Seat) -> Anchor:
        """Return where to find a thing in states that have all columns."""
        start, *_, heading = self.pose(seat)
        return Anchor(start, heading or None, seat.root.name)


def compact_anchor(seats: tuple[Seat, ...], seat: Seat) -> Anchor:
    """Return where to find a thing in states that have three columns for each of some seats."""
    start = 3 * seats.index(seat)
    return Anchor(start, None if seat.root.heading is None else start + 2, seat.root.name)
