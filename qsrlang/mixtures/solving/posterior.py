"""Where the objects of a world are together: its steps linearised, forward along the plan, then about the solution."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.solving.factors import Factors
from qsrlang.mixtures.solving.linear import Factor, Linear
from qsrlang.mixtures.solving.paths import Paths
from qsrlang.mixtures.solving.system import DENSE, Solution, solve
from qsrlang.mixtures.worlds.layout import Layout
from qsrlang.mixtures.worlds.plans import Plan, Step
from qsrlang.mixtures.worlds.supports import Seat
from qsrlang.relations.graph import RelationGraph

TOGETHER = 512
MAX_PASSES = 12
SETTLED = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class Posterior:
    """N(mean, covariance) over everything placed in a world, in the columns of its layout, and its log evidence.

    The evidence is that of the steps that add to what is placed, each relative to a uniform density over a disc of the
    graph's reach; 0 where there are none.
    """

    layout: Layout
    mean: FloatArray
    joint: FloatArray | Solution | Paths
    log_evidence: float = 0.0

    def covariance(self, columns: IntArray) -> FloatArray:
        """Return the joint covariance (K, K) of some columns."""
        if isinstance(self.joint, np.ndarray):
            return self.joint[np.ix_(columns, columns)]
        return self.joint.covariance(columns)

    def marginal(self, *seats: Seat) -> tuple[FloatArray, FloatArray]:
        """Return mean (2 K,) and covariance (2 K, 2 K) of K places together."""
        columns = np.array([column for seat in seats for column in self.layout.place(seat)])
        return self.mean[columns], self.covariance(columns)


def posterior_of(graph: RelationGraph, plan: Plan, viewer: Pose2 | None) -> Posterior:
    """Return the joint Gaussian of a plan: exact moments in every step, linear between them."""
    (posterior,) = posteriors_of(graph, (plan,), viewer)
    return posterior


def posteriors_of(graph: RelationGraph, plans: Sequence[Plan], viewer: Pose2 | None) -> tuple[Posterior, ...]:
    """Return the joint Gaussian of each plan; plans of one layout go forward together."""
    alike: dict[int, list[int]] = defaultdict(list)
    for at, plan in enumerate(plans):
        alike[id(plan.layout)].append(at)
    found: dict[int, Posterior] = {}
    for group in alike.values():
        for start in range(0, len(group), TOGETHER):
            chosen = group[start : start + TOGETHER]
            found |= zip(chosen, _together(graph, [plans[at] for at in chosen], viewer), strict=True)
    return tuple(found[at] for at in range(len(plans)))


def _together(graph: RelationGraph, plans: Sequence[Plan], viewer: Pose2 | None) -> list[Posterior]:
    steps, layout, fused = plans[0].steps, plans[0].layout, plans[0].fused
    making = Factors(graph, viewer, _orientation(plans[0], viewer), layout)
    said = [making.of([plan.steps[at] for plan in plans]) for at in range(len(steps))]
    told = [[each[row] for each in said] for row in range(len(plans))]
    if (fused or layout.size > DENSE) and not any(_needs_joint(one) for each in said for one in each):
        return [_on_paths(graph, steps, layout, fused, one) for one in told]
    forward = _forward(steps, said, layout, len(plans))
    if not fused:
        return [Posterior(layout, *one) for one in zip(forward.means, forward.joints, strict=True)]
    return [_solved(graph, layout, fused, one, *forward.of(row)) for row, one in enumerate(told)]


def _needs_joint(factor: Factor) -> bool:
    """Return whether a factor's equation depends on how places, not a heading alone, are distributed together."""
    return factor.bends and factor.turning is None


def _on_paths(
    graph: RelationGraph, steps: Sequence[Step], layout: Layout, fused: int, factors: Sequence[Factor]
) -> Posterior:
    """Return the posterior of a plan none of whose equations needs to know a joint covariance."""
    equations = equations_ahead(factors, layout)
    placing = [at for at, step in enumerate(steps) if step.places]
    paths = Paths.of([factors[at] for at in placing], [equations[at] for at in placing], layout)
    if fused:
        return _solved(graph, layout, fused, factors, paths.mean(), equations)
    return Posterior(layout, paths.mean(), paths)


def equations_ahead(factors: Sequence[Factor], layout: Layout) -> list[Linear]:
    """Return the equations of factors by what is known before any step; those that say the same are one."""
    found: dict[tuple[int, int], Linear] = {}
    equations = []
    for factor in factors:
        read = factor.columns
        key = (id(factor.turning or factor), read.item(2))
        if key not in found:
            found[key] = factor.linearised(layout.mean[read], np.diag(layout.variance[read]))
        equations.append(found[key])
    return equations


