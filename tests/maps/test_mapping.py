from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.maps.mapping import VoxelMapper
from qsrlang.maps.occupancy import Cell

SHAPE = (7, 6, 5)


def crossed(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return which voxels of SHAPE a segment surely crosses, and which it may cross, by slabs."""
    cells = np.stack(np.meshgrid(*map(np.arange, SHAPE), indexing="ij"), axis=-1).astype(float)
    step = np.where(np.abs(end - start) < 1e-12, 1e-12, end - start)
    near, far = (cells - start) / step, (cells + 1 - start) / step
    enter = np.minimum(near, far).max(axis=-1).clip(0.0, None)
    leave = np.maximum(near, far).min(axis=-1).clip(None, 1.0)
    return leave - enter > 1e-6, leave - enter > -1e-6


coordinate = st.floats(-3.0, 9.0, allow_nan=False).map(lambda value: round(value, 3) + 0.00037)
points = st.tuples(coordinate, coordinate, coordinate)


@settings(max_examples=80, deadline=None)
@given(sensor=points, ends=st.lists(points, min_size=1, max_size=4), reach=st.sampled_from([math.inf, 2.5]))
def test_rays_free_what_they_cross(
    sensor: tuple[float, float, float], ends: list[tuple[float, float, float]], reach: float
) -> None:
    mapper = VoxelMapper((0.0, 0.0, 0.0), SHAPE, 1.0)
    mapper.insert(sensor, ends, max_range=reach)
    voxels = mapper.grid("a test").voxels
    start = np.array(sensor)
    surely, perhaps, hits = np.zeros(SHAPE, bool), np.zeros(SHAPE, bool), np.zeros(SHAPE, bool)
    for end in map(np.array, ends):
        length = float(np.linalg.norm(end - start))
        cell = tuple(np.floor(end).astype(int))
        inside = all(0 <= cell[axis] < SHAPE[axis] for axis in range(3))
        if length <= reach and inside and hits[cell]:
            continue
        if length <= reach and inside:
            hits[cell] = True
        sure, maybe = crossed(start, start + (end - start) * min(1.0, reach / max(length, 1e-9)))
        surely, perhaps = surely | sure, perhaps | maybe
    assert ((voxels == Cell.OCCUPIED) == hits).all()
    assert (voxels[surely & ~hits] == Cell.FREE).all()
    assert (voxels[~perhaps & ~hits] == Cell.UNKNOWN).all()


def test_log_odds_add_up_and_stay_between_their_bounds() -> None:
    mapper = VoxelMapper((0.0, 0.0, 0.0), (4, 1, 1), 1.0)
    sensor, hit, beyond = (0.5, 0.5, 0.5), [(2.5, 0.5, 0.5)], [(3.5, 0.5, 0.5)]

    def state() -> int:
        return int(mapper.grid("a test").voxels[2, 0, 0])

    mapper.insert(sensor, hit)
    assert state() == Cell.OCCUPIED
    for misses in (True, True, False):
        mapper.insert(sensor, beyond)
        assert (state() == Cell.OCCUPIED) is misses
    for _ in range(20):
        mapper.insert(sensor, hit)
    for _ in range(8):
        mapper.insert(sensor, beyond)
    assert state() == Cell.OCCUPIED
    mapper.insert(sensor, beyond)
    assert state() == Cell.FREE
    for _ in range(20):
        mapper.insert(sensor, beyond)
    mapper.insert(sensor, hit)
    mapper.insert(sensor, hit)
    assert state() == Cell.FREE
    mapper.insert(sensor, hit)
    assert state() == Cell.OCCUPIED


def test_a_voxel_is_updated_once_a_cloud_and_a_hit_wins() -> None:
    many, one = (VoxelMapper((0.0, 0.0, 0.0), (5, 1, 1), 1.0) for _ in range(2))
    sensor, hit, beyond = (0.5, 0.5, 0.5), (2.5, 0.5, 0.5), (4.5, 0.5, 0.5)
    many.insert(sensor, [beyond] * 30 + [hit] * 30 + [beyond] * 30)
    one.insert(sensor, [hit, beyond])
    for _ in range(3):
        assert (many.grid("m").voxels == one.grid("o").voxels).all()
        many.insert(sensor, [beyond])
        one.insert(sensor, [beyond])
    assert many.grid("m").voxels.ravel().tolist() == [1, 1, 1, 1, 2]


def test_what_hit_nothing_is_free_up_to_the_range() -> None:
    mapper = VoxelMapper((0.0, 0.0, 0.0), (6, 1, 1), 1.0)
    mapper.insert((0.5, 0.5, 0.5), [(1e30, 0.5, 0.5)], max_range=3.0)
    assert mapper.grid("a test").voxels.ravel().tolist() == [1, 1, 1, 1, 0, 0]


def test_a_sensor_outside_maps_what_lies_inside() -> None:
    mapper = VoxelMapper((10.0, 0.0, 0.0), (3, 1, 1), 0.5)
    mapper.insert((0.0, 0.25, 0.25), [(11.2, 0.25, 0.25), (0.0, 7.0, 0.25)])
    assert mapper.grid("a test").voxels.ravel().tolist() == [1, 1, 2]


def test_an_empty_cloud_changes_nothing() -> None:
    mapper = VoxelMapper((0.0, 0.0, 0.0), SHAPE, 1.0)
    mapper.insert((0.0, 0.0, 0.0), np.empty((0, 3)))
    assert (mapper.grid("a test").voxels == Cell.UNKNOWN).all()


def test_the_grid_keeps_its_frame_and_source() -> None:
    grid = VoxelMapper((1.0, 2.0, 3.0), SHAPE, 0.05).grid("survey of a room")
    assert grid.origin.tolist() == [1.0, 2.0, 3.0]
    assert (grid.resolution, grid.source, grid.voxels.shape) == (0.05, "survey of a room", SHAPE)


@pytest.mark.parametrize(
    ("origin", "shape", "resolution"),
    [
        ((0, 0, 0), SHAPE, 0.0),
        ((0, 0, 0), SHAPE, math.nan),
        ((0, 0), SHAPE, 0.1),
        ((0, 0, math.inf), SHAPE, 0.1),
        ((0, 0, 0), (0, 1, 1), 0.1),
        ((0, 0, 0), (10_000, 10_000, 10_000), 0.1),
    ],
)
def test_senseless_maps_are_refused(origin: object, shape: tuple[int, int, int], resolution: float) -> None:
    with pytest.raises(ValueRangeError):
        VoxelMapper(origin, shape, resolution)  # type: ignore[arg-type]


def test_senseless_clouds_are_refused() -> None:
    mapper = VoxelMapper((0.0, 0.0, 0.0), SHAPE, 1.0)
    for sensor, cloud, reach in (
        ((0, 0, 0), [(math.nan, 0, 0)], 1.0),
        ((0, 0, 0), [(0, 0)], 1.0),
        ((0, math.inf, 0), [(0, 0, 0)], 1.0),
        ((0, 0, 0), [(0, 0, 0)], 0.0),
        ((0, 0, 0), [(0, 0, 0)], math.nan),
    ):
        with pytest.raises(ValueRangeError):
            mapper.insert(sensor, cloud, reach)
