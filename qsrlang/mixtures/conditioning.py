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
from qsrlang.language.syntax import Formula, atoms_of
from qsrlang.mixtures.chains import placed_by
from qsrlang.mixtures.draws import draw, width_of
from qsrlang.mixtures.events import Outlook
from qsrlang.mixtures.plans import plan_world
from qsrlang.mixtures.solving import log_mean
from qsrlang.mixtures.uniforms import REPLICATES, lattices
from qsrlang.mixtures.worlds import World, enumerate_worlds
from qsrlang.relations.graph import RelationGraph

MIN_DRAWS = 100
MAX_DRAWN = 1000


@dataclass(frozen=True, slots=True)
class Condition:
    """A formula that is assumed: it holds where share is None, else it holds with this probability."""

    formula: Formula
    share: float | None
    text: str

    def factor(self, held: BoolArray) -> FloatArray:
        """Return the weight (P,) that draws get by whether the formula holds in them."""
        share = 1.0 if self.share is None else self.share
        return np.where(held, share, 1.0 - share)


@dataclass(frozen=True, slots=True)
class Drawing:
    """How scenes are drawn: how many over all worlds, by which generator, as seen by whom."""

    samples: int
    rng: np.random.Generator
    viewer: Pose2 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Scenes:
    """Draws of one world and their weights (P,); those of all worlds sum to 1."""

    outlook: Outlook
    weights: FloatArray


def objects_of(*formulas: Formula) -> tuple[str, ...]:
    """Return the names of the objects that formulas speak of."""
    names = (argument.text for one in formulas for atom in atoms_of(one) for argument in atom.arguments)
    return tuple(dict.fromkeys(names))


def conditions_on(graph: RelationGraph, names: Sequence[str], given: Formula | None) -> tuple[Condition, ...]:
    """Return what is given, and the requirements that speak of what the names depend on, or of what those do."""
    found = [] if given is None else [Condition(given, None, " ".join(given.span.text.split()))]
    open_ones = [Condition(one.formula, one.share, one.statement.text) for one in graph.requirements]
    while open_ones:
        named = [*names, *(name for one in found for name in objects_of(one.formula))]
        reached = _depends_on(graph, named)
        linked = [one for one in open_ones if reached & set(objects_of(one.formula))]
        if not linked:
            break
        found += linked
        open_ones = [one for one in open_ones if one not in linked]
    return tuple(found)


def draw_scenes(
    graph: RelationGraph, names: Sequence[str], conditions: Sequence[Condition], drawing: Drawing
) -> tuple[Scenes, ...]:
    """Return draws of every world of all objects named, weighted by shares, by evidence and by the conditions.

    Worlds share the draws by their prior weight, each with MIN_DRAWS or more; there are MAX_DRAWN worlds at most.
    Evidence, the agreement of what is fused, weighs worlds only against those that place the same objects. Raises
    ImpossibleConditionError.
    """
    objects = tuple(dict.fromkeys([*names, *objects_of(*(one.formula for one in conditions))]))
    worlds = [one for one in enumerate_worlds(graph, *objects, limit=MAX_DRAWN) if one.weight > 0.0]
    outlooks = [_outlook(graph, world, objects, drawing) for world in worlds]
    scales = _scales(outlooks, objects)
    found = []
    for outlook in outlooks:
        logs = outlook.drawn.logs
        weights = outlook.world.weight * np.exp(logs - scales[_placed(outlook, objects)]) / len(logs)
        for condition in conditions:
            weights = weights * condition.factor(outlook.holds(condition.formula))
        found.append(Scenes(outlook, weights))
    total = sum(float(one.weights.sum()) for one in found)
    if not total > 0.0:
        raise ImpossibleConditionError([one.text for one in conditions], drawing.samples)
    return tuple(Scenes(one.outlook, one.weights / total) for one in found)


def ratio_error(scenes: Iterable[Scenes], held: Iterable[BoolArray], ratio: float) -> float:
    """Return the standard error of sum w_i held_i / sum w_i, from how it differs between REPLICATES of all draws."""
    residuals = np.zeros(REPLICATES)
    for one, is_held in zip(scenes, held, strict=True):
        residuals += (one.weights * (is_held - ratio)).reshape(REPLICATES, -1).sum(axis=1)
    return float(math.sqrt(REPLICATES) * residuals.std(ddof=1))


def effective_draws(scenes: Iterable[Scenes]) -> float:
    """Return how many independent draws of equal weight would be as good: (sum w)^2 / sum w^2."""
    weights = np.concatenate([one.weights for one in scenes])
    return float(weights.sum() ** 2 / np.square(weights).sum())


def _depends_on(graph: RelationGraph, names: Iterable[str]) -> set[str]:
    """Return names with all that statements place them by, and so on, up to what landmarks place."""
    found, waiting = set(names), list(names)
    while waiting:
        fresh = {name for name in placed_by(graph, waiting.pop()) if not graph.instances_of(name)} - found
        found |= fresh
        waiting += fresh
    return found


def _outlook(graph: RelationGraph, world: World, objects: tuple[str, ...], drawing: Drawing) -> Outlook:
    plan = plan_world(graph, world, *objects)
    count = max(MIN_DRAWS, round(drawing.samples * world.weight))
    drawn = draw(graph, plan, drawing.viewer, lattices(count, width_of(plan), drawing.rng))
    return Outlook(graph, world, plan, drawn, drawing.viewer)


def _placed(outlook: Outlook, objects: Iterable[str]) -> frozenset[str]:
    return frozenset(name for name in objects if outlook.world.named(name) in outlook.plan.seats)


def _scales(outlooks: Iterable[Outlook], objects: tuple[str, ...]) -> dict[frozenset[str], float]:
    """Return, for each set of placed objects, the log of the mean evidence of its worlds, weighted by shares."""
    evidence: dict[frozenset[str], list[tuple[float, float]]] = defaultdict(list)
    for outlook in outlooks:
        logs = outlook.drawn.logs
        top = float(logs.max())
        mean = top + math.log(float(np.exp(logs - top).mean())) if math.isfinite(top) else -math.inf
        evidence[_placed(outlook, objects)].append((outlook.world.weight, mean))
    return {placed: log_mean(found) for placed, found in evidence.items()}
