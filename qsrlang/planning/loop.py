"""The search monitor: chooses, drives and looks until the object is found or the limits are reached."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import NoNavigablePoseError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.paths import DistanceField
from qsrlang.planning.outcome import Ending, Limits, SearchResult, SearchStep
from qsrlang.planning.planners.planner import Planner, Situation
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.world import Detection, Look, World

Watcher = Callable[[SearchStep], None]

STOPPED_SHORT = 0.05
"""A drive that ends farther than this from its goal met something that the map does not show [m]."""


def search_world(
    world: World,
    planner: Planner,
    navigation: NavigationGrid,
    target: str | Sequence[str],
    limits: Limits,
    seeds: TrialSeeds,
    watch: Watcher | None = None,
) -> SearchResult:
    """Search for an object of the class `target`, or for one of each of several, and return what happened.

    The monitor of Kunze et al. 2014, section III: draw candidate poses, let the planner choose one (Algorithm 1),
    drive there, look; any one object of a class ends the search for it, once the planner takes the report for true.
    The clock is what the world reports: drives with their turns, and dwells. A drive or look that would end after the
    time limit counts as not found at the limit. `navigation` holds the places the robot can reach; where a drive
    stops short, the way is taken to be closed there, and the next one is planned around it. `watch` is called with
    every step once it is over.
    """
    wanted = targets_of(target)
    run = _Run(navigation, planner, wanted, limits)
    while run.ending is None:
        try:
            run = _next_run(world, run, seeds)
        except NoNavigablePoseError:
            run = replace(run, ending="stuck")
            break
        if watch is not None:
            watch(run.steps[-1])
    return _outcome(run, wanted)


def targets_of(target: str | Sequence[str]) -> tuple[str, ...]:
    """Return the classes that are sought, each once; raises ValueRangeError where there are none."""
    targets = (target,) if isinstance(target, str) else tuple(dict.fromkeys(target))
    if not targets:
        raise ValueRangeError("the number of targets", 0, "at least 1")
    return targets


@dataclass(frozen=True, slots=True)
class _Run:
    navigation: NavigationGrid
    planner: Planner
    wanted: tuple[str, ...]
    limits: Limits
    steps: tuple[SearchStep, ...] = ()
    finds: tuple[Detection, ...] = ()
    ending: Ending | None = None

    @property
    def clock(self) -> float:
        return self.steps[-1].clock if self.steps else 0.0


def _next_run(world: World, run: _Run, seeds: TrialSeeds) -> _Run:
    step = _next_step(world, run, seeds)
    planner, wanted, finds = run.planner, run.wanted, run.finds
    if step.looked:
        planner = planner.after_look(world.robot_pose, step.detections, step.tilt)
        for seen in step.detections:
            if seen.kind in wanted and planner.settles(seen):
                wanted = tuple(kind for kind in wanted if kind != seen.kind)
                planner, finds = planner.after_find(seen.kind), (*finds, seen)
        step = replace(step, absence=planner.absence)
    done = replace(
        run,
        navigation=_still_open(run.navigation, step),
        planner=planner,
        wanted=wanted,
        steps=(*run.steps, step),
        finds=finds,
    )
    return replace(done, ending=_ending(done, step))


def _ending(run: _Run, step: SearchStep) -> Ending | None:
    if not run.wanted:
        return "found"
    if not step.looked:
        return "time"
    if step.absence >= run.limits.absence:
        return "absent"
    return "looks" if len(run.steps) >= run.limits.poses else None


def _next_step(world: World, run: _Run, seeds: TrialSeeds) -> SearchStep:
    number, clock, limits = len(run.steps), run.clock, run.limits
    origin = world.robot_pose
    field = _ways_from(run.navigation, origin)
    drawn = run.navigation.sample_poses(limits.candidates, seeds.candidates(number))
    situation = Situation(drawn, origin, field, limits.seconds - clock)
    choice = run.planner.choose(situation, seeds.pick(number))
    x, y, yaw = (float(value) for value in choice.candidates[choice.index])
    path = np.vstack([[origin.x, origin.y], field.path_to((x, y))[1:]])
    drive = world.drive(path, yaw)
    look, seconds = Look((), 0.0), drive.seconds
    looked = False
    if clock + seconds <= limits.seconds:
        look = world.look() if choice.tilt is None else world.look(choice.tilt)
        seconds += look.seconds
        looked = clock + seconds <= limits.seconds
    return SearchStep(
        number=number,
        origin=origin,
        candidates=choice.candidates,
        values=choice.values,
        chosen=choice.index,
        path=path,
        travel=drive.travel,
        turn=drive.turn,
        seconds=seconds,
        clock=clock + seconds,
        looked=looked,
        detections=look.detections if looked else (),
        reached=drive.reached,
        unit=choice.unit,
        terms=choice.terms,
        tilt=choice.tilt,
        wanted=run.wanted,
    )


def _ways_from(navigation: NavigationGrid, origin: Pose2) -> DistanceField:
    """Return the ways from the robot, from the nearest navigable place where it was stopped beside an obstacle."""
    here = (origin.x, origin.y)
    if not navigation.is_navigable(np.array(here)):
        here = navigation.nearest_navigable(here)
    return DistanceField.from_start(navigation, here)


def _still_open(navigation: NavigationGrid, step: SearchStep) -> NavigationGrid:
    """Return the map less what stopped the robot: the cells about the place just ahead of where it came to stand."""
    place, goal = step.reached.position, step.path[-1]
    if np.hypot(*(goal - place)) <= STOPPED_SHORT:
        return navigation
    return navigation.closed_at(_ahead(step.path, place, navigation.clearance), navigation.clearance, place)


def _ahead(path: FloatArray, place: FloatArray, reach: float) -> FloatArray:
    """Return the point `reach` [m] further along the leg of a path on which a place lies."""
    legs = np.diff(path, axis=0)
    lengths = np.maximum(np.hypot(*legs.T), 1e-12)
    along = np.clip(np.einsum("ld,ld->l", place - path[:-1], legs) / lengths**2, 0.0, 1.0)
    gaps = np.hypot(*(path[:-1] + along[:, None] * legs - place).T)
    leg = int(np.argmin(np.round(gaps, 9)))
    return np.asarray(place + legs[leg] / lengths[leg] * reach)


def _outcome(run: _Run, wanted: tuple[str, ...]) -> SearchResult:
    found = not run.wanted
    return SearchResult(
        target=", ".join(wanted),
        found=found,
        seconds=min(run.clock, run.limits.seconds),
        poses=sum(step.looked for step in run.steps),
        travel=sum(step.travel for step in run.steps),
        steps=run.steps,
        detection=run.finds[-1] if found else None,
        finds=run.finds,
        ending=run.ending or "stuck",
        absence=run.planner.absence,
    )
