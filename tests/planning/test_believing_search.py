"""Searches with a belief in a small room without physics: reports, noise, closed doors, several targets, "not here"."""

from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.paths import DistanceField, path_length, turn_angles
from qsrlang.maps.supports import Supports
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.maps.ways import Ways, lattice
from qsrlang.mixtures.gaussian import GaussianMixture
from qsrlang.planning.atlas import Atlas, Lattice
from qsrlang.planning.belief import Belief
from qsrlang.planning.detecting import Detector
from qsrlang.planning.goals import Goal
from qsrlang.planning.loop import search_world
from qsrlang.planning.noise import FALSE_ALARM, Noise, NoisyWorld
from qsrlang.planning.outcome import Limits
from qsrlang.planning.planners.believing import BeliefPlanner
from qsrlang.planning.planners.planner import Situation
from qsrlang.planning.ranking import DOUBT, rank_views
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.sensing import Camera, Robot
from qsrlang.planning.sight import Sight
from qsrlang.planning.strategies.exact import Exact
from qsrlang.planning.strategies.gain import Gain
from qsrlang.planning.strategies.index import Index
from qsrlang.planning.strategies.rollout import Rollout
from qsrlang.planning.world import Detection, Drive, Look

ROBOT = Robot(clearance=0.2, speed=0.5, turn_rate=1.0, dwell=2.0)
CAMERA = Camera(near=0.2, far=2.0, horizontal_fov=1.0, vertical_fov=1.2, height=1.2, tilt=-0.3)
DETECTOR = Detector(0.9)
SIDE, WALL = 5.0, 2.5
FIRST_DOOR, SECOND_DOOR = (2.2, 2.9), (0.3, 1.0)
CUP = Detection("cup-1", "Cup", (4.4, 4.2, 0.8))
BOWL = Detection("bowl-1", "Bowl", (0.8, 4.4, 0.8))
MOVES = Lattice(spacing=0.5, headings=12, offered=60)


def grid_with(doors):
    cells = np.full((100, 100), Cell.FREE, dtype=np.uint8)
    cells[:, 49:51] = Cell.OCCUPIED
    for low, high in doors:
        cells[round(low * 20) : round(high * 20), 49:51] = Cell.FREE
    return OccupancyGrid(cells, 0.05, Pose2(0.0, 0.0), "two rooms")


def voxels_of(grid):
    solid = np.full((50, 50, 20), Cell.FREE, dtype=np.uint8)
    solid[grid.cells[::2, ::2].T == Cell.OCCUPIED] = Cell.OCCUPIED
    return VoxelGrid(solid, 0.1, np.zeros(3), "two rooms")


PLAN = grid_with([FIRST_DOOR, SECOND_DOOR])
NAVIGATION = NavigationGrid.from_occupancy(PLAN, 0.2)
VOXELS = voxels_of(PLAN)
TABLES = np.array(
    [[x, y, 0.8] for x, y in np.mgrid[0.25:5:0.25, 0.25:5:0.25].reshape(2, -1).T if abs(x - WALL) > 0.3]
)
TABLES[:, :2] += np.random.default_rng(3).uniform(-0.02, 0.02, (len(TABLES), 2))
SIGHT = Sight(CAMERA, 0.0, VOXELS)


@dataclass
class Flat:
    """A world that shows what the robot's own sight says is visible; doors in `closed` stop the robot."""

    things: tuple[Detection, ...] = (CUP,)
    closed: tuple[tuple[float, float], ...] = ()
    pose: Pose2 = field(default_factory=lambda: Pose2(1.0, 1.5))
    looks: int = 0

    @property
    def robot_pose(self):
        return self.pose

    def drive(self, path, yaw):
        path = self.stopped(np.asarray(path))
        travel = path_length(path)
        turn = float(np.abs(turn_angles(path, self.pose.yaw, yaw)).sum())
        self.pose = Pose2(float(path[-1, 0]), float(path[-1, 1]), yaw)
        return Drive(self.pose, travel, turn, travel / ROBOT.speed + turn / ROBOT.turn_rate)

    def stopped(self, path):
        for number, (a, b) in enumerate(pairwise(path)):
            if (a[0] - WALL) * (b[0] - WALL) < 0:
                t = (WALL - a[0]) / (b[0] - a[0])
                y = a[1] + t * (b[1] - a[1])
                if any(low <= y <= high for low, high in self.closed):
                    short = max(0.0, t - 0.3 / np.hypot(*(b - a)))
                    return np.vstack([path[: number + 1], a + short * (b - a)])
        return path

    def look(self, tilt=None):
        self.looks += 1
        here = [[self.pose.x, self.pose.y, self.pose.yaw]]
        seen = [one for one in self.things if SIGHT.visible(here, [one.position])[0, 0]]
        return Look(tuple(seen), ROBOT.dwell)


