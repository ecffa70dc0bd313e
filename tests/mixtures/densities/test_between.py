"""Ternary relations: densities whose axis runs from one relatum to the other."""

import math

import numpy as np
import pytest
from drawn_moments import assert_draws_have_the_moments, grid_moments
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_motions import assert_moves_with_its_landmarks
from strategies import poses

import qsrlang as qsr
from qsrlang.mixtures.densities.stated import make_conditional
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.plans import plan_world

HEAD = """
static A { size: 40 cm × 20 cm }, B { size: 20 cm × 60 cm }, P, Q. dynamic X { size: 8 cm × 8 cm }, Y, Z.
relation nearer(referent, relatum, other) { angle: normal(0 deg, 11.25 deg), distance: uniform(0 %, 50 %) }.
relation off(referent, relatum, other) {
    angle: uniform(20 deg, 80 deg), distance: uniform(20 cm, 40 cm), symmetric: yes
}.
"""
A, B = "a : A at (0 m, 0 m) facing 20 deg", "b : B at (1.1 m, 0.4 m) facing -80 deg"
P, Q = "p : P at (0 m, 0 m)", "q : Q at (2 m, 0 m)"
SPREAD = (f"{A} ± (3 cm, 3 cm, 5 deg)", f"{B} ± (2 cm, 2 cm)")
RELATIONS = ["between", "nearer", "off"]
places = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def known(statements, *landmarks):
    return qsr.parse_knowledge(HEAD + statements).with_landmarks(*landmarks)


def only_conditional(text, target="X"):
    """What the only constraint on a target says, and the state of its landmarks."""
    (world,) = enumerate_worlds(text.graph, target)
    plan = plan_world(text.graph, world, target)
    layout = plan.layout
    return make_conditional(text.graph, plan.steps[0], layout.anchor, None), layout.mean


@pytest.mark.parametrize("relation", RELATIONS)
def test_moments_equal_those_of_draws(relation):
    assert_draws_have_the_moments(*only_conditional(known(f"believe {relation}(X, A, B).", A, B)))


@pytest.mark.parametrize("relation", RELATIONS)
def test_the_density_sums_to_one_and_to_its_moments(relation):
    conditional, state = only_conditional(known(f"believe {relation}(X, A, B).", A, B))
    (exact_mean,), (exact_covariance,) = conditional.moments(state[None])
    mass, mean, covariance = grid_moments(conditional, state, exact_mean, 1.5, 0.005)
    assert mass == pytest.approx(1.0, abs=5e-3)
    np.testing.assert_allclose(mean, exact_mean, atol=2e-3)
    np.testing.assert_allclose(covariance, exact_covariance, atol=1e-3)


def test_on_the_way_from_where_the_boxes_touch_to_where_they_touch():
    p, b = "p : P at (0 m, 0 m)", "b : B at (1 m, 0 m) facing 90 deg"
    conditional, state = only_conditional(known("believe between(X, P, B).", p, b))
    draws = conditional.sample(np.tile(state, (4000, 1)), np.random.default_rng(0).random((4000, 3)))
    assert np.hypot(*draws.T).min() >= 0.04, "half a cup from the point"
    assert draws[:, 0].max() <= 1.0 - 0.1 - 0.04 + 1e-9, "B is 20 cm wide, and stands across"
    assert draws[:, 0].max() > 0.85


def test_each_box_has_its_own_heading():
    """Half of the way from the cup at the point to the cup at B, which stands across it or along it."""
    for facing, second in ((90, 0.1), (0, 0.3)):
        b = f"b : B at (1 m, 0 m) facing {facing} deg"
        conditional, state = only_conditional(known("believe nearer(X, P, B).", "p : P at (0 m, 0 m)", b))
        draws = conditional.sample(np.tile(state, (4000, 1)), np.random.default_rng(0).random((4000, 3)))
        assert draws[:, 0].max() == pytest.approx(0.5 * (0.04 + 1.0 - second - 0.04), abs=5e-3)


