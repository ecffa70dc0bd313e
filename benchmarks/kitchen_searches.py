"""Searches in the paper's kitchen: the arms side by side, hindsight, and what goes wrong.

The knowledge is displaced, the camera errs, or the cup stands anywhere.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import qsrlang as qsr
from qsrlang.experiments.arms import run_trial
from qsrlang.experiments.briefings import brief
from qsrlang.experiments.places import build_world, read_place
from qsrlang.maps.ways import Ways
from qsrlang.planning.motion import first_costs
from qsrlang.planning.threads import processors

SEED = 1
ARMS = ("qsr", "belief", "nearest", "index", "tour", "rollout", "rollout-drawn", "rollout-even")
DRAWN = ("qsr", "belief", "rollout", "rollout-even")
CASES = (("A", "narrow"), ("B", "narrow"), ("C", "wide"), ("C", "narrow"))
SHIFTS = (0.0, 0.25, 0.5, 1.0, 2.0)
RATES, ALARMS = (1.0, 0.9, 0.7, 0.5), (0.0, 0.02, 0.1)
POSES = 40_000
ABOVE = 0.06


def compared(scenario: qsr.Scenario, arms: Sequence[str], trials: int, variant: str) -> qsr.Comparison:
    return qsr.compare(scenario, arms, trials, SEED, variant, processes=processors())


def hindsight(scenario: qsr.Scenario, variant: str) -> float:
    """Return the least time [s] from the start to a look that shows a target, over many random poses."""
    place = read_place(scenario)
    poses = place.reachable.sample_poses(POSES, np.random.default_rng(SEED))
    with build_world(scenario, place, variant) as world:
        wanted = [thing.kind == scenario.target for thing in world.objects]
        shows = world.visible(poses)[:, : len(wanted)][:, wanted].any(axis=1)
    start = scenario.start
    field = qsr.DistanceField.from_start(place.reachable, (start.x, start.y))
    seen = poses[shows]
    ways = Ways.from_field(field, seen[:, :2])
    return float(first_costs(scenario.robot, start, ways, np.arange(len(seen)), seen[:, 2])[2].min())


def tell_case(variant: str, camera: str, trials: int) -> qsr.Comparison:
    scenario = qsr.load_scenario("tum-kitchen", camera)
    result = compared(scenario, ARMS, trials, variant)
    base = result.summaries["qsr"].time_censored
    print(
        f"  {variant}, camera {camera}, {trials} paired trials; hindsight {hindsight(scenario, variant):.1f} s"
    )
    for arm, one in result.summaries.items():
        mean, (low, high) = difference(result, arm)
        found = f"found {one.found:6.1%} [{one.found_ci.low:.1%}, {one.found_ci.high:.1%}]"
        time = f"censored mean {one.time_censored:6.1f} s [{one.time_ci.low:.1f}, {one.time_ci.high:.1f}]"
        beside = f"{one.time_censored / base:5.2f} of eq. 3; less it {mean:+.1f} [{low:+.1f}, {high:+.1f}] s"
        print(f"    {arm:14s} {found}  {time}  {beside}  looks {one.poses or math.nan:.1f}", flush=True)
    return result


def difference(result: qsr.Comparison, arm: str) -> tuple[float, tuple[float, float]]:
    if arm == "qsr":
        return 0.0, (0.0, 0.0)
    mean, interval = result.differences["qsr", arm]
    return -mean, (-interval.high, -interval.low)


def displaced(scenario: qsr.Scenario, shift: float) -> qsr.Scenario:
    """Return the scenario with the worktops of the knowledge moved by `shift` [m] along x."""
    known = qsr.load(scenario.arm("qsr").knowledge)
    moved = tuple(
        f"{one.name} : {one.kind} at ({one.x + shift:.3f} m, {one.y:.3f} m) "
        f"facing {math.degrees(one.heading or 0.0):.1f} deg"
        for one in known.landmarks
    )
    return replace(scenario, landmarks=moved)


def tell_knowledge(trials: int) -> dict[str, tuple[list[float], list[float]]]:
    print(
        f"  A, camera narrow, {trials} paired trials, the landmarks of the knowledge displaced by so many metres"
    )
    scenario, arms = qsr.load_scenario("tum-kitchen", "narrow"), ("qsr", "rollout", "rollout-even")
    times: dict[str, list[float]] = {arm: [] for arm in arms}
    for shift in SHIFTS:
        result = compared(displaced(scenario, shift), arms, trials, "A")
        for arm in arms:
            times[arm].append(result.summaries[arm].time_censored)
        print(
            f"    {shift:4.2f} m  " + "  ".join(f"{arm} {times[arm][-1]:6.1f} s" for arm in arms), flush=True
        )
    return {arm: (list(SHIFTS), told) for arm, told in times.items()}


def tell_noise(trials: int) -> dict[str, tuple[list[float], list[float]]]:
    print(f"  A, camera narrow, {trials} paired trials, a camera that errs: found, censored mean")
    arms, curves = ("qsr", "rollout", "rollout-wary"), {}
    for alarms in ALARMS:
        for rate in RATES:
            scenario = qsr.load_scenario("tum-kitchen", "narrow", noise=qsr.Noise(rate, alarms))
            figures = compared(scenario, arms, trials, "A").summaries
            told = "  ".join(
                f"{arm} {figures[arm].found:6.1%} {figures[arm].time_censored:6.1f} s" for arm in arms
            )
            print(f"    true positives {rate:.1f}, false positives {alarms:.2f}:  {told}", flush=True)
            for arm in arms:
                curve = curves.setdefault(f"{arm}, FP {alarms:g}", ([], []))
                curve[0].append(rate)
                curve[1].append(figures[arm].time_censored)
    return curves


def tell_strewn(count: int) -> None:
    """Print the mean times to a cup put anywhere on the supports where a look from somewhere shows it."""
    print(
        f"  {count} cups, each alone somewhere on the supports, camera narrow: censored mean, standard error"
    )
    scenario, arms, rng = (
        qsr.load_scenario("tum-kitchen", "narrow"),
        ("rollout", "rollout-even"),
        np.random.default_rng(SEED),
    )
    place = read_place(scenario)
    briefings = brief(scenario, [scenario.arm(arm) for arm in arms], place, scenario.target)
    poses = place.reachable.sample_poses(POSES // 10, rng)
    seconds: list[list[float]] = []
    while len(seconds) < count:
        spot = rng.choice(briefings[0].supports.centres)
        try:
            with build_world(with_cup_at(scenario, spot), place, "C") as world:
                if world.visible(poses)[:, 0].any():
                    seeds = qsr.TrialSeeds(SEED, len(seconds))
                    seconds.append([timed(world, one, place.reachable, seeds) for one in briefings])
        except qsr.QSRError:
            continue
    table = np.array(seconds)
    for arm, times in zip(arms, table.T, strict=True):
        print(f"    {arm:14s} {times.mean():6.1f} s  {times.std() / math.sqrt(count):.1f}", flush=True)


def with_cup_at(scenario: qsr.Scenario, spot: np.ndarray) -> qsr.Scenario:
    x, y, z = (float(value) for value in spot)
    moved = {"x": x, "y": y, "z": z + ABOVE}
    placements = [
        one.model_copy(update=moved if one.name == "cup-moved" else {}) for one in scenario.placements
    ]
    return replace(scenario, placements=tuple(placements))


def timed(world, briefing, reachable: qsr.NavigationGrid, seeds: qsr.TrialSeeds) -> float:
    world.reset()
    result = run_trial(world, briefing, reachable, seeds)
    return result.seconds if result.found else briefing.limits.seconds
