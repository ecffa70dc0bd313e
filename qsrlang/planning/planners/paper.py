"""The three planners of the paper: random poses, supporting planes, qualitative relations (Algorithm 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.planning.planners.planner import Choice, Forgetful, Situation
from qsrlang.planning.visibility import view_values


@dataclass(frozen=True, slots=True)
class RandomPlanner(Forgetful):
    """Picks any candidate; all of them are worth the same to it."""

    def choose(self, situation: Situation, rng: np.random.Generator) -> Choice:
        """Choose one of the candidates (N, 3) that were drawn with equal chances."""
        count = len(situation.drawn)
        return Choice(situation.drawn, int(rng.integers(count)), np.ones(count), "")


@dataclass(frozen=True, slots=True, eq=False)
class QSRPlanner(Forgetful):
    """Takes the candidate with the greatest value of equation 3, the first of equals (Algorithm 1).

    `voxels_map` (K, 2) are the support voxels [m] and `weights` (K,) what each is worth. With every weight 1 it is
    the paper's method of supporting planes.
    """

    cone: ViewCone
    voxels_map: FloatArray
    weights: FloatArray

    def __post_init__(self) -> None:
        voxels = frozen_array("the support voxels of a planner", self.voxels_map, (None, 2))
        object.__setattr__(self, "voxels_map", voxels)
        object.__setattr__(self, "weights", frozen_array("their weights", self.weights, (len(voxels),)))

    @classmethod
    def of_planes(cls, cone: ViewCone, voxels_map: FloatArray) -> QSRPlanner:
        """Return the planner that takes the candidate with the most support voxels (K, 2) [m] in view."""
        return cls(cone, voxels_map, np.ones(len(voxels_map)))

    def choose(self, situation: Situation, rng: np.random.Generator) -> Choice:
        """Choose argmax over the candidates (N, 3) that were drawn of sum_i P(v_i) In(v_i, Viewcone(psi))."""
        values = view_values(situation.drawn, self.cone, self.voxels_map, self.weights)
        return Choice(situation.drawn, int(np.argmax(values)), values, "by equation 3")
