"""From a plan to the place of a target, engine by engine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.draws import draw, width_of
from qsrlang.mixtures.plans import Plan
from qsrlang.mixtures.posterior import posterior_of
from qsrlang.mixtures.uniforms import independent
from qsrlang.relations.graph import Constraint, RelationGraph

MIN_DEVIATION = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where a world puts the target: mean (2,), covariance (2, 2), and the log evidence of what was fused."""

    mean: FloatArray
    covariance: FloatArray
    log_evidence: float
    constraints: tuple[Constraint, ...]


def place_exactly(graph: RelationGraph, plan: Plan, target: str, viewer: Pose2 | None) -> Placement:
    """Place by moments: exact in every atom, linear between them."""
    posterior = posterior_of(graph, plan, viewer)
    mean, covariance = posterior.marginal(plan.seats[target])
    return Placement(mean, definite(covariance), posterior.log_evidence, plan.constraints)


def place_by_sampling(
    graph: RelationGraph,
    plan: Plan,
    target: str,
    viewer: Pose2 | None,
    samples: int,
    rng: np.random.Generator,
) -> Placement:
    """Place as the paper does: draw every object of the chain in turn, then fit one Gaussian to the target's draws."""
    drawn = draw(graph, plan, viewer, independent(samples, width_of(plan), rng))
    if not np.isfinite(drawn.logs).any():
        raise UnreachedTargetError(target, ["its statements contradict each other in every sample"])
    weights = np.exp(drawn.logs - drawn.logs.max())
    mean, covariance = fitted(drawn.points(plan.seats[target]), weights)
    evidence = float(drawn.logs.max() + math.log(weights.mean()))
    return Placement(mean, covariance, evidence, plan.constraints)


def fitted(points: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean (2,) and covariance (2, 2) of weighted draws (P, 2)."""
    mean = np.asarray(weights @ points / weights.sum())
    off = points - mean
    return mean, definite(off.T @ (weights[:, None] * off) / weights.sum())


def definite(covariance: FloatArray) -> FloatArray:
    """Return a covariance (2, 2) that is: a landmark known to the millimetre has no spread, a Gaussian needs some."""
    (a, b), (_, c) = covariance = 0.5 * (covariance + covariance.T)
    is_definite = a + c > 0.0 and a * c - b * b > 0.0
    return np.asarray(covariance if is_definite else covariance + MIN_DEVIATION**2 * np.eye(2))
