from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Triangle
from qsrlang.maps.navigation import NavigationGrid
from qsrlang.maps.occupancy import Cell, OccupancyGrid
from qsrlang.maps.paths import path_length, turn_angles
from qsrlang.planning.loop import search_world
from qsrlang.planning.outcome import Limits, SearchResult
from qsrlang.planning.planners.paper import QSRPlanner, RandomPlanner
from qsrlang.planning.seeding import TrialSeeds
from qsrlang.planning.visibility import in_view
from qsrlang.planning.world import Detection, Drive, Look

CUP = Detection("cup-1", "Cup", (4.0, 4.0, 0.8))
MUG = Detection("mug-1", "Mug", (0.6, 0.6, 0.8))
CONE = Triangle(3.0, 1.0)
GENEROUS = Limits(10_000.0, 200, 20)


@dataclass
class PaperWorld:
    """A world without physics: 0.5 m/s, 1 rad/s, a look of 3 s that shows what lies in the triangle."""

    things: tuple[Detection, ...] = (CUP, MUG)
    pose: Pose2 = field(default_factory=lambda: Pose2(1.0, 1.0))
    looks: int = 0

    @property
    def robot_pose(self) -> Pose2:
        return self.pose

    def drive(self, path, yaw):
        travel = path_length(path)
        turn = float(np.abs(turn_angles(path, self.pose.yaw, yaw)).sum())
        self.pose = Pose2(float(path[-1, 0]), float(path[-1, 1]), yaw)
        return Drive(self.pose, travel, turn, travel / 0.5 + turn)

    def look(self, tilt=None):
        self.looks += 1
        here = [[self.pose.x, self.pose.y, self.pose.yaw]]
        seen = [thing for thing in self.things if in_view(here, CONE, [thing.position[:2]])[0, 0]]
        return Look(tuple(seen), 3.0)


@pytest.fixture(scope="module")
def navigation():
    cells = np.full((100, 100), Cell.FREE, dtype=np.uint8)
    cells[40:60, 30:70] = Cell.OCCUPIED
    return NavigationGrid.from_occupancy(OccupancyGrid(cells, 0.05, Pose2(0, 0), "a test"), 0.3)


def run(navigation, world=None, planner=None, limits=None, trial=0, seed=3) -> SearchResult:
    planner = planner or RandomPlanner()
    limits = limits or GENEROUS
    return search_world(world or PaperWorld(), planner, navigation, "Cup", limits, TrialSeeds(seed, trial))


def test_the_search_ends_with_the_first_cup(navigation):
    result = run(navigation)
    assert result.found and result.detection == CUP
    assert [CUP in step.detections for step in result.steps] == [False] * (len(result.steps) - 1) + [True]
    assert result.poses == len(result.steps)


def test_other_classes_do_not_end_it(navigation):
    seen = [
        kind.kind
        for trial in range(30)
        for step in run(navigation, trial=trial).steps
        for kind in step.detections
    ]
    assert "Mug" in seen


def test_the_clock_adds_up_drives_turns_and_looks(navigation):
    for trial in range(10):
        result = run(navigation, trial=trial)
        clock = 0.0
        for number, step in enumerate(result.steps):
            assert step.number == number
            dwell = 3.0 if step.looked else 0.0
            assert step.seconds == pytest.approx(step.travel / 0.5 + step.turn + dwell)
            clock += step.seconds
            assert step.clock == pytest.approx(clock)
        assert result.travel == pytest.approx(sum(path_length(step.path) for step in result.steps))
        assert result.seconds == pytest.approx(clock)


def test_each_step_starts_where_the_last_one_ended(navigation):
    result = run(navigation, PaperWorld(things=()), limits=Limits(120.0, 6, 20))
    for before, after in pairwise(result.steps):
        assert after.origin == before.pose
        np.testing.assert_allclose(after.path[0], before.path[-1])


def test_a_drive_past_the_limit_counts_as_not_found_at_the_limit(navigation):
    world = PaperWorld()
    whole = run(navigation)
    last = whole.steps[-1]
    limit = last.clock - 3.0 - 0.01
    cut = run(navigation, world, limits=Limits(limit, 200, 20))
    assert (cut.found, cut.detection, cut.seconds) == (False, None, limit)
    assert not cut.steps[-1].looked and cut.steps[-1].detections == ()
    assert cut.poses == world.looks == whole.poses - 1


def test_a_look_past_the_limit_counts_as_not_found(navigation):
    limit = run(navigation).steps[-1].clock - 0.01
    cut = run(navigation, limits=Limits(limit, 200, 20))
    assert (cut.found, cut.seconds) == (False, limit)
    exact = run(navigation, limits=Limits(limit + 0.02, 200, 20))
    assert exact.found


def test_the_pose_limit(navigation):
    result = run(navigation, PaperWorld(things=()), limits=Limits(1e6, 4, 20))
    assert (result.found, result.poses, len(result.steps)) == (False, 4, 4)
    assert result.seconds == pytest.approx(result.steps[-1].clock)


def test_all_planners_draw_the_same_candidates(navigation):
    rng = np.random.default_rng(0)
    planes = QSRPlanner.of_planes(CONE, rng.uniform(0, 5, (200, 2)))
    nothing = Limits(120.0, 5, 20)
    first = run(navigation, PaperWorld(things=()), RandomPlanner(), nothing, trial=7)
    second = run(navigation, PaperWorld(things=()), planes, nothing, trial=7)
    assert [step.chosen for step in first.steps] != [step.chosen for step in second.steps]
    for one, other in zip(first.steps, second.steps, strict=False):
        np.testing.assert_array_equal(one.candidates, other.candidates)


def test_trials_do_not_depend_on_each_other(navigation):
    alone = run(navigation, trial=5)
    run(navigation, trial=4)
    again = run(navigation, trial=5)
    assert (alone.seconds, alone.travel) == (again.seconds, again.travel)
    assert alone.seconds != run(navigation, trial=6).seconds


def test_every_step_is_told_as_it_happens(navigation):
    told = []
    result = search_world(
        PaperWorld(), RandomPlanner(), navigation, "Cup", GENEROUS, TrialSeeds(3), watch=told.append
    )
    assert tuple(told) == result.steps


def test_a_step_knows_its_ranking(navigation):
    planes = QSRPlanner.of_planes(CONE, np.random.default_rng(0).uniform(0, 5, (200, 2)))
    step = run(navigation, planner=planes).steps[0]
    assert step.ranking[0] == step.chosen
    assert sorted(step.ranking) == list(range(20))
    assert step.value == step.values.max()
    assert not step.candidates.flags.writeable


@pytest.mark.parametrize("limits", [(0.0, 20, 20), (120.0, 0, 20), (120.0, 20, 0), (float("inf"), 20, 20)])
def test_senseless_limits_are_refused(limits):
    with pytest.raises(ValueRangeError):
        Limits(*limits)
