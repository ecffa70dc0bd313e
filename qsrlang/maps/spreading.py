"""Any-angle shortest distances over open cells. Lengths are in cells; a flat cell is row x W + column."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.maps.sight import clear_line

MoveArray: TypeAlias = npt.NDArray[np.uint8]
ParentArray: TypeAlias = npt.NDArray[np.int32]

MOVES = np.array([[-1, -1], [-1, 0], [-1, 1], [0, -1], [0, 1], [1, -1], [1, 0], [1, 1]])
STEPS = np.sqrt((MOVES**2).sum(axis=1))
_DIAGONAL = np.array([[0, 2], [5, 7]])


def open_moves(open_cells: BoolArray) -> MoveArray:
    """Return for each flat cell (H W,) the bits of the MOVES that lead to open cells and cut no corner."""
    height, width = open_cells.shape
    padded = np.pad(open_cells, 1)
    moves = np.zeros(open_cells.shape, dtype=np.uint8)
    for bit, (dr, dc) in enumerate(MOVES.tolist()):
        rows, columns = slice(1 + dr, 1 + dr + height), slice(1 + dc, 1 + dc + width)
        beside = padded[rows, 1:-1] & padded[1:-1, columns]
        moves |= (open_cells & padded[rows, columns] & beside).astype(np.uint8) << bit
    return moves.reshape(-1)


def spread(
    open_cells: BoolArray, moves: MoveArray, start: int, goal: int = -1
) -> tuple[FloatArray, ParentArray]:
    """Return lengths (H W,) from the flat cell `start` and each cell's parent (H W,), -1 where there is none.

    Lazy Theta* (Nash et al. 2010), ordered towards the flat cell `goal` and ended there, or spread everywhere
    where `goal` is negative. A cell first takes the parent of the cell it was reached from; where that parent
    is out of sight when its turn comes, it takes its best finished neighbour and waits again. So a length is
    never above the 8-connected one, and the line from a finished cell to its parent is always clear.
    """
    lengths, parents = np.full(len(moves), np.inf), np.full(len(moves), -1, dtype=np.int32)
    done, seen = np.zeros(len(moves), dtype=np.bool_), np.zeros(len(moves), dtype=np.bool_)
    room = 8 * int(np.count_nonzero(open_cells)) + 1
    keys, cells = np.empty(room), np.empty(room, dtype=np.int32)
    _spread(open_cells, moves, start, goal, lengths, parents, done, seen, keys, cells)
    return lengths, parents


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
def _spread(open_cells, moves, start, goal, lengths, parents, done, seen, keys, cells):  # type: ignore[no-untyped-def]
    width = open_cells.shape[1]
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
