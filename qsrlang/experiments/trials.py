"""What one trial of one arm came to."""

from __future__ import annotations

from dataclasses import dataclass

from qsrlang.planning.noise import FALSE_ALARM
from qsrlang.planning.outcome import SearchResult

DECIMALS = 6


@dataclass(frozen=True, slots=True, order=True)
class Trial:
    """One trial: found or not, time [s] (the limit where not found), looks, path [m], and the name of the object found.

    Times and lengths are rounded to 1e-6, as they are written, so that a trial read back is the trial itself.
    """

    arm: str
    number: int
    found: bool
    seconds: float
    poses: int
    travel: float
    detected: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "seconds", round(self.seconds, DECIMALS))
        object.__setattr__(self, "travel", round(self.travel, DECIMALS))


def trial_of(arm: str, number: int, result: SearchResult, limit: float) -> Trial:
    """Return the trial that a search was; one that found nothing, or a false alarm, took until the time limit [s]."""
    name = result.detection.name if result.detection is not None else ""
    found = result.found and name != FALSE_ALARM
    seconds = result.seconds if found else limit
    return Trial(arm, number, found, seconds, result.poses, result.travel, name)
