"""From a world to the pose of a target: placing objects along chains of landmarks, engine by engine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.conditional import (
    Conditional,
    FitConditional,
    PolarConditional,
    Standpoint,
    polar_density,
    support_of,
)
from qsrlang.mixtures.joint import JointGaussian
from qsrlang.mixtures.worlds import World
from qsrlang.relations.graph import Constraint, Landmark, RelationGraph

MIN_DEVIATION = 1e-3


@dataclass(frozen=True, slots=True)
class Step:
    """One constraint in the order of placing; `places` is False where it only adds to what is placed already.

    `relatum` names the relatum's block of the state: a landmark's own name, or a class that was placed before.
    """

    constraint: Constraint
    relatum: str
    root: Landmark
    support: Landmark | None
    places: bool


@dataclass(frozen=True, slots=True)
class Plan:
    """The landmarks of a world, the steps that place its objects, and the block of the state that is the target."""

    landmarks: tuple[Landmark, ...]
    steps: tuple[Step, ...]
    target: str


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where a world puts the target: mean (2,), covariance (2, 2), and the log evidence of what was fused."""

    mean: FloatArray
    covariance: FloatArray
    log_evidence: float
    constraints: tuple[Constraint, ...]


def plan_world(graph: RelationGraph, world: World, target: str) -> Plan | None:
    """Return how a world places the target, or None where no chain of it reaches a landmark."""
    roots = world.landmarks
    waiting = _towards(target, sorted(world.constraints, key=lambda c: (c.referent, c.relatum)))
    steps: list[Step] = []
    while True:
        ready = [c for c in waiting if c.relatum in roots and c.referent not in world.landmarks]
        if not ready:
            break
        constraint = next((c for c in ready if c.referent in roots), ready[0])
        waiting.remove(constraint)
        root = roots[constraint.relatum]
        support = support_of(graph, constraint, root)
        relatum = root.name if constraint.relatum in world.landmarks else constraint.relatum
        steps.append(Step(constraint, relatum, root, support, constraint.referent not in roots))
        roots.setdefault(constraint.referent, root)
    if target not in roots:
        return None
    known = [*world.landmarks.values(), *(step.support for step in steps if step.support)]
    block = world.landmarks[target].name if target in world.landmarks else target
    return Plan(tuple({landmark.name: landmark for landmark in known}.values()), tuple(steps), block)


def _towards(target: str, constraints: list[Constraint]) -> list[Constraint]:
    """Return the constraints that help to place the target: its own, its relata's, and so on."""
    needed, waiting = {target}, [target]
    while waiting:
        name = waiting.pop()
        relata = {c.relatum for c in constraints if c.referent == name} - needed
        needed |= relata
        waiting += relata
    return [c for c in constraints if c.referent in needed]


def place_exactly(graph: RelationGraph, plan: Plan, viewer: Pose2 | None) -> Placement:
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
    mean, covariance = joint.marginal(plan.target)
    return Placement(mean[:2], _definite(covariance[:2, :2]), evidence, _used(plan))


def place_by_sampling(
    graph: RelationGraph, plan: Plan, viewer: Pose2 | None, samples: int, rng: np.random.Generator
) -> Placement:
    """Place as the paper does: draw every object of the chain in turn, then fit one Gaussian to the target's draws."""
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
            with np.errstate(divide="ignore"):
                logs += np.log(
                    conditional.pdf(states[:, blocks[referent]], states) * math.pi * graph.reach**2
                )
    if not np.isfinite(logs).any():
        raise UnreachedTargetError(plan.target, ["its statements contradict each other in every sample"])
    weights = np.exp(logs - logs.max())
    points = states[:, blocks[plan.target]][:, :2]
    mean = weights @ points / weights.sum()
    covariance = np.cov(points.T, aweights=weights, ddof=0)
    evidence = float(logs.max() + math.log(weights.mean()))
    return Placement(mean, _definite(covariance), evidence, _used(plan))


def make_conditional(
    graph: RelationGraph, step: Step, blocks: dict[str, slice], viewer: Pose2 | None
) -> Conditional:
    """Return what a step's constraint says of its referent, given states stacked as `blocks` tell."""
    constraint, root, relatum = step.constraint, step.root, blocks[step.relatum]
    own_heading = step.relatum == root.name and root.heading is not None
    support = None if step.support is None else blocks[step.support.name]
    standpoint = Standpoint(
        relatum, blocks[root.name], support, own_heading, root.heading is not None, root.name, viewer
    )
    if constraint.fit is not None:
        return FitConditional(constraint.fit, constraint.atoms[0].frame, standpoint)
    density, frames = polar_density(graph, constraint, step.support)
    return PolarConditional(density, frames, standpoint)


def _orientation(plan: Plan, viewer: Pose2 | None) -> float:
    """Return a direction that turns with the scene: a landmark's heading, else the viewer's line of sight."""
    for landmark in sorted(plan.landmarks, key=lambda landmark: landmark.name):
        if landmark.heading is not None:
            return landmark.heading
        if viewer is not None:
            return math.atan2(landmark.y - viewer.y, landmark.x - viewer.x)
    return 0.0


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


def _used(plan: Plan) -> tuple[Constraint, ...]:
    return tuple(step.constraint for step in plan.steps)
