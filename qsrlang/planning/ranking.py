"""The best views, ranked, with the terms of why."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from qsrlang.arrays import FloatArray
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Triangle
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.paths import DistanceField
from qsrlang.maps.supports import Supports
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.atlas import Atlas, Lattice
from qsrlang.planning.belief import Belief, voxel_weights
from qsrlang.planning.detecting import Detector
from qsrlang.planning.doubt import Doubt
from qsrlang.planning.frusta import POINT, Extent
from qsrlang.planning.goals import Goal
from qsrlang.planning.planners.believing import BeliefPlanner
from qsrlang.planning.planners.planner import Situation, Terms
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.planning.sight import Sight
from qsrlang.planning.strategies.named import strategy_named
from qsrlang.planning.visibility import view_values

DETECTOR = Detector()
LATTICE = Lattice(spacing=0.5, headings=24, offered=200)
PAPER_CONE = Triangle(3.0, 1.0)
PAPER_FLOOR, PAPER_GAIN = 1.0, 10.0
DOUBT = Doubt(floor=0.3, loose=0.5, stretch=3.0)
MAX_RANKED = 1_000


@dataclass(frozen=True, slots=True)
class RankedView:
    """A view and why it is where it is in the ranking.

    `value` is what the planner goes by; `gain` p(v) the chance that one look finds the target; `travel` [m], `turn`
    [rad] and `seconds` c(v) what it costs, the look included; `index` p(v) / c(v); `expected` the seconds that the
    best plan starting there takes, None where the planner looks no further; `equation_3` the sum of equation 3.
    """

    pose: Pose2
    value: float
    gain: float
    travel: float
    turn: float
    seconds: float
    index: float
    expected: float | None
    equation_3: float | None


@dataclass(frozen=True, slots=True)
class RankedViews:
    """The best views for a target, the best first, from where the robot stands; `unit` is that of their values."""

    target: str
    planner: str
    unit: str
    absence: float
    views: tuple[RankedView, ...]

    def to_json(self) -> dict[str, object]:
        """Return the ranking as plain data: metres, radians, seconds, map frame."""
        views = [asdict(view) for view in self.views]
        return {
            "target": self.target,
            "planner": self.planner,
            "unit": self.unit,
            "absence": self.absence,
            "views": views,
        }

    def __str__(self) -> str:
        head = f"views of {self.target}, planner {self.planner}, value in {self.unit}; not here: {self.absence:.3f}"
        rows = [
            f"{'value':>8} {'x [m]':>7} {'y [m]':>7} {'yaw [deg]':>9} {'p':>6} {'c [s]':>6} {'p/c':>7} "
            f"{'plan [s]':>8} {'eq. 3':>7}"
        ]
        rows += [_row(view) for view in self.views]
        return "\n".join([head, *rows])


def rank_views(
    where: Where | GaussianMixture | Belief,
    supports: Supports,
    voxels: VoxelGrid,
    navigation: NavigationGrid,
    camera: Camera,
    robot: Robot,
    pose: Pose2,
    *,
    target: str = "target",
    planner: str = "rollout",
    count: int = 5,
    floor_height: float = 0.0,
    extent: Extent = POINT,
    detector: Detector = DETECTOR,
    doubt: Doubt = DOUBT,
    absent: float = 0.0,
    lattice: Lattice = LATTICE,
    seconds: float = 120.0,
    rng: np.random.Generator | None = None,
) -> RankedViews:
    """Return the `count` best views for a robot at `pose`, with gain, cost and the value of equation 3.

    `where` is an answer or a mixture in the map frame, whose density at the `supports` makes the prior, trusted
    but for the `doubt`; or a belief, as it is after some looks. Views come from a lattice of the navigable
    cells that the robot reaches; `voxels` hide what is behind them; `floor_height` is the z of the floor [m]; the
    target reaches as far as `extent` from its centre; `seconds` are left. `rng` draws which places are offered.
    Raises ValueRangeError, UnknownNameError, and BlockedPoseError where the robot cannot stand at its pose.
    """
    if not 1 <= count <= MAX_RANKED:
        raise ValueRangeError("the number of views", count, f"1 to {MAX_RANKED}")
    strategy, draws = strategy_named(planner), rng or np.random.default_rng(0)
    belief = _belief(where, supports, voxels.resolution, extent, doubt, absent)
    sight = Sight(camera, floor_height, voxels, extent)
    reachable = navigation.reachable_from(pose)
    atlas = Atlas.of(reachable, sight, belief.points_map, detector, lattice)
    goal = Goal(_name(where, target), belief, sight, detector, atlas=atlas)
    field = DistanceField.from_start(reachable, (pose.x, pose.y))
    situation = Situation(reachable.sample_poses(count, draws), pose, field, seconds)
    choice = BeliefPlanner((goal,), robot, strategy).choose(situation, draws)
    best = np.argsort(-choice.values, kind="stable")[:count]
    assert choice.terms is not None
    sums = view_values(
        choice.candidates[best], PAPER_CONE, belief.points_map[:, :2], _paper_weights(where, belief)
    )
    views = ranked(choice.candidates, choice.values, choice.terms, best.tolist(), sums)
    return RankedViews(goal.target, planner, choice.unit, belief.absence, views)


def ranked(
    candidates: FloatArray,
    values: FloatArray,
    terms: Terms,
    order: Sequence[int],
    equation_3: FloatArray | None = None,
) -> tuple[RankedView, ...]:
    """Return some of the candidates (N, 3) as ranked views, in an order; `equation_3` is in that order."""
    return tuple(
        RankedView(
            pose=Pose2(*(float(part) for part in candidates[view])),
            value=float(values[view]),
            gain=float(terms.gains[view]),
            travel=float(terms.travel[view]),
            turn=float(terms.turn[view]),
            seconds=float(terms.seconds[view]),
            index=float(terms.gains[view] / terms.seconds[view]),
            expected=None if math.isnan(terms.expected[view]) else float(terms.expected[view]),
            equation_3=None if equation_3 is None else float(equation_3[place]),
        )
        for place, view in enumerate(order)
    )


def _belief(
    where: Where | GaussianMixture | Belief,
    supports: Supports,
    resolution: float,
    extent: Extent,
    doubt: Doubt,
    absent: float,
) -> Belief:
    if isinstance(where, Belief):
        return where
    aims = supports.centres + np.array([0.0, 0.0, 0.5 * resolution + extent.half_height])
    mixture = where if isinstance(where, GaussianMixture) else where.mixture
    claimed = 1.0 if isinstance(where, GaussianMixture) else 1.0 - where.elsewhere
    return Belief.of_weights(aims, doubt.prior(mixture, aims[:, :2], claimed), absent=absent)


def _paper_weights(where: Where | GaussianMixture | Belief, belief: Belief) -> FloatArray:
    if isinstance(where, Belief):
        return belief.probabilities
    mixture = where if isinstance(where, GaussianMixture) else where.mixture
    claimed = 1.0 if isinstance(where, GaussianMixture) else 1.0 - where.elsewhere
    return voxel_weights(mixture, belief.points_map[:, :2], PAPER_FLOOR, PAPER_GAIN, claimed)


def _name(where: Where | GaussianMixture | Belief, target: str) -> str:
    return where.target if isinstance(where, Where) else target


def _row(view: RankedView) -> str:
    plan = "-" if view.expected is None else f"{view.expected:.1f}"
    sums = "-" if view.equation_3 is None else f"{view.equation_3:.1f}"
    return (
        f"{view.value:8.3f} {view.pose.x:7.2f} {view.pose.y:7.2f} {math.degrees(view.pose.yaw):9.0f} "
        f"{view.gain:6.3f} {view.seconds:6.1f} {view.index:7.4f} {plan:>8} {sums:>7}"
    )