def test_it_lies_in_the_middle_whichever_comes_first():
    texts = ["believe between(X, A, B).", "believe between(X, B, A)."]
    (one, other) = (known(text, A, B).where("X") for text in texts)
    np.testing.assert_allclose(one.means, other.means, atol=1e-12)
    np.testing.assert_allclose(one.covariances, other.covariances, atol=1e-12)
    points = known("believe between(X, P, Q).", P, Q).where("X")
    np.testing.assert_allclose(points.means, [[0.5 * (0.04 + 1.96), 0.0]], atol=1e-12)


def test_a_relation_that_is_not_symmetric_is_seen_from_its_relatum():
    near = known("believe nearer(X, P, Q).", P, Q).where("X").means[0][0]
    far = known("believe nearer(X, Q, P).", P, Q).where("X").means[0][0]
    assert near < 0.6
    assert far == pytest.approx(2.0 - near)


def test_seen_from_either_end_is_the_mixture_of_both_as_one_gaussian():
    """The law of total variance, on a relation whose two halves lie far apart."""
    once = HEAD.replace("symmetric: yes", "symmetric: no")
    halves = [
        qsr.parse_knowledge(f"{once} believe off(X, {pair}).").with_landmarks(P, Q).where("X").components[0]
        for pair in ("P, Q", "Q, P")
    ]
    whole = known("believe off(X, P, Q).", P, Q).where("X").components
    assert len(whole) == 1
    means = np.array([half.mean for half in halves])
    mean = means.mean(axis=0)
    within = np.mean([half.covariance for half in halves], axis=0)
    np.testing.assert_allclose(whole[0].mean, mean, atol=1e-12)
    np.testing.assert_allclose(
        whole[0].covariance, within + (means - mean).T @ (means - mean) / 2, atol=1e-12
    )


def test_a_metric_fit_has_its_axis_from_the_one_to_the_other():
    north = "q : Q at (0 m, 2 m)"
    text = "observe between(X, P, Q) ~ normal((80 cm, 10 cm), (20 cm, 5 cm))."
    answer = known(text, P, north).where("X")
    np.testing.assert_allclose(answer.means, [[-0.1, 0.8]], atol=1e-12)
    np.testing.assert_allclose(answer.covariances[0], np.diag([0.05**2, 0.2**2]), atol=1e-12)


@given(poses, st.booleans())
@settings(max_examples=30)
def test_it_moves_with_its_landmarks(pose, headings):
    if headings:
        landmarks, pair = SPREAD, "A, B"
    else:
        landmarks, pair = (f"{P} ± (3 cm, 3 cm)", f"{Q} ± (2 cm, 2 cm)"), "P, Q"
    text = known(f"believe between(X, {pair}). believe between(Y, X, {pair[0]}).", *landmarks)
    assert_moves_with_its_landmarks(text, "Y", pose)


@given(places, places)
def test_no_two_places_are_too_close_or_too_far(first, second):
    """Where the boxes leave no room it stands on the way even so."""
    landmarks = (
        qsr.Landmark("a", "A", *first, heading=0.3),
        qsr.Landmark("b", "B", *second, heading=1.0),
    )
    answer = known("believe between(X, A, B).", *landmarks).where("X")
    lengths = np.linalg.norm(answer.means[0] - np.array([first, second]), axis=1)
    way = math.dist(first, second)
    assert (lengths <= way + 1e-3).all()
    assert np.isfinite(answer.covariances).all()


@pytest.mark.parametrize(("way", "middle"), [(0.49, 0.145), (0.48, 0.14), (0.24, 0.07), (0.0, 0.0)])
def test_things_that_touch_leave_the_middle(way, middle):
    """A is 14 cm to touch, B 34 cm: the middle is where they would meet, in that proportion where they overlap."""
    text = known("believe between(X, A, B).", "a : A at (0 m, 0 m)", f"b : B at ({way} m, 0 m)")
    (component,) = text.where("X").components
    np.testing.assert_allclose(component.mean, [middle, 0.0], atol=5e-3)
    assert component.ellipse[0] < 0.1


