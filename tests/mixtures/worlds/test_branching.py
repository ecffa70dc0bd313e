"""The worlds of trees, beside those that drafts lead to."""

from collections import Counter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.mixtures.worlds.branching import Branching, TreePlans
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.plans import plan_world
from qsrlang.mixtures.worlds.trees import tree_of

NAMES = "ABCDE"
RELATIONS = ("left-of", "right-of", "in-front-of", "behind-of", "wide")
HEAD = (
    "static M, N. dynamic A, B, C, D, E. landmark m : M at (0 m, 0 m) facing -90 deg.\n"
    "landmark n : N at (2 m, 0 m) facing 30 deg ± (2 cm, 2 cm, 3 deg).\n"
    "relation wide(referent, relatum) { angle: uniform(-120 deg, 120 deg), components: 3 }.\n"
)


@st.composite
def trees(draw):
    """Statements that place five things, some of them perhaps elsewhere, and what is asked about."""
    lines = []
    for number, name in enumerate(NAMES):
        relatum = draw(st.sampled_from(["M", "N", *NAMES[:number]]))
        said = draw(st.lists(st.sampled_from(RELATIONS), min_size=1, max_size=3, unique=True))
        weights = [draw(st.integers(1, 3)) for _ in said]
        total = draw(st.sampled_from([0.4, 0.9, 1.0]))
        terms = " | ".join(
            f"{total * weight / sum(weights)!r} :: {one}({name}, {relatum})"
            for weight, one in zip(weights, said, strict=True)
        )
        lines.append(f"believe {terms}{' | elsewhere' if total < 1.0 else ''}.")
    targets = draw(st.lists(st.sampled_from([*NAMES, "M", "n"]), min_size=1, max_size=3, unique=True))
    return HEAD + "\n".join(lines), tuple(targets)


def told(world):
    """What a world says, whatever the order; its weight to 12 digits."""
    said = [(one.referent, one.relatum, one.atoms[0].relation.name, one.part) for one in world.constraints]
    outcomes = Counter((round(share, 12), type(outcome).__name__) for share, outcome in world.decided)
    return (
        round(world.weight, 12),
        tuple(sorted(said)),
        tuple(sorted(world.bindings)),
        tuple(sorted(world.absent)),
        tuple(sorted(outcomes.items())),
    )


@given(trees(), st.booleans(), st.sampled_from([1, 7, 10_000]))
@settings(max_examples=60)
def test_the_worlds_of_a_tree_are_those_that_drafts_lead_to(case, in_parts, limit):
    text, targets = case
    graph = qsr.parse_knowledge(text).graph
    tree = tree_of(graph, targets)
    assert tree is not None
    branching = Branching.of(tree, targets, in_parts)
    found, drafted = (
        branching.worlds(limit),
        enumerate_worlds(graph, *targets, limit=limit, in_parts=in_parts),
    )
    assert len(found) == len(drafted)
    if limit > len(found):
        assert Counter(map(told, found)) == Counter(map(told, drafted))
        assert found.dropped == pytest.approx(drafted.dropped, abs=1e-9)
    plans = TreePlans(graph, branching, ())
    for world in found:
        mine, theirs = plans.of(world), plan_world(graph, world, *targets)
        assert set(mine.constraints) == set(theirs.constraints)
        assert {name: mine.seats[name] for name in mine.seats} == dict(theirs.seats)
        assert set(mine.landmarks) == set(theirs.landmarks)


@given(trees(), st.integers(1, 20))
@settings(max_examples=30)
def test_likelier_choices_come_first(case, limit):
    text, targets = case
    graph = qsr.parse_knowledge(text).graph
    branching = Branching.of(tree_of(graph, targets), targets, False)
    whole, some = branching.worlds(10_000), branching.worlds(limit)
    assert some.worlds == whole.worlds[:limit]
    assert sum(world.weight for world in some) + some.dropped == pytest.approx(1.0, abs=1e-6)
