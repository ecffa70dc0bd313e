"""From a step of a plan to what it says of its referent, given states laid out in columns."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.densities.conditional import Conditional, FitConditional, frame_of, polar_conditional
from qsrlang.mixtures.densities.regions import region_conditional
from qsrlang.mixtures.densities.standpoint import Anchor, Standpoint
from qsrlang.mixtures.worlds.plans import Step
from qsrlang.mixtures.worlds.supports import Seat, in_region
from qsrlang.relations.graph import RelationGraph

Anchors: TypeAlias = Callable[[Seat], Anchor]


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
