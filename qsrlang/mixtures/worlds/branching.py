"""The worlds of a tree: what is open about each thing is a choice of its own, so that no drafts are needed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush
from itertools import count
from typing import NamedTuple

from qsrlang.language.syntax import Atom
from qsrlang.mixtures.worlds.drafts import MIN_SHARE, Outcome
from qsrlang.mixtures.worlds.enumeration import MIN_REST, World, Worlds
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.plans import Plan, Step, landmarks_of
from qsrlang.mixtures.worlds.trees import Tree, Twig
from qsrlang.relations.graph import Constraint, Landmark, RelationGraph


class Option(NamedTuple):
    """One way to decide about a thing: its name, the share of the mass, and of the greatest share; the step that places
    it, None where it is elsewhere; and what is decided by that.
    """

    name: str
    share: float
    likeness: float
    step: Step | None
    decided: tuple[tuple[float, Outcome], ...]


class _Branch(NamedTuple):
    """Decisions on the first `at` things of a tree: the last one `taken`, after those of `before`.

    Of branches, as tuples, the first is the best: by likeness, then by depth. `reached` has a bit for each thing to be
    looked at.
    """

    unlikeness: float
    shallowness: int
    number: int
    weight: float
    at: int
    reached: int
    taken: Option | None = None
    before: _Branch | None = None

    @property
    def is_reached(self) -> bool:
        """Whether the next thing is one to be looked at."""
        return bool(self.reached >> self.at & 1)

    def options(self) -> list[Option]:
        """Return all options that were taken, from the first to the last."""
        found, branch = [], self
        while branch.taken is not None and branch.before is not None:
            found.append(branch.taken)
            branch = branch.before
        return found[::-1]


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
        numbers, rest = count(), 1.0
        wanted = sum([1 << at for at, name in enumerate(self.names) if name in self.targets])
        waiting = [_Branch(-1.0, 0, next(numbers), 1.0, 0, wanted)]
        while waiting and len(found) < limit and rest > MIN_REST:
            branch = self._forced(heappop(waiting))
            if branch.at == len(self.names):
                found.append(self._world(branch))
                rest -= branch.weight
                continue
            for option in self.options[branch.at]:
                heappush(waiting, self._taking(branch, option, next(numbers)))
        return Worlds(tuple(found), max(rest, 0.0) if waiting else 0.0)

    def _forced(self, branch: _Branch) -> _Branch:
        """Return a branch at the next thing to be looked at of which something is open."""
        while branch.at < len(self.names):
            options = self.options[branch.at]
            if not branch.is_reached:
                branch = branch._replace(at=branch.at + 1)
            elif len(options) == 1:
                branch = self._taking(branch, options[0], branch.number)
            else:
                break
        return branch

    def _taking(self, branch: _Branch, option: Option, number: int) -> _Branch:
        parent = self.parents[branch.at]
        return _Branch(
            branch.unlikeness * option.likeness,
            branch.shallowness - 1,
            number,
            branch.weight * option.share,
            branch.at + 1,
            branch.reached if option.step is None or parent is None else branch.reached | 1 << parent,
            option,
            branch,
        )

    def _world(self, branch: _Branch) -> World:
        taken = branch.options()
        steps = [option.step for option in taken if option.step is not None]
        bindings: dict[str, Landmark] = {}
        decided = [one for option in taken for one in option.decided]
        names = [step.constraint.relatum for step in steps if step.relatum.is_landmark]
        for name in (*names, *self.targets):
            seat = self.tree.seats[name]
            if seat.is_landmark and name not in bindings:
                bindings[name] = seat.root
                decided.append((1.0, seat.root))
        return World(
            branch.weight,
            tuple([step.constraint for step in steps]),
            tuple(bindings.items()),
            absent=tuple([option.name for option in taken if option.step is None]),
            decided=tuple(decided),
        )


def _options(twig: Twig, in_parts: bool) -> tuple[Option, ...]:
    name = twig.step.constraint.referent
    alternatives = [one for one in twig.alternatives if one.share > 0.0]
    rest = 1.0 - sum([one.share for one in alternatives])
    is_open = rest > MIN_SHARE
    greatest = max([one.share for one in alternatives] + [rest] * is_open)
    options = [Option(name, rest, rest / greatest, None, ((rest, twig.choice),))] if is_open else []
    for one in alternatives:
        whole = Option(
            name, one.share, one.share / greatest, twig.step.saying(one.constraints[0]), ((one.share, one),)
        )
        options += _parts(whole, one.constraints[0]) if in_parts else [whole]
    return tuple(options)


def _parts(whole: Option, said: Constraint) -> list[Option]:
    """Return the parts of equal mass that an option is split into, each as likely as the whole."""
    number, step = said.parts, whole.step
    if number == 1 or step is None:
        return [whole]
    parts = [replace(said, part=(at, number)) for at in range(number)]
    return [
        whole._replace(
            share=whole.share / number,
            step=step.saying(one),
            decided=(*whole.decided, (1.0 / number, one)),
        )
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
