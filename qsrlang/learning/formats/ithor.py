"""iTHOR and RoboTHOR layouts (Kolve et al. 2017): rooms designed by people, in Unity's left-handed frame.

Unity has x to the right, y up and z to the front, yaw clockwise about y. With x = z and y = -x the plane is
right-handed, and the heading of an object's +z is minus its yaw.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from qsrlang.learning.formats.tables import Rows, csv_rows, or_unsound
from qsrlang.learning.observations import NOWHERE, Row

COLUMNS = frozenset(
    {"group", "scene", "object_type", "object_id", "yaw_deg", "aabb_cx", "parent_receptacles"}
)
# Of these, +z faces the room in 78 to 100 of 100 rooms; of the others no front is known.
FRONTED = frozenset({"Television", "Sink", "Fridge", "Microwave", "Desk", "Laptop"})
_RIGHT_ANGLE = 90.0


def is_ithor_table(header: Iterable[str]) -> bool:
    """Return whether these are the columns of the table of layouts."""
    return set(header) >= COLUMNS


def read_ithor_table(path: Path) -> Rows:
    """Yield the objects of every room; `support` is the narrowest receptacle: the last that is not the floor."""
    for where, row in csv_rows(path):
        yield where, or_unsound(_object, row)


def _object(row: Row) -> Row:
    yaw = float(row["yaw_deg"])
    sizes = {name: float(row[f"aabb_{name}"]) for name in ("cx", "cy", "cz", "sx", "sy", "sz")}
    length, width = _box(yaw, sizes["sz"], sizes["sx"])
    return {
        "time": 0.0,
        "place": row["scene"],
        "scene": row["scene"],
        "object": row["object_id"],
        "kind": row["object_type"],
        "x": sizes["cz"],
        "y": -sizes["cx"],
        "z": sizes["cy"] - 0.5 * sizes["sy"],
        "yaw": -math.radians(yaw) if row["object_type"] in FRONTED else math.nan,
        "length": length,
        "width": width,
        "height": sizes["sy"],
        "support": _support(str(row["parent_receptacles"] or NOWHERE)),
        "source": row["group"],
    }


def _support(parents: str) -> str:
    names = parents.split(";")
    return next((name for name in reversed(names) if not name.startswith("Floor|")), names[0])


def _box(yaw: float, along_z: float, along_x: float) -> tuple[float, float]:
    """Return length and width in the object's own frame, of a box along the room's axes; exact for right angles."""
    turned = round(yaw / _RIGHT_ANGLE) % 2 == 1
    return (along_x, along_z) if turned else (along_z, along_x)
