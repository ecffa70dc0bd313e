"""Worlds: one alternative for every choice a target depends on, and one instance for every class and role."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace

from qsrlang.errors import TooManyWorldsError
from qsrlang.mixtures.roles import instances_in_roles, is_unplaced_role, landmarks_of_role
from qsrlang.relations.graph import Alternative, Authority, Choice, Constraint, Landmark, Pair, RelationGraph

MAX_WORLDS = 10_000
MIN_REST = 1e-9


@dataclass(frozen=True, slots=True)
class World:
    """Constraints that hold together, with the landmark that stands for each name, and their prior weight.

    `aliases` name, for a class whose any instance will do, the role it is here; constraints name the role already.
    `absent` are the objects that are elsewhere: shares below 1 leave the rest to that.
    """

    weight: float
    constraints: tuple[Constraint, ...] = ()
    bindings: tuple[tuple[str, Landmark], ...] = ()
    aliases: tuple[tuple[str, str], ...] = ()
    absent: tuple[str, ...] = ()

    def named(self, name: str) -> str:
        """Return what a name stands for: for a class perhaps one of its roles."""
        return dict(self.aliases).get(name, name)


@dataclass(frozen=True, slots=True)
class _Partial:
    world: World
    pending: tuple[str, ...]
    visited: frozenset[str] = frozenset()
    covered: frozenset[Pair] = frozenset()
    decided: frozenset[int] = frozenset()


def enumerate_worlds(graph: RelationGraph, *targets: str) -> tuple[World, ...]:
    """Return every world of the sub-graph that targets depend on; raises TooManyWorldsError beyond MAX_WORLDS."""
    complete: list[World] = []
    waiting = [_Partial(World(1.0), targets)]
    while waiting:
        partial = waiting.pop()
        if not partial.pending:
            complete.append(_renamed(partial.world))
        else:
            waiting.extend(_step(graph, partial))
        if len(waiting) + len(complete) > MAX_WORLDS:
            raise TooManyWorldsError(" and ".join(targets), MAX_WORLDS)
    return tuple(reversed(complete))


def needed_for(names: Collection[str], constraints: Iterable[Constraint]) -> frozenset[str]:
    """Return the names that help to place some: themselves, the relata of their constraints, and so on."""
    constraints = tuple(constraints)
    needed, waiting = set(names), list(names)
    while waiting:
        referent = waiting.pop()
        relata = {one for c in constraints if c.referent == referent for one in c.relata} - needed
        needed |= relata
        waiting += relata
    return frozenset(needed)


def _step(graph: RelationGraph, partial: _Partial) -> Iterator[_Partial]:
    name, *rest = partial.pending
    if name in partial.visited:
        return iter([replace(partial, pending=tuple(rest))])
    instances = graph.instances_of(name)
    if instances:
        return _bind(partial, [(1.0 / len(instances), landmark) for landmark in instances])
    if is_unplaced_role(graph, name):
        return _bind(partial, _landmarks_of_role(graph, partial, name))
    candidates = _candidates(graph, partial, name)
    if candidates:
        return _stand_in(partial, candidates)
    choice = _next_choice(graph, partial, name)
    if choice is None:
        relata = [one for c in partial.world.constraints if c.referent == name for one in c.relata]
        pending = (*rest, *dict.fromkeys(relata))
        return iter([replace(partial, pending=pending, visited=partial.visited | {name})])
    return _choose(graph, partial, choice)


def _bind(partial: _Partial, instances: Iterable[tuple[float, Landmark | None]]) -> Iterator[_Partial]:
    name, *rest = partial.pending
    for share, landmark in instances:
        bound = () if landmark is None else ((name, landmark),)
        world = replace(
            partial.world,
            weight=partial.world.weight * share,
            bindings=(*partial.world.bindings, *bound),
        )
        yield replace(partial, world=world, pending=tuple(rest), visited=partial.visited | {name})


def _landmarks_of_role(
    graph: RelationGraph, partial: _Partial, role: str
) -> tuple[tuple[float, Landmark | None], ...]:
    kind = graph.roles[role]
    named = {role, *(one for c in partial.world.constraints for one in (c.referent, *c.relata))}
    alike = {one for one in named if graph.roles.get(one) == kind and is_unplaced_role(graph, one)}
    taken = {landmark.name for name, landmark in partial.world.bindings if name in alike}
    return landmarks_of_role(graph, role, taken, len(alike - partial.visited))


def _candidates(graph: RelationGraph, partial: _Partial, name: str) -> tuple[str, ...]:
    """Return what a class may be, if that is open: one of its roles, or itself."""
    world = partial.world
    if not graph.roles or name in dict(world.aliases) or any(c.referent == name for c in world.constraints):
        return ()
    candidates = instances_in_roles(graph, name)
    return tuple(one for one in candidates if one == name or not _differ(one, name, world.constraints))


def _differ(role: str, name: str, constraints: tuple[Constraint, ...]) -> bool:
    """Return whether a role is not what a name stands for: one constraint names both, or the role depends on it."""
    together = any({role, name} <= {one.referent, *one.relata} for one in constraints)
    return together or name in needed_for((role,), constraints)


def _stand_in(partial: _Partial, candidates: tuple[str, ...]) -> Iterator[_Partial]:
    name, *rest = partial.pending
    for candidate in candidates:
        world = replace(
            partial.world,
            weight=partial.world.weight / len(candidates),
            aliases=(*partial.world.aliases, (name, candidate)),
        )
        visited = partial.visited if candidate == name else partial.visited | {name}
        yield replace(partial, world=world, pending=(candidate, *rest), visited=visited)


def _next_choice(graph: RelationGraph, partial: _Partial, name: str) -> Choice | None:
    for choice in graph.choices_for(name):
        open_pairs = {pair for pair in choice.governs if pair[0] == name} - partial.covered
        if open_pairs and id(choice) not in partial.decided:
            return choice
    return None


def _choose(graph: RelationGraph, partial: _Partial, choice: Choice) -> Iterator[_Partial]:
    alternatives = _compatible(graph, choice, partial.covered)
    rest = 1.0 - sum(alternative.share for alternative in alternatives)
    if rest > MIN_REST:
        yield _elsewhere(partial, choice, rest)
    for alternative in alternatives:
        pairs = [graph.pair_of(constraint) for constraint in alternative.constraints]
        fresh = [
            c for c, pair in zip(alternative.constraints, pairs, strict=True) if pair not in partial.covered
        ]
        yield replace(
            partial,
            world=replace(
                partial.world,
                weight=partial.world.weight * alternative.share,
                constraints=(*partial.world.constraints, *fresh),
            ),
            covered=partial.covered.union(pairs),
            decided=partial.decided | {id(choice)},
        )


def _elsewhere(partial: _Partial, choice: Choice, rest: float) -> _Partial:
    """Return the world in which what a choice speaks of is somewhere that no statement names."""
    absent = (*partial.world.absent, *sorted({referent for referent, _ in choice.governs}))
    return replace(
        partial,
        world=replace(partial.world, weight=partial.world.weight * rest, absent=absent),
        covered=partial.covered | choice.governs,
        decided=partial.decided | {id(choice)},
    )


def _compatible(graph: RelationGraph, choice: Choice, covered: frozenset[Pair]) -> tuple[Alternative, ...]:
    """Return the alternatives; scenes that were already passed over for another are left out if any remain."""
    if choice.authority is not Authority.SCENE:
        return choice.alternatives
    free = [a for a in choice.alternatives if not any(graph.pair_of(c) in covered for c in a.constraints)]
    kept = free or list(choice.alternatives)
    total = sum(alternative.share for alternative in kept)
    return tuple(Alternative(alternative.share / total, alternative.constraints) for alternative in kept)


def _renamed(world: World) -> World:
    """Return the world with the role in the place of every class that is one."""
    names = dict(world.aliases)
    if not names:
        return world
    constraints = tuple(
        replace(
            one,
            referent=names.get(one.referent, one.referent),
            relatum=names.get(one.relatum, one.relatum),
            towards=names.get(one.towards, one.towards) if one.towards else None,
        )
        for one in world.constraints
    )
    return replace(world, constraints=constraints)
