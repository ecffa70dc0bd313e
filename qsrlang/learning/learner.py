"""From sums to knowledge: for every pair a density that holds at places not seen, and what it gains there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.learning.cells import PairCells, cells_of
from qsrlang.learning.density import PairDensity, density_of
from qsrlang.learning.experts import held_out, test_cells, together
from qsrlang.learning.repeating import beside, one_sighting
from qsrlang.learning.stacking import Stack, core_weights, stacked
from qsrlang.learning.sums import PlacementSums

Pair = tuple[str, str]
# With fewer places nothing can be held out and the rest still be compared.
MIN_PLACES = 3
# What one sighting is worth, by bandwidth, beside knowing nothing: the mean over ten pairs of the KTH desks.
ONE_SIGHTING = np.array([0.36, 0.26, 0.14, 0.12, 0.12])
ANYWHERE = PairDensity(1.0, None, np.zeros(0, dtype=np.int64))


@dataclass(frozen=True, slots=True, eq=False)
class LearnedPair:
    """What is known of where `pair[0]` lies from `pair[1]`: its cells, the trust in each expert, and the density."""

    pair: Pair
    cells: PairCells
    stack: Stack
    density: PairDensity


@dataclass(frozen=True, slots=True, eq=False)
class Learned:
    """Every pair that was seen at MIN_PLACES or more places, and the weights of the experts over all pairs.

    `local` are the pairs that were seen at fewer: of them nothing is known but what was seen there.
    """

    pairs: Mapping[Pair, LearnedPair]
    core: FloatArray
    local: Mapping[Pair, LearnedPair]


def learn(sums: PlacementSums, pairs: Iterable[Pair] | None = None) -> Learned:
    """Return what sums tell of some pairs, or of all: shares and bandwidths by held-out likelihood, place by place."""
    asked = sums.pairs() if pairs is None else [pair for pair in pairs if pair in set(sums.pairs())]
    cells = {pair: cells_of(sums.of_pair(*pair)) for pair in asked}
    known = {pair: held_out(one) for pair, one in cells.items() if one.place_count >= MIN_PLACES}
    core = core_weights(list(known.values()))
    by_relatum = {
        name: together([one for pair, one in known.items() if pair[1] == name]) for _, name in known
    }
    classes = {name: stacked(one, core).weights for name, one in by_relatum.items()}
    stacks = {pair: stacked(one, classes[pair[1]]) for pair, one in known.items()}
    learned = {
        pair: LearnedPair(pair, cells[pair], stack, density_of(cells[pair], stack.weights))
        for pair, stack in stacks.items()
    }
    local = {pair: local_pair(pair, one) for pair, one in cells.items() if one.place_count < MIN_PLACES}
    return Learned(learned, core, local)


def local_pair(pair: Pair, cells: PairCells) -> LearnedPair:
    """Return what sightings at one or two places say of the next ones there; nothing, where they foretell nothing.

    p(x) = (w0 / area + sum_h n w_h p_h(x)) / (w0 + n sum_h w_h), with n sightings and the weights ONE_SIGHTING.
    """
    told = one_sighting(cells, 1.0 / cells.areas[test_cells(cells)])
    repeated = len(told.weights) > 0
    gain = 0.0
    if repeated:
        logs = np.log(told.densities @ ONE_SIGHTING) - np.log(told.densities[:, 0])
        gain = float(told.weights @ logs) / told.place_count
    odds = ONE_SIGHTING * np.where(np.arange(len(ONE_SIGHTING)) == 0, 1.0, cells.counts.sum())
    shares = odds / odds.sum() if gain > 0.0 else np.eye(len(ONE_SIGHTING))[0]
    density = beside(ANYWHERE, cells, shares) if gain > 0.0 else ANYWHERE
    return LearnedPair(pair, cells, Stack(shares, np.inf, max(gain, 0.0)), density)
