"""How far the answers of the engine are from those of the oracle, on one generated knowledge base."""

from dataclasses import dataclass

import numpy as np
from oracle import consult
from scipy.spatial.distance import cdist

import qsrlang as qsr

LEAST_WEIGHT = 0.01


@dataclass
class Gap:
    """One comparison. `z` are weights, means and covariances off the oracle's, in its standard errors, and `events` so
    are probabilities; the errors as such are those of means in deviations, of deviations as a ratio, of weights and of
    probabilities; `energy` is the energy distance of the mixture from the oracle's draws, from 0 (equal) to 1.
    """

    z: np.ndarray
    mean: float
    ratio: float
    weight: float
    prob: np.ndarray
    events: np.ndarray
    energy: float
    draws: float


def compare(base, count=4000, draws=1000, prepare=lambda known: known):
    """Ask both engines; `prepare` may change what the engine under test knows."""
    known = qsr.parse_knowledge(base.text)
    viewer = None if base.viewer is None else qsr.Pose2(*base.viewer)
    given = None if base.given is None else qsr.parse_formula(base.given)
    rng = np.random.default_rng([base.seed, 1])
    verdict = consult(known.graph, base.target, (), given, viewer, count, rng, draws)
    answer = prepare(known).where(base.target, viewer=viewer, given=base.given)
    groups = _grouped(answer, verdict)
    z, mean, ratio, weight = _moments(groups, verdict)
    prob, events = _events(base, known, prepare(known), given, viewer, count, rng)
    energy = energy_distance(answer.mixture.sample(draws, rng), verdict.points)
    return Gap(z, mean, ratio, weight, prob, events, energy, verdict.draws)


def _grouped(answer, verdict):
    """Weight, mean and covariance of the engine's components, for each set of statements the oracle tells apart."""
    found = []
    by_key = [_key(one, verdict.keys) for one in answer.components]
    for key in verdict.keys:
        mine = [one for one, its in zip(answer.components, by_key, strict=True) if its == key]
        weight = sum(one.weight for one in mine)
        if weight == 0.0:
            found.append((0.0, np.zeros(2), np.zeros((2, 2))))
            continue
        shares = np.array([one.weight for one in mine]) / weight
        means = np.array([one.mean for one in mine])
        mean = shares @ means
        inside = sum(share * one.covariance for share, one in zip(shares, mine, strict=True))
        found.append((weight, mean, inside + (shares[:, None] * (means - mean)).T @ (means - mean)))
    return found


def _key(component, keys):
    """The largest set of statements that a component cites; under conditions it cites more than places the target."""
    cited = frozenset(component.statements)
    return max((key for key in keys if key <= cited), key=len)


def _moments(groups, verdict):
    scores, means, ratios, weights = [], [0.0], [1.0], [0.0]
    for i, (weight, mean, covariance) in enumerate(groups):
        true_weight = float(verdict.weights.value[i])
        weights.append(abs(weight - true_weight))
        scores.append(_score(weight, verdict.weights, i, 1e-6))
        if max(weight, true_weight) < LEAST_WEIGHT:
            continue
        flat = covariance[[0, 0, 1], [0, 1, 1]]
        xx, xy, yy = verdict.covariances.value[i]
        scores += [*_score(mean, verdict.means, i, 1e-6), *_score(flat, verdict.covariances, i, 1e-6)]
        true = np.array([[xx, xy], [xy, yy]]) + 1e-9 * np.eye(2)
        off = mean - verdict.means.value[i]
        means.append(float(np.sqrt(off @ np.linalg.solve(true, off))))
        spreads = np.sqrt(np.abs(np.linalg.eigvals(np.linalg.solve(true, covariance)).real))
        ratios.append(float(spreads[np.abs(np.log(spreads + 1e-9)).argmax()]))
    return np.hstack(scores), max(means), max(ratios, key=lambda one: abs(np.log(one + 1e-9))), max(weights)


def _score(value, measured, i, floor):
    return (value - measured.value[i]) / (measured.error[i] + floor)


def _events(base, plain, known, given, viewer, count, rng):
    errors, scores = [], []
    for text in base.events:
        event = qsr.parse_formula(text)
        verdict = consult(plain.graph, None, (event,), given, viewer, count, rng)
        answer = known.prob(text, base.given, viewer=viewer)
        error = answer.value - float(verdict.events.value[0])
        errors.append(abs(error))
        scores.append(error / np.hypot(float(verdict.events.error[0]), answer.standard_error + 1e-4))
    return np.array(errors), np.array(scores)


def energy_distance(points, others):
    """(2 E|X - Y| - E|X - X'| - E|Y - Y'|) / (2 E|X - Y|), of draws (N, 2) and (M, 2), unbiased (Szekely and Rizzo)."""
    across = 2.0 * cdist(points, others).mean()
    n, m = len(points), len(others)
    within = cdist(points, points).sum() / (n * (n - 1)) + cdist(others, others).sum() / (m * (m - 1))
    return float((across - within) / across)
