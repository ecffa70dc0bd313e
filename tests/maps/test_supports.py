from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from box_rooms import BoxRoom
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.maps.normals import NEIGHBOURS, REACH, cube_normals, facing_up, mean_normals
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.octomap import read_octomap
from qsrlang.maps.supports import METHODS, Supports, find_supports
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.resources import data_root

voxel_blocks = hnp.arrays(
    np.uint8, hnp.array_shapes(min_dims=3, max_dims=3, max_side=6), elements=st.integers(0, 2)
)


def score(room: BoxRoom, grid: VoxelGrid, supports: Supports) -> tuple[float, float, float]:
    """Return precision, recall over all support faces, and recall over those that were mapped at all."""
    truth: dict[tuple[int, int], list[float]] = {}
    faces = room.support_columns(grid, 0.3, 1.5)
    for i, j, z in faces:
        truth.setdefault((i, j), []).append(z)
    found: dict[tuple[int, int], list[float]] = {}
    for (i, j, _), z in zip(grid.indices_of(supports.centres), supports.centres[:, 2], strict=True):
        found.setdefault((int(i), int(j)), []).append(float(z))

    def near(z: float, others: list[float]) -> bool:
        return any(abs(z - other) <= 1.501 * grid.resolution for other in others)

    right = sum(near(z, truth.get(at, [])) for at, heights in found.items() for z in heights)
    hit = sum(near(z, found.get((i, j), [])) for i, j, z in faces)
    layer = [int((z - grid.origin[2]) / grid.resolution) for *_, z in faces]
    mapped = sum(
        bool((grid.voxels[i, j, k - 1 : k + 2] == Cell.OCCUPIED).any())
        for (i, j, _), k in zip(faces, layer, strict=True)
    )
    return right / len(supports.centres), hit / len(faces), hit / mapped


@pytest.mark.parametrize(
    ("method", "precision", "recall", "recall_mapped"),
    [("pca", 0.97, 0.78, 0.87), ("mean-normal", 0.99, 0.5, 0.55)],
)
def test_supports_of_a_rendered_room(
    box_room: BoxRoom,
    box_room_map: VoxelGrid,
    method: str,
    precision: float,
    recall: float,
    recall_mapped: float,
) -> None:
    supports = find_supports(box_room_map, method, min_height=0.3, max_height=1.5)
    found = score(box_room, box_room_map, supports)
    assert found[0] >= precision
    assert found[1] >= recall
    assert found[2] >= recall_mapped


def test_parts_of_a_rendered_room_are_its_furniture(box_room_map: VoxelGrid) -> None:
    supports = find_supports(box_room_map, min_height=0.3, max_height=1.1, min_part=60)
    tops = [supports.centres_of(name)[:, 2] for name in supports.names]
    assert sorted(round(float(np.median(top)), 2) for top in tops) == [0.45, 0.5, 0.75, 0.9, 1.0]
    sizes = [len(top) for top in tops]
    assert sizes == sorted(sizes, reverse=True)
    table = supports.names[[0.74 <= np.median(top) <= 0.76 for top in tops].index(True)]
    low, high = (getattr(supports.centres_of(table), end)(axis=0)[:2] for end in ("min", "max"))
    assert np.allclose(low, (2.525, 1.525), atol=0.06)
    assert np.allclose(high, (4.075, 2.475), atol=0.06)


def layered(*heights: int, size: int = 12) -> VoxelGrid:
    """Boards one voxel thick and 8 x 8 wide in free space."""
    voxels = np.full((size, size, size), Cell.FREE, dtype=np.uint8)
    for height in heights:
        voxels[2:10, 2:10, height] = Cell.OCCUPIED
    return VoxelGrid(voxels, 0.1, (0.0, 0.0, 0.0), "boards")


def test_a_board_in_free_air_is_a_support_by_pca_only() -> None:
    supports = find_supports(layered(4))
    assert len(supports.centres) == 64
    assert np.allclose(supports.centres[:, 2], 0.45)
    assert len(find_supports(layered(4), "mean-normal").centres) == 0


