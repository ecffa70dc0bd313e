"""The paper's three ways to choose the next pose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.planning.visibility import view_values

PlannerName = Literal["random", "planes", "qsr"]


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Which candidate was chosen, and the value (N,) of every candidate."""

    index: int
    values: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen_array("the values of the candidates", self.values, (None,)))
        if not 0 <= self.index < len(self.values):
            raise ValueRangeError("the chosen candidate", self.index, f"0 to {len(self.values) - 1}")


class Planner(Protocol):
    """A way to choose the next pose."""

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose one of the candidates (N, 3), x, y [m] and yaw [rad] in the map frame."""


@dataclass(frozen=True, slots=True)
class RandomPlanner:
    """Picks any candidate; all of them are worth the same to it."""

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose one of the candidates (N, 3) with equal chances."""
        return Choice(int(rng.integers(len(candidates_map))), np.ones(len(candidates_map)))


@dataclass(frozen=True, slots=True, eq=False)
class QSRPlanner:
    """Takes the candidate with the greatest value of equation 3, the first of equals (Algorithm 1).

    `voxels_map` (K, 2) are the support voxels [m] and `weights` (K,) what each is worth.
    """

    cone: ViewCone
    voxels_map: FloatArray
    weights: FloatArray

    def __post_init__(self) -> None:
        voxels = frozen_array("the support voxels of a planner", self.voxels_map, (None, 2))
        object.__setattr__(self, "voxels_map", voxels)
        object.__setattr__(self, "weights", frozen_array("their weights", self.weights, (len(voxels),)))

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose argmax over the candidates (N, 3) of sum_i P(v_i) In(v_i, Viewcone(psi))."""
        values = view_values(candidates_map, self.cone, self.voxels_map, self.weights)
        return Choice(int(np.argmax(values)), values)


@dataclass(frozen=True, slots=True, eq=False)
class PlanesPlanner:
    """Takes the candidate with the most support voxels (K, 2) [m] in view: equation 3 with every weight 1."""

    cone: ViewCone
    voxels_map: FloatArray

    def __post_init__(self) -> None:
        voxels = frozen_array("the support voxels of a planner", self.voxels_map, (None, 2))
        object.__setattr__(self, "voxels_map", voxels)

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose argmax over the candidates (N, 3) of sum_i In(v_i, Viewcone(psi))."""
        values = view_values(candidates_map, self.cone, self.voxels_map, np.ones(len(self.voxels_map)))
        return Choice(int(np.argmax(values)), values)


def make_planner(name: PlannerName, cone: ViewCone, voxels_map: FloatArray, weights: FloatArray) -> Planner:
    """Return the planner of this name for support voxels (K, 2) [m] with weights (K,)."""
    match name:
        case "random":
            return RandomPlanner()
        case "planes":
            return PlanesPlanner(cone, voxels_map)
        case "qsr":
            return QSRPlanner(cone, voxels_map, weights)
