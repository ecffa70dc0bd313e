"""Reasoning without numbers: the four directions of one shared frame as pairs of strict orders.

A direction is a quarter of the plane about its axis. In the axes u = x + y and w = x - y (x away from the viewer, y to
the left) behind-of is u > 0, w > 0; left-of u > 0, w < 0; in-front-of u < 0, w < 0; right-of u < 0, w > 0. So atoms of
one frame are statements about two orders, and converse, composition and consistency are exact. With a point-like
viewer near the objects the frames differ from pair to pair, and this holds only roughly.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from qsrlang.errors import UnknownNameError
from qsrlang.language.parser import parse_formula
from qsrlang.language.syntax import And, Atom, Formula, Frame, Normal
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


def conceptual_neighbours(relation: Relation) -> tuple[str, ...]:
    """Return the relations that this one turns into by the least change.

    Of a direction those on either side; of a distance, such as close-to, those that it excludes.
    """
    signs = signs_of(relation)
    if signs is not None:
        return tuple(sorted(neighbours(_NAMES[signs])))
    return relation.disjoint if relation.angle is None and relation.region is None else ()


def entailed(atoms: Iterable[Formula | str], a: str, c: str, frame: Frame = Frame.RELATIVE) -> frozenset[str]:
    """Return the directions that (A, C) may have in one frame, given atoms or conjunctions of them that all hold.

    Exact: those for which both orders remain without a circle; none where the atoms contradict each other already.
    Atoms that are no directions, or in another frame, say nothing. Raises LanguageError.
    """
    given = [atom for one in atoms for atom in _conjoined(one) if atom.frame is frame]
    orders = [_order([atom for atom in given if atom.relation.text in _SIGNS], axis) for axis in (0, 1)]
    if any(_runs_in_a_circle(order) for order in orders):
        return frozenset()
    (us, ws) = (_ways(order, a, c) for order in orders)
    return frozenset(_NAMES[u, w] for u in us for w in ws)


def derivation(atoms: Iterable[Atom], goal: Atom) -> tuple[Atom, ...]:
    """Return few of the atoms in a goal's frame from which it follows, in the order given; none where it does not.

    A direction follows where a chain of others leads from its relatum to its referent in each of the two orders.
    """
    given = [one for one in atoms if one.frame is goal.frame and one.relation.text in _SIGNS]
    if goal.relation.text not in _SIGNS or goal.frame is Frame.INTRINSIC:
        return ()
    ways = [_way(given, goal, axis) for axis in (0, 1)]
    used = {id(atom) for way in ways for atom in way}
    return tuple(atom for atom in given if id(atom) in used) if all(ways) else ()


def _way(atoms: Iterable[Atom], goal: Atom, axis: int) -> tuple[Atom, ...]:
    """Return the atoms along a shortest way from the lower to the higher object of a goal in one order."""
    after: dict[str, list[tuple[str, Atom]]] = defaultdict(list)
    for atom in atoms:
        low, high = _low_and_high(atom, axis)
        after[low].append((high, atom))
    start, end = _low_and_high(goal, axis)
    ways: dict[str, tuple[Atom, ...]] = {start: ()}
    waiting = [start]
    for name in waiting:
        for high, atom in after.get(name, ()):
            if high not in ways:
                ways[high] = (*ways[name], atom)
                waiting.append(high)
    return ways.get(end, ())


def _low_and_high(atom: Atom, axis: int) -> tuple[str, str]:
    referent, relatum = (argument.text for argument in atom.arguments)
    return (relatum, referent) if _SIGNS[atom.relation.text][axis] > 0 else (referent, relatum)


def _conjoined(formula: Formula | str) -> Iterator[Atom]:
    """Yield the atoms that hold if a formula does; disjunctions and negations say nothing here."""
    match formula:
        case str():
            yield from _conjoined(parse_formula(formula))
        case Atom():
            yield formula
        case And(parts=parts):
            for part in parts:
                yield from _conjoined(part)


def _order(atoms: Iterable[Atom], axis: int) -> Mapping[str, set[str]]:
    """Return the names that each comes after, in one of the two orders."""
    before: dict[str, set[str]] = defaultdict(set)
    for atom in atoms:
        low, high = _low_and_high(atom, axis)
        before[high].add(low)
    return before


def _runs_in_a_circle(order: Mapping[str, set[str]]) -> bool:
    try:
        TopologicalSorter(order).prepare()
    except CycleError:
        return True
    return False


def _ways(order: Mapping[str, set[str]], a: str, c: str) -> tuple[int, ...]:
    """Return the signs that the coordinate of A less that of C may have: one where the order tells, else both."""
    return (1,) if c in _below(order, a) else (-1,) if a in _below(order, c) else (1, -1)


def _below(order: Mapping[str, set[str]], name: str) -> set[str]:
    found, waiting = set[str](), [name]
    while waiting:
        fresh = order.get(waiting.pop(), set()) - found
        found |= fresh
        waiting += fresh
    return found


def signs_of(relation: Relation) -> tuple[int, int] | None:
    """Return which way u and w grow from relatum to referent; None if the angle is not about one of the four axes."""
    if relation.arity != 2 or not isinstance(relation.angle, Normal):
        return None
    quarters = relation.angle.mean.value / (0.5 * math.pi)
    if abs(quarters - round(quarters)) > _TOLERANCE:
        return None
    return _SIGNS[_RING[round(quarters) % 4]]


def _signs(relation: str) -> tuple[int, int]:
    if relation not in _SIGNS:
        raise UnknownNameError("direction", relation, _SIGNS)
    return _SIGNS[relation]
