"""Where a polar density stands: the boxes it keeps apart, and the stands its relatum may take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Boxes:
    """Half lengths (along x) and half widths (along y) [m] of the referent, its relatum, and the second relatum.

    A relatum may be the support of the referent; only a ternary relation has a second one.
    """

    referent: tuple[float, float]
    relatum: tuple[float, float]
    relatum_supports: bool = False
    second: tuple[float, float] = (0.0, 0.0)

    @property
    def are_points(self) -> bool:
        """Whether none of them has a size, so that it does not matter how they are turned."""
        return not any((*self.referent, *self.relatum, *self.second))

    def contact(self, yaws: FloatArray, directions: FloatArray) -> FloatArray:
        """Return where the referent touches relata turned by `yaws` (P,), along directions (P, N): (P, N) [m]."""
        if self.relatum_supports:
            return np.zeros_like(directions)
        return self._contact(self.relatum, yaws, directions)

    def second_contact(self, yaws: FloatArray, directions: FloatArray) -> FloatArray:
        """Return how far from the second relatum, turned by `yaws` (P,), the referent touches it: (P, N) [m]."""
        return self._contact(self.second, yaws, directions)

    def _contact(self, other: tuple[float, float], yaws: FloatArray, directions: FloatArray) -> FloatArray:
        length, width = self.referent[0] + other[0], self.referent[1] + other[1]
        if length + width == 0.0:
            return np.zeros_like(directions)
        off = directions - yaws[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(1.0 / np.fmax(np.abs(np.cos(off)) / length, np.abs(np.sin(off)) / width))


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """P possible stands of the relatum: positions (P, 2), box headings (P,), axes (P, J), support poses (P, 3).

    `ends` (P, 2) tell of a second relatum how far away it is [m] and the heading of its box [rad].
    """

    positions: FloatArray
    yaws: FloatArray
    axes: FloatArray
    support_poses: FloatArray | None = None
    ends: FloatArray | None = None

    def at(self, chosen: BoolArray | IntArray | slice) -> Stance:
        """Return some of the stands."""
        poses = None if self.support_poses is None else self.support_poses[chosen]
        ends = None if self.ends is None else self.ends[chosen]
        return Stance(self.positions[chosen], self.yaws[chosen], self.axes[chosen], poses, ends)

    def distinct(self) -> tuple[IntArray, IntArray]:
        """Return the first of each kind of stand, and for every stand (P,) which of those it equals."""
        optional = [more for more in (self.support_poses, self.ends) if more is not None]
        columns = [self.positions, self.yaws[:, None], self.axes, *optional]
        _, first, which = np.unique(
            np.concatenate(columns, axis=1), axis=0, return_index=True, return_inverse=True
        )
        return first, which.ravel()


def half_box(width: float, depth: float) -> tuple[float, float]:
    """Return (half length, half width) of a box in its own frame, x to the front [m]."""
    return 0.5 * depth, 0.5 * width
