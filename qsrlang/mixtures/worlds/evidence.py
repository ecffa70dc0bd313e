"""What tells of a target though the target does not depend on it: things seen, and things that several others place.

What is known of them holds in every world, so every world has to be weighed by it, whichever way it places the target.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from qsrlang.mixtures.worlds.chains import placed_by
from qsrlang.mixtures.worlds.roles import instances_in_roles
from qsrlang.relations.graph import Choice, Constraint, RelationGraph


def telling(graph: RelationGraph, targets: Iterable[str]) -> tuple[str, ...]:
    """Return the things on whose places worlds have to agree besides those of the targets, sorted.

    Things seen that are placed by something whose place is open and that a target depends on, in whatever way; then
    what those depend on; and all of that which is placed by several others.
    """
    reached = _closure(graph, targets)
    found: set[str] = set()
    while fresh := {one for one in graph.evidence if one not in found and _tells(graph, one, reached)}:
        found |= fresh
        reached |= _closure(graph, (name for one in fresh for name in _sources(graph, one)))
    return tuple(sorted(found | {one for one in reached if _is_fused(graph, one)}))


def constraints_on(graph: RelationGraph, choice: Choice, name: str) -> Iterator[Constraint]:
    """Yield what a choice may say of a thing."""
    for alternative in choice.alternatives:
        yield from (one for one in alternative.constraints if one.referent == name)


def _closure(graph: RelationGraph, names: Iterable[str]) -> set[str]:
    """Return names with all that they may be placed by, and so on, up to landmarks."""
    found: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += () if graph.instances_of(name) else placed_by(graph, name)
    return found


def _tells(graph: RelationGraph, name: str, reached: set[str]) -> bool:
    open_ones = {one for one in reached if _is_open(graph, one)}
    if name in open_ones:
        return True
    return bool(_closure(graph, _sources(graph, name)) & open_ones)


def _sources(graph: RelationGraph, name: str) -> set[str]:
    """Return what may be said to place a thing that is seen."""
    choices = graph.choices_for(graph.node_of(name))
    return {one for choice in choices for said in constraints_on(graph, choice, name) for one in said.relata}


def _is_open(graph: RelationGraph, name: str) -> bool:
    """Return whether it is not certain where something is: it is no landmark, or one of several, or not exact."""
    instances = graph.instances_of(name)
    return len(instances) != 1 or any(instances[0].deviation)


def _is_fused(graph: RelationGraph, name: str) -> bool:
    """Return whether several constraints may hold of a thing that no landmark places."""
    if graph.instances_of(name) or instances_in_roles(graph, name):
        return False
    return sum(_most_said(choice, name) for choice in graph.choices_for(name)) > 1


def _most_said(choice: Choice, name: str) -> int:
    """Return how many constraints a choice may put on a thing at once."""
    counts = [[one.referent for one in each.constraints].count(name) for each in choice.alternatives]
    return max(counts, default=0)
