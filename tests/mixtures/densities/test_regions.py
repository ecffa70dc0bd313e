"""`on` and `in`: uniform over the box of the relatum, and what that does to the other relations of a referent."""

import math

import numpy as np
import pytest
from drawn_moments import assert_draws_have_the_moments, grid_moments
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_motions import assert_moves_with_its_landmarks
from strategies import poses

import qsrlang as qsr
from qsrlang.geometry.angles import rotation
from qsrlang.mixtures.densities.regions import BoxConditional, DiscConditional
from qsrlang.mixtures.densities.standpoint import Anchor, Standpoint
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.plans import plan_world

HEAD = """
surface Desk { size: 150 cm × 80 cm }. surface Shelf. static Crate { size: 40 cm × 30 cm }.
dynamic Cup { size: 8 cm × 8 cm }, Tray { size: 50 cm × 30 cm }, Board { size: 90 cm × 90 cm }, Keyboard, Pen.
"""
DESK = "desk-1 : Desk at (1 m, 2 m) facing 30 deg"
SPREAD = "desk-1 : Desk at (1 m, 2 m) facing 30 deg ± (3 cm, 3 cm, 4 deg)"
KEYBOARD = "keyboard-1 : Keyboard at (0.95 m, 2.1 m) facing 30 deg"
STANDPOINT = Standpoint(Anchor(0, 2, "desk-1"))
STATE = np.array([0.3, -0.2, 0.7])
REGIONS = [BoxConditional(0.8, 1.5, STANDPOINT), DiscConditional(0.75, STANDPOINT)]
sides = st.floats(0.01, 5.0)


def known(statements, *landmarks):
    return qsr.parse_knowledge(HEAD + statements).with_landmarks(*landmarks)


@pytest.mark.parametrize("region", REGIONS)
def test_moments_equal_those_of_draws(region):
    assert_draws_have_the_moments(region, STATE)


@pytest.mark.parametrize("region", REGIONS)
def test_the_density_sums_to_one_and_to_its_moments(region):
    mass, mean, covariance = grid_moments(region, STATE, STATE[:2], 1.0, 0.005)
    (exact_mean,), (exact_covariance,) = region.moments(STATE[None])
    assert mass == pytest.approx(1.0, abs=5e-3)
    np.testing.assert_allclose(mean, exact_mean, atol=1e-3)
    np.testing.assert_allclose(covariance, exact_covariance, atol=1e-3)


@pytest.mark.parametrize("region", REGIONS)
def test_every_draw_lies_where_the_density_is(region):
    states = np.tile(STATE, (1000, 1))
    draws = region.sample(states, np.random.default_rng(0).random((1000, 3)))
    assert (region.pdf(draws, states) > 0.0).all()
    assert (region.pdf(draws + 2.0, states) == 0.0).all()


@given(sides, sides, poses)
def test_the_spread_of_a_box_turns_with_it(length, width, pose):
    state = np.array([[pose.x, pose.y, pose.yaw]])
    (mean,), (covariance,) = BoxConditional(length, width, STANDPOINT).moments(state)
    turn = rotation(pose.yaw)
    np.testing.assert_allclose(mean, pose.position)
    np.testing.assert_allclose(turn.T @ covariance @ turn, np.diag([length**2, width**2]) / 12, atol=1e-12)


@pytest.mark.parametrize("relation", ["on", "in"])
def test_a_cup_is_anywhere_its_own_box_fits(relation):
    answer = known(f"believe {relation}(Cup, Desk).", DESK).where("Cup")
    turn = rotation(math.radians(30.0))
    expected = turn @ np.diag([(0.80 - 0.08) ** 2, (1.50 - 0.08) ** 2]) @ turn.T / 12
    np.testing.assert_allclose(answer.means, [[1.0, 2.0]], atol=1e-12)
    np.testing.assert_allclose(answer.covariances[0], expected, atol=1e-12)


