"""Laws that every answer keeps, over generated knowledge bases."""

import math
import re
from functools import cache

import numpy as np
import pytest
from generated_knowledge import DIRECTIONS, MAKERS, generate
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_motions import moved
from strategies import poses

import qsrlang as qsr
from qsrlang.geometry.angles import rotation

WITHOUT_DRAWS = [kind for kind in MAKERS if kind not in ("given", "required")]
TURNING = [kind for kind in WITHOUT_DRAWS if kind not in ("fits", "fused fits", "seen fits")]
bases = st.builds(generate, st.sampled_from(WITHOUT_DRAWS), st.integers(0, 30))
seeds = st.integers(0, 2**32 - 1)


@cache
def known(text):
    return qsr.parse_knowledge(text)


def viewer_of(base):
    return None if base.viewer is None else qsr.Pose2(*base.viewer)


def sorted_components(answer):
    """Weight, mean and covariance (M, 7) of all components, in an order that rounding does not change."""
    rows = np.column_stack([answer.weights, answer.means, answer.covariances.reshape(-1, 4)])
    return rows[np.lexsort(rows.round(6).T)]


def same(one, other, atol=1e-6):
    assert one.elsewhere == pytest.approx(other.elsewhere, abs=atol)
    np.testing.assert_allclose(sorted_components(one), sorted_components(other), atol=atol)


# Rigid motions


@given(st.builds(generate, st.sampled_from(TURNING), st.integers(0, 30)), poses)
@settings(max_examples=60)
def test_answers_move_with_the_scene(base, pose):
    """Where, probabilities and proofs; what is said in the axes of the map moves with shifts alone."""
    if "absolute" in base.text:
        pose = qsr.Pose2(pose.x, pose.y)
    here, viewer = known(base.text), viewer_of(base)
    there = here.with_landmarks(*(moved(one, pose) for one in here.landmarks))
    then = None if viewer is None else pose @ viewer
    before, after = here.explain(base.target, viewer=viewer), there.explain(base.target, viewer=then)
    assert [proof.weight for proof in after.proofs] == pytest.approx(
        [proof.weight for proof in before.proofs], abs=1e-6
    )
    turn = rotation(pose.yaw)
    mean, covariance = before.answer.mixture.moments()
    moved_mean, moved_covariance = after.answer.mixture.moments()
    np.testing.assert_allclose(moved_mean, pose.transform([mean])[0], atol=1e-5)
    np.testing.assert_allclose(moved_covariance, turn @ covariance @ turn.T, atol=1e-5)
    (event, _) = base.events
    probs = [here.prob(event, viewer=viewer, samples=200), there.prob(event, viewer=then, samples=200)]
    assert probs[0].method == probs[1].method
    if probs[0].method != "draws":
        assert probs[0].value == pytest.approx(probs[1].value, abs=1e-5)


# Mirrors

SIDES = {"left-of": "right-of", "right-of": "left-of"}


def mirrored(text):
    return re.sub("left-of|right-of", lambda found: SIDES[found[0]], text)


def mirrored_landmark(one):
    """A landmark seen in a mirror along the x axis of the map."""
    heading = None if one.heading is None else -one.heading
    return qsr.Landmark(one.name, one.kind, one.x, -one.y, None, heading, one.deviation)


MIRRORED = (
    "one hop",
    "chain",
    "uncertain place",
    "uncertain heading",
    "on a desk",
    "chain on a desk",
    "between",
)


@given(st.builds(generate, st.sampled_from(MIRRORED), st.integers(0, 60)))
@settings(max_examples=50)
def test_left_is_right_in_a_mirror(base):
    """What is said in the axes of the map is left out: its mirror would be another one."""
    text = base.text.replace(" wrt absolute", " wrt intrinsic")
    here, there = known(text), known(mirrored(text))
    there = there.with_landmarks(*map(mirrored_landmark, here.landmarks))
    before, after = here.where(base.target), there.where(base.target)
    mirror = np.diag([1.0, -1.0])
    (mean, covariance), (other, spread) = before.mixture.moments(), after.mixture.moments()
    assert sorted(after.weights) == pytest.approx(sorted(before.weights), abs=1e-6)
    np.testing.assert_allclose(other, mirror @ mean, atol=1e-5)
    np.testing.assert_allclose(spread, mirror @ covariance @ mirror, atol=1e-5)


