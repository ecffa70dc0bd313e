"""Search against its limits and its peers: kernels, regret in random rooms, pomdp-py's own domain, the paper's kitchen.

`make bench-search` runs all of it; `--only kernels rooms pomdp kitchen` some of it. What needs maps that are not there,
or a peer that is not installed, says so and is left out. `--figures` draws those of docs/explanation/search.md.
"""

from __future__ import annotations

import argparse
import os
import subprocess
from pathlib import Path

import numpy as np
from kitchen_searches import CASES, DRAWN, tell_case, tell_knowledge, tell_noise, tell_strewn
from numba import njit
from random_rooms import excesses
from timing import best_of

import qsrlang as qsr
from qsrlang.maps.occlusion import clear_rays
from qsrlang.planning.frusta import eyes_of
from qsrlang.planning.planners.planner import Situation
from qsrlang.planning.threads import over_rows, processors

HERE = Path(__file__).parent
IMAGES = HERE.parent / "docs" / "images"
PEERS = Path(os.environ.get("QSR_PEERS", HERE.parent / ".peers")) / "bin" / "python"
PARTS = ("kernels", "rooms", "pomdp", "kitchen")
SEED = 1


@njit(nogil=True, fastmath=True)
def _limit(poses, xs, ys, values, first, last):
    """The least arithmetic that decides whether a voxel is in a triangle: a turn and three comparisons."""
    for n in range(first, last):
        cos, sin, px, py, total = np.cos(poses[n, 2]), np.sin(poses[n, 2]), poses[n, 0], poses[n, 1], 0.0
        for k in range(len(xs)):
            dx, dy = xs[k] - px, ys[k] - py
            x, y = cos * dx + sin * dy, cos * dy - sin * dx
            total += 1.0 if (x <= 3.0) & (abs(y) * 3.0 <= x) else 0.0
        values[n] = total


def bench_values(poses: int, voxels: int) -> tuple[float, float]:
    rng = np.random.default_rng(0)
    where = np.column_stack([rng.uniform(0, 10, (poses, 2)), rng.uniform(-3, 3, poses)])
    places, weights = rng.uniform(0, 10, (voxels, 2)), rng.random(voxels)
    xs, ys, values = places[:, 0].copy(), places[:, 1].copy(), np.empty(poses)
    cone, repeats = qsr.Triangle(3.0, 1.0), 5 if poses * voxels < 1e9 else 1
    ours = best_of(lambda: qsr.view_values(where, cone, places, weights), repeats)
    limit = best_of(
        lambda: over_rows(lambda a, b: _limit(where, xs, ys, values, a, b), poses, poses * voxels), repeats
    )
    return ours, limit


def bench_kernels(figures: bool) -> None:
    print(f"kernels, {processors()} processors")
    ours, limit = bench_values(1_000, 100_000)
    print(
        f"  equation 3, 1,000 poses x 100,000 voxels  {1e3 * ours:8.1f} ms  {ours / limit:5.2f} x the bare arithmetic"
    )
    sizes, times = [(100, 10_000), (1_000, 100_000), (3_000, 300_000), (10_000, 1_000_000)], []
    for count, voxels in sizes:
        seconds, bare = bench_values(count, voxels)
        times.append(seconds)
        print(
            f"  {count:6,} x {voxels:9,}  {1e3 * seconds:9.1f} ms  {count * voxels / seconds / 1e9:5.1f} thousand "
            f"million pairs/s  {seconds / bare:5.2f} x the bare arithmetic"
        )
    if figures:
        pairs = [count * voxels for count, voxels in sizes]
        save_lines(
            {"equation 3": (pairs, times)},
            "pairs of a pose and a voxel",
            "time [s]",
            "search-growth",
            log=True,
        )
    bench_kitchen_decision()


