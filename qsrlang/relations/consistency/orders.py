"""Contradictions without numbers: relations that exclude each other, and circles of directions in one frame.

In each frame a direction says, in each of two strict orders, which of two objects comes first; a conjunction of
directions is consistent if and only if neither order runs in a circle.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, combinations
from typing import TypeAlias

from qsrlang.relations.algebra import signs_of
from qsrlang.relations.consistency.claims import Fact, Mention


@dataclass(frozen=True, slots=True, eq=False)
class _Step:
    """A fact says that, in one of the two orders, `high` comes after `low`."""

    low: str
    high: str
    fact: Fact


_After: TypeAlias = Mapping[str, Sequence[_Step]]


def contradiction(facts: Iterable[Fact]) -> tuple[Fact, ...]:
    """Return the fewest facts of a conjunction that contradict each other, or nothing where it is consistent.

    Without any one of them the others are consistent.
    """
    facts = tuple(facts)
    return min((*_excluding(facts), *_circles(facts)), key=len, default=())


def some_contradiction(facts: Iterable[Fact]) -> tuple[Fact, ...]:
    """Return facts of a conjunction that contradict each other, the first that are found, or nothing."""
    facts = tuple(facts)
    circles = (one for steps in _orders(facts) for one in _all_circles(_knotted(steps)))
    return next(chain(_excluding(facts), circles), ())


def entangled(facts: Iterable[Fact]) -> frozenset[Mention]:
    """Return where the facts are written that could take part in any contradiction between some of these."""
    facts = tuple(facts)
    found = {fact.mention for pair in _excluding(facts) for fact in pair}
    for steps in _orders(facts):
        found.update(step.fact.mention for step in _knotted(steps))
    return frozenset(found)


def _excluding(facts: Sequence[Fact]) -> Iterator[tuple[Fact, ...]]:
    """Yield pairs of facts of one ordered pair whose relations exclude each other."""
    said: dict[object, list[tuple[str, Fact]]] = defaultdict(list)
    for fact in facts:
        for name, names in _said(fact):
            said[names, fact.axis.key].append((name, fact))
    for group in said.values():
        for (name, one), (other_name, other) in combinations(group, 2):
            if _excludes(one, name, other_name) or _excludes(other, other_name, name):
                yield one, other


def _excludes(fact: Fact, name: str, other: str) -> bool:
    """Return whether a fact, where it is said in its own words, excludes another relation of the pair."""
    return name == fact.relation.name and other in fact.relation.disjoint


def _said(fact: Fact) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield a relation with its arguments, and what is the same said the other way round."""
    relation, names = fact.relation, fact.names
    yield relation.name, names
    if len(names) == 2 and fact.axis.hand > 0:
        if relation.symmetric:
            yield relation.name, names[::-1]
        if relation.converse:
            yield relation.converse, names[::-1]


def _circles(facts: Sequence[Fact]) -> Iterator[tuple[Fact, ...]]:
    for steps in _orders(facts):
        circle = _shortest_circle(_knotted(steps))
        if circle:
            yield circle


def _orders(facts: Iterable[Fact]) -> Iterable[list[_Step]]:
    """Return the steps of each order: two for each frame."""
    orders: dict[object, list[_Step]] = defaultdict(list)
    for fact in facts:
        signs = signs_of(fact.relation)
        if signs is not None:
            for number, sign in enumerate(signs):
                referent, relatum = fact.names
                low, high = (relatum, referent) if sign > 0 else (referent, relatum)
                orders[fact.axis.key, number].append(_Step(low, high, fact))
    return orders.values()


def _knotted(steps: Sequence[_Step]) -> Sequence[_Step]:
    """Return the steps that may lie on a circle: between two circles, or on one."""
    following = _peeled(steps, lambda step: step.low, lambda step: step.high)
    return _peeled(following, lambda step: step.high, lambda step: step.low) if following else following


def _peeled(
    steps: Sequence[_Step], start: Callable[[_Step], str], end: Callable[[_Step], str]
) -> Sequence[_Step]:
    """Return the steps but for those that start where, after what was taken away, none ends."""
    leaving: dict[str, list[str]] = defaultdict(list)
    arriving: dict[str, int] = defaultdict(int)
    for step in steps:
        leaving[start(step)].append(end(step))
        arriving[end(step)] += 1
    waiting = [name for name in leaving if not arriving[name]]
    for name in waiting:
        for other in leaving.get(name, ()):
            arriving[other] -= 1
            if not arriving[other]:
                waiting.append(other)
    gone = set(waiting)
    return [step for step in steps if start(step) not in gone]


def _shortest_circle(steps: Sequence[_Step]) -> tuple[Fact, ...]:
    return min(_all_circles(steps), key=len, default=())


def _all_circles(steps: Sequence[_Step]) -> Iterator[tuple[Fact, ...]]:
    """Yield a shortest circle through each name that lies on one."""
    after: dict[str, list[_Step]] = defaultdict(list)
    for step in steps:
        after[step.low].append(step)
    yield from filter(None, (_circle_through(start, after) for start in tuple(after)))


def _circle_through(start: str, after: _After) -> tuple[Fact, ...]:
    """Return the facts along a shortest way from a name back to itself, breadth first."""
    came: dict[str, _Step] = {}
    waiting = [start]
    for name in waiting:
        for step in after.get(name, ()):
            if step.high not in came:
                came[step.high] = step
                waiting.append(step.high)
            if step.high == start:
                return tuple(reversed(list(_back(start, came))))
    return ()


def _back(start: str, came: Mapping[str, _Step]) -> Iterator[Fact]:
    step = came[start]
    yield step.fact
    while step.low != start:
        step = came[step.low]
        yield step.fact
