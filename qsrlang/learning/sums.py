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
from qsrlang.learning.summing import HOURS, MOMENTS, add_rows, summed_scenes

BATCH = 50_000
KEYS = ("referent", "relatum", "place", "column", "row")
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
        kinds, words = _few(seen.code("kind"), seen.words, 0)
        places, place_words = _few(seen.code("place"), seen.words, len(words))
        words = words + place_words
        if len(words) >= 1 << _BITS[0]:
            raise ValueRangeError("the number of names in a batch", len(words), f"fewer than {1 << _BITS[0]}")
        keys, moments, hours = summed_scenes(seen, kinds, places)
        return added((cls(keys, moments, hours, words),))

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
    add_rows(which, np.concatenate([part.moments for part in parts]), moments)
    add_rows(which, np.concatenate([part.hours for part in parts]), hours)
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


def _few(codes: IntArray, words: Sequence[str], start: int) -> tuple[IntArray, tuple[str, ...]]:
    """Return codes that number, from `start`, only the words they use, and those words."""
    used, which = np.unique(codes, return_inverse=True)
    return which + start, tuple(words[one] for one in used)
