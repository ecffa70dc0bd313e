"""Reads OctoMap's binary trees (`.bt`)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import IntArray, frozen_array
from qsrlang.errors import FileError
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.reading import read_bounded
from qsrlang.maps.voxels import VoxelGrid

TREE_DEPTH = 16
KEY_OFFSET = 1 << (TREE_DEPTH - 1)
MAX_BT_BYTES = 128_000_000
MAX_LEAVES = 10_000_000
MAX_VOXELS = 200_000_000
MIN_RESOLUTION, MAX_RESOLUTION = 1e-4, 100.0
_MAGIC = b"# Octomap OcTree binary file"
_AGAIN = "copy the file again or write it anew with OctoMap's writeBinary"
_PROBLEMS = (
    "",
    "the tree is cut short",
    "a node lies below the finest depth",
    "bytes follow the end of the tree",
)


@dataclass(frozen=True, slots=True, eq=False)
class OctoMap:
    """The leaves of an octree: lowest `keys` (L, 3), `depths` (L,) and `states` (L,), a `Cell` each.

    A leaf at depth d spans 2^(16 - d) voxels along each axis; key k starts at (k - 32768) x resolution [m].
    """

    keys: IntArray
    depths: IntArray
    states: npt.NDArray[np.uint8]
    resolution: float
    source: str

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "keys", frozen_array("the keys of an octree", self.keys, (None, 3), np.int64)
        )
        for name, kind in (("depths", np.int64), ("states", np.uint8)):
            leaves = frozen_array(f"the {name} of an octree", getattr(self, name), (len(self.keys),), kind)
            object.__setattr__(self, name, leaves)

    @property
    def occupied_leaves(self) -> int:
        """How many leaves are occupied."""
        return int(np.count_nonzero(self.states == Cell.OCCUPIED))

    @property
    def free_leaves(self) -> int:
        """How many leaves are free."""
        return int(np.count_nonzero(self.states == Cell.FREE))

    def voxel_grid(self) -> VoxelGrid:
        """Return the dense grid around all leaves, coarse leaves filled in.

        Raises FileError where the tree is empty or its box has more than MAX_VOXELS voxels.
        """
        if len(self.keys) == 0:
            raise FileError(self.source, "the tree has no leaves", "map the place first")
        spans = 1 << (TREE_DEPTH - self.depths)
        lowest = self.keys.min(axis=0)
        shape = (self.keys + spans[:, None]).max(axis=0) - lowest
        if shape.prod() > MAX_VOXELS:
            box = " x ".join(f"{size:,}" for size in shape)
            raise FileError(
                self.source, f"its box has {box} voxels", f"prune it to at most {MAX_VOXELS:,} voxels"
            )
        voxels = np.zeros(tuple(shape), dtype=np.uint8)
        _fill(voxels, self.keys - lowest, spans, self.states)
        return VoxelGrid(voxels, self.resolution, (lowest - KEY_OFFSET) * self.resolution, self.source)


def read_octomap(path: Path | str) -> OctoMap:
    """Return the leaves of an OctoMap binary file (`.bt`).

    After a text header, each inner node is two bytes, two bits a child (1 free leaf, 2 occupied leaf, 3 inner
    node), in depth-first order; bits 0, 1 and 2 of a child's number are its x, y and z (Hornung et al. 2013).
    Raises FileError where the file is missing, of another kind, cut short, too long or unlike its header.
    """
    path = Path(path)
    data = read_bounded(path, MAX_BT_BYTES, "an OctoMap .bt file")
    size, resolution, start = _header(path, data)
    nodes = np.frombuffer(data, dtype=np.uint8, offset=start)
    leaves = _leaf_count(nodes)
    if leaves > MAX_LEAVES:
        raise FileError(path, f"{leaves:,} leaves", f"prune the tree to at most {MAX_LEAVES:,}")
    keys, depths = np.empty((leaves, 3), dtype=np.int64), np.empty(leaves, dtype=np.int64)
    states = np.empty(leaves, dtype=np.uint8)
    problem, inner = _walk(nodes, keys, depths, states) if size else (3 if len(nodes) else 0, 0)
    if problem:
        raise FileError(path, _PROBLEMS[problem], _AGAIN)
    if inner + leaves != size:
        raise FileError(path, f"its header promises {size:,} nodes but {inner + leaves:,} follow", _AGAIN)
    return OctoMap(keys, depths, states, resolution, str(path))


def _header(path: Path, data: bytes) -> tuple[int, float, int]:
    if not data.startswith(_MAGIC):
        raise FileError(path, f"it does not begin with '{_MAGIC.decode()}'", "name an OctoMap .bt file")
    end = re.search(rb"\ndata\s*?\n", data[:4096])
    if end is None:
        raise FileError(path, "its header has no line 'data'", _AGAIN)
    lines = [line.split() for line in data[: end.start()].split(b"\n") if not line.startswith(b"#")]
    fields = {line[0]: line[1] for line in lines if len(line) == 2}
    if fields.get(b"id") != b"OcTree":
        raise FileError(path, "its header does not say 'id OcTree'", "name the .bt file of an OcTree")
    size, resolution = fields.get(b"size", b""), _resolution(fields.get(b"res", b""))
    if not size.isdigit() or len(size) > 12:
        raise FileError(path, "its header has no valid 'size'", _AGAIN)
    if not MIN_RESOLUTION <= resolution <= MAX_RESOLUTION:
        limits = f"{MIN_RESOLUTION:g} to {MAX_RESOLUTION:g} m"
        raise FileError(path, f"its header's 'res' is not a resolution of {limits}", _AGAIN)
    return int(size), resolution, end.end()


def _resolution(text: bytes) -> float:
    try:
        return float(text)
    except ValueError:
        return 0.0


def _leaf_count(nodes: npt.NDArray[np.uint8]) -> int:
    single = ((nodes ^ (nodes >> 1)) & 0x55).astype(np.uint8)
    return int(np.count_nonzero(np.unpackbits(single)))


@njit(cache=True)
def _walk(nodes, keys, depths, states):  # type: ignore[no-untyped-def]
    pending = np.zeros((8 * TREE_DEPTH + 1, 4), dtype=np.int64)
    top, at, leaf, inner = 0, 0, 0, 0
    while top >= 0:
        x, y, z, depth = pending[top, 0], pending[top, 1], pending[top, 2], pending[top, 3]
        top -= 1
        if depth == TREE_DEPTH:
            return 2, inner
        if at + 2 > nodes.size:
            return 1, inner
        bits = np.int64(nodes[at]) | (np.int64(nodes[at + 1]) << 8)
        at += 2
        inner += 1
        half = np.int64(1) << (TREE_DEPTH - depth - 1)
        for child in range(7, -1, -1):
            if (bits >> (2 * child)) & 3 == 3:
                top += 1
                pending[top, 0] = x + half * (child & 1)
                pending[top, 1] = y + half * ((child >> 1) & 1)
                pending[top, 2] = z + half * (child >> 2)
                pending[top, 3] = depth + 1
        for child in range(8):
            state = (bits >> (2 * child)) & 3
            if state == 1 or state == 2:
                keys[leaf, 0] = x + half * (child & 1)
                keys[leaf, 1] = y + half * ((child >> 1) & 1)
                keys[leaf, 2] = z + half * (child >> 2)
                depths[leaf] = depth + 1
                states[leaf] = state
                leaf += 1
    return (3 if at < nodes.size else 0), inner


@njit(cache=True)
def _fill(voxels, corners, spans, states):  # type: ignore[no-untyped-def]
    for leaf in range(len(states)):
        x, y, z = corners[leaf]
        for i in range(x, x + spans[leaf]):
            for j in range(y, y + spans[leaf]):
                for k in range(z, z + spans[leaf]):
                    voxels[i, j, k] = states[leaf]
