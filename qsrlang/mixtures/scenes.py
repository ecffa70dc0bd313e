"""Joint scenes: all objects drawn together from the true densities, without boxes that overlap."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import ImpossibleConditionError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.draws.bounding import bounds_of, conjuncts, tightest_first
from qsrlang.mixtures.draws.bounds import Bound
from qsrlang.mixtures.draws.collisions import Body, collide, pairs_apart
from qsrlang.mixtures.draws.conditioning import MAX_DRAWN, factors_of
from qsrlang.mixtures.draws.conditions import Condition, assumed_atoms, objects_of
from qsrlang.mixtures.draws.drawing import Drawn, draw, width_of
from qsrlang.mixtures.draws.events import Outlook
from qsrlang.mixtures.draws.uniforms import independent
from qsrlang.mixtures.solving.weighing import log_mean, log_mean_of
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.planned import planned_worlds
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.relations.graph import RelationGraph

CHUNK = 8192
PILOT = 2048
MAX_DRAWS_PER_SCENE = 20_000


@dataclass(frozen=True, slots=True, eq=False)
class SceneSamples:
    """Joint scenes: where each of N things is in each of S scenes.

    `positions` (S, N, 2) [m] and `headings` (S, N) [rad] in the `frame`, as that of `Where`, not a number for what is
    elsewhere; `drawn` is how many scenes were drawn to find them, for those that collide or break a requirement are
    drawn again.
    """

    names: tuple[str, ...]
    positions: FloatArray
    headings: FloatArray
    drawn: int
    assumed: tuple[str, ...] = ()
    frame: str = "map"
    draws: None = None

    def __len__(self) -> int:
        return len(self.positions)

    def to_json(self) -> dict[str, object]:
        """Return the scenes as plain data: of every thing the pose [x, y, heading], null for what is elsewhere."""
        poses = np.concatenate([self.positions, self.headings[..., None]], axis=2)
        scenes = [
            {
                name: pose.tolist() if np.isfinite(pose[:2]).all() else None
                for name, pose in zip(self.names, scene, strict=True)
            }
            for scene in poses
        ]
        return {"frame": self.frame, "scenes": scenes, "drawn": self.drawn, "assumed": list(self.assumed)}

    def summary(self) -> Iterator[tuple[str, float, FloatArray, FloatArray]]:
        """Yield, of each thing, in which share of the scenes it is, and mean and deviation (2,) of where [m]."""
        for at, name in enumerate(self.names):
            there = self.positions[np.isfinite(self.positions[:, at, 0]), at]
            spread = (there.mean(axis=0), there.std(axis=0)) if len(there) else (np.full(2, np.nan),) * 2
            yield name, len(there) / len(self), *spread

    def __str__(self) -> str:
        scenes, things = (
            f"{n} {what}{'s' * (n != 1)}" for n, what in ((len(self), "scene"), (len(self.names), "thing"))
        )
        rows = [f"{scenes} of {things}, {self.drawn} drawn, frame: {self.frame}"]
        for name, share, mean, (dx, dy) in self.summary():
            x, y = mean.round(3) + 0.0
            rest = f", in {share:.1%} of them" if share < 1.0 else ""
            rows.append(f"{name:>16}  x {x:.3f} ± {dx:.3f}, y {y:.3f} ± {dy:.3f} m{rest}")
        return "\n".join(rows)


@dataclass(frozen=True, slots=True, eq=False)
class _Source:
    """A world to draw from: what is drawn inside of what, which conditions remain, and which boxes must not overlap."""

    graph: RelationGraph
    world: World
    plan: Plan
    bounds: Mapping[str, tuple[Bound, ...]]
    conditions: tuple[Condition, ...]
    apart: tuple[tuple[Body, Body], ...]
    viewer: Pose2 | None

    def drawn(self, count: int, rng: np.random.Generator) -> Drawn:
        """Return scenes, those that collide or break a condition among them."""
        uniforms = independent(count, width_of(self.plan), rng)
        return draw(self.graph, self.plan, self.viewer, uniforms, self.bounds)

    def passes(self, drawn: Drawn, rng: np.random.Generator) -> BoolArray:
        """Return which scenes (P,) pass: each condition with its probability, and then none that collide."""
        outlook = Outlook(self.graph, self.world, self.plan, drawn, self.viewer)
        passes = rng.random(len(drawn.logs)) < factors_of(outlook, self.conditions)
        passes[passes] = ~collide(self.apart, drawn.at(passes))
        return passes

    @property
    def is_even(self) -> bool:
        """Whether all scenes weigh the same."""
        return not (self.plan.fused or self.bounds)


def sample_scenes(
    graph: RelationGraph,
    names: Sequence[str],
    count: int,
    conditions: Sequence[Condition],
    viewer: Pose2 | None,
    rng: np.random.Generator,
) -> SceneSamples:
    """Return `count` independent joint scenes of the things named, given that no boxes overlap and conditions hold.

    Rejection: a scene of weight w stays with probability w / bound. Where weights differ the bound is the greatest
    weight seen so far, and what was kept under a smaller one is thinned to the new one (Caffo, Booth and Davis 2002).
    Raises ImpossibleConditionError beyond MAX_DRAWS_PER_SCENE draws for each scene.
    """
    sources = _sources(graph, names, conditions, viewer)
    priors = np.array([one.world.weight for one in sources])
    scales, bound = _pilot(sources, names, rng)
    kept = _Kept(len(names), bound)
    while len(kept.positions) < count:
        if kept.draws > MAX_DRAWS_PER_SCENE * (count + 1):
            raise ImpossibleConditionError([one.text for one in conditions], kept.draws)
        counts = rng.multinomial(kept.batch(count), priors / priors.sum())
        found = [
            _chosen(source, names, scale, kept, int(number), rng)
            for source, scale, number in zip(sources, scales, counts, strict=True)
            if number
        ]
        positions, headings = (np.concatenate(parts) for parts in zip(*found, strict=True))
        kept.add(positions, headings, rng)
    texts = tuple(dict.fromkeys(one.text for one in conditions))
    return SceneSamples(tuple(names), *kept.first(count), kept.draws, texts)


class _Kept:
    """The scenes that are kept so far, under a bound on log weights, and how many were drawn."""

    def __init__(self, things: int, bound: float) -> None:
        self.positions = np.empty((0, things, 2))
        self.headings = np.empty((0, things))
        self.bound, self.draws = bound, 0

    def batch(self, count: int) -> int:
        """Return how many scenes to draw next, by how many of those before were kept."""
        share = max(len(self.positions) / self.draws if self.draws else 0.5, 1e-3)
        return int(np.clip(1.1 * (count - len(self.positions)) / share + 16, 64, CHUNK))

    def chosen(self, logs: FloatArray, rng: np.random.Generator) -> BoolArray:
        """Return which draws of these log weights (P,) stay; if one is above the bound, it becomes the bound."""
        self.draws += len(logs)
        top = float(logs.max(initial=-math.inf))
        if top > self.bound:
            stays = rng.random(len(self.positions)) < math.exp(self.bound - top)
            self.positions, self.headings, self.bound = self.positions[stays], self.headings[stays], top
        return np.asarray(np.log(rng.random(len(logs))) < logs - self.bound)

    def add(self, positions: FloatArray, headings: FloatArray, rng: np.random.Generator) -> None:
        """Take in scenes (S, N, 2) and (S, N), in an order that tells nothing of their worlds."""
        order = rng.permutation(len(positions))
        self.positions = np.concatenate([self.positions, positions[order]])
        self.headings = np.concatenate([self.headings, headings[order]])

    def first(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Return the first of the scenes."""
        return self.positions[:count], self.headings[:count]


