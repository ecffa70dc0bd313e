import math
from pathlib import Path

import numpy as np
import pytest

from qsrlang.errors import FileError, UnknownNameError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.simulation.roomfiles import load_room, read_room
from qsrlang.simulation.rooms import Part, Room, Shape, Thing

SMALL = """
name = "small"
start = [1.0, 1.0]
[colours]
wall = "#ffffff"
floor = "#808080"
[[floor]]
from = [0.0, 0.0]
to = [3.0, 2.0]
[[wall]]
from = [0.0, 0.0]
to = [3.0, 0.0]
[kind.Desk]
parts = [{ box = [0.8, 1.5, 0.75], colour = "wall" }]
[kind.Monitor]
recognised = true
parts = [{ box = [0.2, 0.55, 0.4], colour = "floor" }]
[[thing]]
name = "desk-1"
kind = "Desk"
at = [2.0, 1.0]
facing_deg = 90.0
[[thing]]
name = "monitor-1"
kind = "Monitor"
on = "desk-1"
at = [-0.2, 0.1]
facing_deg = -30.0
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "room.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_room_is_read(tmp_path):
    room = read_room(written(tmp_path, SMALL))
    assert room.name == "small" and room.bounds == (0.0, 0.0, 3.0, 2.0)
    assert [thing.kind for thing in room.things] == ["Structure", "Structure", "Desk", "Monitor"]
    wall = room.named("wall-1")
    assert wall.size == pytest.approx([3.1, 0.1, 2.3])


def test_a_thing_on_another_is_placed_in_its_frame(tmp_path):
    monitor = read_room(written(tmp_path, SMALL)).named("monitor-1")
    assert (monitor.pose.x, monitor.pose.y) == pytest.approx((2.0 - 0.1, 1.0 - 0.2))
    assert monitor.pose.yaw == pytest.approx(math.radians(60.0))
    assert monitor.z == pytest.approx(0.75) and monitor.top == pytest.approx(1.15)


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("box = [0.8, 1.5, 0.75]", "sphere = [0.8]", "unknown field 'kind.Desk.parts.0.sphere'"),
        ("box = [0.8, 1.5, 0.75], ", "", "either a box or a cylinder"),
        ("box = [0.8,", "cylinder = [0.1, 0.1], box = [0.8,", "either a box or a cylinder"),
        ("box = [0.8,", "box = [-0.8,", "kind.Desk.parts.0.box.0"),
        ("recognised = true", "recognized = true", "unknown field 'kind.Monitor.recognized'"),
        ('kind = "Monitor"', 'kind = "Screen"', "unknown kind 'Screen'; known: Desk, Monitor"),
        ('colour = "floor" }', 'colour = "pink" }', "unknown colour 'pink'; known: floor, wall"),
        ('on = "desk-1"', 'on = "desk-7"', "'desk-7', which is not described above it"),
        ('name = "monitor-1"', 'name = "desk-1"', "two things are named 'desk-1'"),
        ("to = [3.0, 0.0]", "to = [3.0, 1.0]", "a wall runs along x or along y"),
        ('"#ffffff"', '"white"', "colours.wall"),
        ("start = [1.0, 1.0]", "", "start: Field required"),
        ("at = [2.0, 1.0]", "at = [2.0, nan]", "thing.0.at.1"),
        ("[kind.Desk]", "[kind.Desk", "not TOML"),
    ],
)
def test_what_is_not_understood_is_an_error_in_one_line(tmp_path, old, new, complaint):
    assert old in SMALL
    path = written(tmp_path, SMALL.replace(old, new, 1))
    with pytest.raises(FileError) as caught:
        read_room(path)
    message = str(caught.value)
    assert complaint in message and message.startswith(str(path)) and "\n" not in message


def test_too_many_parts_are_an_error(tmp_path):
    part = '{ box = [0.8, 1.5, 0.75], colour = "wall" }'
    with pytest.raises(FileError, match=r"kind\.Desk\.parts"):
        read_room(written(tmp_path, SMALL.replace(part, ", ".join([part] * 17))))
    with pytest.raises(ValueRangeError, match="1 to 16"):
        Thing("pile", "Pile", Pose2(0, 0), 0.0, (Part(Shape.BOX, (1, 1, 1), (0, 0, 0), (1, 1, 1)),) * 17)


def test_files_that_are_no_rooms(tmp_path):
    with pytest.raises(FileError, match="No such file"):
        load_room(str(tmp_path / "absent.toml"))
    (tmp_path / "image.toml").write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(FileError, match="not a text file"):
        read_room(tmp_path / "image.toml")
    with pytest.raises(FileError, match="Is a directory"):
        read_room(tmp_path)
    with pytest.raises(FileError, match="use kitchen"):
        load_room("ballroom")


def test_the_kitchen_is_furnished(kitchen):
    assert kitchen.bounds == (0.0, 0.0, 8.0, 12.0)
    counts = {kind: len(kitchen.of_kind(kind)) for kind in ("Desk", "Monitor", "Keyboard", "Chair", "Bottle")}
    assert counts == {"Desk": 3, "Monitor": 3, "Keyboard": 3, "Chair": 4, "Bottle": 2}
    for kind in ("Sink", "Stove", "Fridge", "DiningTable", "Laptop", "Printer", "Shelf"):
        assert kitchen.of_kind(kind), kind
    assert not kitchen.of_kind("Cup")
    with pytest.raises(UnknownNameError, match="did you mean 'desk-1'"):
        kitchen.named("desk_1")


def test_furniture_of_the_kitchen_has_everyday_sizes(kitchen):
    for monitor in kitchen.of_kind("Monitor"):
        assert monitor.size == pytest.approx([0.20, 0.55, 0.40], abs=0.031)
        assert monitor.z == pytest.approx(0.75)
    for desk in kitchen.of_kind("Desk"):
        assert desk.size == pytest.approx([0.80, 1.50, 0.75])
    assert kitchen.named("worktop-1").top == pytest.approx(0.90)
    doorway = kitchen.named("wall-6").pose.x - kitchen.named("wall-5").pose.x
    gap = doorway - 0.5 * (kitchen.named("wall-5").size[0] + kitchen.named("wall-6").size[0])
    assert gap >= 1.5


def test_things_of_the_kitchen_stay_inside_it_and_apart(kitchen):
    x0, y0, x1, y1 = kitchen.bounds
    standing = [thing for thing in kitchen.things if thing.kind not in ("Structure", "Rug")]
    boxes = []
    for thing in standing:
        corners = np.array([[x, y] for x in thing.box[:, 0] for y in thing.box[:, 1]])
        corners = thing.pose.transform(corners)
        boxes.append((corners.min(axis=0), corners.max(axis=0), thing.z, thing.top))
        assert (corners.min(axis=0) >= [x0 - 1e-9, y0 - 1e-9]).all(), thing.name
        assert (corners.max(axis=0) <= [x1 + 1e-9, y1 + 1e-9]).all(), thing.name
    screens = [i for i, thing in enumerate(standing) if thing.recognised]
    for i in screens:
        for j in screens:
            if i < j:
                overlap = np.minimum(boxes[i][1], boxes[j][1]) - np.maximum(boxes[i][0], boxes[j][0])
                height = min(boxes[i][3], boxes[j][3]) - max(boxes[i][2], boxes[j][2])
                assert min(*overlap, height) <= 0.0, (standing[i].name, standing[j].name)


def test_the_static_part_leaves_out_what_moves(kitchen: Room):
    names = {thing.name for thing in kitchen.static_part.things}
    assert "bottle-1" not in names and {"desk-1", "monitor-1", "floor-1"} <= names
