from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from qsrlang.errors import FileError
from qsrlang.maps import octomap
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.octomap import KEY_OFFSET, TREE_DEPTH, OctoMap, read_octomap
from qsrlang.resources import data_root

Leaves = dict[tuple[int, int, int, int], int]
HEADER = "# Octomap OcTree binary file\n# (a comment)\nid OcTree\nsize {size}\nres {res}\ndata\n"


def encode(leaves: Leaves) -> tuple[bytes, int]:
    """Write leaves {(x, y, z, depth): state} the slow and obvious way: nodes in depth-first order."""

    def node(corner: tuple[int, int, int], depth: int, inside: Leaves) -> tuple[bytes, int]:
        half, word, tail, count = 1 << (TREE_DEPTH - depth - 1), 0, b"", 1
        for child, (dz, dy, dx) in enumerate(itertools.product((0, 1), repeat=3)):
            low = (corner[0] + half * dx, corner[1] + half * dy, corner[2] + half * dz)
            own = {
                key: state
                for key, state in inside.items()
                if all(low[a] <= key[a] < low[a] + half for a in range(3)) and key[3] > depth
            }
            if (*low, depth + 1) in own:
                word |= own[(*low, depth + 1)] << 2 * child
                count += 1
            elif own:
                word |= 3 << 2 * child
                below, nodes = node(low, depth + 1, own)
                tail, count = tail + below, count + nodes
        return word.to_bytes(2, "little") + tail, count

    return node((0, 0, 0), 0, leaves)


def write_bt(path: Path, body: bytes, size: int, res: str = "0.05", text: str = HEADER) -> Path:
    path.write_bytes(text.format(size=size, res=res).encode() + body)
    return path


