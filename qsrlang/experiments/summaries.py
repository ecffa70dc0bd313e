"""What the trials of an arm come to, with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from qsrlang.experiments.recording import Experiment
from qsrlang.experiments.statistics import Interval, bootstrap_interval, paired_interval, wilson_interval
from qsrlang.experiments.trials import Trial


@dataclass(frozen=True, slots=True)
class ArmSummary:
    """The figures of one arm; intervals hold with 95 %.

    `found` is the share of trials that found the target (Wilson). `time_found` [s] and `poses` are means over the
    trials that found it, as in the paper's tables, None where none did; `time_censored` [s] is the mean over all
    trials, a failure counting as the time limit, and `time_ci` its interval; `travel` [m] is a mean over all.
    """

    found: float
    found_ci: Interval
    time_found: float | None
    time_censored: float
    time_ci: Interval
    poses: float | None
    poses_ci: Interval | None
    travel: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """The finished trials of a comparison, in the order of arms and trial numbers."""

    experiment: Experiment
    arms: tuple[str, ...]
    trials: int
    results: tuple[Trial, ...]

    def of(self, arm: str) -> tuple[Trial, ...]:
        """Return the trials of one arm."""
        return tuple(trial for trial in self.results if trial.arm == arm)

    @property
    def summaries(self) -> Mapping[str, ArmSummary]:
        """The figures of every arm."""
        return {arm: summarise(self.of(arm), self.experiment.seed) for arm in self.arms}

    @property
    def differences(self) -> Mapping[tuple[str, str], tuple[float, Interval]]:
        """For every two arms, the mean of the paired differences of their times [s], with its interval."""
        return {
            (first, second): _difference(self.of(first), self.of(second), self.experiment.seed)
            for first, second in combinations(self.arms, 2)
        }


def summarise(trials: Sequence[Trial], seed: int) -> ArmSummary:
    """Return the figures of at least one trial; the seed draws the bootstrap."""
    times = [trial.seconds for trial in trials]
    hits = [trial for trial in trials if trial.found]
    poses = [trial.poses for trial in hits]
    return ArmSummary(
        found=len(hits) / len(trials),
        found_ci=wilson_interval(len(hits), len(trials)),
        time_found=_mean([trial.seconds for trial in hits]) if hits else None,
        time_censored=_mean(times),
        time_ci=bootstrap_interval(times, seed),
        poses=_mean(poses) if hits else None,
        poses_ci=bootstrap_interval(poses, seed) if hits else None,
        travel=_mean([trial.travel for trial in trials]),
    )


def _difference(first: Sequence[Trial], second: Sequence[Trial], seed: int) -> tuple[float, Interval]:
    one, other = ([trial.seconds for trial in trials] for trials in (first, second))
    return _mean(one) - _mean(other), paired_interval(one, other, seed)


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
