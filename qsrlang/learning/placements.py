"""From scenes to placements: every object as seen from the first instance of every other class in its scene.

Two objects on different supports tell nothing of each other; an object is also seen from its own support.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.learning.observations import Observations

# Without a known support an object may lie this far from the relatum, either way [m].
REACH = 2.5
# People seldom turn a thing further from its support's own heading; a larger turn is taken for one without a front.
MAX_TURN = 1.2
# A support with a shorter side is one whose size is not known [m].
MIN_SIDE = 0.05
# In a row of geometry: where the referent lies (2), the least and greatest x and y of the support (4), both about the
# relatum, and how far the relatum is turned from its support.
GEOMETRY = 7
STAND = 9


@dataclass(frozen=True, slots=True, eq=False)
class Placements:
    """P placements: the rows of referent and relatum in the observations, and where the one lies from the other.

    `points` (P, 2) [m] are in the relatum's frame: x along the reference axis, away from its front, y to the left.
    `low`, `high` (P, 2) are the bounds of the support about the relatum in the support's own frame, whose x axis is
    `turns` (P,) [rad] clockwise of the reference axis.
    """

    referents: IntArray
    relata: IntArray
    points: FloatArray
    low: FloatArray
    high: FloatArray
    turns: FloatArray

    def __len__(self) -> int:
        return len(self.referents)


def placements_of(seen: Observations) -> Placements:
    """Return all placements of the scenes, whose rows stand together; those further away than REACH are left out."""
    bounds, supports, poses = scene_bounds(seen), support_rows(seen), poses_of(seen)
    room = _count(bounds)
    pairs, geometry = np.empty((room, 2), dtype=np.int64), np.empty((room, GEOMETRY))
    found = _place(bounds, seen.code("kind"), supports, poses, pairs, geometry)
    pairs, geometry = pairs[:found], geometry[:found]
    return Placements(
        pairs[:, 0], pairs[:, 1], geometry[:, :2], geometry[:, 2:4], geometry[:, 4:6], geometry[:, 6]
    )


def scene_bounds(seen: Observations) -> IntArray:
    """Return where each scene begins, and the end: (S + 1,)."""
    return np.flatnonzero(np.diff(seen.code("scene"), prepend=-1, append=-1))


def poses_of(seen: Observations) -> FloatArray:
    """Return x, y, yaw, length and width of each row: (N, 5)."""
    return np.column_stack([seen.number(name) for name in ("x", "y", "yaw", "length", "width")])


def support_rows(seen: Observations) -> IntArray:
    """Return for each row the row of its support in the same scene, -1 without one: (N,)."""
    if len(seen) == 0:
        return np.zeros(0, dtype=np.int64)
    size, scenes = len(seen.words), seen.code("scene")
    numbers = np.cumsum(np.diff(scenes, prepend=scenes[0]) != 0)
    own, wanted = numbers * size + seen.code("object"), numbers * size + seen.code("support")
    order = np.argsort(own, kind="stable")
    at = np.minimum(np.searchsorted(own[order], wanted), len(seen) - 1)
    rows = order[at]
    return np.where((own[rows] == wanted) & (wanted != own), rows, -1)


@njit(cache=True)
def _count(bounds):  # type: ignore[no-untyped-def]
    room = 0
    for scene in range(len(bounds) - 1):
        size = bounds[scene + 1] - bounds[scene]
        room += size * (size - 1)
    return room


@njit(cache=True)
def _wrapped(angle):  # type: ignore[no-untyped-def]
    return np.pi - (np.pi - angle) % (2.0 * np.pi)


@njit(cache=True)
def _axis(yaw, carrier):  # type: ignore[no-untyped-def]
    """Return the reference axis of a relatum, and how far it is turned from its carrier's axis [rad]."""
    if np.isnan(carrier):
        return (0.0 if np.isnan(yaw) else yaw + np.pi), 0.0
    turn = 0.0 if np.isnan(yaw) else _wrapped(yaw - carrier)
    if abs(turn) > MAX_TURN:
        turn = 0.0
    return carrier + np.pi + turn, turn


@njit(cache=True)
def take_stand(poses, relatum, carrier, stand):  # type: ignore[no-untyped-def]
    """Fill cosine and sine of the axis of a relatum, its turn, the bounds (4) of the carrier, the turn's two."""
    axis, turn = _axis(poses[relatum, 2], poses[carrier, 2] if carrier >= 0 else np.nan)
    stand[0], stand[1], stand[2] = np.cos(axis), np.sin(axis), turn
    stand[3], stand[4], stand[5], stand[6] = -REACH, -REACH, REACH, REACH
    stand[7], stand[8] = np.cos(turn), np.sin(turn)
    if carrier >= 0 and min(poses[carrier, 3], poses[carrier, 4]) >= MIN_SIDE:
        cos, sin = np.cos(axis - turn), np.sin(axis - turn)
        dx, dy = poses[carrier, 0] - poses[relatum, 0], poses[carrier, 1] - poses[relatum, 1]
        x, y = cos * dx + sin * dy, cos * dy - sin * dx
        stand[3], stand[5] = x - 0.5 * poses[carrier, 3], x + 0.5 * poses[carrier, 3]
        stand[4], stand[6] = y - 0.5 * poses[carrier, 4], y + 0.5 * poses[carrier, 4]


@njit(cache=True)
def is_second(kinds, start, row):  # type: ignore[no-untyped-def]
    """Return whether a row is not the first of its class in a scene that begins at `start`."""
    for other in range(start, row):  # noqa: SIM110 (a generator is slow here)
        if kinds[other] == kinds[row]:
            return True
    return False


@njit(cache=True)
def relates(kinds, supports, referent, relatum):  # type: ignore[no-untyped-def]
    """Return whether two rows of a scene are of different classes, and on one support or the one on the other."""
    carrier = supports[referent]
    return kinds[referent] != kinds[relatum] and (carrier == relatum or carrier == supports[relatum])


@njit(cache=True)
def _place(bounds, kinds, supports, poses, pairs, geometry):  # type: ignore[no-untyped-def]
    found = 0
    stand = np.empty(STAND)
    for scene in range(len(bounds) - 1):
        start, end = bounds[scene], bounds[scene + 1]
        for relatum in range(start, end):
            if is_second(kinds, start, relatum):
                continue
            for referent in range(start, end):
                if not relates(kinds, supports, referent, relatum):
                    continue
                dx, dy = poses[referent, 0] - poses[relatum, 0], poses[referent, 1] - poses[relatum, 1]
                if dx * dx + dy * dy > REACH * REACH:
                    continue
                take_stand(poses, relatum, supports[referent], stand)
                pairs[found, 0], pairs[found, 1] = referent, relatum
                geometry[found, 0] = stand[0] * dx + stand[1] * dy
                geometry[found, 1] = stand[0] * dy - stand[1] * dx
                geometry[found, 2:6], geometry[found, 6] = stand[3:7], stand[2]
                found += 1
    return found
