"""Reads two-dimensional maps as ROS map_server writes them: a `.yaml` beside a `.pgm` image."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray
from qsrlang.errors import FileError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.pgm import read_pgm
from qsrlang.maps.reading import read_bounded

_T = TypeVar("_T")

MAX_YAML_BYTES = 65_536
MODES = ("trinary", "scale", "raw")
_REQUIRED = ("image", "resolution", "origin", "occupied_thresh", "free_thresh")
_BLANK = re.compile(r"\s*(?:#.*)?|---\s*|\.\.\.\s*")
_FIELD = re.compile(
    r"(\w+)\s*:\s+(\"[^\"]*\"|'[^']*'|\[[^\]]*\]|[^\s#\"'\[](?:[^#]|(?<=\S)#)*)(?:\s+#.*)?\s*"
)
_TRUTH = {"0": False, "1": True, "false": False, "true": True}


@dataclass(frozen=True, slots=True)
class RosMapHeader:
    """What the `.yaml` of a map says: image, resolution [m], pose of its lower left corner, pixels."""

    image: Path
    resolution: float
    origin: Pose2
    occupied_threshold: float
    free_threshold: float
    negate: bool
    mode: str


def read_ros_map(yaml_path: Path | str) -> OccupancyGrid:
    """Return the occupancy grid of a ROS map (`.yaml` and the image it names); row 0 is the lowest y.

    With pixel value v in 0 to 255, p = (255 - v) / 255, or v / 255 where `negate` is set, is the probability
    that a cell is occupied (ROS map_server).
    Mode `trinary`: p above `occupied_thresh` is occupied, p below `free_thresh` is free, the rest is unknown.
    Mode `scale`: as trinary, but a value between the thresholds is a probability too, rescaled so that they
    are 0 and 1; the cell takes its more probable state, and an even chance counts as occupied.
    Mode `raw`: the pixel is the probability in per cent, judged the same way; above 100 is unknown.
    Raises FileError where the `.yaml` or the image is missing, damaged, of the wrong kind or too large.
    """
    path = Path(yaml_path)
    header = read_header(path)
    values = read_pgm(header.image)[::-1]
    if header.negate:
        values = 255.0 - values
    return OccupancyGrid(_states(values, header), header.resolution, header.origin, str(path))


def read_header(path: Path) -> RosMapHeader:
    """Return what the `.yaml` of a ROS map says; raises FileError naming the key that is wrong."""
    fields = _fields(path)
    missing = [key for key in _REQUIRED if key not in fields]
    if missing:
        raise FileError(path, f"the key '{missing[0]}' is missing", "add it, as in the file map_saver writes")
    x, y, yaw = _numbers(path, "origin", fields["origin"])
    free, occupied = (_number(path, key, fields[key]) for key in ("free_thresh", "occupied_thresh"))
    if not 0.0 <= free <= occupied <= 1.0:
        found = f"free_thresh is {free} and occupied_thresh {occupied}"
        raise FileError(path, found, "use 0 <= free_thresh <= occupied_thresh <= 1")
    return RosMapHeader(
        image=path.parent / _text(fields["image"]),
        resolution=_resolution(path, fields["resolution"]),
        origin=Pose2(x, y, yaw),
        occupied_threshold=occupied,
        free_threshold=free,
        negate=_choice(path, "negate", fields.get("negate", "0"), _TRUTH),
        mode=_choice(path, "mode", fields.get("mode", "trinary"), {mode: mode for mode in MODES}),
    )


def _states(values: FloatArray, header: RosMapHeader) -> npt.NDArray[np.uint8]:
    cells = np.full(values.shape, Cell.UNKNOWN, dtype=np.uint8)
    if header.mode == "raw":
        cells[values <= 100.0] = Cell.OCCUPIED
        cells[values < 50.0] = Cell.FREE
        return cells
    occupied = (255.0 - values) / 255.0
    if header.mode == "scale":
        even = 0.5 * (header.free_threshold + header.occupied_threshold)
        cells[...] = np.where(occupied < even, Cell.FREE, Cell.OCCUPIED)
    cells[occupied < header.free_threshold] = Cell.FREE
    cells[occupied > header.occupied_threshold] = Cell.OCCUPIED
    return cells


def _fields(path: Path) -> dict[str, str]:
    try:
        text = read_bounded(path, MAX_YAML_BYTES, "the .yaml of a ROS map").decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FileError(path, "this is not text", "name the .yaml of a ROS map, not its image") from None
    fields: dict[str, str] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if _BLANK.fullmatch(line):
            continue
        field = _FIELD.fullmatch(line)
        if field is None:
            raise FileError(path, f"line {number} is not 'key: value'", "write one key and its value a line")
        if field[1] in fields:
            raise FileError(path, f"line {number} gives '{field[1]}' a second time", "keep one of the two")
        fields[field[1]] = field[2].strip()
    return fields


def _text(value: str) -> str:
    if len(value) >= 2 and value[0] == value[-1] and value[0] in "'\"":
        return value[1:-1]
    return value


def _number(path: Path, key: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FileError(path, f"'{key}' is '{text}'", "write a number")
    return value


def _numbers(path: Path, key: str, text: str) -> tuple[float, float, float]:
    parts = text[1:-1].split(",") if text.startswith("[") and text.endswith("]") else []
    if len(parts) != 3:
        raise FileError(path, f"'{key}' is '{text}'", "write [x, y, yaw] in metres and radians")
    x, y, yaw = (_number(path, key, part.strip()) for part in parts)
    return x, y, yaw


def _resolution(path: Path, text: str) -> float:
    value = _number(path, "resolution", text)
    if value <= 0.0:
        raise FileError(path, f"'resolution' is {value}", "write a positive number of metres")
    return value


def _choice(path: Path, key: str, text: str, values: Mapping[str, _T]) -> _T:
    name = _text(text).lower()
    if name not in values:
        raise FileError(path, f"'{key}' is '{text}'", f"write one of {', '.join(values)}")
    return values[name]
