"""From a relation graph to where a target is: worlds, each placed, weighed and made a component."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.chains import broken_chains, chain_starts
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.mixtures.plans import Plan, plan_world
from qsrlang.mixtures.resolve import Placement, place_by_sampling, place_exactly
from qsrlang.mixtures.worlds import World, enumerate_worlds
from qsrlang.relations.graph import Landmark, RelationGraph


@dataclass(frozen=True, slots=True)
class Engine:
    """How worlds are placed: by exact moments, or, where there is a generator, by draws as in the paper."""

    samples: int = 0
    rng: np.random.Generator | None = None

    def place(self, graph: RelationGraph, plan: Plan, target: str, viewer: Pose2 | None) -> Placement:
        """Return where a plan puts the target."""
        if self.rng is None:
            return place_exactly(graph, plan, target, viewer)
        return place_by_sampling(graph, plan, target, viewer, self.samples, self.rng)


def where_on_map(graph: RelationGraph, target: str, viewer: Pose2 | None, engine: Engine) -> Where:
    """Return where a target is in the map frame; raises UnreachedTargetError, NoRoomError and MissingFacingError."""
    plans = ((world, plan_world(graph, world, target)) for world in enumerate_worlds(graph, target))
    placed = [
        (world, engine.place(graph, plan, world.named(target), viewer))
        for world, plan in plans
        if world.named(target) in plan.seats and world.weight > 0.0
    ]
    if not placed:
        raise UnreachedTargetError(target, broken_chains(graph, target))
    claimed = sum(world.weight for world, _ in placed)
    weights = _posterior(placed) * min(claimed, 1.0)
    components = [
        Component(float(weight), placement.mean, placement.covariance, _statements(placement))
        for weight, (_, placement) in zip(weights, placed, strict=True)
    ]
    components.sort(key=lambda component: (-component.weight, *component.mean))
    return Where(target, "map", mixture_of(components), max(0.0, 1.0 - claimed), tuple(components))


def alone_with(graph: RelationGraph, relatum: str) -> RelationGraph:
    """Return the graph with the relatum at the origin, the viewer's axis along +x, and no other landmark."""
    virtual = Landmark(relatum, graph.class_of(relatum), 0.0, 0.0, heading=math.pi)
    return replace(graph, landmarks=(virtual,))


def rooted(graph: RelationGraph, names: Sequence[str]) -> RelationGraph:
    """Return the graph; where no landmark is known, with the one class at the origin that all names hang on.

    Raises UnreachedTargetError where they hang on several.
    """
    if graph.landmarks:
        return graph
    starts = dict.fromkeys(start for name in names for start in chain_starts(graph, name) or (name,))
    if len(starts) != 1:
        raise UnreachedTargetError(" and ".join(names), [f"{start} has no landmark" for start in starts])
    return alone_with(graph, *starts)


def in_frame(
    graph: RelationGraph, target: str, wrt: str | None, solve: Callable[[RelationGraph], Where]
) -> Where:
    """Return an answer on the map; with `wrt`, relative to that; where no landmark is known, relative to the class,
    of those the target's chains start from, that tells the most.
    """
    if wrt is None and graph.landmarks:
        return solve(graph)
    answers, failures = [], []
    for relatum in chain_starts(graph, target) if wrt is None else (wrt,):
        try:
            answers.append(replace(solve(alone_with(graph, relatum)), frame=relatum))
        except UnreachedTargetError as error:
            failures.append(error)
    if not answers:
        raise failures[0] if failures else UnreachedTargetError(target, broken_chains(graph, target))
    return max(answers, key=lambda answer: 1.0 - answer.elsewhere)


def mixture_of(components: Sequence[Component]) -> GaussianMixture:
    """Return components as a mixture, their weights normalised."""
    shares = np.array([component.weight for component in components])
    means = np.array([component.mean for component in components])
    covariances = np.array([component.covariance for component in components])
    return GaussianMixture(shares / shares.sum(), means, covariances)


def _posterior(placed: Sequence[tuple[World, Placement]]) -> FloatArray:
    """Return the worlds' weights, prior times evidence, normalised."""
    logs = np.array([math.log(world.weight) + placement.log_evidence for world, placement in placed])
    weights = np.exp(logs - logs.max())
    return np.asarray(weights / weights.sum())


def _statements(placement: Placement) -> tuple[str, ...]:
    return tuple(dict.fromkeys(str(constraint.statement) for constraint in placement.constraints))
