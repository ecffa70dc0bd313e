import math

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

from qsrlang.errors import ValueRangeError
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.plotting.voxels import draw_voxels


def _grid(occupied, shape=(6, 6, 6)):
    voxels = np.full(shape, Cell.FREE, dtype=np.uint8)
    voxels[tuple(np.array(occupied).T)] = Cell.OCCUPIED
    return VoxelGrid(voxels, 0.1, np.array([1.0, -2.0, 0.3]), "a test")


def _faces(figure):
    (faces,) = (child for child in figure.axes[0].collections if isinstance(child, PolyCollection))
    return np.array([path.vertices[:4] for path in faces.get_paths()])


def _area(quads):
    x, y = quads[..., 0], quads[..., 1]
    return 0.5 * np.abs((x * np.roll(y, -1, axis=-1) - np.roll(x, -1, axis=-1) * y).sum(axis=-1))


@pytest.mark.parametrize("azimuth", [0.3, 2.0, -2.2, -1.0])
def test_one_voxel_shows_three_faces_of_the_projected_area(azimuth):
    elevation = 0.7
    areas = sorted(_area(_faces(draw_voxels(_grid([[2, 3, 4]]), azimuth=azimuth, elevation=elevation))))
    towards = [
        abs(math.cos(azimuth)) * math.cos(elevation),
        abs(math.sin(azimuth)) * math.cos(elevation),
        math.sin(elevation),
    ]
    assert np.allclose(areas, sorted(0.01 * np.array(towards)))


def test_faces_between_voxels_are_left_out():
    assert len(_faces(draw_voxels(_grid([[2, 2, 2], [2, 2, 3]])))) == 5
    assert len(_faces(draw_voxels(_grid(np.argwhere(np.ones((6, 6, 6))))))) == 3 * 36


def test_nearer_faces_are_painted_later():
    figure = draw_voxels(_grid([[0, 0, 0], [5, 0, 0]]), azimuth=0.0, elevation=0.2)
    vertical = _faces(figure)[:, :, 1].mean(axis=1)
    assert np.argmin(vertical) >= 3


def test_heights_can_be_cut_and_set_the_scale():
    figure = draw_voxels(_grid([[0, 0, 0], [0, 0, 2], [0, 0, 5]]), z_max=0.6)
    assert len(_faces(figure)) == 6
    assert figure.axes[1].get_ylim() == pytest.approx((0.35, 0.55))
    assert "[m]" in figure.axes[1].get_title(loc="left")


def test_nothing_to_show_and_odd_viewers_are_refused():
    with pytest.raises(ValueRangeError, match="the number of occupied voxels"):
        draw_voxels(_grid([[0, 0, 0]]), z_min=1.0)
    for elevation in (0.0, math.pi / 2.0, -1.0, math.nan):
        with pytest.raises(ValueRangeError, match="the elevation of a viewer"):
            draw_voxels(_grid([[0, 0, 0]]), elevation=elevation)


def test_one_layer_still_has_a_scale():
    assert np.ptp(draw_voxels(_grid([[1, 1, 1]])).axes[1].get_ylim()) > 0.0