def _sources(
    graph: RelationGraph, names: Sequence[str], conditions: Sequence[Condition], viewer: Pose2 | None
) -> list[_Source]:
    objects = tuple(dict.fromkeys([*names, *objects_of(*(one.formula for one in conditions))]))
    parts = conjuncts(conditions)
    worlds, plans, _ = planned_worlds(graph, objects, MAX_DRAWN, assumed_atoms(conditions))
    sources = []
    for world, plan in zip(worlds, plans, strict=True):
        ordered = tightest_first(graph, world, plan, parts)
        bounds, rest = bounds_of(graph, world, ordered, parts, viewer)
        sources.append(_Source(graph, world, ordered, bounds, rest, pairs_apart(graph, plan), viewer))
    return sources


def _pilot(
    sources: Sequence[_Source], names: Sequence[str], rng: np.random.Generator
) -> tuple[list[float], float]:
    """Return, for each world, by what its evidence is scaled, and the greatest log weight of all.

    Evidence weighs worlds only against those that place the same objects.
    """
    if all(one.is_even for one in sources):
        return [0.0] * len(sources), 0.0
    drawn = [one.drawn(PILOT, rng) for one in sources]
    groups: dict[frozenset[str], list[tuple[float, float]]] = {}
    keys = [frozenset(name for name in names if one.world.named(name) in one.plan.seats) for one in sources]
    for key, source, one in zip(keys, sources, drawn, strict=True):
        groups.setdefault(key, []).append((source.world.weight, log_mean_of(one.logs)))
    scales = [log_mean(groups[key]) for key in keys]
    tops = [float(one.weights.max()) - scale for one, scale in zip(drawn, scales, strict=True)]
    return scales, max(tops)


def _chosen(
    source: _Source,
    names: Sequence[str],
    scale: float,
    kept: _Kept,
    count: int,
    rng: np.random.Generator,
) -> tuple[FloatArray, FloatArray]:
    """Return positions (S, N, 2) and headings (S, N) in the scenes that stay, of `count` that are drawn of a world."""
    drawn = source.drawn(count, rng)
    drawn = drawn.at(kept.chosen(drawn.weights - scale, rng))
    drawn = drawn.at(source.passes(drawn, rng))
    positions = np.full((len(drawn.logs), len(names), 2), np.nan)
    headings = np.full((len(drawn.logs), len(names)), np.nan)
    for at, name in enumerate(names):
        seat = source.plan.seats.get(source.world.named(name))
        if seat is not None:
            columns = source.plan.layout.pose(seat)
            positions[:, at] = drawn.states[:, columns[:2]]
            headings[:, at] = drawn.states[:, columns[2]]
    return positions, headings
