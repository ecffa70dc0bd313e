"""Briefings: what the robot of one arm is told before it starts, and the planner that this makes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import OutsideMapError, UnknownNameError, UnreachedTargetError
from qsrlang.experiments.goals import goal_of, weights_of
from qsrlang.experiments.places import Place
from qsrlang.experiments.presets import PlannerEntry
from qsrlang.experiments.scenarios import Arm, Scenario
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.maps.supports import Supports, find_supports
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.loading import load
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.planning.outcome import Limits
from qsrlang.planning.planners.believing import BeliefPlanner
from qsrlang.planning.planners.paper import QSRPlanner, RandomPlanner
from qsrlang.planning.planners.planner import Planner
from qsrlang.planning.strategies.named import STRATEGIES
from qsrlang.relations.graph import Landmark

KNOWING = ("qsr", *STRATEGIES)


@dataclass(frozen=True, slots=True, eq=False)
class Briefing:
    """What the robot of an arm knows: the target's class, supports and their weights (K,), landmarks and beliefs.

    `landmarks` leaves out surfaces, whose places the supports show.

    `belief` says where the statements place the target, map frame; it is None for arms that use no knowledge.
    """

    arm: str
    target: str
    supports: Supports
    weights: FloatArray
    belief: Where | None
    landmarks: tuple[Landmark, ...]
    cone: ViewCone
    limits: Limits
    planner: Planner


def brief(scenario: Scenario, arms: Sequence[Arm], place: Place, target: str) -> tuple[Briefing, ...]:
    """Return the briefings of several arms in one place; supports are found once for each way to find them.

    Raises UnreachedTargetError where an arm's knowledge ties the target to no landmark, and OutsideMapError
    where a landmark lies outside the map.
    """
    found: dict[str, Supports] = {}
    briefings = []
    for arm in arms:
        key = arm.preset.supports.model_dump_json()
        if key not in found:
            found[key] = supports_of(scenario, arm.preset, place)
        briefings.append(_briefing(scenario, arm, place, found[key], target))
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


def _briefing(scenario: Scenario, arm: Arm, place: Place, supports: Supports, target: str) -> Briefing:
    preset, cone, places = arm.preset, arm.preset.cone(), supports.centres[:, :2]
    known = known_to(scenario, arm, place) if arm.planner in KNOWING else None
    belief = _belief(known, arm, target) if known is not None else None
    weights = np.ones(len(places)) if belief is None else weights_of(preset, belief, places)
    return Briefing(
        arm=arm.name,
        target=target,
        supports=supports,
        weights=weights,
        belief=belief,
        landmarks=() if known is None else _shown(known),
        cone=cone,
        limits=arm.limits,
        planner=_planner(scenario, arm, place, supports, weights, known, target),
    )


def _shown(known: KnowledgeBase) -> tuple[Landmark, ...]:
    return tuple(one for one in known.landmarks if not known.graph.classes[one.kind].is_surface)


def _planner(
    scenario: Scenario,
    arm: Arm,
    place: Place,
    supports: Supports,
    weights: FloatArray,
    known: KnowledgeBase | None,
    target: str,
) -> Planner:
    cone, places = arm.preset.cone(), supports.centres[:, :2]
    match arm.planner:
        case "random":
            return RandomPlanner()
        case "planes":
            return QSRPlanner.of_planes(cone, places)
        case "qsr":
            return QSRPlanner(cone, places, weights)
        case name:
            assert known is not None
            goal = goal_of(scenario, arm, place, supports, weights, known, target)
            return BeliefPlanner((goal,), scenario.robot, STRATEGIES[name])


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
