"""Reads paths out of the parents of cells and pulls them straight. Places (x, y) are in cells."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.maps.sight import clear_line
from qsrlang.maps.spreading import ParentArray


def trace_path(
    open_cells: BoolArray, parents: ParentArray, start: FloatArray, goal: FloatArray
) -> FloatArray:
    """Return the corners (K, 2) of the path from `start` (2,) to `goal` (2,), both inside cells with parents.

    They are the chain of parents from the goal's cell between the exact ends, shortened to the shortest way
    along clear lines between any two of them.
    """
    room = _room(parents)
    count = _trace(open_cells, parents, start, goal, *room)
    return room[0][:count].copy()


def trace_lengths(
    open_cells: BoolArray, parents: ParentArray, start: FloatArray, goals: FloatArray
) -> FloatArray:
    """Return the lengths (N,) of the paths from `start` (2,) to `goals` (N, 2)."""
    lengths = np.empty(len(goals))
    _lengths(open_cells, parents, start, goals, lengths, *_room(parents))
    return lengths


def trace_ways(
    open_cells: BoolArray, parents: ParentArray, start: FloatArray, goals: FloatArray
) -> FloatArray:
    """Return (4, N): length, first direction, sum of turns and last direction of the paths to `goals` (N, 2).

    A path of no length has no directions (nan).
    """
    ways = np.empty((4, len(goals)))
    _ways(open_cells, parents, start, goals, ways, *_room(parents))
    return ways


def _room(parents: ParentArray) -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
    size = int(np.count_nonzero(parents >= 0)) + 2
    return np.empty((size, 2)), np.empty((size, 2)), np.empty(size), np.empty(size, dtype=np.int64)


@njit(cache=True)
def _lengths(open_cells, parents, start, goals, lengths, path, chain, best, before):  # type: ignore[no-untyped-def]
    for n in range(len(goals)):
        count = _trace(open_cells, parents, start, goals[n], path, chain, best, before)
        lengths[n] = 0.0
        for k in range(1, count):
            lengths[n] += math.hypot(path[k, 0] - path[k - 1, 0], path[k, 1] - path[k - 1, 1])


@njit(cache=True)
def _ways(open_cells, parents, start, goals, ways, path, chain, best, before):  # type: ignore[no-untyped-def]
    for n in range(len(goals)):
        count = _trace(open_cells, parents, start, goals[n], path, chain, best, before)
        length = bends = 0.0
        first = last = math.nan
        for k in range(1, count):
            dx, dy = path[k, 0] - path[k - 1, 0], path[k, 1] - path[k - 1, 1]
            if dx == 0.0 and dy == 0.0:
                continue
            towards = math.atan2(dy, dx)
            if length == 0.0:
                first = towards
            else:
                bend = abs(towards - last)
                bends += min(bend, 2.0 * math.pi - bend)
            length += math.hypot(dx, dy)
            last = towards
        ways[0, n], ways[1, n], ways[2, n], ways[3, n] = length, first, bends, last


@njit(cache=True)
def _trace(open_cells, parents, start, goal, path, chain, best, before):  # type: ignore[no-untyped-def]
    width = open_cells.shape[1]
    cell = math.floor(goal[1]) * width + math.floor(goal[0])
    chain[0, 0], chain[0, 1] = goal[0], goal[1]
    count = 1
    while True:
        chain[count, 0], chain[count, 1] = cell % width + 0.5, cell // width + 0.5
        count += 1
        if parents[cell] == cell:
            break
        cell = np.int64(parents[cell])
    chain[count, 0], chain[count, 1] = start[0], start[1]
    return _pull(open_cells, chain, count + 1, path, best, before)


@njit(cache=True)
def _pull(open_cells, chain, count, path, best, before):  # type: ignore[no-untyped-def]
    best[0] = 0.0
    for end in range(1, count):
        best[end] = math.inf
        x, y = chain[end, 0], chain[end, 1]
        for begin in range(end):
            length = best[begin] + math.hypot(x - chain[begin, 0], y - chain[begin, 1])
            neighbours = begin == end - 1
            if length < best[end] and (
                neighbours or clear_line(open_cells, chain[begin, 0], chain[begin, 1], x, y)
            ):
                best[end], before[end] = length, begin
    at, size = count - 1, 0
    while True:
        path[size, 0], path[size, 1] = chain[at, 0], chain[at, 1]
        size += 1
        if at == 0:
            return size
        at = before[at]
