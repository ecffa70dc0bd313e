"""Knowledge under assumptions: weighted draws of whole scenes, in which what is given or required holds."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import ImpossibleConditionError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.draws.bounding import bounds_of, conjuncts, tightest_first
from qsrlang.mixtures.draws.conditions import Condition, assumed_atoms, objects_of
from qsrlang.mixtures.draws.drawing import draw, width_of
from qsrlang.mixtures.draws.events import Outlook
from qsrlang.mixtures.draws.uniforms import REPLICATES, lattices
from qsrlang.mixtures.gaussian import fitted
from qsrlang.mixtures.solving.weighing import log_mean, log_mean_of
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.planned import planned_worlds
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph

MIN_DRAWS = 100
MAX_DRAWN = 1000


@dataclass(frozen=True, slots=True)
class Drawing:
    """How scenes are drawn: how many over all worlds, by which generator, as seen by whom."""

    samples: int
    rng: np.random.Generator
    viewer: Pose2 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class WorldDraws:
    """Draws of one world and their weights (P,), of a total of 1 over all worlds."""

    outlook: Outlook
    weights: FloatArray

    @property
    def world(self) -> World:
        """The alternatives that hold in it."""
        return self.outlook.world

    @property
    def plan(self) -> Plan:
        """How it places things."""
        return self.outlook.plan

    @property
    def weight(self) -> float:
        """The weight of its draws together."""
        return float(self.weights.sum())

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of the draws of a thing."""
        return fitted(self.outlook.drawn.points(seat), self.weights)


def draw_scenes(
    graph: RelationGraph,
    names: Sequence[str],
    conditions: Sequence[Condition],
    drawing: Drawing,
    asked: Sequence[Atom] = (),
) -> tuple[tuple[WorldDraws, ...], float]:
    """Return draws of every world of all objects named, weighted by shares, by evidence and by the conditions, and
    the prior mass of the worlds left out.

    Worlds share the draws by their prior weight, each with MIN_DRAWS or more; there are MAX_DRAWN worlds at most.
    Evidence, the agreement of what is fused, weighs worlds only against those that place the same objects. Raises
    ImpossibleConditionError.
    """
    objects = tuple(dict.fromkeys([*names, *objects_of(*(one.formula for one in conditions))]))
    asked = (*asked, *assumed_atoms(conditions))
    worlds, plans, dropped = planned_worlds(graph, objects, MAX_DRAWN, asked)
    drawn = [
        _drawn(graph, world, plan, conditions, drawing) for world, plan in zip(worlds, plans, strict=True)
    ]
    scales = _scales([outlook for outlook, _ in drawn], objects)
    found = []
    for outlook, factors in drawn:
        prior = outlook.world.weight / len(factors)
        evidence = np.exp(outlook.drawn.weights - scales[_placed(outlook, objects)])
        found.append(WorldDraws(outlook, prior * evidence * factors))
    total = sum(float(one.weights.sum()) for one in found)
    if not total > 0.0:
        raise ImpossibleConditionError([one.text for one in conditions], drawing.samples)
    return tuple(WorldDraws(one.outlook, one.weights / total) for one in found), dropped


def ratio_error(scenes: Iterable[WorldDraws], held: Iterable[BoolArray], ratio: float) -> float:
    """Return the standard error of sum w_i held_i / sum w_i, from how it differs between REPLICATES of all draws."""
    residuals = np.zeros(REPLICATES)
    for one, is_held in zip(scenes, held, strict=True):
        residuals += (one.weights * (is_held - ratio)).reshape(REPLICATES, -1).sum(axis=1)
    return float(math.sqrt(REPLICATES) * residuals.std(ddof=1))


def effective_draws(scenes: Iterable[WorldDraws]) -> float:
    """Return how many independent draws of equal weight would be as good: (sum w)^2 / sum w^2."""
    weights = np.concatenate([one.weights for one in scenes])
    return float(weights.sum() ** 2 / np.square(weights).sum())


def _drawn(
    graph: RelationGraph,
    world: World,
    plan: Plan,
    conditions: Sequence[Condition],
    drawing: Drawing,
) -> tuple[Outlook, FloatArray]:
    """Return draws of a world, and the factor (P,) of each by the conditions that it was not drawn inside of."""
    parts = conjuncts(conditions)
    plan = tightest_first(graph, world, plan, parts)
    bounds, rest = bounds_of(graph, world, plan, parts, drawing.viewer)
    count = max(MIN_DRAWS, round(drawing.samples * world.weight))
    uniforms = lattices(count, width_of(plan), drawing.rng)
    outlook = Outlook(graph, world, plan, draw(graph, plan, drawing.viewer, uniforms, bounds), drawing.viewer)
    return outlook, factors_of(outlook, rest)


def factors_of(outlook: Outlook, conditions: Iterable[Condition]) -> FloatArray:
    """Return the weight (P,) of each draw by whether conditions hold in it."""
    factors = np.ones(len(outlook.drawn.logs))
    for condition in conditions:
        factors *= condition.factor(outlook.holds(condition.formula))
    return factors


def _placed(outlook: Outlook, objects: Iterable[str]) -> frozenset[str]:
    return frozenset(name for name in objects if outlook.world.named(name) in outlook.plan.seats)


def _scales(outlooks: Iterable[Outlook], objects: tuple[str, ...]) -> dict[frozenset[str], float]:
    """Return, for each set of placed objects, the log of the mean evidence of its worlds, weighted by shares."""
    evidence: dict[frozenset[str], list[tuple[float, float]]] = defaultdict(list)
    for outlook in outlooks:
        weighted = (outlook.world.weight, log_mean_of(outlook.drawn.logs))
        evidence[_placed(outlook, objects)].append(weighted)
    return {placed: log_mean(found) for placed, found in evidence.items()}
