"""KTH-3D-TOTAL (Thippur et al. 2014): office desks annotated by people, as a table of desks or as raw XML.

The frame of a desk has x to the sitting person's right and y away from them; ours has x away and y to the left.
An annotated yaw of 0 is a thing whose front faces the person, so its heading in our frame is yaw + pi.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from qsrlang.errors import FileError
from qsrlang.learning.formats.tables import Rows, csv_rows, or_unsound
from qsrlang.learning.observations import Row

COLUMNS = frozenset(
    {"desk", "scene", "date", "part", "desk_length", "desk_width", "object", "class", "x", "y", "yaw"}
)
MAX_BYTES = 50_000_000
DESK = "Desk"
_HOURS = {"Mor": 9, "Aft": 14, "Eve": 19}
_INSTANCE = re.compile(r"_\d+$")


def read_kth_table(path: Path) -> Rows:
    """Yield the objects of every scan, and the desk itself as one more, its centre in the middle."""
    scene = None
    for where, row in csv_rows(path):
        if row["scene"] != scene:
            scene = row["scene"]
            yield where, or_unsound(_desk, row)
        yield where, or_unsound(_object, row)


def read_kth_xml(path: Path) -> Rows:
    """Yield the objects of one annotated desk, and the desk; raises FileError where it is no such annotation."""
    scenario = _parsed(path)
    size = {f"desk_{name}": scenario.findtext(f"dimensions/{name}") for name in ("length", "width")}
    shared: dict[str, Any] = {
        "desk": path.stem,
        "scene": path.stem,
        "date": "",
        "part": "",
        "source": path.name,
    } | size
    yield path.name, or_unsound(_desk, shared)
    for number, one in enumerate(scenario.iterfind("allObjects/object"), 1):
        name = one.findtext("name") or ""
        row: dict[str, Any] = {"object": name, "class": _INSTANCE.sub("", name)}
        row |= {axis: one.findtext(f"pose/{axis}") for axis in ("x", "y", "z", "yaw")}
        row |= {side: one.findtext(f"dimensions/{side}") for side in ("length", "width", "height")}
        yield f"{path.name}, object {number}", or_unsound(_object, shared | row)


def _parsed(path: Path) -> ElementTree.Element:
    if path.stat().st_size > MAX_BYTES:
        raise FileError(path, f"is larger than {MAX_BYTES} bytes", "name one desk's annotation")
    text = path.read_bytes()
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise FileError(path, "defines entities, which no annotation needs", "export it anew")
    try:
        scenario = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise FileError(path, f"is no XML ({error})", "export it anew") from None
    if scenario.tag != "scenario":
        raise FileError(
            path, f"holds <{scenario.tag}>", "name a KTH-3D-TOTAL annotation, which holds <scenario>"
        )
    return scenario


def _object(row: Row) -> Row:
    """Return an object in our frame: x is the annotation's y, y is minus its x."""
    return _shared(row) | {
        "object": row["object"],
        "kind": row["class"],
        "x": float(row["y"]),
        "y": -float(row["x"]),
        "z": float(row["z"] or 0.0),
        "yaw": float(row["yaw"]) + math.pi,
        "length": float(row["width"]),
        "width": float(row["length"]),
        "height": float(row["height"]),
        "support": DESK,
    }


def _desk(row: Row) -> Row:
    length, width = float(row["desk_length"]), float(row["desk_width"])
    pose = {"x": 0.5 * width, "y": -0.5 * length, "z": 0.0, "yaw": math.pi}
    return (
        _shared(row) | pose | {"object": DESK, "kind": DESK, "length": width, "width": length, "support": ""}
    )


def _shared(row: Row) -> dict[str, Any]:
    source = row.get("source") or "KTH-3D-TOTAL"
    return {"time": _time(row), "place": row["desk"], "scene": row["scene"], "source": source}


def _time(row: Row) -> str | float:
    """Return the middle of the part of the day in which a scan was made."""
    if not row["date"]:
        return 0.0
    day = datetime.strptime(str(row["date"]), "%y%m%d")
    return (
        day.replace(hour=_HOURS[str(row["part"])]).isoformat() if row["part"] in _HOURS else day.isoformat()
    )


def is_kth_table(header: Iterable[str]) -> bool:
    """Return whether these are the columns of the table of desks."""
    return set(header) >= COLUMNS
