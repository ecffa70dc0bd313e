"""A World of pybullet: a robot that drives through a prepared scene and looks for objects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import TracebackType

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import BlockedPoseError, NoNavigablePoseError, OutsideMapError, QSRError, ValueRangeError
from qsrlang.geometry.angles import unit
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.planning.world import Detection, Drive, Look
from qsrlang.simulation.camera import SemanticCamera, targets_of
from qsrlang.simulation.depth import DepthImage, depth_image
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.robot import RobotBody
from qsrlang.simulation.rooms import Room
from qsrlang.simulation.scene import Scene, scene_of_room, scene_of_voxels

PROBE_RINGS = np.arange(0.1, 3.05, 0.1)
PROBES_PER_RING = 24


class PybulletWorld:
    """A robot in a simulated place; implements `qsrlang.planning.world.World`. Poses are in the map frame.

    It lives until `close`, or use it in `with`. `reset` puts the robot back: one world serves many trials.
    Nothing in it is random: the same scene gives the same poses to the bit, beside other worlds or not.
    """

    def __init__(self, scene: Scene, robot: Robot, camera: Camera, start: Pose2) -> None:
        self.scene, self._robot, self._start = scene, robot, start
        self._targets = targets_of(scene.engine, [entry for entry in scene.things if entry[0].recognised])
        self._specs = camera
        self._camera = SemanticCamera(scene.engine, camera, scene.floor, self._targets)
        self._body = RobotBody(scene.engine, robot, camera, scene.floor)
        self._pose = start
        self.reset()

    @classmethod
    def from_room(
        cls,
        room: Room,
        placements: Sequence[Placement],
        robot: Robot,
        camera: Camera,
        start: Pose2 | None = None,
    ) -> PybulletWorld:
        """Build a furnished room with placed objects; without `start` the robot starts where the room says.

        Raises OutsideMapError, ValueRangeError where an object does not stay where it is put, and
        BlockedPoseError where the robot would start in something.
        """
        return cls._of(scene_of_room(room, placements), robot, camera, start or room.start)

    @classmethod
    def from_voxels(
        cls,
        voxels: VoxelGrid,
        placements: Sequence[Placement],
        robot: Robot,
        camera: Camera,
        start: Pose2,
        floor_height: float,
    ) -> PybulletWorld:
        """Build the occupied voxels of a map, floor at `floor_height` [m], with placed objects.

        Raises as `from_room` does.
        """
        return cls._of(scene_of_voxels(voxels, placements, floor_height), robot, camera, start)

    @classmethod
    def _of(cls, scene: Scene, robot: Robot, camera: Camera, start: Pose2) -> PybulletWorld:
        try:
            return cls(scene, robot, camera, start)
        except BaseException:
            scene.engine.close()
            raise

    def close(self) -> None:
        """Free the world; closing twice is fine."""
        self.scene.engine.close()

    def __enter__(self) -> PybulletWorld:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def robot_pose(self) -> Pose2:
        """Where the robot stands."""
        return self._pose

    @property
    def objects(self) -> tuple[Detection, ...]:
        """The truth: everything the camera could recognise, where it rests."""
        return tuple(self._targets.detection(index) for index in range(len(self._targets.names)))

    def reset(self, pose: Pose2 | None = None) -> None:
        """Put the robot at a pose, by default back to its start.

        Raises OutsideMapError and BlockedPoseError where it cannot stand there; it then stays where it was.
        """
        pose = pose or self._start
        x0, y0, x1, y1 = self.scene.bounds
        if not (x0 <= pose.x <= x1 and y0 <= pose.y <= y1):
            raise OutsideMapError("the robot", (pose.x, pose.y), self.scene.bounds, self.scene.source)
        if not self._body.fits(pose):
            error = self._blocked(pose)
            self._body.put(self._pose)
            raise error
        self._pose = pose

    def _blocked(self, pose: Pose2) -> QSRError:
        radius, source = self._body.radius, self.scene.source
        for place in _around(pose):
            if self._body.fits(place):
                return BlockedPoseError("the robot", (pose.x, pose.y), radius, source, (place.x, place.y))
        return NoNavigablePoseError(source, radius)

    def drive(self, path: FloatArray, yaw: float) -> Drive:
        """Drive along the points (K, 2) of a path, first its own place, and turn to `yaw` at the end.

        It turns on the spot at every corner; seconds = travel / speed + turn / turn rate. Where it would
        touch something it stops short and makes the last turn there: `reached` is then not the path's end.
        """
        points = np.asarray(path, dtype=np.float64)
        if points.ndim != 2 or points.shape[1:] != (2,) or not len(points) or not np.isfinite(points).all():
            raise ValueRangeError("the shape of a path", points.shape, "(K, 2) finite points, at least one")
        self._pose, travel, turn = self._body.follow(self._pose, points, yaw)
        return Drive(self._pose, travel, turn, travel / self._robot.speed + turn / self._robot.turn_rate)

    def look(self, tilt: float | None = None) -> Look:
        """Dwell, look once, and return what was recognised; `tilt` [rad] stands in for that of the camera."""
        return Look(self._camera.tilted(tilt).detections(self._pose), self._robot.dwell)

    def is_free(self, pose: Pose2) -> bool:
        """Return whether the robot would touch nothing at a pose."""
        fits = self._body.fits(pose)
        self._body.put(self._pose)
        return fits

    def visible(self, poses: FloatArray) -> BoolArray:
        """Return which of `objects` (K) a look from each of the poses (N, 3) would show: (N, K)."""
        return self._camera.visible(np.asarray(poses, dtype=np.float64))

    def visible_fractions(self, poses: FloatArray) -> FloatArray:
        """Return the share (N, K) of each of `objects` that nothing hides, by 27 rays, from poses (N, 3)."""
        return self._camera.visible_fractions(np.asarray(poses, dtype=np.float64))

    def depth_image(self, width: int = 320, height: int = 240) -> DepthImage:
        """Return what a depth camera in the place of the robot's camera sees now."""
        with self.robot_out_of(None):
            return depth_image(self.scene.engine, self._specs, self._pose, self.scene.floor, width, height)

    @contextmanager
    def robot_out_of(self, eye: FloatArray | None) -> Iterator[None]:
        """Take the robot out of sight for a while, if it stands around `eye` (3,) or if no eye is given."""
        if eye is None or np.hypot(*(eye[:2] - self._pose.position)) < 2 * self._body.radius:
            self._body.vanish()
        try:
            yield
        finally:
            self._body.put(self._pose)


def _around(pose: Pose2) -> Iterator[Pose2]:
    for radius in PROBE_RINGS:
        for angle in np.linspace(0.0, 2 * np.pi, PROBES_PER_RING, endpoint=False):
            x, y = pose.position + radius * unit(angle)
            yield Pose2(float(x), float(y), pose.yaw)
