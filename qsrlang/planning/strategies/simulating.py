"""The kernel of looking ahead: what a search costs that starts with a view and then follows the index."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.threads import over_rows

_ENOUGH = 1e-5
"""A simulated search ends when no view has this chance to find what is left."""


def follow_index(problem: ViewProblem, depth: int, powers: tuple[float, ...] = (1.0,)) -> FloatArray:
    """Return for each first view the cost [s] of `ViewProblem.cost_of` if an index chooses all later ones: (N,).

    The index is p^a / c, of the belief as it is by then, with the best of the `powers` a. Infinite where there is no
    way to the first view. Without a time limit the search goes on until the `depth` is reached or no view is left, the
    nearest first where none shows anything.
    """
    tables, believed = _tables(problem)
    costs = np.empty(len(problem))
    limits = (problem.seconds, depth, np.array(powers))
    over_rows(
        lambda first, last: _follow(tables, believed, limits, costs, first, last),
        len(problem),
        len(powers) * depth * len(problem) * len(problem.views.shown),
    )
    return costs


def follow_orders(problem: ViewProblem, orders: IntArray) -> FloatArray:
    """Return `ViewProblem.cost_of` each row of views (T, L), which a -1 ends: (T,) [s]."""
    tables, believed = _tables(problem)
    costs = np.empty(len(orders))
    over_rows(
        lambda first, last: _follow_orders(orders, tables, believed, problem.seconds, costs, first, last),
        len(orders),
        orders.size * (1 + len(problem.views.shown) // max(len(problem), 1)),
    )
    return costs


def _tables(problem: ViewProblem) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return what kernels read: the views by rows and by places, the costs; and what is believed at first."""
    views = problem.views
    order = np.argsort(views.shown, kind="stable")
    showing = np.repeat(np.arange(len(views)), np.diff(views.starts))[order].astype(np.int32)
    begins = np.concatenate([[0], np.cumsum(np.bincount(views.shown, minlength=views.places))])
    goals = range(len(problem.instances))
    gains = np.array([views.values(np.where(problem.goal_of == goal, problem.mass, 0.0)) for goal in goals])
    tables = (
        *(views.starts, views.shown, views.rates, begins, showing, views.rates[order]),
        *(problem.goal_of, problem.first, problem.between),
    )
    believed = (
        *(problem.mass, gains.reshape(len(problem.instances), len(views)), problem.unseen),
        np.array([one.count for one in problem.instances]),
        np.array([one.poisson for one in problem.instances]),
    )
    return tables, believed


@njit(cache=True)
def _phi(unseen, count, poisson):  # type: ignore[no-untyped-def]
    if poisson:
        return math.exp(-count * (1.0 - unseen))
    return unseen if count == 1.0 else max(unseen, 0.0) ** count


@njit(cache=True)
def _left(unseen, counts, poisson, scale):  # type: ignore[no-untyped-def]
    total = 0.0
    for goal in range(len(unseen)):
        if scale[goal] > 0.0:
            total += _phi(unseen[goal], counts[goal], poisson[goal]) / scale[goal]
    return total


@njit(cache=True)
def _worth(view, gains, unseen, counts, poisson, scale):  # type: ignore[no-untyped-def]
    total = 0.0
    for goal in range(len(unseen)):
        if scale[goal] > 0.0 and gains[goal, view] > 0.0:
            before = _phi(unseen[goal], counts[goal], poisson[goal])
            after = _phi(unseen[goal] - gains[goal, view], counts[goal], poisson[goal])
            total += (before - after) / scale[goal]
    return total


@njit(cache=True)
def _look(view, starts, shown, rates, begins, showing, inverse, goal_of, mass, gains, unseen):  # type: ignore[no-untyped-def]
    for entry in range(starts[view], starts[view + 1]):
        place = shown[entry]
        seen = mass[place] * rates[entry]
        if seen <= 0.0:
            continue
        goal = goal_of[place]
        mass[place] -= seen
        unseen[goal] -= seen
        for other in range(begins[place], begins[place + 1]):
            gains[goal, showing[other]] -= seen * inverse[other]


