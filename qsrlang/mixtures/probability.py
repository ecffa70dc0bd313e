"""How probable a formula is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom, Formula, Not, atoms_of
from qsrlang.mixtures.atoms import DRAWS, EXACT, GAUSSIAN, atom_probability
from qsrlang.mixtures.conditioning import Drawing, draw_scenes, effective_draws, ratio_error
from qsrlang.mixtures.conditions import Condition, conditions_on, objects_of
from qsrlang.mixtures.solving import solve_worlds
from qsrlang.mixtures.weighed import Weighed
from qsrlang.mixtures.worlds import MAX_WORLDS
from qsrlang.relations.graph import RelationGraph


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
    graph: RelationGraph, formula: Formula, given: Formula | None, drawing: Drawing, limit: int = MAX_WORLDS
) -> Proved:
    """Return P(formula | given, requirements) over worlds and places, with its proof.

    Of one atom, negated or not, with nothing assumed, analytically where that can be; else by weighted draws of the
    true densities. What no world places holds in no relation. Raises ImpossibleConditionError, NoRoomError,
    MissingFacingError.
    """
    conditions = conditions_on(graph, objects_of(formula), given)
    found = None if conditions else _without_draws(graph, formula, drawing.viewer, limit)
    return found or _by_draws(graph, formula, conditions, drawing)


def _without_draws(graph: RelationGraph, formula: Formula, viewer: Pose2 | None, limit: int) -> Proved | None:
    atom = formula.part if isinstance(formula, Not) else formula
    if not isinstance(atom, Atom):
        return None
    solution = solve_worlds(graph, objects_of(atom), viewer, limit, (atom,))
    found = []
    for one in solution.worlds:
        share = atom_probability(graph, one, atom, viewer)
        if share is None:
            return None
        found.append(share)
    method = GAUSSIAN if any(how == GAUSSIAN for _, how in found) else EXACT
    shares = [1.0 - share if isinstance(formula, Not) else share for share, _ in found]
    value = sum(one.weight * share for one, share in zip(solution.worlds, shares, strict=True))
    answer = Probability(text_of(formula), min(value, 1.0), method, dropped=solution.dropped)
    return Proved(answer, solution.worlds, shares)


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