def test_what_is_too_large_stands_in_the_middle():
    answer = known("believe on(Board, Crate).", "crate-1 : Crate at (1 m, 2 m) facing 0 deg").where("Board")
    np.testing.assert_allclose(answer.means, [[1.0, 2.0]])
    assert answer.components[0].ellipse[0] < 1e-3


def test_what_is_too_wide_still_has_room_along():
    text, crate = "believe in(Tray, Crate).", "crate-1 : Crate at (0 m, 0 m) facing 90 deg"
    long = known(text.replace("Tray", "Pen"), crate).where("Pen").covariances[0]
    np.testing.assert_allclose(np.diag(long), [0.4**2 / 12, 0.3**2 / 12])
    assert np.diag(known(text, crate).where("Tray").covariances[0]).max() < 1e-6


def test_a_surface_of_unknown_size_is_a_disc_and_needs_no_heading():
    answer = known("believe on(Cup, Shelf).", "shelf-1 : Shelf at (1 m, 2 m)").where("Cup")
    np.testing.assert_allclose(answer.means, [[1.0, 2.0]])
    np.testing.assert_allclose(answer.covariances[0], 0.75**2 / 4 * np.eye(2))


def test_a_box_without_heading_needs_a_viewer():
    text = known("believe in(Cup, Crate).", "crate-1 : Crate at (0 m, 0 m)")
    with pytest.raises(
        qsr.MissingFacingError, match="'crate-1' has no heading, which the outline of its box"
    ):
        text.where("Cup")
    seen = text.where("Cup", viewer=qsr.Pose2(0.0, -2.0))
    np.testing.assert_allclose(np.diag(seen.covariances[0]), [0.32**2 / 12, 0.22**2 / 12])


def test_every_desk_may_be_the_one():
    other = "desk-2 : Desk at (-3 m, 0 m) facing 90 deg"
    answer = known("believe 0.8 :: on(Cup, Desk).", DESK, other).where("Cup")
    assert [component.weight for component in answer.components] == pytest.approx([0.4, 0.4])
    assert answer.elsewhere == pytest.approx(0.2)
    np.testing.assert_allclose(sorted(answer.means[:, 0]), [-3.0, 1.0])


@given(poses, st.booleans())
@settings(max_examples=30)
def test_regions_move_with_their_landmarks(pose, beside):
    statements = "believe 0.7 :: on(Cup, Desk) | 0.3 :: in(Cup, Crate). believe behind-of(Pen, Cup)."
    if beside:
        statements += "believe right-of(Cup, Keyboard)."
    crate = "crate-1 : Crate at (2 m, 2.5 m) facing 200 deg"
    assert_moves_with_its_landmarks(known(statements, SPREAD, KEYBOARD, crate), "Pen", pose)


@pytest.mark.parametrize(
    "statements",
    [
        "believe on(Cup, Desk).",
        "believe on(Cup, Desk) ∧ left-of(Cup, Desk).",
        "believe on(Cup, Desk) ∧ close-to(Cup, Desk) ∧ behind-of(Cup, Desk).",
        "believe on(Tray, Desk). believe in(Cup, Tray).",
        "believe on(Tray, Desk). believe in(Cup, Tray) ∧ left-of(Cup, Tray).",
        "believe on(Cup, Desk). believe right-of(Cup, Keyboard).",
    ],
)
def test_the_exact_engine_agrees_with_the_samples(statements):
    """Means and deviations to a tenth of a deviation, which is 25 standard errors or more of 60,000 draws."""
    text = known(statements, SPREAD, KEYBOARD)
    exact = text.where("Cup")
    drawn = text.where("Cup", engine="sampling", samples=60_000, rng=np.random.default_rng(1))
    deviations = np.sqrt(np.diag(exact.covariances[0]))
    np.testing.assert_allclose(exact.means[0], drawn.means[0], atol=0.1 * deviations.max())
    np.testing.assert_allclose(np.sqrt(np.diag(drawn.covariances[0])), deviations, rtol=0.1)


