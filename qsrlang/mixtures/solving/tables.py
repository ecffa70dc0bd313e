"""Truth tables: how probable each combination of atoms is in a world, from the densities that were stated."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial, reduce
from itertools import product
from typing import NamedTuple

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import NoRoomError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Formula, Not, Or
from qsrlang.mixtures.densities.conditional import PolarConditional
from qsrlang.mixtures.densities.sectors import Arcs, arcs_of
from qsrlang.mixtures.densities.stated import Words, make_conditional
from qsrlang.mixtures.densities.windows import Window, share_inside
from qsrlang.mixtures.solving.linear import cubature
from qsrlang.mixtures.solving.weighing import Solved
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.layout import Layout, compact_anchor
from qsrlang.mixtures.worlds.plans import Plan, Step, asked_step, seats_read
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import RelationGraph

MAX_ATOMS = 10


class Holding(NamedTuple):
    """An atom in words, and where its relation holds."""

    words: Words
    relation: Relation
    arcs: Arcs


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """The atoms, by their numbers, that are asked of one pair, each as a step; `said` where words tell all of them."""

    numbers: tuple[int, ...]
    steps: tuple[Step, ...]
    said: tuple[Holding, ...] | None


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """The density that a step states of a pair, and the windows of atoms on it, for states of the `seats` they read."""

    density: PolarConditional
    windows: tuple[Window, ...]
    seats: tuple[Seat, ...]

    def table(self) -> FloatArray | None:
        """Return the table (2, …, 2) of the atoms, where it is the same in every state."""
        polar = (self.density, *(window.polar for window in self.windows))
        state = _only_state(polar, self.seats)
        if state is None:
            return None
        return _shares(self.density, self.windows, state.tobytes(), bytes(8 * len(state) ** 2))

    def averaged(self, solved: Solved) -> FloatArray:
        """Return the table of the atoms in a world, over a cubature of what is read."""
        columns = np.array([column for seat in self.seats for column in solved.plan.layout.pose(seat)])
        mean, covariance = solved.posterior.mean[columns], solved.posterior.covariance(columns)
        return _shares(self.density, self.windows, mean.tobytes(), covariance.tobytes())


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """The table of what is asked of a pair, where that is the same in every state, else what tells of it in each."""

    table: FloatArray | None
    seen: Seen | None


class TruthTables:
    """P(atoms true or false) (2, …, 2) in worlds, one axis an atom, 1 for true.

    Worlds that place the same things, and those by the same statement, share what is found of a pair.
    """

    def __init__(self, graph: RelationGraph, atoms: Sequence[Atom], viewer: Pose2 | None) -> None:
        self._graph, self.atoms, self._viewer = graph, tuple(atoms), viewer
        self._relations = [graph.relations[atom.relation.text] for atom in atoms]
        self._arcs = [arcs_of(one, graph.relations) for one in self._relations]
        self._asked: dict[int, tuple[Layout, tuple[Asked, ...]]] = {}
        self._pairs: dict[tuple[int, int, int], Pair] = {}

    def of(self, solved: Solved) -> tuple[FloatArray, bool] | None:
        """Return the table of a world and whether it is exact; None where only draws tell.

        Each pair that is asked about has to be one of which one stated density alone tells; where nothing is fused and
        those are certain, different pairs are independent. Of one pair, what its density reads may be open, and a
        Gaussian. Atoms on what is not placed are false.
        """
        if solved.plan.fused or len(self.atoms) > MAX_ATOMS:
            return None
        asked = self.asked(solved.world, solved.plan)
        placing = {step.referent: step for step in solved.plan.steps if step.places}
        table, exact = np.ones((1,) * len(self.atoms)), True
        for one in asked:
            pair = self._pair(solved, one, placing)
            shares = pair.table
            if shares is None and pair.seen is not None and len(asked) == 1:
                shares, exact = pair.seen.averaged(solved), False
            if shares is None:
                return None
            table = table * along(shares, one.numbers, len(self.atoms))
        placed = {number for one in asked for number in one.numbers}
        unplaced = set(range(len(self.atoms))) - placed
        return table * nothing_holds(unplaced, len(self.atoms)), exact

    def asked(self, world: World, plan: Plan) -> tuple[Asked, ...]:
        """Return what is asked in worlds of one layout, pair by pair."""
        layout = plan.layout
        if id(layout) not in self._asked:
            self._asked[id(layout)] = layout, self.asked_of(world, plan.seats)
        return self._asked[id(layout)][1]

    def asked_of(self, world: World, seats: Mapping[str, Seat]) -> tuple[Asked, ...]:
        """Return what is asked of things that have seats, pair by pair."""
        groups: dict[tuple[Seat, Seat], list[tuple[int, Step]]] = defaultdict(list)
        for number, atom in enumerate(self.atoms):
            step = asked_step(self._graph, world, seats, atom)
            if step is not None:
                groups[step.referent, step.relatum].append((number, step))
        return tuple([self._asked_together(group) for group in groups.values()])

    def _asked_together(self, group: Iterable[tuple[int, Step]]) -> Asked:
        numbers, steps = zip(*group, strict=True)
        holding = []
        for number, step in zip(numbers, steps, strict=True):
            words = None if self._viewer is not None else Words.of(self._graph, step)
            if words is None:
                return Asked(numbers, steps, None)
            holding.append(Holding(words, self._relations[number], self._arcs[number]))
        return Asked(numbers, steps, tuple(holding))

    def _pair(self, solved: Solved, asked: Asked, placing: Mapping[Seat, Step]) -> Pair:
        """Return what is asked of a pair, if one polar density alone tells of it."""
        step = placing.get(asked.steps[0].referent)
        if step is None or step.relatum != asked.steps[0].relatum or step.second or asked.steps[0].second:
            return Pair(None, None)
        key = (id(solved.plan.layout), id(step.constraint), asked.numbers[0])
        if key not in self._pairs:
            self._pairs[key] = self.of_pair(step, asked)
        return self._pairs[key]

    def of_pair(self, placing: Step, asked: Asked) -> Pair:
        """Return what is asked of the pair that a step places."""
        table = self._in_words(placing, asked)
        seen = self._seen(placing, asked) if table is None else None
        return Pair(table if seen is None else seen.table(), seen)

    def _in_words(self, placing: Step, asked: Asked) -> FloatArray | None:
        said = None if asked.said is None else Words.of(self._graph, placing)
        if said is None or asked.said is None:
            return None
        root = placing.relatum.root
        return _shares_in_words(said, asked.said, root.heading, root.deviation[2] == 0.0)

    def _seen(self, placing: Step, asked: Asked) -> Seen | None:
        """Return the density of a step and the windows that are asked about; None where one is not polar."""
        seats = seats_read(placing, *asked.steps)
        anchor = partial(compact_anchor, seats)
        said = [make_conditional(self._graph, one, anchor, self._viewer) for one in (placing, *asked.steps)]
        polar = [one for one in said if isinstance(one, PolarConditional)]
        if len(polar) < len(said):
            return None
        windows = tuple(
            Window(seen, self._relations[number], self._arcs[number])
            for seen, number in zip(polar[1:], asked.numbers, strict=True)
        )
        return Seen(polar[0], windows, seats)


def truth_of(formula: Formula, atoms: Sequence[Atom]) -> BoolArray:
    """Return whether a formula holds for each combination of its atoms being true or false: (2, …, 2)."""
    match formula:
        case Atom():
            at = atoms.index(formula)
            held: BoolArray = np.array([False, True])
            return held.reshape([2 if axis == at else 1 for axis in range(len(atoms))])
        case Not(part=part):
            return ~truth_of(part, atoms)
        case And(parts=parts):
            return reduce(np.logical_and, (truth_of(part, atoms) for part in parts))
        case Or(parts=parts):
            return reduce(np.logical_or, (truth_of(part, atoms) for part in parts))


def _only_state(polar: Sequence[PolarConditional], seats: Sequence[Seat]) -> FloatArray | None:
    """Return the state (K,) that tells of all: any place, where all turn with a heading; or where nothing is open."""
    root = seats[0].root
    if all(one.turns(root.heading or 0.0, root.deviation[2] == 0.0) for one in polar):
        return np.array([0.0, 0.0, root.heading or 0.0, *([0.0] * 3 * (len(seats) - 1))])
    if any(not seat.is_landmark or any(seat.root.deviation) for seat in seats):
        return None
    return np.array(
        [value for seat in seats for value in (seat.root.x, seat.root.y, seat.root.heading or 0.0)]
    )


@lru_cache(maxsize=8192)
def _shares_in_words(
    said: Words, asked: tuple[Holding, ...], heading: float | None, is_certain: bool
) -> FloatArray | None:
    """Return the shares of a density in windows, as `_shares` does, by words alone.

    None where they depend on more; and where nothing has room, which is an error of the statement that says so, and is
    raised where that is at hand.
    """
    polar = [one.conditional(heading is not None) for one in (said, *(each.words for each in asked))]
    if not all(one.turns(heading or 0.0, is_certain) for one in polar):
        return None
    seen = tuple(Window(one, each.relation, each.arcs) for one, each in zip(polar[1:], asked, strict=True))
    try:
        return _shares(polar[0], seen, np.array([0.0, 0.0, heading or 0.0]).tobytes(), bytes(72))
    except NoRoomError:
        return None


@lru_cache(maxsize=8192)
def _shares(
    density: PolarConditional, windows: tuple[Window, ...], mean_bytes: bytes, covariance_bytes: bytes
) -> FloatArray:
    """Return the shares of a density inside of each combination of windows, and outside of the others.

    Those inside of some, whatever of the others, first; then by inclusion and exclusion, axis by axis.
    """
    mean = np.frombuffer(mean_bytes)
    states = cubature(mean, np.frombuffer(covariance_bytes).reshape(len(mean), -1), float(mean[2]))
    rays = density.density.rays(density.stance(states), strict=False).part(*density.part)
    table = np.ones((2,) * len(windows))
    for chosen in product((0, 1), repeat=len(windows)):
        inside = [window for window, is_in in zip(windows, chosen, strict=True) if is_in]
        table[chosen] = share_inside(inside, rays, states).mean()
    for axis in range(len(windows)):
        whole, part = np.split(table, 2, axis=axis)
        table = np.concatenate([whole - part, part], axis=axis)
    table.setflags(write=False)
    return table


def nothing_holds(numbers: Collection[int], count: int) -> FloatArray:
    """Return the table over all atoms in which some of them are false."""
    table = np.zeros([2 if number in numbers else 1 for number in range(count)])
    table[(0,) * count] = 1.0
    return table


def along(table: FloatArray, numbers: Sequence[int], count: int) -> FloatArray:
    """Return a table over some atoms, in rising order, as one over all of them."""
    return table.reshape([2 if number in numbers else 1 for number in range(count)])
