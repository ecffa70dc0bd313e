"""One search from beginning to end, with all that a narrator or a picture needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from qsrlang.experiments.arms import run_trial, seen_through
from qsrlang.experiments.briefings import Briefing, brief
from qsrlang.experiments.places import Place, build_world, read_place
from qsrlang.experiments.scenarios import Scenario, load_scenario
from qsrlang.planning.loop import Watcher
from qsrlang.planning.outcome import SearchResult, SearchStep
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.world import Detection


@dataclass(frozen=True, slots=True, eq=False)
class Opening:
    """A search that is about to begin: the scenario, what is truly there, the maps, and what the robot is told."""

    scenario: Scenario
    variant: str
    place: Place
    briefing: Briefing

    def search(self, seed: int = 0, trial: int = 0, watch: Watcher | None = None) -> SearchStory:
        """Search in a world made for this one search; `watch` is called with every step once it is over."""
        with build_world(self.scenario, self.place, self.variant) as world:
            seeds = TrialSeeds(seed, trial)
            seen = seen_through(world, self.scenario, self.place, self.briefing, seeds)
            result = run_trial(seen, self.briefing, self.place.reachable, seeds, watch)
            return SearchStory(self, seed, trial, result)


@dataclass(frozen=True, slots=True, eq=False)
class SearchStory:
    """A search that is over: how it began, and what came of it."""

    opening: Opening
    seed: int
    trial: int
    result: SearchResult

    @property
    def target(self) -> str:
        """The class that was sought; several with commas between."""
        return self.result.target

    @property
    def found(self) -> bool:
        """Whether an object of every class sought was found."""
        return self.result.found

    @property
    def detection(self) -> Detection | None:
        """The object that was found, the last one of several."""
        return self.result.detection

    @property
    def finds(self) -> tuple[Detection, ...]:
        """The objects that were found, one of each class at most."""
        return self.result.finds

    @property
    def seconds(self) -> float:
        """The time of the find, or the time at which the search gave up [s]."""
        return self.result.seconds

    @property
    def poses(self) -> int:
        """How many looks it took."""
        return self.result.poses

    @property
    def travel(self) -> float:
        """The path driven [m]."""
        return self.result.travel

    @property
    def steps(self) -> tuple[SearchStep, ...]:
        """What the search did, step by step."""
        return self.result.steps


def open_search(
    scenario: str | Path | Scenario,
    target: str | Sequence[str] | None = None,
    planner: str = "qsr",
    variant: str | None = None,
) -> Opening:
    """Return a search that is about to begin; `planner` names an arm of the scenario. Raises QSRError."""
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    arm, chosen = loaded.arm(planner), loaded.variant(variant)
    place = read_place(loaded)
    (briefing,) = brief(loaded, [arm], place, target or loaded.target)
    return Opening(loaded, chosen, place, briefing)


def search(
    scenario: str | Path | Scenario,
    target: str | Sequence[str] | None = None,
    planner: str = "qsr",
    seed: int = 0,
    variant: str | None = None,
    trial: int = 0,
    watch: Watcher | None = None,
) -> SearchStory:
    """Search for an object in a scenario, or for one of each of several classes, and return the whole story.

    `target` is the class sought, or several, the scenario's by default; `planner` names one of its arms. The same
    seed and trial give the same search, and the same as that trial of `compare`. Raises QSRError.
    """
    return open_search(scenario, target, planner, variant).search(seed, trial, watch)
