"""What is asked wrongly is told, by whatever function: what was wrong, and what would work."""

import numpy as np
import pytest

import qsrlang as qsr

KNOWN = qsr.load("office/desk").with_landmarks("m : Monitor at (0 m, 0 m) facing -90 deg")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: KNOWN.where(""), "unknown class ''"),
        (lambda: KNOWN.where("Cup", wrt=""), "unknown class ''"),
        (lambda: KNOWN.where("Cup", wrt="Cap"), "did you mean 'Cup'"),
        (lambda: KNOWN.where("Cup", given="Cup"), "Q1"),
        (lambda: KNOWN.where("Cup", given=""), "Q1"),
        (lambda: KNOWN.where("Cup", samples=0, engine="sampling"), "number of samples"),
        (lambda: KNOWN.where("Cup", engine="sampling"), "rng is None; expected a generator"),
        (lambda: KNOWN.where("Cup", max_components=0), "components"),
        (lambda: KNOWN.where("Cup", max_worlds=-1), "worlds"),
        (lambda: KNOWN.where("Cup", {"Monitr": qsr.Pose2(0.0, 0.0)}), "Monitr"),
        (lambda: KNOWN.prob(""), "Q1"),
        (lambda: KNOWN.prob("left-of(Cup, Keyboard)?"), "Q1"),
        (lambda: KNOWN.prob("left-of(Cup, Keyboard)", "left-of(Cup)"), "arguments"),
        (lambda: KNOWN.explain("left-of(Cup, Keyboard) ∧"), "Q1"),
        (lambda: KNOWN.explain("Cup", samples=1), "samples"),
        (lambda: KNOWN.rank_landmarks("Cupp"), "did you mean 'Cup'"),
        (lambda: KNOWN.rank_landmarks(""), "unknown class ''"),
        (lambda: KNOWN.ask("where?"), "Q1"),
        (lambda: KNOWN.ask("sample Cup 0?"), "1 to 1000000 scenes"),
        (lambda: KNOWN.ask("landmarks?"), "Q1"),
        (lambda: KNOWN.with_landmarks("m : Monitor"), "Q1"),
    ],
)
def test_it_is_an_error_of_ours_with_a_message(ask, message):
    with pytest.raises(qsr.QSRError, match=message) as raised:
        ask()
    assert len(str(raised.value)) > 10


def test_a_question_that_fails_loses_nothing():
    before = KNOWN.where("Cup")
    for wrong in ("where Cupp?", "prob left-of(Cup)?", "sample Cup 0?"):
        with pytest.raises(qsr.QSRError):
            KNOWN.ask(wrong)
    np.testing.assert_array_equal(KNOWN.where("Cup").means, before.means)


@pytest.mark.parametrize("formula", ["left-of(B, A)", "¬left-of(B, A)", "left-of(C, D) ∧ left-of(A, M)"])
def test_the_probability_of_what_nothing_ties_to_a_landmark_is_no_number(formula):
    head = "static M. dynamic A, B, C, D. landmark m : M at (0 m, 0 m) facing 0 deg."
    known = qsr.parse_knowledge(f"{head} observe left-of(A, M) ∧ left-of(C, D).")
    assert known.prob("left-of(C, D)").value > 0.9
    with pytest.raises(qsr.UnreachedTargetError, match="no chain of relations ties"):
        known.prob(formula)
    with pytest.raises(qsr.UnreachedTargetError, match="no chain of relations ties"):
        known.prob("left-of(A, M)", given=formula)
