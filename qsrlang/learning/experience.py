"""All that was seen, as sums that add up: placements between objects, and the objects themselves."""

from __future__ import annotations

import io
import zipfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from pathlib import Path

import numpy as np

from qsrlang.arrays import FloatArray, IntArray, frozen_array
from qsrlang.errors import FileError
from qsrlang.learning.observations import Observations
from qsrlang.learning.summing import HOURS, MOMENTS, add_rows
from qsrlang.learning.sums import BATCH, PlacementSums, no_sums

OBJECTS = ("count", "length", "width", "height")
MAX_BYTES = 1_000_000_000


@dataclass(frozen=True, slots=True, eq=False)
class ObjectSums:
    """Sums over objects by class, class of the support, and place: `keys` (K, 3), numbers of `words`.

    `totals` (K, 4) are how many were seen and the sums of their lengths, widths and heights [m].
    """

    keys: IntArray
    totals: FloatArray
    words: tuple[str, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "keys", frozen_array("the keys of objects", self.keys, (None, 3), np.int64))
        shape = (len(self.keys), len(OBJECTS))
        object.__setattr__(self, "totals", frozen_array("the sums of objects", self.totals, shape))

    def __add__(self, other: ObjectSums) -> ObjectSums:
        """Return the sums over both."""
        words = tuple(sorted({*self.words, *other.words}))
        keys = np.concatenate([_renumbered(self, words), _renumbered(other, words)])
        return _grouped(keys, np.concatenate([self.totals, other.totals]), words)

    @classmethod
    def of(cls, seen: Observations) -> ObjectSums:
        """Return the sums over observations."""
        names = seen.code("kind"), _support_kinds(seen), seen.code("place")
        sizes = [seen.number(name) for name in OBJECTS[1:]]
        counts = seen.number("confidence")
        totals = np.column_stack([counts, *(counts * size for size in sizes)])
        return _grouped(np.column_stack(names), totals, seen.words)

    def size(self, kind: str) -> FloatArray | None:
        """Return the mean length, width and height (3,) [m] of a class, places weighted equally; None if unseen."""
        rows = [row for row, (name, _, _) in enumerate(self.keys) if self.words[name] == kind]
        by_place: dict[int, FloatArray] = {}
        for row in rows:
            place = int(self.keys[row, 2])
            by_place[place] = by_place.get(place, np.zeros(len(OBJECTS))) + self.totals[row]
        means = [total[1:] / total[0] for total in by_place.values() if total[0] > 0.0]
        return np.asarray(np.mean(means, axis=0)) if means else None


@dataclass(frozen=True, slots=True, eq=False)
class Experience:
    """What learning starts from: sums that say of two logs together what they say of each, added."""

    placements: PlacementSums
    objects: ObjectSums
    sources: Mapping[str, int]

    def __add__(self, other: Experience) -> Experience:
        """Return the experience of both."""
        sources = dict(sorted((Counter(self.sources) + Counter(other.sources)).items()))
        return Experience(self.placements + other.placements, self.objects + other.objects, sources)


def no_experience() -> Experience:
    """Return the experience of nothing."""
    objects = ObjectSums(np.zeros((0, 3), dtype=np.int64), np.zeros((0, len(OBJECTS))), ("",))
    return Experience(no_sums(), objects, {})


def experience_of(seen: Observations) -> Experience:
    """Return the experience of observations, taken in batches, as a robot takes them online."""
    return reduce(Experience.__add__, map(experience_of_batch, seen.batches(BATCH)), no_experience())


def experience_of_batch(seen: Observations) -> Experience:
    """Return the experience of whole scenes that stand together."""
    numbers, counts = np.unique(seen.code("source"), return_counts=True)
    sources = {seen.words[number]: int(count) for number, count in zip(numbers, counts, strict=True)}
    return Experience(PlacementSums.of(seen), ObjectSums.of(seen), sources)


def experience_bytes(experience: Experience) -> bytes:
    """Return an experience as a compressed file of plain arrays."""
    placements, objects = experience.placements, experience.objects
    out = io.BytesIO()
    np.savez_compressed(
        out,
        keys=placements.keys,
        moments=placements.moments,
        hours=placements.hours,
        words=_as_bytes(placements.words),
        object_keys=objects.keys,
        object_totals=objects.totals,
        object_words=_as_bytes(objects.words),
        sources=_as_bytes(tuple(experience.sources)),
        source_counts=np.array(list(experience.sources.values()), dtype=np.int64),
    )
    return out.getvalue()


def read_experience(path: Path) -> Experience:
    """Return an experience from its file; nothing in it is executed. Raises FileError where it is no such file."""
    if path.stat().st_size > MAX_BYTES:
        raise FileError(path, f"is larger than {MAX_BYTES} bytes", "learn from fewer places at a time")
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            keys, moments, hours = file["keys"], file["moments"], file["hours"]
            placements = PlacementSums(
                keys.reshape(-1, 5),
                moments.reshape(-1, len(MOMENTS)),
                hours.reshape(-1, HOURS),
                _as_words(file["words"]),
            )
            objects = ObjectSums(file["object_keys"], file["object_totals"], _as_words(file["object_words"]))
            counts = file["source_counts"].tolist()
            names = _as_words(file["sources"]) if counts else ()
            sources = dict(zip(names, counts, strict=True))
    except (OSError, ValueError, KeyError, EOFError, UnicodeDecodeError, zipfile.BadZipFile) as error:
        raise FileError(path, f"holds no sums ({error})", "learn anew from all observations") from None
    return Experience(placements, objects, sources)


def _as_bytes(words: Sequence[str]) -> IntArray:
    return np.frombuffer("\0".join(words).encode("utf-8"), dtype=np.uint8).astype(np.int64)


def _as_words(coded: IntArray) -> tuple[str, ...]:
    return tuple(bytes(coded.astype(np.uint8)).decode("utf-8").split("\0"))


def _support_kinds(seen: Observations) -> IntArray:
    """Return the class of each object's support, by the first object of its name; nothing where none is known."""
    nothing = seen.words.index("") if "" in seen.words else 0
    kinds = np.full(len(seen.words), nothing, dtype=np.int64)
    kinds[seen.code("object")[::-1]] = seen.code("kind")[::-1]
    supports = seen.code("support")
    return np.where(supports == nothing, nothing, kinds[supports])


def _renumbered(sums: ObjectSums, words: Sequence[str]) -> IntArray:
    numbers = {word: number for number, word in enumerate(words)}
    return np.array([numbers[word] for word in sums.words], dtype=np.int64)[sums.keys]


def _grouped(keys: IntArray, totals: FloatArray, words: tuple[str, ...]) -> ObjectSums:
    size = len(words)
    packed, first, which = np.unique(
        (keys[:, 0] * size + keys[:, 1]) * size + keys[:, 2], return_index=True, return_inverse=True
    )
    summed = np.zeros((len(packed), len(OBJECTS)))
    add_rows(which, totals, summed)
    used, few = np.unique(keys[first], return_inverse=True)
    return ObjectSums(few.reshape(-1, 3), summed, tuple(words[number] for number in used) or ("",))
