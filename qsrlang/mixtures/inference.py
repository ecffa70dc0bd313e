"""From a relation graph to where a target is: worlds, each placed, weighed and made a component."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.chains import broken_chains, chain_starts
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.mixtures.plans import Plan, plan_world
from qsrlang.mixtures.reduction import MAX_COMPONENTS, reduced
from qsrlang.mixtures.resolve import Placement, definite, place_by_sampling
from qsrlang.mixtures.solving import posterior_weights, solve_worlds
from qsrlang.mixtures.worlds import MAX_WORLDS, enumerate_worlds
from qsrlang.relations.graph import Landmark, RelationGraph

MIN_WEIGHT = 1e-12


@dataclass(frozen=True, slots=True)
class Bounds:
    """How many worlds are weighed, and how many components an answer has, at most."""

    worlds: int = MAX_WORLDS
    components: int = MAX_COMPONENTS


def where_exactly(graph: RelationGraph, target: str, viewer: Pose2 | None, bounds: Bounds) -> Where:
    """Return where a target is in the map frame; raises UnreachedTargetError, NoRoomError and MissingFacingError."""
    solution = solve_worlds(graph, (target,), viewer, bounds.worlds)
    placed = [one for one in solution.worlds if one.places(target)]
    components = []
    for one in placed:
        mean, covariance = one.posterior.marginal(one.plan.seats[one.world.named(target)])
        components.append(Component(one.weight, mean, definite(covariance), statements_of(one.plan)))
    return _answer(graph, target, components, solution.dropped, bounds.components)


def where_by_sampling(
    graph: RelationGraph, target: str, viewer: Pose2 | None, samples: int, rng: np.random.Generator
) -> Where:
    """Return the same as the paper finds it, from `samples` draws of every world."""
    worlds = enumerate_worlds(graph, target)
    plans = [(world, plan_world(graph, world, target)) for world in worlds if world.weight > 0.0]
    found: list[Placement | None] = [
        place_by_sampling(graph, plan, world.named(target), viewer, samples, rng)
        if world.named(target) in plan.seats
        else None
        for world, plan in plans
    ]
    logs = [0.0 if one is None else one.log_evidence for one in found]
    placed = [frozenset(() if one is None else (target,)) for one in found]
    weights = posterior_weights([world.weight for world, _ in plans], logs, placed)
    components = [
        Component(float(weight), one.mean, one.covariance, statements_of(plan))
        for weight, one, (_, plan) in zip(weights, found, plans, strict=True)
        if one is not None
    ]
    return _answer(graph, target, components, worlds.dropped, MAX_COMPONENTS)


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


def statements_of(plan: Plan) -> tuple[str, ...]:
    """Return the statements behind a plan, each once."""
    return tuple(dict.fromkeys(str(constraint.statement) for constraint in plan.constraints))


def _answer(
    graph: RelationGraph, target: str, components: Sequence[Component], dropped: float, limit: int
) -> Where:
    """Return components as an answer; those of less than MIN_WEIGHT are left out, and the rest reduced to `limit`."""
    claimed = sum(component.weight for component in components)
    if not claimed > 0.0:
        raise UnreachedTargetError(target, broken_chains(graph, target))
    kept = [one for one in components if one.weight >= MIN_WEIGHT * claimed]
    chosen = reduced(kept, limit)
    elsewhere = 1.0 - claimed if claimed < 1.0 - MIN_WEIGHT else 0.0
    return Where(target, "map", mixture_of(chosen), elsewhere, chosen, dropped=dropped)
