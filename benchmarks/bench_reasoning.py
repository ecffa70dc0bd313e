"""From knowledge to mixture to the value of a view: times in one run, each beside a limit or a plainer way.

python benchmarks/bench_reasoning.py
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

import qsrlang as qsr
from qsrlang.maps.occlusion import clear_rays

MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)"
DESK = "desk-1 : Desk at (0 m, -0.2 m) facing -90 deg"


def seconds(work: Callable[[], object], repeats: int = 7) -> float:
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def show(what: str, took: float, beside: str) -> None:
    print(f"{what:58s} {1e3 * took:10.2f} ms   {beside}")


def inference() -> None:
    desk = qsr.load("office/desk")
    free, placed = desk.with_landmarks(MONITOR), desk.with_landmarks(MONITOR, DESK)
    exact = seconds(lambda: free.where("Cup"))
    show("where Cup?, landmark uncertain", exact, "")
    show("where Bottle?, three hops, with the edge of the desk", seconds(lambda: placed.where("Bottle")), "")
    rng = np.random.default_rng(0)
    drawn = seconds(lambda: free.where("Cup", engine="sampling", samples=100_000, rng=rng), 3)
    show("where Cup? by 100,000 samples, as in the paper", drawn, f"{drawn / exact:.0f} x the exact moments")


def views() -> None:
    rng = np.random.default_rng(0)
    poses, voxels = rng.uniform(-5.0, 5.0, (500, 3)), rng.uniform(-5.0, 5.0, (20_000, 2))
    weights, cone = rng.random(20_000), qsr.Triangle(3.0, 1.0)
    pairs = len(poses) * len(voxels)
    plane = np.empty((len(poses), len(voxels)))
    limit = seconds(lambda: np.add.outer(poses[:, 0], voxels[:, 0], out=plane), 3)
    took = seconds(lambda: qsr.view_values(poses, cone, voxels, weights), 3)
    show(
        "equation 3, 500 poses x 20,000 voxels",
        took,
        f"{pairs / took / 1e6:.0f} M pairs/s, {took / limit:.0f} x one sum",
    )
    states = np.where(rng.random((160, 240, 50)) < 0.02, qsr.Cell.OCCUPIED, qsr.Cell.FREE).astype(np.uint8)
    grid = qsr.VoxelGrid(states, 0.05, np.zeros(3), "noise")
    ends = rng.uniform([0.0, 0.0, 0.0], [8.0, 12.0, 2.5], (100_000, 3))
    starts = np.broadcast_to([4.0, 6.0, 1.7], ends.shape)
    took = seconds(lambda: clear_rays(grid, starts, ends), 3)
    show("occlusion, 100,000 rays through noise", took, f"{len(ends) / took / 1e6:.1f} M rays/s")


def relations() -> None:
    points = np.random.default_rng(0).normal(size=(3, 2_000_000, 2))
    took = seconds(lambda: qsr.qualify(*points), 3)
    limit = seconds(lambda: points[1] - points[0], 3)
    rate = points.shape[1] / took / 1e6
    show("TPCC relations of 2,000,000 triples", took, f"{rate:.0f} M/s, {took / limit:.1f} x one difference")


def assumptions() -> None:
    known = qsr.load("office/desk").with_landmarks(MONITOR)
    for query in ("prob right-of(Cup, Keyboard)?", "where Cup given close-to(Cup, Keyboard)?"):
        show(f"{query[:-1]}, 10,000 draws", seconds(lambda query=query: known.ask(query)), "")


if __name__ == "__main__":
    inference()
    assumptions()
    relations()
    views()
