"""How long calls take, for all benchmarks: several measurements of one thing, the first call not counted."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Spread:
    """Several measurements of one thing: median, least, greatest."""

    median: float
    least: float
    greatest: float

    @classmethod
    def of(cls, values: Iterable[float]) -> Spread:
        """Return the spread of some values."""
        values = list(values)
        return cls(statistics.median(values), min(values), max(values))

    def text(self, scale: float, unit: str) -> str:
        """Return the median with least and greatest, in a unit of which a value has `scale`."""
        low, middle, high = (f"{scale * one:,.4g}" for one in (self.least, self.median, self.greatest))
        return f"{middle} {unit} ({low} to {high})"


def spread_of(work: Callable[[], object], repeats: int = 5) -> Spread:
    """Return the times of some calls [s], after one that is not counted."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return Spread.of(times)


def best_of(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the least of several times [s]: what the work takes where nothing else does."""
    return spread_of(work, repeats).least


def middle_of(work: Callable[[], object], repeats: int = 7) -> float:
    """Return the median of several times [s]."""
    return spread_of(work, repeats).median