@dataclass(frozen=True, slots=True, eq=False)
class _Forward:
    """Means (W, n) and covariances (W, n, n) of what W plans place, and each step's equations (W, …)."""

    means: FloatArray
    joints: FloatArray
    equations: tuple[Linear, ...]

    def of(self, row: int) -> tuple[FloatArray, list[Linear]]:
        """Return the mean (n,) and the equations of one plan."""
        return self.means[row], [Linear(*(part[row] for part in one)) for one in self.equations]


def _forward(
    steps: Sequence[Step], factors: Sequence[Sequence[Factor]], layout: Layout, count: int
) -> _Forward:
    """Place what the steps place, one after the other; what only adds to that is passed over."""
    means = np.tile(layout.mean, (count, 1))
    joints = np.tile(np.diag(layout.variance), (count, 1, 1))
    equations = []
    for step, said in zip(steps, factors, strict=True):
        read, placed = said[0].columns, said[0].referent
        equation = _equations(said, means[:, read], joints[:, read[:, None], read])
        equations.append(equation)
        if not step.places:
            continue
        means[:, placed] = (equation.slope @ means[:, read, None])[..., 0] + equation.offset
        cross = equation.slope @ joints[:, read]
        joints[:, placed], joints[:, :, placed] = cross, cross.transpose(0, 2, 1)
        own = cross[:, :, read] @ equation.slope.transpose(0, 2, 1) + equation.covariance
        joints[:, placed[:, None], placed] = own
    return _Forward(means, joints, tuple(equations))


def _equations(said: Sequence[Factor], means: FloatArray, covariances: FloatArray) -> Linear:
    """Return the equations of a step in W plans, linearised about their columns: (W, 2, K), (W, 2), (W, 2, 2)."""
    if len(said) == 1:
        return said[0].linearised_each(means, covariances)
    rows: dict[int, list[int]] = defaultdict(list)
    for row, factor in enumerate(said):
        rows[id(factor)].append(row)
    count, width = means.shape
    slopes, offsets, noises = np.empty((count, 2, width)), np.empty((count, 2)), np.empty((count, 2, 2))
    for chosen in rows.values():
        one = said[chosen[0]].linearised_each(means[chosen], covariances[chosen])
        slopes[chosen], offsets[chosen], noises[chosen] = one
    return Linear(slopes, offsets, noises)


def _solved(
    graph: RelationGraph,
    layout: Layout,
    fused: int,
    factors: Sequence[Factor],
    start: FloatArray,
    equations: list[Linear],
) -> Posterior:
    solution = solve(layout, factors, equations, start)
    if not fused:
        return Posterior(layout, solution.mean, solution)
    solution = _settled(solution, layout, factors, equations)
    evidence = solution.log_evidence + fused * math.log(math.pi * graph.reach**2)
    return Posterior(layout, solution.mean, solution, evidence)


def _settled(
    solution: Solution, layout: Layout, factors: Sequence[Factor], equations: list[Linear]
) -> Solution:
    """Return the solution about which its own equations are linearised, MAX_PASSES passes away at most.

    Iterated posterior linearisation (García-Fernández, Svensson, Morelande and Särkkä 2015).
    """
    bending = [at for at, one in enumerate(factors) if one.bends]
    for _ in range(MAX_PASSES if bending else 0):
        moved = 0.0
        for at in bending:
            read = factors[at].columns
            about = solution.mean[read], solution.covariance(read)
            fresh = factors[at].linearised(*about)
            moved = max(moved, fresh.difference(equations[at], about[0]))
            equations[at] = fresh
        solution = solve(layout, factors, equations, solution.mean)
        if moved < SETTLED:
            break
    return solution


def _orientation(plan: Plan, viewer: Pose2 | None) -> float:
    """Return a direction that turns with the scene: a landmark's heading, else a line of sight between two places."""
    landmarks = sorted(plan.landmarks, key=lambda landmark: landmark.name)
    headings = [landmark.heading for landmark in landmarks if landmark.heading is not None]
    if headings:
        return headings[0]
    places = [(one.x, one.y) for one in landmarks]
    x, y = next(iter(places), (0.0, 0.0)) if viewer is None else (viewer.x, viewer.y)
    sights = [math.atan2(there[1] - y, there[0] - x) for there in places if there != (x, y)]
    return sights[0] if sights else 0.0
