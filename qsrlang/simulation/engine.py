"""One physics server: bodies, rays, contacts and steps, behind a small door."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.errors import QSRError
from qsrlang.simulation.rooms import Part, Shape, centroid_of, turned
from qsrlang.simulation.silence import pybullet

GRAVITY = 9.81
FRICTION, ROLLING_FRICTION = 0.6, 0.001
RAYS_PER_CALL = 16_000
ROBOT_GROUP = 64
WORLD_GROUPS = 1 | 2
NOTHING = -1
LIGHT = {
    "lightDirection": [3.0, -4.0, 9.0],
    "lightColor": [1.0, 1.0, 1.0],
    "lightDistance": 20.0,
    "lightAmbientCoeff": 0.68,
    "lightDiffuseCoeff": 0.42,
    "lightSpecularCoeff": 0.0,
}


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """What N rays met: bodies (N,), NOTHING where a ray ran free, and the fraction (N,) of the way to it.

    The points (N, 3) there, or at the end of a free ray, and the normals (N, 3) are in the map frame [m].
    """

    bodies: IntArray
    fractions: FloatArray
    points: FloatArray
    normals: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """What was drawn: colours (H, W, 3), depth (H, W) from 0 near to 1 far, bodies (H, W) or NOTHING."""

    colours: npt.NDArray[np.uint8]
    depth: FloatArray
    bodies: IntArray


@dataclass(frozen=True, slots=True)
class Lens:
    """What a picture needs of a camera: near and far along the axis [m], fields of view [rad]."""

    near: float
    far: float
    horizontal_fov: float
    vertical_fov: float


class Engine:
    """A physics server of its own, without a window; several live side by side. Close it, or use `with`."""

    def __init__(self) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        if self._client < 0:
            raise QSRError(
                "no further physics server can be started; close the worlds that are no longer needed"
            )
        self._open = True
        self.concave: tuple[int, ...] = ()
        self.call("setGravity", 0.0, 0.0, -GRAVITY)
        self.call("setPhysicsEngineParameter", deterministicOverlappingPairs=1, enableFileCaching=0)

    def call(self, name: str, *arguments: Any, **named: Any) -> Any:
        """Call one function of pybullet in this server."""
        return getattr(pybullet, name)(*arguments, **named, physicsClientId=self._client)

    def close(self) -> None:
        """Stop the server and free its bodies; closing twice is fine."""
        if self._open:
            self._open = False
            pybullet.disconnect(physicsClientId=self._client)

    def __enter__(self) -> Engine:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def add_parts(
        self, parts: Sequence[Part], position: FloatArray, yaw: float, mass: float, looks: Sequence[Part] = ()
    ) -> int:
        """Add one body made of parts given in its frame, at `position` (3,) and `yaw`; mass 0 is static.

        It is drawn as `looks`, given in the same frame, or as its parts.
        """
        centroid = centroid_of(parts)
        colours = [[*part.colour, 1.0] for part in looks or parts]
        collision = self.call(
            "createCollisionShapeArray", **_shapes(parts), collisionFramePositions=_places(parts, centroid)
        )
        visual = self.call(
            "createVisualShapeArray",
            **_shapes(looks or parts),
            visualFramePositions=_places(looks or parts, centroid),
            rgbaColors=colours,
        )
        return self._add_body(mass, collision, visual, position + turned(yaw) @ centroid, yaw)

    def add_mesh(self, path: Path, colour: tuple[float, float, float]) -> int:
        """Add the triangles of an OBJ file, in the map frame, as one static concave body."""
        flags = pybullet.GEOM_FORCE_CONCAVE_TRIMESH
        shape = {"shapeType": pybullet.GEOM_MESH, "fileName": str(path)}
        collision = self.call("createCollisionShape", **shape, flags=flags)
        visual = self.call("createVisualShape", **shape, rgbaColor=[*colour, 1.0])
        body = self._add_body(0.0, collision, visual, np.zeros(3), 0.0)
        self.concave += (body,)
        return body

    def _add_body(self, mass: float, collision: int, visual: int, position: FloatArray, yaw: float) -> int:
        if min(collision, visual) < 0:
            raise QSRError("the physics server refused a shape")
        turn = pybullet.getQuaternionFromEuler([0.0, 0.0, yaw])
        body = int(self.call("createMultiBody", mass, collision, visual, list(position), turn))
        self.call(
            "changeDynamics",
            body,
            -1,
            lateralFriction=FRICTION,
            rollingFriction=ROLLING_FRICTION,
            restitution=0.0,
        )
        return body

    def add_ghost(self, parts: Sequence[Part], mass: float, looks: Sequence[Part]) -> int:
        """Add a body that meets the world's bodies but lets rays pass: a robot's camera must see out."""
        body = self.add_parts(parts, np.zeros(3), 0.0, mass, looks)
        self.call("setCollisionFilterGroupMask", body, -1, ROBOT_GROUP, WORLD_GROUPS)
        return body

    def pose_of(self, body: int) -> tuple[FloatArray, FloatArray]:
        """Return the centre of mass (3,) and the rotation (3, 3) of a body, map frame."""
        position, quaternion = self.call("getBasePositionAndOrientation", body)
        return np.array(position), np.array(pybullet.getMatrixFromQuaternion(quaternion)).reshape(3, 3)

    def put(self, body: int, position: FloatArray, yaw: float) -> None:
        """Set a body down at a place (3,), with this heading; rays see it there at once."""
        turn = pybullet.getQuaternionFromEuler([0.0, 0.0, yaw])
        self.call("resetBasePositionAndOrientation", body, list(position), turn)

    def step(self, count: int, time_step: float) -> None:
        """Let the physics run for `count` steps of `time_step` [s]."""
        self.call("setTimeStep", time_step)
        for _ in range(count):
            self.call("stepSimulation")

    def is_slow(self, body: int, speed: float, turn_rate: float) -> bool:
        """Return whether a body moves and turns slower than these limits [m/s, rad/s]."""
        linear, angular = self.call("getBaseVelocity", body)
        return bool(np.linalg.norm(linear) < speed and np.linalg.norm(angular) < turn_rate)

    def touches(self, body: int) -> bool:
        """Return whether a body of non-zero mass meets anything where it stands."""
        self.call("performCollisionDetection")
        return any(distance[8] < 0.0 for distance in self.call("getContactPoints", body))

    def render(
        self,
        eye: FloatArray,
        target: FloatArray,
        up: FloatArray,
        lens: Lens,
        width: int,
        height: int,
        shadow: bool = False,
    ) -> Picture:
        """Draw what a camera at `eye` (3,) sees that looks at `target` (3,), `up` (3,) upwards."""
        view = pybullet.computeViewMatrix(eye.tolist(), target.tolist(), up.tolist())
        half_width, half_height = (
            lens.near * np.tan(0.5 * lens.horizontal_fov),
            lens.near * np.tan(0.5 * lens.vertical_fov),
        )
        sides = (-half_width, half_width, -half_height, half_height, lens.near, lens.far)
        projection = pybullet.computeProjectionMatrix(*(float(side) for side in sides))
        light = {"shadow": int(shadow), **LIGHT}
        _, _, colours, depth, bodies = self.call(
            "getCameraImage", width, height, view, projection, **light, renderer=pybullet.ER_TINY_RENDERER
        )
        return Picture(
            np.asarray(colours, dtype=np.uint8).reshape(height, width, 4)[..., :3],
            np.asarray(depth, dtype=np.float64).reshape(height, width),
            np.asarray(bodies, dtype=np.int64).reshape(height, width),
        )

    def rays(self, starts: FloatArray, ends: FloatArray) -> Hits:
        """Return what the rays from starts (N, 3) to ends (N, 3) meet first; they pass through a ghost."""
        starts, ends = np.asarray(starts, dtype=np.float64), np.asarray(ends, dtype=np.float64)
        bodies, fractions = np.full(len(starts), NOTHING, dtype=np.int64), np.ones(len(starts))
        normals = np.zeros((len(starts), 3))
        for first in range(0, len(starts), RAYS_PER_CALL):
            chunk = slice(first, first + RAYS_PER_CALL)
            found = self.call("rayTestBatch", starts[chunk], ends[chunk], collisionFilterMask=WORLD_GROUPS)
            bodies[chunk], _, fractions[chunk], _, slopes = zip(*found, strict=True)
            normals[chunk] = np.fromiter(chain.from_iterable(slopes), np.float64, 3 * len(found)).reshape(
                -1, 3
            )
        points = starts + fractions[:, None] * (ends - starts)
        return Hits(bodies, fractions, points, normals)


def _shapes(parts: Sequence[Part]) -> dict[str, list[Any]]:
    kinds = {Shape.BOX: pybullet.GEOM_BOX, Shape.CYLINDER: pybullet.GEOM_CYLINDER}
    return {
        "shapeTypes": [kinds[part.shape] for part in parts],
        "halfExtents": [[0.5 * side for side in part.size] for part in parts],
        "radii": [0.5 * part.size[0] for part in parts],
        "lengths": [part.size[2] for part in parts],
    }


def _places(parts: Sequence[Part], centroid: FloatArray) -> list[list[float]]:
    return [(part.centre - centroid).tolist() for part in parts]