def weights_about(*places, spread=0.4):
    squares = np.min([((TABLES[:, :2] - np.array(place)) ** 2).sum(axis=1) for place in places], axis=0)
    return np.exp(-0.5 * squares / spread**2)


ATLAS = Atlas.of(NAVIGATION, SIGHT, TABLES, DETECTOR, MOVES)


def goal(target="Cup", *places, absent=0.0, detector=DETECTOR, **options):
    weights = weights_about(*(places or (CUP.position[:2],)))
    belief = Belief.of_weights(TABLES, weights, 0.2, absent)
    return Goal(target, belief, SIGHT, detector, floor=0.2, atlas=ATLAS, **options)


def run(world, goals=None, target="Cup", strategy=None, limits=None, trial=0, navigation=NAVIGATION):
    planner = BeliefPlanner(tuple(goals or [goal()]), ROBOT, strategy or Rollout())
    limits = limits or Limits(300.0, 40, 20)
    return search_world(world, planner, navigation, target, limits, TrialSeeds(5, trial))


def test_ways_are_the_paths_and_turns_that_are_driven():
    places = lattice(NAVIGATION, 1.0)
    ways = Ways.among(NAVIGATION, places)
    rng = np.random.default_rng(1)
    for start, end in rng.integers(len(places), size=(40, 2)).tolist():
        path = DistanceField.from_start(NAVIGATION, places[start]).path_to(places[end])
        first, last = rng.uniform(-3, 3, 2)
        assert ways.lengths[start, end] == pytest.approx(path_length(path), abs=1e-9)
        turn = ways.turning(first, np.array(start), last, np.array(end))
        assert float(turn) == pytest.approx(np.abs(turn_angles(path, first, last)).sum(), abs=1e-9)


def test_a_lattice_has_one_place_a_square_and_at_most_so_many():
    places = lattice(NAVIGATION, 0.5)
    assert NAVIGATION.is_navigable(places).all()
    assert 60 < len(places) < 110
    assert len(lattice(NAVIGATION, 0.05, most=50)) <= 50


def test_an_atlas_shows_what_looks_from_its_poses_show():
    rows = np.random.default_rng(2).integers(len(ATLAS.views), size=40)
    seen = SIGHT.visible(ATLAS.views.poses[rows], TABLES)
    np.testing.assert_array_equal(ATLAS.views.take(rows).table() > 0.0, seen)


@pytest.mark.parametrize("strategy", [Rollout(), Index(), Gain(), Exact()])
def test_the_cup_is_found(strategy):
    result = run(Flat(), strategy=strategy)
    assert result.found and result.detection == CUP and result.ending == "found"
    step = result.steps[-1]
    assert step.terms is not None
    assert step.terms.seconds[step.chosen] == pytest.approx(step.seconds, rel=1e-6)


def test_a_search_for_several_ends_with_the_last():
    goals = [goal("Cup"), goal("Bowl", BOWL.position[:2])]
    result = run(Flat((CUP, BOWL)), goals, ("Cup", "Bowl"))
    assert result.found and set(result.finds) == {CUP, BOWL}
    assert result.target == "Cup, Bowl"
    missing = run(Flat((BOWL,)), goals, ("Cup", "Bowl"), limits=Limits(60.0, 40, 20))
    assert not missing.found and missing.finds == (BOWL,)


