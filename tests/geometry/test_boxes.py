"""Overlapping boxes beside a slow intersection of polygons."""

import math

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from qsrlang.geometry.angles import unit
from qsrlang.geometry.boxes import overlap

sides = st.floats(0.05, 2.0)
halves = st.tuples(sides, sides)
yaws = st.floats(-math.pi, math.pi)
offsets = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def corners(centre, yaw, half):
    ahead, left = unit(np.array(yaw)), unit(np.array(yaw + 0.5 * math.pi))
    return [
        centre + a * half[0] * ahead + b * half[1] * left for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]


def clipped(polygon, window):
    """What is left of a polygon inside a convex window, its corners counter-clockwise: cut by one edge at a time."""
    for start, end in zip(window, [*window[1:], window[0]], strict=True):
        edge, kept = end - start, []
        for here, there in zip(polygon, [*polygon[1:], *polygon[:1]], strict=True):
            a, b = (edge[0] * (p - start)[1] - edge[1] * (p - start)[0] for p in (here, there))
            kept += [here] if a >= 0.0 else []
            kept += [here + a / (a - b) * (there - here)] if (a >= 0.0) != (b >= 0.0) else []
        polygon = kept
    return polygon


def area(polygon):
    pairs = zip(polygon, [*polygon[1:], *polygon[:1]], strict=True)
    return 0.5 * abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in pairs))


def overlaps(offset, yaw, other_yaw, half, other_half):
    (found,) = overlap(np.array([offset]), np.array([yaw]), np.array([other_yaw]), half, other_half)
    return bool(found)


@given(offsets, yaws, yaws, halves, halves)
def test_boxes_overlap_where_their_intersection_has_an_area(offset, yaw, other_yaw, half, other_half):
    first = corners(np.zeros(2), yaw, half)
    shared = area(clipped(first, corners(np.array(offset), other_yaw, other_half)))
    assume(shared == 0.0 or shared > 1e-9)
    found = overlaps(offset, yaw, other_yaw, half, other_half)
    if shared > 0.0:
        assert found
    elif found:  # at most a hair's breadth that the slow way rounds off
        smaller = (0.999999 * half[0], 0.999999 * half[1])
        assert not overlaps(offset, yaw, other_yaw, smaller, other_half)


@given(offsets, yaws, yaws, halves, halves, yaws)
def test_it_is_symmetric_and_does_not_depend_on_the_frame(offset, yaw, other_yaw, half, other_half, turn):
    found = overlaps(offset, yaw, other_yaw, half, other_half)
    assume(found == overlaps(offset, yaw, other_yaw, (half[0] * 1.000001, half[1] * 1.000001), other_half))
    assume(found == overlaps(offset, yaw, other_yaw, (half[0] * 0.999999, half[1] * 0.999999), other_half))
    back = (-offset[0], -offset[1])
    assert found == overlaps(back, other_yaw, yaw, other_half, half)
    c, s = math.cos(turn), math.sin(turn)
    turned = (c * offset[0] - s * offset[1], s * offset[0] + c * offset[1])
    assert found == overlaps(turned, yaw + turn, other_yaw + turn, half, other_half)


def test_boxes_that_touch_do_not_overlap():
    assert not overlaps((1.0, 0.0), 0.0, 0.0, (0.5, 0.5), (0.5, 0.5))
    assert overlaps((0.999, 0.0), 0.0, 0.0, (0.5, 0.5), (0.5, 0.5))
    assert not overlaps((0.5 + math.sqrt(0.5) + 1e-9, 0.0), 0.0, math.pi / 4, (0.5, 0.5), (0.5, 0.5))
