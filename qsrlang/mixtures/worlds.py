"""Worlds: one alternative for every choice a target depends on, and one instance for every landmark class."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from qsrlang.errors import TooManyWorldsError
from qsrlang.relations.graph import Alternative, Authority, Choice, Constraint, Landmark, Pair, RelationGraph

MAX_WORLDS = 10_000


@dataclass(frozen=True, slots=True)
class World:
    """Constraints that hold together, with the landmark that stands for each name, and their prior weight."""

    weight: float
    constraints: tuple[Constraint, ...] = ()
    bindings: tuple[tuple[str, Landmark], ...] = ()

    @property
    def landmarks(self) -> dict[str, Landmark]:
        """The landmark that stands for each class or landmark name."""
        return dict(self.bindings)


@dataclass(frozen=True, slots=True)
class _Partial:
    world: World
    pending: tuple[str, ...]
    visited: frozenset[str] = frozenset()
    covered: frozenset[Pair] = frozenset()
    decided: frozenset[int] = frozenset()


def enumerate_worlds(graph: RelationGraph, target: str) -> tuple[World, ...]:
    """Return every world of the sub-graph that `target` depends on; raises TooManyWorldsError beyond MAX_WORLDS."""
    complete: list[World] = []
    waiting = [_Partial(World(1.0), (target,))]
    while waiting:
        partial = waiting.pop()
        if not partial.pending:
            complete.append(partial.world)
        else:
            waiting.extend(_step(graph, partial))
        if len(waiting) + len(complete) > MAX_WORLDS:
            raise TooManyWorldsError(target, MAX_WORLDS)
    return tuple(reversed(complete))


def _step(graph: RelationGraph, partial: _Partial) -> Iterator[_Partial]:
    name, *rest = partial.pending
    if name in partial.visited:
        return iter([replace(partial, pending=tuple(rest))])
    instances = graph.instances_of(name)
    if instances:
        return _bind(partial, name, instances)
    choice = _next_choice(graph, partial, name)
    if choice is None:
        relata = [c.relatum for c in partial.world.constraints if c.referent == name]
        pending = (*rest, *dict.fromkeys(relata))
        return iter([replace(partial, pending=pending, visited=partial.visited | {name})])
    return _choose(graph, partial, choice)


def _bind(partial: _Partial, name: str, instances: tuple[Landmark, ...]) -> Iterator[_Partial]:
    for landmark in instances:
        world = replace(
            partial.world,
            weight=partial.world.weight / len(instances),
            bindings=(*partial.world.bindings, (name, landmark)),
        )
        yield replace(partial, world=world, pending=partial.pending[1:], visited=partial.visited | {name})


def _next_choice(graph: RelationGraph, partial: _Partial, name: str) -> Choice | None:
    for choice in graph.choices_for(name):
        open_pairs = {pair for pair in choice.governs if pair[0] == name} - partial.covered
        if open_pairs and id(choice) not in partial.decided:
            return choice
    return None


def _choose(graph: RelationGraph, partial: _Partial, choice: Choice) -> Iterator[_Partial]:
    for alternative in _compatible(graph, choice, partial.covered):
        fresh = [c for c in alternative.constraints if class_pair(graph, c) not in partial.covered]
        yield replace(
            partial,
            world=replace(
                partial.world,
                weight=partial.world.weight * alternative.share,
                constraints=(*partial.world.constraints, *fresh),
            ),
            covered=partial.covered | {class_pair(graph, c) for c in fresh},
            decided=partial.decided | {id(choice)},
        )


def _compatible(graph: RelationGraph, choice: Choice, covered: frozenset[Pair]) -> tuple[Alternative, ...]:
    """Return the alternatives; scenes that were already passed over for another are left out if any remain."""
    if choice.authority is not Authority.SCENE:
        return choice.alternatives
    free = [a for a in choice.alternatives if not any(class_pair(graph, c) in covered for c in a.constraints)]
    kept = free or list(choice.alternatives)
    total = sum(alternative.share for alternative in kept)
    return tuple(Alternative(alternative.share / total, alternative.constraints) for alternative in kept)


def class_pair(graph: RelationGraph, constraint: Constraint) -> Pair:
    """Return the ordered pair of classes that a constraint speaks of."""
    return graph.class_of(constraint.referent), graph.class_of(constraint.relatum)
