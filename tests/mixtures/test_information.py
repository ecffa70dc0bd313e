"""What landmarks tell of a target, beside closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr

FIT = "wrt absolute ~ normal(({} m, 0 m), ({} m, {} m), 0)."


def fit(referent, relatum, spread, ahead=1.0):
    return f"observe behind-of({referent}, {relatum}) " + FIT.format(ahead, spread, spread)


def values(text, target):
    ranking = qsr.parse_knowledge(text).rank_landmarks(target)
    return {one.name: one for one in ranking.landmarks}, ranking


@given(st.floats(0.05, 0.5), st.floats(0.05, 0.5), st.floats(0.05, 0.5))
@settings(max_examples=15)
def test_a_gaussian_chain_tells_what_the_closed_form_says(place, first, second):
    """I(A; B) = log2(1 + var(A) / var(B | A)) in the plane, where B = A + noise; within 5 standard errors."""
    text = f"""static M. dynamic A, B.
        landmark m : M at (0 m, 0 m) facing 0 deg ± ({100 * place:.3f} cm, {100 * place:.3f} cm, 0 deg).
        {fit("A", "M", f"{first:.5f}")} {fit("B", "A", f"{second:.5f}")}"""
    found, _ = values(text, "B")
    for name, variance, noise in (
        ("A", place**2 + first**2, second**2),
        ("M", place**2, first**2 + second**2),
    ):
        one = found[name]
        expected = math.log2(1.0 + variance / noise)
        assert abs(one.information - expected) < 5.0 * one.standard_error + 2e-3
        assert one.through == 1.0
    assert found["A"].information > found["M"].information - 0.1, (
        "what is passed on is not more than what was told"
    )


def test_a_certain_landmark_tells_nothing_more():
    found, _ = values(
        f"static M. dynamic A. landmark m : M at (1 m, 0 m) facing 0 deg. {fit('A', 'M', 0.1)}", "A"
    )
    assert found["M"].information == pytest.approx(0.0, abs=1e-3)
    assert found["M"].through == 1.0


@pytest.mark.parametrize(("count", "bits"), [(2, 1.0), (4, 2.0)])
def test_candidates_far_apart_tell_as_many_bits_as_tell_them_apart(count, bits):
    marks = "".join(f"landmark m{at} : M at ({10 * at} m, 0 m) facing 0 deg. " for at in range(count))
    found, _ = values(f"static M. dynamic A. {marks} {fit('A', 'M', 0.1)}", "A")
    one = found["M"]
    assert abs(one.information - bits) < 5.0 * one.standard_error + 0.01


def test_a_landmark_through_which_less_goes_has_its_share():
    text = """static M, N. dynamic A. landmark m : M at (0 m, 0 m) facing 0 deg.
        landmark n : N at (5 m, 0 m) facing 0 deg.
        believe 0.7 :: left-of(A, M) | 0.3 :: left-of(A, N)."""
    found, _ = values(text, "A")
    assert found["M"].through == pytest.approx(0.7)
    assert found["N"].through == pytest.approx(0.3)
    assert found["M"].ratio == pytest.approx(found["M"].through / found["M"].entropy)


def test_without_landmarks_the_nearer_thing_tells_the_most():
    found, ranking = values(f"static M. dynamic A, B. {fit('A', 'M', 0.2)} {fit('B', 'A', 0.1)}", "B")
    assert [one.name for one in ranking.landmarks] == ["A", "M"]
    entropies = [one.entropy for one in ranking.landmarks]
    assert entropies == sorted(entropies)
    for name, variance in (("A", 0.01), ("M", 0.05)):
        bits = math.log2(2.0 * math.pi * math.e * variance / 0.05**2)
        assert found[name].entropy == pytest.approx(bits, abs=1e-3)
        assert found[name].information == pytest.approx(math.log2(25.0 / 0.05**2) - bits, abs=1e-3)
    assert "no landmark known" in str(ranking)


def test_a_ranking_repeats_and_is_plain_data():
    known = qsr.load("office/desk").with_landmarks(
        "m : Monitor at (0 m, 0 m) facing 0 deg ± (5 cm, 5 cm, 5 deg)"
    )
    one, other = (known.rank_landmarks("Bottle", rng=np.random.default_rng(1)) for _ in range(2))
    assert one == other
    data = one.to_json()
    assert data["target"] == "Bottle"
    bits = [item["information"] for item in data["landmarks"]]
    assert bits == sorted(bits, reverse=True)
    assert {item["name"] for item in data["landmarks"]} == {"Cup", "Keyboard", "Monitor"}


def test_what_nothing_places_has_no_landmarks():
    known = qsr.parse_knowledge("static M. dynamic A.")
    with pytest.raises(qsr.UnreachedTargetError, match="no statement places A"):
        known.rank_landmarks("A")
    with pytest.raises(qsr.UnknownNameError, match="'Nothing'"):
        known.rank_landmarks("Nothing")
