"""What a constraint says of its referent in each draw of a scene: draws and densities, with no Gaussian anywhere."""

import math
from dataclasses import dataclass, replace

import numpy as np
from plain_geometry import (
    along_axes,
    angle_density,
    angle_draws,
    angle_middle_and_half,
    directions,
    to_the_edge,
    touching,
)

from qsrlang.language.syntax import Dimension, Frame, Uniform

SHORTEST_WAY = 1e-3
NARROWEST = 1e-3
DIRECTIONS = 64
TRIES = (1, 4, 100)


@dataclass
class Scenes:
    """P draws of one world: where each object is (P, 2), the heading (P,) of its root landmark or None, the viewer."""

    graph: object
    viewer: object
    count: int
    points: dict
    headings: dict
    roots: dict

    def kind(self, name):
        return self.graph.classes[self.graph.class_of(name)]

    def half(self, name):
        """Half of the depth (along the heading) and of the width."""
        return 0.5 * self.kind(name).depth, 0.5 * self.kind(name).width

    def some(self, chosen):
        """Some of the draws."""
        points = {name: one[chosen] for name, one in self.points.items()}
        headings = {name: None if one is None else one[chosen] for name, one in self.headings.items()}
        return replace(self, count=len(chosen), points=points, headings=headings)


@dataclass
class Table:
    """What carries a referent: the centre (P, 2), heading (P,) and half sides of its top; it may be the relatum."""

    centre: np.ndarray
    yaw: np.ndarray
    half: tuple
    is_relatum: bool

    def some(self, chosen):
        return replace(self, centre=self.centre[chosen], yaw=self.yaw[chosen])


def axis(scenes, constraint, frame):
    """The direction (P,) from which the angles of a frame count."""
    at = scenes.points[constraint.relatum]
    if constraint.towards is not None:
        x, y = (scenes.points[constraint.towards] - at).T
        return np.arctan2(y, x)
    if frame is Frame.ABSOLUTE:
        return np.full(scenes.count, 0.5 * np.pi)
    if frame is Frame.RELATIVE and scenes.viewer is not None:
        return np.arctan2(at[:, 1] - scenes.viewer.y, at[:, 0] - scenes.viewer.x)
    return scenes.headings[constraint.relatum] + np.pi


def box_yaw(scenes, constraint, relatum):
    heading = scenes.headings[relatum]
    if heading is not None:
        return heading
    turned = replace(constraint, relatum=relatum, towards=_other_relatum(constraint, relatum))
    return axis(scenes, turned, Frame.RELATIVE) + np.pi


def _other_relatum(constraint, relatum):
    if constraint.towards is None:
        return None
    return constraint.towards if relatum == constraint.relatum else constraint.relatum


def frame_of(constraint, atom):
    return Frame.RELATIVE if constraint.towards is not None else atom.frame


def sense(frame):
    """Left and right swap in an object's own frame."""
    return -1.0 if frame is Frame.INTRINSIC else 1.0


def way(scenes, constraint, table, theta):
    """The nearest and the farthest that a referent may be along theta (P, N): from touching to the edge, as bounded."""
    yaw = box_yaw(scenes, constraint, constraint.relatum)[:, None]
    half = scenes.half(constraint.referent)
    contact = touching(half, scenes.half(constraint.relatum), yaw, theta)
    if constraint.towards is not None:
        contact, edge = _way_between(scenes, constraint, theta, contact)
    elif table is not None:
        contact = np.zeros_like(theta) if table.is_relatum else contact
        centre = scenes.points[constraint.relatum][:, None]
        edge = to_the_edge(centre, yaw, theta, half, table.centre[:, None], table.yaw[:, None], table.half)
    else:
        edge = contact + scenes.graph.reach
    return _bounded(constraint, table, contact, edge)


def _way_between(scenes, constraint, theta, contact):
    half, other = scenes.half(constraint.referent), scenes.half(constraint.towards)
    yaw = box_yaw(scenes, constraint, constraint.towards)[:, None]
    far = touching(half, other, yaw, theta)
    offsets = scenes.points[constraint.towards] - scenes.points[constraint.relatum]
    length = np.hypot(*offsets.T)[:, None]
    with np.errstate(invalid="ignore"):
        middle = np.where(contact + far > 0.0, length * contact / (contact + far), 0.5 * length)
    short = length - contact - far < SHORTEST_WAY
    low = np.where(short, np.maximum(middle - 0.5 * SHORTEST_WAY, 0.0), contact)
    return low, np.where(short, low + SHORTEST_WAY, length - far)


