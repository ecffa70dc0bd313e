"""The worlds of a tree: what is open about each thing is a choice of its own, so that no drafts are needed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush
from itertools import count
from typing import NamedTuple, TypeAlias

from qsrlang.language.syntax import Atom
from qsrlang.mixtures.worlds.drafts import MIN_SHARE, Outcome
from qsrlang.mixtures.worlds.enumeration import MIN_REST, World, Worlds
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.plans import Plan, Step, landmarks_of
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.mixtures.worlds.trees import Tree, Twig
from qsrlang.relations.graph import Alternative, Constraint, Landmark, RelationGraph


class Option(NamedTuple):
    """One way to decide about a thing: its share of the mass, and of the greatest share; the step that places it, None
    where it is elsewhere; and what is decided by that.
    """

    share: float
    likeness: float
    step: Step | None
    decided: tuple[tuple[float, Outcome], ...]


Picks: TypeAlias = "tuple[int, Option, Picks] | None"


@dataclass(frozen=True, slots=True, eq=False)
class Branching:
    """What is open about each thing of a tree, from what hangs on others to what others hang on.

    `parents` are the numbers of the things that they hang on, None for landmarks; a thing is looked at where it is a
    target, or where something that is not elsewhere hangs on it.
    """

    tree: Tree
    targets: Sequence[str]
    names: tuple[str, ...]
    parents: tuple[int | None, ...]
    options: tuple[tuple[Option, ...], ...]

    @classmethod
    def of(cls, tree: Tree, targets: Sequence[str], in_parts: bool) -> Branching:
        """Return what is open; `in_parts` splits constraints whose relations ask for several components."""
        twigs = tree.twigs[::-1]
        names = tuple([twig.step.constraint.referent for twig in twigs])
        numbers = {name: number for number, name in enumerate(names)}
        parents = tuple([numbers.get(twig.step.constraint.relatum) for twig in twigs])
        return cls(tree, targets, names, parents, tuple([_options(twig, in_parts) for twig in twigs]))

    def worlds(self, limit: int) -> Worlds:
        """Return worlds, best first, in the order of `enumerate_worlds` but for ties."""
        found: list[World] = []
        number, rest = count(), 1.0
        wanted = sum([1 << at for at, name in enumerate(self.names) if name in self.targets])
        waiting: list[tuple[float, int, int, float, int, int, Picks]] = [
            (-1.0, 0, next(number), 1.0, 0, wanted, None)
        ]
        while waiting and len(found) < limit and rest > MIN_REST:
            unlikeness, depth, _, weight, at, reached, picks = heappop(waiting)
            while at < len(self.names) and not (reached >> at & 1 and len(self.options[at]) > 1):
                if reached >> at & 1:
                    (only,) = self.options[at]
                    weight, reached, picks = (
                        weight * only.share,
                        self._reach(reached, at, only),
                        (at, only, picks),
                    )
                at += 1
            if at == len(self.names):
                found.append(self._world(weight, picks))
                rest -= weight
                continue
            for option in self.options[at]:
                after = (at + 1, self._reach(reached, at, option), (at, option, picks))
                likeness = unlikeness * option.likeness
                heappush(waiting, (likeness, depth - 1, next(number), weight * option.share, *after))
        return Worlds(tuple(found), max(rest, 0.0) if waiting else 0.0)

    def _reach(self, reached: int, at: int, option: Option) -> int:
        parent = self.parents[at]
        return reached if option.step is None or parent is None else reached | 1 << parent

    def _world(self, weight: float, picks: Picks) -> World:
        taken = [*_unrolled(picks)][::-1]
        bindings: dict[str, Landmark] = {}
        decided: list[tuple[float, Outcome]] = []
        for at, option in taken:
            decided += option.decided
            if option.step is not None and self.parents[at] is None:
                _bind(option.step.constraint.relatum, option.step.relatum, bindings, decided)
        for name in self.targets:
            if self.tree.seats[name].is_landmark:
                _bind(name, self.tree.seats[name], bindings, decided)
        steps = [option.step for _, option in taken]
        return World(
            weight,
            tuple([step.constraint for step in steps if step is not None]),
            tuple(bindings.items()),
            absent=tuple([self.names[at] for at, option in taken if option.step is None]),
            decided=tuple(decided),
        )


def _unrolled(picks: Picks) -> Iterator[tuple[int, Option]]:
    while picks is not None:
        at, option, picks = picks
        yield at, option


def _bind(name: str, seat: Seat, bindings: dict[str, Landmark], decided: list[tuple[float, Outcome]]) -> None:
    if name not in bindings:
        bindings[name] = seat.root
        decided.append((1.0, seat.root))


def _options(twig: Twig, in_parts: bool) -> tuple[Option, ...]:
    alternatives = [one for one in twig.alternatives if one.share > 0.0]
    rest = 1.0 - sum([one.share for one in alternatives])
    is_open = rest > MIN_SHARE
    greatest = max([one.share for one in alternatives] + [rest] * is_open)
    options = [Option(rest, rest / greatest, None, ((rest, twig.choice),))] if is_open else []
    for one in alternatives:
        options += _parts(twig.step, one, one.share / greatest, in_parts)
    return tuple(options)


def _parts(step: Step, alternative: Alternative, likeness: float, in_parts: bool) -> list[Option]:
    (said,) = alternative.constraints
    decided = (alternative.share, alternative)
    if not in_parts or said.parts == 1:
        return [Option(alternative.share, likeness, step.saying(said), (decided,))]
    number = said.parts
    parts = [replace(said, part=(at, number)) for at in range(number)]
    return [
        Option(alternative.share / number, likeness, step.saying(one), (decided, (1.0 / number, one)))
        for one in parts
    ]


@dataclass(frozen=True, slots=True, eq=False)
class TreePlans:
    """Makes the plans of the worlds of a tree; those that place the same things share all but what is said of them."""

    graph: RelationGraph
    branching: Branching
    asked: Sequence[Atom]
    _alike: dict[tuple[str, ...], Plan] = field(default_factory=dict)
    _steps: dict[int, Step] = field(init=False)

    def __post_init__(self) -> None:
        options = [option for each in self.branching.options for option in each]
        steps = {id(one.step.constraint): one.step for one in options if one.step is not None}
        object.__setattr__(self, "_steps", steps)

    def of(self, world: World) -> Plan:
        """Return how a world places what it can."""
        placed = {name for name, _ in world.bindings}
        said: list[Constraint] = []
        for constraint in reversed(world.constraints):
            if constraint.relatum in placed:
                placed.add(constraint.referent)
                said.append(constraint)
        steps = tuple([self._steps[id(one)] for one in said])
        names = tuple([one.referent for one in said])
        if names not in self._alike:
            self._alike[names] = self._plan(world, steps, tuple(said))
        alike = self._alike[names]
        return Plan(alike.landmarks, steps, alike.seats, tuple(said), alike.layout)

    def _plan(self, world: World, steps: tuple[Step, ...], said: tuple[Constraint, ...]) -> Plan:
        names = [*(name for name, _ in world.bindings), *(one.referent for one in said)]
        seats = {name: self.branching.tree.seats[name] for name in names}
        landmarks = landmarks_of(self.graph, world, seats, steps, self.asked)
        layout = Layout.of(landmarks, [step.referent.block for step in steps])
        return Plan(landmarks, steps, seats, said, layout)
