"""Proofs: their numbers are those of `where` and `prob`."""

import math
from dataclasses import replace

import numpy as np
import pytest
from generated_knowledge import MAKERS, generate
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr

bases = st.builds(generate, st.sampled_from(sorted(MAKERS)), st.integers(0, 30))
DESK = qsr.load("office/desk").with_landmarks("monitor-1 : Monitor at (0 m, 0 m) facing -90 deg")


def asked(base):
    viewer = None if base.viewer is None else qsr.Pose2(*base.viewer)
    return qsr.parse_knowledge(base.text), {"given": base.given, "viewer": viewer, "samples": 500}


def assert_it_adds_up(explanation):
    """Product of shares = prior, prior x evidence = weight, weights sum to 1, heaviest first."""
    for proof in explanation.proofs:
        assert proof.prior == pytest.approx(math.prod(reason.share for reason in proof.reasons))
        assert proof.prior * proof.evidence == pytest.approx(proof.weight, rel=1e-9)
        assert 0.0 <= proof.value <= 1.0 + 1e-9
    weights = [proof.weight for proof in explanation.proofs]
    assert sum(weights) == pytest.approx(1.0, abs=1e-9)
    assert weights == sorted(weights, reverse=True)


@given(bases)
@settings(max_examples=50)
def test_the_proof_of_a_probability_sums_to_it(base):
    known, how = asked(base)
    explanation, answer = known.explain(base.events[0], **how), known.prob(base.events[0], **how)
    assert_it_adds_up(explanation)
    total = sum(proof.weight * proof.value for proof in explanation.proofs)
    assert total == pytest.approx(answer.value, abs=1e-9)
    assert explanation.answer.value == pytest.approx(answer.value, abs=1e-12)
    assert replace(explanation.answer, value=answer.value) == answer
    assert explanation.assumed == answer.assumed


@given(bases)
@settings(max_examples=50)
def test_the_proofs_of_a_place_are_its_components(base):
    known, how = asked(base)
    explanation, answer = known.explain(base.target, **how), known.where(base.target, **how)
    assert_it_adds_up(explanation)
    placing = [proof for proof in explanation.proofs if proof.spot is not None]
    rest = sum(proof.weight for proof in explanation.proofs if proof.spot is None)
    assert answer.elsewhere == pytest.approx(rest, abs=1e-9)
    assert all(proof.value == 1.0 for proof in placing)
    if len(placing) <= 64:
        weights = [one.weight for one in answer.components]
        assert [proof.weight for proof in placing] == pytest.approx(weights, abs=1e-9)
    mean, _ = answer.mixture.moments()
    total = sum(proof.weight * proof.spot.mean for proof in placing)
    np.testing.assert_allclose(total / (1.0 - answer.elsewhere), mean, atol=1e-8)


def test_a_proof_names_statements_with_their_lines_and_places_of_the_chain():
    best = DESK.explain("Bottle").proofs[0]
    texts = [text for reason in best.reasons for text in reason.texts]
    assert any("office/desk.qsr:27: observe 85 × right-of(Cup, Keyboard)" in text for text in texts)
    spots = {spot.name: spot.mean for reason in best.reasons for spot in reason.spots}
    assert set(spots) == {"Keyboard", "Cup", "Bottle"}
    np.testing.assert_allclose(spots["Cup"], DESK.where("Cup").means[0], atol=1e-9)


def test_what_is_elsewhere_and_parts_of_components_are_reasons():
    text = """
        static M. dynamic A. relation wide(a, b) { angle: normal(0 deg, 60 deg), components: 3 }.
        landmark m : M at (0 m, 0 m) facing 0 deg. believe 0.7 :: wide(A, M) | elsewhere.
    """
    explanation = qsr.parse_knowledge(text).explain("A")
    assert [round(proof.weight, 9) for proof in explanation.proofs] == [0.3, *[round(0.7 / 3, 9)] * 3]
    shown = str(explanation)
    assert "A elsewhere" in shown
    assert all(f"part {number} of 3" in shown for number in (1, 2, 3))


def test_a_long_proof_is_cut_and_says_by_how_much():
    names = "ABCDE"
    links = "".join(
        f"believe 0.6 :: left-of({one}, {to}) | 0.4 :: right-of({one}, {to})."
        for to, one in zip("M" + names, names, strict=False)
    )
    text = f"static M. dynamic {', '.join(names)}. landmark m : M at (0 m, 0 m) facing 0 deg. {links}"
    explanation = qsr.parse_knowledge(text).explain("E")
    assert len(explanation.proofs) == 32
    rest = sum(proof.weight for proof in explanation.proofs[12:])
    assert str(explanation).splitlines()[-1] == f"└─ 20 more worlds, together {rest:.3f}"


def test_an_explanation_is_plain_data():
    data = DESK.explain("right-of(Cup, Keyboard)").to_json()
    assert data["answer"]["probability"] == pytest.approx(0.85, abs=1e-3)
    assert sum(proof["weight"] * proof["value"] for proof in data["proofs"]) == pytest.approx(
        data["answer"]["probability"]
    )
    assert {"share", "statements", "places"} == set(data["proofs"][0]["reasons"][0])


@pytest.mark.parametrize(
    ("subject", "error"),
    [("Cupp", "did you mean 'Cup'"), ("left-of(Cup)", "arguments"), ("left-of(Cup", "Q1"), ("", "unknown")],
)
def test_what_cannot_be_explained_is_told(subject, error):
    with pytest.raises(qsr.QSRError, match=error):
        DESK.explain(subject)
