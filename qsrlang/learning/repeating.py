"""What one sighting at a place says of the next one there, and a density of what was seen at a place."""

from __future__ import annotations

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.cells import PairCells
from qsrlang.learning.density import PairDensity
from qsrlang.learning.experts import LEAST_MASS, HeldOut, test_cells
from qsrlang.learning.rectangles import upright_mass
from qsrlang.mixtures.gaussian import GaussianMixture

BANDWIDTHS = (0.03, 0.06, 0.12, 0.25)


def one_sighting(cells: PairCells, general: FloatArray) -> HeldOut:
    """Return what general knowledge, and one sighting at the same place, say of another sighting there.

    `general` (N,) is the former's density at `test_cells`. Rows are pairs of cells of one place, weighted by how often
    the two follow each other; both are blurred by what their cells hide.
    """
    tests = test_cells(cells)
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


def beside(general: PairDensity, cells: PairCells, shares: FloatArray) -> PairDensity:
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
