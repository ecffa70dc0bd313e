"""Knowledge of one place: what holds in general, and what was seen there, by how much of it was seen.

p(x) = w0 / W p_general(x) + sum_h n w_h / W p_h(x), with n sightings at the place, blurred by bandwidths h, and W what
makes the shares sum to 1. The weights are those that say most of one sighting at a place by another one there, at
places held out from general knowledge; those of a pair are shrunk as `stacking` does, and a pair whose earlier
sightings say nothing of later ones keeps to general knowledge.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.cells import PairCells, cells_of
from qsrlang.learning.density import PairDensity
from qsrlang.learning.experts import LEAST_MASS, HeldOut, held_out, test_cells, together
from qsrlang.learning.learner import Learned, LearnedPair, Pair, learn
from qsrlang.learning.rectangles import upright_mass
from qsrlang.learning.stacking import core_weights, stacked
from qsrlang.learning.sums import PlacementSums
from qsrlang.mixtures.gaussian import GaussianMixture

BANDWIDTHS = (0.03, 0.06, 0.12, 0.25)


@dataclass(frozen=True, slots=True, eq=False)
class PlaceLearner:
    """General knowledge, and for each pair the weights (1 + 4,) of it and of one sighting at a place, by bandwidth."""

    general: Learned
    weights: Mapping[Pair, FloatArray]

    @classmethod
    def of(cls, sums: PlacementSums, pairs: Iterable[Pair] | None = None) -> PlaceLearner:
        """Return what sums over several places teach of a place that is none of them."""
        general = learn(sums, pairs)
        told = {pair: one_sighting(one) for pair, one in general.pairs.items()}
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
        return _beside(general, cells, odds / odds.sum())


def one_sighting(one: LearnedPair) -> HeldOut:
    """Return what general knowledge, and one sighting at the same place, say of another sighting there.

    Rows are pairs of cells of one place, weighted by how often the two follow each other; both are blurred by what
    their cells hide.
    """
    cells, tests = one.cells, test_cells(one.cells)
    general = held_out(cells).densities @ one.stack.weights
    rows, sources = np.nonzero(cells.places[tests][:, None] == cells.places)
    targets = tests[rows]
    totals = np.bincount(cells.places, weights=cells.counts)[cells.places[targets]]
    others = np.maximum(cells.counts[sources] - (targets == sources), 0.0) / np.maximum(totals - 1.0, 1.0)
    weights = cells.shares[targets] * others
    seen = weights > 0.0
    densities = [_from_sighting(cells, targets[seen], sources[seen], h) for h in BANDWIDTHS]
    columns = np.column_stack([general[rows[seen]], *densities])
    places = cells.places[targets[seen]]
    each = np.bincount(places, weights=weights[seen])[places] if seen.any() else np.ones(0)
    return HeldOut(columns, weights[seen] / each, places)


def _from_sighting(cells: PairCells, targets: IntArray, sources: IntArray, h: float) -> FloatArray:
    """Return the density (N,) at target cells of a Gaussian of bandwidth h about source cells, cut to the support."""
    covariances = cells.spreads[targets] + cells.spreads[sources] + h * h * np.eye(2)
    off = cells.means[targets] - cells.means[sources]
    squares = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariances), off)
    heights = np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariances)))
    means = np.einsum("nij,nj->ni", rotation(cells.turns[targets]), cells.means[sources])
    deviations = np.sqrt(np.diagonal(covariances, axis1=1, axis2=2))
    masses = upright_mass(means, deviations, cells.low[targets], cells.high[targets])
    return np.asarray(heights / np.maximum(masses, LEAST_MASS))


def _beside(general: PairDensity, cells: PairCells, shares: FloatArray) -> PairDensity:
    """Return general knowledge with share `shares[0]`, and the sightings at one place with the others."""
    weights = [share * cells.shares / cells.shares.sum() for share in shares[1:]]
    means = [cells.means] * len(BANDWIDTHS)
    covariances = [cells.spreads + h * h * np.eye(2) for h in BANDWIDTHS]
    groups = [np.full(len(cells), number) for number in range(len(BANDWIDTHS))]
    if general.mixture is not None:
        weights.append(shares[0] * (1.0 - general.anywhere) * general.mixture.weights)
        means.append(general.mixture.means)
        covariances.append(general.mixture.covariances)
        groups.append(general.groups + len(BANDWIDTHS))
    mixed = np.concatenate(weights)
    anywhere = float(shares[0] * general.anywhere)
    mixture = GaussianMixture(mixed / mixed.sum(), np.concatenate(means), np.concatenate(covariances))
    return PairDensity(anywhere, mixture, np.concatenate(groups))
