"""What was seen: one row per object and sighting, kept by columns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import ValueRangeError

TEXTS = ("place", "scene", "object", "kind", "support", "source")
NUMBERS = ("time", "x", "y", "z", "yaw", "length", "width", "height", "confidence")
NOWHERE = ""
SECONDS_A_DAY = 86_400.0

Row: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, slots=True, eq=False)
class Observations:
    """N sightings by columns; a scene is what was seen together, at one place and time.

    `codes` (N, 6) are the columns TEXTS as numbers of `words`, `numbers` (N, 9) the columns NUMBERS.
    `time` is seconds since 1970 on the local clock; `x`, `y`, `z` [m] is the centre of an object on the ground plane
    and its lowest point, `yaw` the heading of its front [rad], counter-clockwise, nan where it has none, all in the
    frame of the scene; `length` runs along the front, `width` across. `support` names the object of the same scene
    that it stands on or in, "" where that is not known. `confidence` is the detector's, 1 for a person.
    """

    codes: IntArray
    numbers: FloatArray
    words: tuple[str, ...]

    def __post_init__(self) -> None:
        codes = frozen_array("the codes of observations", self.codes, (None, len(TEXTS)), np.int64)
        numbers = np.array(self.numbers, dtype=np.float64)
        numbers.setflags(write=False)
        if numbers.shape != (len(codes), len(NUMBERS)):
            raise ValueRangeError(
                "the shape of the numbers", numbers.shape, f"({len(codes)}, {len(NUMBERS)})"
            )
        if len(codes) and not (codes.min() >= 0 and codes.max() < len(self.words)):
            raise ValueRangeError("a code", int(codes.max()), f"the number of one of {len(self.words)} words")
        object.__setattr__(self, "codes", codes)
        object.__setattr__(self, "numbers", numbers)

    def __len__(self) -> int:
        return len(self.numbers)

    @classmethod
    def of(cls, rows: Iterable[Row]) -> Observations:
        """Return rows, each a mapping with the names of TEXTS and NUMBERS, as columns."""
        codes: dict[str, int] = {NOWHERE: 0}
        texts: list[list[int]] = []
        numbers: list[list[float]] = []
        for row in rows:
            texts.append([codes.setdefault(str(row[name]), len(codes)) for name in TEXTS])
            numbers.append([row[name] for name in NUMBERS])
        coded = np.array(texts, dtype=np.int64).reshape(-1, len(TEXTS))
        return cls(coded, np.array(numbers, dtype=np.float64).reshape(-1, len(NUMBERS)), tuple(codes))

    def code(self, name: str) -> IntArray:
        """Return a column of texts by its name, as numbers of `words`: (N,)."""
        return np.asarray(self.codes[:, TEXTS.index(name)])

    def number(self, name: str) -> FloatArray:
        """Return a column of numbers by its name: (N,)."""
        return np.asarray(self.numbers[:, NUMBERS.index(name)])

    def text(self, name: str) -> list[str]:
        """Return a column of texts by its name."""
        return [self.words[code] for code in self.code(name)]

    @property
    def hours(self) -> FloatArray:
        """The time of day of each sighting: (N,) [h]."""
        return np.asarray(np.mod(self.number("time"), SECONDS_A_DAY) / 3600.0)

    def take(self, chosen: Any) -> Observations:
        """Return some of the rows: by a mask (N,), by numbers, or a slice."""
        return Observations(self.codes[chosen], self.numbers[chosen], self.words)

    def among(self, name: str, wanted: Iterable[str], keep: bool = True) -> Observations:
        """Return the rows whose text `name` is one of those wanted, or, without `keep`, all the others."""
        texts = set(wanted)
        chosen = np.array([word in texts for word in self.words], dtype=np.bool_)[self.code(name)]
        return self.take(chosen == keep)

    def rows(self) -> Iterator[dict[str, str | float]]:
        """Yield the rows as mappings."""
        for codes, values in zip(self.codes.tolist(), self.numbers.tolist(), strict=True):
            texts = {name: self.words[code] for name, code in zip(TEXTS, codes, strict=True)}
            yield texts | dict(zip(NUMBERS, values, strict=True))

    def batches(self, size: int) -> Iterator[Observations]:
        """Yield the rows in order, in parts of about `size` rows that cut no scene in two."""
        edges = np.flatnonzero(np.diff(self.code("scene"), prepend=-1, append=-1))
        cuts = edges[np.searchsorted(edges, np.arange(size, len(self), size))]
        bounds = [0, *cuts.tolist(), len(self)]
        for low, high in pairwise(bounds):
            if high > low:
                yield self.take(slice(low, high))


def joined(parts: Sequence[Observations]) -> Observations:
    """Return the rows of all parts, one part after the other."""
    known: dict[str, int] = {NOWHERE: 0}
    codes, numbers = [np.zeros((0, len(TEXTS)), dtype=np.int64)], [np.zeros((0, len(NUMBERS)))]
    for part in parts:
        renamed = np.array([known.setdefault(word, len(known)) for word in part.words], dtype=np.int64)
        codes.append(renamed[part.codes])
        numbers.append(part.numbers)
    return Observations(np.concatenate(codes), np.concatenate(numbers), tuple(known))
