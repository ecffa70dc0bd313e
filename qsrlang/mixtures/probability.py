"""How probable a formula is, and where a target is under assumptions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.syntax import Atom, Formula, Not
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.atoms import DRAWS, EXACT, GAUSSIAN, atom_probability
from qsrlang.mixtures.chains import broken_chains
from qsrlang.mixtures.conditioning import Drawing, WorldDraws, draw_scenes, effective_draws, ratio_error
from qsrlang.mixtures.conditions import Condition, conditions_on, objects_of
from qsrlang.mixtures.inference import mixture_of, statements_of
from qsrlang.mixtures.resolve import fitted
from qsrlang.mixtures.solving import solve_worlds
from qsrlang.mixtures.worlds import MAX_WORLDS
from qsrlang.relations.graph import RelationGraph

MIN_SHARE = 1e-9


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


def probability(
    graph: RelationGraph, formula: Formula, given: Formula | None, drawing: Drawing, limit: int = MAX_WORLDS
) -> Probability:
    """Return P(formula | given, requirements) over worlds and places.

    Of one atom, negated or not, with nothing assumed, analytically where that can be; else by weighted draws of the
    true densities. What no world places holds in no relation. Raises ImpossibleConditionError, NoRoomError,
    MissingFacingError.
    """
    conditions = conditions_on(graph, objects_of(formula), given)
    found = None if conditions else _without_draws(graph, formula, drawing.viewer, limit)
    return found or _by_draws(graph, formula, conditions, drawing)


def _without_draws(
    graph: RelationGraph, formula: Formula, viewer: Pose2 | None, limit: int
) -> Probability | None:
    atom = formula.part if isinstance(formula, Not) else formula
    if not isinstance(atom, Atom):
        return None
    solution = solve_worlds(graph, objects_of(atom), viewer, limit)
    shares = []
    for one in solution.worlds:
        share = atom_probability(graph, one, atom, viewer)
        if share is None:
            return None
        shares.append(share)
    value = sum(one.weight * share for one, (share, _) in zip(solution.worlds, shares, strict=True))
    method = GAUSSIAN if any(how == GAUSSIAN for _, how in shares) else EXACT
    value = min(1.0 - value if isinstance(formula, Not) else value, 1.0)
    return Probability(text_of(formula), value, method, dropped=solution.dropped)


def _by_draws(
    graph: RelationGraph, formula: Formula, conditions: tuple[Condition, ...], drawing: Drawing
) -> Probability:
    scenes = draw_scenes(graph, objects_of(formula), conditions, drawing)
    held = [one.outlook.holds(formula) for one in scenes]
    value = sum(float(one.weights @ is_held) for one, is_held in zip(scenes, held, strict=True))
    assumed = tuple(one.text for one in conditions)
    error = ratio_error(scenes, held, value)
    return Probability(text_of(formula), min(value, 1.0), DRAWS, error, effective_draws(scenes), assumed)


def text_of(formula: Formula) -> str:
    """Return a formula as it was written, on one line."""
    return " ".join(formula.span.text.split())


def where_assuming(
    graph: RelationGraph, target: str, conditions: tuple[Condition, ...], drawing: Drawing
) -> Where:
    """Return where a target is under conditions: each world's draws by their moments; raises UnreachedTargetError."""
    scenes = draw_scenes(graph, (target,), conditions, drawing)
    components = [
        _component(one, target) for one in scenes if one.outlook.world.named(target) in one.outlook.plan.seats
    ]
    components = [one for one in components if one.weight > MIN_SHARE]
    if not components:
        raise UnreachedTargetError(target, broken_chains(graph, target))
    components.sort(key=lambda one: (-one.weight, *one.mean))
    claimed = sum(one.weight for one in components)
    assumed = tuple(one.text for one in conditions)
    rest = 1.0 - claimed if claimed < 1.0 - MIN_SHARE else 0.0
    return Where(
        target, "map", mixture_of(components), rest, tuple(components), assumed, effective_draws(scenes)
    )


def _component(scenes: WorldDraws, target: str) -> Component:
    plan = scenes.outlook.plan
    points = scenes.outlook.drawn.points(plan.seats[scenes.outlook.world.named(target)])
    weight = float(scenes.weights.sum())
    if weight <= MIN_SHARE:
        return Component(0.0, np.zeros(2), np.eye(2), ())
    return Component(weight, *fitted(points, scenes.weights), statements_of(plan))
