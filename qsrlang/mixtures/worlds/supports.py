"""What a referent stands on or lies in: where its way ends, and which surface that is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from qsrlang.errors import MissingFacingError
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2
from qsrlang.relations.graph import Constraint, Landmark, ObjectClass, RelationGraph


@dataclass(frozen=True, slots=True)
class Seat:
    """A placed object: its block of the state (a landmark's own name, or that of a class), and its chain's root."""

    block: str
    root: Landmark

    def __hash__(self) -> int:
        return hash(self.block)

    @property
    def is_landmark(self) -> bool:
        """Whether the object is a landmark itself."""
        return self.block == self.root.name


@dataclass(frozen=True, slots=True)
class Support:
    """A placed object that carries or contains a referent; it may be the relatum itself."""

    kind: ObjectClass
    seat: Seat
    is_relatum: bool

    @property
    def outline(self) -> ConvexPolygon:
        """The outline of its box in its own frame."""
        return _outline(self.kind)


def in_region(constraint: Constraint) -> bool:
    """Return whether a constraint speaks of a part of its relatum: its top or its inside."""
    return constraint.atoms[0].relation.region is not None


def stated_regions(constraints: Iterable[Constraint]) -> dict[str, tuple[str, ...]]:
    """Return what each referent is said to be on or in."""
    regions: dict[str, tuple[str, ...]] = {}
    for one in filter(in_region, constraints):
        regions[one.referent] = (*regions.get(one.referent, ()), one.relatum)
    return regions


def support_of(
    graph: RelationGraph,
    constraint: Constraint,
    regions: Mapping[str, tuple[str, ...]],
    seats: Mapping[str, Seat],
) -> Support | None:
    """Return what bounds the distances of a constraint, given the regions stated in its world and what is placed.

    That is what the referent is said to be on or in, where the constraint's relatum is that too; else the surface
    its class stands on. None where neither is known, and for regions and ternary relations, which bound themselves.
    """
    if constraint.towards is not None or in_region(constraint):
        return None
    stated = _stated_support(graph, constraint, regions, seats)
    return stated or _usual_support(graph, constraint, seats[constraint.relatum].root)


def _stated_support(
    graph: RelationGraph,
    constraint: Constraint,
    regions: Mapping[str, tuple[str, ...]],
    seats: Mapping[str, Seat],
) -> Support | None:
    for name in regions.get(constraint.referent, ()):
        if name not in seats:
            continue
        kind, seat, is_relatum = graph.classes[graph.class_of(name)], seats[name], name == constraint.relatum
        if kind.width == 0.0 or seat.root.heading is None:
            continue
        within = is_relatum or name in regions.get(constraint.relatum, ())
        if within or (seat.is_landmark and _carries(graph, seat.root, seats[constraint.relatum].root)):
            return Support(kind, seat, is_relatum)
    return None


def _usual_support(graph: RelationGraph, constraint: Constraint, root: Landmark) -> Support | None:
    """Return the surface of the class that referent or relatum stands `on`, if the root landmark is on it."""
    wanted = (
        graph.classes[graph.class_of(constraint.referent)].on
        or graph.classes[graph.class_of(constraint.relatum)].on
    )
    if wanted is None or graph.classes[wanted].width == 0.0:
        return None
    for landmark in graph.instances_of(wanted):
        if _carries(graph, landmark, root):
            is_relatum = constraint.relatum in (landmark.name, landmark.kind)
            return Support(graph.classes[landmark.kind], Seat(landmark.name, landmark), is_relatum)
    return None


def _carries(graph: RelationGraph, surface: Landmark, root: Landmark) -> bool:
    if surface.name == root.name:
        return True
    if surface.heading is None:
        raise MissingFacingError(surface.name, "the outline of a support")
    pose = Pose2(surface.x, surface.y, surface.heading)
    inside = _outline(graph.classes[surface.kind]).contains(pose.transform_inverse([root.x, root.y]))
    return bool(inside)


@lru_cache(maxsize=256)
def _outline(kind: ObjectClass) -> ConvexPolygon:
    return ConvexPolygon.rectangle(Pose2(0.0, 0.0), kind.depth, kind.width)
