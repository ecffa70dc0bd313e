"""An object on its support among its neighbours, and densities on a grid of that support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.geometry.angles import rotation
from qsrlang.learning.density import PairDensity
from qsrlang.learning.experts import LEAST_MASS
from qsrlang.learning.observations import Observations
from qsrlang.learning.placements import placements_of

# A grid of this many cells along x and y where no spacing is asked for.
COARSE = (10, 22)


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """Where a support lies about a relatum: its corners `low`, `high` (2,) [m] and how far the relatum is turned."""

    low: FloatArray
    high: FloatArray
    turn: float


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """An object at a place, where it lies on its support, as shares (2,) of its sides, and its neighbours."""

    referent: str
    place: str
    scene: str
    share: FloatArray
    area: float
    relata: Mapping[str, Stance]


def sights_of(seen: Observations, referent: str) -> list[Sight]:
    """Return all sightings of a class of objects, each with every neighbour it has a placement to."""
    placed = placements_of(seen)
    wanted = np.flatnonzero(np.array(seen.words)[seen.code("kind")[placed.referents]] == referent)
    by_row: dict[int, list[int]] = {}
    for number in wanted:
        by_row.setdefault(int(placed.referents[number]), []).append(int(number))
    sights = []
    for row, numbers in by_row.items():
        stances = {
            seen.words[seen.code("kind")[placed.relata[one]]]: Stance(
                placed.low[one], placed.high[one], placed.turns[one]
            )
            for one in numbers
        }
        first = numbers[0]
        size = placed.high[first] - placed.low[first]
        point = rotation(placed.turns[first]) @ placed.points[first]
        share = (point - placed.low[first]) / size
        place, scene = seen.words[seen.code("place")[row]], seen.words[seen.code("scene")[row]]
        sights.append(Sight(referent, place, scene, share, float(size.prod()), stances))
    return sights


def grid_of(sight: Sight, spacing: float | None) -> FloatArray:
    """Return the middles of a grid's cells as shares of the support's sides, and last the object itself: (G + 1, 2)."""
    stance = next(iter(sight.relata.values()))
    size = stance.high - stance.low
    columns, rows = COARSE if spacing is None else np.maximum(np.round(size / spacing).astype(int), 1)
    x, y = (np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows
    middles = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.concatenate([middles, sight.share[None]])


def grid_density(density: PairDensity, stance: Stance, grid: FloatArray) -> FloatArray:
    """Return a pair's density (G + 1,) [1/m^2], each expert's cut to the support by its mean on the grid."""
    size = stance.high - stance.low
    total = np.full(len(grid), density.anywhere / size.prod())
    if density.mixture is None:
        return total
    points = (stance.low + grid * size) @ rotation(stance.turn)
    for group, height in enumerate(density.heights(points).T):
        share = density.mixture.weights[density.groups == group].sum() * (1.0 - density.anywhere)
        total = total + share * height / max(height[:-1].mean() * size.prod(), LEAST_MASS)
    return np.asarray(np.maximum(total, LEAST_MASS))
