"""How a straight line enters a grid and steps from cell to cell along one axis (Amanatides and Woo 1987)."""

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
def axis(start, step, size, first, last):  # type: ignore[no-untyped-def]
    """Return the first cell, how many cells follow (signed), the t of the first border, and t from border to border."""
    cell = min(max(math.floor(start + first * step), 0), size - 1)
    goal = min(max(math.floor(start + last * step), 0), size - 1)
    if goal == cell:
        return cell, 0, math.inf, math.inf
    border = cell + 1 if step > 0.0 else cell
    return cell, goal - cell, (border - start) / step, 1.0 / abs(step)
