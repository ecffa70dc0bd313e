import pytest

ROOM = """
name = "cell"
start = [1.0, 1.0]
[colours]
wall = "#e9e4d8"
oak = "#c69c6d"
[[floor]]
from = [0.0, 0.0]
to = [4.0, 3.0]
colour = "oak"
[[wall]]
from = [-0.05, -0.05]
to = [4.05, -0.05]
[[wall]]
from = [-0.05, 3.05]
to = [4.05, 3.05]
[[wall]]
from = [-0.05, 0.05]
to = [-0.05, 2.95]
[[wall]]
from = [4.05, 0.05]
to = [4.05, 2.95]
[kind.Table]
parts = [{ box = [0.6, 1.2, 0.7], colour = "oak" }]
[[thing]]
name = "table-1"
kind = "Table"
at = [3.6, 1.8]
"""

KNOWLEDGE = """language 1.
static Table.
dynamic Cup, Plate, Spoon.
landmark table-1 : Table at (3.6 m, 1.8 m) facing 180 deg.
observe 1 × in-front-of(Cup, Table) ~ normal((0 cm, 0 cm), (20 cm, 40 cm), 0).
believe left-of(Spoon, Plate).
"""

SCENARIO = """
title = "A table in a small room"
target = "Cup"
knowledge = "cups.qsr"
robot = "slow.toml"
camera = "wide"
preset = "kunze2014"
[map]
room = "room.toml"
[start]
x = 1.0
y = 1.0
[[placements]]
name = "cup-1"
kind = "Cup"
x = 3.5
y = 2.1
size = [0.09, 0.09, 0.10]
[[placements]]
name = "cup-2"
kind = "Cup"
x = 3.5
y = 1.4
size = [0.09, 0.09, 0.10]
[variants]
both = ["cup-1", "cup-2"]
one = ["cup-2"]
[arms.random]
planner = "random"
[arms.planes]
planner = "planes"
[arms.qsr]
planner = "qsr"
"""

ROBOT = """
title = "A small slow robot"
clearance = 0.35
speed = 0.3
turn_rate = 0.7
dwell = 2.0
footprint = 0.35
band = [0.1, 1.8]
"""


def written(folder):
    for name, text in (("room", ROOM), ("cell", SCENARIO), ("slow", ROBOT)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    (folder / "cups.qsr").write_text(KNOWLEDGE, encoding="utf-8")
    return folder / "cell.toml"


@pytest.fixture
def cell(tmp_path):
    """The path of a scenario in a room of its own, all of whose files may be changed."""
    return written(tmp_path)


@pytest.fixture(scope="session")
def unchanged_cell(tmp_path_factory):
    """The path of the same scenario, which nobody changes."""
    return written(tmp_path_factory.mktemp("unchanged"))


@pytest.fixture
def change():
    """A function that replaces text in a file and insists that it was there."""

    def replace(path, old, new):
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    return replace
