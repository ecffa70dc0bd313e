"""The search monitor: chooses, drives and looks until the object is found or the limits are reached."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.paths import DistanceField
from qsrlang.planning.outcome import Limits, SearchResult, SearchStep
from qsrlang.planning.planners import Planner
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.world import Detection, World

Watcher = Callable[[SearchStep], None]


def search_world(
    world: World,
    planner: Planner,
    navigation: NavigationGrid,
    target: str,
    limits: Limits,
    seeds: TrialSeeds,
    watch: Watcher | None = None,
) -> SearchResult:
    """Search for an object of the class `target` and return what happened.

    The monitor of Kunze et al. 2014, section III: draw candidate poses, let the planner choose one (Algorithm 1),
    drive there, look; any one object of the class ends the search. The clock is what the world reports: drives
    with their turns, and dwells. A drive or look that would end after the time limit counts as not found at the
    limit. `navigation` holds the places the robot can reach; `watch` is called with every step once it is over.
    """
    task = _Task(navigation, target, limits)
    steps: list[SearchStep] = []
    while len(steps) < task.limits.poses:
        step = _next_step(world, task, planner, seeds, steps)
        steps.append(step)
        if watch is not None:
            watch(step)
        if not step.looked or _hit(step, task.target):
            break
        planner = planner.after_miss(world.robot_pose)
    return _outcome(task, steps)


@dataclass(frozen=True, slots=True)
class _Task:
    navigation: NavigationGrid
    target: str
    limits: Limits


def _next_step(
    world: World, task: _Task, planner: Planner, seeds: TrialSeeds, steps: list[SearchStep]
) -> SearchStep:
    number = len(steps)
    clock = steps[-1].clock if steps else 0.0
    origin = world.robot_pose
    candidates = task.navigation.sample_poses(task.limits.candidates, seeds.candidates(number))
    choice = planner.choose(candidates, origin, seeds.pick(number))
    x, y, yaw = (float(value) for value in candidates[choice.index])
    path = _path(task.navigation, origin, (x, y))
    drive = world.drive(path, yaw)
    seconds, looked, detections = drive.seconds, False, tuple[Detection, ...]()
    if clock + seconds <= task.limits.seconds:
        look = world.look()
        seconds += look.seconds
        looked = clock + seconds <= task.limits.seconds
        detections = look.detections if looked else ()
    return SearchStep(
        number=number,
        origin=origin,
        candidates=candidates,
        values=choice.values,
        chosen=choice.index,
        path=path,
        travel=drive.travel,
        turn=drive.turn,
        seconds=seconds,
        clock=clock + seconds,
        looked=looked,
        detections=detections,
    )


def _path(navigation: NavigationGrid, origin: Pose2, goal: tuple[float, float]) -> FloatArray:
    return DistanceField.from_start(navigation, (origin.x, origin.y)).path_to(goal)


def _hit(step: SearchStep, target: str) -> Detection | None:
    return next((seen for seen in step.detections if seen.kind == target), None)


def _outcome(task: _Task, steps: list[SearchStep]) -> SearchResult:
    last = steps[-1]
    hit = _hit(last, task.target)
    return SearchResult(
        target=task.target,
        found=hit is not None,
        seconds=min(last.clock, task.limits.seconds),
        poses=sum(step.looked for step in steps),
        travel=sum(step.travel for step in steps),
        steps=tuple(steps),
        detection=hit,
    )
