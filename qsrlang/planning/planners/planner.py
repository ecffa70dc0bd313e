"""What every planner is given, and what it returns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.paths import DistanceField
from qsrlang.planning.world import Detection

PlannerName = Literal["random", "planes", "qsr", "belief", "nearest", "index", "rollout", "tour", "exact"]


@dataclass(frozen=True, slots=True, eq=False)
class Situation:
    """Where a robot is when it has to choose: its pose, the ways from there, candidates (N, 3) drawn for it at random.

    `seconds` are left.
    """

    drawn: FloatArray
    pose: Pose2
    field: DistanceField
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class Terms:
    """Why views are worth what they are: all (N,).

    `gains` p(v) is the chance to find a target by one look; `travel` [m], `turn` [rad] and `seconds` c(v), the look
    included, are what it costs to get there; `expected` [s] is the cost of the best plan that starts there, nan
    where the planner looks no further than one view.
    """

    gains: FloatArray
    travel: FloatArray
    turn: FloatArray
    seconds: FloatArray
    expected: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Which of the candidates (N, 3) was chosen, and the value (N,) of every candidate in `unit`.

    `tilt` [rad] is that of the camera for this look, None for its own.
    """

    candidates: FloatArray
    index: int
    values: FloatArray
    unit: str
    terms: Terms | None = None
    tilt: float | None = None

    def __post_init__(self) -> None:
        values = frozen_array("the values of the candidates", self.values, (len(self.candidates),))
        object.__setattr__(self, "values", values)
        if not 0 <= self.index < len(self.values):
            raise ValueRangeError("the chosen candidate", self.index, f"0 to {len(self.values) - 1}")


class Planner(Protocol):
    """A way to choose the next pose."""

    def choose(self, situation: Situation, rng: np.random.Generator) -> Choice:
        """Choose where to look from next."""

    def after_look(self, pose: Pose2, detections: Sequence[Detection], tilt: float | None = None) -> Planner:
        """Return the planner for the next step, now that a look from `pose` has shown `detections`."""

    def after_find(self, target: str) -> Planner:
        """Return the planner for the targets that are left once `target` is found."""

    def settles(self, detection: Detection) -> bool:
        """Return whether a report of a target is sure enough to end the search for it."""

    @property
    def absence(self) -> float:
        """The probability that nothing of what is sought is here, 0 for planners without a belief."""


class Forgetful:
    """A planner that looks teach nothing, and that takes every report for true, as in the paper."""

    __slots__ = ()

    def after_look(self, pose: Pose2, detections: Sequence[Detection], tilt: float | None = None) -> Planner:
        """Return the planner itself."""
        return self  # type: ignore[return-value]

    def after_find(self, target: str) -> Planner:
        """Return the planner itself."""
        return self  # type: ignore[return-value]

    def settles(self, detection: Detection) -> bool:
        """Return True."""
        return True

    @property
    def absence(self) -> float:
        """Return 0: it has no belief."""
        return 0.0
