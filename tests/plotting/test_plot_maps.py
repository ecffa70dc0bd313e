import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_rgb

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.supports import Supports
from qsrlang.plotting import style
from qsrlang.plotting.maps import draw_map, known_ground

SIZE = 0.25
ORIGIN = Pose2(-1.0, 2.0, 0.0)


def _grid(origin=ORIGIN, shape=(14, 9), seed=0):
    cells = np.random.default_rng(seed).integers(0, 3, size=shape).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = cells[0, -1] = cells[-1, 0] = Cell.FREE
    return OccupancyGrid(cells, SIZE, origin, "a test")


def _supports(names=("support-1", "support-2")):
    x, y = np.meshgrid(-0.875 + 0.25 * np.arange(4), 2.125 + 0.25 * np.arange(3))
    low = np.stack([x.ravel(), y.ravel(), np.full(12, 0.8)], axis=1)
    high = np.array([[-0.875, 2.125, 1.2], [0.375, 4.125, 1.2]])
    return Supports(np.concatenate([low, high]), np.repeat([0, 1], [12, 2]), names)


def _pixels(figure, places):
    figure.canvas.draw()
    picture = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3] / 255.0
    x, y = np.floor(figure.axes[0].transData.transform(places)).astype(int).T
    return picture[y, x]


@pytest.mark.parametrize("yaw", [0.0, 0.4, -2.0, np.pi / 2.0, np.pi])
def test_every_cell_is_painted_where_it_is(yaw):
    grid = _grid(Pose2(3.0, -7.0, yaw))
    figure = draw_map(grid)
    cells = np.argwhere(np.ones(grid.cells.shape))
    found = _pixels(figure, grid.centres_of(cells))
    greys = np.array(
        [to_rgb(style.CELL_GREYS[Cell(value)]) for value in grid.cells[cells[:, 0], cells[:, 1]]]
    )
    assert np.abs(found - greys).max() < 1.0 / 255.0


@settings(max_examples=6, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-20.0, 20.0), st.floats(-20.0, 20.0), st.integers(0, 2**31))
def test_cells_keep_their_place_under_any_origin(yaw, x, y, seed):
    grid = _grid(Pose2(x, y, yaw), seed=seed)
    cells = np.argwhere(grid.cells == Cell.OCCUPIED)
    found = _pixels(draw_map(grid), grid.centres_of(cells))
    assert np.abs(found - to_rgb(style.CELL_GREYS[Cell.OCCUPIED])).max() < 1.0 / 255.0


def test_the_ground_leaves_unknown_margins_out():
    cells = np.zeros((100, 80), dtype=np.uint8)
    cells[40:60, 10:30] = Cell.FREE
    ground = known_ground(OccupancyGrid(cells, 0.1, Pose2(0.0, 0.0), "a test"))
    assert (ground.x_min, ground.x_max) == pytest.approx((0.75, 3.25))
    assert (ground.y_min, ground.y_max) == pytest.approx((3.75, 6.25))


def test_an_unknown_map_is_shown_whole():
    ground = known_ground(OccupancyGrid(np.zeros((30, 20), dtype=np.uint8), 0.1, Pose2(0.0, 0.0), "a test"))
    assert (ground.x_min, ground.x_max) == pytest.approx((-0.25, 2.25))
    assert (ground.y_min, ground.y_max) == pytest.approx((-0.25, 3.25))


def test_support_voxels_bear_the_colour_of_the_highest_part():
    supports = _supports()
    figure = draw_map(_grid(), supports)
    found = _pixels(figure, supports.centres[:, :2] + 0.1)
    expected = np.array([to_rgb(style.PARTS[part]) for part in supports.part])
    expected[0] = to_rgb(style.PARTS[1])
    assert np.abs(found - expected).max() < 0.02
    assert [
        text.get_text() for text in figure.axes[0].texts if text.get_text().startswith("support")
    ] == list(supports.names)
    assert len(figure.axes) == 1


def test_parts_beyond_the_palette_share_a_colour_and_bear_no_name():
    count = len(style.PARTS) + 3
    centres = np.stack([0.25 * np.arange(count), np.full(count, 3.0), np.ones(count)], axis=1)
    supports = Supports(centres, np.arange(count), tuple(f"support-{i + 1}" for i in range(count)))
    figure = draw_map(_grid(), supports)
    assert np.abs(_pixels(figure, centres[-3:, :2]) - to_rgb(style.OTHER_PART)).max() < 0.02
    names = [text.get_text() for text in figure.axes[0].texts if text.get_text().startswith("support")]
    assert names == list(supports.names[: len(style.PARTS)])


def test_weights_colour_the_voxels_the_heaviest_on_top():
    supports = _supports()
    weights = np.linspace(1.0, 5.0, len(supports.centres))
    figure = draw_map(_grid(), supports, weights)
    found = _pixels(figure, supports.centres[1:, :2])
    shades = (weights[1:] - 1.0) / 4.0
    shades[-2] = (weights[-2] - 1.0) / 4.0
    assert np.abs(found - np.asarray(style.WEIGHT_COLOURS(shades))[:, :3]).max() < 0.02
    assert figure.axes[1].get_ylim() == pytest.approx((1.0, 5.0))
    assert "weight" in figure.axes[1].get_title(loc="left")


def test_equal_weights_need_no_colour_bar():
    assert len(draw_map(_grid(), _supports(), np.ones(14)).axes) == 1


def test_no_supports_is_a_map_alone():
    empty = Supports(np.zeros((0, 3)), np.zeros(0, dtype=int), ())
    for supports, weights in ((None, None), (empty, None), (empty, np.zeros(0))):
        assert len(draw_map(_grid(), supports, weights).axes[0].images) == 1


@pytest.mark.parametrize(
    ("supports", "weights"),
    [(_supports(), np.ones(3)), (None, np.ones(3)), (_supports(), np.full(14, np.nan))],
)
def test_weights_that_do_not_fit_are_refused(supports, weights):
    with pytest.raises(ValueRangeError, match="the weights of the support voxels"):
        draw_map(_grid(), supports, weights)


def test_a_lattice_beyond_the_limit_is_refused():
    centres = np.array([[0.0, 0.0, 1.0], [0.001, 0.0, 1.0], [20.0, 0.0, 1.0]])
    with pytest.raises(ValueRangeError, match="the side of a picture in voxels"):
        draw_map(_grid(), Supports(centres, np.zeros(3, dtype=int), ("support-1",)))


def test_one_voxel_is_as_large_as_a_cell():
    lone = Supports(np.array([[0.0, 3.0, 1.0]]), np.zeros(1, dtype=int), ("support-1",))
    image = draw_map(_grid(), lone).axes[0].images[1]
    assert image.get_extent() == pytest.approx((-0.125, 0.125, 2.875, 3.125))
