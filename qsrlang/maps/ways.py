"""Ways between places: how long each is, how it sets out, bends and arrives; what a robot pays for driving it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.geometry.angles import TURN, wrap
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.paths import DistanceField
from qsrlang.maps.tracing import trace_ways

MAX_PLACES = 2_000


@dataclass(frozen=True, slots=True, eq=False)
class Ways:
    """The ways from S starts to P places: `lengths` [m], `departures`, `bends`, `arrivals` [rad], all (S, P).

    A way sets out in the direction `departures`, turns by `bends` in sum on the way, and comes in along `arrivals`.
    Where there is no way its length is infinite; a way of no length has no directions (nan).
    """

    lengths: FloatArray
    departures: FloatArray
    bends: FloatArray
    arrivals: FloatArray

    @classmethod
    def from_field(cls, field: DistanceField, places_map: npt.ArrayLike) -> Ways:
        """Return the ways (1, P) from the start of a distance field to places (P, 2)."""
        places = frozen_array("the places of ways", places_map, (None, 2))
        return cls(*(column[None] for column in trace_ways_of(field, places)))

    @classmethod
    def among(cls, navigation: NavigationGrid, places_map: npt.ArrayLike) -> Ways:
        """Return the ways (P, P) among navigable places (P, 2), by one distance field from each."""
        places = frozen_array("the places of ways", places_map, (None, 2))
        rows = [trace_ways_of(DistanceField.from_start(navigation, place), places) for place in places]
        columns = np.array(rows).reshape(len(places), 4, len(places))
        return cls(*(columns[:, part] for part in range(4)))

    def rows(self, indices: npt.ArrayLike) -> Ways:
        """Return the ways from some of the starts."""
        chosen = np.asarray(indices)
        return Ways(self.lengths[chosen], self.departures[chosen], self.bends[chosen], self.arrivals[chosen])

    def turning(
        self, yaws_start: npt.ArrayLike, starts: IntArray, yaws_end: npt.ArrayLike, ends: IntArray
    ) -> FloatArray:
        """Return what a robot turns [rad] that leaves `starts` (...) with one yaw and reaches `ends` with another.

        |departure - first yaw| + bends + |last yaw - arrival|, or |last yaw - first yaw| where it stays.
        """
        first, last = np.asarray(yaws_start, dtype=np.float64), np.asarray(yaws_end, dtype=np.float64)
        out, bend, home = (part[starts, ends] for part in (self.departures, self.bends, self.arrivals))
        stays = np.isnan(out)
        moving = (
            _between(first, np.where(stays, 0.0, out)) + bend + _between(np.where(stays, 0.0, home), last)
        )
        return np.asarray(np.where(stays, _between(first, last), moving))


def trace_ways_of(field: DistanceField, places: FloatArray) -> tuple[FloatArray, ...]:
    """Return lengths, departures, bends and arrivals (P,) of the ways from a field's start to places (P, 2)."""
    reached, start, goals = field.in_cells(places)
    parts = np.full((4, len(places)), np.nan)
    parts[0], parts[2] = np.inf, 0.0
    traced = trace_ways(field.navigation.navigable, field.parents, start, goals)
    turn = field.navigation.grid.origin.yaw
    parts[0, reached] = traced[0] * field.navigation.grid.resolution
    parts[1, reached], parts[3, reached] = wrap(traced[1] + turn), wrap(traced[3] + turn)
    parts[2, reached] = traced[2]
    return tuple(parts)


def lattice(navigation: NavigationGrid, spacing: float, most: int = MAX_PLACES) -> FloatArray:
    """Return about one navigable place (P, 2) [m] for each square of `spacing` [m], the nearest to its middle.

    Where that gives more than `most`, the squares grow. The squares belong to the grid, so the places move with it.
    """
    rows, columns = np.nonzero(navigation.navigable)
    step = max(spacing / navigation.grid.resolution, 1.0)
    while True:
        places = _nearest_to_middle(rows, columns, step)
        if len(places) <= most:
            return navigation.grid.centres_of(places)
        step *= 1.2


def _nearest_to_middle(
    rows: npt.NDArray[np.int64], columns: npt.NDArray[np.int64], step: float
) -> npt.NDArray[np.int64]:
    down, along = np.floor((rows + 0.5) / step), np.floor((columns + 0.5) / step)
    off = np.hypot(rows + 0.5 - (down + 0.5) * step, columns + 0.5 - (along + 0.5) * step)
    order = np.lexsort((off, along, down))
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(down[order]) != 0) | (np.diff(along[order]) != 0)
    chosen = order[first]
    return np.column_stack([rows[chosen], columns[chosen]])


def _between(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.asarray(np.abs(np.remainder(second - first + math.pi, TURN) - math.pi))
