"""Plans: in which order the constraints of a world place its objects, from landmarks to a target."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from qsrlang.mixtures.supports import Seat, Support, in_region, support_of
from qsrlang.mixtures.worlds import World, needed_for
from qsrlang.relations.graph import Constraint, Landmark, RelationGraph


@dataclass(frozen=True, slots=True)
class Step:
    """One constraint in the order of placing; `places` is False where it only adds to what is placed already.

    `second` is the second relatum of a ternary relation.
    """

    constraint: Constraint
    relatum: Seat
    second: Seat | None
    support: Support | None
    places: bool


@dataclass(frozen=True, slots=True)
class Plan:
    """The landmarks of a world, the steps that place its objects, and where each object sits in the state.

    `constraints` are those that the steps come from, and the regions that bound their distances.
    """

    landmarks: tuple[Landmark, ...]
    steps: tuple[Step, ...]
    seats: Mapping[str, Seat]
    constraints: tuple[Constraint, ...]


def plan_world(graph: RelationGraph, world: World, *targets: str) -> Plan:
    """Return how a world places targets; those that no chain of it ties to a landmark have no seat."""
    seats = {name: Seat(landmark.name, landmark) for name, landmark in world.bindings}
    waiting = [constraint for constraint in _helpful(world, targets) if constraint.referent not in seats]
    helpful = tuple(waiting)
    used: list[Constraint] = []
    steps: list[Step] = []
    while ready := [c for c in waiting if all(name in seats for name in c.relata)]:
        constraint = min(ready, key=lambda c: (c.referent not in seats, _delay(c, waiting)))
        waiting.remove(constraint)
        used.append(constraint)
        if not _bounds_already(constraint, seats, steps):
            steps.append(_step(graph, constraint, helpful, seats))
        seats.setdefault(constraint.referent, Seat(constraint.referent, seats[constraint.relatum].root))
    known = [landmark for _, landmark in world.bindings]
    known += [step.support.seat.root for step in steps if step.support]
    landmarks = tuple({one.name: one for one in known}.values())
    return Plan(landmarks, tuple(steps), seats, tuple(used))


def _delay(constraint: Constraint, waiting: list[Constraint]) -> int:
    """Return how long a constraint may wait: regions, which only bound what others tell, for as long as those may."""
    if not in_region(constraint):
        return 0
    others = (other for other in waiting if other.referent == constraint.referent and not in_region(other))
    return 2 if any(others) else 1


def _step(
    graph: RelationGraph, constraint: Constraint, others: tuple[Constraint, ...], seats: Mapping[str, Seat]
) -> Step:
    second = None if constraint.towards is None else seats[constraint.towards]
    support = support_of(graph, constraint, others, seats)
    return Step(constraint, seats[constraint.relatum], second, support, constraint.referent not in seats)


def _bounds_already(constraint: Constraint, seats: dict[str, Seat], steps: list[Step]) -> bool:
    """Return whether a region says nothing more, since its relatum bounds where its referent was placed."""
    return in_region(constraint) and any(
        step.constraint.referent == constraint.referent
        and step.support is not None
        and step.support.seat == seats[constraint.relatum]
        for step in steps
    )


def step_of(graph: RelationGraph, constraint: Constraint, seats: Mapping[str, Seat]) -> Step:
    """Return a constraint between objects that sit already."""
    return _step(graph, constraint, (), seats)


def _helpful(world: World, targets: tuple[str, ...]) -> list[Constraint]:
    """Return the constraints that help to place targets, in an order that is always the same."""
    needed = needed_for([world.named(target) for target in targets], world.constraints)
    absent = {world.named(name) for name in world.absent}
    helpful = [one for one in world.constraints if one.referent in needed and one.referent not in absent]
    return sorted(helpful, key=lambda c: (c.referent, *c.relata))
