"""Where a target is, as worlds and as the answer that they make together."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.draws.conditioning import Drawing, draw_scenes, effective_draws
from qsrlang.mixtures.draws.conditions import Condition
from qsrlang.mixtures.reduction import MAX_COMPONENTS
from qsrlang.mixtures.sampling import sampled_worlds
from qsrlang.mixtures.solving.weighing import solve_worlds
from qsrlang.mixtures.weighed import Weighed, answer_of
from qsrlang.mixtures.worlds.chains import broken_chains, chain_starts, circle_of
from qsrlang.mixtures.worlds.enumeration import MAX_WORLDS
from qsrlang.relations.graph import Landmark, RelationGraph


@dataclass(frozen=True, slots=True)
class Bounds:
    """How many worlds are weighed, and how many components an answer has, at most."""

    worlds: int = MAX_WORLDS
    components: int = MAX_COMPONENTS


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """Where a target is, and the worlds behind that, best first."""

    answer: Where
    worlds: Sequence[Weighed]


def place_exactly(graph: RelationGraph, target: str, viewer: Pose2 | None, bounds: Bounds) -> Placed:
    """Place a target in the map frame; raises UnreachedTargetError, NoRoomError and MissingFacingError."""
    solution = solve_worlds(graph, (target,), viewer, bounds.worlds)
    return Placed(
        answer_of(graph, target, solution.worlds, solution.dropped, bounds.components), solution.worlds
    )


def place_assuming(
    graph: RelationGraph, target: str, conditions: tuple[Condition, ...], drawing: Drawing, bounds: Bounds
) -> Placed:
    """Place a target under conditions, by the moments of each world's draws; raises ImpossibleConditionError too."""
    drawn, dropped = draw_scenes(graph, (target,), conditions, drawing)
    assumed = tuple(one.text for one in conditions)
    draws = effective_draws(drawn)
    return Placed(answer_of(graph, target, drawn, dropped, bounds.components, assumed, draws), drawn)


def place_by_sampling(
    graph: RelationGraph, target: str, viewer: Pose2 | None, samples: int, rng: np.random.Generator
) -> Placed:
    """Place a target as the paper does, by a Gaussian fit to `samples` draws of every world."""
    worlds, dropped = sampled_worlds(graph, target, viewer, samples, rng)
    return Placed(answer_of(graph, target, worlds, dropped), worlds)


def alone_with(graph: RelationGraph, relatum: str) -> RelationGraph:
    """Return the graph with the relatum at the origin, the viewer's axis along +x, and no other landmark."""
    virtual = Landmark(relatum, graph.class_of(relatum), 0.0, 0.0, heading=math.pi)
    return replace(graph, landmarks=(virtual,))


def rooted(graph: RelationGraph, names: Sequence[str]) -> RelationGraph:
    """Return the graph; where no chain of any name comes to a landmark, with the one class at the origin that all of
    them hang on.

    Raises UnreachedTargetError where they hang on several, or their chains run in circles.
    """
    if any(graph.instances_of(name) for name in names):
        return graph
    starts: dict[str, None] = {}
    for name in names:
        own = chain_starts(graph, name) or (name,)
        if any(graph.instances_of(start) for start in own):
            return graph
        starts.update(dict.fromkeys(own))
    if len(starts) != 1:
        raise UnreachedTargetError(" and ".join(names), _endings(graph, starts))
    return alone_with(graph, *starts)


def _endings(graph: RelationGraph, starts: Iterable[str]) -> Iterable[str]:
    """Return a sentence on each of some names that have no landmark, and one on each circle that they run in."""
    found: dict[frozenset[str], str] = {}
    for start in starts:
        circle = circle_of(graph, start)
        said = (
            f"{' - '.join(circle)} is a circle without a landmark" if circle else f"{start} has no landmark"
        )
        found.setdefault(frozenset(circle or (start,)), said)
    return found.values()


def in_frame(
    graph: RelationGraph, target: str, wrt: str | None, place: Callable[[RelationGraph], Placed]
) -> Placed:
    """Place a target on the map; with `wrt`, relative to that; where no landmark is known, relative to the class,
    of those the target's chains start from, that tells the most.
    """
    if wrt is None and graph.landmarks:
        return place(graph)
    found, failures = [], []
    for relatum in chain_starts(graph, target) if wrt is None else (wrt,):
        try:
            placed = place(alone_with(graph, relatum))
            found.append(replace(placed, answer=replace(placed.answer, frame=relatum)))
        except UnreachedTargetError as error:
            failures.append(error)
    if not found:
        raise failures[0] if failures else UnreachedTargetError(target, broken_chains(graph, target))
    return max(found, key=lambda placed: 1.0 - placed.answer.elsewhere)
