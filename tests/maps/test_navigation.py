from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from qsrlang.errors import BlockedPoseError, NoNavigablePoseError, OutsideMapError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid, occupancy_from_voxels
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.octomap import read_octomap
from qsrlang.maps.rosmap import read_ros_map
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.resources import data_root

states = hnp.arrays(
    np.uint8, hnp.array_shapes(min_dims=2, max_dims=2, max_side=9), elements=st.integers(0, 2)
)


def room(rows: str, resolution: float = 1.0, origin: Pose2 = Pose2(0, 0)) -> OccupancyGrid:  # noqa: B008
    """Draw a grid: '#' occupied, '.' free, '?' unknown; the last line is the lowest row."""
    code = {"#": Cell.OCCUPIED, ".": Cell.FREE, "?": Cell.UNKNOWN}
    cells = [[code[sign] for sign in line] for line in reversed(rows.split())]
    return OccupancyGrid(np.array(cells, dtype=np.uint8), resolution, origin, "a drawn room")


@settings(max_examples=150, deadline=None)
@given(cells=states, clearance=st.sampled_from([0.0, 0.5, 1.0, 1.2, 1.5, 2.0, 2.3]))
def test_inflation_keeps_the_clearance_from_all_that_is_not_free(cells: np.ndarray, clearance: float) -> None:
    grid = OccupancyGrid(cells, 0.5, Pose2(1, 2, 0.3), "a test")
    padded = np.pad(cells, 6)
    blocked = np.argwhere(padded != Cell.FREE)
    expected = np.zeros(cells.shape, dtype=bool)
    for row, column in np.ndindex(cells.shape):
        nearest = np.hypot(*(blocked - (row + 6, column + 6)).T).min() * 0.5
        expected[row, column] = nearest > clearance + 1e-9
    try:
        navigation = NavigationGrid.from_occupancy(grid, clearance)
    except NoNavigablePoseError as error:
        assert not expected.any()
        assert "a test" in str(error)
    else:
        assert (navigation.navigable == expected).all()


def test_reachable_cells_are_those_of_the_start() -> None:
    grid = room(
        """
        ..#..
        ..#..
        ###..
        .....
        """
    )
    navigation = NavigationGrid.from_occupancy(grid, 0.0)
    upper_left = navigation.reachable_from(Pose2(0.5, 3.5))
    assert upper_left.navigable.sum() == 4
    rest = navigation.reachable_from(Pose2(4.5, 3.5))
    assert rest.navigable.sum() == 11
    assert not (upper_left.navigable & rest.navigable).any()


def test_a_diagonal_gap_is_no_door() -> None:
    navigation = NavigationGrid.from_occupancy(room(".#\n#."), 0.0)
    assert navigation.reachable_from(Pose2(0.5, 1.5)).navigable.sum() == 1


def test_places_where_the_robot_cannot_stand() -> None:
    navigation = NavigationGrid.from_occupancy(room("....\n....\n#...\n#..."), 0.5)
    with pytest.raises(OutsideMapError, match=r"drawn room: the robot's start at \(9.00 m, 1.00 m\)"):
        navigation.reachable_from(Pose2(9, 1))
    with pytest.raises(BlockedPoseError, match=r"within 0.50 m .* nearest free place is \(0.50 m, 2.50 m\)"):
        navigation.reachable_from(Pose2(0.2, 1.4))
    with pytest.raises(OutsideMapError):
        navigation.cell_of((1e300, 0.0))
    with pytest.raises(ValueRangeError):
        navigation.cell_of((math.nan, 0.0))
    with pytest.raises(NoNavigablePoseError, match=r"inflation by 7.00 m"):
        NavigationGrid.from_occupancy(navigation.grid, 7.0)
    for clearance in (-0.1, math.nan, math.inf):
        with pytest.raises(ValueRangeError):
            NavigationGrid.from_occupancy(navigation.grid, clearance)


