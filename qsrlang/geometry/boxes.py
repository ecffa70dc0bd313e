"""Boxes seen from above: whether they overlap."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray

Half: TypeAlias = tuple[float, float]


def overlap(
    offsets: FloatArray, yaws: FloatArray, other_yaws: FloatArray, half: Half, other_half: Half
) -> BoolArray:
    """Return whether pairs of rectangles overlap: (P,).

    `offsets` (P, 2) lead from the centre of the one to that of the other [m], `yaws` (P,) are their headings [rad],
    `half` their half lengths and half widths [m]. Separating axes: two rectangles are apart where their shadows on
    the direction of one of the four sides are; boxes that touch do not overlap.
    """
    turns = other_yaws - yaws
    cos, sin = np.abs(np.cos(turns)), np.abs(np.sin(turns))
    by_first = _shadows_meet(offsets, yaws, half, other_half, cos, sin)
    return by_first & _shadows_meet(offsets, other_yaws, other_half, half, cos, sin)


def _shadows_meet(
    offsets: FloatArray, yaws: FloatArray, own: Half, other: Half, cos: FloatArray, sin: FloatArray
) -> BoolArray:
    """Return whether the shadows on the sides of one box meet; cos and sin (P,) are of the angle between the two."""
    ahead, left = np.cos(yaws), np.sin(yaws)
    along = np.abs(offsets[:, 0] * ahead + offsets[:, 1] * left) < own[0] + other[0] * cos + other[1] * sin
    across = np.abs(offsets[:, 1] * ahead - offsets[:, 0] * left) < own[1] + other[0] * sin + other[1] * cos
    return np.asarray(along & across)
