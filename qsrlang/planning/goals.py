"""Goals: what is sought, where it is believed to be, and how the camera would show it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.atlas import Atlas
from qsrlang.planning.belief import Belief
from qsrlang.planning.detecting import Detector
from qsrlang.planning.repeats import INDEPENDENT, PastLook, Repeats, discounted
from qsrlang.planning.sight import Sight
from qsrlang.planning.views import Views
from qsrlang.planning.world import Detection

_NEAR = 3.0
"""A report is true where the target is within this many spreads of it."""


class Recall(Protocol):
    """What is known of a target's place once other things have been seen."""

    def weights(self, seen: Sequence[Detection]) -> FloatArray | None:
        """Return new weights (K,) of the places, or None where the things seen change nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """A target: the belief of its place, how the camera sees it, and what was seen of it so far.

    `floor` is the share of the prior that is even over all places, whatever is known. `atlas` holds the views
    made beforehand, None where candidates are only drawn.
    """

    target: str
    belief: Belief
    sight: Sight
    detector: Detector
    floor: float = 0.0
    atlas: Atlas | None = None
    recall: Recall | None = None
    repeats: Repeats = INDEPENDENT
    looks: tuple[PastLook, ...] = ()
    seen: tuple[Detection, ...] = ()

    def views_from(self, poses: FloatArray) -> Views:
        """Return what looks from poses (N, 3) would show of this target, given the looks before them."""
        return discounted(
            self.sight.views(poses, self.belief.points_map, self.detector), self.looks, self.repeats
        )

    def atlas_views(self, views: IntArray) -> Views:
        """Return some of the views of the atlas, given the looks before them."""
        assert self.atlas is not None
        return discounted(self.atlas.views.take(views), self.looks, self.repeats)

    def after_look(self, pose: Pose2, detections: Sequence[Detection], tilt: float | None = None) -> Goal:
        """Return the goal after a look: the target reported, or missed, and other things seen."""
        place = np.array([pose.x, pose.y, pose.yaw])
        tilts = None if tilt is None else np.array([tilt])
        views = self.sight.views(place[None], self.belief.points_map, self.detector, tilts)
        rates = discounted(views, self.looks, self.repeats).row(0)
        reported = next((one for one in detections if one.kind == self.target), None)
        if reported is not None:
            belief = self.belief.after_detection(rates, reported.position, self.detector)
            return self._recalled(replace(self, belief=belief), detections)
        looks = (*self.looks, PastLook(place, views.row(0)))
        return self._recalled(replace(self, belief=self.belief.after_miss(rates), looks=looks), detections)

    def settles(self, detection: Detection) -> bool:
        """Return whether the target is where it is reported with the confidence its detector asks for."""
        if self.detector.false_alarms == 0.0:
            return True
        return self.belief.near(detection.position, _NEAR * self.detector.spread) >= self.detector.confidence

    def _recalled(self, goal: Goal, detections: Sequence[Detection]) -> Goal:
        known = {one.name for one in self.seen}
        fresh = tuple(one for one in detections if one.kind != self.target and one.name not in known)
        if self.recall is None or not fresh:
            return goal
        seen = (*self.seen, *fresh)
        weights = self.recall.weights(seen)
        belief = goal.belief if weights is None else goal.belief.with_weights(weights, self.floor)
        return replace(goal, belief=belief, seen=seen)
