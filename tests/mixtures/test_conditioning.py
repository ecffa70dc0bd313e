"""Probabilities, assumptions and requirements. Statistical tests fix their seeds; a limit of 4 standard errors lets a
right program fail with probability 6e-5 per comparison, about 1 % over all of them if the seeds were drawn anew."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import qsrlang as qsr

DESK = qsr.load("office/desk").with_landmarks("monitor-1 : Monitor at (0 m, 0 m) facing -90 deg")
FREE = """
static M {{ front: yes }}. dynamic A, B.
landmark m : M at (0 m, 0 m) facing 180 deg.
{}
"""
DIRECTIONS = ("behind-of", "left-of", "in-front-of", "right-of")


def known(*statements):
    return qsr.parse_knowledge(FREE.format("\n".join(statements)))


def near(answer, expected, errors=4.0):
    """What is exact is so by a quadrature good to 1e-4."""
    return abs(answer.value - expected) <= errors * answer.standard_error + 1e-4


def test_shares_are_probabilities():
    assert near(DESK.ask("prob right-of(Cup, Keyboard)?"), 0.85)
    assert near(DESK.ask("prob left-of(Cup, Keyboard)?"), 0.15)
    assert DESK.prob("close-to(Bottle, Cup)").value == pytest.approx(1.0)


@given(st.lists(st.integers(1, 9), min_size=4, max_size=4), st.integers(0, 5))
def test_exclusive_directions_sum_to_one_and_equal_their_shares(counts, seed):
    said = [f"observe {count} × {name}(A, M)." for count, name in zip(counts, DIRECTIONS, strict=True)]
    knowledge = known(*said)
    found = [
        knowledge.prob(f"{name}(A, M)", samples=2000, rng=np.random.default_rng(seed)) for name in DIRECTIONS
    ]
    assert sum(one.value for one in found) == pytest.approx(1.0, abs=1e-9)
    for one, count in zip(found, counts, strict=True):
        assert abs(one.value - count / sum(counts)) < 5e-3


def test_the_angle_of_a_normal_relation_has_the_share_of_its_quarter():
    """P(|angle| < 45 deg) of a deviation of 30 deg is erf(1.5 / sqrt 2)."""
    knowledge = known(
        "relation roughly-left(referent, relatum) { angle: normal(90 deg, 30 deg), distance: uniform(0 cm, 50 cm) }.",
        "observe roughly-left(A, M).",
    )
    found = knowledge.prob("left-of(A, M)", samples=40_000)
    assert near(found, math.erf(1.5 / math.sqrt(2.0)))
    assert found.method == "exact"
    assert near(knowledge.prob("roughly-left(A, M)", samples=40_000), 0.95)


def test_negation_disjunction_and_conjunction_follow_the_laws_of_probability():

    def prob(formula, given=None):
        return DESK.prob(formula, given, samples=5000, rng=np.random.default_rng(3)).value

    a, b = "close-to(Cup, Keyboard)", "left-of(Cup, Keyboard)"
    both, one = f"({a} ∧ {a})", f"({b} ∧ {b})"  # by draws, as every conjunction
    assert prob(f"¬{a}") == pytest.approx(1.0 - prob(a))
    assert prob(f"{a} ∨ {b}") == pytest.approx(prob(both) + prob(one) - prob(f"{a} ∧ {b}"))
    assert prob(a, b) == pytest.approx(prob(f"{a} ∧ {b}") / prob(one))
    assert prob(b, b) == pytest.approx(1.0)
    assert prob(both) == pytest.approx(prob(a), abs=0.01)
    assert prob(one) == pytest.approx(prob(b), abs=0.01)


def test_given_a_side_only_that_component_remains():
    answer = DESK.ask("where Cup given left-of(Cup, Keyboard)?")
    assert answer.weights == pytest.approx([1.0])
    assert answer.means[0] == pytest.approx(DESK.where("Cup").means[1], abs=0.03)
    assert answer.assumed == ("left-of(Cup, Keyboard)",)
    assert answer.draws > 1000


def test_given_that_it_is_close_the_way_is_halved():
    knowledge = known("observe left-of(A, M).")
    whole, half = knowledge.where("A"), knowledge.where("A", given="close-to(A, M)", samples=40_000)
    assert half.means[0] == pytest.approx(0.5 * whole.means[0], abs=5e-3)


def test_conditioning_twice_is_conditioning_once_and_order_does_not_matter():
    def where(formula):
        return DESK.where("Cup", given=formula, samples=4000, rng=np.random.default_rng(1))

    a, b = "close-to(Cup, Keyboard)", "left-of(Cup, Monitor)"
    once, twice, turned = where(f"{a} ∧ {b}"), where(f"{a} ∧ {b} ∧ {a}"), where(f"{b} ∧ {a}")
    for other in (twice, turned):
        assert np.array_equal(once.means, other.means)
        assert np.array_equal(once.weights, other.weights)


def test_what_is_required_is_met_and_a_soft_requirement_shifts_the_odds():
    sides = ["believe 0.5 :: left-of(A, M) | 0.5 :: right-of(A, M)."]
    hard = known(*sides, "require ¬right-of(A, M).")
    soft = known(*sides, "require 0.9 :: left-of(A, M).")
    assert hard.where("A").weights == pytest.approx([1.0])
    assert hard.where("A").assumed == ("require ¬right-of(A, M)",)
    assert soft.where("A").weights == pytest.approx([0.9, 0.1], abs=0.01)
    assert hard.prob("left-of(A, M)").value == pytest.approx(1.0, abs=2e-4)
    assert near(soft.prob("left-of(A, M)"), 0.9)


def test_a_requirement_reaches_through_what_the_target_depends_on():
    chain = [
        "believe 0.5 :: left-of(A, M) | 0.5 :: right-of(A, M).",
        "observe behind-of(B, A) ∧ close-to(B, A).",
    ]
    free, bound = known(*chain), known(*chain, "require left-of(A, M).")
    assert len(free.where("B").weights) == 2
    assert bound.where("B").weights == pytest.approx([1.0])
    unrelated = known(*chain, "dynamic C. observe left-of(C, M). require close-to(C, M).")
    assert unrelated.where("B").assumed == (), "exact, since nothing that B depends on is required"


def test_a_requirement_on_what_is_in_no_known_place_is_passed_over():
    chain = known("dynamic C. static N. observe left-of(A, M). observe right-of(B, A).")
    required = known(
        "dynamic C. static N. observe left-of(A, M). observe right-of(B, A).", "require close-to(A, N)."
    )
    np.testing.assert_array_equal(required.where("A").means, chain.where("A").means)
    relative = known("observe left-of(A, M). observe right-of(B, A). require close-to(A, M).").where(
        "B", wrt="A"
    )
    assert relative.frame == "A"
    assert relative.assumed == ()


def test_a_requirement_between_two_objects_moves_both():
    text = "observe left-of(A, M). observe left-of(B, M). require distant-from(A, B)."
    assert known(text).where("A").assumed
    pair = known("observe left-of(A, M). observe left-of(B, M). require left-of(A, B).")
    assert np.linalg.norm(pair.where("A").means[0]) > np.linalg.norm(pair.where("B").means[0]) + 0.1


def test_requirements_of_a_context_hold_there():
    text = "believe 0.5 :: left-of(A, M) | 0.5 :: right-of(A, M). in room r { require left-of(A, M). }"
    assert len(known(text).ask("where A?").weights) == 2
    assert known(text).ask("where A in room r?").weights == pytest.approx([1.0])


def test_what_is_elsewhere_holds_in_no_relation():
    knowledge = known("believe 0.6 :: left-of(A, M) | elsewhere.")
    assert near(knowledge.prob("left-of(A, M)"), 0.6)
    assert near(knowledge.prob("¬left-of(A, M)"), 0.4)
    assert knowledge.where("A", given="¬right-of(A, M)").elsewhere == pytest.approx(0.4, abs=0.01)
    assert knowledge.where("A", given="left-of(A, M)").elsewhere == 0.0


def test_what_cannot_be_is_an_error_that_names_it():
    both = "left-of(Bottle, Monitor) ∧ right-of(Bottle, Monitor)"
    with pytest.raises(qsr.ImpossibleConditionError, match=r"left-of\(Bottle, Monitor\).*none of 500 draws"):
        DESK.prob("close-to(Cup, Keyboard)", both, samples=500)
    with pytest.raises(qsr.ImpossibleConditionError, match="cannot hold"):
        DESK.prob("left-of(Cup, Keyboard)", "close-to(Bottle, Cup) ∧ distant-from(Bottle, Cup)")
    with pytest.raises(qsr.ImpossibleConditionError, match="require"):
        known("observe left-of(A, M). require right-of(A, M).").where("A")


def test_without_a_landmark_the_one_class_that_all_hang_on_is_taken():
    assert near(qsr.load("office/desk").prob("right-of(Cup, Keyboard)"), 0.85)
    two = qsr.parse_knowledge("static M, N. dynamic A, B. observe left-of(A, M). observe left-of(B, N).")
    with pytest.raises(qsr.UnreachedTargetError, match=r"M has no landmark.*N has no landmark"):
        two.prob("left-of(A, B)")


def test_support_containment_and_between_as_events():
    text = """
    surface Desk { size: 100 cm × 60 cm }. static Box { size: 20 cm × 20 cm }. dynamic A. static P, Q.
    landmark d : Desk at (0 m, 0 m) facing 0 deg. landmark p : P at (-1 m, 0 m) facing 0 deg.
    landmark q : Q at (1 m, 0 m) facing 0 deg.
    believe 0.25 :: on(A, Desk) | 0.75 :: left-of(A, Q) ∧ distant-from(A, Q).
    """
    knowledge = qsr.parse_knowledge(text)
    assert near(knowledge.prob("on(A, Desk)"), 0.25)
    inside = knowledge.prob("between(A, P, Q)", "on(A, Desk)", samples=40_000)
    wedge = math.tan(math.radians(1.96 * 11.25))
    x, y = np.meshgrid(np.linspace(-0.3, 0.3, 601), np.linspace(-0.5, 0.5, 1001))
    either = (np.abs(y) <= wedge * (1 + x)) | (np.abs(y) <= wedge * (1 - x))
    assert near(inside, float(either.mean()), errors=5.0)


@given(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-math.pi, math.pi))
def test_probabilities_do_not_change_when_the_whole_scene_moves(x, y, yaw):
    def prob(monitor):
        placed = qsr.load("office/desk").with_landmarks(monitor)
        return placed.prob("left-of(Cup, Monitor)", samples=300, rng=np.random.default_rng(2)).value

    here = prob("monitor-1 : Monitor at (0 m, 0 m) facing 0 rad")
    there = prob(f"monitor-1 : Monitor at ({x:.9f} m, {y:.9f} m) facing {yaw:.9f} rad")
    assert here == pytest.approx(there, abs=0.011), "a draw on a boundary may fall to the other side"


def test_names_and_numbers_in_formulas_are_checked():
    with pytest.raises(qsr.UnknownNameError, match="left-of"):
        DESK.prob("left_of(Cup, Keyboard)")
    with pytest.raises(qsr.ValueRangeError, match="arguments"):
        DESK.prob("left-of(Cup, Keyboard, Monitor)")
    with pytest.raises(qsr.ValueRangeError, match="samples"):
        DESK.prob("left-of(Cup, Keyboard)", samples=1)
    with pytest.raises(qsr.LanguageError, match="Q101"):
        DESK.prob("left-of(Cup Keyboard)")


def test_an_answer_is_plain_data_and_one_line():
    exact = DESK.prob("left-of(Cup, Keyboard)")
    assert str(exact) == "prob left-of(Cup, Keyboard): 0.1500 (exact)"
    answer = DESK.prob("left-of(Cup, Keyboard)", "close-to(Cup, Keyboard)")
    assert str(answer).startswith("prob left-of(Cup, Keyboard) given close-to(Cup, Keyboard): 0.1")
    assert set(answer.to_json()) == {
        "formula",
        "probability",
        "method",
        "dropped",
        "standard_error",
        "effective_draws",
        "assumed",
    }
