"""Facts as half-planes: what they imply of the place of a referent, given that of its relatum.

Every region is drawn no smaller than it is, so that what is found impossible surely is: circles as the polygons around
them, angles closed and with the deviation of the landmark that turns their axis, boxes by the most they can reach.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from qsrlang.language.syntax import Dimension, Uniform
from qsrlang.relations.algebra import signs_of
from qsrlang.relations.consistency.claims import Fact
from qsrlang.relations.graph import Landmark, ObjectClass, RelationGraph

SIDES = 16
OUTWARD = 8
CERTAIN = 3.0
"""How many deviations a landmark may be off."""
_QUARTER = 0.25 * math.pi
_AXES = {(1, 1): 0.0, (1, -1): 0.5 * math.pi, (-1, -1): math.pi, (-1, 1): 1.5 * math.pi}


@dataclass(frozen=True, slots=True)
class HalfPlane:
    """normal . (position of `name` - position of `other`) <= bound [m]."""

    name: str
    other: str
    normal: tuple[float, float]
    bound: float


@dataclass(frozen=True, slots=True)
class Regions:
    """Draws the regions of facts for a graph."""

    graph: RelationGraph

    def half_planes(self, fact: Fact) -> tuple[HalfPlane, ...]:
        """Return what a fact implies of places: its sector, its greatest distance, the outline it lies in."""
        if len(fact.names) != 2:
            return ()
        return (*self._sector(fact), *self._disc(fact), *self._outline(fact))

    def outward(self, fact: Fact) -> tuple[HalfPlane, ...]:
        """Return half-planes of which at least one holds, since the referent is not nearer than it may be."""
        least = self.least(fact)
        if least <= 0.0:
            return ()
        bound = -least * math.cos(math.pi / OUTWARD)
        return tuple(_apart(fact, 2.0 * math.pi * k / OUTWARD, bound) for k in range(OUTWARD))

    def support(self, name: str, roots: Iterable[Landmark]) -> Landmark | None:
        """Return the landmark that carries an object: the only one its class stands on, if all its roots are on it."""
        wanted = self._kind(name).on
        carriers = [one for one in self.graph.landmarks if one.kind == wanted and one.name != name]
        roots = [one for one in roots if one.name != name]
        if len(carriers) == 1 and roots and all(self._is_on(one, carriers[0]) for one in roots):
            return carriers[0]
        return None

    def on_support(self, name: str, carrier: Landmark) -> tuple[HalfPlane, ...]:
        """Return the sides of what carries an object."""
        return tuple(self._box(name, carrier))

    def _is_on(self, landmark: Landmark, carrier: Landmark) -> bool:
        offset = landmark.x - carrier.x, landmark.y - carrier.y
        return all(
            side.normal[0] * offset[0] + side.normal[1] * offset[1] <= side.bound
            for side in self._box(landmark.name, carrier)
        )

    def bounds_below(self, fact: Fact) -> bool:
        """Return whether a fact keeps its referent away from its relatum."""
        return len(fact.names) == 2 and self.least(fact) > 0.0

    def _sector(self, fact: Fact) -> Iterator[HalfPlane]:
        middle = direction(fact)
        if middle is not None:
            half = min(_QUARTER + CERTAIN * fact.axis.deviation, 0.5 * math.pi)
            for normal in (middle + half - 0.5 * math.pi, middle - half + 0.5 * math.pi):
                yield _apart(fact, normal, 0.0)

    def _disc(self, fact: Fact) -> Iterator[HalfPlane]:
        most = self._most(fact)
        if math.isfinite(most):
            for k in range(SIDES):
                normal = _unit(2.0 * math.pi * k / SIDES)
                yield HalfPlane(fact.names[0], fact.names[1], normal, most)

    def _outline(self, fact: Fact) -> Iterator[HalfPlane]:
        """Yield the sides of the landmark that a referent is on or in."""
        landmark = next((one for one in self.graph.landmarks if one.name == fact.names[1]), None)
        if fact.relation.region is not None and landmark is not None:
            yield from self._box(fact.names[0], landmark)

    def _box(self, name: str, landmark: Landmark) -> Iterator[HalfPlane]:
        """Yield the four sides of a landmark's box, if its size and heading are known, that hold a name."""
        kind = self._kind(landmark.name)
        if landmark.heading is None or kind.width == 0.0 or kind.depth == 0.0:
            return
        slack = CERTAIN * landmark.deviation[2] * _diagonal(kind)
        for quarter in range(4):
            half = 0.5 * (kind.depth, kind.width)[quarter % 2] + slack
            normal = _unit(landmark.heading + quarter * 0.5 * math.pi)
            yield HalfPlane(name, landmark.name, normal, half)

    def _most(self, fact: Fact) -> float:
        """Return the greatest distance between the centres [m]: from contact, some share of the way or some length.

        What may be at the edge may be beyond it.
        """
        distance = fact.relation.distance
        if not isinstance(distance, Uniform) or _reaches_the_edge(distance):
            return math.inf
        contact = sum(_radius(self._kind(name)) for name in fact.names)
        if distance.high.dimension is not Dimension.FRACTION:
            return contact + distance.high.value
        way = max(contact + self.graph.reach, *(_diagonal(kind) for kind in self._supports()))
        return contact + distance.high.value * max(0.0, way - contact)

    def least(self, fact: Fact) -> float:
        """Return the least distance between the centres [m]; none where the way to an edge may be short."""
        distance = fact.relation.distance
        if not isinstance(distance, Uniform):
            return 0.0
        if distance.low.dimension is not Dimension.FRACTION:
            return distance.low.value
        is_reach = not any(_diagonal(kind) for kind in self._supports())
        return distance.low.value * self.graph.reach if is_reach else 0.0

    def _supports(self) -> list[ObjectClass]:
        """Return what may end the way of a distance: every landmark's class, and a class without a size beside."""
        return [self._kind(one.name) for one in self.graph.landmarks] + [ObjectClass("", "surface")]

    def _kind(self, name: str) -> ObjectClass:
        return self.graph.classes[self.graph.class_of(name)]


def _reaches_the_edge(distance: Uniform) -> bool:
    return distance.high.dimension is Dimension.FRACTION and distance.high.value >= 1.0


def direction(fact: Fact) -> float | None:
    """Return where on the map a direction points [rad]; None where its axis is not known, or it is no direction."""
    signs = signs_of(fact.relation)
    if signs is None or fact.axis.direction is None:
        return None
    return fact.axis.direction + fact.axis.hand * _AXES[signs]


def far(fact: Fact, other: Fact, least: float) -> HalfPlane | None:
    """Return how far along its axis a referent lies that has a direction and a least distance of one relatum."""
    middle = direction(fact)
    half = _QUARTER + CERTAIN * fact.axis.deviation
    if middle is None or fact.names != other.names or half >= 0.5 * math.pi:
        return None
    return _apart(fact, middle, -least * math.cos(half))


def within(landmark: Landmark) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return between which x, and between which y, a landmark surely is [m]."""
    dx, dy = (CERTAIN * one for one in landmark.deviation[:2])
    return (landmark.x - dx, landmark.x + dx), (landmark.y - dy, landmark.y + dy)


def _apart(fact: Fact, angle: float, bound: float) -> HalfPlane:
    """Return -unit(angle) . (referent - relatum) <= bound."""
    x, y = _unit(angle)
    return HalfPlane(fact.names[0], fact.names[1], (-x, -y), bound)


def _unit(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


def _diagonal(kind: ObjectClass) -> float:
    return math.hypot(kind.width, kind.depth)


def _radius(kind: ObjectClass) -> float:
    return 0.5 * _diagonal(kind)
