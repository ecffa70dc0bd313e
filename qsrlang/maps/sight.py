"""Lines of sight over open cells. Places are in cells: x along columns, y along rows."""

from __future__ import annotations

import math

from numba import njit

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
