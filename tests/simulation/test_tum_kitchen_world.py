import numpy as np
import pytest

from qsrlang.geometry.pose import Pose2
from qsrlang.maps.octomap import read_octomap
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.resources import data_root
from qsrlang.simulation.mesh import clear_boxes, mesh_of
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.world import PybulletWorld

OCTOMAP = data_root() / "tum_kitchen" / "tum_kitchen_octomap.bt"
FLOOR = -0.37
CUPS = ((0.8, -2.4), (-0.5, 4.8), (2.5, 4.8))
pytestmark = pytest.mark.skipif(not OCTOMAP.is_file(), reason=f"no data at {OCTOMAP}")


@pytest.fixture(scope="module")
def voxels():
    return read_octomap(OCTOMAP).voxel_grid()


@pytest.fixture(scope="module")
def world(voxels):
    cups = [Placement(f"cup-{n}", "Cup", x, y) for n, (x, y) in enumerate(CUPS, 1)]
    robot = Robot(clearance=0.5, speed=0.5, turn_rate=1.0, dwell=3.0)
    camera = Camera(0.8, 2.5, np.radians(57.0), np.radians(44.3), 1.76, np.radians(-30.0))
    with PybulletWorld.from_voxels(voxels, cups, robot, camera, Pose2(0.0, 0.0), FLOOR) as world:
        yield world


def test_the_three_cups_stand_on_the_worktops(world):
    places = np.array([found.position for found in world.objects])
    assert places[:, :2] == pytest.approx(np.array(CUPS), abs=5e-3)
    heights = places[:, 2] - 0.05 - FLOOR
    assert sorted(heights) == pytest.approx([0.80, 0.80, 0.95], abs=0.03)


def test_each_cup_is_seen_by_a_robot_that_stands_before_its_worktop(world):
    angles = np.linspace(-np.pi, np.pi, 36, endpoint=False)
    for number, cup in enumerate(CUPS):
        places = cup + 1.8 * np.column_stack([np.cos(angles), np.sin(angles)])
        poses = np.column_stack([places, angles + np.pi])
        seen = world.visible(poses)[:, number]
        standing = np.array([world.is_free(Pose2(*pose)) for pose in poses])
        assert 2 <= (seen & standing).sum() < 36
    assert not world.look().detections


def test_merged_faces_keep_the_area_of_all_exposed_faces(voxels):
    occupied = clear_boxes(voxels, [])
    mesh = mesh_of(occupied, voxels.resolution, voxels.origin)
    padded = np.pad(occupied, 1)
    faces = sum(int((np.diff(padded.astype(np.int8), axis=axis) != 0).sum()) for axis in range(3))
    corner = mesh.vertices[mesh.quads]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 3] - corner[:, 0]), axis=1).sum()
    assert faces == 145_440
    assert area == pytest.approx(faces * voxels.resolution**2)
    assert len(mesh.quads) < faces / 5
