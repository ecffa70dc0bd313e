import numpy as np
import pytest
from simulation_scenes import box, table_room

from qsrlang.errors import OutsideMapError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.rooms import Room, Shape, Thing
from qsrlang.simulation.scene import scene_of_room, scene_of_voxels


def rest(room, *placements):
    """Where the placed objects come to rest: centres (K, 3) and rotations (K, 3, 3)."""
    scene = scene_of_room(room, placements)
    try:
        poses = [scene.engine.pose_of(body) for _, body in scene.things[len(room.things) :]]
    finally:
        scene.engine.close()
    return np.array([place for place, _ in poses]), np.array([turn for _, turn in poses])


def test_a_cup_stands_upright_on_the_table_and_on_the_floor():
    places, turns = rest(table_room(), Placement("a", "Cup", 2.2, 2.3), Placement("b", "Cup", 3.5, 3.5))
    assert places[:, 2] == pytest.approx([0.75 + 0.05, 0.05], abs=2e-3)
    assert turns[:, 2, 2] == pytest.approx(1.0, abs=1e-4)
    assert places[:, :2] == pytest.approx(np.array([[2.2, 2.3], [3.5, 3.5]]), abs=5e-3)


def test_the_same_scene_comes_to_rest_at_the_same_poses_to_the_bit(kitchen):
    cups = [Placement(f"cup-{n}", "Cup", 0.35, 1.0 + 0.25 * n) for n in range(5)]
    first, again = rest(kitchen, *cups), rest(kitchen, *cups)
    assert first[0].tobytes() == again[0].tobytes() and first[1].tobytes() == again[1].tobytes()


def test_a_box_keeps_its_yaw():
    _, turns = rest(
        table_room(), Placement("a", "Laptop", 2.0, 2.0, (0.24, 0.34, 0.02), None, 0.5, Shape.BOX)
    )
    assert np.arctan2(turns[0, 1, 0], turns[0, 0, 0]) == pytest.approx(0.5, abs=0.02)


def test_a_height_chooses_the_surface_below_it():
    places, _ = rest(table_room(), Placement("under", "Cup", 2.25, 2.3, z=0.5))
    assert places[0, 2] == pytest.approx(0.05, abs=2e-3)


def test_without_a_height_the_highest_surface_within_reach_is_taken():
    slab = Thing("lamp", "Lamp", Pose2(1, 1), 1.9, (box((0.5, 0.5, 0.1), (0, 0, 0)),))
    shelf = Thing("shelf", "Shelf", Pose2(1, 1), 1.4, (box((0.5, 0.5, 0.1), (0, 0, 0)),))
    room = table_room()
    room = Room(room.name, room.bounds, room.start, (*room.things, slab, shelf))
    places, _ = rest(room, Placement("a", "Cup", 1.0, 1.0))
    assert places[0, 2] == pytest.approx(1.5 + 0.05, abs=2e-3)


def test_a_surface_without_room_for_the_object_is_passed_over():
    lid = Thing("lid", "Lid", Pose2(2, 2), 0.80, (box((0.8, 1.5, 1.2), (0, 0, 0)),))
    room = table_room()
    room = Room(room.name, room.bounds, room.start, (*room.things, lid))
    places, _ = rest(room, Placement("a", "Cup", 2.25, 2.3))
    assert places[0, 2] == pytest.approx(0.05, abs=2e-3)


def test_an_object_on_the_edge_falls_and_that_is_an_error():
    with pytest.raises(
        ValueRangeError, match=r"where cup-1 came to rest .* put down at \(2\.00 m, 2\.78 m\)"
    ):
        rest(table_room(), Placement("cup-1", "Cup", 2.0, 2.78))


def test_nothing_below_is_an_error():
    room = table_room()
    hole = Room(room.name, room.bounds, room.start, (room.named("table-1"),))
    with pytest.raises(ValueRangeError, match=r"the place of cup-1 is \(3\.50 m, 3\.50 m\)"):
        rest(hole, Placement("cup-1", "Cup", 3.5, 3.5))


def test_places_outside_are_an_error():
    with pytest.raises(OutsideMapError, match="table-room: cup-1"):
        rest(table_room(), Placement("cup-1", "Cup", 9.0, 1.0))


@pytest.mark.parametrize(
    "wrong", [{"x": np.nan}, {"z": np.inf}, {"size": (0.0, 0.1, 0.1)}, {"size": (0.1, 0.2, 0.1)}]
)
def test_values_that_make_no_sense_are_an_error(wrong):
    values = {"name": "cup-1", "kind": "Cup", "x": 1.0, "y": 1.0} | wrong
    with pytest.raises(ValueRangeError):
        rest(table_room(), Placement(**values))


def heap(height_of_the_heap):
    """A voxel map of a plate 1 x 1 m, top at z = 0.5, with a heap of 0.2 x 0.2 m in its middle."""
    voxels = np.ones((20, 20, 30), dtype=np.uint8)
    voxels[:, :, 9] = 2
    voxels[8:12, 8:12, 10 : 10 + height_of_the_heap] = 2
    return VoxelGrid(voxels, 0.05, np.zeros(3), "heap")


@pytest.mark.parametrize(("z", "bottom"), [(None, 0.6), (0.5, 0.5)])
def test_a_height_cuts_away_what_the_map_remembers(z, bottom):
    scene = scene_of_voxels(heap(2), [Placement("cup-1", "Cup", 0.5, 0.5, z=z)], 0.0)
    try:
        place, turn = scene.engine.pose_of(scene.things[0][1])
    finally:
        scene.engine.close()
    assert place == pytest.approx([0.5, 0.5, bottom + 0.05], abs=3e-3)
    assert turn[2, 2] == pytest.approx(1.0, abs=1e-4)
