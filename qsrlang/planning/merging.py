"""Places that the same views show at the same rates, taken together: no plan tells them apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit

from qsrlang.arrays import IntArray
from qsrlang.planning.problem import ViewProblem
from qsrlang.planning.views import IndexArray, Views


def merged(problem: ViewProblem) -> ViewProblem:
    """Return the problem with one place, of their summed mass, for all places of a target that views show alike.

    Every order of views costs what it did before. Places are told apart by a signature of 64 bits, so that among
    10^4 of them two that differ are taken for one with probability 3 x 10^-12.
    """
    views = problem.views
    signatures = problem.goal_of.astype(np.uint64)
    _sign(views.starts, views.shown, views.rates.view(np.uint32), signatures)
    _, firsts, group = np.unique(signatures, return_index=True, return_inverse=True)
    return replace(
        problem,
        views=_of_groups(views, firsts, group.astype(np.int32)),
        mass=np.bincount(group, problem.mass, minlength=len(firsts)).astype(np.float64),
        goal_of=problem.goal_of[firsts],
    )


def _of_groups(views: Views, firsts: IntArray, group: IndexArray) -> Views:
    """Return the views of groups (K,) of places, each of which the first of its members (G,) stands for."""
    stands = firsts[group[views.shown]] == views.shown
    starts = np.concatenate([[0], np.cumsum(stands)])[views.starts]
    return Views(
        views.poses, views.tilts, starts, group[views.shown[stands]], views.rates[stands], len(firsts)
    )


@njit(cache=True)
def _sign(starts, shown, rates, signatures):  # type: ignore[no-untyped-def]
    for view in range(len(starts) - 1):
        for entry in range(starts[view], starts[view + 1]):
            signatures[shown[entry]] += _mixed(np.uint64(view + 1) << np.uint64(32) | np.uint64(rates[entry]))


@njit(cache=True)
def _mixed(key):  # type: ignore[no-untyped-def]
    """Return a hash of 64 bits (the finaliser of SplitMix64, Steele, Lea and Flood 2014)."""
    key += np.uint64(0x9E3779B97F4A7C15)
    key = (key ^ (key >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    key = (key ^ (key >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return key ^ (key >> np.uint64(31))
