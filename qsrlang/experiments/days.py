"""Day after day: things move, the robot searches with what it knows by then, and learns from what it saw."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from qsrlang.errors import (
    FileError,
    OutsideMapError,
    UnknownNameError,
    UnreachedTargetError,
    ValueRangeError,
)
from qsrlang.experiments.arms import run_trial, seen_through
from qsrlang.experiments.briefings import Briefing, brief, known_to
from qsrlang.experiments.places import Place, build_world, read_place
from qsrlang.experiments.scenariofiles import PlacementEntry
from qsrlang.experiments.scenarios import Arm, Scenario, load_scenario
from qsrlang.files import write_whole
from qsrlang.language.printing.printer import print_statement
from qsrlang.language.statements import Declaration, Landmark
from qsrlang.learning.differences import differences
from qsrlang.learning.experience import experience_of
from qsrlang.learning.merging import learn_anew, learned_before
from qsrlang.learning.observations import NUMBERS, Observations, Row
from qsrlang.learning.searches import sightings_of
from qsrlang.learning.store import ObservationStore
from qsrlang.mixtures.loading import load
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.planning.outcome import SearchResult
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.relations.imports import find_knowledge, read_library, read_source
from qsrlang.simulation.world import PybulletWorld

MAX_DAYS = 10_000
MOVED = 0.05
MAX_DRAWS = 20
SECONDS_A_DAY, MORNING = 86_400.0, 9 * 3_600.0


@dataclass(frozen=True, slots=True)
class Day:
    """One day: which objects were there, what its search came to, how much was seen, and what is known since.

    `told` says whether the learned file placed the target that morning; else the scenario's knowledge did.
    """

    number: int
    variant: str
    told: bool
    found: bool
    seconds: float
    poses: int
    sightings: int
    change: str


@dataclass(frozen=True, slots=True, eq=False)
class _Course:
    """What all days have in common."""

    scenario: Scenario
    place: Place
    arm: Arm
    target: str
    variants: tuple[str, ...]
    seed: int
    file: Path


def search_and_learn(
    scenario: str | Path | Scenario,
    file: Path | str,
    days: int = 7,
    target: str | None = None,
    planner: str = "qsr",
    seed: int = 0,
    variant: str | None = None,
    watch: Callable[[Day], None] | None = None,
) -> tuple[Day, ...]:
    """Search once a day with what is known by then, learn from what was seen, and return the days that were done.

    On each day the seed draws one of the scenario's variants, unless one is given, and every object of it has moved by
    a normal with a deviation of MOVED [m] along x and y. The robot uses `file` as soon as that places the target,
    before that the scenario's knowledge. Its sightings are appended to the store beside the file (.sqlite), and the
    file is learned anew from the whole store. Days that the store holds of this place, target and seed are not done
    again: an interrupted course goes on where it was. `watch` is called with each day once it is over. Raises QSRError.
    """
    if not 1 <= days <= MAX_DAYS:
        raise ValueRangeError("the number of days", days, f"1 to {MAX_DAYS}")
    course = _course(scenario, Path(file), target, planner, seed, variant)
    done = []
    with ObservationStore(course.file.with_suffix(".sqlite")) as store:
        _take_up(course, store)
        for number in range(_days_done(course, store) + 1, days + 1):
            done.append(_day(course, store, number))
            if watch is not None:
                watch(done[-1])
    return tuple(done)


def _course(
    scenario: str | Path | Scenario,
    file: Path,
    target: str | None,
    planner: str,
    seed: int,
    variant: str | None,
) -> _Course:
    if file.suffix != ".qsr":
        raise FileError(file, "does not end in .qsr", "name a file such as learned.qsr")
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    arm = loaded.arm(planner)
    variants = tuple(loaded.variants) if variant is None else (loaded.variant(variant),)
    return _Course(loaded, read_place(loaded), arm, target or loaded.target, variants, seed, file)


def _take_up(course: _Course, store: ObservationStore) -> None:
    """Begin the file where there is none, and learn what the store holds where the file lags behind."""
    if not course.file.exists():
        write_whole(course.file, _beginning(course.arm.knowledge))
    learned = sum(learned_before(course.file).sources.values())
    if learned > len(store):
        remedy = "name a new file, and import this one there"
        raise FileError(course.file, f"was learned from more than {store.path.name} holds", remedy)
    if learned < len(store):
        learn_anew(course.file, experience_of(store.query()))


def _beginning(knowledge: str) -> str:
    """Return the classes and landmarks of a file of knowledge and its imports, without where anything is."""
    documents = read_library(read_source(find_knowledge(knowledge))).documents
    told = [one for document in documents for one in document.statements]
    kept = [one for one in told if isinstance(one, (Declaration, Landmark))]
    return "\n".join(["language 1.", *(print_statement(one).strip() for one in kept)]) + "\n"


def _scene(course: _Course, number: int) -> str:
    return f"{course.target}, seed {course.seed}, day {number}"


def _days_done(course: _Course, store: ObservationStore) -> int:
    scenes = set(store.query(place=course.scenario.name).text("scene"))
    opening = _scene(course, 0).removesuffix("0")
    numbers = (one.removeprefix(opening).split(",")[0] for one in scenes if one.startswith(opening))
    return max(map(int, numbers), default=0)


def _day(course: _Course, store: ObservationStore, number: int) -> Day:
    before = load(str(course.file))
    told, briefing = _briefing(course)
    variant, result = _search(course, briefing, number)
    known = known_to(course.scenario, course.arm, course.place)
    landmarks = [one for one in known.landmarks if not known.graph.classes[one.kind].is_surface]
    scene, time = _scene(course, number), number * SECONDS_A_DAY + MORNING
    seen = sightings_of(result.steps, landmarks, course.scenario.name, scene, time)
    store.append(by_nearest_landmark(seen, len(landmarks)))
    learn_anew(course.file, experience_of(store.query()))
    return Day(
        number=number,
        variant=variant,
        told=told,
        found=result.found,
        seconds=result.seconds,
        poses=result.poses,
        sightings=len(seen) - len(landmarks),
        change=change_in_words(before, load(str(course.file))),
    )


def by_nearest_landmark(seen: Observations, landmarks: int) -> Observations:
    """Return each thing of one scene beside the landmark nearest to it, as a scene of their own.

    The first rows, `landmarks` of them, are the landmarks. A search passes several desks: what is at one of them tells
    nothing by the monitor of another, and how landmarks lie to each other is known.
    """
    rows = list(seen.rows())
    known, things = rows[:landmarks], rows[landmarks:]
    if not known:
        return seen
    places = seen.numbers[:, [NUMBERS.index("x"), NUMBERS.index("y")]]
    gaps = np.hypot(*(places[landmarks:, None] - places[None, :landmarks]).transpose(2, 0, 1))
    found: list[Row] = []
    for near, thing in zip(gaps.argmin(axis=1), things, strict=True):
        scene: dict[str, str | float] = {"scene": f"{thing['scene']}, {thing['object']}"}
        found += [known[near] | scene, thing | scene]
    return Observations.of(found)


def _briefing(course: _Course) -> tuple[bool, Briefing]:
    """Return whether the learned file places the target, and what the robot is told."""
    learned = replace(course.arm, knowledge=str(course.file))
    try:
        return True, brief(course.scenario, [learned], course.place, course.target)[0]
    except (UnknownNameError, UnreachedTargetError):
        return False, brief(course.scenario, [course.arm], course.place, course.target)[0]


def _search(course: _Course, briefing: Briefing, number: int) -> tuple[str, SearchResult]:
    rng = np.random.default_rng([course.seed, number])
    variant = str(rng.choice(course.variants))
    seeds = TrialSeeds(course.seed, number)
    with _world(course, variant, rng) as world:
        seen = seen_through(world, course.scenario, course.place, briefing, seeds)
        return variant, run_trial(seen, briefing, course.place.reachable, seeds)


def _world(course: _Course, variant: str, rng: np.random.Generator) -> PybulletWorld:
    """Return the world of a day; where things do not stay, they are moved anew, at last not at all."""
    for placements in _moves(course.scenario.placements, rng):
        try:
            return build_world(replace(course.scenario, placements=placements), course.place, variant)
        except (FileError, OutsideMapError):
            continue
    return build_world(course.scenario, course.place, variant)


def _moves(
    placements: tuple[PlacementEntry, ...], rng: np.random.Generator
) -> Iterator[tuple[PlacementEntry, ...]]:
    for _ in range(MAX_DRAWS):
        moves = rng.normal(0.0, MOVED, (len(placements), 2)).tolist()
        yield tuple(
            one.model_copy(update={"x": one.x + dx, "y": one.y + dy})
            for one, (dx, dy) in zip(placements, moves, strict=True)
        )


def change_in_words(before: KnowledgeBase, after: KnowledgeBase) -> str:
    """Return the largest change from one state of knowledge to another on one line, and how many more there are."""
    changes = differences(before, after)
    if not changes:
        return "nothing"
    first, more = changes[0], len(changes) - 1
    bits = "" if first.bits is None else f" ({first.bits:.2f} bits)"
    referent, relatum = first.pair
    pair = f"{referent} from {relatum}" + ("" if first.bits is None else ":")
    return f"{pair} {first.words}{bits}" + (f", and {more} more" if more else "")
