"""Times the simulated worlds, and holds the supports found in a survey against the truth.

Prints load times, rays a second, milliseconds a view, a depth image and a metre of driving, the time of a survey, and
precision and recall of supports. The OctoMap part needs the data folder and is left out, with a word, without it.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
from scipy import ndimage

from qsrlang.geometry.pose import Pose2
from qsrlang.maps.octomap import read_octomap
from qsrlang.maps.supports import find_supports
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.resources import data_root
from qsrlang.simulation.mesh import clear_boxes, mesh_of
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.roomfiles import load_room
from qsrlang.simulation.scene import scene_of_room
from qsrlang.simulation.surfaces import supporting_voxels
from qsrlang.simulation.survey import survey_room
from qsrlang.simulation.world import PybulletWorld

ROBOT = Robot(clearance=0.5, speed=0.5, turn_rate=1.0, dwell=3.0)
CAMERA = Camera(0.8, 2.5, np.radians(57.0), np.radians(44.3), 1.76, np.radians(-30.0))
ROOM_CUPS = ((1.1, 11.4), (0.4, 1.2), (5.2, 2.5))
TUM_CUPS = ((0.8, -2.4), (-0.5, 4.8), (2.5, 4.8))
TUM_FLOOR = -0.37
RAYS = 15_000
VIEWS = 500


def timed(action: Callable[[], Any]) -> tuple[Any, float]:
    start = perf_counter()
    result = action()
    return result, perf_counter() - start


def line(what: str, value: float, unit: str) -> None:
    print(f"  {what:<58} {value:12,.2f} {unit}")


def cups(places: tuple[tuple[float, float], ...]) -> list[Placement]:
    return [Placement(f"cup-{n}", "Cup", x, y) for n, (x, y) in enumerate(places, 1)]


def bench_world(world: PybulletWorld, drive: np.ndarray) -> None:
    rng = np.random.default_rng(0)
    eye = np.array([world.robot_pose.x, world.robot_pose.y, world.scene.floor + 1.2])
    starts = np.broadcast_to(eye, (RAYS, 3))
    ends = starts + 5.0 * rng.normal(size=(RAYS, 3))
    seconds = min(timed(lambda: world.scene.engine.rays(starts, ends))[1] for _ in range(5))
    line("rays", RAYS / seconds / 1e3, "thousand/s")
    _, seconds = timed(lambda: [world.look() for _ in range(VIEWS)])
    line(f"a view by the rule, {len(world.objects)} objects", seconds / VIEWS * 1e3, "ms")
    x0, y0, x1, y1 = world.scene.bounds
    poses = rng.uniform([x0, y0, -np.pi], [x1, y1, np.pi], size=(VIEWS, 3))
    _, seconds = timed(lambda: world.visible(poses))
    line("a view by the rule, many at once", seconds / VIEWS * 1e3, "ms")
    for width in (160, 320, 640):
        _, seconds = timed(lambda width=width: [world.depth_image(width, width * 3 // 4) for _ in range(3)])
        line(f"a depth image of {width} x {width * 3 // 4}", seconds / 3 * 1e3, "ms")
    report, seconds = timed(lambda: world.drive(drive, 0.0))
    line("driving with contacts checked, a metre", seconds / report.travel * 1e3, "ms")


def bench_room() -> None:
    print("built-in kitchen")
    room = load_room("kitchen")
    world, seconds = timed(lambda: PybulletWorld.from_room(room, cups(ROOM_CUPS), ROBOT, CAMERA))
    line("load, three cups at rest", seconds, "s")
    with world:
        bench_world(world, np.array([[4.0, 6.3], [4.0, 3.9]]))


def bench_octomap() -> None:
    path = data_root() / "tum_kitchen" / "tum_kitchen_octomap.bt"
    print("OctoMap of the TUM kitchen")
    if not path.is_file():
        print(f"  left out: no data at {path}")
        return
    voxels = read_octomap(path).voxel_grid()
    mesh, seconds = timed(lambda: mesh_of(clear_boxes(voxels, []), voxels.resolution, voxels.origin))
    line(f"mesh of {len(mesh.quads):,} merged quads", seconds, "s")
    world, seconds = timed(
        lambda: PybulletWorld.from_voxels(voxels, cups(TUM_CUPS), ROBOT, CAMERA, Pose2(0.0, 0.0), TUM_FLOOR)
    )
    line("load, mesh included, three cups at rest", seconds, "s")
    with world:
        bench_world(world, np.array([[0.0, 0.0], [0.5, -1.0]]))


def bench_survey() -> None:
    print("survey of the built-in kitchen")
    room = load_room("kitchen")
    survey_room(room)
    (_, voxels), seconds = timed(lambda: survey_room(room))
    line("survey, both maps", seconds, "s")
    scene = scene_of_room(room.static_part)
    truth = supporting_voxels(scene.engine, voxels, 0.0)
    scene.engine.close()
    near = np.ones((3, 3, 3), dtype=bool)
    print(f"  supports against {int(truth.sum()):,} true voxels: exact, and with one voxel of tolerance")
    for method in ("pca", "mean-normal"):
        supports, seconds = timed(
            lambda method=method: find_supports(voxels, method, min_height=0.3, max_height=1.5, min_part=40)
        )
        found = np.zeros_like(truth)
        found[tuple(voxels.indices_of(supports.centres).T)] = True
        both = (found & truth).sum()
        precision = (found & ndimage.binary_dilation(truth, near)).sum() / found.sum()
        recall = (truth & ndimage.binary_dilation(found, near)).sum() / truth.sum()
        print(
            f"  {method:<12} precision {both / found.sum():.2f} / {precision:.2f}   "
            f"recall {both / truth.sum():.2f} / {recall:.2f}   {seconds * 1e3:.0f} ms"
        )


if __name__ == "__main__":
    bench_room()
    bench_octomap()
    bench_survey()
