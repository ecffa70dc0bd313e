"""From a step of a plan to what it says of its referent, given states laid out in columns."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Frame
from qsrlang.mixtures.densities.conditional import (
    Conditional,
    FitConditional,
    PolarConditional,
    frame_of,
    half_box_of,
    polar_conditional,
    product_of,
)
from qsrlang.mixtures.densities.regions import region_conditional
from qsrlang.mixtures.densities.stance import Boxes
from qsrlang.mixtures.densities.standpoint import Anchor, Standpoint
from qsrlang.mixtures.worlds.plans import Step
from qsrlang.mixtures.worlds.supports import Seat, in_region
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import RelationGraph

Anchors: TypeAlias = Callable[[Seat], Anchor]


class Words(NamedTuple):
    """What a constraint says of two things, whatever those are called and wherever they are.

    Relations, each in a frame, which part (j, k) of their mass, half boxes of referent and relatum [m], and the graph's
    reach [m].
    """

    relations: tuple[Relation, ...]
    frames: tuple[Frame, ...]
    part: tuple[int, int]
    referent: tuple[float, float]
    relatum: tuple[float, float]
    reach: float

    @classmethod
    def of(cls, graph: RelationGraph, step: Step) -> Words | None:
        """Return the words of a step; None where more than two things, a support, a fit or a region tells."""
        said = step.constraint
        if step.second is not None or step.support is not None or said.fit is not None or in_region(said):
            return None
        relations = tuple([atom.relation for atom in said.atoms])
        frames = tuple([atom.frame for atom in said.atoms])
        referent, relatum = half_box_of(graph, said.referent), half_box_of(graph, said.relatum)
        return cls(relations, frames, said.part, referent, relatum, graph.reach)

    def conditional(self, has_heading: bool) -> PolarConditional:
        """Return the density about a relatum in columns x, y and, if it has one, heading, seen from no other place."""
        boxes = Boxes(self.referent, self.relatum)
        density, frames = product_of(self.relations, self.frames, boxes, None, self.reach, "")
        standpoint = Standpoint(Anchor(0, 2 if has_heading else None, ""))
        return PolarConditional(density, frames, standpoint, self.part)


def make_conditional(graph: RelationGraph, step: Step, anchor: Anchors, viewer: Pose2 | None) -> Conditional:
    """Return what a step's constraint says of its referent, given states in which `anchor` finds things."""
    constraint = step.constraint
    support = None if step.support is None else anchor(step.support.seat)
    second = None if step.second is None else anchor(step.second)
    standpoint = Standpoint(anchor(step.relatum), second, viewer, support)
    if constraint.fit is not None:
        return FitConditional(constraint.fit, frame_of(constraint, constraint.atoms[0]), standpoint)
    if in_region(constraint):
        return region_conditional(graph, constraint, standpoint)
    return polar_conditional(graph, constraint, standpoint, step.support)