@st.composite
def trees(draw: st.DrawFn) -> Leaves:
    """Leaves of mixed depths in a box of 16 voxels, none inside another."""
    leaves: Leaves = {}
    taken: set[tuple[int, int, int]] = set()
    for _ in range(draw(st.integers(1, 12))):
        depth = draw(st.integers(14, 16))
        span = 1 << (TREE_DEPTH - depth)
        x, y, z = (32760 + span * draw(st.integers(0, 16 // span - 1)) for _ in range(3))
        cells = set(itertools.product(range(x, x + span), range(y, y + span), range(z, z + span)))
        if not cells & taken:
            taken |= cells
            leaves[x, y, z, depth] = draw(st.sampled_from([1, 2]))
    return leaves


SAMPLE: Leaves = {(32768, 32768, 32768, 16): 2, (32769, 32768, 32768, 16): 1, (32772, 32776, 32760, 14): 2}


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(leaves=trees())
def test_every_leaf_is_read(tmp_path: Path, leaves: Leaves) -> None:
    body, size = encode(leaves)
    tree = read_octomap(write_bt(tmp_path / "tree.bt", body, size))
    rows = np.column_stack([tree.keys, tree.depths])
    read = {tuple(map(int, row)): int(state) for row, state in zip(rows, tree.states, strict=True)}
    assert read == leaves
    assert tree.occupied_leaves == sum(state == 2 for state in leaves.values())
    assert tree.free_leaves == sum(state == 1 for state in leaves.values())
    grid = tree.voxel_grid()
    for (x, y, z, depth), state in leaves.items():
        span = 1 << (TREE_DEPTH - depth)
        corner = (np.array([x, y, z]) - KEY_OFFSET) * 0.05
        i, j, k = grid.indices_of(corner + 0.025)
        assert (grid.voxels[i : i + span, j : j + span, k : k + span] == state).all()
    volume = sum(8 ** (TREE_DEPTH - depth) for *_, depth in leaves)
    assert np.count_nonzero(grid.voxels) == volume


def test_keys_are_places(tmp_path: Path) -> None:
    body, size = encode({(32768, 32767, 32770, 16): 2})
    grid = read_octomap(write_bt(tmp_path / "one.bt", body, size, "0.1")).voxel_grid()
    assert grid.voxels.tolist() == [[[Cell.OCCUPIED]]]
    assert np.allclose(grid.origin, (0.0, -0.1, 0.2))
    assert np.allclose(grid.centres_of((0, 0, 0)), (0.05, -0.05, 0.25))


def test_empty_tree_has_no_grid(tmp_path: Path) -> None:
    tree = read_octomap(write_bt(tmp_path / "empty.bt", b"", 0))
    assert (tree.occupied_leaves, tree.free_leaves) == (0, 0)
    with pytest.raises(FileError, match="no leaves"):
        tree.voxel_grid()


def test_scattered_tree_is_refused_by_name(tmp_path: Path) -> None:
    body, size = encode({(0, 0, 0, 16): 2, (65535, 65535, 65535, 16): 2})
    with pytest.raises(FileError, match=r"65,536 x 65,536 x 65,536 voxels"):
        read_octomap(write_bt(tmp_path / "far.bt", body, size)).voxel_grid()


def test_too_many_leaves_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(octomap, "MAX_LEAVES", 2)
    body, size = encode(SAMPLE)
    with pytest.raises(FileError, match="3 leaves"):
        read_octomap(write_bt(tmp_path / "tree.bt", body, size))


@pytest.mark.parametrize("kept", [0, 1, 2, 7, -1, -2])
def test_cut_short(tmp_path: Path, kept: int) -> None:
    body, size = encode(SAMPLE)
    with pytest.raises(FileError, match="cut short"):
        read_octomap(write_bt(tmp_path / "tree.bt", body[:kept], size))


@pytest.mark.parametrize("tail", [b"\0", b"\n", b"\0\0", b"abc"])
def test_trailing_bytes(tmp_path: Path, tail: bytes) -> None:
    body, size = encode(SAMPLE)
    with pytest.raises(FileError, match="follow the end"):
        read_octomap(write_bt(tmp_path / "tree.bt", body + tail, size))
    with pytest.raises(FileError, match="follow the end"):
        read_octomap(write_bt(tmp_path / "empty.bt", tail, 0))


def test_too_deep(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="finest depth"):
        read_octomap(write_bt(tmp_path / "deep.bt", b"\x03\x00" * 17 + b"\x01\x00", 18))


@pytest.mark.parametrize(
    ("text", "res", "shift", "words"),
    [
        (HEADER, "0.05", 1, "promises"),
        (HEADER, "0.05", -1, "promises"),
        (HEADER, "0", 0, "'res'"),
        (HEADER, "-0.05", 0, "'res'"),
        (HEADER, "nan", 0, "'res'"),
        (HEADER, "inf", 0, "'res'"),
        (HEADER, "1e9", 0, "'res'"),
        (HEADER, "fine", 0, "'res'"),
        (HEADER.replace("res {res}\n", ""), "0.05", 0, "'res'"),
        (HEADER.replace("{size}", "-{size}"), "0.05", 0, "'size'"),
        (HEADER.replace("{size}", "9" * 30), "0.05", 0, "'size'"),
        (HEADER.replace("id OcTree", "id ColorOcTree"), "0.05", 0, "id OcTree"),
        (HEADER.replace("OcTree binary file", "OcTree file"), "0.05", 0, "does not begin with"),
        (HEADER.replace("data\n", ""), "0.05", 0, "no line 'data'"),
        ("\x89PNG", "0.05", 0, "does not begin with"),
    ],
)
def test_lying_header(tmp_path: Path, text: str, res: str, shift: int, words: str) -> None:
    body, size = encode(SAMPLE)
    with pytest.raises(FileError) as error:
        read_octomap(write_bt(tmp_path / "tree.bt", body, size + shift, res, text))
    assert words in str(error.value)
    assert str(tmp_path / "tree.bt") in str(error.value)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(body=st.binary(max_size=60), size=st.integers(0, 40))
def test_any_bytes_give_a_tree_or_a_file_error(tmp_path: Path, body: bytes, size: int) -> None:
    try:
        tree = read_octomap(write_bt(tmp_path / "any.bt", body, size))
    except FileError:
        return
    assert isinstance(tree, OctoMap)


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        read_octomap(tmp_path / "none.bt")


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
@pytest.mark.parametrize(
    ("name", "occupied", "free", "resolution"),
    [
        ("tum_kitchen/tum_kitchen_octomap.bt", 67_084, 156_089, 0.05),
        ("bham_lab/cs_lg_obj_search_octomap.bt", 44_216, 181_194, 0.05),
        ("geb079/geb079.bt", 143_729, 284_415, 0.08),
    ],
)
def test_real_trees(name: str, occupied: int, free: int, resolution: float) -> None:
    tree = read_octomap(data_root() / name)
    assert (tree.occupied_leaves, tree.free_leaves, tree.resolution) == (occupied, free, resolution)
    grid = tree.voxel_grid()
    spans = 8 ** (TREE_DEPTH - tree.depths)
    for state in (Cell.FREE, Cell.OCCUPIED):
        assert np.count_nonzero(grid.voxels == state) == spans[tree.states == state].sum()


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
def test_kitchen_box_and_coarse_leaves() -> None:
    tree = read_octomap(data_root() / "tum_kitchen/tum_kitchen_octomap.bt")
    assert np.count_nonzero((tree.states == Cell.OCCUPIED) & (tree.depths == 15)) == 2_671
    grid = tree.voxel_grid()
    assert np.allclose(grid.origin, (-2.65, -6.5, -0.45))
    assert np.allclose(grid.origin + np.array(grid.voxels.shape) * 0.05, (5.8, 5.9, 3.6))
