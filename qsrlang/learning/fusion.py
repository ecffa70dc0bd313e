"""Where an object is, from all that is seen about it: a weighted product of what each relatum says.

log p(x) = sum_l a_l log p_l(x) - log Z, on the support (a logarithmic opinion pool, Genest and Zidek 1986). What
neighbours say is not independent, so the exponents a_l are learned: they maximise the held-out likelihood of the
places, those of a referent drawn to a part of those of all referents; part and pull are the ones that say most of
places held out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from qsrlang.arrays import BoolArray, FloatArray
from qsrlang.learning.cells import PairCells
from qsrlang.learning.density import PairDensity, density_of
from qsrlang.learning.grids import Sight, grid_density, grid_of, sights_of
from qsrlang.learning.learner import Learned, Pair
from qsrlang.learning.observations import Observations

PULLS = (1.0, 3.0, 10.0, 100.0)
# What a referent's exponents are drawn to: these parts of the shared ones, for some referents heed no neighbour much.
PARTS = (1.0, 0.5, 0.2)
FOLDS = 3
MAX_EXPONENT = 2.0
MAX_SIGHTS = 5
# Share of the support's uniform density in what a place is scored by, so that no single surprise decides.
FLOOR = 0.05
_START, _LOOSE = 0.3, 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Fusion:
    """The pair densities and the exponent of each relatum for each referent; 0 where none was learned."""

    densities: Mapping[Pair, PairDensity]
    exponents: Mapping[Pair, float]

    def log_density(self, sight: Sight, spacing: float) -> FloatArray:
        """Return log p (G + 1,) [log 1/m^2] on a grid of the support and, last, at the referent itself."""
        grid = grid_of(sight, spacing)
        total = np.zeros(len(grid))
        for relatum, stance in sight.relata.items():
            exponent = self.exponents.get((sight.referent, relatum), 0.0)
            if exponent > 0.0:
                total += exponent * np.log(
                    grid_density(self.densities[sight.referent, relatum], stance, grid)
                )
        peak = total[:-1].max()
        return np.asarray(total - peak - np.log(np.exp(total[:-1] - peak).mean()) - np.log(sight.area))


@dataclass(frozen=True, slots=True, eq=False)
class _Cases:
    """N cases of one referent: log densities times area (N, R, G + 1), weights (N,), and places."""

    logs: FloatArray
    weights: FloatArray
    places: tuple[str, ...]

    def take(self, chosen: BoolArray) -> _Cases:
        rows = np.flatnonzero(chosen)
        return _Cases(self.logs[rows], self.weights[rows], tuple(self.places[row] for row in rows))


def learn_fusion(seen: Observations, learned: Learned, referents: Sequence[str]) -> Fusion:
    """Return the densities with exponents learned from the scenes of observations, for some referents."""
    densities = {pair: one.density for pair, one in learned.pairs.items() if one.density.mixture is not None}
    relata = sorted({relatum for referent, relatum in densities if referent in referents})
    cases = {name: _cases(seen, learned, name, relata) for name in referents}
    cases = {name: case for name, case in cases.items() if len(case.logs)}
    shared = _fitted(list(cases.values()), np.full(len(relata), _START), _LOOSE)
    exponents = {name: _chosen(case, shared) for name, case in cases.items()}
    named = {(n, r): float(a) for n, found in exponents.items() for r, a in zip(relata, found, strict=True)}
    return Fusion(densities, {pair: value for pair, value in named.items() if pair in densities})


def _chosen(cases: _Cases, shared: FloatArray) -> FloatArray:
    """Return a referent's exponents, by the part of the shared ones and the pull to it that say most."""
    choices = [(part, pull) for part in PARTS for pull in PULLS]
    part, pull = max(choices, key=lambda one: _score(cases, one[0] * shared, one[1]))
    return _fitted([cases], part * shared, pull)


def _cases(seen: Observations, learned: Learned, referent: str, relata: Sequence[str]) -> _Cases:
    """Return some sights from each place, each told by densities that do not know the place."""
    sights = _thinned(sights_of(seen, referent))
    logs = [_logs(sight, learned, relata) for sight in sights]
    counts = {place: sum(one.place == place for one in sights) for place in {one.place for one in sights}}
    weights = np.array([1.0 / counts[sight.place] for sight in sights])
    size = (0, len(relata), 1)
    return _Cases(np.stack(logs) if logs else np.zeros(size), weights, tuple(one.place for one in sights))


def _thinned(sights: Sequence[Sight]) -> list[Sight]:
    by_place: dict[str, list[Sight]] = {}
    for sight in sights:
        by_place.setdefault(sight.place, []).append(sight)
    kept = []
    for group in by_place.values():
        rows = np.unique(np.linspace(0, len(group) - 1, MAX_SIGHTS).astype(int))
        kept += [group[row] for row in rows]
    return kept


def _logs(sight: Sight, learned: Learned, relata: Sequence[str]) -> FloatArray:
    grid = grid_of(sight, None)
    logs = np.zeros((len(relata), len(grid)))
    for row, relatum in enumerate(relata):
        one = learned.pairs.get((sight.referent, relatum))
        if one is None or one.density.mixture is None or relatum not in sight.relata:
            continue
        density = density_of(_elsewhere(one.cells, sight.place), one.stack.weights)
        logs[row] = np.log(grid_density(density, sight.relata[relatum], grid) * sight.area)
    return logs


def _elsewhere(cells: PairCells, place: str) -> PairCells:
    number = cells.words.index(place) if place in cells.words else -1
    return cells.take(cells.places != number)


def _score(cases: _Cases, shared: FloatArray, pull: float) -> float:
    """Return what exponents found at two thirds of the places say of the others."""
    names = sorted(set(cases.places))
    total = 0.0
    for fold in range(FOLDS):
        out = np.isin(cases.places, names[fold::FOLDS])
        if out.any() and not out.all():
            found = _fitted([cases.take(~out)], shared, pull)
            total += _likelihood(cases.take(out), found)[0]
    return total


def _fitted(cases: Sequence[_Cases], towards: FloatArray, pull: float) -> FloatArray:
    """Return the exponents that maximise the likelihood less pull * |a - towards|^2."""

    def cost(exponents: FloatArray) -> tuple[float, FloatArray]:
        parts = [_likelihood(case, exponents) for case in cases]
        off = exponents - towards
        value = pull * float(off @ off) - sum(part for part, _ in parts)
        return value, 2.0 * pull * off - sum((slope for _, slope in parts), np.zeros(len(off)))

    bounds = [(0.0, MAX_EXPONENT)] * len(towards)
    return np.asarray(minimize(cost, towards, jac=True, bounds=bounds, method="L-BFGS-B").x)


def _likelihood(cases: _Cases, exponents: FloatArray) -> tuple[float, FloatArray]:
    """Return the sum of weighted log densities times area, a share FLOOR uniform, and its slope (R,)."""
    totals = exponents @ cases.logs
    peaks = totals[:, :-1].max(axis=1, keepdims=True)
    heights = np.exp(totals[:, :-1] - peaks)
    masses = heights.mean(axis=1)
    density = np.exp(totals[:, -1] - peaks[:, 0]) / masses
    mixed = (1.0 - FLOOR) * density + FLOOR
    chances = heights / heights.sum(axis=1, keepdims=True)
    slopes = cases.logs[:, :, -1] - (cases.logs[:, :, :-1] @ chances[..., None])[..., 0]
    shares = cases.weights * (1.0 - FLOOR) * density / mixed
    return float(cases.weights @ np.log(mixed)), np.asarray(shares @ slopes)
