from collections.abc import Iterator

import pytest
from simulation_scenes import CAMERA, CUPS, ROBOT, table_room

from qsrlang.simulation.objects import Placement
from qsrlang.simulation.roomfiles import load_room
from qsrlang.simulation.rooms import Room
from qsrlang.simulation.world import PybulletWorld


@pytest.fixture(scope="session")
def kitchen() -> Room:
    return load_room("kitchen")


@pytest.fixture(scope="module")
def kitchen_world(kitchen: Room) -> Iterator[PybulletWorld]:
    with PybulletWorld.from_room(kitchen, CUPS, ROBOT, CAMERA) as world:
        yield world


@pytest.fixture
def table_world() -> Iterator[PybulletWorld]:
    with PybulletWorld.from_room(table_room(), [Placement("cup-1", "Cup", 2.0, 2.0)], ROBOT, CAMERA) as world:
        yield world
