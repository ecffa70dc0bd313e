"""Truth tables of trees: the work grows with the sum of the alternatives, not with their product."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.mixtures.solving.tables import Asked, TruthTables, along, nothing_holds
from qsrlang.mixtures.worlds.enumeration import MIN_REST, World
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.mixtures.worlds.trees import Tree, Twig, tree_of
from qsrlang.relations.graph import RelationGraph


def tree_table(graph: RelationGraph, names: tuple[str, ...], tables: TruthTables) -> FloatArray | None:
    """Return P(atoms true or false) (2, …, 2) over all worlds; None where what is known of the names is no tree.

    T(X) = elsewhere x F(X) + sum_a share_a T_a(X) prod_Y T(Y) over the alternatives a of X and the things Y placed by
    it, T_a its table by one stated density and F(X) the table in which nothing holds of X and of what hangs on it.
    None too where an atom is about a pair that no step places.
    """
    tree = tree_of(graph, names)
    if tree is None:
        return None
    asked = {one.steps[0].referent: one for one in tables.asked_of(World(1.0), tree.seats)}
    if sum([len(one.numbers) for one in asked.values()]) < len(tables.atoms):
        return None
    relata = {twig.step.referent: twig.step.relatum for twig in tree.twigs}
    if not all(_is_of(one, relata.get(referent)) for referent, one in asked.items()):
        return None
    return _summed(tree, asked, tables, len(tables.atoms))


def _summed(tree: Tree, asked: dict[Seat, Asked], tables: TruthTables, count: int) -> FloatArray | None:
    """Return the product of T(X) over what landmarks place, made from the last thing placed to the first."""
    whole = nothing_asked = np.ones((1,) * count)
    inside: dict[Seat, FloatArray] = defaultdict(lambda: nothing_asked)
    hanging: dict[Seat, tuple[int, ...]] = defaultdict(tuple)
    for twig in reversed(tree.twigs):
        own, step = asked.get(twig.step.referent), twig.step
        table = _mixed(twig, own, tables, count)
        if table is None:
            return None
        numbers = (*(own.numbers if own else ()), *hanging[step.referent])
        table = table * inside[step.referent]
        rest = 1.0 - sum([one.share for one in twig.alternatives])
        if rest > MIN_REST:
            table = table + rest * nothing_holds(numbers, count)
        if step.relatum.is_landmark:
            whole = whole * table
        else:
            inside[step.relatum] = inside[step.relatum] * table
            hanging[step.relatum] += numbers
    return whole


def _mixed(twig: Twig, asked: Asked | None, tables: TruthTables, count: int) -> FloatArray | None:
    """Return sum_a share_a T_a of the alternatives of a pair."""
    if asked is None:
        return np.full((1,) * count, sum([one.share for one in twig.alternatives]))
    mixed: float | FloatArray = 0.0
    for one in twig.alternatives:
        table = tables.of_pair(twig.step.saying(one.constraints[0]), asked).table
        if table is None:
            return None
        mixed = mixed + one.share * table
    return along(np.asarray(mixed), asked.numbers, count)


def _is_of(asked: Asked, relatum: Seat | None) -> bool:
    """Return whether atoms are about the pair that a step places."""
    return relatum is not None and all(one.relatum == relatum and one.second is None for one in asked.steps)
