"""Options: the views among which a planner with a belief chooses, and what they cost."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.maps.ways import Ways
from qsrlang.planning.goals import Goal
from qsrlang.planning.motion import costs_between, first_costs
from qsrlang.planning.planners.planner import Situation
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.sensing import Robot
from qsrlang.planning.views import Views, beside

COVERING = 0.375
"""The share of the views thought through that is picked because together they show most."""
_APART = 1.0
"""The second heading that a place offers is at least this far from its best [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class Options:
    """N views, what it costs to get to each, and the ways (P, P) among their places, None where not asked for."""

    views: Views
    place_of: IntArray
    travel: FloatArray
    turn: FloatArray
    seconds: FloatArray
    ways: Ways | None

    def between(self, robot: Robot) -> FloatArray:
        """Return the seconds (N, N) from view to view; without ways, those of the first drive stand in for all."""
        if self.ways is None:
            return np.broadcast_to(self.seconds, (len(self.views), len(self.views)))
        return costs_between(robot, self.ways, self.place_of, self.views.poses[:, 2])

    def take(self, views: IntArray) -> Options:
        """Return some of the options."""
        return Options(
            self.views.take(views),
            self.place_of[views],
            self.travel[views],
            self.turn[views],
            self.seconds[views],
            self.ways,
        )


def drawn_options(
    goals: Sequence[Goal], robot: Robot, situation: Situation, is_farsighted: bool, most: int
) -> Options:
    """Return the candidates that were drawn at random, without those to which there is no way."""
    poses = situation.drawn
    views = beside([goal.views_from(poses) for goal in goals])
    here = Ways.from_field(situation.field, poses[:, :2])
    every = np.arange(len(poses))
    costs = first_costs(robot, situation.pose, here, every, poses[:, 2])
    ways = Ways.among(situation.field.navigation, poses[:, :2]) if is_farsighted else None
    options = _reached(Options(views, every, *costs, ways))
    if len(options.views) <= most:
        return options
    return options.take(np.sort(shortlist(options, scaled_mass(goals), most)))


def atlas_options(
    goals: Sequence[Goal],
    robot: Robot,
    situation: Situation,
    rng: np.random.Generator,
    most: int,
) -> Options:
    """Return the most promising views of the goals' atlas: by chance over cost, and by what they show together.

    Each place that is drawn offers its best heading and the best that is far from that one.
    """
    atlas = goals[0].atlas
    assert atlas is not None
    drawn = np.flatnonzero(atlas.drawn(rng)[atlas.place_of])
    views, place_of = beside([goal.atlas_views(drawn) for goal in goals]), atlas.place_of[drawn]
    here = Ways.from_field(situation.field, atlas.places)
    costs = first_costs(robot, situation.pose, here, place_of, views.poses[:, 2])
    options, mass = _reached(Options(views, place_of, *costs, atlas.ways)), scaled_mass(goals)
    offered = _best_headings(options.views.values(mass), options.views.poses[:, 2], options.place_of)
    options = options.take(offered)
    return options.take(shortlist(options, mass, most))


def shortlist(options: Options, mass: FloatArray, most: int) -> IntArray:
    """Return at most `most` of the options: the greedy cover of the mass (K,) first, then by chance over cost."""
    index = options.views.values(mass) / options.seconds
    ranked = np.argsort(-index, kind="stable")
    cover = greedy_cover(options.views, mass, math.ceil(COVERING * most))
    rest = ranked[~np.isin(ranked, cover)][: most - len(cover)]
    return np.concatenate([cover, rest])


def greedy_cover(views: Views, mass: FloatArray, count: int) -> IntArray:
    """Return up to `count` views, each the one that adds most to sum_x mass(x) [1 - prod_v (1 - d_v(x))].

    Coverage is monotone and submodular, so this reaches at least 1 - 1/e of the best (Nemhauser et al. 1978).
    """
    left, chosen = mass.astype(np.float64).copy(), list[int]()
    for _ in range(min(count, len(views))):
        values = views.values(left)
        best = int(np.argmax(values))
        if values[best] <= 0.0 or best in chosen:
            break
        chosen.append(best)
        left *= 1.0 - views.row(best)
    return np.array(chosen, dtype=np.int64)


def problem_of(options: Options, goals: Sequence[Goal], robot: Robot, seconds: float) -> ViewProblem:
    """Return the choice among options that a search for all the goals faces."""
    beliefs = [goal.belief for goal in goals]
    return ViewProblem(
        views=options.views,
        mass=np.concatenate([belief.mass for belief in beliefs]),
        first=options.seconds,
        between=options.between(robot),
        seconds=seconds,
        goal_of=np.repeat(np.arange(len(goals)), [len(belief.mass) for belief in beliefs]),
        absent=np.array([belief.absent_mass for belief in beliefs]),
        instances=tuple(belief.instances for belief in beliefs),
    )


def scaled_mass(goals: Sequence[Goal]) -> FloatArray:
    """Return the posteriors of the goals' places, one goal after the other: (K,)."""
    return np.concatenate([goal.belief.probabilities for goal in goals])


def _reached(options: Options) -> Options:
    return options.take(np.flatnonzero(np.isfinite(options.seconds)))


def _best_headings(values: FloatArray, yaws: FloatArray, place_of: IntArray) -> IntArray:
    """Return two views of each place that shows anything: the best, and the best of those far from its heading."""
    _, place = np.unique(place_of, return_inverse=True)
    best = _best_of_each(values, place)
    apart = np.abs(np.remainder(yaws - yaws[best][place] + np.pi, 2.0 * np.pi) - np.pi) >= _APART
    second = _best_of_each(np.where(apart, values, -1.0), place)
    both = np.unique(np.concatenate([best, second]))
    return np.asarray(both[values[both] > 0.0])


def _best_of_each(values: FloatArray, place: IntArray) -> IntArray:
    """Return the first of the best views of each place, where places are numbered from 0 without a gap."""
    order = np.lexsort((-values, place))
    return np.asarray(order[np.searchsorted(place[order], np.arange(place.max(initial=-1) + 1))])
