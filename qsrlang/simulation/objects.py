"""Objects that are put into a world: dropped from just above a surface, then left to physics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.simulation.engine import Engine
from qsrlang.simulation.rooms import Colour, Part, Shape, Thing
from qsrlang.simulation.surfaces import STEEPEST, surfaces_under

DENSITY = 600.0
DROP_GAP = 0.002
MAX_REACH = 1.6
TIME_STEP = 1.0 / 240.0
STEPS_PER_CHECK = 12
CALM_CHECKS = 3
MAX_STEPS = 1_440
REST_SPEED, REST_TURN_RATE = 0.005, 0.05
MAX_DRIFT = 0.05


@dataclass(frozen=True, slots=True)
class Placement:
    """Where an object is put: its centre x, y [m], its size (x, y, z) [m], its yaw [rad], map frame.

    It is dropped on the surface below `z`, or, without `z`, on the highest surface that an arm reaches
    (MAX_REACH above the floor). With a `z` a voxel map is cut free inside the box that stands on `z`.
    """

    name: str
    kind: str
    x: float
    y: float
    size: tuple[float, float, float] = (0.08, 0.08, 0.10)
    z: float | None = None
    yaw: float = 0.0
    shape: Shape = Shape.CYLINDER
    colour: Colour = (0.85, 0.25, 0.15)

    def __post_init__(self) -> None:
        if not all(math.isfinite(value) for value in (self.x, self.y, self.z or 0.0)):
            raise ValueRangeError(
                f"the place of {self.name}", (self.x, self.y, self.z), "finite numbers of metres"
            )
        if not all(0.01 <= side <= 2.0 for side in self.size):
            raise ValueRangeError(f"the size of {self.name}", self.size, "0.01 to 2 m a side")

    def thing(self, surface: float) -> Thing:
        """Return the thing as it starts its fall, a gap above the surface at this height [m]."""
        part = Part(self.shape, self.size, (0.0, 0.0, 0.0), self.colour)
        pose, mass = Pose2(self.x, self.y, self.yaw), DENSITY * part.volume
        return Thing(self.name, self.kind, pose, surface + DROP_GAP, (part,), mass, recognised=True)


def boxes_to_clear(placements: Sequence[Placement]) -> list[FloatArray]:
    """Return the boxes (2, 3), map frame, in which placements that name their height are to stand."""
    boxes = []
    for placed in placements:
        if placed.z is not None:
            reach = 0.5 * math.hypot(*placed.size[:2]) if placed.yaw else 0.5 * max(placed.size[:2])
            foot = np.array([placed.x, placed.y, placed.z])
            half = np.array([reach, reach, 0.0])
            boxes.append(
                np.stack([foot - half, foot + half + np.array([0.0, 0.0, placed.size[2] + DROP_GAP])])
            )
    return boxes


def surface_below(engine: Engine, placed: Placement, floor: float) -> float:
    """Return the height of the highest surface under the footprint of a placement that has room for it [m].

    Raises ValueRangeError where there is none under its centre, below its `z` or MAX_REACH above the floor.
    """
    top = floor + MAX_REACH if placed.z is None else placed.z + DROP_GAP
    foot = _footprint(placed)
    heights = surfaces_under(engine, foot, floor, placed.size[2] + DROP_GAP).highest(len(foot), top)
    if np.isnan(heights[0]):
        where = f"({placed.x:.2f} m, {placed.y:.2f} m), below z = {top:.2f} m"
        raise ValueRangeError(
            f"the place of {placed.name}", where, "a place above a surface with room for it"
        )
    return float(np.nanmax(heights))


def _footprint(placed: Placement) -> FloatArray:
    half = 0.4 * np.array(placed.size[:2])
    steps = np.array([[0, 0], [1, 1], [1, -1], [-1, 1], [-1, -1], [1, 0], [-1, 0], [0, 1], [0, -1]])
    return Pose2(placed.x, placed.y, placed.yaw).transform(steps * half)


def settle(engine: Engine, dropped: Sequence[tuple[Thing, int]]) -> None:
    """Step the physics until all things, given with their bodies, rest.

    Raises ValueRangeError where one leaves the place it was dropped at by more than MAX_DRIFT, or tips over.
    """
    before = [engine.pose_of(body)[0] for _, body in dropped]
    calm = 0
    for _ in range(0, MAX_STEPS if dropped else 0, STEPS_PER_CHECK):
        engine.step(STEPS_PER_CHECK, TIME_STEP)
        calm = calm + 1 if all(engine.is_slow(body, REST_SPEED, REST_TURN_RATE) for _, body in dropped) else 0
        if calm == CALM_CHECKS:
            break
    for (thing, body), start in zip(dropped, before, strict=True):
        _check_rest(engine, thing, body, start)


def _check_rest(engine: Engine, thing: Thing, body: int, start: FloatArray) -> None:
    place, turn = engine.pose_of(body)
    drift = np.abs(place - start)
    if drift.max() > MAX_DRIFT or turn[2, 2] < STEEPEST:
        where = f"({thing.pose.x:.2f} m, {thing.pose.y:.2f} m)"
        problem = f"({place[0]:.2f} m, {place[1]:.2f} m, {place[2]:.2f} m) after it was put down at {where}"
        raise ValueRangeError(
            f"where {thing.name} came to rest", problem, "to stay there; move it off the edge"
        )
    if not engine.is_slow(body, 10 * REST_SPEED, 10 * REST_TURN_RATE):
        raise ValueRangeError(
            f"the speed of {thing.name}", "still above 0", "rest within 6 s; give it a flat side"
        )
