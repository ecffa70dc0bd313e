"""How a straight line enters a grid and walks from cell to cell (Amanatides and Woo 1987)."""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True)
def clip(start, step, size, first, last):  # type: ignore[no-untyped-def]
    """Return the part of [first, last] in which start + t step lies within 0 to size; first > last where none does."""
    if step == 0.0:
        return (first, last) if 0.0 <= start < size else (1.0, 0.0)
    enter, leave = -start / step, (size - start) / step
    return max(first, min(enter, leave)), min(last, max(enter, leave))


@njit(cache=True)
def clip_all(x, y, z, dx, dy, dz, shape, last):  # type: ignore[no-untyped-def]
    """Return the part of [0, last] in which (x, y, z) + t (dx, dy, dz) lies in a grid; first > last where none does."""
    nx, ny, nz = shape
    first, last = clip(x, dx, nx, 0.0, last)
    first, last = clip(y, dy, ny, first, last)
    return clip(z, dz, nz, first, last)


@njit(cache=True)
def axis(start, step, size, first, last):  # type: ignore[no-untyped-def]
    """Return the first cell, how many cells follow (signed), the t of the first border, and t from border to border."""
    cell = min(max(math.floor(start + first * step), 0), size - 1)
    goal = min(max(math.floor(start + last * step), 0), size - 1)
    if goal == cell:
        return cell, 0, math.inf, math.inf
    border = cell + 1 if step > 0.0 else cell
    return cell, goal - cell, (border - start) / step, 1.0 / abs(step)


@njit(cache=True)
def enter(x, y, z, dx, dy, dz, shape, first, last):  # type: ignore[no-untyped-def]
    """Return the number of the first cell of a walk over [first, last], how many follow, and what `onward` goes by.

    That is what each step adds to the number of a cell, and to the t of the next border along its axis; then how many
    steps are left along each axis, and the t of the next border.
    """
    nx, ny, nz = shape
    i, left_i, next_i, wait_i = axis(x, dx, nx, first, last)
    j, left_j, next_j, wait_j = axis(y, dy, ny, first, last)
    k, left_k, next_k, wait_k = axis(z, dz, nz, first, last)
    steps = (ny * nz if left_i > 0 else -ny * nz, nz if left_j > 0 else -nz, 1 if left_k > 0 else -1)
    left = abs(left_i), abs(left_j), abs(left_k)
    borders = next_i, next_j, next_k
    return (i * ny + j) * nz + k, left[0] + left[1] + left[2], steps, (wait_i, wait_j, wait_k), left, borders


@njit(cache=True)
def onward(here, steps, waits, left, borders):  # type: ignore[no-untyped-def]
    """Return the number of the next cell, how many steps are left, and the next borders."""
    left_i, left_j, left_k = left
    next_i, next_j, next_k = borders
    if next_i <= next_j and next_i <= next_k:
        next_i = next_i + waits[0] if left_i > 1 else math.inf
        return here + steps[0], (left_i - 1, left_j, left_k), (next_i, next_j, next_k)
    if next_j <= next_k:
        next_j = next_j + waits[1] if left_j > 1 else math.inf
        return here + steps[1], (left_i, left_j - 1, left_k), (next_i, next_j, next_k)
    next_k = next_k + waits[2] if left_k > 1 else math.inf
    return here + steps[2], (left_i, left_j, left_k - 1), (next_i, next_j, next_k)
