"""From a plan to the pose of a target: placing objects along chains of landmarks, engine by engine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.conditional import Conditional, FitConditional, frame_of, polar_conditional
from qsrlang.mixtures.joint import JointGaussian
from qsrlang.mixtures.plans import Plan, Step
from qsrlang.mixtures.regions import region_conditional
from qsrlang.mixtures.standpoint import Anchor, Standpoint
from qsrlang.mixtures.supports import Seat, in_region
from qsrlang.relations.graph import Constraint, Landmark, RelationGraph

MIN_DEVIATION = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where a world puts the target: mean (2,), covariance (2, 2), and the log evidence of what was fused."""

    mean: FloatArray
    covariance: FloatArray
    log_evidence: float
    constraints: tuple[Constraint, ...]


def place_exactly(graph: RelationGraph, plan: Plan, target: str, viewer: Pose2 | None) -> Placement:
    """Place by moments: exact in every atom, cubature over what is uncertain before it."""
    joint = JointGaussian.empty(_orientation(plan, viewer))
    for landmark in plan.landmarks:
        joint = joint.with_block(landmark.name, *_landmark_block(landmark))
    evidence = 0.0
    for step in plan.steps:
        conditional = make_conditional(graph, step, joint.blocks, viewer)
        if step.places:
            joint = joint.with_conditional(step.constraint.referent, conditional.moments)
        else:
            joint, more = joint.observed(step.constraint.referent, conditional.moments)
            evidence += more + math.log(math.pi * graph.reach**2)
    mean, covariance = joint.marginal(plan.seats[target].block)
    return Placement(mean[:2], _definite(covariance[:2, :2]), evidence, plan.constraints)


def place_by_sampling(
    graph: RelationGraph,
    plan: Plan,
    target: str,
    viewer: Pose2 | None,
    samples: int,
    rng: np.random.Generator,
) -> Placement:
    """Place as the paper does: draw every object of the chain in turn, then fit one Gaussian to the target's draws."""
    drawn = draw(graph, plan, viewer, samples, rng)
    if not np.isfinite(drawn.logs).any():
        raise UnreachedTargetError(target, ["its statements contradict each other in every sample"])
    weights = np.exp(drawn.logs - drawn.logs.max())
    mean, covariance = fitted(drawn.points(plan.seats[target].block), weights)
    evidence = float(drawn.logs.max() + math.log(weights.mean()))
    return Placement(mean, covariance, evidence, plan.constraints)


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """Draws of all objects of a plan together: states (P, n), their blocks, and log weights (P,) of what is fused."""

    states: FloatArray
    blocks: dict[str, slice]
    logs: FloatArray

    def points(self, block: str) -> FloatArray:
        """Return where an object is in each draw: (P, 2) [m]."""
        return self.states[:, self.blocks[block]][:, :2]


def draw(
    graph: RelationGraph, plan: Plan, viewer: Pose2 | None, samples: int, rng: np.random.Generator
) -> Drawn:
    """Draw landmarks and objects in the order of the plan, from the true densities, no Gaussian between."""
    blocks: dict[str, slice] = {}
    states = np.zeros((samples, 0))
    for landmark in plan.landmarks:
        mean, covariance = _landmark_block(landmark)
        draws = mean + rng.standard_normal((samples, 3)) * np.sqrt(np.diag(covariance))
        states = _append(states, blocks, landmark.name, draws)
    logs = np.zeros(samples)
    for step in plan.steps:
        conditional = make_conditional(graph, step, blocks, viewer)
        referent = step.constraint.referent
        if step.places:
            states = _append(states, blocks, referent, conditional.sample(states, rng))
        else:
            densities = conditional.pdf(states[:, blocks[referent]], states)
            with np.errstate(divide="ignore"):
                logs += np.log(densities * math.pi * graph.reach**2)
    return Drawn(states, blocks, logs)


def fitted(points: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean (2,) and covariance (2, 2) of weighted draws (P, 2)."""
    mean = np.asarray(weights @ points / weights.sum())
    off = points - mean
    return mean, _definite(off.T @ (weights[:, None] * off) / weights.sum())


def make_conditional(
    graph: RelationGraph, step: Step, blocks: dict[str, slice], viewer: Pose2 | None
) -> Conditional:
    """Return what a step's constraint says of its referent, given states stacked as `blocks` tell."""
    constraint = step.constraint
    support = None if step.support is None else _anchor(step.support.seat, blocks)
    second = None if step.second is None else _anchor(step.second, blocks)
    standpoint = Standpoint(_anchor(step.relatum, blocks), second, viewer, support)
    if constraint.fit is not None:
        return FitConditional(constraint.fit, frame_of(constraint, constraint.atoms[0]), standpoint)
    if in_region(constraint):
        return region_conditional(graph, constraint, standpoint)
    return polar_conditional(graph, constraint, standpoint, step.support)


def _anchor(seat: Seat, blocks: dict[str, slice]) -> Anchor:
    heading = None if seat.root.heading is None else blocks[seat.root.name].start + 2
    return Anchor(blocks[seat.block], heading, seat.root.name)


def _orientation(plan: Plan, viewer: Pose2 | None) -> float:
    """Return a direction that turns with the scene: a landmark's heading, else a line of sight between two places."""
    landmarks = sorted(plan.landmarks, key=lambda landmark: landmark.name)
    headings = [landmark.heading for landmark in landmarks if landmark.heading is not None]
    if headings:
        return headings[0]
    x, y = (landmarks[0].x, landmarks[0].y) if viewer is None else (viewer.x, viewer.y)
    sights = [math.atan2(one.y - y, one.x - x) for one in landmarks if (one.x, one.y) != (x, y)]
    return sights[0] if sights else 0.0


def _landmark_block(landmark: Landmark) -> tuple[FloatArray, FloatArray]:
    mean = np.array([landmark.x, landmark.y, landmark.heading or 0.0])
    return mean, np.diag(np.square(landmark.deviation))


def _append(states: FloatArray, blocks: dict[str, slice], name: str, draws: FloatArray) -> FloatArray:
    blocks[name] = slice(states.shape[1], states.shape[1] + draws.shape[1])
    return np.concatenate([states, draws], axis=1)


def _definite(covariance: FloatArray) -> FloatArray:
    """A landmark known to the millimetre has no spread to speak of; a Gaussian needs some."""
    symmetric = 0.5 * (covariance + covariance.T)
    return (
        symmetric if np.linalg.eigvalsh(symmetric).min() > 0.0 else symmetric + MIN_DEVIATION**2 * np.eye(2)
    )
