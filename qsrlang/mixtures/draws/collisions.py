"""Which boxes of a scene may not overlap, and whether they do."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from qsrlang.arrays import BoolArray
from qsrlang.geometry.boxes import overlap
from qsrlang.mixtures.densities.stance import half_box
from qsrlang.mixtures.draws.drawing import Drawn
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat, in_region
from qsrlang.relations.graph import ObjectClass, RelationGraph


@dataclass(frozen=True, slots=True)
class Body:
    """A thing that takes up room: where it sits, and half the length and width of its box [m]."""

    seat: Seat
    half: tuple[float, float]


def pairs_apart(graph: RelationGraph, plan: Plan) -> tuple[tuple[Body, Body], ...]:
    """Return the pairs of bodies that must not overlap: not of a thing and what it stands on or in, nor of landmarks.

    Surfaces take up no room, and neither does what has no size.
    """
    held = _held(plan)
    seats = {seat.block: (seat, graph.classes[graph.class_of(name)]) for name, seat in plan.seats.items()}
    bodies = [
        Body(seat, half_box(kind.width, kind.depth)) for seat, kind in seats.values() if _is_solid(kind)
    ]
    return tuple(
        (one, other)
        for one, other in combinations(bodies, 2)
        if not (one.seat.is_landmark and other.seat.is_landmark)
        and other.seat.block not in held.get(one.seat.block, ())
        and one.seat.block not in held.get(other.seat.block, ())
    )


def collide(pairs: tuple[tuple[Body, Body], ...], drawn: Drawn) -> BoolArray:
    """Return in which draws (P,) some pair of bodies overlaps."""
    found = np.zeros(len(drawn.logs), dtype=bool)
    for one, other in pairs:
        yaws, other_yaws = (drawn.states[:, drawn.layout.pose(body.seat)[2]] for body in (one, other))
        offsets = drawn.points(other.seat) - drawn.points(one.seat)
        found |= overlap(offsets, yaws, other_yaws, one.half, other.half)
    return found


def _is_solid(kind: ObjectClass) -> bool:
    return not kind.is_surface and kind.width > 0.0 and kind.depth > 0.0


def _held(plan: Plan) -> dict[str, set[str]]:
    """Return, for each thing, what it stands on or in, and what that does, and so on."""
    held: dict[str, set[str]] = {}
    for constraint in plan.constraints:
        if in_region(constraint):
            holder = plan.seats[constraint.relatum].block
            own = held.setdefault(plan.seats[constraint.referent].block, set())
            own |= {holder, *held.get(holder, ())}
    return held
