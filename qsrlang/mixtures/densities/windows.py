"""Whether relations hold where objects are: parts of the plane, sharp where their densities are not.

A direction holds in its arcs. A distance holds between its bounds, below where it begins at 0, and beyond where it
ends at the edge. `on` and `in` hold where the relatum's outline contains the referent, `between` where it is seen so
from either end.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.geometry.angles import wrap
from qsrlang.language.syntax import Dimension, Uniform
from qsrlang.mixtures.densities.conditional import Conditional, EitherConditional, PolarConditional
from qsrlang.mixtures.densities.density import Rays
from qsrlang.mixtures.densities.sectors import Arcs, Part, arcs_of, covered
from qsrlang.mixtures.densities.stance import Stance
from qsrlang.relations.calculus import Relation


@dataclass(frozen=True, slots=True)
class Window:
    """The part of the plane that a relation holds in, seen from where a polar density would be."""

    polar: PolarConditional
    relation: Relation
    arcs: Arcs

    def parts(self, rays: Rays, states: FloatArray) -> tuple[tuple[Part, ...], FloatArray, FloatArray]:
        """Return the parts inside of the cells about rays (P, N), from states (P, n), and from where to where along."""
        stance, hand = self.polar.stance(states), self.polar.density.hands[0]
        found = self.arcs.parts(hand * (rays.directions - stance.axes[:, [0]]), rays.cell)
        low, high = _bounds(self.polar, self.relation, stance, rays.directions)
        return tuple(part if hand > 0.0 else (-part[1], -part[0]) for part in found), low, high


def share_inside(windows: Sequence[Window], rays: Rays, states: FloatArray) -> FloatArray:
    """Return which share (P,) of the mass along rays (P, N), from states (P, n), lies inside of all windows."""
    shape, low, high = np.shape(rays.weights), rays.low, rays.high
    parts: list[Part] = [(np.full(shape, -0.5 * rays.cell), np.full(shape, 0.5 * rays.cell))]
    for window in windows:
        inside, least, greatest = window.parts(rays, states)
        parts = [_both(one, other) for one in parts for other in inside]
        low, high = np.maximum(low, least), np.minimum(high, greatest)
    length = rays.high - rays.low
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.where(length > 0.0, np.clip((high - low) / length, 0.0, 1.0), high >= low)
    return np.asarray((rays.weights * covered(parts, rays.cell, shape) * along).sum(axis=1))


def _both(one: Part, other: Part) -> Part:
    return np.maximum(one[0], other[0]), np.minimum(one[1], other[1])


def holds_at(
    conditional: Conditional,
    relation: Relation,
    relations: Mapping[str, Relation],
    points: FloatArray,
    states: FloatArray,
) -> BoolArray:
    """Return whether a relation holds of points (P, 2), one for each state (P, n): (P,)."""
    match conditional:
        case EitherConditional(first=first, second=second):
            return holds_at(first, relation, relations, points, states) | holds_at(
                second, relation, relations, points, states
            )
        case PolarConditional():
            return _within(conditional, relation, relations, points, states)
        case _:
            return np.asarray(conditional.pdf(points, states) > 0.0)


def _within(
    polar: PolarConditional,
    relation: Relation,
    relations: Mapping[str, Relation],
    points: FloatArray,
    states: FloatArray,
) -> BoolArray:
    stance = polar.stance(states)
    offsets = points - stance.positions
    directions = np.arctan2(offsets[:, 1], offsets[:, 0])
    held = np.ones(len(points), dtype=bool)
    if relation.angle is not None:
        angles = wrap(polar.density.hands[0] * (directions - stance.axes[:, 0]))
        held &= arcs_of(relation, relations).contain(angles)
    if relation.distance is not None:
        low, high = (bound[:, 0] for bound in _bounds(polar, relation, stance, directions[:, None]))
        lengths = np.hypot(*offsets.T)
        held &= (lengths >= low) & (lengths <= high)
    return held


def _bounds(
    polar: PolarConditional, relation: Relation, stance: Stance, directions: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return from where to where a relation holds along directions (P, N): twice (P, N) [m]."""
    low, high = polar.density.bounds(stance, directions)
    distance = relation.distance
    if not isinstance(distance, Uniform):
        return np.zeros_like(low), np.full_like(high, np.inf)
    is_share = distance.high.dimension is Dimension.FRACTION and relation.arity == 2
    from_contact, to_edge = distance.low.value == 0.0, is_share and distance.high.value == 1.0
    return (np.zeros_like(low) if from_contact else low), (np.full_like(high, np.inf) if to_edge else high)
