"""How probable a formula is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.errors import ImpossibleConditionError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom, Formula, atoms_of
from qsrlang.mixtures.draws.conditioning import Drawing, draw_scenes, effective_draws, ratio_error
from qsrlang.mixtures.draws.conditions import Condition, assumed_atoms, conditions_on, objects_of
from qsrlang.mixtures.solving.pairs import direction_probability
from qsrlang.mixtures.solving.tables import expectation, truth_table
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
        error = f" ± {self.standard_error:.4f}" if self.method == DRAWS else f" ({self.method})"
        return f"prob {self.formula}{given}: {self.value:.4f}{error}"


@dataclass(frozen=True, slots=True, eq=False)
class Proved:
    """How probable a formula is, and the worlds behind that, with the share of each in which it holds."""

    answer: Probability
    worlds: Sequence[Weighed]
    shares: Sequence[float]


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
    found = [_masses(graph, one, formula, conditions, atoms, viewer) for one in solution.worlds]
    told = [one for one in found if one is not None]
    if len(told) < len(found):
        return None
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


def _masses(
    graph: RelationGraph,
    solved: Solved,
    formula: Formula,
    conditions: tuple[Condition, ...],
    atoms: Sequence[Atom],
    viewer: Pose2 | None,
) -> tuple[float, float, bool] | None:
    """Return the mass of a world in which the formula and what is assumed hold, that of the latter, and if exact."""
    found = truth_table(graph, solved, atoms, viewer)
    if found is not None:
        table, exact = found
        assumed = [(one.formula, *one.factors) for one in conditions]
        true = expectation(table, atoms, [(formula, 1.0, 0.0), *assumed])
        return true, expectation(table, atoms, assumed), exact
    if conditions or len(atoms) != 1:
        return None
    share = direction_probability(graph, solved, atoms[0], viewer)
    if share is None:
        return None
    return expectation(np.array([1.0 - share, share]), atoms, [(formula, 1.0, 0.0)]), 1.0, False


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
