"""Answers as a person reads them."""

import re
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

import qsrlang as qsr
from qsrlang.cli.answers import print_answer

DESK = qsr.load("office/desk")
PLACED = DESK.with_landmarks("monitor-1 : Monitor at (0 m, 0 m) facing -90 deg")
FUSED = qsr.parse_knowledge("""
static Monitor { front: yes }. static Lamp { front: yes }. dynamic Cup.
landmark m : Monitor at (-15 cm, 25 cm) facing -90 deg.
landmark l : Lamp at (62 cm, 25 cm) facing -90 deg.
believe 60 % :: in-front-of(Cup, Monitor) | 40 % :: right-of(Cup, Monitor).
believe 70 % :: left-of(Cup, Lamp) | 20 % :: in-front-of(Cup, Lamp).
""")
QUERIES = (
    "where Cup?",
    "explain Cup?",
    "explain right-of(Cup, Keyboard)?",
    "landmarks Cup?",
    "sample Cup 40?",
)


def shown(answer):
    console = Console(file=StringIO(), width=120)
    print_answer(answer, console, "title")
    return console.file.getvalue()


@pytest.mark.parametrize("known", [DESK, PLACED], ids=["relative", "map"])
@pytest.mark.parametrize("query", QUERIES)
def test_no_zero_has_a_sign(known, query):
    answer = known.ask(query)
    assert not re.search(r"-0\.0+\b", shown(answer) + str(answer))


@pytest.mark.parametrize("query", ["where Cup?", "explain Cup?", "sample Cup 3?"])
def test_an_answer_about_places_says_its_frame(query):
    assert "frame: map" in shown(PLACED.ask(query))
    assert "frame: Monitor at the origin" in shown(DESK.ask(query))
    assert DESK.sample("Cup", 3).to_json()["frame"] == "Monitor"


def test_weights_that_are_explained_are_those_of_where():
    told, where = FUSED.explain("Cup"), FUSED.where("Cup")
    placed = [proof for proof in told.proofs if proof.spot]
    np.testing.assert_allclose([proof.weight for proof in placed], where.weights * (1.0 - where.elsewhere))
    np.testing.assert_allclose([proof.spot.mean for proof in placed], where.means)
    assert sum(proof.weight for proof in told.proofs) == pytest.approx(1.0)
    for proof in told.proofs:
        assert proof.weight == pytest.approx(proof.prior * proof.evidence)


def test_weights_and_shares_that_are_explained_make_the_probability():
    for formula in ("right-of(Cup, Monitor)", "left-of(Cup, Lamp) ∧ right-of(Cup, Monitor)"):
        told = FUSED.explain(formula)
        assert told.answer.value == FUSED.prob(formula).value
        assert told.answer.value == pytest.approx(sum(one.weight * one.value for one in told.proofs))


def test_a_fused_place_stands_below_the_last_statement_that_tells_of_it():
    lines = shown(FUSED.explain("Cup")).splitlines()
    branches = [at for at, line in enumerate(lines) if line[:2] in ("├─", "└─")]
    assert [lines[at][0] for at in branches] == ["├"] * (len(branches) - 1) + ["└"]
    first = lines[branches[0] + 1 : branches[1]]
    assert [line for line in first if "Cup at" in line] == first[-1:]


def test_evidence_is_told_where_it_weighs():
    assert "× evidence" in shown(FUSED.explain("Cup"))
    assert "evidence" not in shown(PLACED.explain("Cup"))
