from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from qsrlang.arrays import BoolArray, FloatArray, frozen_array
from qsrlang.errors import BlockedPoseError, OutsideMapError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.paths import DistanceField, path_length, shortest_path, turn_angles
from qsrlang.maps.sight import clear_line
from qsrlang.maps.spreading import open_moves, spread

masks = hnp.arrays(np.bool_, hnp.array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=12)).map(
    lambda mask: frozen_array("a mask", mask, (None, None), np.bool_)
)


def navigation_of(
    open_cells: BoolArray, resolution: float = 1.0, origin: Pose2 | None = None
) -> NavigationGrid:
    cells = np.where(open_cells, Cell.FREE, Cell.OCCUPIED).astype(np.uint8)
    return NavigationGrid.from_occupancy(
        OccupancyGrid(cells, resolution, origin or Pose2(0, 0), "a test"), 0.0
    )


def grid_lengths(open_cells: BoolArray, start: int) -> FloatArray:
    """Return 8-connected lengths without corner cutting, by scipy's Dijkstra on an explicit graph."""
    height, width = open_cells.shape
    edges = []
    for row, column in np.argwhere(open_cells):
        for dr, dc in itertools.product((-1, 0, 1), repeat=2):
            up, right = row + dr, column + dc
            inside = (dr or dc) and 0 <= up < height and 0 <= right < width
            if inside and open_cells[up, right] and open_cells[up, column] and open_cells[row, right]:
                edges.append((row * width + column, up * width + right, math.hypot(dr, dc)))
    tails, heads, lengths = zip(*edges, strict=True) if edges else ((), (), ())
    graph = coo_array((lengths, (tails, heads)), shape=(height * width,) * 2).tocsr()
    return np.asarray(dijkstra(graph, indices=start))


def clear_by_sampling(open_cells: BoolArray, path: FloatArray) -> bool:
    """Return whether closely spaced points of a path all lie on open cells (or on their very borders)."""
    for begin, end in itertools.pairwise(path):
        points = begin + (end - begin) * np.linspace(0.0, 1.0, 150)[:, None]
        for dx, dy in itertools.product((-1e-7, 1e-7), repeat=2):
            columns, rows = np.floor(points + np.array([dx, dy])).astype(int).T
            inside = open_cells[
                rows.clip(0, open_cells.shape[0] - 1), columns.clip(0, open_cells.shape[1] - 1)
            ]
            if not inside.all():
                return False
    return True


