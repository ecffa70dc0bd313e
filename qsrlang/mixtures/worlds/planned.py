"""The worlds that a question depends on, planned; a graph remembers them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from qsrlang.language.syntax import Atom
from qsrlang.mixtures.worlds.branching import Branching, TreePlans
from qsrlang.mixtures.worlds.enumeration import MAX_WORLDS, World, enumerate_worlds
from qsrlang.mixtures.worlds.plans import Plan, plan_worlds
from qsrlang.mixtures.worlds.trees import tree_of
from qsrlang.relations.graph import RelationGraph


class PlannedWorlds(NamedTuple):
    """Worlds that are possible at all, best first, each with its plan, and the prior mass of those dropped."""

    worlds: tuple[World, ...]
    plans: tuple[Plan, ...]
    dropped: float


def planned_worlds(
    graph: RelationGraph,
    targets: tuple[str, ...],
    limit: int = MAX_WORLDS,
    asked: Sequence[Atom] = (),
    in_parts: bool = False,
) -> PlannedWorlds:
    """Return the worlds of targets and how each places them, those of a tree without drafts."""

    def planned() -> PlannedWorlds:
        tree = tree_of(graph, targets)
        if tree is not None:
            branching = Branching.of(tree, targets, in_parts)
            grown, plans = branching.worlds(limit), TreePlans(graph, branching, asked)
            return PlannedWorlds(grown.worlds, tuple([plans.of(world) for world in grown]), grown.dropped)
        found = enumerate_worlds(graph, *targets, limit=limit, in_parts=in_parts)
        worlds = tuple(world for world in found if world.weight > 0.0)
        return PlannedWorlds(worlds, plan_worlds(graph, worlds, *targets, asked=asked), found.dropped)

    spoken = tuple((atom.relation.text, *(one.text for one in atom.arguments)) for atom in asked)
    return graph.derived((targets, limit, spoken, in_parts), planned, lambda found: len(found.worlds))
