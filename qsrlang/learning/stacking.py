"""How much to trust each expert: weights by held-out likelihood, those of a pair shrunk to those of all pairs.

The weights maximise sum_n v_n log sum_e w_e p_e(x_n) + c sum_e w0_e log w_e (stacked densities, Smyth and Wolpert
1999, with a Dirichlet prior of concentration c about w0), by expectation maximisation. The concentration is the one
whose weights, found without a place, say most of that place; `inf` is w0 itself, and 0 stands for the first expert
alone, the one that says nothing: a pair about which nothing holds from place to place stays unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit

from qsrlang.arrays import FloatArray
from qsrlang.learning.experts import HeldOut

CONCENTRATIONS = (1.0, 4.0, 16.0, np.inf)
NOTHING = 0.0
_STEPS = 80
_CORE_PRIOR = 1.0
_TINY = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Stack:
    """Weights (E,) of the experts, the concentration they were found with, and what they gain on a place not seen.

    `gain` is nats for each object above the first expert, the mean over places.
    """

    weights: FloatArray
    concentration: float
    gain: float


def core_weights(known: Sequence[HeldOut]) -> FloatArray:
    """Return the weights (E,) for all pairs together, each place of each pair with the same weight; of none, none."""
    if not known:
        return np.zeros(0)
    densities = np.concatenate([one.densities for one in known])
    weights = np.concatenate([one.weights for one in known])
    count = densities.shape[1]
    return np.asarray(_maximised(densities, weights, np.full(count, _CORE_PRIOR / count)))


def stacked(known: HeldOut, core: FloatArray) -> Stack:
    """Return the weights for one pair, shrunk to the core's by the concentration that says most of places held out."""
    scores = {one: _score(known, core, one) for one in (NOTHING, *CONCENTRATIONS)}
    best = max(scores, key=lambda one: scores[one])
    gain = (scores[best] - scores[NOTHING]) / known.place_count
    return Stack(_weights(known.densities, known.weights, core, best), best, gain)


def _weights(
    densities: FloatArray, weights: FloatArray, core: FloatArray, concentration: float
) -> FloatArray:
    if concentration == NOTHING:
        return np.asarray(np.eye(len(core))[0])
    if np.isinf(concentration):
        return core
    return np.asarray(_maximised(densities, weights, concentration * core))


def _score(known: HeldOut, core: FloatArray, concentration: float) -> float:
    """Return the sum over places of the mean log density there, under weights found at the other places."""
    total = 0.0
    for place in np.unique(known.places):
        own = known.places == place
        found = _weights(known.densities[~own], known.weights[~own], core, concentration)
        total += float(known.weights[own] @ np.log(known.densities[own] @ found + _TINY))
    return total


@njit(cache=True)
def _maximised(densities, weights, prior):  # type: ignore[no-untyped-def]
    """Return the mixture weights at the posterior's mode, after a fixed number of steps from the prior's mean."""
    found = prior / prior.sum()
    for _ in range(_STEPS):
        gathered = prior.copy()
        for n in range(len(densities)):
            mixed = 0.0
            for e in range(len(found)):
                mixed += densities[n, e] * found[e]
            if mixed > 0.0:
                for e in range(len(found)):
                    gathered[e] += weights[n] * densities[n, e] * found[e] / mixed
        found = gathered / gathered.sum()
    return found
