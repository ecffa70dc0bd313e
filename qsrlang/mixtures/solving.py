"""The worlds that a question depends on, each solved and weighed: prior share times evidence."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.gaussian import definite
from qsrlang.mixtures.plans import Plan, plan_worlds
from qsrlang.mixtures.posterior import Posterior, posteriors_of
from qsrlang.mixtures.supports import Seat
from qsrlang.mixtures.worlds import MAX_WORLDS, World, enumerate_worlds
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class Solved:
    """A world, how it places things, where they are together, and its posterior weight, of a total of 1."""

    world: World
    plan: Plan
    posterior: Posterior
    weight: float

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of a thing that it places."""
        mean, covariance = self.posterior.marginal(seat)
        return mean, definite(covariance)


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """Worlds solved, best first, and the prior mass of those that were `dropped`."""

    worlds: tuple[Solved, ...]
    dropped: float


def solve_worlds(
    graph: RelationGraph,
    names: Sequence[str],
    viewer: Pose2 | None,
    limit: int = MAX_WORLDS,
    asked: Sequence[Atom] = (),
) -> Solution:
    """Return the worlds of all objects named, solved; relations of several components split them further.

    Their plans have the landmarks that bound the atoms `asked` about.
    """
    found = enumerate_worlds(graph, *names, limit=limit, in_parts=True)
    worlds = [world for world in found if world.weight > 0.0]
    plans = list(zip(worlds, plan_worlds(graph, worlds, *names, asked=asked), strict=True))
    posteriors = posteriors_of(graph, [plan for _, plan in plans], viewer)
    placed = [frozenset(name for name in names if world.named(name) in plan.seats) for world, plan in plans]
    logs = [one.log_evidence for one in posteriors]
    weights = posterior_weights([world.weight for world, _ in plans], logs, placed)
    solved = zip(plans, posteriors, weights.tolist(), strict=True)
    return Solution(tuple(Solved(*plan, joint, weight) for plan, joint, weight in solved), found.dropped)


def posterior_weights(
    priors: Sequence[float], logs: Sequence[float], placed: Sequence[frozenset[str]]
) -> FloatArray:
    """Return prior x evidence (M,), normalised to a sum of 1.

    Evidence, the agreement of what is fused, weighs worlds only against those that place the same objects: those keep
    the mass they had together.
    """
    groups: dict[frozenset[str], list[tuple[float, float]]] = defaultdict(list)
    for prior, log, names in zip(priors, logs, placed, strict=True):
        groups[names].append((prior, log))
    scales = {names: log_mean(group) for names, group in groups.items()}
    weights = np.array(
        [
            prior * math.exp(min(log - scales[names], 700.0))
            for prior, log, names in zip(priors, logs, placed, strict=True)
        ]
    )
    total = float(weights.sum())
    return weights / total if total > 0.0 else weights


def log_mean(weighted: Iterable[tuple[float, float]]) -> float:
    """Return log(sum w e^l / sum w) of weights and logs; 0 where nothing is possible at all."""
    weighted = tuple(weighted)
    top = max(log for _, log in weighted)
    if not math.isfinite(top):
        return 0.0
    total = sum(weight for weight, _ in weighted)
    return top + math.log(sum(weight * math.exp(log - top) for weight, log in weighted) / total)


def log_mean_of(logs: FloatArray) -> float:
    """Return log(mean e^l) of logs (P,); -inf where none is finite."""
    top = float(logs.max())
    return top + math.log(float(np.exp(logs - top).mean())) if math.isfinite(top) else -math.inf