def test_an_empty_room_ends_the_search_honestly():
    result = run(Flat(()), [goal(absent=0.2)], limits=Limits(5_000.0, 200, 20, absence=0.9))
    assert (result.found, result.ending) == (False, "absent")
    assert result.absence >= 0.9
    assert result.verdict.startswith("probably not here: 0.9")


def test_a_closed_door_is_planned_around():
    found = 0
    for trial in range(4):
        result = run(Flat(closed=(FIRST_DOOR,)), trial=trial)
        stopped = [s for s in result.steps if np.hypot(*(s.reached.position - s.path[-1])) > 0.05]
        found += bool(stopped)
        assert result.found
    assert found >= 2, "the nearer door was never tried"


def test_behind_closed_doors_a_search_ends_without_a_crash():
    result = run(Flat(closed=(FIRST_DOOR, SECOND_DOOR)), limits=Limits(400.0, 40, 20))
    assert not result.found
    assert result.ending in ("time", "looks", "stuck", "absent")
    assert all(step.reached.x < WALL for step in result.steps)


def test_the_limit_is_kept_while_planning():
    world = Flat()
    result = run(world, limits=Limits(5.0, 40, 20))
    assert (result.found, result.ending, result.seconds) == (False, "time", 5.0)
    assert all(step.clock <= 5.0 for step in result.steps if step.looked)


def test_errors_of_the_camera_are_those_of_view_and_thing():
    noise = Noise(0.5, 0.3)
    told = []
    for _ in range(2):
        answers = []
        for trial in range(60):
            world = Flat(pose=Pose2(3.4, 4.2, 0.0))
            noisy = NoisyWorld(world, noise, TrialSeeds(1, trial), ("Cup",), SIGHT, TABLES)
            first, again = noisy.look(), noisy.look()
            assert first == again, "the same view errs in the same way"
            answers.append([one.name for one in first.detections])
        told.append(answers)
    assert told[0] == told[1]
    seen = sum(CUP.name in names for names in told[0])
    stray = sum(FALSE_ALARM in names for names in told[0])
    assert 15 < seen < 45, "30 of 60 expected, 4 deviations"
    assert 4 < stray < 33, "18 of 60 expected, 4 deviations"


def test_a_wary_robot_looks_again_where_a_trusting_one_takes_a_false_alarm():
    wrong = {}
    for name, assumed in (("trusting", 0.0), ("wary", 0.1)):
        wrong[name] = 0
        for trial in range(12):
            noisy = NoisyWorld(Flat(()), Noise(1.0, 0.3), TrialSeeds(5, trial), ("Cup",), SIGHT, TABLES)
            made = goal(detector=replace(DETECTOR, false_alarms=assumed, confidence=0.99))
            result = run(noisy, [made], limits=Limits(60.0, 40, 20), trial=trial)
            wrong[name] += result.found
    assert wrong["wary"] < wrong["trusting"]


@dataclass
class Told:
    """A recall that puts the target beside a plate."""

    asked: list = field(default_factory=list)

    def weights(self, seen):
        self.asked.append(seen)
        plates = [one.position[:2] for one in seen if one.kind == "Plate"]
        return weights_about(*plates, spread=0.2) if plates else None


def test_what_is_seen_on_the_way_changes_the_belief_at_once():
    plate, told = Detection("plate-1", "Plate", (4.0, 4.0, 0.8)), Told()
    before = goal(recall=told)
    after = before.after_look(Pose2(1.0, 1.0, 3.0), [plate])
    assert after.belief.near((4.0, 4.0), 0.5) > 0.6 > before.belief.near((4.0, 4.0), 0.5)
    again = after.after_look(Pose2(1.0, 1.0, 2.0), [plate])
    assert told.asked == [(plate,)], "nothing new was seen"
    np.testing.assert_allclose(again.belief.prior, after.belief.prior)


def moved_place(motion):
    grid = OccupancyGrid(PLAN.cells, PLAN.resolution, motion @ PLAN.origin, "moved")
    return NavigationGrid.from_occupancy(grid, 0.2)


