import numpy as np
import pytest
from scipy import ndimage
from simulation_scenes import ROBOT, table_room

from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.supports import find_supports
from qsrlang.simulation.scene import scene_of_room
from qsrlang.simulation.surfaces import supporting_voxels
from qsrlang.simulation.survey import SURVEY_CAMERA, SURVEY_ROBOT, survey_room, tour

ONE_VOXEL = np.ones((3, 3, 3), dtype=bool)


@pytest.fixture(scope="module")
def surveyed(kitchen):
    return survey_room(kitchen)


@pytest.fixture(scope="module")
def truth(kitchen, surveyed):
    scene = scene_of_room(kitchen.static_part)
    try:
        return supporting_voxels(scene.engine, surveyed[1], 0.0)
    finally:
        scene.engine.close()


def test_the_maps_are_those_of_the_room(kitchen, surveyed):
    occupancy, voxels = surveyed
    assert voxels.resolution == occupancy.resolution == 0.05
    assert occupancy.source == voxels.source == "kitchen"
    x0, y0, x1, y1 = occupancy.bounds
    assert x0 < 0.0 and y0 < 0.0 and x1 > 8.0 and y1 > 12.0


def test_the_plane_map_shows_floor_and_furniture(kitchen, surveyed):
    occupancy, _ = surveyed

    def cell(x, y):
        return occupancy.cells[tuple(occupancy.cells_of([x, y]))]

    for x, y in ((4.0, 6.3), (4.0, 5.0), (2.0, 2.5), (7.0, 4.3), (3.0, 10.3), (6.0, 7.5)):
        assert cell(x, y) == Cell.FREE, (x, y)
    for name in ("dining-table-1", "desk-1", "desk-2", "desk-3", "sofa-1", "sideboard-1", "coffee-table-1"):
        place = kitchen.named(name).pose
        assert cell(place.x, place.y) == Cell.OCCUPIED, name


def test_no_place_is_unknown_where_a_robot_goes(kitchen, surveyed):
    occupancy, _ = surveyed
    x, y = np.meshgrid(np.arange(0.1, 7.95, 0.05), np.arange(0.1, 11.95, 0.05))
    cells = occupancy.cells[tuple(occupancy.cells_of(np.stack([x, y], axis=-1)).transpose(2, 0, 1))]
    assert (cells == Cell.UNKNOWN).mean() < 0.01
    navigation = NavigationGrid.from_occupancy(occupancy, 0.5).reachable_from(kitchen.start)
    assert navigation.navigable.sum() * 0.05**2 > 35.0
    assert navigation.is_navigable(np.array([[2.5, 2.5], [7.0, 4.3], [3.0, 10.0], [6.0, 10.0]])).all()


def test_what_moves_is_not_mapped(kitchen, surveyed):
    _, voxels = surveyed
    x, y, z = voxels.indices_of(kitchen.named("bottle-1").position + np.array([0.0, 0.0, 0.15]))
    assert voxels.voxels[x, y, z] == Cell.FREE


def test_rays_tell_which_voxels_are_supports(kitchen, surveyed, truth):
    _, voxels = surveyed

    def held(x, y, z):
        return truth[tuple(voxels.indices_of([x, y, z]))]

    assert held(5.6, 2.55, 0.749) and held(0.45, 3.0, 0.899) and held(1.0, 11.4, 0.749)
    assert not held(5.6, 2.55, 0.60) and not held(4.0, 6.3, 0.01) and not held(4.0, 6.3, 0.749)
    assert not truth[..., voxels.indices_of([0, 0, 1.55])[2] :].any()


@pytest.mark.parametrize(
    ("method", "precision", "recall"), [("pca", 0.85, 0.80), ("mean-normal", 0.95, 0.60)]
)
def test_supports_found_in_the_survey_are_true(surveyed, truth, method, precision, recall):
    _, voxels = surveyed
    supports = find_supports(voxels, method, min_height=0.3, max_height=1.5, min_part=40)
    found = np.zeros_like(truth)
    found[tuple(voxels.indices_of(supports.centres).T)] = True
    assert (found & ndimage.binary_dilation(truth, ONE_VOXEL)).sum() >= precision * found.sum()
    assert (truth & ndimage.binary_dilation(found, ONE_VOXEL)).sum() >= recall * truth.sum()


def test_a_survey_is_the_same_each_time():
    room = table_room()
    first, again = survey_room(room), survey_room(room)
    assert (first[1].voxels == again[1].voxels).all() and (first[0].cells == again[0].cells).all()


def test_the_tour_stays_where_the_robot_can_drive(kitchen):
    scene = scene_of_room(kitchen.static_part)
    try:
        places = tour(scene, SURVEY_ROBOT, SURVEY_CAMERA, kitchen.start)
    finally:
        scene.engine.close()
    assert places[0] == pytest.approx([4.0, 6.3])
    assert (places[:, 1] < 4.5).any() and (places[:, 1] > 10.0).any()
    gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + 10.0 * np.eye(len(places))
    assert gaps.min() >= 1.5
    table = kitchen.named("dining-table-1").pose
    assert np.hypot(*(places - [table.x, table.y]).T).min() > 0.5 + ROBOT.clearance / 2


def test_a_start_in_furniture_maps_nothing_beyond_it():
    room = table_room(Pose2(2.0, 2.0))
    scene = scene_of_room(room)
    try:
        assert len(tour(scene, SURVEY_ROBOT, SURVEY_CAMERA, room.start)) == 1
    finally:
        scene.engine.close()
