"""Whether formulas hold where objects are: relations as regions of the plane, sharp where their densities are not.

A direction holds where no relation that it excludes is nearer, in deviations of its angle (the four directions are
quarters); one that excludes none, within the central 95 % of its angle. A distance holds between its bounds, below
where it begins at 0, and beyond where it ends at the edge. `on` and `in` hold where the relatum's outline contains the
referent, `between` where it is seen so from either end. What is not placed holds in no relation.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.geometry.angles import wrap
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Density, Dimension, Formula, Normal, Not, Or, Uniform
from qsrlang.mixtures.conditional import Conditional, EitherConditional, PolarConditional
from qsrlang.mixtures.plans import Plan, step_of
from qsrlang.mixtures.resolve import Drawn, make_conditional
from qsrlang.mixtures.stance import Stance
from qsrlang.mixtures.worlds import World
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import AtomicRelation, Constraint, RelationGraph, Statement

CENTRAL_95 = 1.959963984540054


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
        names = [self.world.named(argument.text) for argument in atom.arguments]
        if any(name not in self.plan.seats for name in names):
            return np.zeros(len(self.drawn.logs), dtype=bool)
        referent, relatum, *towards = names
        said = Constraint(
            referent, relatum, (), Statement.at(atom.span), None, towards[0] if towards else None
        )
        points = self.drawn.points(self.plan.seats[referent].block)
        terms = [term for _, term in self.graph.relations[atom.relation.text].terms]
        held = [
            self._term_holds(replace(said, atoms=(AtomicRelation(term, atom.frame),)), points)
            for term in terms
        ]
        return np.asarray(np.logical_or.reduce(held))

    def _term_holds(self, said: Constraint, points: FloatArray) -> BoolArray:
        step = step_of(self.graph, said, self.plan.seats)
        conditional = make_conditional(self.graph, step, self.drawn.blocks, self.viewer)
        return _inside(conditional, said.atoms[0].relation, self.graph, points, self.drawn.states)


def _inside(
    conditional: Conditional, relation: Relation, graph: RelationGraph, points: FloatArray, states: FloatArray
) -> BoolArray:
    match conditional:
        case EitherConditional(first=first, second=second):
            return _inside(first, relation, graph, points, states) | _inside(
                second, relation, graph, points, states
            )
        case PolarConditional():
            return _within(conditional, relation, graph.relations, points, states)
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
        held &= _turned(relation, relations, angles)
    if relation.distance is not None:
        held &= _reached(polar, relation, stance, directions, np.hypot(*offsets.T))
    return held


def _turned(relation: Relation, relations: Mapping[str, Relation], angles: FloatArray) -> BoolArray:
    own = _deviations(relation.angle, angles)
    terms = [term for name in relation.disjoint for _, term in relations[name].terms]
    rivals = [_deviations(term.angle, angles) for term in terms if term.angle is not None]
    if not rivals:
        return np.asarray(own <= CENTRAL_95)
    return np.asarray((own <= np.minimum.reduce(rivals)) & np.isfinite(own))


def _deviations(angle: Density | None, angles: FloatArray) -> FloatArray:
    """Return how far angles (P,) are from a density's middle, in its deviations; 0 inside an arc, infinite outside."""
    match angle:
        case Normal(mean=mean, deviation=deviation):
            return np.asarray(np.abs(wrap(angles - mean.value)) / deviation.value)
        case Uniform(low=low, high=high):
            middle, half = 0.5 * (low.value + high.value), 0.5 * (high.value - low.value)
            return np.where(np.abs(wrap(angles - middle)) <= half, 0.0, np.inf)
        case _:
            return np.zeros_like(angles)


def _reached(
    polar: PolarConditional, relation: Relation, stance: Stance, directions: FloatArray, lengths: FloatArray
) -> BoolArray:
    distance = relation.distance
    if not isinstance(distance, Uniform):
        return np.ones(len(lengths), dtype=bool)
    low, high = (bound[:, 0] for bound in polar.density.bounds(stance, directions[:, None]))
    from_contact = distance.low.value == 0.0
    is_share = distance.high.dimension is Dimension.FRACTION and relation.arity == 2
    to_edge = is_share and distance.high.value == 1.0
    return ((lengths >= low) | from_contact) & ((lengths <= high) | to_edge)
