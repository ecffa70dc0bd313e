"""Which atoms share a frame of reference, and where its axis points on the map if that is known."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from qsrlang.language.syntax import Frame
from qsrlang.relations.graph import Landmark, RelationGraph

_DECIMALS = 9


@dataclass(frozen=True, slots=True)
class Axis:
    """The axis of a frame: atoms of equal `key` share it; `direction` [rad] and its `deviation` on the map, if known.

    `hand` is -1 where left is the relatum's own left, so that angles grow clockwise.
    """

    key: object
    direction: float | None = None
    deviation: float = 0.0
    hand: int = 1


NO_FRAME = Axis("none")
_ABSOLUTE = Axis("absolute", 0.5 * math.pi)


@dataclass(frozen=True, slots=True)
class Axes:
    """The axes of a graph without a viewer: an object faces as the landmarks do that chains lead from it to.

    `facing` tells which landmarks those are.
    """

    graph: RelationGraph
    landmarks: Mapping[str, Landmark]
    facing: Mapping[str, frozenset[Landmark]]
    alone: Mapping[str, str]

    @classmethod
    def of(cls, graph: RelationGraph) -> Axes:
        """Return the axes of a graph."""
        kinds = defaultdict(list)
        for landmark in graph.landmarks:
            kinds[landmark.kind].append(landmark.name)
        alone = {kind: names[0] for kind, names in kinds.items() if len(names) == 1}
        landmarks = {landmark.name: landmark for landmark in graph.landmarks}
        return cls(graph, landmarks, _facing(graph, landmarks, alone), alone)

    def named(self, name: str) -> str:
        """Return the landmark that a class stands for where it has one alone; other names stand for themselves."""
        return self.alone.get(name, name)

    def axis(self, relatum: str, frame: Frame) -> Axis:
        """Return the axis of atoms with this relatum in a frame.

        Atoms in the relative frame share it, unless chains lead to landmarks that face differently.
        """
        if frame is Frame.ABSOLUTE:
            return _ABSOLUTE
        known = self._heading(self.facing.get(relatum, frozenset()))
        direction, deviation = (None, 0.0) if known is None else (known[0] + math.pi, known[1])
        if frame is Frame.INTRINSIC:
            return Axis(("intrinsic", relatum), direction, deviation, -1)
        return Axis(self._relative_key(relatum), direction, deviation)

    def _relative_key(self, relatum: str) -> object:
        every = {_rounded(one.heading) for facing in self.facing.values() for one in facing}
        if len(every) < 2:
            return "relative"
        own = {_rounded(one.heading) for one in self.facing.get(relatum, ())}
        return ("relative", next(iter(own))) if len(own) == 1 else ("relative", relatum)

    def _heading(self, landmarks: Iterable[Landmark]) -> tuple[float, float] | None:
        headings = {one.heading for one in landmarks}
        if len(headings) != 1 or None in headings:
            return None
        (heading,) = headings
        assert heading is not None
        return heading, max(one.deviation[2] for one in landmarks)


def _facing(
    graph: RelationGraph, landmarks: Mapping[str, Landmark], alone: Mapping[str, str]
) -> Mapping[str, frozenset[Landmark]]:
    """Return the landmarks that chains lead to from each name."""
    before: dict[str, set[str]] = defaultdict(set)
    for choice in graph.choices:
        for alternative in choice.alternatives:
            for one in alternative.constraints:
                for relatum in one.relata:
                    before[alone.get(relatum, relatum)].add(alone.get(one.referent, one.referent))
    found: dict[str, set[Landmark]] = defaultdict(set)
    for landmark in landmarks.values():
        for name in _reaching({landmark.name, landmark.kind}, before, landmarks):
            found[name].add(landmark)
    return {name: frozenset(roots) for name, roots in found.items()}


def _reaching(goals: set[str], before: Mapping[str, set[str]], landmarks: Mapping[str, Landmark]) -> set[str]:
    found, waiting = set(goals), list(goals)
    while waiting:
        fresh = before.get(waiting.pop(), set()) - found - landmarks.keys()
        found |= fresh
        waiting += fresh
    return found


def _rounded(heading: float | None) -> float | None:
    return None if heading is None else round(heading % (2.0 * math.pi), _DECIMALS)