def decision(move, navigation):
    """The view chosen in the moved room, seen from the room, and its worth; nothing hides anything."""
    empty = VoxelGrid(np.full((2, 2, 2), Cell.FREE, dtype=np.uint8), 0.1, np.full(3, 50.0), "empty")
    sight = Sight(CAMERA, 0.0, empty)
    points = np.column_stack([move.transform(TABLES[:, :2]), TABLES[:, 2]])
    start = move @ Pose2(1.02, 1.53)
    atlas = Atlas.of(navigation, sight, points, DETECTOR, replace(MOVES, spacing=1.2))
    belief = Belief.of_weights(points, weights_about(CUP.position[:2]), 0.2)
    planner = BeliefPlanner((Goal("Cup", belief, sight, DETECTOR, atlas=atlas),), ROBOT, Rollout())
    field = DistanceField.from_start(navigation, (start.x, start.y))
    situation = Situation(navigation.sample_poses(5, np.random.default_rng(0)), start, field, 120.0)
    choice = planner.choose(situation, np.random.default_rng(1))
    return move.inverse() @ Pose2(*choice.candidates[choice.index]), choice.values.max()


@settings(max_examples=4)
@given(st.builds(Pose2, st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)))
def test_decisions_move_with_the_room(motion):
    first, worth = decision(Pose2(0.0, 0.0), NAVIGATION)
    again, also = decision(motion, moved_place(motion))
    assert also == pytest.approx(worth, rel=1e-5)
    assert (again.x, again.y) == pytest.approx((first.x, first.y), abs=1e-6)
    assert np.cos(again.yaw - first.yaw) == pytest.approx(1.0)


def ranking(where=None, **options):
    mixture = GaussianMixture([1.0], [CUP.position[:2]], [0.16 * np.eye(2)])
    supports = Supports(TABLES, np.zeros(len(TABLES), dtype=int), ("support-1",))
    start = Pose2(1.0, 1.5)
    return rank_views(
        where or mixture, supports, VOXELS, NAVIGATION, CAMERA, ROBOT, start, lattice=MOVES, **options
    )


@pytest.mark.parametrize("planner", ["rollout", "index", "belief", "nearest", "tour", "exact"])
def test_views_are_ranked_with_their_terms(planner):
    ranked = ranking(planner=planner, count=4)
    values = [view.value for view in ranked.views]
    assert len(values) == 4 and values == sorted(values, reverse=True)
    for view in ranked.views:
        assert view.seconds == pytest.approx(
            view.travel / ROBOT.speed + view.turn / ROBOT.turn_rate + ROBOT.dwell
        )
        assert view.index == pytest.approx(view.gain / view.seconds)
        assert (view.expected is None) == (planner not in ("rollout", "tour", "exact"))
        assert view.equation_3 > 0.0
    told = ranked.to_json()
    assert len(told["views"]) == 4 and told["views"][0]["pose"]["x"] == ranked.views[0].pose.x
    assert str(ranked).count("\n") == 5


def test_a_belief_ranks_like_the_mixture_it_was_made_of():
    mixture = GaussianMixture([1.0], [CUP.position[:2]], [0.16 * np.eye(2)])
    aims = TABLES + np.array([0.0, 0.0, 0.05])
    belief = Belief.of_weights(aims, DOUBT.prior(mixture, aims[:, :2]))
    assert [v.pose for v in ranking(belief).views] == [v.pose for v in ranking(mixture).views]


def test_rankings_refuse_what_makes_no_sense():
    with pytest.raises(UnknownNameError, match="planner with a belief"):
        ranking(planner="rolout")
    with pytest.raises(ValueRangeError, match="number of views"):
        ranking(count=0)
    with pytest.raises(ValueRangeError, match="number of goals"):
        BeliefPlanner((), ROBOT, Index())
    for bad in ({"spacing": 0.0}, {"headings": 0}, {"offered": 0}, {"tilts": (2.0,)}):
        with pytest.raises(ValueRangeError):
            Lattice(**bad)
