"""A semantic camera: which objects are in view, by frustum and rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.frusta import axes_of, eyes_of
from qsrlang.planning.sensing import Camera
from qsrlang.planning.world import Detection
from qsrlang.simulation.engine import NOTHING, Engine
from qsrlang.simulation.rooms import Thing

FRACTION_SPREAD = 0.8


@dataclass(frozen=True, slots=True, eq=False)
class Targets:
    """K objects a camera recognises: bodies (K,), boxes' corners (K, 8, 3), centres and aims (K, 3) [m].

    The aim is the point a ray must reach: the centre of the first part.
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    bodies: IntArray
    corners: FloatArray
    centres: FloatArray
    aims: FloatArray

    def __post_init__(self) -> None:
        count = len(self.names)
        for field, shape in (("corners", (count, 8, 3)), ("centres", (count, 3)), ("aims", (count, 3))):
            object.__setattr__(
                self, field, frozen_array(f"the {field} of targets", getattr(self, field), shape)
            )

    def detection(self, index: int) -> Detection:
        """Return what a camera reports of one of them: name, class and the centre of its box."""
        x, y, z = self.centres[index].tolist()
        return Detection(self.names[index], self.kinds[index], (x, y, z))


def targets_of(engine: Engine, things: Sequence[tuple[Thing, int]]) -> Targets:
    """Return the targets for things, given with their bodies, where the physics has them now."""
    corners, centres, aims = (
        np.zeros((len(things), 8, 3)),
        np.zeros((len(things), 3)),
        np.zeros((len(things), 3)),
    )
    for index, (thing, body) in enumerate(things):
        place, turn = engine.pose_of(body)
        box, centroid = thing.box, thing.centroid
        picks = np.stack(np.unravel_index(np.arange(8), (2, 2, 2)), axis=-1)
        local = np.take_along_axis(box, picks, axis=0)
        corners[index] = place + (local - centroid) @ turn.T
        centres[index] = place + turn @ (box.mean(axis=0) - centroid)
        aims[index] = place + turn @ (thing.parts[0].centre - centroid)
    names, kinds = tuple(thing.name for thing, _ in things), tuple(thing.kind for thing, _ in things)
    return Targets(
        names, kinds, np.array([body for _, body in things], dtype=np.int64), corners, centres, aims
    )


def boxes_in_frustum(camera: Camera, corners_camera: FloatArray) -> BoolArray:
    """Return which boxes, corners (..., 8, 3) as (forward, left, up), are not outside the frustum: (...,).

    A box is outside where one of the six planes of the frustum has all its corners behind it: the test of the
    simulator used in Kunze et al. 2014 (`boxInsideFrustum`).
    """
    forward, left, up = corners_camera[..., 0], corners_camera[..., 1], corners_camera[..., 2]
    wide, high = np.tan(0.5 * camera.horizontal_fov) * forward, np.tan(0.5 * camera.vertical_fov) * forward
    planes = np.stack(
        [forward - camera.near, camera.far - forward, wide - left, wide + left, high - up, high + up]
    )
    return np.asarray((planes.max(axis=-1) >= 0.0).all(axis=0))


class SemanticCamera:
    """Says which targets are recognised from a pose: the box in the frustum and a free ray to its aim."""

    def __init__(self, engine: Engine, camera: Camera, floor: float, targets: Targets) -> None:
        self._engine, self._camera, self._floor, self._targets = engine, camera, floor, targets

    def tilted(self, tilt: float | None) -> SemanticCamera:
        """Return the camera with another tilt [rad], itself where that is None."""
        if tilt is None or tilt == self._camera.tilt:
            return self
        return SemanticCamera(self._engine, replace(self._camera, tilt=tilt), self._floor, self._targets)

    def visible(self, poses: FloatArray) -> BoolArray:
        """Return which of the K targets are recognised from the poses (N, 3) of x, y, yaw: (N, K)."""
        eyes = eyes_of(poses, self._camera, self._floor)
        seen = self._in_frustum(poses, eyes)
        view, target = np.nonzero(seen)
        if len(view):
            hits = self._engine.rays(eyes[view], self._targets.aims[target])
            seen[view, target] = hits.bodies == self._targets.bodies[target]
        return seen

    def detections(self, pose: Pose2) -> tuple[Detection, ...]:
        """Return the detections of one look from a pose, in the order of the targets."""
        seen = self.visible(np.array([[pose.x, pose.y, pose.yaw]]))[0]
        return tuple(self._targets.detection(int(index)) for index in np.flatnonzero(seen))

    def visible_fractions(self, poses: FloatArray) -> FloatArray:
        """Return the share (N, K) of 27 points in each box that nothing else hides; 0 outside the frustum."""
        eyes = eyes_of(poses, self._camera, self._floor)
        fractions = np.zeros((len(poses), len(self._targets.names)))
        view, target = np.nonzero(self._in_frustum(poses, eyes))
        if len(view):
            points = _lattice(self._targets.corners[target])
            hits = self._engine.rays(np.repeat(eyes[view], 27, axis=0), points.reshape(-1, 3))
            own = np.repeat(self._targets.bodies[target], 27)
            free = (hits.bodies == own) | (hits.bodies == NOTHING)
            fractions[view, target] = free.reshape(-1, 27).mean(axis=1)
        return fractions

    def _in_frustum(self, poses: FloatArray, eyes: FloatArray) -> BoolArray:
        offsets = self._targets.corners.reshape(1, -1, 3) - eyes[:, None, :]
        corners_camera = offsets @ axes_of(poses, self._camera).transpose(0, 2, 1)
        return boxes_in_frustum(self._camera, corners_camera.reshape(len(poses), -1, 8, 3))


def _lattice(corners: FloatArray) -> FloatArray:
    """Return 3 x 3 x 3 points (V, 27, 3) in boxes of corners (V, 8, 3), FRACTION_SPREAD of them wide."""
    steps = np.stack(np.meshgrid(*[np.array([-1.0, 0.0, 1.0])] * 3, indexing="ij"), axis=-1).reshape(27, 3)
    centre = corners.mean(axis=1)
    halves = 0.5 * (corners[:, [4, 2, 1]] - corners[:, :1])
    return np.asarray(centre[:, None] + FRACTION_SPREAD * np.einsum("pa,vaj->vpj", steps, halves))
