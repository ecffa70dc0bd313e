"""How probable a formula is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import ImpossibleConditionError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom, Formula, atoms_of
from qsrlang.mixtures.draws.conditioning import Drawing, draw_scenes, effective_draws, ratio_error
from qsrlang.mixtures.draws.conditions import Condition, assumed_atoms, conditions_on, objects_of
from qsrlang.mixtures.solving.pairs import direction_probability
from qsrlang.mixtures.solving.tables import MAX_ATOMS, TruthTables, truth_of
from qsrlang.mixtures.solving.trees import tree_table
from qsrlang.mixtures.solving.weighing import Assumed, Solved, solve_worlds
from qsrlang.mixtures.weighed import Weighed
from qsrlang.mixtures.worlds.enumeration import MAX_WORLDS
from qsrlang.relations.graph import RelationGraph

EXACT, GAUSSIAN, DRAWS = "exact", "Gaussian", "draws"


@dataclass(frozen=True, slots=True)
class Probability:
    """How probable a formula is, and how that was found.

    `method` is "exact" (the share of the stated densities), "Gaussian" (that of the worlds' Gaussians) or "draws": then
    there is a standard error, and `draws` is how many independent draws would be as good. `assumed` are the texts of
    what was given or required, `dropped` the prior mass of the combinations of alternatives that were left out.
    """

    formula: str
    value: float
    method: str
    standard_error: float = 0.0
    draws: float | None = None
    assumed: tuple[str, ...] = ()
    dropped: float = 0.0

    def to_json(self) -> dict[str, object]:
        """Return the answer as plain data."""
        return {
            "formula": self.formula,
            "probability": self.value,
            "method": self.method,
            "standard_error": self.standard_error,
            "effective_draws": self.draws,
            "assumed": list(self.assumed),
            "dropped": self.dropped,
        }

    def __str__(self) -> str:
        given = f" given {', '.join(self.assumed)}" if self.assumed else ""
        error = f" ± {self.standard_error:.1g}" if self.method == DRAWS else f" ({self.method})"
        return f"prob {self.formula}{given}: {self.value:.4f}{error}"


@dataclass(frozen=True, slots=True, eq=False)
class Proved:
    """How probable a formula is, and the worlds behind that, with the share of each in which it holds."""

    answer: Probability
    worlds: Sequence[Weighed]
    shares: Sequence[float]


def probability(
    graph: RelationGraph,
    formula: Formula,
    given: Formula | None,
    viewer: Pose2 | None,
    drawing: Callable[[], Drawing],
    limit: int = MAX_WORLDS,
) -> Probability:
    """Return P(formula | given, requirements), as `prove` does; of trees without telling worlds apart."""
    found = _of_tree(graph, formula, conditions_on(graph, objects_of(formula), given), viewer)
    return found or prove(graph, formula, given, viewer, drawing, limit).answer


def _of_tree(
    graph: RelationGraph, formula: Formula, conditions: tuple[Condition, ...], viewer: Pose2 | None
) -> Probability | None:
    atoms = (*atoms_of(formula), *assumed_atoms(conditions))
    if len(atoms) > MAX_ATOMS:
        return None
    telling = _Telling.of(graph, formula, conditions, atoms, viewer)
    names = objects_of(formula, *(one.formula for one in conditions))
    table = tree_table(graph, names, atoms, telling.tables)
    if table is None:
        return None
    true, whole = telling.weighed(table)
    texts = tuple(one.text for one in conditions)
    if not whole > 0.0:
        raise ImpossibleConditionError(texts, 0)
    return Probability(text_of(formula), min(true / whole, 1.0), EXACT, assumed=texts)


def prove(
    graph: RelationGraph,
    formula: Formula,
    given: Formula | None,
    viewer: Pose2 | None,
    drawing: Callable[[], Drawing],
    limit: int = MAX_WORLDS,
) -> Proved:
    """Return P(formula | given, requirements) over worlds and places, with its proof.

    By truth tables of the stated densities where those tell; of one direction, with nothing assumed, by the Gaussian
    of each world; else by weighted draws of the true densities. What no world places holds in no relation. Raises
    ImpossibleConditionError, NoRoomError, MissingFacingError.
    """
    conditions = conditions_on(graph, objects_of(formula), given)
    found = _without_draws(graph, formula, conditions, viewer, limit)
    return found or _by_draws(graph, formula, conditions, drawing())


def _without_draws(
    graph: RelationGraph,
    formula: Formula,
    conditions: tuple[Condition, ...],
    viewer: Pose2 | None,
    limit: int,
) -> Proved | None:
    atoms = (*atoms_of(formula), *assumed_atoms(conditions))
    names = objects_of(formula, *(one.formula for one in conditions))
    solution = solve_worlds(graph, names, viewer, limit, atoms, is_needed=False)
    telling = _Telling.of(graph, formula, conditions, atoms, viewer)
    told = []
    for one in solution.worlds:
        found = telling.masses(one)
        if found is None:
            return None
        told.append(found)
    masses = [one.weight * whole for one, (_, whole, _) in zip(solution.worlds, told, strict=True)]
    total = sum(masses)
    if not total > 0.0:
        raise ImpossibleConditionError([one.text for one in conditions], 0)
    worlds = [Assumed(one, mass / total) for one, mass in zip(solution.worlds, masses, strict=True)]
    shares = [true / whole if whole > 0.0 else 0.0 for true, whole, _ in told]
    value = sum(one.weight * share for one, share in zip(worlds, shares, strict=True))
    method = EXACT if all(exact for *_, exact in told) else GAUSSIAN
    texts = tuple(one.text for one in conditions)
    answer = Probability(text_of(formula), min(value, 1.0), method, assumed=texts, dropped=solution.dropped)
    return Proved(answer, worlds, shares)


@dataclass(frozen=True, slots=True, eq=False)
class _Telling:
    """Where, among the combinations of atoms, a formula holds, and how conditions weigh them."""

    graph: RelationGraph
    tables: TruthTables
    atoms: Sequence[Atom]
    held: FloatArray
    assumed: FloatArray | None
    viewer: Pose2 | None

    @classmethod
    def of(
        cls,
        graph: RelationGraph,
        formula: Formula,
        conditions: tuple[Condition, ...],
        atoms: Sequence[Atom],
        viewer: Pose2 | None,
    ) -> _Telling:
        """Return what is to be told of a formula under conditions, all of whose `atoms` are given."""
        if len(atoms) > MAX_ATOMS:
            return cls(graph, TruthTables(graph, atoms, viewer), atoms, np.zeros(0), None, viewer)
        held, assumed = truth_of(formula, atoms).astype(float), None
        for one in conditions:
            factor = one.factor(truth_of(one.formula, atoms))
            held, assumed = held * factor, factor if assumed is None else assumed * factor
        return cls(graph, TruthTables(graph, atoms, viewer), atoms, held, assumed, viewer)

    def weighed(self, table: FloatArray) -> tuple[float, float]:
        """Return the mass of a table in which formula and conditions hold, and that of the conditions."""
        whole = 1.0 if self.assumed is None else float((table * self.assumed).sum())
        return float((table * self.held).sum()), whole

    def masses(self, solved: Solved) -> tuple[float, float, bool] | None:
        """Return the mass of a world in which formula and conditions hold, that of the latter, and if exact."""
        found = self.tables.of(solved)
        if found is not None:
            return (*self.weighed(found[0]), found[1])
        if self.assumed is not None or len(self.atoms) != 1:
            return None
        share = direction_probability(self.graph, solved, self.atoms[0], self.viewer)
        return None if share is None else (float(self.held @ [1.0 - share, share]), 1.0, False)


def _by_draws(
    graph: RelationGraph, formula: Formula, conditions: tuple[Condition, ...], drawing: Drawing
) -> Proved:
    drawn, dropped = draw_scenes(graph, objects_of(formula), conditions, drawing, tuple(atoms_of(formula)))
    held = [one.outlook.holds(formula) for one in drawn]
    masses = [float(one.weights @ is_held) for one, is_held in zip(drawn, held, strict=True)]
    value, assumed = sum(masses), tuple(one.text for one in conditions)
    answer = Probability(
        text_of(formula),
        min(value, 1.0),
        DRAWS,
        ratio_error(drawn, held, value),
        effective_draws(drawn),
        assumed,
        dropped,
    )
    weights = [one.weight for one in drawn]
    shares = [mass / weight if weight > 0.0 else 0.0 for mass, weight in zip(masses, weights, strict=True)]
    return Proved(answer, drawn, shares)


def text_of(formula: Formula) -> str:
    """Return a formula as it was written, on one line."""
    return " ".join(formula.span.text.split())
