"""Reasoning without numbers: the four directions of one shared frame as pairs of strict orders.

A direction is a quarter of the plane about its axis. In the axes u = x + y and w = x - y (x away from the viewer, y to
the left) behind-of is u > 0, w > 0; left-of u > 0, w < 0; in-front-of u < 0, w < 0; right-of u < 0, w > 0. So atoms of
one frame are statements about two orders, and converse, composition and consistency are exact. With a point-like
viewer near the objects the frames differ from pair to pair, and this holds only roughly.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

from qsrlang.errors import UnknownNameError
from qsrlang.language.syntax import Atom, Frame, Normal
from qsrlang.relations.calculus import Relation

_SIGNS = {"behind-of": (1, 1), "left-of": (1, -1), "in-front-of": (-1, -1), "right-of": (-1, 1)}
_NAMES = {signs: name for name, signs in _SIGNS.items()}
_RING = ("behind-of", "left-of", "in-front-of", "right-of")
_TOLERANCE = 1e-9


def converse(relation: str) -> str:
    """Return the direction of (B, A) where this is the one of (A, B); raises UnknownNameError."""
    u, w = _signs(relation)
    return _NAMES[-u, -w]


def compose(first: str, second: str) -> frozenset[str]:
    """Return the directions that (A, C) may have, given first(A, B) and second(B, C); raises UnknownNameError.

    Of equal ones it is the same, of neighbours one of the two, of opposites any.
    """
    (u, w), (v, z) = _signs(first), _signs(second)
    return frozenset(_NAMES[one, other] for one in {u, v} for other in {w, z})


def neighbours(relation: str) -> frozenset[str]:
    """Return the directions into which this one turns without passing through another; raises UnknownNameError."""
    _signs(relation)
    at = _RING.index(relation)
    return frozenset((_RING[at - 1], _RING[(at + 1) % 4]))


def conflict(atoms: Sequence[Atom], relations: Mapping[str, Relation]) -> tuple[Atom, ...]:
    """Return few atoms of a conjunction that contradict each other, or nothing where it is consistent.

    Two kinds are found: relations that exclude each other on one ordered pair, and cycles of directions in the
    relative or in the absolute frame. Without any one of the atoms returned, the others are consistent.
    """
    found = [*_excluding(atoms, relations), *_cycles(atoms, relations)]
    return min(found, key=len, default=())


@dataclass(frozen=True, slots=True)
class _Step:
    """An atom says that, in one of the two orders, `high` comes after `low`."""

    low: str
    high: str
    atom: Atom


def _signs(relation: str) -> tuple[int, int]:
    if relation not in _SIGNS:
        raise UnknownNameError("direction", relation, _SIGNS)
    return _SIGNS[relation]


def _excluding(atoms: Sequence[Atom], relations: Mapping[str, Relation]) -> Iterator[tuple[Atom, ...]]:
    said: dict[object, list[Atom]] = {}
    for atom in atoms:
        said.setdefault((*(one.text for one in atom.arguments), atom.frame), []).append(atom)
    for group in said.values():
        for number, one in enumerate(group):
            excluded = relations[one.relation.text].disjoint
            yield from ((one, other) for other in group[number + 1 :] if other.relation.text in excluded)


def _cycles(atoms: Sequence[Atom], relations: Mapping[str, Relation]) -> Iterator[tuple[Atom, ...]]:
    for frame in (Frame.RELATIVE, Frame.ABSOLUTE):
        directed = [
            (atom, _direction(relations[atom.relation.text])) for atom in atoms if atom.frame is frame
        ]
        for axis in (0, 1):
            steps = [_step(atom, signs[axis]) for atom, signs in directed if signs is not None]
            yield from filter(None, [_shortest_cycle(steps)])


def _direction(relation: Relation) -> tuple[int, int] | None:
    """Return the signs of a relation whose angle is a normal density about one of the four axes."""
    if relation.arity != 2 or not isinstance(relation.angle, Normal):
        return None
    quarters = relation.angle.mean.value / (0.5 * math.pi)
    if abs(quarters - round(quarters)) > _TOLERANCE:
        return None
    return _SIGNS[_RING[round(quarters) % 4]]


def _step(atom: Atom, sign: int) -> _Step:
    referent, relatum = (argument.text for argument in atom.arguments)
    return _Step(relatum, referent, atom) if sign > 0 else _Step(referent, relatum, atom)


def _shortest_cycle(steps: Iterable[_Step]) -> tuple[Atom, ...]:
    """Return the atoms along a short cycle of an order, in their order, or nothing."""
    after: dict[str, list[_Step]] = {}
    for step in steps:
        after.setdefault(step.low, []).append(step)
    cycles = (_cycle_through(start, after) for start in _some_cycle(after))
    return min(filter(None, cycles), key=len, default=())


def _some_cycle(after: Mapping[str, list[_Step]]) -> list[str]:
    """Return the names along a cycle, or nothing where there is none."""
    try:
        TopologicalSorter({low: [step.high for step in steps] for low, steps in after.items()}).prepare()
    except CycleError as error:
        return sorted(set(error.args[1]))
    return []


def _cycle_through(start: str, after: Mapping[str, list[_Step]]) -> tuple[Atom, ...]:
    """Return the atoms along a shortest way from a name back to itself, breadth first."""
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


def _back(start: str, came: Mapping[str, _Step]) -> Iterator[Atom]:
    step = came[start]
    yield step.atom
    while step.low != start:
        step = came[step.low]
        yield step.atom
