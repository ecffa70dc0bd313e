"""Polar densities against slow and obvious sums over a fine grid, and against draws."""

import math

import numpy as np
import pytest

import qsrlang as qsr
from qsrlang.geometry.polygon import ConvexPolygon
from qsrlang.geometry.pose import Pose2
from qsrlang.mixtures.densities.angles import bump
from qsrlang.mixtures.densities.density import PolarDensity
from qsrlang.mixtures.densities.stance import Boxes, Stance

RELATIONS = """
relation diagonal(a, b) { angle: normal(45 deg, 20 deg) }.
relation beside(a, b) { angle: mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg)), distance: uniform(0 cm, 30 cm) }.
relation wedge(a, b) { angle: uniform(-30 deg, 60 deg), distance: uniform(20 %, 90 %) }.
relation around(a, b) { distance: uniform(10 %, 60 %) }.
"""
DESK = ConvexPolygon.rectangle(Pose2(0.0, 0.0), 0.8, 1.5)
POINT = Boxes((0.0, 0.0), (0.0, 0.0))
CUP_BY_KEYBOARD = Boxes((0.04, 0.04), (0.075, 0.225))


def density(*names, boxes=POINT, support=None, reach=0.75):
    """The product of some relations, of a mix its last part."""
    relations = qsr.parse_knowledge(RELATIONS).graph.relations
    chosen = [relations[name].terms[-1][1] for name in names]
    angles = tuple(bump(r.angle) for r in chosen if r.angle) or (bump(None),)
    distances = tuple(r.distance for r in chosen if r.distance)
    return PolarDensity(angles, (1.0,) * len(angles), distances, boxes, support, reach, " ∧ ".join(names))


def stance(factor, count=1, axis=0.3, yaw=0.1, at=(0.1, -0.2)):
    return Stance(
        np.tile(at, (count, 1)),
        np.full(count, yaw),
        np.full((count, len(factor.angles)), axis),
        np.tile([0.0, 0.0, 0.05], (count, 1)),
    )


CASES = [
    (("diagonal",), POINT, None),
    (("beside",), CUP_BY_KEYBOARD, None),
    (("beside",), CUP_BY_KEYBOARD, DESK),
    (("wedge",), CUP_BY_KEYBOARD, DESK),
    (("around",), CUP_BY_KEYBOARD, DESK),
    (("diagonal", "wedge"), CUP_BY_KEYBOARD, DESK),
    (("beside", "around"), POINT, DESK),
]


@pytest.mark.parametrize(("names", "boxes", "support"), CASES)
def test_moments_equal_sums_over_a_fine_grid(names, boxes, support):
    factor = density(*names, boxes=boxes, support=support)
    step = 0.008
    axis = np.arange(-1.6, 1.6, step) + 0.5 * step
    points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    mass = factor.pdf(points, stance(factor, len(points))) * step**2
    assert mass.sum() == pytest.approx(1.0, abs=0.02)
    mean = mass @ points / mass.sum()
    covariance = np.cov(points.T, aweights=mass, ddof=0)
    (exact_mean,), (exact_covariance,) = factor.moments(stance(factor))
    np.testing.assert_allclose(exact_mean, mean, atol=2e-3)
    np.testing.assert_allclose(exact_covariance, covariance, atol=1e-3)


@pytest.mark.parametrize(("names", "boxes", "support"), CASES)
def test_moments_equal_those_of_draws(names, boxes, support):
    """False-alarm rate below 1e-5 a case: five standard errors, from the draws' own spread."""
    factor = density(*names, boxes=boxes, support=support)
    count = 60_000
    draws = factor.sample(stance(factor, count), np.random.default_rng(7).random((count, 3)))
    (mean,), (covariance,) = factor.moments(stance(factor))
    centred = draws - mean
    assert (np.abs(centred.mean(axis=0)) < 5.0 * centred.std(axis=0) / math.sqrt(count)).all()
    products = np.einsum("ni,nj->nij", centred, centred)
    error = products.std(axis=0) / math.sqrt(count)
    assert (np.abs(products.mean(axis=0) - covariance) < 5.0 * error + 1e-5).all()


def test_a_cup_starts_where_it_touches_and_ends_at_the_edge():
    factor = density("diagonal", boxes=CUP_BY_KEYBOARD, support=DESK)
    one = Stance(np.zeros((1, 2)), np.zeros(1), np.zeros((1, 1)), np.zeros((1, 3)))
    low, high = factor.bounds(one, np.array([[0.0, math.pi / 2, math.pi, 3 * math.pi / 2]]))
    np.testing.assert_allclose(low[0], [0.115, 0.265, 0.115, 0.265])
    np.testing.assert_allclose(high[0], [0.36, 0.71, 0.36, 0.71])


def test_no_room_behind_a_monitor_at_the_wall_side_of_its_desk():
    factor = density("diagonal", boxes=CUP_BY_KEYBOARD, support=DESK)
    at_the_edge = stance(factor, axis=-math.pi / 4, at=(0.39, 0.0))
    with pytest.raises(qsr.NoRoomError, match="no room"):
        factor.moments(at_the_edge)


def test_contradicting_directions_leave_no_room():
    knowledge = "dynamic A, B. observe left-of(A, B) ∧ right-of(A, B)."
    with pytest.raises(qsr.NoRoomError, match="contradict"):
        qsr.parse_knowledge(knowledge).where("A", wrt="B")


def test_directions_without_room_are_left_out_not_bent():
    """At the far edge only the half that leads back onto the desk remains."""
    factor = density("around", support=DESK)
    (mean,), _ = factor.moments(
        Stance(np.array([[0.3999, 0.0]]), np.zeros(1), np.zeros((1, 1)), np.zeros((1, 3)))
    )
    assert mean[0] < 0.35
    assert mean[1] == pytest.approx(0.0, abs=1e-9)
