"""Views: what a look from each of many poses would show, place by place, and how surely."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import njit

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError

IndexArray: TypeAlias = npt.NDArray[np.int32]
RateArray: TypeAlias = npt.NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Views:
    """N views of K places. `poses` (N, 3) are x, y [m] and yaw [rad] in the map frame, `tilts` (N,) [rad].

    View n shows the places `shown[starts[n] : starts[n + 1]]` with probabilities `rates` of the same positions:
    d_n(x) = rate x visible(x, n), and 0 elsewhere. `starts` is (N + 1,), `shown` and `rates` are (E,).
    """

    poses: FloatArray
    tilts: FloatArray
    starts: IntArray
    shown: IndexArray
    rates: RateArray
    places: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "poses", frozen_array("the poses of views", self.poses, (None, 3)))
        object.__setattr__(self, "tilts", frozen_array("their tilts", self.tilts, (len(self.poses),)))
        starts = frozen_array("the starts of views", self.starts, (len(self.poses) + 1,), np.int64)
        shown = frozen_array("what views show", self.shown, (None,), np.int32)
        rates = frozen_array("their rates", self.rates, (len(shown),), np.float32)
        for name, value in (("starts", starts), ("shown", shown), ("rates", rates)):
            object.__setattr__(self, name, value)
        if starts[0] != 0 or starts[-1] != len(shown) or (np.diff(starts) < 0).any():
            raise ValueRangeError("the starts of views", starts.tolist()[:5], "rising from 0 to their sum")
        if len(shown) and not (shown.min() >= 0 and shown.max() < self.places):
            raise ValueRangeError("a place in view", int(shown.max()), f"0 to {self.places - 1}")
        if len(rates) and not (rates.min() >= 0.0 and rates.max() <= 1.0):
            raise ValueRangeError("the detection rate", float(rates.max()), "0 to 1")

    @classmethod
    def of_rates(cls, poses: npt.ArrayLike, rates: npt.ArrayLike) -> Views:
        """Return the views with the detection rates (N, K)."""
        table = np.asarray(rates, dtype=np.float64)
        rows, shown = np.nonzero(table)
        starts = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=len(table)))])
        poses = np.asarray(poses, dtype=np.float64)
        rates_of = table[rows, shown].astype(np.float32)
        return cls(poses, np.zeros(len(poses)), starts, shown.astype(np.int32), rates_of, table.shape[1])

    def __len__(self) -> int:
        return len(self.poses)

    def values(self, mass: npt.ArrayLike) -> FloatArray:
        """Return sum_x mass(x) d_n(x) of every view n: (N,); `mass` is (K,)."""
        values = np.empty(len(self))
        _sum_rows(self.starts, self.shown, self.rates, np.asarray(mass, dtype=np.float64), values)
        return values

    def row(self, view: int) -> FloatArray:
        """Return d_n(x) of one view for all places: (K,)."""
        part = slice(self.starts[view], self.starts[view + 1])
        row = np.zeros(self.places)
        row[self.shown[part]] = self.rates[part]
        return row

    def table(self) -> FloatArray:
        """Return d_n(x) of all views: (N, K)."""
        return np.array([self.row(view) for view in range(len(self))]).reshape(len(self), self.places)

    def take(self, views: npt.ArrayLike) -> Views:
        """Return some of the views, in the order given."""
        chosen = np.asarray(views, dtype=np.int64)
        counts = np.diff(self.starts)[chosen]
        starts = np.concatenate([[0], np.cumsum(counts)])
        entries = np.repeat(self.starts[chosen] - starts[:-1], counts) + np.arange(starts[-1])
        return Views(
            self.poses[chosen],
            self.tilts[chosen],
            starts,
            self.shown[entries],
            self.rates[entries],
            self.places,
        )

    def with_rates(self, rates: npt.ArrayLike) -> Views:
        """Return the same views with other rates (E,)."""
        return Views(
            self.poses, self.tilts, self.starts, self.shown, np.asarray(rates, dtype=np.float32), self.places
        )


def beside(parts: list[Views]) -> Views:
    """Return views of the same poses as one, the places of each part after those of the parts before it."""
    if len(parts) == 1:
        return parts[0]
    offsets = np.cumsum([0, *(part.places for part in parts)])
    view_of = np.concatenate([np.repeat(np.arange(len(part)), np.diff(part.starts)) for part in parts])
    order = np.argsort(view_of, kind="stable")
    shown = np.concatenate([part.shown + offset for part, offset in zip(parts, offsets[:-1], strict=True)])
    rates = np.concatenate([part.rates for part in parts])
    starts = np.sum([part.starts for part in parts], axis=0)
    first = parts[0]
    return Views(first.poses, first.tilts, starts, shown[order], rates[order], int(offsets[-1]))


@njit(cache=True)
def _sum_rows(starts, shown, rates, mass, values):  # type: ignore[no-untyped-def]
    for n in range(len(values)):
        total = 0.0
        for entry in range(starts[n], starts[n + 1]):
            total += mass[shown[entry]] * rates[entry]
        values[n] = total