def test_poses_are_uniform_over_cells_places_and_headings() -> None:
    origin = Pose2(-3.0, 1.0, 0.7)
    navigation = NavigationGrid.from_occupancy(room("..#\n...\n?..", 0.5, origin), 0.0)
    poses = navigation.sample_poses(14_000, np.random.default_rng(5))
    assert poses.shape == (14_000, 3)
    assert navigation.is_navigable(poses[:, :2]).all()
    rows, columns = navigation.grid.cells_of(poses[:, :2]).T
    counts = np.zeros((3, 3))
    np.add.at(counts, (rows, columns), 1)
    assert (np.abs(counts[navigation.navigable] - 2000) < 5 * math.sqrt(2000)).all()
    inside = origin.transform_inverse(poses[:, :2]) / 0.5 % 1.0
    assert np.allclose(inside.mean(axis=0), 0.5, atol=0.02)
    assert np.allclose(inside.var(axis=0), 1 / 12, atol=0.005)
    assert np.allclose(np.histogram(poses[:, 2], 8, (-np.pi, np.pi))[0], 1750, atol=200)


def test_poses_come_from_the_generator_alone() -> None:
    navigation = NavigationGrid.from_occupancy(room("...\n..."), 0.0)
    first, again = (navigation.sample_poses(20, np.random.default_rng(3)) for _ in range(2))
    assert (first == again).all()
    assert navigation.sample_poses(0, np.random.default_rng(3)).shape == (0, 3)


def test_a_grid_without_navigable_cells_has_no_poses() -> None:
    grid = room("..")
    navigation = NavigationGrid(grid, 0.2, np.zeros((1, 2), dtype=bool))
    with pytest.raises(NoNavigablePoseError):
        navigation.sample_poses(1, np.random.default_rng(0))
    with pytest.raises(NoNavigablePoseError):
        navigation.nearest_navigable((0.0, 0.0))


def test_nothing_in_a_navigation_grid_can_be_changed() -> None:
    navigation = NavigationGrid.from_occupancy(room("...\n..."), 0.0)
    for array in (navigation.navigable, navigation.moves, navigation.grid.cells):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def column(*layers: int) -> VoxelGrid:
    """One column of voxels of 0.1 m whose floor layer is the first, its middle at z = 0."""
    return VoxelGrid(np.array([[layers]], dtype=np.uint8), 0.1, (0.0, 0.0, -0.05), "a column")


@pytest.mark.parametrize(
    ("layers", "state"),
    [
        ((2, 1, 1, 1, 1), Cell.FREE),
        ((2, 0, 0, 0, 0), Cell.FREE),
        ((0, 0, 0, 1, 0), Cell.FREE),
        ((0, 0, 0, 0, 0), Cell.UNKNOWN),
        ((0, 0, 0, 0, 2), Cell.UNKNOWN),
        ((2, 1, 2, 1, 1), Cell.OCCUPIED),
        ((0, 0, 0, 2, 0), Cell.OCCUPIED),
        ((1, 1, 1, 1, 2), Cell.FREE),
    ],
)
def test_columns_become_cells(layers: tuple[int, ...], state: Cell) -> None:
    grid = occupancy_from_voxels(column(*layers), 0.0, (0.15, 0.35))
    assert grid.cells.tolist() == [[state]]


def test_plane_map_lies_under_its_voxels() -> None:
    voxels = np.ones((5, 3, 4), dtype=np.uint8)
    voxels[4, 1, 2] = Cell.OCCUPIED
    grid = occupancy_from_voxels(VoxelGrid(voxels, 0.5, (-1.0, 2.0, 0.0), "a hall"), 0.0)
    assert grid.cells.shape == (3, 5)
    assert np.argwhere(grid.cells == Cell.OCCUPIED).tolist() == [[1, 4]]
    assert np.allclose(grid.centres_of((1, 4)), (1.25, 2.75))
    assert (grid.source, grid.resolution) == ("a hall", 0.5)
    with pytest.raises(ValueRangeError, match="height band"):
        occupancy_from_voxels(VoxelGrid(voxels, 0.5, (0.0, 0.0, 0.0), "a hall"), 9.0)


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
def test_kitchen_can_be_navigated_by_both_maps() -> None:
    folder = data_root() / "tum_kitchen"
    voxels = read_octomap(folder / "tum_kitchen_octomap.bt").voxel_grid()
    for grid in (read_ros_map(folder / "tum_kitchen.yaml"), occupancy_from_voxels(voxels, -0.37)):
        navigation = NavigationGrid.from_occupancy(grid, 0.5).reachable_from(Pose2(0, 0))
        assert 25.0 < navigation.navigable.sum() * grid.resolution**2 < 40.0
