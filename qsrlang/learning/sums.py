"""Sums that say all that is learned from: moments of placements by pair, place and cell, and counts by the hour.

They add up: those of two logs together are the sum of each one's, in any order, so learning online, in batches, or
from a file and new data are the same. They grow with what differs (pairs, places, cells), not with what is seen.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from qsrlang.arrays import BoolArray, FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.learning.observations import Observations
from qsrlang.learning.placements import placements_of

# The side of a cell [m]; within one, placements are told apart by their moments alone.
CELL = 0.15
HOURS = 24
BATCH = 20_000
KEYS = ("referent", "relatum", "place", "column", "row")
MOMENTS = ("x", "y", "xx", "xy", "yy", "low x", "low y", "high x", "high y", "cos", "sin")
_BITS = (12, 12, 20, 8, 8)
_MIDDLE = 128


@dataclass(frozen=True, slots=True, eq=False)
class PlacementSums:
    """Sums over the placements in K cells.

    `keys` (K, 5) are referent, relatum and place (numbers of `words`) and the cell's column and row; `moments`
    (K, 11) are sums of x, y, xx, xy, yy about the cell's middle [m, m^2], of the bounds of the support about the
    relatum [m], and of the cosine and sine of the relatum's turn; `hours` (K, 24) are counts by the hour of the day.
    """

    keys: IntArray
    moments: FloatArray
    hours: FloatArray
    words: tuple[str, ...]

    def __post_init__(self) -> None:
        size = len(self.keys)
        keys = frozen_array("the keys of sums", np.reshape(self.keys, (-1, 5)), (None, 5), np.int64)
        object.__setattr__(self, "keys", keys)
        moments = np.reshape(self.moments, (-1, len(MOMENTS)))
        object.__setattr__(
            self, "moments", frozen_array("the moments of sums", moments, (size, len(MOMENTS)))
        )
        hours = np.reshape(self.hours, (-1, HOURS))
        object.__setattr__(self, "hours", frozen_array("the hours of sums", hours, (size, HOURS)))

    def __len__(self) -> int:
        return len(self.keys)

    def __add__(self, other: PlacementSums) -> PlacementSums:
        """Return the sums over both."""
        return added((self, other))

    @classmethod
    def of(cls, seen: Observations) -> PlacementSums:
        """Return the sums over observations whose scenes are whole and stand together."""
        placed = placements_of(seen)
        cells = np.floor(placed.points / CELL + 0.5).astype(np.int64)
        names = (
            seen.code("kind")[placed.referents],
            seen.code("kind")[placed.relata],
            seen.code("place")[placed.referents],
        )
        off = placed.points - CELL * cells
        x, y = off.T
        turned = np.column_stack([np.cos(placed.turns), np.sin(placed.turns)])
        moments = np.column_stack([x, y, x * x, x * y, y * y, placed.low, placed.high, turned])
        hours = seen.hours[placed.referents].astype(np.int64)
        keys = np.column_stack([*names, cells])
        return _summed(keys, moments, hours, seen.number("confidence")[placed.referents], seen.words)

    @property
    def counts(self) -> FloatArray:
        """How much was seen in each cell: (K,)."""
        return np.asarray(self.hours.sum(axis=1))

    def take(self, chosen: BoolArray | IntArray) -> PlacementSums:
        """Return some of the cells."""
        return PlacementSums(self.keys[chosen], self.moments[chosen], self.hours[chosen], self.words)

    def pairs(self) -> list[tuple[str, str]]:
        """Return the pairs (referent, relatum) of classes that something is known of, by name."""
        distinct = np.unique(self.keys[:, :2], axis=0)
        return sorted((self.words[referent], self.words[relatum]) for referent, relatum in distinct)

    def of_pair(self, referent: str, relatum: str) -> PlacementSums:
        """Return the cells of one pair."""
        numbers = {word: number for number, word in enumerate(self.words)}
        wanted = np.array([numbers.get(referent, -1), numbers.get(relatum, -1)])
        return self.take((self.keys[:, :2] == wanted).all(axis=1))

    def places(self) -> list[str]:
        """Return the places that something is known of, by name."""
        return sorted(self.words[number] for number in np.unique(self.keys[:, 2]))

    def at(self, places: Iterable[str], keep: bool = True) -> PlacementSums:
        """Return what was seen at some places or, without `keep`, at all others."""
        wanted = set(places)
        chosen = np.array([word in wanted for word in self.words], dtype=np.bool_)[self.keys[:, 2]]
        return self.take(chosen == keep)


def no_sums() -> PlacementSums:
    """Return the sums over nothing."""
    return PlacementSums(
        np.zeros((0, 5), dtype=np.int64), np.zeros((0, len(MOMENTS))), np.zeros((0, HOURS)), ("",)
    )


def sums_of(seen: Observations) -> PlacementSums:
    """Return the sums over observations, taken in batches, as a robot would online."""
    return reduce(PlacementSums.__add__, map(PlacementSums.of, seen.batches(BATCH)), no_sums())


def added(parts: Sequence[PlacementSums]) -> PlacementSums:
    """Return the sums over all parts, cells in the order of their names."""
    words = tuple(sorted({part.words[one] for part in parts for one in np.unique(part.keys[:, :3])} | {""}))
    numbers = {word: number for number, word in enumerate(words)}
    keys = np.concatenate([_renamed(part, numbers) for part in parts])
    packed, first, which = np.unique(_packed(keys), return_index=True, return_inverse=True)
    moments, hours = np.zeros((len(packed), len(MOMENTS))), np.zeros((len(packed), HOURS))
    np.add.at(moments, which, np.concatenate([part.moments for part in parts]))
    np.add.at(hours, which, np.concatenate([part.hours for part in parts]))
    return PlacementSums(keys[first], moments, hours, words)


def _renamed(part: PlacementSums, numbers: dict[str, int]) -> IntArray:
    renamed = np.array([numbers.get(word, 0) for word in part.words], dtype=np.int64)
    return np.concatenate([renamed[part.keys[:, :3]], part.keys[:, 3:]], axis=1)


def _packed(keys: IntArray) -> IntArray:
    """Return each key as one number; raises ValueRangeError where there are too many names."""
    shifted = keys + np.array([0, 0, 0, _MIDDLE, _MIDDLE])
    packed = np.zeros(len(keys), dtype=np.int64)
    for column, bits in zip(shifted.T, _BITS, strict=True):
        if len(column) and column.max() >= 1 << bits:
            raise ValueRangeError(
                "the number of different names", int(column.max()), f"fewer than {1 << bits}"
            )
        packed = packed << bits | column
    return packed


def _summed(
    keys: IntArray, moments: FloatArray, hours: IntArray, shares: FloatArray, words: tuple[str, ...]
) -> PlacementSums:
    """Return the sums by distinct key; each placement counts by the share its detector gave it."""
    named = _few_names(keys, words)
    packed, first, which = np.unique(_packed(named[0]), return_index=True, return_inverse=True)
    weighed = moments * shares[:, None]
    summed = np.empty((len(packed), len(MOMENTS)))
    for number, column in enumerate(weighed.T):
        summed[:, number] = np.bincount(which, weights=column, minlength=len(packed))
    counted = np.zeros(HOURS * len(packed))
    counted += np.bincount(which * HOURS + hours, weights=shares, minlength=len(counted))
    return PlacementSums(named[0][first], summed, counted.reshape(-1, HOURS), named[1])


def _few_names(keys: IntArray, words: tuple[str, ...]) -> tuple[IntArray, tuple[str, ...]]:
    """Return keys that number only the words they use, and those words."""
    used, which = np.unique(keys[:, :3], return_inverse=True)
    return np.concatenate([which.reshape(-1, 3), keys[:, 3:]], axis=1), tuple(words[one] for one in used)
