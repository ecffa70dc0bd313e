"""Compiled walks over navigable cells: lines of sight and any-angle distances. Lengths are in cells."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

MOVES = np.array([[-1, -1], [-1, 0], [-1, 1], [0, -1], [0, 1], [1, -1], [1, 0], [1, 1]])
STEPS = np.sqrt((MOVES**2).sum(axis=1))
_DIAGONAL = np.array([[0, 2], [5, 7]])
_TIE = 1e-9


@njit(cache=True)
def clear_line(open_cells, x0, y0, x1, y1):  # type: ignore[no-untyped-def]
    """Return whether a segment between points inside the grid (x along columns) touches open cells only.

    Where it passes exactly through a corner, both cells beside the corner must be open too.
    """
    column, row = math.floor(x0), math.floor(y0)
    left_x, left_y = math.floor(x1) - column, math.floor(y1) - row
    dx, dy = x1 - x0, y1 - y0
    sign_x, sign_y = 1 if left_x > 0 else -1, 1 if left_y > 0 else -1
    next_x = next_y = math.inf
    wait_x = wait_y = 0.0
    if left_x != 0:
        next_x, wait_x = ((column + 1 if left_x > 0 else column) - x0) / dx, 1.0 / abs(dx)
    if left_y != 0:
        next_y, wait_y = ((row + 1 if left_y > 0 else row) - y0) / dy, 1.0 / abs(dy)
    left_x, left_y = abs(left_x), abs(left_y)
    if not open_cells[row, column]:
        return False
    while left_x > 0 or left_y > 0:
        step_x, step_y = next_x <= next_y + _TIE, next_y <= next_x + _TIE
        if step_x and step_y and not (open_cells[row, column + sign_x] and open_cells[row + sign_y, column]):
            return False
        if step_x:
            column += sign_x
            left_x -= 1
            next_x = next_x + wait_x if left_x > 0 else math.inf
        if step_y:
            row += sign_y
            left_y -= 1
            next_y = next_y + wait_y if left_y > 0 else math.inf
        if not open_cells[row, column]:
            return False
    return True


@njit(cache=True)
def _rise(keys, cells, size, key, cell):  # type: ignore[no-untyped-def]
    at = size
    while at > 0:
        parent = (at - 1) >> 1
        if keys[parent] <= key:
            break
        keys[at], cells[at] = keys[parent], cells[parent]
        at = parent
    keys[at], cells[at] = key, cell


@njit(cache=True)
def _sink(keys, cells, size):  # type: ignore[no-untyped-def]
    key, cell = keys[size], cells[size]
    at = 0
    while 2 * at + 1 < size:
        child = 2 * at + 1
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[at], cells[at] = keys[child], cells[child]
        at = child
    keys[at], cells[at] = key, cell


@njit(cache=True)
def open_moves(open_cells):  # type: ignore[no-untyped-def]
    """Return for each flat cell (H W,) the bits of the MOVES that lead to open cells and cut no corner."""
    height, width = open_cells.shape
    moves = np.zeros(height * width, dtype=np.uint8)
    for row in range(height):
        for column in range(width):
            for bit in range(8):
                up, right = row + MOVES[bit, 0], column + MOVES[bit, 1]
                if (
                    0 <= up < height
                    and 0 <= right < width
                    and open_cells[row, column]
                    and open_cells[up, right]
                    and open_cells[up, column]
                    and open_cells[row, right]
                ):
                    moves[row * width + column] |= np.uint8(1 << bit)
    return moves


@njit(cache=True)
def _through_neighbour(moves, width, done, lengths, cell):  # type: ignore[no-untyped-def]
    best, parent = math.inf, -1
    for bit in range(8):
        if moves[cell] >> bit & 1:
            other = cell + MOVES[bit, 0] * width + MOVES[bit, 1]
            length = lengths[other] + STEPS[bit]
            if done[other] and length < best:
                best, parent = length, other
    return best, parent


@njit(cache=True)
def _bracketed(moves, width, done, parents, cell):  # type: ignore[no-untyped-def]
    # Two clear lines to neighbours less than a cell apart leave no room between them for a blocked cell.
    parent = parents[cell]
    dr, dc = parent // width - cell // width, parent % width - cell % width
    sr, sc = (dr > 0) - (dr < 0), (dc > 0) - (dc < 0)
    diagonal = cell + sr * width + sc
    if not (done[diagonal] and parents[diagonal] == parent):
        return False
    if abs(dr) == abs(dc):
        return moves[cell] >> _DIAGONAL[(sr + 1) >> 1, (sc + 1) >> 1] & 1 == 1
    straight = cell + sr * width if abs(dr) > abs(dc) else cell + sc
    return done[straight] and parents[straight] == parent


@njit(cache=True)
def _in_sight(open_cells, moves, done, parents, cell):  # type: ignore[no-untyped-def]
    width = open_cells.shape[1]
    if _bracketed(moves, width, done, parents, cell):
        return True
    row, column = parents[cell] // width, parents[cell] % width
    return clear_line(open_cells, column + 0.5, row + 0.5, cell % width + 0.5, cell // width + 0.5)


@njit(cache=True)
def _ahead(cell, goal, width):  # type: ignore[no-untyped-def]
    if goal < 0:
        return 0.0
    return math.sqrt((goal // width - cell // width) ** 2 + (goal % width - cell % width) ** 2)


@njit(cache=True)
def spread(open_cells, moves, start, goal):  # type: ignore[no-untyped-def]
    """Return lengths (H W,) from the flat cell `start` and each cell's parent (H W,), -1 where there is none.

    Lazy Theta* (Nash et al. 2010), ordered towards the flat cell `goal` and ended there, or spread everywhere
    where `goal` is negative. A cell first takes the parent of the cell it was reached from; where that parent
    is out of sight when its turn comes, it takes its best finished neighbour and waits again. So a length is
    never above the 8-connected one, and the line from a finished cell to its parent is always clear.
    """
    width = open_cells.shape[1]
    lengths, parents = np.full(len(moves), math.inf), np.full(len(moves), -1, dtype=np.int32)
    done, seen = np.zeros(len(moves), dtype=np.bool_), np.zeros(len(moves), dtype=np.bool_)
    room = 8 * np.count_nonzero(open_cells) + 1
    keys, cells = np.empty(room), np.empty(room, dtype=np.int32)
    lengths[start], parents[start], seen[start] = 0.0, start, True
    keys[0], cells[0], size = _ahead(start, goal, width), start, 1
    while size > 0:
        key, cell = keys[0], np.int64(cells[0])
        size -= 1
        _sink(keys, cells, size)
        if done[cell] or key != lengths[cell] + _ahead(cell, goal, width):
            continue
        if not seen[cell]:
            seen[cell] = True
            if not _in_sight(open_cells, moves, done, parents, cell):
                lengths[cell], parents[cell] = _through_neighbour(moves, width, done, lengths, cell)
                _rise(keys, cells, size, lengths[cell] + _ahead(cell, goal, width), cell)
                size += 1
                continue
        done[cell] = True
        if cell == goal:
            break
        parent = np.int64(parents[cell])
        row, column = cell // width - parent // width, cell % width - parent % width
        for bit in range(8):
            other = cell + MOVES[bit, 0] * width + MOVES[bit, 1]
            if moves[cell] >> bit & 1 and not done[other] and parents[other] != parent:
                length = lengths[parent] + math.sqrt(
                    (row + MOVES[bit, 0]) ** 2 + (column + MOVES[bit, 1]) ** 2
                )
                if length < lengths[other]:
                    lengths[other], parents[other], seen[other] = length, parent, False
                    _rise(keys, cells, size, length + _ahead(other, goal, width), other)
                    size += 1
    return lengths, parents


@njit(cache=True)
def trace(open_cells, parents, start_x, start_y, goal_x, goal_y, path):  # type: ignore[no-untyped-def]
    """Write the points from start to goal into `path` (P, 2), each as (x, y), and return how many there are.

    They are the chain of parents from the goal's cell between the exact ends, shortened to the shortest way
    along clear lines between any two of them.
    """
    width = open_cells.shape[1]
    start = math.floor(start_y) * width + math.floor(start_x)
    cell = math.floor(goal_y) * width + math.floor(goal_x)
    path[0, 0], path[0, 1] = goal_x, goal_y
    count = 1
    while True:
        path[count, 0], path[count, 1] = cell % width + 0.5, cell // width + 0.5
        count += 1
        if cell == start:
            break
        cell = np.int64(parents[cell])
    path[count, 0], path[count, 1] = start_x, start_y
    path[: count + 1] = path[count::-1].copy()
    return _pull(open_cells, path, count + 1)


@njit(cache=True)
def _pull(open_cells, path, count):  # type: ignore[no-untyped-def]
    best, before = np.full(count, math.inf), np.zeros(count, dtype=np.int64)
    best[0] = 0.0
    for end in range(1, count):
        for begin in range(end):
            length = best[begin] + math.hypot(path[end, 0] - path[begin, 0], path[end, 1] - path[begin, 1])
            if length < best[end] and (
                begin == end - 1
                or clear_line(open_cells, path[begin, 0], path[begin, 1], path[end, 0], path[end, 1])
            ):
                best[end], before[end] = length, begin
    kept = np.empty(count, dtype=np.int64)
    at, size = count - 1, 0
    while at > 0:
        kept[size] = at
        at = before[at]
        size += 1
    for n in range(size):
        path[n + 1] = path[kept[size - 1 - n]]
    return size + 1


@njit(cache=True)
def traced_lengths(open_cells, parents, start_x, start_y, goals, path):  # type: ignore[no-untyped-def]
    """Return the lengths (N,) of the traced paths to `goals` (N, 2), which must lie in cells with parents."""
    lengths = np.empty(len(goals))
    for n in range(len(goals)):
        count = trace(open_cells, parents, start_x, start_y, goals[n, 0], goals[n, 1], path)
        length = 0.0
        for k in range(1, count):
            length += math.hypot(path[k, 0] - path[k - 1, 0], path[k, 1] - path[k - 1, 1])
        lengths[n] = length
    return lengths