def _bounded(constraint, table, contact, edge):
    low, high = contact, np.full_like(contact, np.inf)
    for atom in constraint.atoms:
        bounds = atom.relation.distance
        if isinstance(bounds, Uniform):
            unit = edge - contact if bounds.low.dimension is Dimension.FRACTION else 1.0
            low = np.maximum(low, contact + bounds.low.value * unit)
            high = np.minimum(high, contact + bounds.high.value * unit)
    if table is not None or np.isinf(high).any():
        high = np.minimum(high, edge)
    return low, high


def draws(scenes, constraint, table, rng):
    """One place (P, 2) for the referent in each draw of what it is placed by."""
    if constraint.fit is not None:
        return _fit_draws(scenes, constraint, rng)
    if is_region(constraint):
        return _region_draws(scenes, constraint, rng)
    if _either_way(constraint):
        heads = rng.random(scenes.count) < 0.5
        one = _polar_draws(scenes, constraint, table, rng)
        other = _polar_draws(scenes, _seen_from_the_other(constraint), table, rng)
        return np.where(heads[:, None], one, other)
    return _polar_draws(scenes, constraint, table, rng)


def densities(scenes, constraint, table, points):
    """The density (P,) of the referent being at points (P, 2) [1/m^2]."""
    if constraint.fit is not None:
        return _fit_density(scenes, constraint, points)
    if is_region(constraint):
        return _region_density(scenes, constraint, points)
    if _either_way(constraint):
        one = _polar_density(scenes, constraint, table, points)
        return 0.5 * (one + _polar_density(scenes, _seen_from_the_other(constraint), table, points))
    return _polar_density(scenes, constraint, table, points)


def is_region(constraint):
    return any(atom.relation.region is not None for atom in constraint.atoms)


def _either_way(constraint):
    return constraint.towards is not None and constraint.atoms[0].relation.symmetric


def _seen_from_the_other(constraint):
    return replace(constraint, relatum=constraint.towards, towards=constraint.relatum)


def _factors(scenes, constraint):
    """The angle factors: density, sense, and the axis (P,); where nothing is said of the angle, any."""
    said = [atom for atom in constraint.atoms if atom.relation.angle is not None]
    frames = [frame_of(constraint, atom) for atom in said]
    found = [
        (atom.relation.angle, sense(frame), axis(scenes, constraint, frame))
        for atom, frame in zip(said, frames, strict=True)
    ]
    return found or [(None, 1.0, np.zeros(scenes.count))]


def _narrowest_first(factors):
    return sorted(factors, key=lambda factor: angle_middle_and_half(factor[0])[1])


def _polar_draws(scenes, constraint, table, rng):
    """Draw an angle by the narrowest factor; keep it by the others and if there is room; else draw again.

    Where hardly any angle has room, the boxes touch.
    """
    theta, low, high = np.zeros((3, scenes.count))
    waiting = np.arange(scenes.count)
    for tries in TRIES:
        some, top = scenes.some(waiting), table and table.some(waiting)
        tried, near, far, kept = _tries(some, constraint, top, tries, rng)
        chosen = np.arange(some.count), kept.argmax(axis=1)
        theta[waiting], low[waiting] = tried[chosen], near[chosen]
        high[waiting] = np.maximum(near[chosen], far[chosen])
        waiting = waiting[~kept.any(axis=1)]
    return scenes.points[constraint.relatum] + rng.uniform(low, high)[:, None] * directions(theta)


def _tries(scenes, constraint, table, tries, rng):
    """Angles (P, tries), how near and far they let the referent be, and which of them may be kept."""
    (first, hand, along), *others = _narrowest_first(_factors(scenes, constraint))
    theta = along[:, None] + hand * angle_draws(first, (scenes.count, tries), rng)
    near, far = way(scenes, constraint, table, theta)
    agreed = rng.random(theta.shape) < _agreement(others, theta)
    return theta, near, far, agreed & (far > near)


def _agreement(factors, theta):
    """The product of factors at theta (P, N), each as a share of its greatest value."""
    product = np.ones_like(theta)
    for density, hand, along in factors:
        middle, _ = angle_middle_and_half(density)
        product = product * angle_density(density, hand * (theta - along[:, None]))
        product = product / angle_density(density, np.array(middle))
    return product


