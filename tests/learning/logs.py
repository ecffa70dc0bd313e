"""Logs made for tests: desks with a keyboard and things about it, whose truth is known."""

import numpy as np

from qsrlang.learning.observations import NUMBERS, TEXTS, Observations

EMPTY = dict.fromkeys(NUMBERS, 0.0) | dict.fromkeys(TEXTS, "") | {"confidence": 1.0}
SIZES = {
    "Desk": (0.8, 1.6, 0.0),
    "Keyboard": (0.16, 0.45, 0.04),
    "Mouse": (0.12, 0.07, 0.04),
    "Mug": (0.1, 0.1, 0.1),
}


def row(kind, x, y, *, place="room", scene="s", time=0.0, yaw=np.pi, support="Desk", confidence=1.0):
    length, width, height = SIZES.get(kind, (0.1, 0.1, 0.1))
    support = "" if kind == "Desk" else support
    return EMPTY | {
        "place": place, "scene": scene, "object": kind, "kind": kind, "support": support, "source": "log",
        "time": time, "x": x, "y": y, "yaw": yaw, "length": length, "width": width, "height": height,
        "confidence": confidence,
    }  # fmt: skip


def desks(count, scans, rng, left=0.0):
    """Desks of which each has its mouse 0.3 m right of the keyboard (left, for a share), and a mug anywhere."""
    rows = []
    for number in range(count):
        side = 1.0 if rng.random() < left else -1.0
        for scan in range(scans):
            at = {"place": f"room-{number}", "scene": f"{number}-{scan}", "time": 3600.0 * (9 + scan)}
            x, y = 0.3 + rng.normal(0.0, 0.02), rng.normal(0.0, 0.05)
            rows.append(row("Desk", 0.4, 0.0, **at))
            rows.append(row("Keyboard", x, y, **at))
            mouse = (x + rng.normal(0.0, 0.03), y + side * 0.3 + rng.normal(0.0, 0.03))
            rows.append(row("Mouse", *mouse, **at))
            rows.append(row("Mug", rng.uniform(0.05, 0.75), rng.uniform(-0.75, 0.75), **at))
    return Observations.of(rows)
