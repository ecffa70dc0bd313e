"""A world whose camera errs: it misses things in view, and reports the target where it is not."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.sight import Sight
from qsrlang.planning.world import Detection, Drive, Look, World

FALSE_ALARM = "false alarm"
VIEW_LENGTH, VIEW_ANGLE = 0.25, math.pi / 12.0
"""Looks from one square of this side [m] within one such sector [rad] err in the same way."""


@dataclass(frozen=True, slots=True)
class Noise:
    """How a camera errs: it shows a share `detection_rate` of what is in view, and in a share `false_alarms` of its
    looks a target where it is not."""

    detection_rate: float = 1.0
    false_alarms: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < self.detection_rate <= 1.0:
            raise ValueRangeError("the detection rate of a camera", self.detection_rate, "above 0, at most 1")
        if not 0.0 <= self.false_alarms < 1.0:
            raise ValueRangeError("the false alarms of a camera", self.false_alarms, "0 or more, below 1")

    @property
    def is_none(self) -> bool:
        """Whether the camera does not err."""
        return self.detection_rate == 1.0 and self.false_alarms == 0.0


class NoisyWorld:
    """A world seen through a camera with `noise`; what it draws depends on trial, view and object, and on nothing else.

    So all arms of a comparison meet the same errors, and to look twice from one view is of no use. False alarms for
    the classes of `targets` lie at places (K, 3) [m] in view by `sight`.
    """

    def __init__(
        self,
        world: World,
        noise: Noise,
        seeds: TrialSeeds,
        targets: tuple[str, ...],
        sight: Sight,
        places_map: npt.ArrayLike,
    ) -> None:
        self._world, self._noise, self._seeds = world, noise, seeds
        self._targets, self._sight = targets, sight
        self._places: FloatArray = frozen_array("the places of false alarms", places_map, (None, 3))

    @property
    def robot_pose(self) -> Pose2:
        """Where the robot stands."""
        return self._world.robot_pose

    def drive(self, path: FloatArray, yaw: float) -> Drive:
        """Drive along the points (K, 2) of a path and turn to `yaw` at the end."""
        return self._world.drive(path, yaw)

    def look(self, tilt: float | None = None) -> Look:
        """Look once; miss some of what is in view, and perhaps report what is not there."""
        look = self._world.look(tilt)
        seen = [one for one in look.detections if self._draw(one.name).random() < self._noise.detection_rate]
        stray = self._draw(FALSE_ALARM)
        if stray.random() < self._noise.false_alarms:
            seen += self._false_alarm(stray, tilt)
        return Look(tuple(seen), look.seconds)

    def _false_alarm(self, rng: np.random.Generator, tilt: float | None) -> list[Detection]:
        pose = self.robot_pose
        tilts = None if tilt is None else np.array([tilt])
        (visible,) = self._sight.visible([[pose.x, pose.y, pose.yaw]], self._places, tilts)
        places = self._places[visible]
        if not len(places):
            return []
        x, y, z = places[rng.integers(len(places))].tolist()
        return [Detection(FALSE_ALARM, self._targets[rng.integers(len(self._targets))], (x, y, z))]

    def _draw(self, name: str) -> np.random.Generator:
        pose = self.robot_pose
        cells = (pose.x / VIEW_LENGTH, pose.y / VIEW_LENGTH, pose.yaw / VIEW_ANGLE)
        view = tuple(math.floor(cell) % (1 << 32) for cell in cells)
        return self._seeds.errors(zlib.crc32(name.encode()), view)
