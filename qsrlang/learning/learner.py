"""From sums to knowledge: for every pair a density that holds at places not seen, and what it gains there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from qsrlang.arrays import FloatArray
from qsrlang.learning.cells import PairCells, cells_of
from qsrlang.learning.density import PairDensity, density_of
from qsrlang.learning.experts import held_out, together
from qsrlang.learning.stacking import Stack, core_weights, stacked
from qsrlang.learning.sums import PlacementSums

Pair = tuple[str, str]
# With fewer places nothing can be held out and the rest still be compared.
MIN_PLACES = 3


@dataclass(frozen=True, slots=True, eq=False)
class LearnedPair:
    """What is known of where `pair[0]` lies from `pair[1]`: its cells, the trust in each expert, and the density."""

    pair: Pair
    cells: PairCells
    stack: Stack
    density: PairDensity


@dataclass(frozen=True, slots=True, eq=False)
class Learned:
    """Every pair that was seen at MIN_PLACES or more places, and the weights of the experts over all pairs."""

    pairs: Mapping[Pair, LearnedPair]
    core: FloatArray


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
    return Learned(learned, core)
