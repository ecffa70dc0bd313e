"""Ways to choose the next pose: the paper's three, and one that sees in three dimensions and remembers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, Protocol, Self

import numpy as np

from qsrlang.arrays import FloatArray, frozen_array
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import ViewCone
from qsrlang.planning.sight import Sight
from qsrlang.planning.visibility import view_values

PlannerName = Literal["random", "planes", "qsr", "belief"]


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

    def after_miss(self, pose: Pose2) -> Planner:
        """Return the planner for the next step, now that a look from `pose` did not show the target."""


class Forgetful:
    """A planner that an empty view teaches nothing, as in the paper."""

    __slots__ = ()

    def after_miss(self, pose: Pose2) -> Self:
        """Return the planner itself."""
        return self


@dataclass(frozen=True, slots=True)
class RandomPlanner(Forgetful):
    """Picks any candidate; all of them are worth the same to it."""

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose one of the candidates (N, 3) with equal chances."""
        return Choice(int(rng.integers(len(candidates_map))), np.ones(len(candidates_map)))


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

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose argmax over the candidates (N, 3) of sum_i P(v_i) In(v_i, Viewcone(psi))."""
        values = view_values(candidates_map, self.cone, self.voxels_map, self.weights)
        return Choice(int(np.argmax(values)), values)


@dataclass(frozen=True, slots=True, eq=False)
class BeliefPlanner:
    """Takes the candidate whose look is the likeliest to show the target, and lowers what an empty look disproved.

    Equation 3 with d visible(x, psi) in place of In: frustum, height and occlusion by the robot's own voxel map.
    After a miss b'(x) ~ b(x) (1 - d visible(x, psi)), so overlapping views are not counted twice. `points_map` (K, 3)
    are the places where the target's centre would be [m], `belief` (K,) of any scale, d the detection rate.
    """

    sight: Sight
    points_map: FloatArray
    belief: FloatArray
    detection_rate: float

    def __post_init__(self) -> None:
        points = frozen_array("the places of a belief", self.points_map, (None, 3))
        object.__setattr__(self, "points_map", points)
        object.__setattr__(self, "belief", frozen_array("a belief", self.belief, (len(points),)))
        if not 0.0 < self.detection_rate <= 1.0:
            raise ValueRangeError("the detection rate", self.detection_rate, "above 0 and at most 1")

    def choose(self, candidates_map: FloatArray, robot_pose: Pose2, rng: np.random.Generator) -> Choice:
        """Choose argmax over the candidates (N, 3) of sum_x b(x) d visible(x, psi)."""
        values = self.sight.visible(candidates_map, self.points_map) @ (self.detection_rate * self.belief)
        return Choice(int(np.argmax(values)), values)

    def after_miss(self, pose: Pose2) -> BeliefPlanner:
        """Return the planner with the belief after an empty look."""
        (seen,) = self.sight.visible([[pose.x, pose.y, pose.yaw]], self.points_map)
        return replace(self, belief=self.belief * (1.0 - self.detection_rate * seen))
