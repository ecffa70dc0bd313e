"""What a search did, step by step: values with everything that a picture or a table needs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.planners.planner import Terms
from qsrlang.planning.world import Detection

MAX_COUNT = 1_000_000

Ending = Literal["found", "time", "looks", "absent", "stuck"]
"""Why a search ended: found, out of time or looks, probably not here, or nowhere left to go."""


@dataclass(frozen=True, slots=True)
class Limits:
    """When a search gives up: time [s], poses looked from, and how many candidates are drawn for each.

    It ends too where the probability that nothing of what is sought is here reaches `absence`.
    """

    seconds: float = 120.0
    poses: int = 20
    candidates: int = 20
    absence: float = 0.95

    def __post_init__(self) -> None:
        if not 0.0 < self.seconds < math.inf:
            raise ValueRangeError("the time limit of a search", self.seconds, "a positive number of seconds")
        for what, value in (("pose limit", self.poses), ("number of candidates", self.candidates)):
            if not 1 <= value <= MAX_COUNT:
                raise ValueRangeError(f"the {what} of a search", value, f"1 to {MAX_COUNT}")
        if not 0.0 < self.absence <= 1.0:
            raise ValueRangeError("the absence that ends a search", self.absence, "above 0 and at most 1")


@dataclass(frozen=True, slots=True, eq=False)
class SearchStep:
    """One turn of the monitor: choose a pose, drive there, look.

    Candidates (N, 3), x, y [m] and yaw [rad], and the path (L, 2) [m] are in the map frame; `values` (N,) is what
    the planner thought each candidate worth. Travel [m], turn [rad] and seconds are of this step, `clock` is the
    time since the search began [s]. `wanted` are the classes that were still sought. `looked` is False where the time
    ran out before the look was over. `reached` is where the robot came to stand: where something was in its way, not
    the end of the path. `terms` say why views are worth their values in `unit`; `absence` is the probability, after
    the look, that nothing sought is here.
    """

    number: int
    origin: Pose2
    candidates: FloatArray
    values: FloatArray
    chosen: int
    path: FloatArray
    travel: float
    turn: float
    seconds: float
    clock: float
    looked: bool
    detections: tuple[Detection, ...]
    reached: Pose2
    unit: str = ""
    terms: Terms | None = None
    absence: float = 0.0
    tilt: float | None = None
    wanted: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        candidates = frozen_array("the candidates of a step", self.candidates, (None, 3))
        object.__setattr__(self, "candidates", candidates)
        object.__setattr__(self, "values", frozen_array("their values", self.values, (len(candidates),)))
        object.__setattr__(self, "path", frozen_array("the path of a step", self.path, (None, 2)))
        if not 0 <= self.chosen < len(candidates):
            raise ValueRangeError("the chosen candidate", self.chosen, f"0 to {len(candidates) - 1}")

    @property
    def pose(self) -> Pose2:
        """The pose that was chosen."""
        x, y, yaw = self.candidates[self.chosen]
        return Pose2(float(x), float(y), float(yaw))

    @property
    def value(self) -> float:
        """The value of the pose that was chosen."""
        return float(self.values[self.chosen])

    @property
    def runner_up(self) -> int | None:
        """The most valuable candidate but the chosen one, None where there is no other."""
        return next((index for index in self.ranking if index != self.chosen), None)

    @property
    def ranking(self) -> tuple[int, ...]:
        """The candidates from the most to the least valuable, the first drawn first among equals."""
        return tuple(int(index) for index in np.argsort(-self.values, kind="stable"))


@dataclass(frozen=True, slots=True, eq=False)
class SearchResult:
    """What became of a search: `seconds` is the time of the find, or the time at which the search gave up.

    `poses` counts the looks, `travel` is the path driven, a last drive that ran out of time whole [m];
    `detection` is the object found last, `finds` are all, one for each target. `absence` is the probability that what
    was not found is not here.
    """

    target: str
    found: bool
    seconds: float
    poses: int
    travel: float
    steps: tuple[SearchStep, ...]
    detection: Detection | None
    finds: tuple[Detection, ...] = ()
    ending: Ending = "found"
    absence: float = 0.0

    @property
    def verdict(self) -> str:
        """How it ended, in words."""
        return {
            "found": "found",
            "time": "not found: the time ran out",
            "looks": "not found: no look is left",
            "absent": f"probably not here: {self.absence:.2f}",
            "stuck": "not found: there is nowhere left to go",
        }[self.ending]

    def __post_init__(self) -> None:
        if self.found != (self.detection is not None):
            raise ValueRangeError(
                "the outcome of a search", self.found, "a detection exactly where one was found"
            )
