"""Draws inside of bounds, beside draws of everything of which most is thrown away."""

import numpy as np
import pytest

import qsrlang as qsr
from qsrlang.mixtures.draws import bounding, conditioning
from qsrlang.mixtures.draws.conditions import conditions_on
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.plans import plan_world

TABLE = """
surface T { size: 120 cm × 80 cm }. static M { front: yes }.
dynamic A { size: 6 cm × 8 cm }, B { size: 6 cm × 8 cm }, C { size: 6 cm × 8 cm }.
landmark t : T at (1 m, 2 m) facing 25 deg.
landmark m : M at (1.2 m, 2.1 m) facing -40 deg ± (1 cm, 1 cm, 4 deg).
observe on(A, T). observe on(B, T). observe on(C, T).
"""
GIVEN = {
    "one side": "left-of(A, M)",
    "of each other": "left-of(A, B) ∧ behind-of(C, A)",
    "a circle": "left-of(A, B) ∧ behind-of(B, C) ∧ left-of(A, C)",
    "by its own left": "left-of(A, M) wrt intrinsic ∧ right-of(B, A) wrt absolute",
    "with a distance": "left-of(A, M) ∧ close-to(A, M)",
    "near each other": "close-to(A, B) ∧ close-to(C, A)",
    "not": "¬left-of(A, M) ∧ right-of(A, B)",
}


@pytest.mark.parametrize("name", GIVEN)
@pytest.mark.parametrize("viewer", [None, qsr.Pose2(-1.0, 0.5)])
def test_bounds_give_what_rejection_gives(name, viewer, monkeypatch):
    """Means of every object within 5 standard errors of those of some thousand draws."""
    known = qsr.parse_knowledge(TABLE)

    def means():
        return [
            known.where(one, given=GIVEN[name], samples=30_000, rng=np.random.default_rng(2), viewer=viewer)
            for one in "ABC"
        ]

    inside = means()
    monkeypatch.setattr(conditioning, "bounds_of", lambda graph, world, plan, parts, seen: ({}, parts))
    for one, other in zip(inside, means(), strict=True):
        (mean, covariance), (expected, spread) = one.mixture.moments(), other.mixture.moments()
        error = np.sqrt(np.diag(spread) * (1.0 / one.draws + 1.0 / other.draws))
        assert (np.abs(mean - expected) < 5.0 * error + 1e-4).all()
        np.testing.assert_allclose(covariance, spread, atol=10.0 * np.trace(spread) / np.sqrt(other.draws))
        assert one.draws > 0.9 * other.draws


def planned(given):
    graph = qsr.parse_knowledge(TABLE).graph
    conditions = bounding.conjuncts(conditions_on(graph, ("A", "B", "C"), qsr.parse_formula(given)))
    (world,) = enumerate_worlds(graph, "A", "B", "C", "M")
    plan = plan_world(graph, world, "A", "B", "C", "M")
    return graph, world, plan, conditions


@pytest.mark.parametrize("name", GIVEN)
def test_plans_in_another_order_place_the_same_things(name):
    graph, world, plan, conditions = planned(GIVEN[name])
    ordered = bounding.tightest_first(graph, world, plan, conditions)
    assert set(ordered.steps) == set(plan.steps)
    assert ordered.layout is plan.layout
    if name == "one side":
        assert ordered.steps[0].referent.block == "A", "the only one with a condition on what is known"


def test_what_is_no_wedge_remains_a_condition():
    for name, inside, remaining in (
        ("one side", 1, 0),
        ("with a distance", 1, 1),
        ("not", 1, 1),
        ("a circle", 3, 0),
    ):
        graph, world, plan, conditions = planned(GIVEN[name])
        found, rest = bounding.bounds_of(graph, world, plan, conditions, None)
        assert (sum(map(len, found.values())), len(rest)) == (inside, remaining)


def test_a_conjunction_falls_into_its_parts_only_where_it_holds_for_sure():
    text = TABLE + "require left-of(A, M) ∧ left-of(B, M). require 0.7 :: left-of(A, M) ∧ left-of(C, M)."
    found = bounding.conjuncts(conditions_on(qsr.parse_knowledge(text).graph, ("A",), None))
    assert sorted(one.share is None for one in found) == [False, True, True]