@njit(cache=True)
def _next(view, used, gains, unseen, counts, poisson, scale, between, power, enough):  # type: ignore[no-untyped-def]
    best, chosen, nearest = 0.0, -1, -1
    for other in range(len(used)):
        if used[other] or not math.isfinite(between[view, other]):
            continue
        if nearest < 0 or between[view, other] < between[view, nearest]:
            nearest = other
        worth = _worth(other, gains, unseen, counts, poisson, scale)
        if worth > enough:
            ratio = worth**power / between[view, other]
            if ratio > best:
                best, chosen = ratio, other
    return chosen, nearest


@njit(cache=True)
def _cost_from(start, tables, believed, limits):  # type: ignore[no-untyped-def]
    starts, shown, rates, begins, showing, inverse, goal_of, first, between = tables
    mass, gains, unseen = believed[0].copy(), believed[1].copy(), believed[2].copy()
    counts, poisson = believed[3], believed[4]
    seconds, depth, power = limits
    used, scale = np.zeros(len(first), dtype=np.bool_), np.empty(len(unseen))
    for goal in range(len(unseen)):
        scale[goal] = _phi(unseen[goal], counts[goal], poisson[goal])
    view, step, clock, cost = np.int64(start), first[start], 0.0, 0.0
    left = _left(unseen, counts, poisson, scale)
    for _ in range(depth):
        step = min(step, seconds - clock)
        cost += step * left
        clock += step
        if clock >= seconds:
            break
        used[view] = True
        _look(view, starts, shown, rates, begins, showing, inverse, goal_of, mass, gains, unseen)
        left = _left(unseen, counts, poisson, scale)
        chosen, nearest = _next(
            view, used, gains, unseen, counts, poisson, scale, between, power, _ENOUGH * left
        )
        if chosen < 0 and not math.isfinite(seconds):
            chosen = nearest
        if chosen < 0:
            break
        step, view = between[view, chosen], chosen
    return cost + (seconds - clock) * left if math.isfinite(seconds) else cost


@njit(cache=True, nogil=True)
def _follow(tables, believed, limits, costs, first, last):  # type: ignore[no-untyped-def]
    for start in range(first, last):
        costs[start] = math.inf
        for power in limits[2]:
            cost = _cost_from(start, tables, believed, (limits[0], limits[1], power))
            costs[start] = min(costs[start], cost)


@njit(cache=True)
def _cost_of_order(order, tables, believed, seconds):  # type: ignore[no-untyped-def]
    starts, shown, rates, _, _, _, goal_of, first, between = tables
    mass, unseen, counts, poisson = believed[0].copy(), believed[2].copy(), believed[3], believed[4]
    scale = np.empty(len(unseen))
    for goal in range(len(unseen)):
        scale[goal] = _phi(unseen[goal], counts[goal], poisson[goal])
    clock, cost, last = 0.0, 0.0, -1
    for view in order:
        if view < 0 or clock >= seconds:
            break
        left = _left(unseen, counts, poisson, scale)
        step = min(first[view] if last < 0 else between[last, view], seconds - clock)
        cost += step * left
        clock += step
        last = view
        for entry in range(starts[view], starts[view + 1]):
            seen = mass[shown[entry]] * rates[entry]
            mass[shown[entry]] -= seen
            unseen[goal_of[shown[entry]]] -= seen
    return (
        cost + (seconds - clock) * _left(unseen, counts, poisson, scale) if math.isfinite(seconds) else cost
    )


@njit(cache=True, nogil=True)
def _follow_orders(orders, tables, believed, seconds, costs, first, last):  # type: ignore[no-untyped-def]
    for tour in range(first, last):
        costs[tour] = _cost_of_order(orders[tour], tables, believed, seconds)
