import numpy as np

from qsrlang.geometry.pose import Pose2
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.simulation.objects import Placement
from qsrlang.simulation.rooms import Part, Room, Shape, Thing

ROBOT = Robot(clearance=0.35, speed=0.5, turn_rate=1.0, dwell=3.0)
CAMERA = Camera(near=0.3, far=4.0, horizontal_fov=1.1, vertical_fov=0.85, height=1.4, tilt=-0.3)
CUPS = (
    Placement("cup-1", "Cup", 1.1, 11.4),
    Placement("cup-2", "Cup", 0.4, 1.2),
    Placement("cup-3", "Cup", 5.2, 2.5),
)


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> Part:
    return Part(Shape.BOX, size, at, (0.8, 0.6, 0.4))


def table_room(start: Pose2 | None = None) -> Room:
    """A floor of 4 x 4 m and one table, 0.8 x 1.5 m and 0.75 m high, at (2, 2)."""
    floor = Thing("floor", "Structure", Pose2(2, 2), -0.1, (box((4, 4, 0.1), (0, 0, 0)),))
    top, leg = box((0.8, 1.5, 0.04), (0, 0, 0.71)), box((0.1, 0.1, 0.71), (0, 0, 0))
    table = Thing("table-1", "Table", Pose2(2, 2), 0.0, (top, leg))
    return Room("table-room", (0.0, 0.0, 4.0, 4.0), start or Pose2(0.5, 0.5, np.pi / 4), (floor, table))
