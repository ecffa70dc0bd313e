"""Joint scenes: what never happens in them, what is required of them, and what is drawn."""

import json
import math
from itertools import combinations

import numpy as np
import pytest
from generated_knowledge import generate
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.geometry.boxes import overlap

HEAD = """
static M { size: 20 cm × 30 cm, front: yes }. dynamic A { size: 12 cm × 8 cm }, B { size: 10 cm × 10 cm }.
landmark m : M at (1 m, -2 m) facing 70 deg.
"""
SIDES = "believe 0.5 :: left-of(A, M) | 0.5 :: right-of(A, M). observe in-front-of(B, M)."
bases = st.builds(
    generate, st.sampled_from(["one hop", "chain", "uncertain heading", "region"]), st.integers(0, 40)
)


def known(*statements):
    return qsr.parse_knowledge(HEAD + "\n".join(statements))


def half(graph, name):
    kind = graph.classes[graph.class_of(name)]
    return 0.5 * kind.depth, 0.5 * kind.width


@given(bases)
@settings(max_examples=15)
def test_no_boxes_overlap_but_of_what_is_on_or_in_another(base):
    knowledge = qsr.parse_knowledge(base.text)
    scenes = knowledge.sample(count=60)
    assert len(scenes) == 60
    for one, other in combinations(range(len(scenes.names)), 2):
        names = scenes.names[one], scenes.names[other]
        halves = [half(knowledge.graph, name) for name in names]
        if {"Table", "Bin"} & set(names) or min(map(min, halves)) == 0.0:
            continue
        both = np.isfinite(scenes.headings[:, [one, other]]).all(axis=1)
        offsets = (scenes.positions[:, other] - scenes.positions[:, one])[both]
        yaws, other_yaws = scenes.headings[both, one], scenes.headings[both, other]
        assert not overlap(offsets, yaws, other_yaws, *halves).any()


@given(
    st.sampled_from(["left-of(A, M)", "¬close-to(A, M)", "left-of(A, M) ∨ close-to(B, M)"]),
    st.integers(0, 99),
)
@settings(max_examples=12)
def test_what_is_given_and_required_holds_in_every_scene(formula, seed):
    """Each scene, with its things as landmarks, is asked again."""
    for scenes in (
        known(SIDES).sample(count=3, given=formula, rng=np.random.default_rng(seed)),
        known(SIDES, f"require {formula}.").sample(count=3, rng=np.random.default_rng(seed)),
    ):
        for places in scenes.positions:
            spots = dict(zip(scenes.names, places, strict=True))
            seen = [f"{one.lower()} : {one} at ({x} m, {y} m)" for one in "AB" for x, y in [spots[one]]]
            holds = known().with_landmarks(*seen).prob(f"({formula}) ∧ ({formula})", samples=64)
            assert holds.value == pytest.approx(1.0)
        assert scenes.assumed


def test_a_soft_requirement_shifts_the_odds():
    """Within 5 standard errors of 4,000 scenes."""
    scenes = known(SIDES, "require 0.8 :: left-of(A, M).").sample("A", 4000)
    axis = np.radians(70.0) + np.pi
    off = scenes.positions[:, scenes.names.index("A")] - [1.0, -2.0]
    left = off @ [-np.sin(axis), np.cos(axis)] > 0.0
    assert abs(left.mean() - 0.8) < 5.0 * math.sqrt(0.16 / 4000)


def test_what_is_elsewhere_is_in_no_scene():
    scenes = known("believe 0.25 :: left-of(A, M) | elsewhere.").sample("A", 4000)
    there = np.isfinite(scenes.positions[:, scenes.names.index("A")]).all(axis=1)
    assert abs(there.mean() - 0.25) < 5.0 * math.sqrt(0.1875 / 4000)
    data = scenes.to_json()
    assert sum(scene["A"] is None for scene in data["scenes"]) == (~there).sum()
    assert f"in {there.mean():.1%} of them" in str(scenes)
    json.dumps(data, allow_nan=False)


def test_a_scene_a_class_or_all_is_drawn():
    text = known(SIDES, "dynamic C. observe left-of(C, B). scene pair(A, M) ⇔ behind-of(A, M).")
    assert set(text.sample("pair").names) == {"A", "M"}
    assert set(text.sample("C").names) == {"C", "B", "M"}, "up to the landmarks"
    assert set(text.sample().names) == {"A", "B", "C", "M"}
    data = text.sample("C", 2).to_json()
    assert [set(scene) for scene in data["scenes"]] == [{"C", "B", "M"}] * 2
    assert all(len(pose) == 3 for scene in data["scenes"] for pose in scene.values())


@pytest.mark.parametrize("count", [1, 7, 20_001])
def test_as_many_as_are_asked_for_are_drawn_and_repeat_with_their_seed(count):
    knowledge = known(SIDES)
    one, other = (knowledge.sample(count=count, rng=np.random.default_rng(4)) for _ in range(2))
    assert len(one) == count <= one.drawn
    np.testing.assert_array_equal(one.positions, other.positions)


def test_what_never_passes_is_an_error_that_names_it():
    big = "dynamic Big { size: 4 m × 4 m }. observe close-to(Big, M) ~ normal((0 m, 0 m), (1 cm, 1 cm), 0)."
    with pytest.raises(qsr.ImpossibleConditionError):
        known(big).sample("Big")
    with pytest.raises(qsr.ImpossibleConditionError, match=r"behind-of\(B, M\)"):
        known(SIDES).sample(given="behind-of(B, M) ∧ close-to(A, M)")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda one: one.sample("Nothing"), "unknown scene or class 'Nothing'"),
        (lambda one: one.sample("A", 0), "number of scenes"),
        (lambda one: one.sample("A", 10**9), "number of scenes"),
        (lambda one: one.sample("A", given="left-of(A)"), "arguments"),
        (lambda one: one.sample("A", given="left-of(A, Nothing)"), "Nothing"),
        (lambda one: one.sample("A", given="left-of(A"), "Q1"),
        (lambda one: one.sample(""), "unknown"),
    ],
)
def test_bad_input_is_told(ask, message):
    with pytest.raises(qsr.QSRError, match=message):
        ask(known(SIDES))