def test_a_block_seen_from_above_is_a_support_by_both() -> None:
    voxels = layered(4).voxels.copy()
    voxels[:, :, :4] = Cell.UNKNOWN
    grid = VoxelGrid(voxels, 0.1, (0.0, 0.0, 0.0), "a block")
    middle = {(i, j, 4) for i in range(3, 9) for j in range(3, 9)}
    for method in METHODS:
        found = {tuple(index) for index in grid.indices_of(find_supports(grid, method).centres)}
        assert middle <= found
        assert all(index[2] == 4 for index in found)


def test_ceilings_and_walls_support_nothing() -> None:
    voxels = np.full((12, 12, 12), Cell.FREE, dtype=np.uint8)
    voxels[:, :, 10] = Cell.OCCUPIED
    voxels[:, :, 11] = Cell.UNKNOWN
    voxels[6, :, :10] = Cell.OCCUPIED
    grid = VoxelGrid(voxels, 0.1, (0.0, 0.0, 0.0), "a hall")
    for method in METHODS:
        assert len(find_supports(grid, method, min_height=0.1).centres) == 0


def tilted(angle: float) -> VoxelGrid:
    """A plane tilted about y, solid below, free above."""
    i, _, k = np.indices((40, 12, 40))
    solid = (k + 0.5) * 0.1 <= 2.0 + math.tan(angle) * ((i + 0.5) * 0.1 - 2.0)
    surface = solid & ~np.roll(solid, -1, axis=2)
    voxels = np.where(surface, Cell.OCCUPIED, np.where(solid, Cell.UNKNOWN, Cell.FREE)).astype(np.uint8)
    return VoxelGrid(voxels, 0.1, (0.0, 0.0, 0.0), "a ramp")


def test_tilt_decides() -> None:
    for method, share, rest in (("pca", 0.8, 0.1), ("mean-normal", 0.6, 0.35)):
        total = np.count_nonzero(tilted(0.0).voxels == Cell.OCCUPIED)
        assert len(find_supports(tilted(0.1), method).centres) > share * total
        assert len(find_supports(tilted(0.6), method).centres) < rest * total
        assert len(find_supports(tilted(0.6), method, max_tilt=0.9).centres) > share * total


def test_heights_parts_and_names() -> None:
    voxels = layered(2, 6).voxels.copy()
    voxels[2:5, :, 6] = Cell.FREE
    grid = VoxelGrid(voxels, 0.1, (0.0, 0.0, -1.0), "two boards")
    both = find_supports(grid)
    assert both.names == ("support-1", "support-2")
    assert np.bincount(both.part).tolist() == [64, 40]
    assert (np.diff(both.part) >= 0).all()
    assert np.allclose(both.centres_of("support-2")[:, 2], -0.35)
    assert find_supports(grid, min_part=41).names == ("support-1",)
    assert np.allclose(find_supports(grid, min_height=-0.6).centres[:, 2], -0.35)
    assert np.allclose(find_supports(grid, max_height=-0.6).centres[:, 2], -0.75)
    with pytest.raises(UnknownNameError, match=r"support-3.*support-1"):
        both.centres_of("support-3")


@pytest.mark.parametrize("method", METHODS)
def test_nothing_found_is_empty(method: str) -> None:
    free = VoxelGrid(np.ones((4, 4, 4), dtype=np.uint8), 0.1, (0.0, 0.0, 0.0), "air")
    for supports in (find_supports(free, method), find_supports(layered(4), method, min_height=3.0)):
        assert supports.centres.shape == (0, 3)
        assert supports.part.shape == (0,)
        assert supports.names == ()
    assert find_supports(layered(4), method, min_part=65).names == ()


def test_senseless_questions_are_refused() -> None:
    with pytest.raises(UnknownNameError, match="pca"):
        find_supports(layered(4), "pcb")
    for tilt in (-0.1, math.pi / 2, math.nan):
        with pytest.raises(ValueRangeError):
            find_supports(layered(4), max_tilt=tilt)
    with pytest.raises(ValueRangeError):
        Supports(np.zeros((2, 3)), np.array([0, 1]), ("support-1",))


