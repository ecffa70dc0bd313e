"""Truth tables: how probable each combination of atoms is in a world, from the densities that were stated."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial, reduce
from itertools import product

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Formula, Not, Or
from qsrlang.mixtures.densities.conditional import PolarConditional
from qsrlang.mixtures.densities.sectors import arcs_of
from qsrlang.mixtures.densities.stated import make_conditional
from qsrlang.mixtures.densities.windows import Window, share_inside
from qsrlang.mixtures.solving.linear import cubature
from qsrlang.mixtures.solving.weighing import Solved
from qsrlang.mixtures.worlds.enumeration import World
from qsrlang.mixtures.worlds.layout import Layout, compact_anchor
from qsrlang.mixtures.worlds.plans import Plan, Step, asked_step, seats_read
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph

MAX_ATOMS = 10


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """The atoms, by their numbers, that are asked of one pair, each as a step."""

    numbers: tuple[int, ...]
    steps: tuple[Step, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """One density that was stated of a pair, the windows of atoms on it, and the columns (K,) of what they read.

    There is one `table` of them (2, …, 2) where it is the same in every state: where it turns with a heading that is
    certain, or nothing that it reads is open.
    """

    density: PolarConditional
    windows: tuple[Window, ...]
    columns: IntArray
    table: FloatArray | None


class TruthTables:
    """P(atoms true or false) (2, …, 2) in worlds, one axis an atom, 1 for true.

    Worlds that place the same things, and those by the same statement, share what is found of a pair.
    """

    def __init__(self, graph: RelationGraph, atoms: Sequence[Atom], viewer: Pose2 | None) -> None:
        self._graph, self._atoms, self._viewer = graph, tuple(atoms), viewer
        self._relations = [graph.relations[atom.relation.text] for atom in atoms]
        self._arcs = [arcs_of(one, graph.relations) for one in self._relations]
        self._asked: dict[int, tuple[Layout, tuple[Asked, ...]]] = {}
        self._pairs: dict[tuple[int, int, int], Pair | None] = {}

    def of(self, solved: Solved) -> tuple[FloatArray, bool] | None:
        """Return the table of a world and whether it is exact; None where only draws tell.

        Each pair that is asked about has to be one of which one stated density alone tells; where nothing is fused and
        those are certain, different pairs are independent. Of one pair, what its density reads may be open, and a
        Gaussian. Atoms on what is not placed are false.
        """
        if solved.plan.fused or len(self._atoms) > MAX_ATOMS:
            return None
        asked = self.asked(solved.world, solved.plan)
        placing = {step.referent: step for step in solved.plan.steps if step.places}
        table, exact = np.ones((1,) * len(self._atoms)), True
        for one in asked:
            pair = self._pair(solved, one, placing)
            if pair is None or (pair.table is None and len(asked) > 1):
                return None
            exact &= pair.table is not None
            shares = _averaged(pair, solved) if pair.table is None else pair.table
            table = table * along(shares, one.numbers, len(self._atoms))
        placed = {number for one in asked for number in one.numbers}
        for number in set(range(len(self._atoms))) - placed:
            table = table * along(np.array([1.0, 0.0]), (number,), len(self._atoms))
        return table, exact

    def asked(self, world: World, plan: Plan) -> tuple[Asked, ...]:
        """Return what is asked in worlds of one layout, pair by pair."""
        layout = plan.layout
        if id(layout) not in self._asked:
            groups: dict[tuple[Seat, Seat], list[tuple[int, Step]]] = defaultdict(list)
            for number, atom in enumerate(self._atoms):
                step = asked_step(self._graph, world, plan.seats, atom)
                if step is not None:
                    groups[step.referent, step.relatum].append((number, step))
            asked = tuple(Asked(*zip(*group, strict=True)) for group in groups.values())
            self._asked[id(layout)] = layout, asked
        return self._asked[id(layout)][1]

    def _pair(self, solved: Solved, asked: Asked, placing: Mapping[Seat, Step]) -> Pair | None:
        step = placing.get(asked.steps[0].referent)
        if step is None or step.relatum != asked.steps[0].relatum or step.second or asked.steps[0].second:
            return None
        key = (id(solved.plan.layout), id(step.constraint), asked.numbers[0])
        if key not in self._pairs:
            self._pairs[key] = self.read(solved.plan.layout, step, asked)
        return self._pairs[key]

    def read(self, layout: Layout, placing: Step, asked: Asked) -> Pair | None:
        """Return what the density of a step says of the atoms asked of its pair; None where it is not a polar one."""
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
        columns = np.array([column for seat in seats for column in layout.pose(seat)])
        state = _only_state(polar, layout, columns)
        none = np.zeros((len(columns),) * 2)
        table = None if state is None else _shares(polar[0], windows, state.tobytes(), none.tobytes())
        return Pair(polar[0], windows, columns, table)


def truth_of(formula: Formula, atoms: Sequence[Atom]) -> BoolArray:
    """Return whether a formula holds for each combination of its atoms being true or false: (2, …, 2)."""
    match formula:
        case Atom():
            at = next(number for number, atom in enumerate(atoms) if atom is formula)
            held: BoolArray = np.array([False, True])
            return held.reshape([2 if axis == at else 1 for axis in range(len(atoms))])
        case Not(part=part):
            return ~truth_of(part, atoms)
        case And(parts=parts):
            return reduce(np.logical_and, (truth_of(part, atoms) for part in parts))
        case Or(parts=parts):
            return reduce(np.logical_or, (truth_of(part, atoms) for part in parts))


def _only_state(polar: Sequence[PolarConditional], layout: Layout, columns: IntArray) -> FloatArray | None:
    """Return the state (K,) that tells of all: any place, where all turn with a heading that is certain."""
    is_free, heading = layout.free[columns], float(layout.mean[columns[2]])
    if not is_free[2] and all(one.turns(heading, True) for one in polar):
        return np.where(np.arange(len(columns)) == 2, heading, 0.0)
    return None if is_free.any() else layout.mean[columns]


def _averaged(pair: Pair, solved: Solved) -> FloatArray:
    """Return P(atoms of a pair true or false) (2, …, 2), over a cubature of what its density reads."""
    mean, covariance = solved.posterior.mean[pair.columns], solved.posterior.covariance(pair.columns)
    return _shares(pair.density, pair.windows, mean.tobytes(), covariance.tobytes())


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


def along(table: FloatArray, numbers: Sequence[int], count: int) -> FloatArray:
    """Return a table over some atoms, in rising order, as one over all of them."""
    return table.reshape([2 if number in numbers else 1 for number in range(count)])
