"""How far the answers of the engine are from those of the oracle, on one generated knowledge base."""

from dataclasses import dataclass

import numpy as np
from generated_knowledge import Generated
from oracle import Verdict, consult
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist
from scipy.special import digamma

import qsrlang as qsr

LEAST_WEIGHT = 0.01
NEIGHBOURS = 3
LEAST_ERROR = 5e-4
MOST_COMPONENTS = 10_000


@dataclass
class Gap:
    """One comparison: how far the engine is from the oracle.

    `z` are weights, means and covariances in standard errors of the oracle, and so are `events`, probabilities by the
    method that found them. The errors as such: of means in deviations, of deviations as a ratio, of weights, of
    probabilities. `energy` is the energy distance of the mixture from the oracle's draws, from 0 (equal) to 1; `kl`
    the Kullback-Leibler divergence of the mixture from the truth [nat].
    """

    z: np.ndarray
    mean: float
    ratio: float
    weight: float
    prob: np.ndarray
    events: dict
    energy: float
    kl: float
    draws: float


@dataclass
class Judged:
    """A base, what it knows, what the oracle found of its target, and of each of its events (value, error)."""

    base: Generated
    known: qsr.KnowledgeBase
    verdict: Verdict
    events: list

    @property
    def viewer(self):
        return None if self.base.viewer is None else qsr.Pose2(*self.base.viewer)


def compare(base, count=4000, draws=1000, prepare=lambda known: known):
    """Ask both engines; `prepare` may change what the engine under test knows."""
    return gap(judge(base, count, draws), prepare)


def judge(base, count, draws):
    """Ask the oracle: of the target, and of each event by itself, since an event may tell of the target."""
    judged = Judged(base, qsr.parse_knowledge(base.text), None, [])
    given = None if base.given is None else qsr.parse_formula(base.given)
    rng = np.random.default_rng([base.seed, 1])
    graph, how = judged.known.graph, (given, judged.viewer, count, rng)
    judged.verdict = consult(graph, base.target, (), *how, draws)
    for event in base.events:
        found = consult(graph, None, (qsr.parse_formula(event),), *how).events
        judged.events.append((float(found.value[0]), float(found.error[0])))
    return judged


def gap(judged, prepare=lambda known: known):
    """Return how far the engine is from the oracle."""
    base, verdict, known = judged.base, judged.verdict, prepare(judged.known)
    answer = known.where(base.target, viewer=judged.viewer, given=base.given, max_components=MOST_COMPONENTS)
    z, mean, ratio, weight = _moments(_grouped(answer, verdict), verdict)
    prob, events = _events(judged, known)
    drawn = answer.mixture.sample(len(verdict.points), np.random.default_rng(base.seed))
    energy = energy_distance(drawn, verdict.points)
    kl = divergence(verdict.points, answer.mixture)
    return Gap(z, mean, ratio, weight, prob, events, energy, kl, verdict.draws)


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


def _events(judged, known):
    """How far probabilities are off, and in standard errors of both engines, by the engine's method."""
    errors, scores = [], {"exact": [], "draws": [], "Gaussian": []}
    for event, (value, error) in zip(judged.base.events, judged.events, strict=True):
        answer = known.prob(event, judged.base.given, viewer=judged.viewer)
        errors.append(abs(answer.value - value))
        doubt = np.hypot(error, answer.standard_error) + LEAST_ERROR
        scores[answer.method].append((answer.value - value) / doubt)
    return np.array(errors), scores


def energy_distance(points, others):
    """(2 E|X - Y| - E|X - X'| - E|Y - Y'|) / (2 E|X - Y|), of draws (N, 2) and (M, 2), unbiased (Szekely and Rizzo)."""
    across = 2.0 * cdist(points, others).mean()
    n, m = len(points), len(others)
    within = cdist(points, points).sum() / (n * (n - 1)) + cdist(others, others).sum() / (m * (m - 1))
    return float((across - within) / across)


def divergence(points, mixture):
    """KL(truth || mixture) [nat] from draws of the truth: -h - E log q, h by nearest neighbours.

    h = psi(n) - psi(k) + log pi + 2 E log r_k (Kozachenko and Leonenko 1987), r_k the distance to the k-th neighbour.
    """
    points = np.unique(points, axis=0)
    reach = cKDTree(points).query(points, k=NEIGHBOURS + 1)[0][:, -1]
    entropy = digamma(len(points)) - digamma(NEIGHBOURS) + np.log(np.pi) + 2.0 * np.log(reach).mean()
    return float(-entropy - mixture.logpdf(points).mean())
