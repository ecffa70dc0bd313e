"""Draws of all the objects of a plan together, from the true densities, with no Gaussian in between."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.conditionals import make_conditional
from qsrlang.mixtures.layout import Layout
from qsrlang.mixtures.plans import Plan
from qsrlang.mixtures.supports import Seat
from qsrlang.relations.graph import RelationGraph

PER_OBJECT = 3


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """Draws of everything in a layout together: states (P, n), and log weights (P,) of what is fused."""

    layout: Layout
    states: FloatArray
    logs: FloatArray

    def points(self, seat: Seat) -> FloatArray:
        """Return where a thing is in each draw: (P, 2) [m]."""
        start, _ = self.layout.place(seat)
        return self.states[:, start : start + 2]


def width_of(plan: Plan) -> int:
    """Return how many uniform numbers one draw of a plan takes."""
    return PER_OBJECT * (len(plan.landmarks) + sum(step.places for step in plan.steps))


def draw(graph: RelationGraph, plan: Plan, viewer: Pose2 | None, uniforms: FloatArray) -> Drawn:
    """Draw landmarks and objects in the order of the plan, each made of three of the uniform numbers (P, width)."""
    layout = plan.layout
    states = np.tile(layout.mean, (len(uniforms), 1))
    known = 3 * len(plan.landmarks)
    noisy = np.flatnonzero(layout.variance[1 : 1 + known])
    states[:, 1 + noisy] += ndtri(uniforms[:, noisy]) * np.sqrt(layout.variance[1 + noisy])
    logs = np.zeros(len(uniforms))
    used = known
    for step in plan.steps:
        conditional = make_conditional(graph, step, layout.anchor, viewer)
        start, _ = layout.place(step.referent)
        place = slice(start, start + 2)
        if step.places:
            states[:, place] = conditional.sample(states, uniforms[:, used : used + PER_OBJECT])
            used += PER_OBJECT
        else:
            densities = conditional.pdf(states[:, place], states)
            with np.errstate(divide="ignore"):
                logs += np.log(densities * math.pi * graph.reach**2)
    return Drawn(layout, states, logs)