@pytest.mark.parametrize("frame", ["relative", "intrinsic", "absolute"])
@pytest.mark.parametrize("fit", ["", " ~ normal((80 cm, 10 cm), (20 cm, 5 cm))"])
def test_the_frame_does_not_matter(frame, fit):
    head = HEAD.replace("static A {", "static A { front: yes,").replace("symmetric: yes", "symmetric: no")
    answers = [
        qsr.parse_knowledge(f"{head} believe off(X, A, B){wrt}{fit}.").with_landmarks(A, B).where("X")
        for wrt in ("", f" wrt {frame}")
    ]
    np.testing.assert_allclose(answers[1].means, answers[0].means, atol=1e-12)
    np.testing.assert_allclose(answers[1].covariances, answers[0].covariances, atol=1e-12)


def test_a_support_does_not_end_the_way():
    """The desk is small, and nobody knows how it is turned."""
    head = HEAD.replace("X { size: 8 cm × 8 cm }", "X { size: 8 cm × 8 cm, on: Desk }")
    text = head + "surface Desk { size: 30 cm × 30 cm }. believe between(X, P, Q)."
    answer = qsr.parse_knowledge(text).with_landmarks(P, Q, "d : Desk at (0 m, 0 m)").where("X")
    np.testing.assert_allclose(answer.means, known("believe between(X, P, Q).", P, Q).where("X").means)


def test_both_relata_may_be_placed_by_statements():
    """False-alarm rate below 1e-3 for the means: five standard errors, and a centimetre for linearisation."""
    statements = "believe right-of(Y, A). believe behind-of(Z, B). believe between(X, Y, Z)."
    text = known(statements, *SPREAD)
    exact = text.where("X")
    drawn = text.where("X", engine="sampling", samples=60_000, rng=np.random.default_rng(2))
    sd = np.sqrt(np.diag(exact.covariances[0]))
    assert (np.abs(exact.means[0] - drawn.means[0]) < 5.0 * sd / math.sqrt(60_000) + 0.02).all()
    np.testing.assert_allclose(np.sqrt(np.diag(drawn.covariances[0])), sd, rtol=0.1)
    assert len(exact.components[0].statements) == 3


def test_what_else_is_known_of_the_referent_narrows_it():
    both = known("believe between(X, P, Q). believe right-of(X, P) ∧ close-to(X, P).", P, Q)
    answer = both.where("X", viewer=qsr.Pose2(0.0, -3.0))
    alone = known("believe between(X, P, Q).", P, Q).where("X")
    assert answer.means[0][0] < alone.means[0][0]
    assert np.linalg.det(answer.covariances[0]) < np.linalg.det(alone.covariances[0])
    assert len(answer.components[0].statements) == 2


def test_two_atoms_in_one_statement_are_two_sources():
    text = known("believe between(X, P, Q) ∧ between(X, A, B).", P, Q, A, "b : B at (1 m, 0 m) facing 0 deg")
    assert 0.3 < text.where("X").means[0][0] < 1.0


def test_a_way_with_one_end_unknown_says_so():
    with pytest.raises(qsr.UnreachedTargetError, match="X - B ends at B, which has no landmark") as raised:
        known("believe between(X, A, B).", A).where("X")
    assert len(raised.value.chains) == 1, "the other end is known"
    with pytest.raises(qsr.UnreachedTargetError, match="which has no landmark"):
        known("believe between(X, A, B).").where("X")


def test_relative_to_a_class_that_both_ends_start_from():
    answer = known("believe right-of(Y, A). believe left-of(Z, A). believe between(X, Y, Z).").where("X")
    assert answer.frame == "A"
    np.testing.assert_allclose(answer.means[0], [0.0, 0.0], atol=0.02)


def test_what_is_relative_to_two_classes_leaves_the_others():
    """Relative to A the place of B is unknown, and the other way round; M tells of one alternative."""
    text = known("static M. believe 0.7 :: between(X, A, B) | 0.3 :: right-of(X, M).").where("X")
    assert text.frame == "M"
    assert text.elsewhere == pytest.approx(0.7)


def test_all_pairs_of_landmarks_are_ways():
    more = "q2 : Q at (0 m, 4 m)"
    answer = known("believe between(X, P, Q).", P, Q, more).where("X")
    assert sorted(answer.weights) == pytest.approx([0.5, 0.5])
    np.testing.assert_allclose(sorted(answer.means[:, 1]), [0.0, 2.0], atol=1e-9)
