"""Reads the description of a room from a TOML file and checks every word of it."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from qsrlang.errors import FileError, QSRError
from qsrlang.geometry.pose import Pose2
from qsrlang.resources import resource_path, resource_root
from qsrlang.simulation.rooms import MAX_PARTS, Colour, Part, Room, Shape, Thing

MAX_ROOM_BYTES = 1_000_000
MAX_THINGS = 2_000
MAX_SIDE = 100.0
STRUCTURE = "Structure"
FLOOR_THICKNESS = 0.1

Length = Annotated[float, Field(gt=0.0, le=MAX_SIDE)]
Coordinate = Annotated[float, Field(ge=-MAX_SIDE, le=MAX_SIDE)]
Plane = tuple[Coordinate, Coordinate]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class _PartText(_Strict):
    """One of `box = [x, y, z]` and `cylinder = [diameter, height]`; `at` is the middle of its underside."""

    box: tuple[Length, Length, Length] | None = None
    cylinder: tuple[Length, Length] | None = None
    at: tuple[Coordinate, Coordinate, Coordinate] = (0.0, 0.0, 0.0)
    colour: str

    @model_validator(mode="after")
    def _one_shape(self) -> _PartText:
        if (self.box is None) == (self.cylinder is None):
            raise ValueError("a part is either a box or a cylinder")
        return self

    def part(self, colours: dict[str, Colour]) -> Part:
        colour = _named(self.colour, colours)
        if self.cylinder is not None:
            diameter, height = self.cylinder
            return Part(Shape.CYLINDER, (diameter, diameter, height), self.at, colour)
        assert self.box is not None
        return Part(Shape.BOX, self.box, self.at, colour)


class _KindText(_Strict):
    parts: Annotated[list[_PartText], Field(min_length=1, max_length=MAX_PARTS)]
    mass: Annotated[float, Field(ge=0.0, le=1_000.0)] = 0.0
    recognised: bool = False


class _ThingText(_Strict):
    """`at` and `facing_deg` are in the map frame, or, on its top, in that of the thing which `on` names."""

    name: Annotated[str, Field(min_length=1, max_length=80)]
    kind: str
    at: Plane
    z: Coordinate = 0.0
    facing_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    on: str | None = None


class _WallText(_Strict):
    """A wall along one axis, its middle line from `from` to `to`."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: Plane = Field(alias="from")
    end: Plane = Field(alias="to")
    thickness: Length = 0.1
    height: Length = 2.3
    z: Coordinate = 0.0
    colour: str = "wall"

    @model_validator(mode="after")
    def _along_an_axis(self) -> _WallText:
        if self.start[0] != self.end[0] and self.start[1] != self.end[1]:
            raise ValueError("a wall runs along x or along y")
        return self


class _FloorText(_Strict):
    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: Plane = Field(alias="from")
    end: Plane = Field(alias="to")
    colour: str = "floor"


class _RoomText(_Strict):
    name: str
    start: Plane
    start_facing_deg: float = 0.0
    colours: dict[str, Annotated[str, Field(pattern="^#[0-9a-f]{6}$")]]
    floor: Annotated[list[_FloorText], Field(min_length=1, max_length=50)]
    wall: Annotated[list[_WallText], Field(max_length=200)] = []
    kind: dict[str, _KindText]
    thing: Annotated[list[_ThingText], Field(max_length=MAX_THINGS)]


def load_room(name: str) -> Room:
    """Return a shipped room by its name, or the room of a file whose path ends in .toml; raises FileError."""
    if name.endswith(".toml"):
        return read_room(Path(name))
    folder = resource_root("knowledge") / "worlds" / "rooms"
    if not (folder / f"{name}.toml").is_file():
        known = ", ".join(sorted(path.stem for path in folder.glob("*.toml")))
        raise FileError(name, "no room of this name is shipped", f"use {known}, or a path that ends in .toml")
    return read_room(resource_path("knowledge", "worlds", "rooms", f"{name}.toml"))


