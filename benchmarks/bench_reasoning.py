"""From knowledge to mixture to the value of a view: times in one run, each beside a limit or a plainer way.

python benchmarks/bench_reasoning.py
"""

from __future__ import annotations

import numpy as np
from timing import middle_of

import qsrlang as qsr
from qsrlang.maps.occlusion import clear_rays

MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)"
DESK = "desk-1 : Desk at (0 m, -0.2 m) facing -90 deg"


def show(what: str, took: float, beside: str) -> None:
    print(f"{what:58s} {1e3 * took:10.2f} ms   {beside}")


def inference() -> None:
    desk = qsr.load("office/desk")
    free, placed = desk.with_landmarks(MONITOR), desk.with_landmarks(MONITOR, DESK)
    exact = middle_of(lambda: free.where("Cup"))
    show("where Cup?, landmark uncertain", exact, "")
    show(
        "where Bottle?, three hops, with the edge of the desk", middle_of(lambda: placed.where("Bottle")), ""
    )
    rng = np.random.default_rng(0)
    drawn = middle_of(lambda: free.where("Cup", engine="sampling", samples=100_000, rng=rng), 3)
    show("where Cup? by 100,000 samples, as in the paper", drawn, f"{drawn / exact:.0f} x the exact moments")


def views() -> None:
    rng = np.random.default_rng(0)
    poses, voxels = rng.uniform(-5.0, 5.0, (500, 3)), rng.uniform(-5.0, 5.0, (20_000, 2))
    weights, cone = rng.random(20_000), qsr.Triangle(3.0, 1.0)
    pairs = len(poses) * len(voxels)
    plane = np.empty((len(poses), len(voxels)))
    limit = middle_of(lambda: np.add.outer(poses[:, 0], voxels[:, 0], out=plane), 3)
    took = middle_of(lambda: qsr.view_values(poses, cone, voxels, weights), 3)
    show(
        "equation 3, 500 poses x 20,000 voxels",
        took,
        f"{pairs / took / 1e6:.0f} M pairs/s, {took / limit:.2g} x one sum",
    )
    states = np.where(rng.random((160, 240, 50)) < 0.02, qsr.Cell.OCCUPIED, qsr.Cell.FREE).astype(np.uint8)
    grid = qsr.VoxelGrid(states, 0.05, np.zeros(3), "noise")
    ends = rng.uniform([0.0, 0.0, 0.0], [8.0, 12.0, 2.5], (100_000, 3))
    starts = np.broadcast_to([4.0, 6.0, 1.7], ends.shape)
    took = middle_of(lambda: clear_rays(grid, starts, ends), 3)
    show("occlusion, 100,000 rays through noise", took, f"{len(ends) / took / 1e6:.1f} M rays/s")


def relations() -> None:
    points = np.random.default_rng(0).normal(size=(3, 2_000_000, 2))
    took = middle_of(lambda: qsr.qualify(*points), 3)
    limit = middle_of(lambda: points[1] - points[0], 3)
    rate = points.shape[1] / took / 1e6
    show("TPCC relations of 2,000,000 triples", took, f"{rate:.0f} M/s, {took / limit:.1f} x one difference")


def labels() -> None:
    """How often a viewer at a point gives a pair another direction than the shared frame of all pairs does."""
    rng = np.random.default_rng(0)
    relata, referents = rng.uniform([-0.75, -0.4], [0.75, 0.4], (2, 200_000, 2))
    shared = qsr.direction_of(qsr.qualify(relata - [0.0, 1.0], relata, referents))
    for distance in (1.2, 2.5, 10.0):
        seen = qsr.direction_of(qsr.qualify(np.array([0.0, -distance]), relata, referents))
        share = 100.0 * float(np.mean(seen != shared))
        print(f"{f'pairs on a desk labelled otherwise by a viewer {distance} m away':58s} {share:10.1f} %")


def scattered(objects: int, atoms: int, landmarks: int) -> str:
    """Return knowledge that is true of random points: directions on the map between random pairs."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-5.0, 5.0, (objects, 2))
    names = [f"thing-{n}" if n < landmarks else f"Thing{n}" for n in range(objects)]
    numbers = (sorted(rng.permutation(objects)[:2].tolist(), reverse=True) for _ in range(2 * atoms))
    pairs = list(dict.fromkeys((one, other) for one, other in numbers))[:atoms]
    said = [one for one in qsr.relations_between(names, points, pairs=pairs) if "absolute" in one]
    declared = ", ".join(f"Thing{n}" for n in range(landmarks, objects))
    placed = [
        f"static Kind{n}. landmark thing-{n} : Kind{n} at ({points[n, 0]} m, {points[n, 1]} m)."
        for n in range(landmarks)
    ]
    return "\n".join([f"dynamic {declared}.", *placed, *(f"require {one}." for one in said)])


def consistency() -> None:
    desk = qsr.load("office/desk").graph
    show("consistency of the desk of Fig. 2", middle_of(lambda: qsr.find_conflicts(desk)), "")
    free = qsr.parse_knowledge(scattered(200, 600, 0)).graph
    took = middle_of(lambda: qsr.find_conflicts(free))
    show("consistency, 200 objects, 600 directions", took, "two orders, no numbers")
    placed = qsr.parse_knowledge(scattered(200, 600, 20)).graph
    numbers = middle_of(lambda: qsr.find_conflicts(placed))
    show("the same, 20 landmarks: linear programme", numbers, f"{numbers / took:.1f} x the orders")
    circle = "require left-of(Thing0, Thing1) wrt absolute ∧ left-of(Thing1, Thing2) wrt absolute ∧ "
    wrong = f"{scattered(200, 600, 0)}\n{circle} left-of(Thing2, Thing0) wrt absolute."
    broken = qsr.parse_knowledge(wrong).graph
    found = qsr.find_conflicts(broken).conflicts
    shown = f"{len(found)} minimal, of {', '.join(str(len(one.atoms)) for one in found)} atoms, with their changes"
    show("its conflicts, with a circle of three", middle_of(lambda: qsr.find_conflicts(broken), 3), shown)


def assumptions() -> None:
    known = qsr.load("office/desk").with_landmarks(MONITOR)
    for query in ("prob right-of(Cup, Keyboard)?", "where Cup given close-to(Cup, Keyboard)?"):
        show(f"{query[:-1]}, 10,000 draws", middle_of(lambda query=query: known.ask(query)), "")


if __name__ == "__main__":
    inference()
    assumptions()
    relations()
    consistency()
    labels()
    views()
