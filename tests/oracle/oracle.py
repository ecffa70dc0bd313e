"""The oracle: where a target is and how probable formulas are, from draws of the true densities, with standard errors.

Every world is drawn as often, in BATCHES batches; each answer is a function of sums over the draws, so that leaving out
one batch at a time (the jackknife) gives its standard error.
"""

from dataclasses import dataclass

import numpy as np
from drawn_worlds import draw_world
from naive_worlds import naive_worlds
from sharp_events import holds

from qsrlang.language.syntax import atoms_of

BATCHES = 100


@dataclass
class Measured:
    """A value with its standard error, of the same shape."""

    value: np.ndarray
    error: np.ndarray


@dataclass
class Verdict:
    """What the oracle found: for each set of statements weight, mean and covariance (xx, xy, yy) of the target, and of
    each event its probability; `draws` is the effective sample size, `points` (N, 2) are draws of the target.
    """

    keys: list
    weights: Measured
    means: Measured
    covariances: Measured
    elsewhere: Measured
    events: Measured
    draws: float
    points: np.ndarray


@dataclass
class _World:
    share: float
    key: frozenset
    placed: frozenset
    has_target: bool
    columns: np.ndarray
    points: np.ndarray
    weights: np.ndarray


def consult(graph, target, events=(), given=None, viewer=None, count=4000, rng=None, points=1000):
    """Ask the oracle for a target, for events, or both; all that the graph requires is required.

    Draws are of all that is known; worlds that place the same of what is asked about are weighed against each other.
    """
    conditions = [(given, 1.0)] if given is not None else []
    conditions += [(one.formula, 1.0 if one.share is None else one.share) for one in graph.requirements]
    spoken = [*events, *(formula for formula, _ in conditions)]
    named = [argument.text for one in spoken for atom in atoms_of(one) for argument in atom.arguments]
    names = tuple(dict.fromkeys([*filter(None, [target]), *named]))
    worlds = [
        _drawn(graph, world, target, names, events, conditions, viewer, count, rng)
        for world in naive_worlds(graph, names)
    ]
    return _verdict(worlds, rng, points)


def _drawn(graph, world, target, names, events, conditions, viewer, count, rng):
    scenes, evidence = draw_world(graph, world, viewer, count, rng)
    weights = evidence.copy()
    for formula, share in conditions:
        weights = weights * np.where(holds(formula, scenes), share, 1.0 - share)
    has_target = target in scenes.points
    x, y = scenes.points[target].T if has_target else np.zeros((2, count))
    moments = [weights, weights * x, weights * y, weights * x * x, weights * x * y, weights * y * y]
    held = [weights * holds(event, scenes) for event in events]
    columns = np.array([np.ones(count), evidence, *moments, *held])
    placed = frozenset(name for name in names if name in scenes.points)
    batches = columns.reshape(len(columns), BATCHES, -1).sum(axis=2)
    key = _cited(world, target) if has_target else frozenset()
    return _World(world.share, key, placed, has_target, batches, np.stack([x, y], axis=1), weights)


def _cited(world, target):
    """The statements that place the target: those of its constraints, of what these place it by, and so on."""
    landmarks, names, cited = dict(world.landmarks), [target], []
    for name in names:
        mine = [one for one in world.constraints if one.referent == name and name not in landmarks]
        names += [relatum for one in mine for relatum in one.relata if relatum not in names]
        cited += [str(one.statement) for one in mine]
    return frozenset(cited)


def _verdict(worlds, rng, count):
    sums = np.array([world.columns for world in worlds]).transpose(2, 0, 1)
    total = sums.sum(axis=0)
    keys = sorted({world.key for world in worlds if world.has_target}, key=sorted)
    found = _answers(total, worlds, keys)
    left_out = [_answers(total - one, worlds, keys) for one in sums]
    measured = [
        Measured(value, _jackknife(np.array([one[part] for one in left_out])))
        for part, value in enumerate(found)
    ]
    weights = np.concatenate(
        [_draw_weights(one, mass) for one, mass in zip(worlds, _masses(total, worlds), strict=True)]
    )
    points = np.concatenate([world.points for world in worlds])
    here = np.concatenate([np.full(len(world.points), world.has_target) for world in worlds]) * weights
    draws = float(weights.sum() ** 2 / np.square(weights).sum())
    chosen = rng.choice(len(points), count, p=here / here.sum()) if here.any() else []
    return Verdict(keys, *measured, draws, points[chosen])


def _draw_weights(world, mass):
    total = world.weights.sum()
    return world.weights * (mass / total if total > 0.0 else 0.0)


def _masses(total, worlds):
    """The mass of each world: share x evidence, evidence weighing only worlds that place the same objects."""
    masses = np.zeros(len(worlds))
    for placed in {world.placed for world in worlds}:
        group = [i for i, world in enumerate(worlds) if world.placed == placed]
        shares = np.array([worlds[i].share for i in group])
        evidence = np.array([total[i, 1] / total[i, 0] for i in group])
        met = np.array([total[i, 2] / total[i, 0] for i in group])
        scale = (shares @ evidence) / shares.sum()
        masses[group] = shares * met / (scale if scale > 0.0 else 1.0)
    return masses / masses.sum()


def _answers(total, worlds, keys):
    """From sums over draws: weights (K,), means (K, 2), covariances (K, 3), elsewhere, probabilities of the events."""
    masses = _masses(total, worlds)
    per_draw = total[:, 3:] / np.where(total[:, 2:3] > 0.0, total[:, 2:3], 1.0)
    weights, means, covariances = [], [], []
    for key in keys:
        group = [i for i, world in enumerate(worlds) if world.key == key and world.has_target]
        weight = masses[group].sum()
        x, y, xx, xy, yy = masses[group] @ per_draw[group][:, :5] / max(weight, 1e-300)
        weights.append(weight)
        means.append([x, y])
        covariances.append([xx - x * x, xy - x * y, yy - y * y])
    gone = sum(mass for mass, world in zip(masses, worlds, strict=True) if not world.has_target)
    return np.array(weights), np.array(means), np.array(covariances), np.array(gone), masses @ per_draw[:, 5:]


def _jackknife(replicates):
    count = len(replicates)
    return np.sqrt((count - 1) / count * np.square(replicates - replicates.mean(axis=0)).sum(axis=0))
