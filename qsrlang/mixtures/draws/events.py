"""In which draws of a world formulas hold; what is not placed holds in no relation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Formula, Not, Or
from qsrlang.mixtures.densities.stated import make_conditional
from qsrlang.mixtures.densities.windows import holds_at
from qsrlang.mixtures.draws.drawing import Drawn
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.plans import Plan, asked_step
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
        return holds_at(conditional, relation, self.graph.relations, points, self.drawn.states)
