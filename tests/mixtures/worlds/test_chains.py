"""Chains that end nowhere, or run in a circle, are errors that say so."""

import pytest

import qsrlang as qsr
from qsrlang.mixtures.worlds.chains import broken_chains, circle_of

HEAD = "static M, N. dynamic A, B, C, D. "
PLACED = "landmark m : M at (0 m, 0 m) facing 0 deg. "
TWO = "observe left-of(A, B). observe right-of(B, A)."
LATER = "observe left-of(A, B). observe left-of(B, C). observe left-of(C, D). observe left-of(D, B)."
CIRCLES = [(TWO, "A - B - A"), (LATER, "B - C - D - B")]


@pytest.mark.parametrize(("text", "circle"), CIRCLES)
@pytest.mark.parametrize("landmark", ["", PLACED])
@pytest.mark.parametrize("query", ["where A?", "explain A?", "prob left-of(A, B)?", "sample A 2?"])
def test_a_circle_without_a_landmark_is_an_error_that_prints_it(text, circle, landmark, query):
    with pytest.raises(qsr.UnreachedTargetError) as raised:
        qsr.parse_knowledge(HEAD + landmark + text).ask(query)
    assert f"{circle} is a circle without a landmark" in str(raised.value)
    assert str(raised.value).count("is a circle") == 1


def test_a_circle_is_printed_though_one_of_its_chains_comes_to_a_landmark():
    known = qsr.parse_knowledge(HEAD + PLACED + "observe between(A, M, B). observe left-of(B, A).")
    with pytest.raises(qsr.UnreachedTargetError, match="A - B - A is a circle without a landmark"):
        known.where("A")


@pytest.mark.parametrize("text", [TWO, LATER])
def test_a_circle_with_a_landmark_is_none(text):
    known = qsr.parse_knowledge(f"{HEAD}{PLACED}{text} observe left-of(B, M).")
    assert known.where("A").means.shape[1] == 2


def test_chains_that_end_are_no_circles():
    graph = qsr.parse_knowledge(HEAD + "observe left-of(A, B). observe left-of(A, C).").graph
    assert circle_of(graph, "A") == ()
    assert broken_chains(graph, "A") == (
        "A - B ends at B, which has no landmark",
        "A - C ends at C, which has no landmark",
    )
    assert broken_chains(graph, "D") == ()


def test_what_hangs_on_no_landmark_is_asked_relative_to_what_it_hangs_on():
    """Though a landmark is known that has nothing to do with it."""
    known = qsr.parse_knowledge(f"{HEAD}{PLACED} observe left-of(A, N).")
    assert known.prob("left-of(A, N)").value == pytest.approx(1.0, abs=1e-3)
    assert known.sample("A", 3).positions.shape == (3, 2, 2)
    with pytest.raises(qsr.UnreachedTargetError, match="A - N ends at N, which has no landmark"):
        known.where("A")
