import numpy as np
import pytest
from simulation_scenes import table_room

from qsrlang.errors import ValueRangeError
from qsrlang.simulation.picture import BACKGROUND, scene_picture


def test_a_picture_of_a_room_shows_its_floor_and_its_table():
    picture = scene_picture(table_room(), (2.0, -2.0, 4.0), (2.0, 2.0, 0.0), (80, 60))
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    assert (picture[0, 0] == BACKGROUND).all()
    assert abs(picture[35, 40].astype(int) - BACKGROUND).max() > 20


def test_a_robot_is_in_the_picture_but_not_before_its_own_eye(table_world):
    with_robot = scene_picture(table_world, (2.0, -3.0, 3.0), (1.0, 1.0, 0.5), (80, 60))
    with table_world.robot_out_of(None):
        without = scene_picture(table_world.scene, (2.0, -3.0, 3.0), (1.0, 1.0, 0.5), (80, 60))
    assert (with_robot != without).any()
    own = scene_picture(table_world, (0.5, 0.5, 1.4), (2.0, 2.0, 0.8), (80, 60))
    with table_world.robot_out_of(None):
        empty = scene_picture(table_world.scene, (0.5, 0.5, 1.4), (2.0, 2.0, 0.8), (80, 60))
    assert (own == empty).all()


def test_straight_down_works_too():
    assert scene_picture(table_room(), (2.0, 2.0, 6.0), (2.0, 2.0, 0.0), (40, 40)).std() > 0.0


@pytest.mark.parametrize("size", [(0, 10), (10, 100_000)])
def test_sizes_out_of_range_are_an_error(size):
    with pytest.raises(ValueRangeError, match="the size of a picture"):
        scene_picture(table_room(), (2, 2, 6), (2, 2, 0), size)


def test_eye_and_target_in_one_point_are_an_error():
    with pytest.raises(ValueRangeError, match="another point than the eye"):
        scene_picture(table_room(), (2, 2, 6), (2, 2, 6), (10, 10))
