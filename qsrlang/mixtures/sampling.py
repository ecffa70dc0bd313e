"""Worlds placed as the paper does: by a Gaussian fit to draws of every object of the chain in turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.draws.drawing import Drawn, draw, width_of
from qsrlang.mixtures.draws.uniforms import independent
from qsrlang.mixtures.gaussian import fitted
from qsrlang.mixtures.solving.weighing import log_mean_of, posterior_weights
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.planned import planned_worlds
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class SampledWorld:
    """A world, its draws, and its posterior weight."""

    world: World
    plan: Plan
    drawn: Drawn
    weight: float

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of the draws of a thing, weighted by what is fused."""
        logs = self.drawn.logs
        return fitted(self.drawn.points(seat), np.exp(logs - logs.max()))


def sampled_worlds(
    graph: RelationGraph, target: str, viewer: Pose2 | None, samples: int, rng: np.random.Generator
) -> tuple[Sequence[SampledWorld], float]:
    """Return every world of a target with `samples` draws, and the prior mass of those left out."""
    worlds, plans, dropped = planned_worlds(graph, (target,))
    drawn = [draw(graph, plan, viewer, independent(samples, width_of(plan), rng)) for plan in plans]
    logs = [log_mean_of(one.logs) for one in drawn]
    if not np.isfinite(logs).any():
        raise UnreachedTargetError(target, ["its statements contradict each other in every sample"])
    placed = [
        frozenset((target,) if world.named(target) in plan.seats else ())
        for world, plan in zip(worlds, plans, strict=True)
    ]
    weights = posterior_weights([world.weight for world in worlds], logs, placed).tolist()
    return [SampledWorld(*one) for one in zip(worlds, plans, drawn, weights, strict=True)], dropped
