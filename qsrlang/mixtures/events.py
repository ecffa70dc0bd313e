"""Whether formulas hold where objects are: relations as regions of the plane, sharp where their densities are not.

A direction holds in its arcs. A distance holds between its bounds, below where it begins at 0, and beyond where it
ends at the edge. `on` and `in` hold where the relatum's outline contains the referent, `between` where it is seen so
from either end. What is not placed holds in no relation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.geometry.angles import wrap
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Dimension, Formula, Not, Or, Uniform
from qsrlang.mixtures.conditional import Conditional, EitherConditional, PolarConditional
from qsrlang.mixtures.conditionals import make_conditional
from qsrlang.mixtures.density import Rays
from qsrlang.mixtures.draws import Drawn
from qsrlang.mixtures.plans import Plan, asked_step
from qsrlang.mixtures.sectors import Arcs, arcs_of
from qsrlang.mixtures.stance import Stance
from qsrlang.mixtures.worlds import World
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class Outlook:
    """Draws of a world, in which formulas hold or do not."""

    graph: RelationGraph
    world: World
    plan: Plan
    drawn: Drawn
    viewer: Pose2 | None

    def holds(self, formula: Formula) -> BoolArray:
        """Return in which draws (P,) a formula holds."""
        match formula:
            case Not(part=part):
                return ~self.holds(part)
            case And(parts=parts):
                return np.asarray(np.logical_and.reduce([self.holds(part) for part in parts]))
            case Or(parts=parts):
                return np.asarray(np.logical_or.reduce([self.holds(part) for part in parts]))
            case Atom():
                return self._atom_holds(formula)

    def _atom_holds(self, atom: Atom) -> BoolArray:
        step = asked_step(self.graph, self.world, self.plan.seats, atom)
        if step is None:
            return np.zeros(len(self.drawn.logs), dtype=bool)
        conditional = make_conditional(self.graph, step, self.drawn.layout.anchor, self.viewer)
        points = self.drawn.points(step.referent)
        relation = self.graph.relations[atom.relation.text]
        return _inside(conditional, relation, self.graph.relations, points, self.drawn.states)


@dataclass(frozen=True, slots=True)
class Window:
    """The part of the plane that a relation holds in, seen from where a polar density would be."""

    polar: PolarConditional
    relation: Relation
    arcs: Arcs

    def cover(self, rays: Rays, states: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return, along rays (P, N) from states (P, n), the share of each cell inside, and from where to where."""
        stance = self.polar.stance(states)
        angles = self.polar.density.hands[0] * (rays.directions - stance.axes[:, [0]])
        low, high = _bounds(self.polar, self.relation, stance, rays.directions)
        return self.arcs.cover(angles, rays.cell), low, high


def share_inside(windows: Sequence[Window], rays: Rays, states: FloatArray) -> FloatArray:
    """Return which share (P,) of the mass along rays (P, N), from states (P, n), lies inside of all windows."""
    share, low, high = np.ones_like(rays.weights), rays.low, rays.high
    for window in windows:
        cover, least, greatest = window.cover(rays, states)
        share, low, high = np.minimum(share, cover), np.maximum(low, least), np.minimum(high, greatest)
    length = rays.high - rays.low
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.where(length > 0.0, np.clip((high - low) / length, 0.0, 1.0), high >= low)
    return np.asarray((rays.weights * share * along).sum(axis=1))


def _inside(
    conditional: Conditional,
    relation: Relation,
    relations: Mapping[str, Relation],
    points: FloatArray,
    states: FloatArray,
) -> BoolArray:
    match conditional:
        case EitherConditional(first=first, second=second):
            return _inside(first, relation, relations, points, states) | _inside(
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
