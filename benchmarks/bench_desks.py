"""Search in simulated desks that are laid out as real ones were: learned knowledge, knowledge by hand, and none.

python benchmarks/bench_desks.py [--trials N] [--processes N] [--seed N]

Needs the KTH desk table (QSR_DATA, default ../shared/data). A trial is a scan of a desk: a room with a table of the
desk's size, all that the scan shows on it as boxes, one monitor that the robot is told of, and a class to find. What is
learned comes from the other desks only. The arms share scan, start, map and random numbers; all plan by `rollout`.
"""

from __future__ import annotations

import argparse
import math
import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import qsrlang as qsr
from qsrlang.errors import UnknownNameError, UnreachedTargetError
from qsrlang.experiments.arms import run_trial
from qsrlang.experiments.briefings import Briefing, brief
from qsrlang.experiments.cluster import work_through
from qsrlang.experiments.places import Place, safe_ground
from qsrlang.experiments.statistics import bootstrap_interval, paired_interval
from qsrlang.experiments.trials import Trial, trial_of
from qsrlang.geometry.pose import Pose2
from qsrlang.learning.experience import experience_of
from qsrlang.learning.merging import learn_into
from qsrlang.learning.observations import Observations, Row
from qsrlang.learning.reading import read_observations
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.simulation.rooms import Part, Room, Shape, Thing
from qsrlang.simulation.survey import survey_room
from qsrlang.simulation.world import PybulletWorld

CAMERA = "morse2014"
LANDMARK = "Monitor"
TARGETS = ("Mouse", "Keyboard", "Cup", "Bottle", "Lamp", "Laptop", "Headphones", "Book", "Telephone")
ARMS = {"learned": "rollout", "by hand": "rollout", "none": "rollout-even"}
BY_HAND = "office/desk"
QUICK = 18
WIDTH, DEPTH, WALL, TALL = 5.0, 4.0, 0.1, 2.3
HEIGHT, PLATE, LEG, GAP = 0.75, 0.03, 0.05, 0.1
LEAST_SIDE = 0.005
COLOUR = (0.7, 0.6, 0.5)


@dataclass(frozen=True)
class Case:
    """One trial: the scan, the class to find, and the number that picks the random streams."""

    number: int
    desk: str
    scene: str
    target: str


@dataclass(frozen=True)
class Setup:
    """What a process needs: where the table is and learned files go, and the seed."""

    table: Path
    folder: Path
    seed: int


def read_desks(table: Path) -> Observations:
    """Return the table, a mug called a cup as in `office/desk`."""
    seen = read_observations(table).observations
    return replace(seen, words=tuple("Cup" if word == "Mug" else word for word in seen.words))


def cases_of(seen: Observations, trials: int, seed: int) -> list[Case]:
    """Return the trials: classes in turn, the desks that have one in turn, a scan of the desk by lot."""
    columns = [seen.text(name) for name in ("place", "scene", "kind")]
    found = set(zip(*columns, strict=True))
    cases = []
    for number in range(trials):
        turn, kind = divmod(number, len(TARGETS))
        scans = sorted((d, s) for d, s, k in found if k == TARGETS[kind] and (d, s, LANDMARK) in found)
        desks = sorted({desk for desk, _ in scans})
        desk = desks[turn % len(desks)]
        scene = np.random.default_rng([seed, number]).choice([s for d, s in scans if d == desk])
        cases.append(Case(number, desk, str(scene), TARGETS[kind]))
    return cases


def box(name: str, kind: str, pose: Pose2, z: float, *sides: float) -> Thing:
    """Return a box, its underside at z, its sides along its front, across and up; none is thinner than 5 mm."""
    length, width, height = (max(side, LEAST_SIDE) for side in sides)
    return Thing(name, kind, pose, z, (Part(Shape.BOX, (length, width, height), (0.0, 0.0, 0.0), COLOUR),))


def bare_room(desk: Row) -> Room:
    """Return four walls and the table along the far one: what the robot maps."""
    walls = [
        box("floor", "Structure", Pose2(0.5 * WIDTH, 0.5 * DEPTH), -WALL, WIDTH, DEPTH, WALL),
        *(
            box(f"wall-x{x:g}", "Structure", Pose2(x, 0.5 * DEPTH), 0.0, WALL, DEPTH, TALL)
            for x in (0.0, WIDTH)
        ),
        *(
            box(f"wall-y{y:g}", "Structure", Pose2(0.5 * WIDTH, y), 0.0, WIDTH, WALL, TALL)
            for y in (0.0, DEPTH)
        ),
    ]
    start = Pose2(0.5 * WIDTH, 1.0, 0.5 * math.pi)
    return Room(str(desk["place"]), (0.0, 0.0, WIDTH, DEPTH), start, (*walls, *table_of(desk)))


