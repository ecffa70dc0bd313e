"""Goals of an arm: the belief its robot starts with, its camera in the mapped place, and the views it can take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnplaceableError
from qsrlang.experiments.places import Place
from qsrlang.experiments.presets import PlannerEntry
from qsrlang.experiments.scenarios import Arm, Scenario
from qsrlang.maps.supports import Supports
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.loading import load
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.planning.atlas import Atlas
from qsrlang.planning.belief import Belief, voxel_weights
from qsrlang.planning.frusta import POINT, Extent
from qsrlang.planning.goals import Goal
from qsrlang.planning.instances import ONE
from qsrlang.planning.repeats import INDEPENDENT
from qsrlang.planning.sight import Sight
from qsrlang.planning.world import Detection
from qsrlang.relations.graph import Landmark


def goal_of(
    scenario: Scenario,
    arm: Arm,
    place: Place,
    supports: Supports,
    weights: FloatArray,
    known: KnowledgeBase,
    target: str,
) -> Goal:
    """Return the goal of finding one target, its belief made of `weights` (K,) of the support voxels."""
    preset = arm.preset
    extent, rise = extent_of(known, target, preset)
    aims = supports.centres + np.array([0.0, 0.0, 0.5 * place.voxels.resolution + rise])
    sight = Sight(scenario.camera, scenario.floor_height, place.voxels, extent)
    detector, told = preset.looks.detector(), preset.belief
    places = supports.centres[:, :2]
    grid = preset.lattice.lattice() if preset.lattice is not None else None
    return Goal(
        target=target,
        belief=Belief.of_weights(
            aims, weights, absent=told.absent if told else 0.0, instances=told.number() if told else ONE
        ),
        sight=sight,
        detector=detector,
        atlas=None if grid is None else Atlas.of(place.reachable, sight, aims, detector, grid),
        recall=Reminder(arm.knowledge, scenario.landmarks, target, preset, places) if told else None,
        repeats=told.repeats() if told else INDEPENDENT,
    )


def extent_of(known: KnowledgeBase, target: str, preset: PlannerEntry) -> tuple[Extent, float]:
    """Return how far the target reaches, and how high above its support its centre is [m].

    Of classes whose size is known both follow from it; else the target is a point at the preset's `aim_height`.
    Presets without a table `belief` take every target for such a point.
    """
    kind = known.graph.classes.get(target)
    if preset.belief is None or kind is None or min(kind.width, kind.depth, kind.height) <= 0.0:
        return POINT, preset.looks.aim_height
    return Extent(0.25 * (kind.width + kind.depth), 0.5 * kind.height), 0.5 * kind.height


def weights_of(preset: PlannerEntry, belief: Where, places: FloatArray) -> FloatArray:
    """Return what support voxels at `places` (K, 2) are worth by an answer: (K,).

    1 + 10 p(x) and the like for the paper's planners; with a table `belief`, K times the prior of each.
    """
    claimed = 1.0 - belief.elsewhere
    if preset.belief is None:
        return voxel_weights(belief.mixture, places, preset.weight_floor, preset.weight_gain, claimed)
    return len(places) * preset.belief.doubt().prior(belief.mixture, places, claimed)


@dataclass(frozen=True, slots=True, eq=False)
class Reminder:
    """Asks what is known once more when things have been seen: they are landmarks from then on.

    A thing without a front of its own is taken to face as the nearest landmark does. As long as s of the n places
    where such a thing may be are accounted for, the answer counts for s / n, and the one without it for the rest.
    """

    knowledge: str
    landmarks: tuple[str, ...]
    target: str
    preset: PlannerEntry
    places: FloatArray

    def weights(self, seen: Sequence[Detection]) -> FloatArray | None:
        """Return the weights (K,) of the places by what is known now.

        None where nothing seen is new to it, and where it cannot tell the target's place with what was seen: what
        was believed before then stands.
        """
        known = load(self.knowledge).with_landmarks(*self.landmarks)
        placed = {landmark.name for landmark in known.landmarks}
        fresh = [one for one in seen if one.kind in known.graph.classes and one.name not in placed]
        if not fresh:
            return None
        landmarks = [
            Landmark(one.name, one.kind, *one.position[:2], heading=heading_near(known, one)) for one in fresh
        ]
        try:
            before, after = known.where(self.target), known.with_landmarks(*landmarks).where(self.target)
            share = min(_accounted(known, kind, fresh) for kind in {one.kind for one in fresh})
        except UnplaceableError:
            return None
        told, old = (weights_of(self.preset, answer, self.places) for answer in (after, before))
        return np.asarray(share * told + (1.0 - share) * old)


def heading_near(known: KnowledgeBase, seen: Detection) -> float | None:
    """Return the heading of the landmark that is nearest to a thing seen [rad], None where no landmark has one."""
    facing = [one for one in known.landmarks if one.heading is not None]
    x, y, _ = seen.position
    nearest = min(facing, key=lambda one: np.hypot(one.x - x, one.y - y), default=None)
    return None if nearest is None else nearest.heading


def _accounted(known: KnowledgeBase, kind: str, seen: Sequence[Detection]) -> float:
    """Return the share of the places of a class, one for each component of where it is, that the things seen fill."""
    count = sum(one.kind == kind for one in seen)
    return count / max(count, len(known.where(kind).components))