def bench_kitchen_decision() -> None:
    scenario = scenario_of("tum-kitchen") or qsr.load_scenario("kitchen")
    print(f"  one decision in {scenario.name}, camera {scenario.camera_name}")
    opening = qsr.open_search(scenario, planner="rollout" if "rollout" in scenario.arms else "belief")
    planner, reachable = opening.briefing.planner, opening.place.reachable
    goal = planner.goals[0]
    rng = np.random.default_rng(0)
    points = goal.belief.points_map
    seen_from = eyes_of(reachable.sample_poses(300, rng), scenario.camera, scenario.floor_height)
    view, place = np.nonzero(np.linalg.norm(points[None] - seen_from[:, None], axis=2) < goal.sight.reach)
    eyes, ends = seen_from[view], points[place]
    voxels = opening.place.voxels
    alone = best_of(lambda: clear_rays(voxels, eyes, ends), 3)
    shared = best_of(
        lambda: over_rows(lambda a, b: clear_rays(voxels, eyes[a:b], ends[a:b]), len(eyes), len(eyes)), 3
    )
    print(
        f"    {len(eyes):,} rays within range: {len(eyes) / alone / 1e6:.1f} million/s in one thread, "
        f"{len(eyes) / shared / 1e6:.1f} million/s in {processors()}"
    )
    places = reachable.sample_poses(400, rng)
    seconds = best_of(lambda: goal.sight.all_round(places[:, :2], points), 3)
    near = np.linalg.norm(
        points[None] - eyes_of(places, scenario.camera, scenario.floor_height)[:, None], axis=2
    )
    rays = np.count_nonzero(near <= goal.sight.reach)
    print(
        f"    an atlas, from 400 places to all {len(points):,} voxels: {near.size / seconds / 1e6:.1f} million pairs/s "
        f"in {processors()}, {rays / seconds / 1e6:.1f} million of them within range"
    )
    pose = scenario.start
    field = qsr.DistanceField.from_start(reachable, (pose.x, pose.y))
    drawn = reachable.sample_poses(500, rng)
    situation = Situation(drawn, pose, field, 120.0)
    for name, strategy in (("index", qsr.Index()), ("belief", qsr.Gain())):
        cold = qsr.BeliefPlanner((without_atlas(goal),), scenario.robot, strategy)
        seconds = best_of(lambda cold=cold: cold.choose(situation, rng))
        print(
            f"    {name}: 500 random poses, 3D views with occlusion, {len(points):,} voxels: {1e3 * seconds:.1f} ms"
        )
    if goal.atlas is not None:
        seconds = best_of(lambda: planner.choose(situation, rng))
        print(
            f"    rollout: its own candidates from an atlas of {len(goal.atlas.views):,} views: {1e3 * seconds:.1f} ms"
        )


def without_atlas(goal: qsr.Goal) -> qsr.Goal:
    return qsr.Goal(goal.target, goal.belief, goal.sight, goal.detector)


def scenario_of(name: str, camera: str | None = None, noise: qsr.Noise | None = None) -> qsr.Scenario | None:
    try:
        return qsr.load_scenario(name, camera, noise=noise)
    except qsr.FileError as error:
        print(f"  left out: {error}")
        return None


def bench_rooms(figures: bool) -> None:
    print(
        "random rooms: 100 of 10 overlapping views; mean excess over the exact optimum (dynamic programming)"
    )
    found = excesses(100, 10, SEED)
    for name, excess in found.items():
        low, high = np.quantile(
            np.random.default_rng(0).choice(excess, (2_000, len(excess))).mean(axis=1), [0.025, 0.975]
        )
        print(
            f"  {name:28s} mean {excess.mean():6.1%} [{low:.1%}, {high:.1%}]  median {np.median(excess):6.1%}  "
            f"worst {excess.max():6.1%}  exact in {np.mean(excess < 1e-6):4.0%}"
        )
    if figures:
        shares = np.append(np.arange(1, 101) / 100.0, 1.0)
        curves = {name: (np.append(np.sort(100.0 * excess), 500.0), shares) for name, excess in found.items()}
        save_lines(curves, "cost above the best order [%]", "share of rooms", "search-regret", limit=120.0)


def bench_pomdp(options: argparse.Namespace) -> None:
    print("pomdp-py's multi-object search, its own domain")
    if not PEERS.is_file():
        print(
            f"  left out: {PEERS} is not there; `make peers` installs pomdp-py beside qsrlang, or set QSR_PEERS"
        )
        return
    command = [str(PEERS), str(HERE / "peer_pomdp.py"), "--seeds", str(options.seeds)]
    command += ["--kept", str(options.kept)] if options.kept else []
    subprocess.run(command, check=True, env={**os.environ, "SDL_VIDEODRIVER": "dummy"})


def bench_kitchen(options: argparse.Namespace) -> None:
    print("the paper's kitchen, its robot 0.5 m/s, 1 rad/s, 3 s a look")
    if scenario_of("tum-kitchen") is None:
        return
    for variant, camera in CASES:
        result = tell_case(variant, camera, options.trials)
        if options.figures:
            times = {arm: [t.seconds if t.found else np.inf for t in result.of(arm)] for arm in DRAWN}
            figure = qsr.draw_found_by_time(times, 120.0)
            qsr.save_figure(figure, IMAGES / f"search-found-{variant}-{camera}.png")
    knowledge, noise = tell_knowledge(options.trials // 4), tell_noise(options.trials // 4)
    tell_strewn(options.trials // 4)
    if options.figures:
        save_lines(
            knowledge, "displacement of the known landmarks [m]", "censored mean time [s]", "search-knowledge"
        )
        noise = {name: curve for name, curve in noise.items() if "0.02" not in name}
        save_lines(noise, "detection rate of the camera", "censored mean time [s]", "search-noise")


def save_lines(curves, x: str, y: str, name: str, **options) -> None:
    IMAGES.mkdir(exist_ok=True)
    qsr.save_figure(qsr.draw_curves(curves, x, y, **options), IMAGES / f"{name}.png")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--kept", type=Path, help="a file of POUCT's finished runs: read first, and added to")
    parser.add_argument("--figures", action="store_true")
    options = parser.parse_args()
    if "kernels" in options.only:
        bench_kernels(options.figures)
    if "rooms" in options.only:
        bench_rooms(options.figures)
    if "pomdp" in options.only:
        bench_pomdp(options)
    if "kitchen" in options.only:
        bench_kitchen(options)


if __name__ == "__main__":
    main()
