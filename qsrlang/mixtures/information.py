"""Landmarks by how much knowing the place of each narrows the search for a target."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.errors import UnreachedTargetError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.gaussian import MIN_DEVIATION
from qsrlang.mixtures.inference import Bounds, alone_with, place_exactly
from qsrlang.mixtures.solving.weighing import Solved, solve_worlds
from qsrlang.mixtures.worlds.chains import broken_chains, needed_for, sources_of
from qsrlang.relations.graph import RelationGraph

DRAWS = 8192
MAX_RANKED_WORLDS = 128
CELL = 0.05
AREA = 25.0


@dataclass(frozen=True, slots=True)
class LandmarkValue:
    """What knowing the place of one landmark tells of a target.

    `information` is I(L; O) [bit], with its standard error; `through` is P(L | O), the share of what is known of the
    target in whose chain the landmark is; `entropy` is H(O | L) [bit] over cells of CELL, and `ratio` = P(L | O) / H.
    """

    name: str
    information: float
    standard_error: float
    through: float
    entropy: float

    @property
    def ratio(self) -> float:
        """P(L | O) / H, by which the authors of Kunze et al. 2014 rank landmarks in their later code."""
        return self.through / self.entropy if self.entropy > 0.0 else math.inf


@dataclass(frozen=True, slots=True)
class LandmarkRanking:
    """The landmarks of a target, the most telling first; `basis` says what is known of their places without looking."""

    target: str
    basis: str
    landmarks: tuple[LandmarkValue, ...]
    assumed: tuple[str, ...] = ()
    draws: None = None

    def to_json(self) -> dict[str, object]:
        """Return the ranking as plain data, information and entropy in bits."""
        return {
            "target": self.target,
            "basis": self.basis,
            "landmarks": [
                {
                    "name": one.name,
                    "information": one.information,
                    "standard_error": one.standard_error,
                    "through": one.through,
                    "entropy": one.entropy,
                    "ratio": one.ratio if math.isfinite(one.ratio) else None,
                }
                for one in self.landmarks
            ],
        }

    def __str__(self) -> str:
        rows = [f"landmarks {self.target}, {self.basis}"]
        rows.append(f"{'landmark':>16} {'I [bit]':>8} {'P(L|O)':>7} {'H [bit]':>8} {'P/H':>6}")
        for one in self.landmarks:
            numbers = f"{one.information:8.3f} {one.through:7.3f} {one.entropy:8.2f} {one.ratio:6.3f}"
            rows.append(f"{one.name:>16} {numbers}")
        return "\n".join(rows)


def rank_landmarks(
    graph: RelationGraph, target: str, viewer: Pose2 | None, rng: np.random.Generator
) -> LandmarkRanking:
    """Return what a target is placed by, ranked by I(L; O) = E log p(l, o) / (p(l) p(o)) over the worlds' Gaussians.

    A thing that is in no place of a world counts as one more value. Where no landmark is known at all, each thing may
    be anywhere on an area of AREA [m^2] beforehand, and I = log AREA - H(O | L). Raises UnreachedTargetError where
    nothing places the target.
    """
    names = sorted(sources_of(graph, target))
    if not names:
        raise UnreachedTargetError(target, broken_chains(graph, target))
    if graph.landmarks:
        found = [_known(graph, target, name, viewer, rng) for name in names]
        basis = "given the landmarks that are known"
    else:
        found = [_unknown(graph, target, name) for name in names]
        basis = f"no landmark known: each thing anywhere on {AREA:g} m² beforehand"
    ranked = sorted(found, key=lambda one: (-round(one.information, 6), -one.through, one.name))
    return LandmarkRanking(target, basis, tuple(ranked))


def _known(
    graph: RelationGraph, target: str, name: str, viewer: Pose2 | None, rng: np.random.Generator
) -> LandmarkValue:
    solution = solve_worlds(graph, (target, name), viewer, MAX_RANKED_WORLDS)
    worlds = [one for one in solution.worlds if one.weight > 0.0]
    logs = _log_ratios(worlds, (name, target), rng)
    through = _through(worlds, name, target)
    entropy = _entropy_given(_relative(graph, target, name))
    error = float(logs.std(ddof=1) / math.sqrt(len(logs)))
    information = max(float(logs.mean()), 0.0) / math.log(2.0)
    return LandmarkValue(name, information, error / math.log(2.0), through, entropy)


def _unknown(graph: RelationGraph, target: str, name: str) -> LandmarkValue:
    relative = _relative(graph, target, name)
    entropy = _entropy_given(relative)
    through = 0.0 if relative is None else 1.0 - relative.elsewhere
    return LandmarkValue(name, max(_most() - entropy, 0.0), 0.0, through, entropy)


def _log_ratios(worlds: Sequence[Solved], names: tuple[str, str], rng: np.random.Generator) -> FloatArray:
    """Return log p(l, o) / (p(l) p(o)) [nat] of draws (DRAWS,) from the worlds' Gaussians over both places."""
    weights = np.array([one.weight for one in worlds])
    has, means, covariances = _joint(worlds, names)
    chosen = rng.choice(len(worlds), size=DRAWS, p=weights / weights.sum())
    roots = np.linalg.cholesky(covariances)
    normals = rng.standard_normal((DRAWS, 4)) * has[chosen].repeat(2, axis=1)
    points = means[chosen] + np.einsum("dij,dj->di", roots[chosen], normals)
    both = _log_density(points, has[chosen], weights, has, means, covariances, slice(0, 4))
    first = _log_density(points, has[chosen], weights, has, means, covariances, slice(0, 2))
    second = _log_density(points, has[chosen], weights, has, means, covariances, slice(2, 4))
    return both - first - second


