"""Where things are: weights, chains, frames, and the laws every answer keeps."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_motions import assert_moves_with_its_landmarks
from strategies import poses

import qsrlang as qsr

DESK = qsr.load("office/desk")
MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg"
SPREAD = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 5 deg)"
UNDER = "desk-1 : Desk at (0.1 m, -0.15 m) facing -85 deg ± (1 cm, 1 cm, 1 deg)"
HEAD = "dynamic A, B, C { front: yes }, D. static M { front: yes }, N. "


def test_15_and_85_samples_weigh_0_15_and_0_85():
    answer = DESK.with_landmarks(MONITOR).where("Cup")
    assert sorted(answer.weights) == [0.15, 0.85]
    right = answer.means[np.argmax(answer.weights)]
    assert right[0] > 0.3, "seen by someone who faces the monitor, right is +x"
    assert right[1] < 0.0


def test_the_exact_engine_agrees_with_a_million_samples_within_their_error():
    """False-alarm rate below 1e-4: five standard errors of means and covariances."""
    known = DESK.with_landmarks(MONITOR)
    count = 1_000_000
    exact = known.where("Cup")
    drawn = known.where("Cup", engine="sampling", samples=count, rng=np.random.default_rng(3))
    sd = np.sqrt(np.stack([np.diag(c) for c in exact.covariances]))
    assert (np.abs(exact.means - drawn.means) < 5.0 * sd / math.sqrt(count)).all()
    scale = np.einsum("mi,mj->mij", sd, sd)
    assert (np.abs(exact.covariances - drawn.covariances) < 5.0 * scale * math.sqrt(3.0 / count)).all()


def test_with_edges_and_uncertain_landmarks_cubature_stays_near_the_samples():
    known = DESK.with_landmarks(SPREAD, UNDER)
    for target in ("Cup", "Bottle"):
        exact = known.where(target)
        drawn = known.where(target, engine="sampling", samples=40_000, rng=np.random.default_rng(3))
        np.testing.assert_allclose(exact.means, drawn.means, atol=0.02)
        np.testing.assert_allclose(exact.covariances, drawn.covariances, atol=0.004)


@given(poses, st.booleans(), st.booleans())
@settings(max_examples=40)
def test_moving_landmark_viewer_and_surface_moves_the_mixture(pose, with_desk, with_viewer):
    """The second fault of the original: a wrong sign, a wrong index, R^-1 S R, and off-diagonals dropped."""
    known = DESK.with_landmarks(*((SPREAD, UNDER) if with_desk else (SPREAD,)))
    viewer = qsr.Pose2(0.4, -1.6) if with_viewer else None
    assert_moves_with_its_landmarks(known, "Bottle", pose, viewer)


def test_left_is_right_in_a_mirror():
    left, right = (
        qsr.parse_knowledge(f"{HEAD} observe {side}-of(A, M).").where(
            "A", {"M": qsr.Pose2(0.0, 0.0, math.pi)}
        )
        for side in ("left", "right")
    )
    np.testing.assert_allclose(left.means * [1, -1], right.means, atol=1e-9)
    np.testing.assert_allclose(left.covariances * [[1, -1], [-1, 1]], right.covariances, atol=1e-9)


def test_every_landmark_of_the_class_gets_the_mixture_in_equal_parts():
    here, there = qsr.Pose2(1.2, 3.0, -1.57), qsr.Pose2(-4.0, 0.5, 2.0)
    both = DESK.where("Cup", {"Monitor": [here, there]})
    assert sorted(both.weights) == pytest.approx([0.075, 0.075, 0.425, 0.425])
    alone = DESK.where("Cup", {"Monitor": there})
    for mean in alone.means:
        assert min(np.linalg.norm(both.means - mean, axis=1)) < 1e-9


@pytest.mark.parametrize(
    ("statements", "weights", "elsewhere"),
    [
        ("believe 0.15 :: left-of(A, M) | 0.85 :: right-of(A, M).", [0.15, 0.85], 0.0),
        ("believe left-of(A, M) | right-of(A, M).", [0.5, 0.5], 0.0),
        ("believe 70 % :: left-of(A, M) | 20 % :: right-of(A, M).", [7 / 9, 2 / 9], 0.1),
        ("observe 3 × (left-of(A, M) ∨ right-of(A, M)).", [0.5, 0.5], 0.0),
        ("observe ¬left-of(A, M).", [1 / 3, 1 / 3, 1 / 3], 0.0),
        (
            "scene s(A, M) ⇔ left-of(A, M). scene t(A, M) ⇔ right-of(A, M). observe 3 × t.",
            [1 / 4, 3 / 4],
            0.0,
        ),
        (
            "scene s(A, M) ⇔ left-of(A, M). observe 1 × right-of(A, M). observe 1 × behind-of(A, M).",
            [1 / 2, 1 / 2],
            0.0,
        ),
        # Dirichlet: (10 x 0.2 + 6) / 16 and (10 x 0.8 + 0) / 16.
        ("believe 0.2 :: left-of(A, M) | 0.8 :: right-of(A, M). observe 6 × left-of(A, M).", [0.5, 0.5], 0.0),
        ("believe 1 :: left-of(A, M). observe 10 × right-of(A, M).", [0.5, 0.5], 0.0),
        ("believe 0.6 :: left-of(A, M) | 0.4 :: left-of(A, B).", [1.0], 0.4),
    ],
)
def test_shares_counts_and_scenes(statements, weights, elsewhere):
    answer = qsr.parse_knowledge(HEAD + statements).where("A", {"M": qsr.Pose2(0.0, 0.0)})
    assert sorted(answer.weights) == pytest.approx(sorted(weights))
    assert answer.elsewhere == pytest.approx(elsewhere)
    assert sum(component.weight for component in answer.components) == pytest.approx(1.0 - elsewhere)


def test_the_atoms_of_one_scene_hold_together():
    text = HEAD + (
        "scene s(A, B, M) ⇔ left-of(A, M) ∧ left-of(B, A). scene t(A, B, M) ⇔ right-of(A, M) ∧ right-of(B, A)."
    )
    answer = qsr.parse_knowledge(text).where("B", {"M": qsr.Pose2(0.0, 0.0)})
    assert len(answer.weights) == 2
    assert (np.abs(answer.means[:, 1]) > 0.5).all(), "never left, then right"


def test_a_mix_of_angles_is_a_mixture_not_one_wide_gaussian():
    beside = "relation beside(a, b) { angle: mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg)) }. "
    known = qsr.parse_knowledge(HEAD + beside + "observe 3 × beside(A, M). observe 1 × behind-of(A, M).")
    answer = known.where("A", {"M": qsr.Pose2(0.0, 0.0, math.pi)})
    assert sorted(answer.weights) == pytest.approx([0.25, 0.375, 0.375])
    assert sorted(np.sign(answer.means[:, 1].round(9))) == [-1.0, 0.0, 1.0]


def test_the_order_of_statements_does_not_matter():
    statements = ["observe 15 × left-of(A, M).", "observe 85 × right-of(A, M).", "observe behind-of(B, A)."]
    answers = [
        qsr.parse_knowledge(HEAD + " ".join(order)).where("B", {"M": qsr.Pose2(1.0, 2.0, 0.5)})
        for order in (statements, statements[::-1])
    ]
    np.testing.assert_allclose(answers[0].means, answers[1].means, atol=1e-12)
    np.testing.assert_allclose(answers[0].weights, answers[1].weights, atol=1e-12)


def test_two_relata_are_fused_as_the_samples_say():
    text = HEAD + "observe right-of(A, M) ∧ close-to(A, M). observe left-of(A, N) ∧ close-to(A, N)."
    known = qsr.parse_knowledge(text).with_landmarks(
        "m : M at (0 m, 0 m) facing -90 deg", "n : N at (0.45 m, 0.1 m) facing -90 deg"
    )
    exact = known.where("A")
    alone = qsr.parse_knowledge(text.split("observe left")[0]).where(
        "A", {"M": qsr.Pose2(0.0, 0.0, -math.pi / 2)}
    )
    drawn = known.where("A", engine="sampling", samples=200_000, rng=np.random.default_rng(0))
    assert np.linalg.det(exact.covariances[0]) < np.linalg.det(alone.covariances[0])
    np.testing.assert_allclose(exact.means, drawn.means, atol=0.03)


def test_knowledge_that_fits_the_landmarks_better_weighs_more():
    text = HEAD + "observe right-of(A, M). observe 1 × left-of(A, N). observe 1 × right-of(A, N)."
    landmarks = {"M": qsr.Pose2(0.0, 0.0, -math.pi / 2), "N": qsr.Pose2(1.0, 0.0, -math.pi / 2)}
    answer = qsr.parse_knowledge(text).where("A", landmarks)
    best = answer.components[0]
    assert best.weight > 0.9
    assert 0.0 < best.mean[0] < 1.0, "between the two"


def test_intrinsic_swaps_left_and_right_and_nothing_else():
    here = {"M": qsr.Pose2(0.0, 0.0, 0.0)}

    def mean(relation, frame):
        return qsr.parse_knowledge(f"{HEAD} observe {relation}(A, M) wrt {frame}.").where("A", here).means[0]

    np.testing.assert_allclose(mean("left-of", "intrinsic"), mean("right-of", "relative"), atol=1e-9)
    np.testing.assert_allclose(mean("in-front-of", "intrinsic"), mean("in-front-of", "relative"), atol=1e-9)
    assert mean("left-of", "intrinsic")[1] > 0.3, "its own left"
    assert mean("in-front-of", "intrinsic")[0] > 0.3


def test_absolute_means_as_on_the_map():
    here = {"M": qsr.Pose2(0.0, 0.0, 1.234)}

    def mean(relation):
        return qsr.parse_knowledge(f"{HEAD} observe {relation}(A, M) wrt absolute.").where("A", here).means[0]

    assert mean("behind-of")[1] > 0.3
    assert mean("right-of")[0] > 0.3
    assert mean("in-front-of")[1] < -0.3


def test_a_given_viewer_sets_the_axis():
    known = qsr.parse_knowledge(HEAD + "observe behind-of(A, M).").with_landmarks("m : M at (0 m, 0 m)")
    behind = known.where("A", viewer=qsr.Pose2(-2.0, 0.0)).means[0]
    assert behind[0] > 0.3
    with pytest.raises(qsr.MissingFacingError, match="'m' has no heading"):
        known.where("A")


def test_a_metric_fit_is_placed_as_written():
    text = HEAD + "observe right-of(A, M) ~ normal((-7 cm, -31 cm), (12 cm, 20 cm), 0.12)."
    answer = qsr.parse_knowledge(text).where("A", {"M": qsr.Pose2(1.0, 2.0, math.pi)})
    np.testing.assert_allclose(answer.means[0], [0.93, 1.69], atol=1e-12)
    expected = [[0.12**2, 0.12 * 0.12 * 0.2], [0.12 * 0.12 * 0.2, 0.2**2]]
    np.testing.assert_allclose(answer.covariances[0], expected, atol=1e-12)


def test_without_a_landmark_the_answer_is_relative_and_says_so():
    answer = DESK.where("Cup")
    assert answer.frame == "Monitor"
    assert answer.to_json()["frame"] == "Monitor"
    keyboard = DESK.ask("where Cup wrt Keyboard?")
    assert keyboard.frame == "Keyboard"
    assert sorted(keyboard.means[:, 1]) == pytest.approx(
        [-keyboard.means[:, 1].max(), keyboard.means[:, 1].max()]
    )


def test_each_component_names_the_statements_behind_it():
    answer = DESK.with_landmarks(MONITOR).where("Bottle")
    assert answer.components[0].statements == (
        "office/desk.qsr:19: in-front-of(Keyboard, Monitor)",
        "office/desk.qsr:27: observe 85 × right-of(Cup, Keyboard)",
        "office/desk.qsr:22: behind-of(Bottle, Cup) ∧ close-to(Bottle, Cup)",
    )


def test_a_target_that_no_chain_reaches_lists_the_chains_tried():
    known = qsr.parse_knowledge(HEAD + "observe left-of(A, B).").with_landmarks(
        "m : M at (0 m, 0 m) facing 0 deg"
    )
    with pytest.raises(qsr.UnreachedTargetError, match="A - B ends at B, which has no landmark"):
        known.where("A")
    with pytest.raises(qsr.UnreachedTargetError, match="no statement places D"):
        known.where("D")


def test_unknown_names_are_told_with_the_nearest():
    with pytest.raises(qsr.UnknownNameError, match="did you mean 'Cup'"):
        DESK.where("Cupp")
    with pytest.raises(qsr.UnknownNameError, match="known: exact, sampling"):
        DESK.where("Cup", engine="magic")
    with pytest.raises(qsr.UnknownNameError, match="unknown class 'Monitr'"):
        DESK.with_landmarks("m : Monitr at (0 m, 0 m)")


def test_a_cycle_with_an_anchor_is_no_special_case():
    text = HEAD + "observe right-of(A, M). observe left-of(A, B). observe right-of(B, A)."
    answer = qsr.parse_knowledge(text).where("B", {"M": qsr.Pose2(0.0, 0.0, math.pi)})
    assert answer.means[0][1] < -0.5


def test_what_is_seen_is_a_landmark_at_once():
    known = DESK.with_landmarks(MONITOR, "keyboard-1 : Keyboard at (0.3 m, -0.4 m) facing -90 deg")
    answer = known.where("Cup")
    assert answer.components[0].mean[0] == pytest.approx(0.3 + 0.6313, abs=0.01)
    seen = known.where("Keyboard")
    np.testing.assert_allclose(seen.means, [[0.3, -0.4]])


def test_the_likeliest_combinations_are_kept_and_the_mass_of_the_others_is_told():
    names = [f"K{number}" for number in range(16)]
    text = f"static R. dynamic {', '.join(names)}. "
    text += " ".join(
        f"believe 0.9 :: left-of({a}, {b}) | 0.1 :: right-of({a}, {b})."
        for a, b in zip(names[1:], names, strict=False)
    )
    known = qsr.parse_knowledge(text + " observe left-of(K0, R).")
    answer = known.where("K15", {"R": qsr.Pose2(0.0, 0.0)}, max_worlds=100, max_components=20)
    swaps = [math.comb(15, count) * 0.9 ** (15 - count) * 0.1**count for count in range(3)]
    fewest = sum(swaps[:2]) + (100 - 16) * 0.9**13 * 0.1**2
    assert answer.dropped == pytest.approx(1.0 - fewest)
    assert len(answer.weights) == 20
    assert sum(answer.weights) == pytest.approx(1.0)
    assert "dropped" in str(answer)
    whole = known.where("K2", {"R": qsr.Pose2(0.0, 0.0)})
    assert whole.dropped == 0.0
