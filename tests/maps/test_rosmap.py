from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from qsrlang.errors import FileError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps import pgm
from qsrlang.maps.occupancy import Cell
from qsrlang.maps.rosmap import read_ros_map
from qsrlang.resources import data_root

YAML = """\
image: room.pgm
resolution: 0.05
origin: [-1.0, 2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
PIXELS = np.array([[0, 254, 205], [128, 0, 254]], dtype=np.uint8)
F, X, U = Cell.FREE, Cell.OCCUPIED, Cell.UNKNOWN


def write_map(folder: Path, text: str = YAML, image: bytes | None = None) -> Path:
    (folder / "room.pgm").write_bytes(image or b"P5\n# CREATOR: map_saver\n3 2\n255\n" + PIXELS.tobytes())
    path = folder / "room.yaml"
    path.write_text(text)
    return path


def test_trinary_map_has_its_lowest_row_first(tmp_path: Path) -> None:
    grid = read_ros_map(write_map(tmp_path))
    assert grid.cells.tolist() == [[U, X, F], [X, F, U]]
    assert grid.resolution == 0.05
    assert grid.origin == Pose2(-1.0, 2.0, 0.0)
    assert grid.source == str(tmp_path / "room.yaml")
    assert np.allclose(grid.bounds, (-1.0, 2.0, -0.85, 2.1))


def test_negate_turns_black_and_white_round(tmp_path: Path) -> None:
    grid = read_ros_map(write_map(tmp_path, YAML.replace("negate: 0", "negate: 1")))
    assert grid.cells.tolist() == [[U, F, X], [F, X, X]]


def test_thresholds_are_strict(tmp_path: Path) -> None:
    text = YAML.replace("0.65", "0.6").replace("0.196", "0.2")
    values = bytes([102, 101, 204, 205])
    grid = read_ros_map(write_map(tmp_path, text, b"P5 4 1 255\n" + values))
    assert grid.cells.tolist() == [[U, X, U, F]]


@pytest.mark.parametrize(("value", "state"), [(254, F), (150, F), (146, X), (100, X), (0, X)])
def test_scale_mode_takes_the_more_probable_state(tmp_path: Path, value: int, state: Cell) -> None:
    grid = read_ros_map(write_map(tmp_path, YAML + "mode: scale\n", b"P5 1 1 255\n" + bytes([value])))
    assert grid.cells.tolist() == [[state]]


@pytest.mark.parametrize(("value", "state"), [(0, F), (49, F), (50, X), (100, X), (101, U), (255, U)])
def test_raw_mode_reads_per_cent(tmp_path: Path, value: int, state: Cell) -> None:
    grid = read_ros_map(write_map(tmp_path, YAML + "mode: raw\n", b"P5 1 1 255\n" + bytes([value])))
    assert grid.cells.tolist() == [[state]]


def test_origin_with_yaw_turns_the_grid(tmp_path: Path) -> None:
    text = YAML.replace("[-1.0, 2.0, 0.0]", f"[-1.0, 2.0, {math.pi / 2}]")
    grid = read_ros_map(write_map(tmp_path, text))
    assert np.allclose(grid.centres_of((0, 0)), (-1.025, 2.025))
    assert np.allclose(grid.centres_of((0, 2)), (-1.025, 2.125))
    assert np.allclose(grid.bounds, (-1.1, 2.0, -1.0, 2.15))


@pytest.mark.parametrize(
    "image",
    [
        b"P2\n3 2\n255\n0 254 205\n128 0 254\n",
        b"P2\n# CREATOR: gimp\n3 2 # size\n255\n0 254 205 # row\n128 0 254",
        b"P5\n#a\n#b\n3\n#c\n2\n255\n" + PIXELS.tobytes(),
        b"P5 3 2 65535\n" + (PIXELS.astype(">u2") * 257).astype(">u2").tobytes(),
    ],
)
def test_every_kind_of_pgm_gives_the_same_map(tmp_path: Path, image: bytes) -> None:
    grid = read_ros_map(write_map(tmp_path, YAML, image))
    assert grid.cells.tolist() == [[U, X, F], [X, F, U]]


def test_small_largest_value_is_scaled(tmp_path: Path) -> None:
    grid = read_ros_map(write_map(tmp_path, YAML, b"P5 3 1 1\n" + bytes([0, 1, 1])))
    assert grid.cells.tolist() == [[X, F, F]]


def test_yaml_may_have_comments_quotes_and_foreign_keys(tmp_path: Path) -> None:
    text = "---\n# made by hand\n" + YAML.replace("room.pgm", '"room.pgm"  # the image') + "\nnote: 1\n"
    assert read_ros_map(write_map(tmp_path, text)).cells.shape == (2, 3)


def test_image_name_may_hold_a_hash_and_be_absolute(tmp_path: Path) -> None:
    other = tmp_path / "maps"
    other.mkdir()
    write_map(tmp_path)
    (tmp_path / "room.pgm").rename(other / "a#1.pgm")
    path = write_map(tmp_path, YAML.replace("room.pgm", str(other / "a#1.pgm")))
    (tmp_path / "room.pgm").unlink()
    assert read_ros_map(path).cells.shape == (2, 3)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("resolution: 0.05\n", "", "'resolution' is missing"),
        ("image: room.pgm\n", "", "'image' is missing"),
        ("0.05", "-0.05", "'resolution' is -0.05"),
        ("0.05", "five", "'resolution' is 'five'"),
        ("0.05", "nan", "'resolution' is 'nan'"),
        ("[-1.0, 2.0, 0.0]", "[-1.0, 2.0]", "[x, y, yaw]"),
        ("[-1.0, 2.0, 0.0]", "-1.0", "[x, y, yaw]"),
        ("[-1.0, 2.0, 0.0]", "[-1.0, 2.0, __import__('os')]", "a number"),
        ("negate: 0", "negate: maybe", "'negate' is 'maybe'"),
        ("negate: 0", "negate: 0\nmode: colour", "trinary, scale, raw"),
        ("0.196", "0.7", "0 <= free_thresh <= occupied_thresh <= 1"),
        ("negate: 0", "negate", "line 4 is not 'key: value'"),
        ("negate: 0", "negate: 0\nnegate: 1", "line 5 gives 'negate' a second time"),
        ("image: room.pgm", "image: hall.pgm", "hall.pgm: there is no such file"),
    ],
)
def test_damaged_yaml_names_the_fault(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in YAML
    with pytest.raises(FileError) as error:
        read_ros_map(write_map(tmp_path, YAML.replace(old, new)))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (b"\x89PNG\r\n\x1a\n" + bytes(40), "a PNG"),
        (b"\xff\xd8\xff\xe0" + bytes(40), "a JPEG"),
        (b"P6 1 1 255\n" + bytes(3), "type P6"),
        (b"P5 x 2 255\n", "damaged header"),
        (b"hello", "something else"),
        (b"P5 3 2 255\n" + bytes(5), "5 of 6 pixels"),
        (b"P5 3 2 65535\n" + bytes(11), "5 of 6 pixels"),
        (b"P2 3 2 255\n1 2 3", "3 of 6 pixels"),
        (b"P2 2 1 255\n1 two", "not a number"),
        (b"P2 2 1 255\n1 300", "above its largest value 255"),
        (b"P5 0 2 255\n", "0 x 2 pixels"),
        (b"P5 99999 99999 255\n", "99999 x 99999 pixels"),
        (b"P5 3 2 70000\n" + bytes(12), "70000"),
    ],
)
def test_damaged_image_is_named(tmp_path: Path, image: bytes, words: str) -> None:
    with pytest.raises(FileError) as error:
        read_ros_map(write_map(tmp_path, YAML, image))
    assert words in str(error.value)
    assert "room.pgm" in str(error.value)


def test_empty_image_is_named(tmp_path: Path) -> None:
    path = write_map(tmp_path)
    (tmp_path / "room.pgm").write_bytes(b"")
    with pytest.raises(FileError, match="empty"):
        read_ros_map(path)


def test_missing_folder_and_image_in_place_of_yaml(tmp_path: Path) -> None:
    write_map(tmp_path)
    with pytest.raises(FileError, match="no such file"):
        read_ros_map(tmp_path / "nowhere.yaml")
    with pytest.raises(FileError, match="not a file"):
        read_ros_map(tmp_path)
    with pytest.raises(FileError, match="not text"):
        read_ros_map(tmp_path / "room.pgm")


def test_large_files_are_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pgm, "MAX_PGM_BYTES", 10)
    with pytest.raises(FileError, match="more than the limit of 10"):
        read_ros_map(write_map(tmp_path))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(yaml=st.binary(max_size=200), image=st.binary(max_size=60), damaged=st.booleans())
def test_any_bytes_give_a_map_or_a_file_error(
    tmp_path: Path, yaml: bytes, image: bytes, damaged: bool
) -> None:
    path = write_map(tmp_path, YAML, b"P5 2 2 255\n" + image if damaged else image or b"P")
    if not damaged:
        path.write_bytes(yaml)
    try:
        assert read_ros_map(path).cells.shape == (2, 2)
    except FileError as error:
        assert "\n" not in str(error)


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
@pytest.mark.parametrize(
    ("name", "shape", "bounds"),
    [
        ("tum_kitchen/tum_kitchen.yaml", (238, 148), (-2.55, -6.25, 4.85, 5.65)),
        ("bham_lab/cs_lg.yaml", (993, 562), (-18.35, -31.5, 9.75, 18.15)),
    ],
)
def test_real_maps(name: str, shape: tuple[int, int], bounds: tuple[float, ...]) -> None:
    grid = read_ros_map(data_root() / name)
    assert grid.cells.shape == shape
    assert np.allclose(grid.bounds, bounds)
    assert all((grid.cells == state).any() for state in Cell)


@pytest.mark.skipif(not data_root().is_dir(), reason="the folder of real maps is absent")
def test_the_robot_of_the_kitchen_starts_on_a_free_cell() -> None:
    grid = read_ros_map(data_root() / "tum_kitchen/tum_kitchen.yaml")
    row, column = grid.cells_of((0.0, 0.0))
    assert grid.cells[row, column] == Cell.FREE
