"""Boxes seen from above: whether they overlap."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray


def overlap(
    offsets: FloatArray, yaws: FloatArray, other_yaws: FloatArray, half: FloatArray, other_half: FloatArray
) -> BoolArray:
    """Return whether pairs of rectangles overlap: (P,).

    `offsets` (P, 2) lead from the centre of the one to that of the other [m], `yaws` (P,) are their headings [rad],
    `half` (2,) their half lengths and half widths [m]. Separating axes: two rectangles are apart where their shadows on
    the direction of one of the four sides are; boxes that touch do not overlap.
    """
    turns = other_yaws - yaws
    cos, sin = np.abs(np.cos(turns)), np.abs(np.sin(turns))
    near = _shadows_meet(
        offsets,
        yaws,
        half,
        other_half[0] * cos + other_half[1] * sin,
        other_half[0] * sin + other_half[1] * cos,
    )
    back = _shadows_meet(
        offsets, other_yaws, other_half, half[0] * cos + half[1] * sin, half[0] * sin + half[1] * cos
    )
    return near & back


def _shadows_meet(
    offsets: FloatArray, yaws: FloatArray, half: FloatArray, along: FloatArray, across: FloatArray
) -> BoolArray:
    cos, sin = np.cos(yaws), np.sin(yaws)
    x = offsets[:, 0] * cos + offsets[:, 1] * sin
    y = offsets[:, 1] * cos - offsets[:, 0] * sin
    return np.asarray((np.abs(x) < half[0] + along) & (np.abs(y) < half[1] + across))