def _joint(worlds: Sequence[Solved], names: tuple[str, str]) -> tuple[BoolArray, FloatArray, FloatArray]:
    """Return which of two things each world places (M, 2), and mean (M, 4) and covariance (M, 4, 4) of both places.

    What a world does not place is at 0 in it, with a covariance by which its density there is 1.
    """
    seats = [[one.plan.seats.get(one.world.named(name)) for name in names] for one in worlds]
    has = np.array([[seat is not None for seat in pair] for pair in seats], dtype=bool)
    means, covariances = np.zeros((len(worlds), 4)), np.tile(np.eye(4) / (2.0 * math.pi), (len(worlds), 1, 1))
    for row, (one, pair) in enumerate(zip(worlds, seats, strict=True)):
        at = np.flatnonzero(has[row].repeat(2))
        if len(at):
            mean, covariance = one.posterior.marginal(*(seat for seat in pair if seat is not None))
            means[row, at] = mean
            covariances[row][np.ix_(at, at)] = covariance + MIN_DEVIATION**2 * np.eye(len(at))
    return has, means, covariances


def _log_density(
    points: FloatArray,
    present: BoolArray,
    weights: FloatArray,
    has: BoolArray,
    means: FloatArray,
    covariances: FloatArray,
    columns: slice,
) -> FloatArray:
    """Return the log density (D,) of draws in some columns, among worlds (M,) that place the same of those things."""
    things = slice(columns.start // 2, columns.stop // 2)
    same: BoolArray = np.all(present[:, None, things] == has[None, :, things], axis=2)
    off = points[:, None, columns] - means[None, :, columns]
    block = covariances[:, columns, columns]
    solved = np.einsum("mij,dmj->dmi", np.linalg.inv(block), off)
    logs = -0.5 * np.einsum("dmi,dmi->dm", off, solved) - 0.5 * np.linalg.slogdet(2.0 * math.pi * block)[1]
    return np.asarray(logsumexp(np.where(same, logs, -np.inf), b=weights, axis=1))


def _through(worlds: Sequence[Solved], name: str, target: str) -> float:
    """Return the share of the worlds that place a target in which a thing is in its chain."""
    placing = [one for one in worlds if one.world.named(target) in one.plan.seats]
    total = sum(one.weight for one in placing)
    chained = sum(
        one.weight
        for one in placing
        if one.world.named(name) in needed_for((one.world.named(target),), one.plan.constraints)
    )
    return chained / total if total > 0.0 else 0.0


def _entropy_given(relative: Where | None) -> float:
    """Return H(O | L) [bit] over cells of CELL: of the mixture relative to L, and of AREA where that does not tell."""
    if relative is None:
        return _most()
    told = 1.0 - relative.elsewhere
    inside = relative.mixture.entropy() / math.log(2.0) - 2.0 * math.log2(CELL)
    mixing = -sum(p * math.log2(p) for p in (told, relative.elsewhere) if p > 0.0)
    return max(told * inside + relative.elsewhere * _most() + mixing, 0.0)


def _relative(graph: RelationGraph, target: str, name: str) -> Where | None:
    """Return where a target is relative to one thing; None where that alone does not tell."""
    try:
        return place_exactly(alone_with(graph, name), target, None, Bounds(MAX_RANKED_WORLDS)).answer
    except UnreachedTargetError:
        return None


def _most() -> float:
    """Return the entropy [bit] of what may be anywhere on AREA, over cells of CELL."""
    return math.log2(AREA / CELL**2)
