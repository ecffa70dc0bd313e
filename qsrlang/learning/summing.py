"""The inner loop of learning online: every placement of every scene, added to the sums of its cell as it is found."""

from __future__ import annotations

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.learning.observations import Observations
from qsrlang.learning.placements import (
    REACH,
    STAND,
    is_second,
    poses_of,
    relates,
    scene_bounds,
    support_rows,
    take_stand,
)

# The side of a cell [m]; within one, placements are told apart by their moments alone.
CELL = 0.15
HOURS = 24
MOMENTS = ("x", "y", "xx", "xy", "yy", "low x", "low y", "high x", "high y", "cos", "sin")
_SHIFT = 128
_START = 1 << 12


def summed_scenes(
    seen: Observations, kinds: IntArray, places: IntArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return distinct keys (K, 5), their moments (K, 11) and counts by the hour (K, 24); names are below 4096.

    `kinds` and `places` (N,) number the classes and places of the rows.
    """
    bounds, supports, poses = scene_bounds(seen), support_rows(seen), poses_of(seen)
    shares, hours = seen.number("confidence"), seen.hours.astype(np.int64)
    packed, moments, counts = _sum(bounds, kinds, places, supports, poses, hours, shares)
    keys = np.empty((len(packed), 5), dtype=np.int64)
    keys[:, 4], keys[:, 3] = packed % 256 - _SHIFT, packed // 256 % 256 - _SHIFT
    keys[:, 2], keys[:, 1], keys[:, 0] = packed >> 16 & 4095, packed >> 28 & 4095, packed >> 40
    return keys, moments, counts


@njit(cache=True)
def add_rows(which, rows, sums):  # type: ignore[no-untyped-def]
    """Add each row (N, C) to the sums (K, C) that it belongs to."""
    for n in range(len(which)):
        for column in range(rows.shape[1]):
            sums[which[n], column] += rows[n, column]


@njit(cache=True)
def _slot(key, table, slots):  # type: ignore[no-untyped-def]
    """Return where a key stands, or should, in an open hash table whose size is a power of 2."""
    mask = len(table) - 1
    at = (key * 0x9E3779B97F4A7C1 >> 20) & mask
    while slots[at] >= 0 and table[at] != key:
        at = (at + 1) & mask
    return at


@njit(cache=True)
def _grown(table, slots):  # type: ignore[no-untyped-def]
    larger = np.empty(2 * len(table), dtype=np.int64)
    places = np.full(2 * len(table), -1, dtype=np.int64)
    for at in range(len(table)):
        if slots[at] >= 0:
            to = _slot(table[at], larger, places)
            larger[to], places[to] = table[at], slots[at]
    return larger, places


@njit(cache=True)
def _sum(bounds, kinds, places, supports, poses, hours, shares):  # type: ignore[no-untyped-def]
    table, slots = np.empty(_START, dtype=np.int64), np.full(_START, -1, dtype=np.int64)
    keys = np.empty(_START, dtype=np.int64)
    moments, counts = np.zeros((_START, 11)), np.zeros((_START, HOURS))
    stand = np.empty(STAND)
    found = 0
    for scene in range(len(bounds) - 1):
        start, end = bounds[scene], bounds[scene + 1]
        for relatum in range(start, end):
            if is_second(kinds, start, relatum):
                continue
            carrier = -2
            for referent in range(start, end):
                if not relates(kinds, supports, referent, relatum):
                    continue
                dx, dy = poses[referent, 0] - poses[relatum, 0], poses[referent, 1] - poses[relatum, 1]
                if dx * dx + dy * dy > REACH * REACH:
                    continue
                if supports[referent] != carrier:
                    carrier = supports[referent]
                    take_stand(poses, relatum, carrier, stand)
                x, y = stand[0] * dx + stand[1] * dy, stand[0] * dy - stand[1] * dx
                column, row = int(np.floor(x / CELL + 0.5)), int(np.floor(y / CELL + 0.5))
                key = ((kinds[referent] << 12 | kinds[relatum]) << 12 | places[referent]) << 16
                key |= (column + _SHIFT) << 8 | (row + _SHIFT)
                at = _slot(key, table, slots)
                if slots[at] < 0:
                    if 2 * (found + 1) > len(table):
                        table, slots = _grown(table, slots)
                        at = _slot(key, table, slots)
                        keys, moments, counts = _longer(keys, moments, counts)
                    table[at], slots[at], keys[found] = key, found, key
                    found += 1
                x, y = x - CELL * column, y - CELL * row
                _add(moments[slots[at]], x, y, stand, shares[referent])
                counts[slots[at], hours[referent]] += shares[referent]
    return keys[:found].copy(), moments[:found].copy(), counts[:found].copy()


@njit(cache=True)
def _longer(keys, moments, counts):  # type: ignore[no-untyped-def]
    size = len(keys)
    more = np.empty(2 * size, dtype=np.int64), np.zeros((2 * size, 11)), np.zeros((2 * size, HOURS))
    more[0][:size], more[1][:size], more[2][:size] = keys, moments, counts
    return more


@njit(cache=True)
def _add(sums, x, y, stand, share):  # type: ignore[no-untyped-def]
    sums[0] += share * x
    sums[1] += share * y
    sums[2] += share * x * x
    sums[3] += share * x * y
    sums[4] += share * y * y
    for side in range(4):
        sums[5 + side] += share * stand[3 + side]
    sums[9] += share * stand[7]
    sums[10] += share * stand[8]