@settings(max_examples=60, deadline=None)
@given(open_cells=masks, data=st.data())
def test_paths_are_clear_and_never_longer_than_grid_paths(open_cells: BoolArray, data: st.DataObject) -> None:
    cells = np.argwhere(open_cells)
    if not len(cells):
        return
    start = data.draw(st.sampled_from(cells.tolist()))
    flat = start[0] * open_cells.shape[1] + start[1]
    expected = grid_lengths(open_cells, flat)
    lengths, _ = spread(open_cells, open_moves(open_cells), flat)
    assert (np.isfinite(lengths) == np.isfinite(expected)).all()
    reached = np.isfinite(expected)
    assert (lengths[reached] <= expected[reached] + 1e-9).all()
    straight = np.hypot(*(np.argwhere(np.ones_like(open_cells)) - start).T)
    assert (lengths[reached] >= straight[reached] - 1e-9).all()
    navigation = navigation_of(open_cells)
    field = DistanceField.from_start(navigation, (start[1] + 0.5, start[0] + 0.5))
    goals = np.argwhere(reached.reshape(open_cells.shape))
    lengths_to = field.lengths_to(goals[:, ::-1] + 0.5)
    for goal, length in list(zip(goals, lengths_to, strict=True))[:: max(1, len(goals) // 6)]:
        path = field.path_to(goal[::-1] + 0.5)
        cell = goal[0] * open_cells.shape[1] + goal[1]
        assert path_length(path) <= lengths[cell] + 1e-9
        assert math.isclose(path_length(path), length, abs_tol=1e-9)
        assert clear_by_sampling(open_cells, path)


@settings(max_examples=50, deadline=None)
@given(open_cells=masks, seed=st.integers(0, 10**6))
def test_one_search_agrees_with_the_whole_field(open_cells: BoolArray, seed: int) -> None:
    if not open_cells.any():
        return
    origin = Pose2(3.0, -2.0, 0.4)
    navigation = navigation_of(open_cells, 0.2, origin)
    start, end = navigation.sample_poses(2, np.random.default_rng(seed))[:, :2]
    field = DistanceField.from_start(navigation, start)
    length = field.lengths_to(end[None])[0]
    if not np.isfinite(length):
        with pytest.raises(ValueRangeError, match="reached"):
            shortest_path(navigation, start, end)
        return
    path = shortest_path(navigation, start, end)
    assert (path[0] == start).all()
    assert (path[-1] == end).all()
    assert clear_by_sampling(open_cells, origin.transform_inverse(path) / 0.2)
    cell = np.ravel_multi_index(navigation.cell_of(start), open_cells.shape)
    goal = np.ravel_multi_index(navigation.cell_of(end), open_cells.shape)
    ends = sum(np.hypot(*(navigation.grid.centres_of(navigation.cell_of(at)) - at)) for at in (start, end))
    bound = 0.2 * grid_lengths(open_cells, int(cell))[goal] + ends
    assert math.dist(start, end) - 1e-9 <= path_length(path) <= bound + 1e-9
    assert math.dist(start, end) - 1e-9 <= length <= bound + 1e-9


def true_length(open_cells: BoolArray, corners: FloatArray, start: FloatArray, end: FloatArray) -> float:
    """Return the shortest length of a point that may graze blocked cells, by a visibility graph of corners."""
    nodes = np.vstack([start, end, corners])
    first, second = np.triu_indices(len(nodes), 1)
    points = nodes[first, None] + (nodes[second] - nodes[first])[:, None] * np.linspace(0, 1, 250)[:, None]
    blocked = []
    for offset in ((-1e-6, -1e-6), (1e-6, 1e-6), (-1e-6, 1e-6), (1e-6, -1e-6)):
        columns, rows = np.moveaxis(np.floor(points + np.array(offset)).astype(int), -1, 0)
        blocked.append(~open_cells[rows.clip(0, 59), columns.clip(0, 79)])
    cut = ((blocked[0] & blocked[1]) | (blocked[2] & blocked[3])).any(axis=1)
    lengths = np.hypot(*(nodes[first] - nodes[second]).T)
    graph = coo_array((lengths[~cut], (first[~cut], second[~cut])), shape=(len(nodes),) * 2)
    return float(dijkstra(graph.tocsr(), directed=False, indices=0)[1])


@pytest.mark.parametrize("seed", range(6))
def test_paths_are_close_to_the_true_shortest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    open_cells = np.ones((60, 80), dtype=bool)
    corners = []
    for _ in range(6):
        x, y, w, h = rng.integers((8, 8, 4, 4), (56, 40, 22, 16))
        open_cells[y : y + h, x : x + w] = False
        corners += [(x, y), (x + w, y), (x, y + h), (x + w, y + h)]
    navigation = navigation_of(open_cells)
    start = np.array([3.3, 4.4])
    field = DistanceField.from_start(navigation, start)
    ends = navigation.sample_poses(10, rng)[:, :2]
    for end, length in zip(ends, field.lengths_to(ends), strict=True):
        truth = true_length(open_cells, np.array(corners, dtype=float), start, end)
        searched = path_length(shortest_path(navigation, start, end))
        for found in (length, searched):
            assert truth - 1e-6 <= found <= 1.01 * truth + 1.0


def test_an_empty_map_is_crossed_straight() -> None:
    navigation = navigation_of(np.ones((40, 60), dtype=bool), 0.1)
    path = shortest_path(navigation, (0.53, 0.61), (5.91, 3.07))
    assert path.tolist() == [[0.53, 0.61], [5.91, 3.07]]
    field = DistanceField.from_start(navigation, (0.53, 0.61))
    poses = navigation.sample_poses(200, np.random.default_rng(0))[:, :2]
    assert np.allclose(field.lengths_to(poses), np.hypot(*(poses - (0.53, 0.61)).T), atol=1e-12)


def test_a_wall_is_rounded_at_its_end() -> None:
    open_cells = np.ones((30, 30), dtype=bool)
    open_cells[:25, 15] = False
    path = shortest_path(navigation_of(open_cells), (5.5, 5.5), (25.5, 5.5))
    assert path.tolist() == [[5.5, 5.5], [14.5, 25.5], [16.5, 25.5], [25.5, 5.5]]


def test_the_start_itself_is_no_way_off() -> None:
    navigation = navigation_of(np.ones((3, 3), dtype=bool))
    assert path_length(shortest_path(navigation, (1.2, 1.2), (1.2, 1.2))) == 0.0
    assert DistanceField.from_start(navigation, (1.2, 1.2)).lengths_to([(1.2, 1.2)]).tolist() == [0.0]


def test_places_without_a_way() -> None:
    open_cells = np.ones((5, 9), dtype=bool)
    open_cells[:, 4] = False
    navigation = navigation_of(open_cells)
    field = DistanceField.from_start(navigation, (1.0, 1.0))
    goals = [(2.0, 1.0), (6.0, 1.0), (4.5, 1.0), (90.0, 1.0), (1e300, 0.0)]
    assert np.isfinite(field.lengths_to(goals)).tolist() == [True, False, False, False, False]
    assert field.lengths_to(np.empty((0, 2))).shape == (0,)
    with pytest.raises(ValueRangeError, match="can be reached"):
        field.path_to((6.0, 1.0))
    with pytest.raises(BlockedPoseError):
        field.path_to((4.5, 1.0))
    with pytest.raises(OutsideMapError):
        field.path_to((90.0, 1.0))
    with pytest.raises(BlockedPoseError, match="the start of a path"):
        DistanceField.from_start(navigation, (4.5, 1.0))
    with pytest.raises(ValueRangeError):
        field.lengths_to([(math.nan, 0.0)])


@settings(max_examples=150, deadline=None)
@given(open_cells=masks, data=st.data())
def test_lines_of_sight(open_cells: BoolArray, data: st.DataObject) -> None:
    height, width = open_cells.shape
    place = st.tuples(st.floats(0.01, width - 0.01), st.floats(0.01, height - 0.01))
    start, end = data.draw(place), data.draw(place)
    clear = clear_line(open_cells, *start, *end)
    points = np.array(start) + np.subtract(end, start) * np.linspace(0, 1, 300)[:, None]
    columns, rows = np.floor(points).astype(int).T
    if clear:
        assert clear_by_sampling(open_cells, np.array([start, end]))
    if not open_cells[rows, columns].all():
        assert not clear


def test_no_line_slips_between_two_corners() -> None:
    gap = frozen_array("a mask", [[True, False], [False, True]], (2, 2), np.bool_)
    assert not clear_line(gap, 0.5, 0.5, 1.5, 1.5)
    assert not clear_line(gap, 1.5, 1.5, 0.5, 0.5)
    corner = frozen_array("a mask", [[True, True], [False, True]], (2, 2), np.bool_)
    assert not clear_line(corner, 0.5, 0.5, 1.5, 1.5)
    assert clear_line(corner, 0.5, 0.5, 1.5, 0.5)


def test_lengths_and_turns_of_a_polyline() -> None:
    path = [(0.0, 0.0), (2.0, 0.0), (2.0, 0.0), (2.0, 1.0)]
    assert path_length(path) == 3.0
    assert np.allclose(turn_angles(path, -np.pi / 2, np.pi), [np.pi / 2, np.pi / 2, np.pi / 2])
    assert path_length([(1.0, 1.0)]) == 0.0
    assert np.allclose(turn_angles([(1.0, 1.0)], 3.0, -3.0), [2 * np.pi - 6.0])
    assert np.allclose(turn_angles([(0.0, 0.0), (-1.0, 0.0)], 0.0, 0.0), [np.pi, np.pi])
