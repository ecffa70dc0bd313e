"""The manner in which a question is answered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.draws.conditioning import Drawing
from qsrlang.mixtures.inference import Bounds, Placed, place_by_sampling, place_exactly
from qsrlang.relations.graph import RelationGraph

ENGINES = ("exact", "sampling")


@dataclass(frozen=True, slots=True)
class Manner:
    """How a question is answered: by which engine, from how many draws of which generator, as seen by whom."""

    engine: str
    samples: int
    rng: np.random.Generator | None
    viewer: Pose2 | None
    bounds: Bounds

    def __post_init__(self) -> None:
        if self.engine not in ENGINES:
            raise UnknownNameError("engine", self.engine, ENGINES)
        if self.samples < 2:
            raise ValueRangeError("the number of samples", self.samples, "at least 2")
        if self.engine == "sampling" and self.rng is None:
            raise ValueRangeError("the sampling engine's rng", None, "a generator")
        for what, bound in (("components", self.bounds.components), ("worlds", self.bounds.worlds)):
            if bound < 1:
                raise ValueRangeError(f"the greatest number of {what}", bound, "at least 1")

    def drawing(self) -> Drawing:
        """Return how scenes are drawn."""
        return Drawing(self.samples, self.rng or np.random.default_rng(0), self.viewer)

    def place(self, graph: RelationGraph, target: str) -> Placed:
        """Return where a target is when nothing is assumed."""
        if self.engine == "sampling" and self.rng is not None:
            return place_by_sampling(graph, target, self.viewer, self.samples, self.rng)
        return place_exactly(graph, target, self.viewer, self.bounds)
