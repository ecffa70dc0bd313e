"""What a camera would show of the supports: frustum, height and occlusion, by the robot's own map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.detecting import Detector
from qsrlang.planning.frusta import POINT, Extent, eyes_of, planes_of
from qsrlang.planning.seeing import mark_between, mark_clear, mark_in_view
from qsrlang.planning.sensing import Camera
from qsrlang.planning.views import IndexArray, Views

PAIRS_AT_ONCE = 8_000_000
"""How many pairs of a view and a place are held in memory at once, one byte each."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """A camera in a mapped place; `floor` is the height of the floor in the map frame [m].

    `extent` is how far the things sought reach from their centres: they are in view unless wholly outside the
    frustum, and a free ray must reach the centre.
    """

    camera: Camera
    floor: float
    voxels: VoxelGrid
    extent: Extent = POINT

    def visible(
        self, poses_map: npt.ArrayLike, points_map: npt.ArrayLike, tilts: npt.ArrayLike | None = None
    ) -> BoolArray:
        """Return which points (K, 3) [m] are in the frustum and hidden by nothing from poses (N, 3): (N, K)."""
        poses, points = _checked(poses_map, points_map)
        seen = np.empty((len(poses), len(points)), dtype=np.bool_)
        planes = planes_of(poses, self.camera, self.floor, self.extent, tilts)
        eyes = eyes_of(poses, self.camera, self.floor)
        mark_in_view(planes, eyes, self.reach, points, self.voxels, seen)
        return seen

    def views(
        self,
        poses_map: npt.ArrayLike,
        points_map: npt.ArrayLike,
        detector: Detector,
        tilts: npt.ArrayLike | None = None,
    ) -> Views:
        """Return what looks from poses (N, 3) would show of points (K, 3), in blocks of bounded memory."""
        poses, points = _checked(poses_map, points_map)
        gazes = (
            np.full(len(poses), self.camera.tilt) if tilts is None else np.asarray(tilts, dtype=np.float64)
        )
        blocks = [self.visible(poses[part], points, gazes[part]) for part in _blocks(len(poses), len(points))]
        return self.gathered(poses, gazes, points, blocks, detector)

    def all_round(self, places: FloatArray, points: FloatArray) -> BoolArray:
        """Return which points (K, 3) a camera at places (P, 2) could show if it turned to them: (P, K)."""
        eyes = eyes_of(np.column_stack([places, np.zeros(len(places))]), self.camera, self.floor)
        clear = np.empty((len(places), len(points)), dtype=np.bool_)
        mark_clear(eyes, points, self.voxels, self.reach, clear)
        return clear

    def turned(
        self, poses: FloatArray, tilts: FloatArray, place_of: IntArray, clear: BoolArray, points: FloatArray
    ) -> Iterator[BoolArray]:
        """Yield, block by block, which points are in view of poses (N, 3), by what is `clear` (P, K) of places."""
        for part in _blocks(len(poses), len(points)):
            planes = planes_of(poses[part], self.camera, self.floor, self.extent, tilts[part])
            seen = np.empty((len(planes), len(points)), dtype=np.bool_)
            mark_between(planes, points, place_of[part], clear, seen)
            yield seen

    @property
    def reach(self) -> float:
        """How far from the camera the corner of its frustum is, a thing's own reach included [m]."""
        wide, high = np.tan(0.5 * self.camera.horizontal_fov), np.tan(0.5 * self.camera.vertical_fov)
        far = self.camera.far + self.extent.size
        return float(far * np.sqrt(1.0 + wide * wide + high * high) + self.extent.size)

    def gathered(
        self,
        poses: FloatArray,
        tilts: FloatArray,
        points: FloatArray,
        blocks: Iterator[BoolArray] | list[BoolArray],
        detector: Detector,
    ) -> Views:
        """Return views from what is seen, block by block of poses (N, 3)."""
        counts: list[IntArray] = [np.zeros(0, dtype=np.int64)]
        shown: list[IndexArray] = [np.zeros(0, dtype=np.int32)]
        for seen in blocks:
            counts.append(np.count_nonzero(seen, axis=1))
            shown.append((np.flatnonzero(seen) % max(len(points), 1)).astype(np.int32))
        starts = np.concatenate([[0], np.cumsum(np.concatenate(counts))])
        entries = np.concatenate(shown)
        rates = detector.rates(self._ranges(poses, points, starts, entries, detector), self.extent.size)
        return Views(poses, tilts, starts, entries, rates.astype(np.float32), len(points))

    def _ranges(
        self, poses: FloatArray, points: FloatArray, starts: IntArray, entries: IndexArray, detector: Detector
    ) -> FloatArray:
        if detector.is_flat:
            return np.zeros(len(entries))
        offsets = points[entries] - np.repeat(
            eyes_of(poses, self.camera, self.floor), np.diff(starts), axis=0
        )
        return np.asarray(np.sqrt(np.einsum("ed,ed->e", offsets, offsets)))


def _checked(poses_map: npt.ArrayLike, points_map: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    poses = frozen_array("the poses of a camera", poses_map, (None, 3))
    points = frozen_array("the points before a camera", points_map, (None, 3))
    if len(points) > PAIRS_AT_ONCE:
        raise ValueRangeError("the number of points before a camera", len(points), f"at most {PAIRS_AT_ONCE}")
    return poses, points


def _blocks(poses: int, points: int) -> Iterator[slice]:
    rows = max(1, PAIRS_AT_ONCE // max(points, 1))
    return (slice(first, min(first + rows, poses)) for first in range(0, poses, rows))
