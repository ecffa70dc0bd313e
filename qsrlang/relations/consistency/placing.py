"""Contradictions with numbers: whether objects can be placed on the map, by linear programming.

Variables are the positions of all objects; landmarks lie within CERTAIN deviations of where they are said to be. Each
half-plane a . x <= b of a fact may be missed by t >= 0, and the least t is sought: where it is 0 the objects can be
placed; where it is not, the half-planes with a price at the optimum contradict each other (Farkas' lemma). Least
distances are not convex: where a placement breaks one, the sides on which its referent may lie are tried in turn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array

from qsrlang.arrays import FloatArray
from qsrlang.relations.consistency.claims import Fact
from qsrlang.relations.consistency.frames import Axes
from qsrlang.relations.consistency.regions import HalfPlane, Regions, direction, far, within
from qsrlang.relations.consistency.searching import Undecided
from qsrlang.relations.graph import Landmark, RelationGraph

MAX_SPLITS = 200
_MISSED = 1e-5
_PRICED = 1e-9


@dataclass(frozen=True, slots=True)
class Placing:
    """Judges whether facts about the landmarks and objects of a graph can be placed on the map."""

    regions: Regions
    landmarks: Mapping[str, Landmark]
    carriers: Mapping[str, Landmark] = field(default_factory=dict)
    memory: dict[Fact, tuple[HalfPlane, ...]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, graph: RelationGraph) -> Placing:
        """Return the judge of a graph."""
        regions = Regions(graph)
        carriers = {}
        for name, roots in Axes.of(graph).facing.items():
            carrier = regions.support(name, roots)
            if carrier is not None:
                carriers[name] = carrier
        return cls(regions, {one.name: one for one in graph.landmarks}, carriers)

    def __call__(self, facts: Sequence[Fact]) -> Sequence[Fact]:
        """Return facts that cannot be placed together, or nothing; raises Undecided beyond MAX_SPLITS."""
        if not self.can_clash(facts):
            return ()
        return _Placement(self, facts).clash()

    def can_clash(self, facts: Sequence[Fact]) -> bool:
        """Return whether numbers matter: two landmarks are spoken of, or something keeps apart.

        Otherwise everything may be shrunk towards one point without leaving a sector or a disc.
        """
        return len(self.poses_behind(facts)) > 1 or any(self.regions.bounds_below(fact) for fact in facts)

    def half_planes(self, fact: Fact) -> tuple[HalfPlane, ...]:
        """Return what a fact implies of places; remembered, for a search asks again and again."""
        if fact not in self.memory:
            self.memory[fact] = self.regions.half_planes(fact)
        return self.memory[fact]

    def poses_behind(self, facts: Sequence[Fact]) -> tuple[str, ...]:
        """Return the landmarks that facts speak of, and those that carry what they speak of."""
        names = {name for fact in facts for name in fact.names}
        carriers = {self.carriers[name].name for name in names & self.carriers.keys()}
        return tuple(sorted((names & self.landmarks.keys()) | carriers))

    def supports(self, facts: Sequence[Fact]) -> list[_Row]:
        """Return the outlines of what carries the objects that facts speak of."""
        names = {name for fact in facts for name in fact.names}
        carried = sorted(names & self.carriers.keys() - self.landmarks.keys())
        return [((), side) for name in carried for side in self.regions.on_support(name, self.carriers[name])]


_Row: TypeAlias = tuple[tuple[Fact, ...], HalfPlane]
"""A half-plane and the facts that together imply it; none where what is known of landmarks does."""


@dataclass(slots=True)
class _Placement:
    """One attempt to place facts; `left` counts the programmes that may still be solved."""

    placing: Placing
    facts: Sequence[Fact]
    left: int = MAX_SPLITS

    def clash(self) -> Sequence[Fact]:
        rows: list[_Row] = [((fact,), one) for fact in self.facts for one in self.placing.half_planes(fact)]
        apart = self._keeping_apart(rows)
        return self._split([*rows, *self.placing.supports(self.facts)], apart)

    def _keeping_apart(self, rows: list[_Row]) -> list[tuple[Fact, tuple[HalfPlane, ...]]]:
        """Return the facts with a least distance, with their sides; add what follows with a direction beside one."""
        directed = {fact.names: fact for fact in self.facts if direction(fact) is not None}
        found = []
        for fact in self.facts:
            if self.placing.regions.bounds_below(fact):
                beside = directed.get(fact.names)
                least = self.placing.regions.least(fact)
                one = far(beside, fact, least) if beside else None
                if beside and one:
                    rows.append(((fact, beside), one))
                found.append((fact, self.placing.regions.outward(fact)))
        return found

    def _split(self, rows: list[_Row], apart: list[tuple[Fact, tuple[HalfPlane, ...]]]) -> Sequence[Fact]:
        self.left -= 1
        if self.left < 0:
            raise Undecided
        places, clashing = self._solve(rows)
        if clashing:
            return clashing
        broken = next((one for one in apart if not _holds_any(one[1], places)), None)
        if broken is None:
            return ()
        fact, sides = broken
        others = [one for one in apart if one is not broken]
        together: dict[Fact, None] = {}
        for side in sides:
            found = self._split([*rows, ((fact,), side)], others)
            if not any(one is fact for one in found):
                return found
            together |= dict.fromkeys(found)
        return tuple(together)

    def _solve(self, rows: Sequence[_Row]) -> tuple[Mapping[str, FloatArray], Sequence[Fact]]:
        """Return where objects can be placed, or the facts whose half-planes have a price."""
        names = sorted({name for _, one in rows for name in (one.name, one.other)})
        column = {name: 2 * number for number, name in enumerate(names)}
        if not rows:
            return {}, ()
        matrix, bounds = _programme(rows, column)
        limits = list(chain.from_iterable(self._limits(name) for name in names))
        cost = np.zeros(2 * len(names) + 1)
        cost[-1] = 1.0
        solved = linprog(cost, A_ub=matrix, b_ub=bounds, bounds=[*limits, (0.0, None)], method="highs")
        if solved.x is None or solved.fun is None or solved.fun <= _MISSED:
            places = {} if solved.x is None else {name: solved.x[at : at + 2] for name, at in column.items()}
            return places, ()
        prices = np.flatnonzero(solved.ineqlin.marginals < -_PRICED).tolist()
        return {}, tuple(dict.fromkeys(fact for n in prices for fact in rows[n][0]))

    def _limits(self, name: str) -> tuple[tuple[float | None, float | None], ...]:
        landmark = self.placing.landmarks.get(name)
        return ((None, None), (None, None)) if landmark is None else within(landmark)


def _programme(rows: Sequence[_Row], column: Mapping[str, int]) -> tuple[Any, FloatArray]:
    """Return A and b of A (x, t) <= b: each half-plane a row, missed by t."""
    at, where, what = list[int](), list[int](), list[float]()
    for number, (_, one) in enumerate(rows):
        for name, sign in ((one.name, 1.0), (one.other, -1.0)):
            at += [number, number]
            where += [column[name], column[name] + 1]
            what += [sign * one.normal[0], sign * one.normal[1]]
        at.append(number)
        where.append(2 * len(column))
        what.append(-1.0)
    shape = (len(rows), 2 * len(column) + 1)
    return csr_array((what, (at, where)), shape=shape), np.array([one.bound for _, one in rows])


def _holds_any(sides: Sequence[HalfPlane], places: Mapping[str, FloatArray]) -> bool:
    """Return whether a placement keeps within at least one of some half-planes."""
    one = sides[0]
    if one.name not in places or one.other not in places:
        return False
    offset = places[one.name] - places[one.other]
    return any(float(np.dot(side.normal, offset)) <= side.bound + _MISSED for side in sides)
