import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulation_scenes import CAMERA, ROBOT, box, table_room

from qsrlang.geometry.pose import Pose2
from qsrlang.planning.frusta import axes_of, eyes_of
from qsrlang.planning.sensing import Camera
from qsrlang.simulation.camera import boxes_in_frustum
from qsrlang.simulation.depth import depth_image
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.rooms import Room, Thing
from qsrlang.simulation.world import PybulletWorld

NUMBERS = st.floats(-5.0, 5.0, allow_nan=False)


@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), st.floats(-3.1, 3.1), st.floats(-1.2, 1.2))
def test_a_point_is_in_the_frustum_as_a_pinhole_camera_has_it(point, yaw, tilt):
    """The oracle turns the point step by step, by yaw and then by tilt, and compares tangents."""
    camera = Camera(0.5, 4.0, 1.2, 0.8, 1.3, tilt)
    poses = np.array([[0.4, -0.2, yaw]])
    eye, axes = eyes_of(poses, camera, 0.1)[0], axes_of(poses, camera)[0]
    assert eye == pytest.approx([0.4, -0.2, 1.4])
    x, y, z = np.array(point) - eye
    ahead, left = x * np.cos(yaw) + y * np.sin(yaw), -x * np.sin(yaw) + y * np.cos(yaw)
    depth, up = ahead * np.cos(tilt) + z * np.sin(tilt), -ahead * np.sin(tilt) + z * np.cos(tilt)
    assert axes @ (np.array(point) - eye) == pytest.approx([depth, left, up], abs=1e-9)
    margins = [depth - 0.5, 4.0 - depth, np.tan(0.6) * depth - abs(left), np.tan(0.4) * depth - abs(up)]
    if min(abs(margin) for margin in margins) > 1e-9:
        corners = np.repeat((axes @ (np.array(point) - eye))[None], 8, axis=0)
        assert boxes_in_frustum(camera, corners) == (min(margins) > 0.0)


def cup_at(distance, **changes):
    values = {
        "near": 0.8,
        "far": 2.5,
        "horizontal_fov": 1.0,
        "vertical_fov": 0.8,
        "height": 1.0,
        "tilt": 0.0,
    } | changes
    room = table_room(Pose2(2.0 - distance, 2.0))
    return room, Camera(**values)


@pytest.mark.parametrize(
    ("distance", "changes", "seen"),
    [
        (1.5, {}, True),
        (0.75, {"near": 0.82}, False),
        (1.5, {"far": 1.3}, False),
        (1.5, {"tilt": 0.8}, False),
        (1.5, {"tilt": -0.3}, True),
        (1.5, {"height": 2.6}, False),
    ],
)
def test_near_far_tilt_and_height_decide(distance, changes, seen):
    room, camera = cup_at(distance, **changes)
    with PybulletWorld.from_room(room, [Placement("cup-1", "Cup", 2.0, 2.0)], ROBOT, camera) as world:
        look = world.look()
    assert bool(look.detections) is seen and look.seconds == ROBOT.dwell


def test_a_detection_tells_name_class_and_place(table_world):
    (found,) = table_world.look().detections
    assert (found.name, found.kind) == ("cup-1", "Cup")
    assert found.position == pytest.approx((2.0, 2.0, 0.80), abs=3e-3)
    assert table_world.objects == (found,)


def test_a_screen_before_the_cup_hides_it():
    room, camera = cup_at(1.5)
    screen = Thing("screen", "Screen", Pose2(1.3, 2.0), 0.0, (box((0.05, 0.6, 1.2), (0, 0, 0)),))
    room = Room(room.name, room.bounds, room.start, (*room.things, screen))
    cup = Placement("cup-1", "Cup", 2.0, 2.0)
    with PybulletWorld.from_room(room, [cup], ROBOT, camera) as world:
        assert not world.look().detections
        assert world.visible_fractions(np.array([[0.5, 2.0, 0.0]]))[0, 0] < 0.2
        beside = np.array([[0.5, 3.2, np.arctan2(-1.2, 1.5)]])
        assert world.visible(beside)[0, 0]
        assert world.visible_fractions(beside)[0, 0] == 1.0


def test_many_poses_at_once_are_the_looks_one_by_one(kitchen_world):
    rng = np.random.default_rng(5)
    poses = np.column_stack([rng.uniform(0.5, 7.5, 60), rng.uniform(0.5, 11.5, 60), rng.uniform(-3, 3, 60)])
    at_once = kitchen_world.visible(poses)
    assert at_once.any()
    one_by_one = np.concatenate([kitchen_world.visible(pose[None]) for pose in poses])
    assert (at_once == one_by_one).all()


def test_the_robot_does_not_stand_in_its_own_way(table_world):
    """Its mast reaches the camera: rays that start inside it must leave it."""
    assert table_world.look().detections
    table_world.drive(np.array([[0.5, 0.5], [1.0, 1.0]]), np.pi / 4)
    assert table_world.look().detections


def test_rule_and_picture_agree(kitchen_world):
    """The rule (box in the frustum, one free ray) against the pixels that a rendered picture gives each object."""
    rng = np.random.default_rng(11)
    engine, things = kitchen_world.scene.engine, [e for e in kitchen_world.scene.things if e[0].recognised]
    agreed, detections, poses = 0, 0, []
    while len(poses) < 25:
        x, y, yaw = rng.uniform([0.5, 0.5, -np.pi], [7.5, 11.5, np.pi])
        if kitchen_world.is_free(Pose2(x, y, yaw)):
            poses.append((x, y, yaw))
    seen = kitchen_world.visible(np.array(poses))
    with kitchen_world.robot_out_of(None):
        for pose, row in zip(poses, seen, strict=True):
            bodies = depth_image(engine, CAMERA, Pose2(*pose), 0.0, 160, 120).bodies
            shown = np.array([(bodies == body).sum() >= 4 for _, body in things])
            agreed += int((shown & row).sum())
            detections += int((shown | row).sum())
    assert detections >= 25
    assert agreed >= 0.75 * detections


def test_a_camera_can_be_tilted_for_one_look(table_world):
    level = table_world.look()
    assert table_world.look(CAMERA.tilt) == level
    assert not table_world.look(1.2).detections, "it looks at the ceiling"
    assert table_world.look() == level
