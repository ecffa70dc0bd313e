"""How probable a formula is, and where a target is under assumptions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.errors import UnreachedTargetError
from qsrlang.language.syntax import Formula
from qsrlang.mixtures.answers import Component, Where
from qsrlang.mixtures.chains import broken_chains
from qsrlang.mixtures.conditioning import (
    Condition,
    Drawing,
    Scenes,
    conditions_on,
    draw_scenes,
    effective_draws,
    objects_of,
    ratio_error,
)
from qsrlang.mixtures.inference import mixture_of
from qsrlang.mixtures.resolve import fitted
from qsrlang.relations.graph import RelationGraph

MIN_SHARE = 1e-9


@dataclass(frozen=True, slots=True)
class Probability:
    """How probable a formula is, with the standard error of the draws it was found by, and how good those were.

    `draws` is how many independent draws would be as good; `assumed` are the texts of what was given or required.
    """

    formula: str
    value: float
    standard_error: float
    draws: float
    assumed: tuple[str, ...] = ()

    def to_json(self) -> dict[str, object]:
        """Return the answer as plain data."""
        return {
            "formula": self.formula,
            "probability": self.value,
            "standard_error": self.standard_error,
            "effective_draws": self.draws,
            "assumed": list(self.assumed),
        }

    def __str__(self) -> str:
        given = f" given {', '.join(self.assumed)}" if self.assumed else ""
        return f"prob {self.formula}{given}: {self.value:.4f} ± {self.standard_error:.4f}"


def probability(
    graph: RelationGraph, formula: Formula, given: Formula | None, drawing: Drawing
) -> Probability:
    """Return P(formula | given, requirements) over worlds and places, by weighted draws of the true densities.

    What no world places holds in no relation. Raises ImpossibleConditionError, NoRoomError, MissingFacingError.
    """
    conditions = conditions_on(graph, objects_of(formula), given)
    scenes = draw_scenes(graph, objects_of(formula), conditions, drawing)
    held = [one.outlook.holds(formula) for one in scenes]
    value = sum(float(one.weights @ is_held) for one, is_held in zip(scenes, held, strict=True))
    return Probability(
        " ".join(formula.span.text.split()),
        min(value, 1.0),
        ratio_error(scenes, held, value),
        effective_draws(scenes),
        tuple(one.text for one in conditions),
    )


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


def _component(scenes: Scenes, target: str) -> Component:
    plan = scenes.outlook.plan
    points = scenes.outlook.drawn.points(plan.seats[scenes.outlook.world.named(target)].block)
    weight = float(scenes.weights.sum())
    if weight <= MIN_SHARE:
        return Component(0.0, np.zeros(2), np.eye(2), ())
    cited = tuple(dict.fromkeys(str(one.statement) for one in plan.constraints))
    return Component(weight, *fitted(points, scenes.weights), cited)
