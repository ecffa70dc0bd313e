"""Worlds: one alternative for every choice a target depends on, and one instance for every class and role.

Worlds are found best first: those that take the likelier alternative of each choice come before those that do not.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from itertools import count

from qsrlang.mixtures.worlds.drafts import Draft, Outcome
from qsrlang.mixtures.worlds.evidence import telling
from qsrlang.relations.graph import Constraint, Landmark, RelationGraph

MAX_WORLDS = 10_000
MIN_REST = 1e-9


@dataclass(frozen=True, slots=True)
class World:
    """Constraints that hold together, with the landmark that stands for each name, and their prior weight.

    `aliases` name, for a class whose any instance will do, the role it is here; constraints name the role already.
    `absent` are the objects that are elsewhere: shares below 1 leave the rest to that. `telling` are the objects that
    tell of others, seen or placed by several. `decided` are the shares, whose product is the weight, and of what.
    """

    weight: float
    constraints: tuple[Constraint, ...] = ()
    bindings: tuple[tuple[str, Landmark], ...] = ()
    aliases: tuple[tuple[str, str], ...] = ()
    absent: tuple[str, ...] = ()
    telling: tuple[str, ...] = ()
    decided: tuple[tuple[float, Outcome], ...] = ()

    def named(self, name: str) -> str:
        """Return what a name stands for: for a class perhaps one of its roles."""
        return name if not self.aliases else next((role for kind, role in self.aliases if kind == name), name)


@dataclass(frozen=True, slots=True)
class Worlds:
    """The likelier worlds, best first, and the prior mass of those that were `dropped`, of a total of 1."""

    worlds: tuple[World, ...]
    dropped: float = 0.0

    def __iter__(self) -> Iterator[World]:
        return iter(self.worlds)

    def __len__(self) -> int:
        return len(self.worlds)


def enumerate_worlds(
    graph: RelationGraph, *targets: str, limit: int = MAX_WORLDS, in_parts: bool = False
) -> Worlds:
    """Return worlds of the sub-graph that targets depend on, best first, up to `limit` of them.

    The order is that of share / greatest share, multiplied over all choices made; where all worlds make the same
    choices it is that of their weights. `in_parts` splits constraints whose relations ask for several components.
    """
    found: list[World] = []
    number = count()
    waiting = [(-1.0, 0, next(number), Draft.start(targets, telling(graph, targets)))]
    rest = 1.0
    while waiting and len(found) < limit and rest > MIN_REST:
        *_, draft = heappop(waiting)
        branches = draft.branches(graph, in_parts)
        if branches is None:
            found.append(_world(draft))
            rest -= draft.weight
        for branch in branches or ():
            heappush(waiting, (-branch.likeness, -branch.depth, next(number), branch))
    return Worlds(tuple(found), max(rest, 0.0) if waiting else 0.0)


def _world(draft: Draft) -> World:
    """Return the world of a complete draft, with the role in the place of every class that is one."""
    names = draft.aliases
    constraints = [_renamed(one, names) for one in draft.constraints] if names else draft.constraints
    return World(
        draft.weight,
        tuple(constraints),
        tuple(draft.bindings.items()),
        tuple(names.items()),
        tuple(draft.absent),
        draft.telling,
        tuple(draft.decided),
    )


def _renamed(constraint: Constraint, names: dict[str, str]) -> Constraint:
    towards = constraint.towards
    return replace(
        constraint,
        referent=names.get(constraint.referent, constraint.referent),
        relatum=names.get(constraint.relatum, constraint.relatum),
        towards=names.get(towards, towards) if towards else None,
    )