def read_room(path: Path) -> Room:
    """Read a room from a TOML file; raises FileError, in one line, where anything in it is not understood."""
    try:
        if path.stat().st_size > MAX_ROOM_BYTES:
            raise FileError(path, f"larger than {MAX_ROOM_BYTES} bytes", "a room is a short text file")
        return _room(_RoomText.model_validate(tomllib.loads(path.read_text(encoding="utf-8"))))
    except OSError as error:
        raise FileError(path, error.strerror or "cannot be read", "check the path") from error
    except UnicodeDecodeError as error:
        raise FileError(path, "not a text file", "a room is TOML in UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise FileError(path, f"not TOML: {error}", "mend that line") from error
    except ValidationError as error:
        raise FileError(path, _first_problem(error), "mend that entry") from error
    except (ValueError, QSRError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(path, str(error), "mend that entry") from error


def _first_problem(error: ValidationError) -> str:
    first = error.errors(include_url=False)[0]
    where = ".".join(str(step) for step in first["loc"])
    if first["type"] == "extra_forbidden":
        return f"unknown field '{where}'"
    return f"{where}: {first['msg']}".replace("\n", " ")


def _room(text: _RoomText) -> Room:
    colours = {name: _colour(code) for name, code in text.colours.items()}
    built = {thing.name: thing for thing in (*_floors(text, colours), *_walls(text, colours))}
    for entry in text.thing:
        if entry.name in built:
            raise ValueError(f"two things are named '{entry.name}'")
        built[entry.name] = _thing(entry, text.kind, colours, built)
    corners = [corner for floor in text.floor for corner in (floor.start, floor.end)]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    start = Pose2(*text.start, math.radians(text.start_facing_deg))
    return Room(text.name, (min(xs), min(ys), max(xs), max(ys)), start, tuple(built.values()))


def _colour(code: str) -> Colour:
    red, green, blue = (int(code[first : first + 2], 16) / 255 for first in (1, 3, 5))
    return red, green, blue


def _thing(
    entry: _ThingText, kinds: dict[str, _KindText], colours: dict[str, Colour], built: dict[str, Thing]
) -> Thing:
    if entry.kind not in kinds:
        raise ValueError(
            f"thing '{entry.name}' is of the unknown kind '{entry.kind}'; known: {', '.join(sorted(kinds))}"
        )
    kind = kinds[entry.kind]
    pose, z = Pose2(*entry.at, math.radians(entry.facing_deg)), entry.z
    if entry.on is not None:
        if entry.on not in built:
            raise ValueError(f"thing '{entry.name}' stands on '{entry.on}', which is not described above it")
        pose, z = built[entry.on].pose @ pose, built[entry.on].top + z
    parts = tuple(part.part(colours) for part in kind.parts)
    return Thing(entry.name, entry.kind, pose, z, parts, kind.mass, kind.recognised)


def _named(name: str, colours: dict[str, Colour]) -> Colour:
    if name not in colours:
        raise ValueError(f"unknown colour '{name}'; known: {', '.join(sorted(colours))}")
    return colours[name]


def _floors(text: _RoomText, colours: dict[str, Colour]) -> list[Thing]:
    slabs = []
    for number, floor in enumerate(text.floor, 1):
        size = (abs(floor.end[0] - floor.start[0]), abs(floor.end[1] - floor.start[1]), FLOOR_THICKNESS)
        middle = _middle(floor.start, floor.end)
        slabs.append(_slab(f"floor-{number}", middle, -FLOOR_THICKNESS, size, _named(floor.colour, colours)))
    return slabs


def _walls(text: _RoomText, colours: dict[str, Colour]) -> list[Thing]:
    slabs = []
    for number, wall in enumerate(text.wall, 1):
        width, depth = (abs(b - a) + wall.thickness for a, b in zip(wall.start, wall.end, strict=True))
        middle, colour = _middle(wall.start, wall.end), _named(wall.colour, colours)
        slabs.append(_slab(f"wall-{number}", middle, wall.z, (width, depth, wall.height), colour))
    return slabs


def _middle(start: Plane, end: Plane) -> Pose2:
    return Pose2(0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))


def _slab(name: str, pose: Pose2, z: float, size: tuple[float, float, float], colour: Colour) -> Thing:
    return Thing(name, STRUCTURE, pose, z, (Part(Shape.BOX, size, (0.0, 0.0, 0.0), colour),))
