"""One trial of one arm, and the worker that does such trials one after the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.experiments.briefings import Briefing
from qsrlang.experiments.places import Place, build_world
from qsrlang.experiments.scenarios import Scenario
from qsrlang.experiments.trials import Trial, trial_of
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.planning.loop import Watcher, search_world
from qsrlang.planning.noise import NoisyWorld
from qsrlang.planning.outcome import SearchResult
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.sight import Sight
from qsrlang.planning.world import World


@dataclass(frozen=True, slots=True)
class TrialJob:
    """One trial to do: which arm, and the number that picks its random streams."""

    arm: str
    number: int


@dataclass(frozen=True, slots=True, eq=False)
class TrialSetup:
    """What a process needs for the trials of a comparison: the place and its truth, and a briefing for each arm."""

    scenario: Scenario
    variant: str
    place: Place
    briefings: tuple[Briefing, ...]
    seed: int


class TrialWorker:
    """Does trials in a world that it builds once; a trial's outcome depends on its job and the setup alone."""

    def __init__(self, setup: TrialSetup) -> None:
        self._setup = setup
        self._briefings = {briefing.arm: briefing for briefing in setup.briefings}
        self._world = build_world(setup.scenario, setup.place, setup.variant)

    def __call__(self, job: TrialJob) -> Trial:
        """Do one trial from the robot's start."""
        briefing = self._briefings[job.arm]
        self._world.reset()
        seeds = TrialSeeds(self._setup.seed, job.number)
        seen = seen_through(self._world, self._setup.scenario, self._setup.place, briefing, seeds)
        result = run_trial(seen, briefing, self._setup.place.reachable, seeds)
        return trial_of(job.arm, job.number, result, briefing.limits.seconds)

    def close(self) -> None:
        """Free the world."""
        self._world.close()


def seen_through(
    world: World, scenario: Scenario, place: Place, briefing: Briefing, seeds: TrialSeeds
) -> World:
    """Return the world as the scenario's camera shows it: itself where that does not err."""
    if scenario.noise.is_none:
        return world
    sight = Sight(scenario.camera, scenario.floor_height, place.voxels)
    aims = briefing.supports.centres + np.array([0.0, 0.0, 0.5 * place.voxels.resolution])
    return NoisyWorld(world, scenario.noise, seeds, briefing.targets, sight, aims)


def run_trial(
    world: World,
    briefing: Briefing,
    reachable: NavigationGrid,
    seeds: TrialSeeds,
    watch: Watcher | None = None,
) -> SearchResult:
    """Return what a robot with this briefing does in the world, from where it stands."""
    return search_world(world, briefing.planner, reachable, briefing.targets, briefing.limits, seeds, watch)
