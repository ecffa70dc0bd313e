"""Roles: which instance a class may be, and which landmark a role may be."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_motions import assert_moves_with_its_landmarks
from strategies import poses

import qsrlang as qsr
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds

HEAD = "surface Table { size: 2 m × 1 m }. static M, N. dynamic Cup, Plate, Spoon. "
M = "m : M at (0 m, 0 m) facing -90 deg"
BREAKFAST = "scene breakfast(left: Cup, right: Cup, M) ⇔ left-of(left, M) ∧ right-of(right, M). "
SETTING = "scene setting(left: Cup, right: Cup, Plate) ⇔ right-of(Plate, left) ∧ left-of(Plate, right). "
CUPS = ("cup-1 : Cup at (0 m, 0 m) facing -90 deg", "cup-2 : Cup at (1 m, 0 m) facing -90 deg")


def known(statements, *landmarks):
    return qsr.parse_knowledge(HEAD + statements).with_landmarks(*landmarks)


def test_a_role_is_asked_for_by_name():
    text = known(BREAKFAST, M)
    left, right = text.where("left: Cup"), text.ask("where right: Cup?")
    assert left.means[0][0] < -0.3
    assert right.means[0][0] > 0.3
    assert left.elsewhere == right.elsewhere == 0.0


def test_a_class_is_any_of_its_roles():
    text = known(BREAKFAST, M)
    answer = text.where("Cup")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])
    roles = [text.where(role).means[0] for role in ("left: Cup", "right: Cup")]
    np.testing.assert_allclose(sorted(answer.means.tolist()), roles, atol=1e-12)


def test_what_is_said_of_the_class_itself_is_one_alternative_more():
    answer = known(BREAKFAST + "believe behind-of(Cup, M).", M).where("Cup")
    np.testing.assert_allclose(answer.weights, [1 / 3] * 3)
    assert answer.means[:, 1].max() > 0.3


def test_a_relatum_is_any_of_its_roles_too():
    answer = known(BREAKFAST + "believe behind-of(Spoon, Cup).", M).where("Spoon")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])
    np.testing.assert_allclose(sorted(np.sign(answer.means[:, 0])), [-1.0, 1.0])
    assert all(len(component.statements) == 2 for component in answer.components)


def test_the_cup_of_a_scene_without_roles_is_its_own():
    """What holds together in one scene is said of one cup."""
    answer = known(BREAKFAST + "scene(Spoon, Cup, N) ⇔ behind-of(Spoon, Cup) ∧ right-of(Cup, N).", M).where
    with pytest.raises(qsr.UnreachedTargetError, match="Spoon - Cup ends at N"):
        answer("Spoon")


def test_a_relatum_that_names_its_role_is_that_one():
    answer = known(BREAKFAST + "believe behind-of(Spoon, left: Cup).", M).where("Spoon")
    assert len(answer.weights) == 1
    assert answer.means[0][0] < -0.3


def test_both_relata_may_be_roles():
    answer = known(BREAKFAST + "believe between(Spoon, left: Cup, right: Cup).", M).where("Spoon")
    assert answer.means[0][0] == pytest.approx(0.0, abs=0.02)


def test_one_role_may_be_placed_by_another():
    text = known("scene(one: Cup, two: Cup, M) ⇔ right-of(one, M) ∧ right-of(two, one).", M)
    assert text.where("two: Cup").means[0][0] > text.where("one: Cup").means[0][0] + 0.3
    answer = text.where("Cup")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])


def test_a_role_is_not_placed_by_itself():
    """The second cup is left of any other cup, so of the first."""
    text = known("believe right-of(one: Cup, M). believe left-of(two: Cup, Cup).", M)
    answer = text.where("two: Cup")
    assert answer.components[0].weight == pytest.approx(1.0)
    assert len(answer.components[0].statements) == 2


def test_what_is_named_beside_a_role_is_another():
    answer = known(BREAKFAST + "believe between(Spoon, left: Cup, Cup).", M).where("Spoon")
    assert answer.components[0].weight == pytest.approx(1.0)
    assert answer.means[0][0] == pytest.approx(0.0, abs=0.02)


@given(st.integers(0, 6), st.booleans(), st.floats(0.1, 1.0))
@settings(max_examples=30)
def test_weights_of_instances_and_the_rest_sum_to_one(count, own, share):
    roles = " ".join(f"believe {share} :: left-of(role{number}: Cup, M)." for number in range(count))
    text = known(roles + (" believe behind-of(Cup, M)." if own or not count else ""), M)
    answer = text.where("Cup")
    weights = [component.weight for component in answer.components]
    assert sum(weights) + answer.elsewhere == pytest.approx(1.0)
    ways = max(count + (own or not count), 1)
    assert min(weights) == pytest.approx(min(share if count else 1.0, 1.0) / ways)


@given(poses)
@settings(max_examples=20)
def test_roles_move_with_their_landmarks(pose):
    statements = BREAKFAST + "believe behind-of(Spoon, Cup). believe 0.7 :: close-to(Cup, N)."
    spread = ("m : M at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)", "n : N at (2 m, 3 m) facing 9 deg")
    assert_moves_with_its_landmarks(known(statements, *spread), "Spoon", pose)


def test_cups_that_are_seen_are_where_they_are():
    answer = known(BREAKFAST, M, *CUPS).where("Cup")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])
    np.testing.assert_allclose(sorted(answer.means[:, 0]), [0.0, 1.0])


def test_a_role_keeps_to_its_own_relations_though_cups_are_seen():
    answer = known(BREAKFAST, M, *CUPS).where("right: Cup")
    assert len(answer.weights) == 1
    assert 0.3 < answer.means[0][0] < 0.4


def test_a_role_that_nothing_places_is_a_landmark_of_its_class():
    answer = known("believe behind-of(Spoon, big: Cup).", *CUPS).where("Spoon")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])
    np.testing.assert_allclose(sorted(answer.means[:, 0]), [0.0, 1.0], atol=1e-9)


def test_two_roles_are_never_one_landmark():
    worlds = enumerate_worlds(known(SETTING, *CUPS).graph, "Plate")
    assert len(worlds) == 2
    for world in worlds:
        assert world.weight == pytest.approx(0.5)
        assert len({landmark.name for _, landmark in world.bindings}) == 2
    answer = known(SETTING, *CUPS).where("Plate")
    assert answer.components[0].weight > 0.9, "left of the right one and right of the left one"
    assert answer.means[0][0] == pytest.approx(0.5, abs=0.01)


def test_of_two_roles_and_one_landmark_one_was_not_seen():
    """The plate is then right of the cup or left of it, and never both."""
    answer = known(SETTING, CUPS[0]).where("Plate")
    np.testing.assert_allclose(answer.weights, [0.5, 0.5])
    np.testing.assert_allclose(answer.means[0], -answer.means[1], atol=1e-9)
    assert np.abs(answer.means[:, 0]).min() > 0.3


@given(st.integers(1, 4), st.integers(1, 4))
@settings(max_examples=16)
def test_every_assignment_of_landmarks_to_roles_is_as_likely(roles, cups):
    formula = " ∧ ".join(f"close-to(Plate, r{number}: Cup)" for number in range(roles))
    landmarks = [f"cup-{number} : Cup at ({number} m, 0 m) facing 0 deg" for number in range(cups)]
    worlds = enumerate_worlds(known(f"observe {formula}.", *landmarks).graph, "Plate")
    weights = np.array([world.weight for world in worlds])
    assert weights.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(weights, weights.mean(), rtol=1e-9)
    assert all(len(world.bindings) == min(roles, cups) for world in worlds)


def test_a_role_may_be_given_its_place():
    text = known(SETTING)
    answer = text.where("Plate", {"left: Cup": qsr.Pose2(5.0, 5.0, -1.5)})
    assert np.linalg.norm(answer.means[0] - [5.0, 5.0]) < 1.0
    seen = text.where("left: Cup", {"left: Cup": qsr.Pose2(5.0, 5.0)})
    np.testing.assert_allclose(seen.means, [[5.0, 5.0]])


def test_without_landmarks_the_answer_is_relative_to_what_the_roles_start_from():
    assert known(BREAKFAST).where("Cup").frame == "M"
    plate = known("believe behind-of(Plate, big: Cup).").where("Plate")
    assert plate.frame == "Cup"


def test_a_role_that_nothing_places_and_no_landmark_shows_is_not_reached():
    with pytest.raises(
        qsr.UnreachedTargetError, match="Plate - left: Cup ends at Cup, which has no landmark"
    ):
        known(SETTING, M).where("Plate")
    with pytest.raises(qsr.UnknownNameError, match="unknown role 'lift: Cup'; did you mean 'left: Cup'"):
        known(SETTING, M).where("lift: Cup")
