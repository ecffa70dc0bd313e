"""Knowledge of one place: what holds in general, and what was seen there, by how much of it was seen.

p(x) = w0 / W p_general(x) + sum_h n w_h / W p_h(x), with n sightings at the place, blurred by bandwidths h, and W what
makes the shares sum to 1. The weights are those that say most of one sighting at a place by another one there, at
places held out from general knowledge; those of a pair are shrunk as `stacking` does, and a pair whose earlier
sightings say nothing of later ones keeps to general knowledge.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from qsrlang.arrays import FloatArray
from qsrlang.learning.cells import cells_of
from qsrlang.learning.density import PairDensity
from qsrlang.learning.experts import HeldOut, held_out, together
from qsrlang.learning.learner import Learned, LearnedPair, Pair, learn
from qsrlang.learning.repeating import beside, one_sighting
from qsrlang.learning.stacking import core_weights, stacked
from qsrlang.learning.sums import PlacementSums


@dataclass(frozen=True, slots=True, eq=False)
class PlaceLearner:
    """General knowledge, and for each pair the weights (1 + 4,) of it and of one sighting at a place, by bandwidth."""

    general: Learned
    weights: Mapping[Pair, FloatArray]

    @classmethod
    def of(cls, sums: PlacementSums, pairs: Iterable[Pair] | None = None) -> PlaceLearner:
        """Return what sums over several places teach of a place that is none of them."""
        general = learn(sums, pairs)
        told = {pair: _told(one) for pair, one in general.pairs.items()}
        told = {pair: one for pair, one in told.items() if one.place_count > 1}
        core = core_weights(list(told.values()))
        by_relatum = {
            name: together([one for pair, one in told.items() if pair[1] == name]) for _, name in told
        }
        classes = {name: stacked(one, core).weights for name, one in by_relatum.items()}
        return cls(general, {pair: stacked(one, classes[pair[1]]).weights for pair, one in told.items()})

    def density(self, pair: Pair, here: PlacementSums) -> PairDensity:
        """Return where `pair[0]` is from `pair[1]` at a place with these sums; general knowledge where none are."""
        general = self.general.pairs[pair].density
        own = here.of_pair(*pair)
        if len(own) == 0 or pair not in self.weights:
            return general
        cells = cells_of(own)
        odds = self.weights[pair].copy()
        odds[1:] *= cells.counts.sum()
        return beside(general, cells, odds / odds.sum())


def _told(one: LearnedPair) -> HeldOut:
    return one_sighting(one.cells, held_out(one.cells).densities @ one.stack.weights)
