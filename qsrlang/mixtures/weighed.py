"""What is found in a world, whichever way: its posterior weight, and where things are in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.mixtures.answers import Component, Where, mixture_of
from qsrlang.mixtures.reduction import MAX_COMPONENTS, reduced
from qsrlang.mixtures.worlds.chains import broken_chains
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.plans import Plan
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph

MIN_WEIGHT = 1e-12


class Weighed(Protocol):
    """A world with its plan and its posterior weight, of a total of 1."""

    @property
    def world(self) -> World:
        """The alternatives that hold in it."""

    @property
    def plan(self) -> Plan:
        """How it places things."""

    @property
    def weight(self) -> float:
        """Prior x evidence, normalised."""

    def place(self, seat: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2,) and covariance (2, 2) of a thing that it places."""


def component_of(weighed: Weighed, target: str) -> Component:
    """Return where a world places a target."""
    mean, covariance = weighed.place(weighed.plan.seats[weighed.world.named(target)])
    return Component(weighed.weight, mean, covariance, statements_of(weighed.plan))


def statements_of(plan: Plan) -> tuple[str, ...]:
    """Return the statements behind a plan, each once."""
    return tuple(dict.fromkeys(str(constraint.statement) for constraint in plan.constraints))


def answer_of(
    graph: RelationGraph,
    target: str,
    worlds: Sequence[Weighed],
    dropped: float,
    limit: int = MAX_COMPONENTS,
    assumed: tuple[str, ...] = (),
    draws: float | None = None,
) -> Where:
    """Return the answer that worlds make together, of `limit` components at most; raises UnreachedTargetError.

    Worlds of less than MIN_WEIGHT of what is claimed are left out.
    """
    placed = [one for one in worlds if one.world.named(target) in one.plan.seats]
    claimed = sum(one.weight for one in placed)
    if not claimed > 0.0:
        raise UnreachedTargetError(target, broken_chains(graph, target))
    kept = [component_of(one, target) for one in placed if one.weight >= MIN_WEIGHT * claimed]
    chosen = reduced(kept, limit)
    elsewhere = 1.0 - claimed if claimed < 1.0 - MIN_WEIGHT else 0.0
    return Where(target, "map", mixture_of(chosen), elsewhere, chosen, assumed, draws, dropped)
