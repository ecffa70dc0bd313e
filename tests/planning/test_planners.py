import numpy as np
import pytest

from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.geometry.viewcone import Triangle
from qsrlang.planning.planners.paper import QSRPlanner, RandomPlanner
from qsrlang.planning.planners.planner import Choice, Situation

CONE = Triangle(3, 1)
CANDIDATES = np.array([[0, 0, 0.0], [0, 0, np.pi / 2], [0, 0, np.pi]])
SITUATION = Situation(CANDIDATES, Pose2(0, 0), None, 120.0)
VOXELS = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 2.0], [-1.0, 0.0]])


def rng():
    return np.random.default_rng(1)


def test_qsr_follows_the_weights_and_planes_the_count():
    qsr = QSRPlanner(CONE, VOXELS, np.array([1.0, 1.0, 1.0, 7.5])).choose(SITUATION, rng())
    planes = QSRPlanner.of_planes(CONE, VOXELS).choose(SITUATION, rng())
    assert (qsr.index, qsr.values.tolist()) == (2, [1.0, 2.0, 7.5])
    assert (planes.index, planes.values.tolist()) == (1, [1.0, 2.0, 1.0])


def test_the_first_of_equals_is_taken():
    assert QSRPlanner.of_planes(CONE, VOXELS[[0, 3]]).choose(SITUATION, rng()).index == 0
    assert QSRPlanner.of_planes(CONE, np.empty((0, 2))).choose(SITUATION, rng()).index == 0


def test_choosing_twice_chooses_the_same():
    planner = QSRPlanner(CONE, VOXELS, np.array([0.3, 0.2, 0.2, 0.1]))
    first = planner.choose(SITUATION, rng())
    again = planner.choose(SITUATION, rng())
    assert first.index == again.index
    assert first.values.tolist() == again.values.tolist()


def test_random_takes_each_candidate_equally_often():
    """Chi-square of 3,000 fixed draws with 2 degrees of freedom: above 13.8 in one of 1,000 seeds."""
    stream = rng()
    picks = [RandomPlanner().choose(SITUATION, stream).index for _ in range(3_000)]
    counts = np.bincount(picks, minlength=3)
    assert ((counts - 1_000) ** 2 / 1_000).sum() < 13.8


def test_a_choice_names_one_of_its_candidates():
    with pytest.raises(ValueRangeError):
        Choice(CANDIDATES, 3, np.ones(3), "")
    with pytest.raises(ValueRangeError):
        QSRPlanner(CONE, VOXELS, np.ones(3))
