"""Times the maps layer and sets each time beside a limit or a peer that needs nothing but numpy and scipy.

Run it as `python benchmarks/bench_maps.py`. The kitchen of the data folder is used where it is there, else a
synthetic hall; the first call of each kernel, which compiles it, is not counted.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from timing import best_of

from qsrlang.maps.mapping import VoxelMapper
from qsrlang.maps.navigation import NavigationGrid, occupancy_from_voxels
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.octomap import read_octomap
from qsrlang.maps.paths import DistanceField, path_length, shortest_path
from qsrlang.maps.spreading import MOVES, STEPS
from qsrlang.maps.supports import find_supports
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.resources import data_root

KITCHEN = Path("tum_kitchen/tum_kitchen_octomap.bt")
CLEARANCE = 0.3


def report(name: str, seconds: float, peer: str, peer_seconds: float) -> None:
    ratio = seconds / peer_seconds
    print(f"{name:44s} {1e3 * seconds:9.2f} ms   {ratio:7.2f} x  {peer} ({1e3 * peer_seconds:.2f} ms)")


def synthetic_hall() -> VoxelGrid:
    voxels = np.full((120, 128, 50), Cell.FREE, dtype=np.uint8)
    voxels[:, :, :2] = Cell.OCCUPIED
    voxels[[0, -1]], voxels[:, [0, -1]] = Cell.OCCUPIED, Cell.OCCUPIED
    for x, y in np.random.default_rng(0).integers(20, 90, (4, 2)):
        voxels[x : x + 12, y : y + 18, 2:18] = Cell.OCCUPIED
    return VoxelGrid(voxels, 0.05, (0.0, 0.0, 0.0), "a synthetic hall")


def bytes_of_tree(grid: VoxelGrid) -> bytes:
    """Encode a grid of at most 128 voxels a side as an OctoMap file with all leaves at the finest depth."""
    cells = np.zeros((128, 128, 128), dtype=np.uint8)
    cells[tuple(slice(0, side) for side in grid.voxels.shape)] = grid.voxels
    levels = [cells]
    while levels[-1].shape[0] > 1:
        side = levels[-1].shape[0] // 2
        blocks = levels[-1].reshape(side, 2, side, 2, side, 2)
        levels.append(np.where(blocks.any(axis=(1, 3, 5)), 3, 0).astype(np.uint8))
    body, count, pending = bytearray(b"\x00\xc0" + b"\x03\x00" * 8), 10, [(7, 0, 0, 0)]
    while pending:
        level, x, y, z = pending.pop()
        block = levels[level - 1][2 * x : 2 * x + 2, 2 * y : 2 * y + 2, 2 * z : 2 * z + 2]
        states = block.transpose(2, 1, 0).ravel().tolist()
        body += sum(state << 2 * child for child, state in enumerate(states)).to_bytes(2, "little")
        count += sum(state > 0 for state in states)
        inner = [child for child in range(7, -1, -1) if level > 1 and states[child]]
        pending += [(level - 1, 2 * x + (c & 1), 2 * y + (c >> 1 & 1), 2 * z + (c >> 2)) for c in inner]
    header = f"# Octomap OcTree binary file\nid OcTree\nsize {count}\nres 0.05\ndata\n"
    return header.encode() + bytes(body)


def cloud(eye: np.ndarray, width: int = 320, height: int = 240) -> np.ndarray:
    u, v = np.meshgrid(np.linspace(-0.64, 0.64, width), np.linspace(-0.48, 0.48, height))
    rays = np.stack([np.ones_like(u), u, v], axis=-1).reshape(-1, 3)
    low, high = np.array([0.0, 0.0, 0.0]), np.array([8.0, 8.0, 2.5])
    return np.asarray(
        eye + rays * np.where(rays > 0, (high - eye) / rays, (low - eye) / rays).min(axis=1)[:, None]
    )


def bench_octomap(folder: Path) -> tuple[VoxelGrid, float]:
    path, floor = data_root() / KITCHEN, -0.37
    if not path.is_file():
        print(f"{path} is absent: a synthetic hall takes its place")
        path, floor = folder / "hall.bt", 0.05
        path.write_bytes(bytes_of_tree(synthetic_hall()))
    tree = read_octomap(path)
    print(f"{path.name}: {tree.occupied_leaves:,} occupied and {tree.free_leaves:,} free leaves")
    peer = best_of(lambda: np.unpackbits(np.frombuffer(path.read_bytes(), dtype=np.uint8)).sum())
    report("read the .bt file", best_of(lambda: read_octomap(path)), "read and count its bits in numpy", peer)
    grid = tree.voxel_grid()
    copy = best_of(lambda: grid.voxels.copy())
    report("fill the dense grid", best_of(tree.voxel_grid), "copy the dense grid", copy)
    return grid, floor


def bench_mapping() -> None:
    eye = np.array([1.6, 2.1, 1.5])
    points = cloud(eye)
    mapper = VoxelMapper((-0.125, -0.125, -0.125), (168, 168, 58), 0.05)
    steps = int((np.abs(points - eye).sum(axis=1) / 0.05).sum())
    field = np.zeros(steps, dtype=np.uint8)
    peer = best_of(lambda: field.sum())
    name = f"integrate {len(points):,} rays ({steps / 1e6:.1f} M steps)"
    report(name, best_of(lambda: mapper.insert(eye, points)), "sum one byte a step in numpy", peer)


def bench_supports(grid: VoxelGrid) -> None:
    peer = best_of(lambda: grid.indices(Cell.OCCUPIED))
    for method in ("pca", "mean-normal"):
        seconds = best_of(lambda method=method: find_supports(grid, method), 3)
        report(f"supports, {method}", seconds, "list the occupied voxels", peer)


def scipy_graph(navigation: NavigationGrid) -> csr_array:
    cells, bits = np.nonzero(navigation.moves[:, None] >> np.arange(8) & 1)
    heads = cells + MOVES[bits, 0] * navigation.navigable.shape[1] + MOVES[bits, 1]
    return csr_array((STEPS[bits], (cells, heads)), shape=(navigation.moves.size,) * 2)


def bench_paths(grid: VoxelGrid, floor: float) -> None:
    plane = occupancy_from_voxels(grid, floor)
    seconds = best_of(lambda: occupancy_from_voxels(grid, floor))
    report("plane map from voxels", seconds, "copy the dense grid", best_of(lambda: grid.voxels.copy()))
    whole = NavigationGrid.from_occupancy(plane, CLEARANCE)
    seconds = best_of(lambda: NavigationGrid.from_occupancy(plane, CLEARANCE))
    report("inflate", seconds, "copy the cells as float", best_of(lambda: plane.cells.astype(float)))
    x, y, _ = whole.sample_poses(1, np.random.default_rng(2))[0]
    navigation = whole.reachable_from(type(plane.origin)(float(x), float(y)))
    poses = navigation.sample_poses(400, np.random.default_rng(1))[:, :2]
    graph, start = (
        scipy_graph(navigation),
        np.ravel_multi_index(navigation.cell_of(poses[0]), plane.cells.shape),
    )
    peer = best_of(lambda: dijkstra(graph, indices=start))
    field = DistanceField.from_start(navigation, poses[0])
    name = f"distance field, {navigation.navigable.sum():,} cells"
    seconds = best_of(lambda: DistanceField.from_start(navigation, poses[0]))
    report(name, seconds, "scipy's Dijkstra, graph made before", peer)
    report("400 lengths from that field", best_of(lambda: field.lengths_to(poses)), "scipy's Dijkstra", peer)
    begin = time.perf_counter()
    paths = [shortest_path(navigation, a, b) for a, b in zip(poses[::2], poses[1::2], strict=True)]
    mean = (time.perf_counter() - begin) / len(paths)
    report("one path between two places (mean of 200)", mean, "scipy's Dijkstra, no path yet", peer)
    straight = np.hypot(*(poses[::2] - poses[1::2]).T).sum()
    print(f"paths are {sum(map(path_length, paths)) / straight:.3f} x the straight lines", end="; ")
    octile = dijkstra(graph, indices=start)[np.ravel_multi_index(plane.cells_of(poses).T, plane.cells.shape)]
    ratio = np.median(octile[1:] * plane.resolution / field.lengths_to(poses[1:]))
    print(f"8-connected lengths are {100 * (ratio - 1):.1f} % longer in the median")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        grid, floor = bench_octomap(Path(folder))
    bench_mapping()
    bench_supports(grid)
    bench_paths(grid, floor)


if __name__ == "__main__":
    main()
