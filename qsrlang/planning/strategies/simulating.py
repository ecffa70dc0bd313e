"""The kernel of looking ahead: what a search costs that starts with a view and then follows the index."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.planning.merging import merged
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
    alike = merged(problem)
    tables, believed = _tables(alike)
    columns = np.ascontiguousarray(alike.views.table().T)
    nearness = np.array([problem.between ** (-1.0 / power) for power in powers])
    costs = np.empty(len(problem))
    ahead = (columns, _gains(alike), problem.seconds, depth)
    over_rows(
        lambda first, last: _follow(tables, believed, ahead, nearness, costs, first, last),
        len(problem),
        len(powers) * depth * len(problem) * len(alike.views.shown),
    )
    return costs


def follow_orders(problem: ViewProblem, orders: IntArray) -> FloatArray:
    """Return `ViewProblem.cost_of` each row of views (T, L), which a -1 ends: (T,) [s]."""
    tables, believed = _tables(merged(problem))
    costs = np.empty(len(orders))
    over_rows(
        lambda first, last: _follow_orders(orders, tables, believed, problem.seconds, costs, first, last),
        len(orders),
        orders.size * (1 + len(problem.views.shown) // max(len(problem), 1)),
    )
    return costs


def _tables(problem: ViewProblem) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return what kernels read: the views and what they cost; and what is believed at first."""
    views = problem.views
    tables = (views.starts, views.shown, views.rates, problem.goal_of, problem.first, problem.between)
    counts = np.array([one.count for one in problem.instances])
    poisson = np.array([one.poisson for one in problem.instances])
    return tables, (problem.mass, problem.unseen, counts, poisson)


def _gains(problem: ViewProblem) -> FloatArray:
    """Return the mass of each target that each view shows: (G, N)."""
    masses = [np.where(problem.goal_of == goal, problem.mass, 0.0) for goal in range(len(problem.instances))]
    return np.array([problem.views.values(mass) for mass in masses])


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
def _scale(unseen, counts, poisson):  # type: ignore[no-untyped-def]
    scale = np.empty(len(unseen))
    for goal in range(len(unseen)):
        scale[goal] = _phi(unseen[goal], counts[goal], poisson[goal])
    return scale


@njit(cache=True)
def _look(view, tables, mass, unseen):  # type: ignore[no-untyped-def]
    starts, shown, rates, goal_of = tables[:4]
    for entry in range(starts[view], starts[view + 1]):
        seen = mass[shown[entry]] * rates[entry]
        mass[shown[entry]] -= seen
        unseen[goal_of[shown[entry]]] -= seen


@njit(cache=True)
def _look_ahead(view, tables, columns, mass, unseen, gains):  # type: ignore[no-untyped-def]
    starts, shown, rates, goal_of = tables[:4]
    for entry in range(starts[view], starts[view + 1]):
        place = shown[entry]
        seen = mass[place] * rates[entry]
        goal, column = goal_of[place], columns[place]
        mass[place] -= seen
        unseen[goal] -= seen
        left = gains[goal]
        for other in range(len(column)):
            left[other] -= seen * column[other]


@njit(cache=True)
def _count_worths(gains, unseen, counts, poisson, scale, worths):  # type: ignore[no-untyped-def]
    worths[:] = 0.0
    for goal in range(len(unseen)):
        if scale[goal] <= 0.0:
            continue
        left, share, count, is_poisson = gains[goal], unseen[goal], counts[goal], poisson[goal]
        if count == 1.0 and not is_poisson:
            for view in range(len(worths)):
                worths[view] += max(left[view], 0.0) / scale[goal]
            continue
        before = _phi(share, count, is_poisson)
        for view in range(len(worths)):
            after = _phi(share - max(left[view], 0.0), count, is_poisson)
            worths[view] += (before - after) / scale[goal]


@njit(cache=True)
def _best(worths, near, looked, enough):  # type: ignore[no-untyped-def]
    worths[looked] = 0.0
    best, chosen = 0.0, -1
    for view in range(len(worths)):
        ratio = worths[view] * near[view]
        if ratio > best and worths[view] > enough:
            best, chosen = ratio, view
    return chosen


@njit(cache=True)
def _nearest(costs, looked):  # type: ignore[no-untyped-def]
    least, chosen = math.inf, -1
    for view in range(len(costs)):
        if costs[view] < least and not (looked == view).any():
            least, chosen = costs[view], view
    return chosen


@njit(cache=True)
def _cost_from(start, tables, believed, ahead, nearness):  # type: ignore[no-untyped-def]
    first, between = tables[4:]
    mass, unseen, counts, poisson = believed[0].copy(), believed[1].copy(), believed[2], believed[3]
    columns, gains, seconds, depth = ahead[0], ahead[1].copy(), ahead[2], ahead[3]
    worths, looked = np.empty(len(first)), np.empty(depth, dtype=np.int64)
    scale = _scale(unseen, counts, poisson)
    view, step, clock, cost = np.int64(start), first[start], 0.0, 0.0
    left = _left(unseen, counts, poisson, scale)
    for look in range(depth):
        step = min(step, seconds - clock)
        cost += step * left
        clock += step
        if clock >= seconds:
            break
        looked[look] = view
        _look_ahead(view, tables, columns, mass, unseen, gains)
        left = _left(unseen, counts, poisson, scale)
        _count_worths(gains, unseen, counts, poisson, scale, worths)
        chosen = _best(worths, nearness[view], looked[: look + 1], _ENOUGH * left)
        if chosen < 0 and not math.isfinite(seconds):
            chosen = _nearest(between[view], looked[: look + 1])
        if chosen < 0:
            break
        step, view = between[view, chosen], chosen
    return cost + (seconds - clock) * left if math.isfinite(seconds) else cost


@njit(cache=True, nogil=True)
def _follow(tables, believed, ahead, nearness, costs, first, last):  # type: ignore[no-untyped-def]
    for start in range(first, last):
        costs[start] = math.inf
        for power in range(len(nearness)):
            cost = _cost_from(start, tables, believed, ahead, nearness[power])
            costs[start] = min(costs[start], cost)


@njit(cache=True)
def _cost_of_order(order, tables, believed, seconds):  # type: ignore[no-untyped-def]
    first, between = tables[4:]
    mass, unseen, counts, poisson = believed[0].copy(), believed[1].copy(), believed[2], believed[3]
    scale = _scale(unseen, counts, poisson)
    clock, cost, last = 0.0, 0.0, -1
    for view in order:
        if view < 0 or clock >= seconds:
            break
        left = _left(unseen, counts, poisson, scale)
        step = min(first[view] if last < 0 else between[last, view], seconds - clock)
        cost += step * left
        clock += step
        last = view
        _look(view, tables, mass, unseen)
    return (
        cost + (seconds - clock) * _left(unseen, counts, poisson, scale) if math.isfinite(seconds) else cost
    )


@njit(cache=True, nogil=True)
def _follow_orders(orders, tables, believed, seconds, costs, first, last):  # type: ignore[no-untyped-def]
    for tour in range(first, last):
        costs[tour] = _cost_of_order(orders[tour], tables, believed, seconds)