def _polar_density(scenes, constraint, table, points):
    x, y = (points - scenes.points[constraint.relatum]).T
    r, theta = np.hypot(x, y), np.arctan2(y, x)
    near, far = (bound[:, 0] for bound in way(scenes, constraint, table, theta[:, None]))
    factors = _narrowest_first(_factors(scenes, constraint))
    angles = _product(factors, theta[:, None])[:, 0] / _mass(scenes, constraint, table, factors)
    inside = (near <= r) & (r <= far) & (far > near)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(inside, angles / ((far - near) * r), 0.0)


def _product(factors, theta):
    product = np.ones_like(theta)
    for density, hand, along in factors:
        product = product * angle_density(density, hand * (theta - along[:, None]))
    return product


def _mass(scenes, constraint, table, factors):
    """The integral (P,) of the product of angle factors over directions with room, by the midpoint rule."""
    density, hand, along = factors[0]
    middle, half = angle_middle_and_half(density)
    steps = middle + half * (2.0 * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS - 1.0)
    theta = along[:, None] + hand * steps
    near, far = way(scenes, constraint, table, theta)
    heights = np.where(far > near, _product(factors, theta), 0.0)
    return heights.sum(axis=1) * (2.0 * half / DIRECTIONS)


def _fit_parts(scenes, constraint):
    frame = frame_of(constraint, constraint.atoms[0])
    along = axis(scenes, constraint, frame)
    left = sense(frame) * directions(along + 0.5 * np.pi)
    return scenes.points[constraint.relatum], directions(along), left


def _fit_draws(scenes, constraint, rng):
    (mx, my), (sx, sy), rho = constraint.fit.mean, constraint.fit.deviation, constraint.fit.correlation
    start, ahead, left = _fit_parts(scenes, constraint)
    one, other = rng.standard_normal((2, scenes.count, 1))
    a, b = mx + sx * one, my + sy * (rho * one + math.sqrt(1.0 - rho * rho) * other)
    return start + a * ahead + b * left


def _fit_density(scenes, constraint, points):
    (mx, my), (sx, sy), rho = constraint.fit.mean, constraint.fit.deviation, constraint.fit.correlation
    start, ahead, left = _fit_parts(scenes, constraint)
    u = (((points - start) * ahead).sum(axis=1) - mx) / sx
    v = (((points - start) * left).sum(axis=1) - my) / sy
    rest = 1.0 - rho * rho
    square = (u * u - 2.0 * rho * u * v + v * v) / rest
    return np.exp(-0.5 * square) / (2.0 * np.pi * sx * sy * math.sqrt(rest))


def region_room(scenes, constraint):
    """Half the sides of where the referent's centre may be in its relatum; None where that has no size."""
    kind, own = scenes.kind(constraint.relatum), scenes.kind(constraint.referent)
    if kind.width == 0.0 or kind.depth == 0.0:
        return None
    return 0.5 * max(kind.depth - own.depth, NARROWEST), 0.5 * max(kind.width - own.width, NARROWEST)


def _region_draws(scenes, constraint, rng):
    room, start = region_room(scenes, constraint), scenes.points[constraint.relatum]
    if room is None:
        r = scenes.graph.reach * np.sqrt(rng.random(scenes.count))
        return start + r[:, None] * directions(rng.uniform(-np.pi, np.pi, scenes.count))
    yaw = box_yaw(scenes, constraint, constraint.relatum)
    a, b = rng.uniform(-room[0], room[0], scenes.count), rng.uniform(-room[1], room[1], scenes.count)
    return start + a[:, None] * directions(yaw) + b[:, None] * directions(yaw + 0.5 * np.pi)


def _region_density(scenes, constraint, points):
    room, offsets = region_room(scenes, constraint), points - scenes.points[constraint.relatum]
    if room is None:
        reach = scenes.graph.reach
        return np.where(np.hypot(*offsets.T) <= reach, 1.0 / (np.pi * reach**2), 0.0)
    a, b = along_axes(offsets, box_yaw(scenes, constraint, constraint.relatum))
    inside = (np.abs(a) <= room[0]) & (np.abs(b) <= room[1])
    return np.where(inside, 1.0 / (4.0 * room[0] * room[1]), 0.0)