# Order


@given(bases, seeds)
@settings(max_examples=60)
def test_the_order_of_statements_does_not_matter(base, seed):
    """Neither of classes, landmarks and beliefs, nor of counts."""
    first, *lines = base.text.splitlines()
    shuffled = "\n".join([first, *np.random.default_rng(seed).permutation(lines)])
    viewer = viewer_of(base)
    one, other = (known(text).where(base.target, viewer=viewer) for text in (base.text, shuffled))
    same(one, other, atol=1e-5)
    one, other = (
        known(text).prob(base.events[0], viewer=viewer, samples=500) for text in (base.text, shuffled)
    )
    if one.method != "draws":
        assert one.value == pytest.approx(other.value, abs=1e-6)


EVIDENCE = ("fused", "fused fits", "seen", "seen fits", "several landmarks", "between", "region")


@given(st.builds(generate, st.sampled_from(EVIDENCE), st.integers(0, 60)), seeds)
@settings(max_examples=40)
def test_the_order_of_evidence_does_not_matter(base, seed):
    """Landmarks and seen objects that are given one by one, in any order, tell what all of them tell together."""
    whole = known(base.text)
    lines = base.text.splitlines()
    bare = known("\n".join(line for line in lines if not line.startswith("landmark")))
    step_by_step = bare
    for at in np.random.default_rng(seed).permutation(len(whole.landmarks)):
        step_by_step = step_by_step.with_landmarks(whole.landmarks[at])
    same(whole.where(base.target), step_by_step.where(base.target), atol=1e-5)


@given(st.integers(0, 60), seeds)
@settings(max_examples=15)
def test_conditioning_twice_is_once_and_the_order_of_what_is_given_does_not_matter(number, seed):
    base = generate("given", number)
    a, b = base.given, "distant-from(B, A)" if "close" in base.given else "close-to(A, M)"

    def prob(condition):
        rng = np.random.default_rng(seed)
        return known(base.text).prob(base.events[0], condition, samples=1000, rng=rng).value

    try:
        once = prob(f"{a} ∧ {b}")
    except qsr.ImpossibleConditionError:
        return
    for again in (f"{b} ∧ {a}", f"{a} ∧ {b} ∧ {a}", f"({a} ∧ {b}) ∧ ({a} ∧ {b})", f"¬(¬{a} ∨ ¬{b})"):
        assert prob(again) == pytest.approx(once, abs=0.03 if "¬" in again else 1e-9)


# Sums


@given(st.builds(generate, st.sampled_from(WITHOUT_DRAWS), st.integers(0, 30)))
@settings(max_examples=60)
def test_exclusive_directions_sum_to_one_less_what_is_elsewhere(base):
    """The four quarters about a relatum, whichever way each is found."""
    match = re.search(r"(?:behind-of|left-of|in-front-of|right-of)\((\w+), (\w+)\)", base.text)
    referent, relatum = match.groups() if match else ("A", "M")
    viewer, knowledge = viewer_of(base), known(base.text)
    found = [
        knowledge.prob(f"{one}({referent}, {relatum})", viewer=viewer, samples=400) for one in DIRECTIONS
    ]
    whole = " ∨ ".join(f"{one}({referent}, {relatum})" for one in DIRECTIONS)
    together = knowledge.prob(whole, viewer=viewer, samples=400)
    error = math.hypot(together.standard_error, *(one.standard_error for one in found))
    assert abs(sum(one.value for one in found) - together.value) <= 6.0 * error + 2e-3
    assert knowledge.prob(f"¬({whole})", viewer=viewer, samples=400).value == pytest.approx(
        1.0 - together.value, abs=1e-6
    )
