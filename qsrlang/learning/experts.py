"""Densities that know a pair from other places, from the one that says nothing to the most precise.

uniform    anywhere on the support
wide       the predictive of a normal-inverse-Wishart prior and all places (Murphy 2007), moments of its Student t
kernels    the placements at every place, blurred by h: mean over places of sum_m share_m N(x; m, S_m + h^2 I)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, IntArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.cells import PairCells
from qsrlang.learning.rectangles import upright_mass

BANDWIDTHS = (0.05, 0.1, 0.2, 0.4)
EXPERTS = ("uniform", "wide", *(f"kernel {100 * h:g} cm" for h in BANDWIDTHS))
# The prior of the wide expert: one place with the referent at the relatum, and this deviation [m].
WIDE_DEVIATION = 0.5
_PRIOR_PLACES, _PRIOR_FREEDOM = 1.0, 4.0
LEAST_MASS = 1e-9
MAX_TESTS = 300


@dataclass(frozen=True, slots=True, eq=False)
class HeldOut:
    """What E experts say of N placements from places they have not seen: densities (N, E) [1/m^2].

    `weights` (N,) sum to 1 over each place; `places` (N,) are the places' numbers.
    """

    densities: FloatArray
    weights: FloatArray
    places: IntArray

    @property
    def place_count(self) -> int:
        """How many places there are."""
        return len(np.unique(self.places))


def together(known: Sequence[HeldOut]) -> HeldOut:
    """Return what experts say of several pairs; a place counts once for each pair that was seen there."""
    columns = (
        np.concatenate([getattr(one, name) for one in known]) for name in ("densities", "weights", "places")
    )
    return HeldOut(*columns)


def held_out(cells: PairCells) -> HeldOut:
    """Return what the experts, each taught by all places but one, say of that one, cut to the support there."""
    tests = test_cells(cells)
    means = cells.means_on_support[tests]
    columns = [1.0 / cells.areas[tests], _wide_densities(cells, tests, means)]
    others = (cells.places[tests, None] != cells.places) * cells.shares
    others /= others.sum(axis=1, keepdims=True)
    source_means = np.einsum("nij,mj->nmi", rotation(cells.turns[tests]), cells.means)
    columns += [_kernel_densities(cells, tests, source_means, means, others, h) for h in BANDWIDTHS]
    weights = cells.shares[tests]
    totals = np.bincount(cells.places[tests], weights=weights)
    return HeldOut(np.column_stack(columns), weights / totals[cells.places[tests]], cells.places[tests])


def test_cells(cells: PairCells) -> IntArray:
    """Return the cells to test on: all, or MAX_TESTS spread evenly."""
    return np.unique(np.linspace(0, len(cells) - 1, MAX_TESTS).astype(np.int64))


def _kernel_densities(
    cells: PairCells, tests: IntArray, sources: FloatArray, means: FloatArray, shares: FloatArray, h: float
) -> FloatArray:
    """Return the cut density (N,) of the kernels of other places; correlations within cells do not move its mass."""
    covariances = cells.spreads + h * h * np.eye(2)
    inverse = np.linalg.inv(covariances)
    residuals = cells.means[tests][:, None] - cells.means
    squares = np.einsum("nmi,mij,nmj->nm", residuals, inverse, residuals)
    heights = np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariances)))
    deviations = np.sqrt(np.diagonal(covariances, axis1=1, axis2=2))
    low, high = cells.low[tests][:, None], cells.high[tests][:, None]
    masses = (upright_mass(sources, deviations, low, high) * shares).sum(axis=1)
    return np.asarray((heights * shares).sum(axis=1) / np.maximum(masses, LEAST_MASS))


def _wide_densities(cells: PairCells, tests: IntArray, means: FloatArray) -> FloatArray:
    """Return the cut density (N,) of the wide expert, taught by the other places."""
    density = np.empty(len(tests))
    for place in np.unique(cells.places[tests]):
        own = cells.places[tests] == place
        centre, covariance = wide_gaussian(cells, cells.places != place)
        rows = tests[own]
        residuals = cells.means[rows] - centre
        squares = np.einsum("ni,ij,nj->n", residuals, np.linalg.inv(covariance), residuals)
        height = np.exp(-0.5 * squares) / (2.0 * np.pi * np.sqrt(np.linalg.det(covariance)))
        centres = rotation(cells.turns[rows]) @ centre
        mass = upright_mass(centres, np.sqrt(np.diag(covariance)), cells.low[rows], cells.high[rows])
        density[own] = height / np.maximum(mass, LEAST_MASS)
    return density


def wide_gaussian(cells: PairCells, chosen: FloatArray | IntArray) -> tuple[FloatArray, FloatArray]:
    """Return mean (2,) and covariance (2, 2) of the normal-inverse-Wishart predictive, one observation a place.

    kappa' = kappa + P, nu' = nu + P, Psi' = Psi + sum of squares about the mean + kappa P / kappa' m m^T, and the
    Student t's covariance is Psi' (kappa' + 1) / (kappa' (nu' - 3)) (Murphy 2007, equations 250 to 258).
    """
    shares, means = cells.shares * chosen, cells.means
    count = shares.sum()
    mean = shares @ means / max(count, LEAST_MASS)
    off = means - mean
    scatter = np.einsum("m,mij->ij", shares, cells.spreads) + off.T @ (shares[:, None] * off)
    kappa, freedom = _PRIOR_PLACES + count, _PRIOR_FREEDOM + count
    scatter = scatter + WIDE_DEVIATION**2 * np.eye(2) + _PRIOR_PLACES * count / kappa * np.outer(mean, mean)
    return np.asarray(count / kappa * mean), np.asarray(scatter * (kappa + 1.0) / (kappa * (freedom - 3.0)))
