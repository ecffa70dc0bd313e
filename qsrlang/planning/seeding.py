"""Common random numbers: what is random in a search depends on seed, trial and step, and on nothing else."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.errors import ValueRangeError

_CANDIDATES, _PICK, _ERRORS = 0, 1, 2


@dataclass(frozen=True, slots=True)
class TrialSeeds:
    """The random streams of one trial: all arms of a comparison draw the same candidate poses from them."""

    seed: int
    trial: int = 0

    def __post_init__(self) -> None:
        for what, value in (("seed", self.seed), ("trial", self.trial)):
            if value < 0:
                raise ValueRangeError(f"the {what}", value, "a whole number of at least 0")

    def candidates(self, step: int) -> np.random.Generator:
        """Return the stream of the candidate poses of a step."""
        return self._stream(step, _CANDIDATES)

    def pick(self, step: int) -> np.random.Generator:
        """Return the stream of a planner's own draws at a step."""
        return self._stream(step, _PICK)

    def errors(self, thing: int, view: tuple[int, ...]) -> np.random.Generator:
        """Return the stream of what a camera gets wrong of a thing in a view, both given as whole numbers."""
        key = (self.trial, _ERRORS, thing, *view)
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=key))

    def _stream(self, step: int, purpose: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(self.trial, step, purpose)))
