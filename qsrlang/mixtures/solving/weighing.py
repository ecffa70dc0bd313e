"""The worlds that a question depends on, each solved and weighed: prior share times evidence."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.gaussian import definite
from qsrlang.mixtures.solving.posterior import Posterior, posterior_of, posteriors_of
from qsrlang.mixtures.worlds.enumeration import MAX_WORLDS, World
from qsrlang.mixtures.worlds.planned import PlannedWorlds, planned_worlds
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True, eq=False)
class Solved:
    """A world, how it places things, its posterior weight, of a total of 1, and, once asked for, where they are."""

    world: World
    plan: Plan
    weight: float
    joint: Callable[[], Posterior]

    @property
    def posterior(self) -> Posterior:
        """Where all things are together."""
        return self.joint()

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of a thing that it places."""
        mean, covariance = self.posterior.marginal(seat)
        return mean, definite(covariance)


@dataclass(frozen=True, slots=True, eq=False)
class Assumed:
    """A world under conditions: its posterior weight given those; things are placed as without them."""

    solved: Solved
    weight: float

    @property
    def world(self) -> World:
        """The alternatives that hold in it."""
        return self.solved.world

    @property
    def plan(self) -> Plan:
        """How it places things."""
        return self.solved.plan

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of a thing that it places."""
        return self.solved.place(seat)


@dataclass(frozen=True, slots=True, eq=False)
class SolvedWorlds:
    """Worlds solved, best first, the prior mass of those that were `dropped`, and what they were solved from."""

    worlds: tuple[Solved, ...]
    dropped: float
    planned: PlannedWorlds


def solve_worlds(
    graph: RelationGraph,
    names: Sequence[str],
    viewer: Pose2 | None,
    limit: int = MAX_WORLDS,
    asked: Sequence[Atom] = (),
    is_needed: bool = True,
) -> SolvedWorlds:
    """Return the worlds of all objects named, solved; relations of several components split them further.

    Their plans have the landmarks that bound the atoms `asked` about. Where all places are not needed, and no world is
    to be weighed by them, they are found when they are asked for.
    """
    planned = planned_worlds(graph, tuple(names), limit, asked, in_parts=True)
    key = (id(planned), viewer, is_needed)
    return graph.derived(
        key, lambda: _solved(graph, planned, names, viewer, is_needed), lambda found: len(found.worlds)
    )


def _solved(
    graph: RelationGraph,
    planned: PlannedWorlds,
    names: Sequence[str],
    viewer: Pose2 | None,
    is_needed: bool,
) -> SolvedWorlds:
    worlds, plans, dropped = planned
    if is_needed or any(plan.fused for plan in plans):
        posteriors = posteriors_of(graph, plans, viewer)
        joints: list[Callable[[], Posterior]] = [partial(_given, one) for one in posteriors]
        logs = [one.log_evidence for one in posteriors]
    else:
        joints = [cache(partial(posterior_of, graph, plan, viewer)) for plan in plans]
        logs = [0.0] * len(plans)
    placed = [
        frozenset(name for name in names if world.named(name) in plan.seats)
        for world, plan in zip(worlds, plans, strict=True)
    ]
    weights = posterior_weights([world.weight for world in worlds], logs, placed).tolist()
    solved = zip(worlds, plans, weights, joints, strict=True)
    return SolvedWorlds(tuple(Solved(*one) for one in solved), dropped, planned)


def _given(posterior: Posterior) -> Posterior:
    return posterior


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
