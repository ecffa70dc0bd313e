"""What is assumed: what a question gives, and what the knowledge requires of what the question depends on."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.language.syntax import Atom, Formula, atoms_of
from qsrlang.mixtures.worlds.chains import depends_on, is_tied
from qsrlang.relations.graph import RelationGraph


@dataclass(frozen=True, slots=True)
class Condition:
    """A formula that is assumed: it holds where share is None, else it holds with this probability."""

    formula: Formula
    share: float | None
    text: str

    @property
    def factors(self) -> tuple[float, float]:
        """The weights of what it holds in, and of what it does not hold in."""
        share = 1.0 if self.share is None else self.share
        return share, 1.0 - share

    def factor(self, held: BoolArray) -> FloatArray:
        """Return the weight (P,) that draws get by whether the formula holds in them."""
        return np.where(held, *self.factors)


def objects_of(*formulas: Formula) -> tuple[str, ...]:
    """Return the names of the objects that formulas speak of."""
    names = (argument.text for one in formulas for atom in atoms_of(one) for argument in atom.arguments)
    return tuple(dict.fromkeys(names))


def assumed_atoms(conditions: Iterable[Condition]) -> tuple[Atom, ...]:
    """Return the atoms that conditions speak of."""
    return tuple(atom for one in conditions for atom in atoms_of(one.formula))


def conditions_on(graph: RelationGraph, names: Sequence[str], given: Formula | None) -> tuple[Condition, ...]:
    """Return what is given, and the requirements that speak of what the names depend on, or of what those do.

    A requirement on what no landmark places cannot be judged, and is passed over.
    """
    found = [] if given is None else [Condition(given, None, " ".join(given.span.text.split()))]
    open_ones = [
        Condition(one.formula, one.share, one.statement.text)
        for one in graph.requirements
        if all(is_tied(graph, name) for name in objects_of(one.formula))
    ]
    while open_ones:
        named = [*names, *(name for one in found for name in objects_of(one.formula))]
        reached = depends_on(graph, named)
        linked = [one for one in open_ones if reached & set(objects_of(one.formula))]
        if not linked:
            break
        found += linked
        open_ones = [one for one in open_ones if one not in linked]
    return tuple(found)
