"""Plain geometry for the oracle: boxes that touch, rays that meet edges, densities on the circle. Metres, radians."""

import math

import numpy as np

from qsrlang.language.syntax import Normal, Uniform

CIRCLE = 2.0 * math.pi


def turned_back(angles):
    """Angles in (-pi, pi]."""
    return np.pi - (np.pi - angles) % CIRCLE


def directions(theta):
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def along_axes(offsets, yaw):
    """Offsets (..., 2) in a frame that is turned by yaw."""
    x, y = offsets[..., 0], offsets[..., 1]
    return np.cos(yaw) * x + np.sin(yaw) * y, np.cos(yaw) * y - np.sin(yaw) * x


def touching(half, other_half, yaw, theta):
    """How far apart two boxes turned by yaw touch, the one in direction theta of the other."""
    length, width = half[0] + other_half[0], half[1] + other_half[1]
    if length == 0.0 and width == 0.0:
        return np.zeros_like(theta)
    c, s = np.abs(np.cos(theta - yaw)), np.abs(np.sin(theta - yaw))
    with np.errstate(divide="ignore"):
        return np.minimum(length / c, width / s)


def to_the_edge(centre, yaw, theta, half, table_centre, table_yaw, table_half):
    """How far a box turned by yaw moves from a centre in direction theta until it meets the edge of a table."""
    x, y = along_axes(centre - table_centre, table_yaw)
    x, y = np.clip(x, -table_half[0], table_half[0]), np.clip(y, -table_half[1], table_half[1])
    c, s = np.abs(np.cos(yaw - table_yaw)), np.abs(np.sin(yaw - table_yaw))
    room_x = table_half[0] - (half[0] * c + half[1] * s)
    room_y = table_half[1] - (half[0] * s + half[1] * c)
    off = theta - table_yaw
    return np.minimum(_to_the_line(x, room_x, np.cos(off)), _to_the_line(y, room_y, np.sin(off)))


def _to_the_line(start, room, speed):
    with np.errstate(divide="ignore", invalid="ignore"):
        way = np.where(speed > 0.0, (room - start) / speed, (room + start) / -speed)
    return np.where(speed == 0.0, np.inf, way)


def angle_density(density, angles):
    """The density of an angle factor [1/rad]: a wrapped normal, uniform on an arc, or anywhere."""
    if isinstance(density, Normal):
        turns = range(-3, 4) if density.deviation.value > 1.0 else (-1, 0, 1)
        off = turned_back(angles - density.mean.value)
        z = [(off + turn * CIRCLE) / density.deviation.value for turn in turns]
        return sum(np.exp(-0.5 * one**2) for one in z) / (density.deviation.value * math.sqrt(CIRCLE))
    if isinstance(density, Uniform):
        width = min(density.high.value - density.low.value, CIRCLE)
        middle = 0.5 * (density.low.value + density.high.value)
        return np.where(np.abs(turned_back(angles - middle)) <= 0.5 * width, 1.0 / width, 0.0)
    return np.full(np.shape(angles), 1.0 / CIRCLE)


def angle_draws(density, count, rng):
    if isinstance(density, Normal):
        return rng.normal(density.mean.value, density.deviation.value, count)
    if isinstance(density, Uniform):
        width = min(density.high.value - density.low.value, CIRCLE)
        return 0.5 * (density.low.value + density.high.value) + width * (rng.random(count) - 0.5)
    return rng.uniform(-np.pi, np.pi, count)


def angle_middle_and_half(density):
    """The middle of an angle factor and half the width that holds all but 1e-6 of it, to integrate over."""
    if isinstance(density, Normal):
        return density.mean.value, min(5.0 * density.deviation.value, math.pi)
    if isinstance(density, Uniform):
        middle = 0.5 * (density.low.value + density.high.value)
        return middle, 0.5 * min(density.high.value - density.low.value, CIRCLE)
    return 0.0, math.pi


def overlapping(offsets, yaw, other_yaw, half, other_half):
    """Whether boxes overlap: no side of either has the whole of the other beyond it."""
    corners = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    return ~(
        _apart(-offsets, yaw, other_yaw, half, other_half * corners)
        | _apart(offsets, other_yaw, yaw, other_half, half * corners)
    )


def _apart(offsets, yaw, other_yaw, half, other_corners):
    """Whether all corners of another box, at minus the offsets, are beyond one side of a box turned by yaw."""
    x, y = along_axes(-offsets, yaw)
    turn = other_yaw - yaw
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    xs = x[:, None] + c * other_corners[:, 0] - s * other_corners[:, 1]
    ys = y[:, None] + s * other_corners[:, 0] + c * other_corners[:, 1]
    beyond = [xs >= half[0], xs <= -half[0], ys >= half[1], ys <= -half[1]]
    return np.any([side.all(axis=1) for side in beyond], axis=0)
