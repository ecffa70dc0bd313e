"""Draws of all the objects of a plan together, from the true densities, with no Gaussian in between."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from scipy.special import ndtri

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.densities.regions import BoxConditional
from qsrlang.mixtures.densities.stated import make_conditional
from qsrlang.mixtures.draws.bounds import Bound
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph

PER_OBJECT = 3
NO_BOUNDS: Mapping[str, tuple[Bound, ...]] = MappingProxyType({})


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """Draws of everything in a layout together: states (P, n), and log weights (P,) of what is fused.

    `clipping` (P,) are the logs of the shares of their regions that objects were drawn inside of.
    """

    layout: Layout
    states: FloatArray
    logs: FloatArray
    clipping: FloatArray

    @property
    def weights(self) -> FloatArray:
        """The log weights (P,) by what is fused and what was drawn inside of what."""
        return self.logs + self.clipping

    def at(self, chosen: BoolArray) -> Drawn:
        """Return some of the draws."""
        return Drawn(self.layout, self.states[chosen], self.logs[chosen], self.clipping[chosen])

    def points(self, seat: Seat) -> FloatArray:
        """Return where a thing is in each draw: (P, 2) [m]."""
        start, _ = self.layout.place(seat)
        return self.states[:, start : start + 2]


def width_of(plan: Plan) -> int:
    """Return how many uniform numbers one draw of a plan takes."""
    return PER_OBJECT * (len(plan.landmarks) + sum(step.places for step in plan.steps))


def draw(
    graph: RelationGraph,
    plan: Plan,
    viewer: Pose2 | None,
    uniforms: FloatArray,
    bounds: Mapping[str, tuple[Bound, ...]] = NO_BOUNDS,
) -> Drawn:
    """Draw landmarks and objects in the order of the plan, each made of three of the uniform numbers (P, width).

    Objects that lie anywhere in a region are drawn inside of the bounds given for them.
    """
    layout = plan.layout
    states = np.tile(layout.mean, (len(uniforms), 1))
    known = 3 * len(plan.landmarks)
    noisy = np.flatnonzero(layout.variance[1 : 1 + known])
    states[:, 1 + noisy] += ndtri(uniforms[:, noisy]) * np.sqrt(layout.variance[1 + noisy])
    logs, clipping = np.zeros((2, len(uniforms)))
    used = known
    for step in plan.steps:
        conditional = make_conditional(graph, step, layout.anchor, viewer)
        start, _ = layout.place(step.referent)
        place = slice(start, start + 2)
        if not step.places:
            densities = conditional.pdf(states[:, place], states)
            with np.errstate(divide="ignore"):
                logs += np.log(densities * math.pi * graph.reach**2)
            continue
        numbers = uniforms[:, used : used + PER_OBJECT]
        used += PER_OBJECT
        inside = bounds.get(step.referent.block, ())
        if inside and isinstance(conditional, BoxConditional):
            lines = [line for bound in inside for line in bound.lines(layout, states)]
            states[:, place], more = conditional.sample_inside(states, numbers, lines)
            clipping += more
        else:
            states[:, place] = conditional.sample(states, numbers)
    return Drawn(layout, states, logs, clipping)
