"""Truth tables of trees, where each thing is placed by one other and each pair has a choice of its own.

There worlds need not be told apart: what is open about one pair does not depend on what is about another, but for
whether things are placed at all. The work grows with the sum of the alternatives, not with their product.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.language.syntax import Atom
from qsrlang.mixtures.solving.tables import Asked, TruthTables, along
from qsrlang.mixtures.worlds.enumeration import MIN_REST, World
from qsrlang.mixtures.worlds.plans import Plan, Step, planned_worlds
from qsrlang.mixtures.worlds.supports import Seat, in_region
from qsrlang.relations.graph import Alternative, RelationGraph


def tree_table(
    graph: RelationGraph, names: tuple[str, ...], atoms: Sequence[Atom], tables: TruthTables
) -> FloatArray | None:
    """Return P(atoms true or false) (2, …, 2) over all worlds; None where what is known of the names is no tree.

    T(X) = elsewhere x F(X) + sum_a share_a T_a(X) prod_Y T(Y) over the alternatives a of X and the things Y placed by
    it, T_a its table by one stated density and F(X) the table in which nothing holds of X and of what hangs on it.
    None too where something is elsewhere in the likeliest world, whose layout is that of the tree.
    """
    worlds, plans, _ = planned_worlds(graph, names, 1, atoms)
    if not worlds or not _is_tree(graph, worlds[0], plans[0]):
        return None
    asked = {one.steps[0].referent: one for one in tables.asked(worlds[0], plans[0])}
    placing = {step.referent: step for step in plans[0].steps}
    if sum(len(one.numbers) for one in asked.values()) < len(atoms):
        return None
    if any(not _is_of(one, placing.get(referent)) for referent, one in asked.items()):
        return None
    return _summed(graph, plans[0], asked, tables, len(atoms))


def _summed(
    graph: RelationGraph, plan: Plan, asked: dict[Seat, Asked], tables: TruthTables, count: int
) -> FloatArray | None:
    """Return the product of T(X) over what landmarks place, made from the last thing placed to the first."""
    whole = np.ones((1,) * count)
    inside: dict[Seat, FloatArray] = defaultdict(lambda: np.ones((1,) * count))
    hanging: dict[Seat, tuple[int, ...]] = defaultdict(tuple)
    for step in reversed(plan.steps):
        own = asked.get(step.referent)
        mixed = _mixed(graph, plan, step, own, tables, count)
        if mixed is None:
            return None
        numbers = (*(own.numbers if own else ()), *hanging[step.referent])
        table = mixed * inside[step.referent]
        rest = 1.0 - sum(one.share for one in _alternatives(graph, step))
        if rest > MIN_REST:
            table = table + rest * _nothing_holds(numbers, count)
        if step.relatum.is_landmark:
            whole = whole * table
        else:
            inside[step.relatum] = inside[step.relatum] * table
            hanging[step.relatum] += numbers
    return whole


def _mixed(
    graph: RelationGraph, plan: Plan, step: Step, asked: Asked | None, tables: TruthTables, count: int
) -> FloatArray | None:
    """Return sum_a share_a T_a of the alternatives of a pair."""
    alternatives = _alternatives(graph, step)
    if asked is None:
        return np.full((1,) * count, sum(one.share for one in alternatives))
    mixed = np.zeros((1,) * count)
    for one in alternatives:
        pair = tables.read(plan.layout, step.saying(one.constraints[0]), asked)
        if pair is None or pair.table is None:
            return None
        mixed = mixed + one.share * along(pair.table, asked.numbers, count)
    return mixed


def _nothing_holds(numbers: Sequence[int], count: int) -> FloatArray:
    table = np.ones((1,) * count)
    for number in numbers:
        table = table * along(np.array([1.0, 0.0]), (number,), count)
    return table


def _is_tree(graph: RelationGraph, world: World, plan: Plan) -> bool:
    """Return whether a world's plan is that of all worlds, but for what is said of each pair and what is elsewhere."""
    is_simple = not (world.telling or world.aliases or world.absent or plan.fused)
    single = all(len(graph.instances_of(name)) == 1 for name, _ in world.bindings)
    return is_simple and single and all(_is_own(graph, step) for step in plan.steps)


def _is_own(graph: RelationGraph, step: Step) -> bool:
    """Return whether all that is said of a thing is one choice between single constraints on its pair."""
    said = step.constraint
    choices = graph.choices_for(graph.node_of(said.referent))
    if len(choices) != 1 or choices[0].governs != {graph.pair_of(said)}:
        return False
    constraints = [one.constraints for one in choices[0].alternatives]
    return all(
        len(each) == 1
        and (each[0].referent, each[0].relata) == (said.referent, (said.relatum,))
        and not in_region(each[0])
        for each in constraints
    )


def _is_of(asked: Asked, placing: Step | None) -> bool:
    """Return whether atoms are about the pair that a step places."""
    return placing is not None and all(
        step.relatum == placing.relatum and step.second is None for step in asked.steps
    )


def _alternatives(graph: RelationGraph, step: Step) -> tuple[Alternative, ...]:
    return graph.choices_for(graph.node_of(step.constraint.referent))[0].alternatives