def test_to_the_left_on_a_desk_is_on_its_left_half():
    """The atoms on one pair multiply: the direction's rays end at the edge of the desk and start at its middle."""
    desk = "desk-1 : Desk at (0 m, 0 m) facing -90 deg"
    answer = known("believe on(Cup, Desk) ∧ left-of(Cup, Desk).", desk).where("Cup")
    x, y = answer.means[0]
    assert x == pytest.approx(-0.5 * 0.71, abs=0.01)
    assert y == pytest.approx(0.0, abs=1e-9)
    beside = known("believe left-of(Cup, Desk).", desk).where("Cup")
    assert beside.means[0][0] < -0.79


def test_what_shares_a_tray_is_bounded_by_it():
    """The tray is no landmark; the pen lies on it and so does the cup, at most a tray's length to the right."""
    text = "believe on(Tray, Desk). believe on(Pen, Tray). believe on(Cup, Tray). believe right-of(Cup, Pen)."
    graph = known(text, DESK).graph
    (world,) = enumerate_worlds(graph, "Cup")
    plan = plan_world(graph, world, "Cup")
    (step,) = (step for step in plan.steps if step.constraint.referent == "Cup")
    assert step.support.kind.name == "Tray"
    assert not step.support.is_relatum
    assert len(plan.constraints) == 4


def test_a_stated_support_bounds_distances_as_a_declared_one_does():
    cited = known("believe on(Cup, Desk). believe right-of(Cup, Keyboard).", DESK, KEYBOARD).where("Cup")
    declared = qsr.parse_knowledge(
        HEAD.replace("Cup { size: 8 cm × 8 cm }", "Cup { size: 8 cm × 8 cm, on: Desk }")
        + "believe right-of(Cup, Keyboard)."
    )
    answer = declared.with_landmarks(DESK, KEYBOARD).where("Cup")
    np.testing.assert_allclose(cited.means, answer.means, atol=1e-12)
    np.testing.assert_allclose(cited.covariances, answer.covariances, atol=1e-12)
    assert len(cited.components[0].statements) == 2, "both are cited"


def test_a_relatum_beside_the_desk_is_a_second_source():
    """The keyboard stands off the desk: what is right of it and on the desk is between the two centres."""
    away = "keyboard-1 : Keyboard at (0 m, 0 m) facing -90 deg"
    desk = "desk-1 : Desk at (1.2 m, 0 m) facing -90 deg"
    beside = known("believe right-of(Cup, Keyboard).", away).where("Cup")
    both = known("believe on(Cup, Desk). believe right-of(Cup, Keyboard).", away, desk).where("Cup")
    assert beside.means[0][0] < both.means[0][0] < 1.2
    assert np.linalg.det(both.covariances[0]) < np.linalg.det(beside.covariances[0])


def test_the_desk_that_carries_the_keyboard_is_the_one():
    other = "desk-2 : Desk at (-6 m, 0 m) facing 90 deg"
    text = "believe on(Cup, Desk). believe right-of(Cup, Keyboard)."
    answer = known(text, DESK, other, KEYBOARD).where("Cup")
    assert answer.components[0].weight > 0.999
    assert np.linalg.norm(answer.means[0] - [1.0, 2.0]) < 0.8


def test_a_tray_carries_what_is_on_it_wherever_it_is():
    answer = known("believe on(Tray, Desk). believe on(Cup, Tray).", SPREAD).where("Cup")
    tray = known("believe on(Tray, Desk).", SPREAD).where("Tray")
    np.testing.assert_allclose(answer.means, tray.means, atol=1e-12)
    added = answer.covariances[0] - tray.covariances[0]
    assert np.trace(added) == pytest.approx((0.42**2 + 0.22**2) / 12, rel=1e-9)


def test_without_a_landmark_the_answer_is_relative_to_the_desk():
    answer = known("believe on(Cup, Desk).").where("Cup")
    assert answer.frame == "Desk"
    np.testing.assert_allclose(np.diag(answer.covariances[0]), [0.72**2 / 12, 1.42**2 / 12])