def table_of(desk: Row) -> Iterator[Thing]:
    """Yield a plate of the desk's size at 75 cm, and a board at each end that carries it."""
    depth, length = float(desk["length"]), float(desk["width"])
    frame = frame_of(desk)
    middle = frame @ Pose2(0.5 * depth, -0.5 * length)
    yield box("plate", "Desk", middle, HEIGHT - PLATE, depth, length, PLATE)
    for side in (-1.0, 1.0):
        end = middle @ Pose2(0.0, side * 0.5 * (length - LEG))
        yield box(f"leg{side:+g}", "Desk", end, 0.0, depth, LEG, HEIGHT - PLATE)


def frame_of(desk: Row) -> Pose2:
    """Return the frame of the scan in the room: x to the far wall, the origin at the near left corner of the table."""
    return Pose2(
        0.5 * (WIDTH - float(desk["width"])), DEPTH - GAP - WALL - float(desk["length"]), 0.5 * math.pi
    )


def things_of(rows: Sequence[Row], desk: Row, target: str) -> tuple[Thing, ...]:
    """Return all that a scan shows as boxes on the table; only the target and the landmark are recognised."""
    frame = frame_of(desk)
    counts: dict[str, int] = {}
    things = []
    for row in rows:
        kind = str(row["kind"])
        if kind == "Desk":
            continue
        counts[kind] = counts.get(kind, 0) + 1
        pose = frame @ Pose2(float(row["x"]), float(row["y"]), float(row["yaw"]))
        z = HEIGHT + max(float(row["z"]), 0.0)
        sides = (float(row[name]) for name in ("length", "width", "height"))
        thing = box(f"{kind.lower()}-{counts[kind]}", kind, pose, z, *sides)
        things.append(replace(thing, recognised=kind in (LANDMARK, target)))
    return tuple(things)


class DeskWorker:
    """Searches one desk after the other."""

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        self._seen = read_desks(setup.table)

    def __call__(self, cases: tuple[Case, ...]) -> list[tuple[Case, tuple[Trial, ...]]]:
        """Learn from the other desks, map this one, and do its trials with each arm."""
        name = cases[0].desk
        known = write_knowledge(self._seen.among("place", [name], keep=False), self._setup.folder / name)
        scene = self._rows(cases[0])
        scenario, place = mapped(bare_room(desk_of(scene)))
        return [(case, self._trials(case, known, scenario, place)) for case in cases]

    def _trials(
        self, case: Case, known: dict[str, str], scenario: qsr.Scenario, place: Place
    ) -> tuple[Trial, ...]:
        rows = self._rows(case)
        things = things_of(rows, desk_of(rows), case.target)
        seed, room = self._setup.seed, place.room
        start = Pose2(*place.reachable.sample_poses(1, np.random.default_rng([seed, case.number, 1]))[0])
        told = told_of(scenario, next(thing for thing in things if thing.kind == LANDMARK))
        full = replace(room, things=(*room.things, *things))
        with PybulletWorld.from_room(full, (), scenario.robot, scenario.camera, start) as world:
            briefings = [briefing_of(arm, case.target, known, told, place) for arm in ARMS]
            return tuple(one_trial(world, one, place, TrialSeeds(seed, case.number)) for one in briefings)

    def _rows(self, case: Case) -> list[Row]:
        return list(self._seen.among("scene", [case.scene]).rows())

    def close(self) -> None:
        """Nothing outlives a desk."""


def desk_of(rows: Sequence[Row]) -> Row:
    """Return the row of the desk itself."""
    return next(row for row in rows if row["kind"] == "Desk")


def write_knowledge(others: Observations, folder: Path) -> dict[str, str]:
    """Write what other desks teach, and a file that knows sizes only, which are the same; return the files by arm."""
    folder.mkdir(parents=True, exist_ok=True)
    experience = experience_of(others)
    learned, sizes = folder / "learned.qsr", folder / "sizes.qsr"
    learn_into(learned, experience, keep_sums=False)
    lines = ["language 1.", f"static {LANDMARK} {{ front: yes }}."]
    for kind in TARGETS:
        size = experience.objects.size(kind)
        told = " × ".join(f"{100.0 * side:.0f} cm" for side in size[[1, 0, 2]])
        lines += [f"dynamic {kind} {{ size: {told} }}.", f"believe in-front-of({kind}, {LANDMARK})."]
    sizes.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return {"learned": str(learned), "by hand": BY_HAND, "none": str(sizes)}


def mapped(room: Room) -> tuple[qsr.Scenario, Place]:
    """Return the kitchen's scenario moved to a room, and the maps of the room."""
    scenario = replace(qsr.load_scenario("kitchen", CAMERA), start=room.start)
    occupancy, voxels = survey_room(room)
    ground = safe_ground(occupancy, voxels, scenario)
    return scenario, Place(occupancy, voxels, room, ground.reachable_from(room.start))


