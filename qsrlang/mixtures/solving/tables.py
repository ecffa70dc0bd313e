"""Truth tables: how probable each combination of atoms is in a world, from the densities that were stated."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import product

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import And, Atom, Formula, Not, Or
from qsrlang.mixtures.densities.conditional import PolarConditional
from qsrlang.mixtures.densities.sectors import arcs_of
from qsrlang.mixtures.densities.stated import make_conditional
from qsrlang.mixtures.densities.windows import Window, share_inside
from qsrlang.mixtures.solving.linear import cubature
from qsrlang.mixtures.solving.weighing import Solved
from qsrlang.mixtures.worlds.layout import Layout, compact_anchor
from qsrlang.mixtures.worlds.plans import Step, asked_step, seats_read
from qsrlang.relations.graph import RelationGraph

MAX_ATOMS = 10


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """One density that was stated of a pair, the windows of atoms on it, and the columns (K,) of what they read.

    It is `certain` where it is the same in every state: it turns with a heading that is certain, or nothing that it
    reads is open.
    """

    density: PolarConditional
    windows: tuple[Window, ...]
    columns: IntArray
    certain: bool


def truth_table(
    graph: RelationGraph, solved: Solved, atoms: Sequence[Atom], viewer: Pose2 | None
) -> tuple[FloatArray, bool] | None:
    """Return P(atoms true or false) (2, …, 2) in a world, one axis an atom, 1 for true, and whether that is exact.

    None where only draws tell. Each pair that is asked about has to be one of which one stated density alone tells;
    where nothing is fused and those are certain, different pairs are independent. Of one pair, what its density reads
    may be open, and a Gaussian. Atoms on what is not placed are false.
    """
    if solved.plan.fused or len(atoms) > MAX_ATOMS:
        return None
    asked: dict[tuple[str, str], list[tuple[int, Step]]] = defaultdict(list)
    table = np.ones((1,) * len(atoms))
    for number, atom in enumerate(atoms):
        step = asked_step(graph, solved.world, solved.plan.seats, atom)
        if step is None:
            table = table * _along(np.array([1.0, 0.0]), (number,), len(atoms))
        else:
            asked[step.referent.block, step.relatum.block].append((number, step))
    exact = True
    for group in asked.values():
        pair = _pair(graph, solved, [(atoms[number], step) for number, step in group], viewer)
        if pair is None or not (pair.certain or len(asked) == 1):
            return None
        exact &= pair.certain
        table = table * _along(_table(pair, solved), [number for number, _ in group], len(atoms))
    return table, exact


def expectation(
    table: FloatArray, atoms: Sequence[Atom], factors: Sequence[tuple[Formula, float, float]]
) -> float:
    """Return E of a product of factors under a truth table: a formula each, its value if true, and if false."""
    number = {id(atom): at for at, atom in enumerate(atoms)}
    total = 0.0
    for values in product((0, 1), repeat=len(atoms)):
        mass = float(table[values])
        for formula, if_true, if_false in factors if mass > 0.0 else ():
            mass *= if_true if _holds(formula, values, number) else if_false
        total += mass
    return total


def _pair(
    graph: RelationGraph, solved: Solved, group: Sequence[tuple[Atom, Step]], viewer: Pose2 | None
) -> Pair | None:
    first = group[0][1]
    placing = [one for one in solved.plan.steps if one.referent == first.referent]
    if len(placing) != 1 or placing[0].relatum != first.relatum or placing[0].second or first.second:
        return None
    seats = seats_read(placing[0], *(step for _, step in group))
    anchor = partial(compact_anchor, seats)
    said = [
        make_conditional(graph, step, anchor, viewer) for step in (placing[0], *(step for _, step in group))
    ]
    polar = [one for one in said if isinstance(one, PolarConditional)]
    if len(polar) < len(said):
        return None
    density, *seen = polar
    windows = []
    for window, (atom, _) in zip(seen, group, strict=True):
        relation = graph.relations[atom.relation.text]
        windows.append(Window(window, relation, arcs_of(relation, graph.relations)))
    layout = solved.plan.layout
    columns = np.array([column for seat in seats for column in layout.pose(seat)])
    return Pair(density, tuple(windows), columns, _is_certain(polar, layout, columns))


def _is_certain(polar: Sequence[PolarConditional], layout: Layout, columns: IntArray) -> bool:
    is_free = layout.free[columns]
    heading = float(layout.mean[columns[2]])
    return not is_free.any() or (not is_free[2] and all(one.turns(heading, True) for one in polar))


def _table(pair: Pair, solved: Solved) -> FloatArray:
    """Return P(atoms of a pair true or false) (2, …, 2), over a cubature of what its density reads."""
    if pair.certain:
        mean, covariance = solved.plan.layout.mean[pair.columns], np.zeros((len(pair.columns),) * 2)
    else:
        posterior = solved.posterior
        mean, covariance = posterior.mean[pair.columns], posterior.covariance(pair.columns)
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


def _along(table: FloatArray, numbers: Sequence[int], count: int) -> FloatArray:
    """Return a table over some atoms, in rising order, as one over all of them."""
    return table.reshape([2 if number in numbers else 1 for number in range(count)])


def _holds(formula: Formula, values: Sequence[int], number: Mapping[int, int]) -> bool:
    match formula:
        case Atom():
            return bool(values[number[id(formula)]])
        case Not(part=part):
            return not _holds(part, values, number)
        case And(parts=parts):
            return all(_holds(part, values, number) for part in parts)
        case Or(parts=parts):
            return any(_holds(part, values, number) for part in parts)
