"""Random rooms with a few overlapping views, and what planners cost there above the best order of all views."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.strategies.exact import least_costs
from qsrlang.planning.strategies.gain import Gain
from qsrlang.planning.strategies.index import Index
from qsrlang.planning.strategies.nearest import Nearest
from qsrlang.planning.strategies.rollout import Rollout
from qsrlang.planning.strategies.strategy import Strategy
from qsrlang.planning.strategies.tour import Tour
from qsrlang.planning.views import Views

SIDE, SPEED, LOOK, RATE, REACH, HALF_VIEW = 6.0, 0.5, 2.0, 0.8, 2.5, np.pi / 6.0
Rule = Callable[[ViewProblem, ViewProblem, np.random.Generator], np.ndarray]


def random_room(rng: np.random.Generator, count: int) -> ViewProblem:
    """Return a room of 6 x 6 m: a prior of three Gaussians on 300 voxels of tables, and views, half of them aimed."""
    means, weights = rng.uniform(0.5, SIDE - 0.5, (3, 2)), rng.dirichlet([1.0, 1.0, 1.0])
    tables = [mean + rng.normal(0.0, 0.45, (60, 2)) for mean in means]
    voxels = np.vstack([*tables, rng.uniform(0.0, SIDE, (120, 2))])
    squares = ((voxels[:, None] - means) ** 2).sum(axis=2)
    mass = np.exp(-0.5 * squares / 0.45**2) @ weights + 0.01
    mass /= mass.sum()
    poses = np.column_stack([rng.uniform(0.3, SIDE - 0.3, (count, 2)), rng.uniform(-np.pi, np.pi, count)])
    for view in range(count // 2):
        aim, angle = voxels[rng.choice(len(voxels), p=mass)], rng.uniform(-np.pi, np.pi)
        poses[view, :2] = np.clip(aim + 1.5 * np.array([np.cos(angle), np.sin(angle)]), 0.1, SIDE - 0.1)
        poses[view, 2] = np.arctan2(*(aim - poses[view, :2])[::-1])
    start = rng.uniform(0.5, SIDE - 0.5, 2)
    offsets = voxels[None] - poses[:, None, :2]
    ranges = np.hypot(offsets[..., 0], offsets[..., 1])
    bearings = np.arctan2(offsets[..., 1], offsets[..., 0]) - poses[:, 2:]
    inside = (ranges < REACH) & (np.abs((bearings + np.pi) % (2 * np.pi) - np.pi) < HALF_VIEW)
    places = np.vstack([start, poses[:, :2]])
    costs = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) / SPEED + LOOK
    return ViewProblem.of_one(Views.of_rates(poses, RATE * inside), mass, costs[0, 1:], costs[1:, 1:])


def cost_of_playing(room: ViewProblem, rule: Rule, rng: np.random.Generator) -> float:
    """Return the cost [s] of the order that a rule makes, choosing anew after every empty look."""
    order, left, mass = list[int](), list(range(len(room))), room.mass
    while left:
        first = room.first[left] if not order else room.between[order[-1]][left]
        views, between = room.views.take(left), room.between[np.ix_(left, left)]
        now = ViewProblem.of_one(views, mass, first, between)
        prior = ViewProblem.of_one(views, room.mass, first, between)
        order.append(left.pop(int(np.argmax(rule(now, prior, rng)))))
        mass = mass * (1.0 - room.views.row(order[-1]))
    return room.cost_of(order)


def ranking_by(strategy: Strategy) -> Rule:
    """Return the rule that takes the view a strategy ranks first."""
    return lambda now, prior, rng: strategy.rank(now, rng).values


RULES: Mapping[str, Rule] = {
    "random": lambda now, prior, rng: rng.random(len(now)),
    "nearest": ranking_by(Nearest()),
    "eq. 3, no memory": lambda now, prior, rng: prior.gains(),
    "belief (eq. 3, with memory)": ranking_by(Gain()),
    "index": ranking_by(Index()),
    "tour (viper, 1000 sampled)": ranking_by(Tour()),
    "rollout": ranking_by(Rollout()),
}


def excesses(rooms: int, views: int, seed: int) -> dict[str, np.ndarray]:
    """Return for each rule the excess (rooms,) over the least cost of any order, as a share."""
    rng = np.random.default_rng(seed)
    problems = [random_room(rng, views) for _ in range(rooms)]
    best = np.array([least_costs(room).min() for room in problems])
    played = {
        name: np.array([cost_of_playing(room, rule, rng) for room in problems])
        for name, rule in RULES.items()
    }
    return {name: costs / best - 1.0 for name, costs in played.items()}