@settings(max_examples=60, deadline=None)
@given(voxels=voxel_blocks)
def test_pca_agrees_with_a_slow_recomputation(voxels: np.ndarray) -> None:
    grid = VoxelGrid(voxels, 0.1, (0.0, 0.0, 0.0), "a test")
    indices = grid.indices(Cell.OCCUPIED)
    state = {index: int(voxels[index]) for index in np.ndindex(voxels.shape)}
    faces, sure, flat = set(), set(), set()
    for x, y, z in map(tuple, indices):
        around = [state.get((x + i, y + j, z + 1), 0) for i, j in itertools.product((-1, 0, 1), repeat=2)]
        squares = ((indices - (x, y, z)) ** 2).sum(axis=1)
        ranked = np.sort(squares[(squares > 0) & (squares <= REACH**2)])
        if around[4] == Cell.OCCUPIED or Cell.FREE not in around or len(ranked) < 2:
            continue
        faces.add((x, y, z))
        last = ranked[min(NEIGHBOURS, len(ranked)) - 1]
        values, vectors = np.linalg.eigh(np.cov(indices[squares <= last].T, bias=True))
        if abs(vectors[2, 0]) >= math.cos(math.pi / 8) - 1e-6:
            flat.add((x, y, z))
        if values[1] - values[0] > 1e-6 and abs(abs(vectors[2, 0]) - math.cos(math.pi / 8)) > 1e-6:
            sure.add((x, y, z))
    found = set(map(tuple, indices[facing_up(grid, indices, math.pi / 8)]))
    assert found <= faces
    if faces == sure:
        rims = {
            (x, y, z)
            for x, y, z in faces
            if any((x + i, y + j, z) in flat for i, j in itertools.product((-1, 0, 1), repeat=2))
        }
        assert found == rims


def test_every_cube_closes_and_faces_free_space() -> None:
    sums, counts = cube_normals()
    corners = np.array(list(itertools.product((0, 1), repeat=3)))
    for cube in range(256):
        solid = np.array([cube >> corner & 1 for corner in range(8)], dtype=bool)
        if solid.all() or not solid.any():
            assert counts[cube] == 0
            continue
        towards_free = corners[~solid].mean(axis=0) - corners[solid].mean(axis=0)
        assert counts[cube] > 0
        assert sums[cube] @ towards_free >= -1e-9
        for flip in (1, 2, 4):
            mirrored = sum(1 << (corner ^ flip) for corner in range(8) if solid[corner])
            assert counts[cube] == counts[mirrored]


def test_known_cubes() -> None:
    sums, counts = cube_normals()
    assert np.allclose(sums[0b00000001], np.ones(3) / math.sqrt(3))
    assert counts[0b00000001] == 1
    assert np.allclose(sums[0b00001111], (2.0, 0.0, 0.0))
    assert np.allclose(sums[0b01010101], (0.0, 0.0, 2.0))
    assert np.allclose(sums[0b00000101] / 2, np.array([1.0, 0.0, 1.0]) / math.sqrt(2))
    assert counts[0b10000001] == 2
    assert counts[0b00001001] == 2
    assert counts[0b11110110] == 4


def test_mean_normals_of_flat_ground_point_up() -> None:
    grid = tilted(0.0)
    indices = grid.indices(Cell.OCCUPIED)
    inner = indices[(np.abs(indices[:, :2] - (20, 6)) < 4).all(axis=1)]
    assert np.allclose(mean_normals(grid, inner), (0.0, 0.0, 1.0))
    assert np.allclose(mean_normals(grid, inner, unknown_is_occupied=False), 0.0)


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
def test_worktops_of_the_kitchen() -> None:
    grid = read_octomap(data_root() / "tum_kitchen/tum_kitchen_octomap.bt").voxel_grid()
    for method in METHODS:
        supports = find_supports(grid, method, min_height=-0.1, max_height=0.7, min_part=40)
        for cup, height in (((0.8, -2.4), 0.95), ((-0.5, 4.8), 0.80), ((2.5, 4.8), 0.80)):
            beside = np.hypot(*(supports.centres[:, :2] - cup).T) < 0.3
            assert beside.any()
            assert abs(np.median(supports.centres[beside, 2]) + 0.37 - height) < 0.05


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
def test_table_tops_of_the_laboratory() -> None:
    grid = read_octomap(data_root() / "bham_lab/cs_lg_obj_search_octomap.bt").voxel_grid()
    supports = find_supports(grid, min_part=40, max_height=1.2)
    assert len(supports.names) >= 3
    assert abs(np.median(supports.centres_of("support-1")[:, 2]) - 0.775) < 0.03
