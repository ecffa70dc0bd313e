"""Briefings: what the robot of one arm is told before it starts, and the planner that this makes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import OutsideMapError, UnknownNameError, UnreachedTargetError, ValueRangeError
from qsrlang.experiments.goals import goal_of, weights_of
from qsrlang.experiments.places import Place
from qsrlang.experiments.presets import PlannerEntry
from qsrlang.experiments.scenarios import Arm, Scenario
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.maps.supports import Supports, find_supports
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.loading import load
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.planning.loop import targets_of
from qsrlang.planning.outcome import Limits
from qsrlang.planning.planners.believing import BeliefPlanner
from qsrlang.planning.planners.paper import QSRPlanner, RandomPlanner
from qsrlang.planning.planners.planner import Planner
from qsrlang.planning.strategies.named import STRATEGIES
from qsrlang.relations.graph import Landmark

KNOWING = ("qsr", *STRATEGIES)


@dataclass(frozen=True, slots=True, eq=False)
class Briefing:
    """What the robot of an arm knows: the classes sought, supports and their weights (K,), landmarks and beliefs.

    `landmarks` leaves out surfaces, whose places the supports show. `beliefs` say where the statements place each
    target, map frame; there are none for arms that use no knowledge. Of several targets, `weights` are the mean.
    """

    arm: str
    targets: tuple[str, ...]
    supports: Supports
    weights: FloatArray
    beliefs: tuple[Where, ...]
    landmarks: tuple[Landmark, ...]
    cone: ViewCone
    limits: Limits
    planner: Planner


def brief(
    scenario: Scenario, arms: Sequence[Arm], place: Place, target: str | Sequence[str]
) -> tuple[Briefing, ...]:
    """Return the briefings of several arms in one place; supports are found once for each way to find them.

    Raises ValueRangeError for several targets of an arm without a belief, UnreachedTargetError where an arm's knowledge
    ties a target to no landmark, and OutsideMapError where a landmark lies outside the map.
    """
    found: dict[str, Supports] = {}
    briefings, targets = [], targets_of(target)
    for arm in arms:
        if len(targets) > 1 and arm.planner not in STRATEGIES:
            several = f"1; of several at once, arms with one of the planners {', '.join(STRATEGIES)}"
            raise ValueRangeError(f"the number of targets of the arm '{arm.name}'", len(targets), several)
        key = arm.preset.supports.model_dump_json()
        if key not in found:
            found[key] = supports_of(scenario, arm.preset, place)
        briefings.append(_briefing(scenario, arm, place, found[key], targets))
    return tuple(briefings)


def supports_of(scenario: Scenario, preset: PlannerEntry, place: Place) -> Supports:
    """Return the supporting planes of a place as a preset wants them found."""
    wanted, floor = preset.supports, scenario.floor_height
    return find_supports(
        place.voxels,
        method=wanted.method,
        max_tilt=math.radians(wanted.max_tilt_deg),
        min_height=None if wanted.min_height is None else floor + wanted.min_height,
        max_height=None if wanted.max_height is None else floor + wanted.max_height,
        min_part=wanted.min_part,
    )


def _briefing(
    scenario: Scenario, arm: Arm, place: Place, supports: Supports, targets: tuple[str, ...]
) -> Briefing:
    preset, cone, places = arm.preset, arm.preset.cone(), supports.centres[:, :2]
    known = known_to(scenario, arm, place) if arm.planner in KNOWING else None
    beliefs = () if known is None else tuple(_belief(known, arm, target) for target in targets)
    weights = [weights_of(preset, belief, places) for belief in beliefs] or [np.ones(len(places))]
    return Briefing(
        arm=arm.name,
        targets=targets,
        supports=supports,
        weights=np.mean(weights, axis=0),
        beliefs=beliefs,
        landmarks=() if known is None else _shown(known),
        cone=cone,
        limits=arm.limits,
        planner=_planner(scenario, arm, place, supports, weights, known, targets),
    )


def _shown(known: KnowledgeBase) -> tuple[Landmark, ...]:
    return tuple(one for one in known.landmarks if not known.graph.classes[one.kind].is_surface)


def _planner(
    scenario: Scenario,
    arm: Arm,
    place: Place,
    supports: Supports,
    weights: Sequence[FloatArray],
    known: KnowledgeBase | None,
    targets: tuple[str, ...],
) -> Planner:
    cone, places = arm.preset.cone(), supports.centres[:, :2]
    match arm.planner:
        case "random":
            return RandomPlanner()
        case "planes":
            return QSRPlanner.of_planes(cone, places)
        case "qsr":
            return QSRPlanner(cone, places, weights[0])
        case name:
            assert known is not None
            goals = tuple(
                goal_of(scenario, arm, place, supports, own, known, target)
                for own, target in zip(weights, targets, strict=True)
            )
            return BeliefPlanner(goals, scenario.robot, STRATEGIES[name])


def known_to(scenario: Scenario, arm: Arm, place: Place) -> KnowledgeBase:
    """Return the knowledge of an arm with the scenario's landmarks; OutsideMapError where one is off the map."""
    known = load(arm.knowledge).with_landmarks(*scenario.landmarks)
    for landmark in known.landmarks:
        if not place.occupancy.covers([landmark.x, landmark.y]):
            what, point = f"landmark '{landmark.name}'", (landmark.x, landmark.y)
            raise OutsideMapError(what, point, place.occupancy.bounds, place.occupancy.source)
    return known


def _belief(known: KnowledgeBase, arm: Arm, target: str) -> Where:
    """Return where the target is in the map frame; an answer relative to a class without landmarks is of no use."""
    try:
        answer = known.where(target)
        if answer.frame != "map":
            raise UnreachedTargetError(target, [f"its chains start at {answer.frame}, which has no landmark"])
        return answer
    except UnknownNameError as error:
        raise UnknownNameError(f"class of {arm.knowledge}:", error.name, error.known) from None
    except UnreachedTargetError as error:
        chains = error.chains or (f"no statement places {target}",)
        raise UnreachedTargetError(target, [f"{arm.knowledge}: {chain}" for chain in chains]) from None
