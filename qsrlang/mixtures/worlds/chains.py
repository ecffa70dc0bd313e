"""Chains: from a target over what it is placed by to the classes that nothing places."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable

from qsrlang.mixtures.worlds.roles import instances_in_roles
from qsrlang.relations.graph import Constraint, RelationGraph


def placed_by(graph: RelationGraph, name: str) -> tuple[str, ...]:
    """Return the classes and roles that statements place a class or role by, sorted; a class also by its roles."""
    found = set(instances_in_roles(graph, name))
    for choice in graph.choices_for(name):
        for alternative in choice.alternatives:
            for one in alternative.constraints:
                if graph.node_of(one.referent) == name:
                    found.update(map(graph.node_of, one.relata))
    return tuple(sorted(found - {name}))


def chain_starts(graph: RelationGraph, target: str) -> tuple[str, ...]:
    """Return the classes at which a target's chains start: those that landmarks place, or no statement does."""
    starts, waiting, seen = [], [target], {target}
    while waiting:
        name = waiting.pop(0)
        relata = () if graph.instances_of(name) else placed_by(graph, name)
        if not relata and name != target:
            starts.append(graph.class_of(name))
        waiting += [relatum for relatum in relata if relatum not in seen]
        seen.update(relata)
    return tuple(dict.fromkeys(starts))


def is_tied(graph: RelationGraph, name: str) -> bool:
    """Return whether something is a landmark, or a chain may tie it to one."""
    starts = (graph.class_of(name), *chain_starts(graph, name))
    return any(graph.instances_of(start) for start in starts)


def broken_chains(graph: RelationGraph, target: str) -> tuple[str, ...]:
    """Return, for each thing a target is placed by, a sentence on where its chains end, or run in a circle, without a
    landmark.
    """
    chains = []
    for relatum in placed_by(graph, target):
        starts = chain_starts(graph, relatum) or _own_start(graph, relatum)
        ends = [name for name in starts if not graph.instances_of(name)]
        circle = circle_of(graph, target, relatum)
        if ends:
            chains.append(f"{target} - {relatum} ends at {', '.join(ends)}, which has no landmark")
        elif circle:
            chains.append(f"{' - '.join(circle)} is a circle without a landmark")
    return tuple(dict.fromkeys(chains))


def _own_start(graph: RelationGraph, name: str) -> tuple[str, ...]:
    return () if placed_by(graph, name) else (graph.class_of(name),)


def circle_of(graph: RelationGraph, *way: str) -> tuple[str, ...]:
    """Return the first circle that chains over a way of names come to, back to where it starts; else nothing."""
    *before, last = way
    waiting, seen = [(*before, last)], {last}
    while waiting:
        chain = waiting.pop(0)
        for name in () if graph.instances_of(chain[-1]) else placed_by(graph, chain[-1]):
            if name in chain:
                return (*chain[chain.index(name) :], name)
            if name not in seen:
                seen.add(name)
                waiting.append((*chain, name))
    return ()


def needed_for(names: Collection[str], constraints: Iterable[Constraint]) -> frozenset[str]:
    """Return the names that help to place some: themselves, the relata of their constraints, and so on."""
    relata: dict[str, list[str]] = defaultdict(list)
    for one in constraints:
        relata[one.referent] += one.relata
    needed, waiting = set(names), list(names)
    while waiting:
        fresh = [name for name in relata[waiting.pop()] if name not in needed]
        needed.update(fresh)
        waiting += fresh
    return frozenset(needed)


def depends_on(graph: RelationGraph, names: Iterable[str]) -> set[str]:
    """Return names with all that statements place them by, and so on, up to what landmarks place."""
    found, waiting = set(names), list(names)
    while waiting:
        fresh = {name for name in placed_by(graph, waiting.pop()) if not graph.instances_of(name)} - found
        found |= fresh
        waiting += fresh
    return found


def sources_of(graph: RelationGraph, target: str) -> set[str]:
    """Return all that a target is placed by, landmarks too, but nothing that those are placed by."""
    names = depends_on(graph, (target,))
    return {one for name in names for one in placed_by(graph, name)} | names - {target}
