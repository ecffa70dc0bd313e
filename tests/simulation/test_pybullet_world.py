import subprocess
import sys
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulation_scenes import CAMERA, CUPS, ROBOT, table_room

from qsrlang.errors import BlockedPoseError, OutsideMapError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.planning.world import World
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.world import PybulletWorld


def test_it_is_a_world(table_world):
    world: World = table_world
    assert world.robot_pose == Pose2(0.5, 0.5, np.pi / 4)


def test_a_drive_costs_its_path_and_its_turns(table_world):
    drive = table_world.drive(np.array([[0.5, 0.5], [0.5, 1.5], [1.0, 1.5]]), np.pi)
    assert drive.reached == Pose2(1.0, 1.5, np.pi) == table_world.robot_pose
    assert drive.travel == pytest.approx(1.5)
    assert drive.turn == pytest.approx(np.pi / 4 + np.pi / 2 + np.pi)
    assert drive.seconds == pytest.approx(1.5 / 0.5 + drive.turn / 1.0)


def test_a_path_of_one_point_is_a_turn_on_the_spot(table_world):
    drive = table_world.drive(np.array([[0.5, 0.5]]), -np.pi / 4)
    assert (drive.travel, drive.turn) == (0.0, pytest.approx(np.pi / 2))


@cache
def free_world() -> PybulletWorld:
    return PybulletWorld.from_room(table_room(), [], ROBOT, CAMERA)


CORNER = st.tuples(st.floats(0.4, 1.2), st.floats(0.4, 3.6))


@given(st.lists(CORNER, min_size=1, max_size=5), st.floats(-3.0, 3.0))
def test_travel_is_the_length_of_a_free_path(corners, yaw):
    world = free_world()
    world.reset()
    path = np.array([[0.5, 0.5], *corners])
    drive = world.drive(path, yaw)
    assert drive.travel == pytest.approx(np.hypot(*np.diff(path, axis=0).T).sum())
    assert (drive.reached.x, drive.reached.y) == corners[-1] and drive.reached.yaw == pytest.approx(yaw)


def test_it_stops_short_of_the_table(table_world):
    drive = table_world.drive(np.array([[0.5, 0.5], [0.5, 2.0], [3.5, 2.0]]), 0.5)
    assert drive.reached.y == 2.0 and drive.reached.yaw == pytest.approx(0.5)
    assert 1.2 < drive.reached.x < 1.6
    assert drive.travel == pytest.approx(1.5 + drive.reached.x - 0.5)
    assert not table_world.is_free(Pose2(2.0, 2.0)) and table_world.is_free(drive.reached)
    assert table_world.robot_pose == drive.reached


def test_reset_puts_it_back_and_rays_see_the_new_place(table_world):
    before = table_world.look()
    table_world.drive(np.array([[0.5, 0.5], [0.5, 3.0]]), np.pi / 2)
    assert not table_world.look().detections
    table_world.reset()
    assert table_world.robot_pose == Pose2(0.5, 0.5, np.pi / 4) and table_world.look() == before
    table_world.reset(Pose2(3.4, 2.0, np.pi))
    assert table_world.look().detections


def test_starts_in_furniture_or_outside_are_errors(table_world):
    with pytest.raises(BlockedPoseError, match="the nearest free place is") as caught:
        table_world.reset(Pose2(2.0, 2.0))
    x, y = caught.value.nearest
    assert table_world.is_free(Pose2(x, y)) and table_world.robot_pose == Pose2(0.5, 0.5, np.pi / 4)
    with pytest.raises(OutsideMapError, match="the robot"):
        table_world.reset(Pose2(7.0, 2.0))
    with pytest.raises(BlockedPoseError):
        PybulletWorld.from_room(table_room(Pose2(2.0, 2.0)), [], ROBOT, CAMERA)


@pytest.mark.parametrize("path", [np.zeros((0, 2)), np.zeros((3, 3)), np.array([[np.nan, 0.0]]), np.zeros(2)])
def test_paths_that_are_none_are_an_error(table_world, path):
    with pytest.raises(ValueRangeError, match="a path"):
        table_world.drive(path, 0.0)


def trial(world, offset):
    """A short life of a robot: everything it reports."""
    world.reset()
    told = [world.look()]
    for n in range(6):
        here = world.robot_pose.position
        there = here + 0.3 * np.array([np.cos(n + offset), np.sin(n + offset)])
        told += [world.drive(np.array([here, there]), n + offset), world.look()]
    return told, world.objects


def test_worlds_side_by_side_do_not_disturb_each_other(kitchen):
    def build():
        return PybulletWorld.from_room(kitchen, CUPS, ROBOT, CAMERA)

    with build() as alone:
        first, second = trial(alone, 0.0), trial(alone, 1.0)
    with build() as left, PybulletWorld.from_room(table_room(), [], ROBOT, CAMERA) as other, build() as right:
        assert trial(left, 0.0) == first
        trial(other, 0.5)
        assert trial(right, 1.0) == second
        other.close()
        assert trial(left, 1.0) == second and trial(right, 0.0) == first


def test_a_closed_world_can_be_closed_again():
    world = PybulletWorld.from_room(table_room(), [], ROBOT, CAMERA)
    world.close()
    world.close()


def test_a_world_of_voxels():
    voxels = np.ones((40, 40, 30), dtype=np.uint8)
    voxels[:, :, 0] = 2
    voxels[18:30, 12:28, 15] = 2
    grid = VoxelGrid(voxels, 0.05, np.array([0.0, 0.0, -0.05]), "slab")
    cup = Placement("cup-1", "Cup", 1.2, 1.0)
    with PybulletWorld.from_voxels(grid, [cup], ROBOT, CAMERA, Pose2(0.35, 1.0), 0.0) as world:
        (found,) = world.look().detections
        assert found.position == pytest.approx((1.2, 1.0, 0.80), abs=3e-3)
        assert world.drive(np.array([[0.35, 1.0], [1.2, 1.0]]), 0.0).reached.x < 0.9


def test_importing_it_prints_nothing():
    code = "import qsrlang.simulation.world"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True
    )
    assert run.stdout == "" and run.stderr == ""
