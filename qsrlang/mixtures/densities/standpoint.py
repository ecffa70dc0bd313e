"""Where axes and boxes come from, given the stacked state of everything placed before."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import MissingFacingError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Frame


@dataclass(frozen=True, slots=True)
class Anchor:
    """A placed object: the first of the columns of its place, and that of its heading, which its root landmark gives.

    `heading` is None where the root landmark has none.
    """

    start: int
    heading: int | None
    root: str

    def positions(self, states: FloatArray) -> FloatArray:
        """Return where the object is in each state (P, n): (P, 2) [m]."""
        return states[:, self.start : self.start + 2]

    def turning_axes(
        self, frames: tuple[Frame, ...], viewer: Pose2 | None, heading: float, is_certain: bool
    ) -> tuple[float, ...] | None:
        """Return the axes of frames less the heading [rad] of this relatum; None where they depend on more than that.

        Where the heading is certain, the absolute axis is the same in every state too.
        """
        if self.heading is None or (viewer is not None and Frame.RELATIVE in frames):
            return None
        if Frame.ABSOLUTE in frames and not is_certain:
            return None
        return tuple(0.5 * np.pi - heading if one is Frame.ABSOLUTE else np.pi for one in frames)

    def poses(self, states: FloatArray) -> FloatArray:
        """Return position and heading of the object in each state (P, n): (P, 3) [m, m, rad]."""
        if self.heading is None:
            raise MissingFacingError(self.root, "the outline of a support")
        return np.concatenate([self.positions(states), states[:, [self.heading]]], axis=1)


@dataclass(frozen=True, slots=True)
class Standpoint:
    """The relatum, perhaps a second one, the viewer, and what carries the referent."""

    relatum: Anchor
    second: Anchor | None = None
    viewer: Pose2 | None = None
    support: Anchor | None = None

    def axes(self, states: FloatArray, frame: Frame) -> FloatArray:
        """Return the reference axis (P,) of a frame [rad]: away from the viewer; along +y where it is absolute.

        With a second relatum the axis runs to that, whatever the frame. Raises MissingFacingError.
        """
        if self.second is not None:
            return _directions(self._offsets(states))
        if frame is Frame.ABSOLUTE:
            return np.full(len(states), 0.5 * np.pi)
        if frame is Frame.RELATIVE and self.viewer is not None:
            return _directions(self.relatum.positions(states) - self.viewer.position)
        if self.relatum.heading is None:
            raise MissingFacingError(self.relatum.root, f"the {frame.value} frame (no viewer is given)")
        return states[:, self.relatum.heading] + np.pi

    def box_yaws(self, states: FloatArray) -> FloatArray:
        """Return the heading (P,) of the boxes [rad]: the relatum's; else against the axis of the relative frame.

        Raises MissingFacingError.
        """
        if self.relatum.heading is not None:
            return states[:, self.relatum.heading]
        if self.viewer is None and self.second is None:
            raise MissingFacingError(self.relatum.root, "the outline of its box (no viewer is given)")
        return self.axes(states, Frame.RELATIVE) + np.pi

    def ends(self, states: FloatArray) -> FloatArray | None:
        """Return the distance [m] to the second relatum and the heading of its box [rad]: (P, 2)."""
        if self.second is None:
            return None
        offsets = self._offsets(states)
        return np.stack([np.hypot(*offsets.T), self.turned().box_yaws(states)], axis=-1)

    def turned(self) -> Standpoint:
        """Return the standpoint with the two relata exchanged."""
        assert self.second is not None
        return replace(self, relatum=self.second, second=self.relatum)

    def _offsets(self, states: FloatArray) -> FloatArray:
        assert self.second is not None
        return self.second.positions(states) - self.relatum.positions(states)


def _directions(offsets: FloatArray) -> FloatArray:
    return np.asarray(np.arctan2(offsets[:, 1], offsets[:, 0]))