def told_of(scenario: qsr.Scenario, shown: Thing) -> qsr.Scenario:
    """Return the scenario with the one landmark that the robot is told of."""
    at = f"({shown.pose.x:.3f} m, {shown.pose.y:.3f} m) facing {math.degrees(shown.pose.yaw):.1f} deg"
    return replace(scenario, landmarks=(f"{shown.name} : {shown.kind} at {at}",))


def briefing_of(
    name: str, target: str, known: dict[str, str], scenario: qsr.Scenario, place: Place
) -> Briefing:
    """Return what an arm is told; of a class that its knowledge does not place, no more than `none` is."""
    arm = replace(scenario.arm(ARMS[name]), name=name, knowledge=known[name])
    ignorant = replace(scenario.arm(ARMS["none"]), name=name, knowledge=known["none"])
    try:
        (told,) = brief(scenario, [arm], place, target)
    except (UnknownNameError, UnreachedTargetError):
        (told,) = brief(scenario, [ignorant], place, target)
    return told


def one_trial(world: PybulletWorld, told: Briefing, place: Place, seeds: TrialSeeds) -> Trial:
    """Return the trial of one arm from the start."""
    world.reset()
    result = run_trial(world, told, place.reachable, seeds)
    return trial_of(told.arm, seeds.trial, result, told.limits.seconds)


def print_arms(results: Sequence[tuple[Trial, ...]]) -> None:
    print(f"{'arm':9s} {'found':>7s}  censored mean [s]       looks")
    for trials in zip(*results, strict=True):
        found = np.mean([trial.found for trial in trials])
        columns = (within([trial.seconds for trial in trials]), within([trial.poses for trial in trials]))
        print(f"{trials[0].arm:9s} {found:7.1%}  {columns[0]:22s}  {columns[1]}")


def within(values: Sequence[float]) -> str:
    interval = bootstrap_interval(values)
    return f"{np.mean(values):.2f} [{interval.low:.2f}, {interval.high:.2f}]"


def print_paired(results: Sequence[tuple[Trial, ...]], what: str) -> None:
    learned, *others = zip(*results, strict=True)
    for other in others:
        told = []
        for name, unit in (("seconds", "s"), ("poses", "looks")):
            ours, theirs = ([getattr(one, name) for one in trials] for trials in (learned, other))
            interval, gap = paired_interval(ours, theirs), float(np.mean(ours) - np.mean(theirs))
            told.append(f"{gap:+.2f} [{interval.low:+.2f}, {interval.high:+.2f}] {unit}")
        print(f"{what}: learned less {other[0].arm:8s} {',  '.join(told)}")


def print_targets(done: Sequence[tuple[Case, tuple[Trial, ...]]]) -> None:
    print(f"{'target':12s}{'trials':>7s}" + "".join(f"{arm:>20s}" for arm in ARMS) + "   (seconds, looks)")
    for target in TARGETS:
        arms = list(zip(*(trials for case, trials in done if case.target == target), strict=True))
        cells = [
            f"{np.mean([one.seconds for one in trials]):12.1f} {np.mean([one.poses for one in trials]):7.2f}"
            for trials in arms
        ]
        print(f"{target:12s}{len(arms[0]) if arms else 0:7d}" + "".join(cells))


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Search in simulated desks laid out as real ones.")
    parser.add_argument("--trials", type=int, default=QUICK)
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def main() -> None:
    asked = options()
    table = Path(os.environ.get("QSR_DATA", "../shared/data")) / "kth3d" / "kth3d_desks.csv"
    if not table.is_file():
        print(f"skipped: {table} is not there; set QSR_DATA to the folder of the data sets")
        return
    begun = time.perf_counter()
    by_desk: dict[str, list[Case]] = {}
    for case in cases_of(read_desks(table), asked.trials, asked.seed):
        by_desk.setdefault(case.desk, []).append(case)
    done = []
    with tempfile.TemporaryDirectory(prefix="qsrlang-") as folder:
        setup = Setup(table.resolve(), Path(folder), asked.seed)
        jobs = [tuple(cases) for cases in by_desk.values()]
        for told in work_through(DeskWorker, setup, jobs, asked.processes):
            done += told
            print(f"  {len(done)} of {asked.trials} trials ({time.perf_counter() - begun:.0f} s)", flush=True)
    done.sort(key=lambda one: one[0].number)
    print(f"{len(done)} paired trials at {len(by_desk)} desks, camera {CAMERA}, seed {asked.seed}")
    results = [trials for _, trials in done]
    print_arms(results)
    print_paired(results, "all classes")
    placed = [trials for case, trials in done if case.target in qsr.load(BY_HAND).classes]
    print_paired(placed, "those known by hand")
    print_targets(done)


if __name__ == "__main__":
    main()
