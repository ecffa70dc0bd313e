"""Worlds: best first, with the mass of those that are dropped, beside a slow product of all alternatives."""

import math
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import qsrlang as qsr
from qsrlang.mixtures.worlds.enumeration import enumerate_worlds
from qsrlang.mixtures.worlds.evidence import telling

SIDES = ("behind-of", "left-of", "in-front-of", "right-of")
NAMES = "ABCD"
seeds = st.integers(0, 2**32 - 1)
HEAD = f"static M, N. dynamic {', '.join(NAMES)}, E. landmark m : M at (0 m, 0 m) facing 0 deg. "


def random_chain(seed):
    """A text, and for each object of a chain its alternatives: (share, side), the rest being elsewhere."""
    rng = np.random.default_rng(seed)
    said, choices = [HEAD], []
    for relatum, name in zip("M" + NAMES, NAMES[: rng.integers(1, 5)], strict=False):
        count = rng.integers(1, 4)
        shares = rng.dirichlet(np.ones(count + 1)).round(3).clip(0.001)[:count]
        sides = rng.permutation(SIDES)[:count]
        parts = [
            f"{share:.3f} :: {side}({name}, {relatum})" for share, side in zip(shares, sides, strict=True)
        ]
        elsewhere = " | elsewhere" if rng.random() < 0.5 else ""
        whole = 1.0 if elsewhere else shares.sum()
        said.append(
            f"believe {' | '.join(parts)}{elsewhere}."
            if elsewhere
            else _certain(name, relatum, shares, sides)
        )
        choices.append([(float(share / whole), str(side)) for share, side in zip(shares, sides, strict=True)])
    return " ".join(said), choices


def _certain(name, relatum, shares, sides):
    """Counted alternatives, whose shares sum to 1."""
    counts = zip((1000 * shares).round().astype(int), sides, strict=True)
    return " ".join(f"observe {count} × {side}({name}, {relatum})." for count, side in counts)


def slow_weights(choices):
    """The weights of all worlds of the last object: every product of alternatives, backwards until one is elsewhere."""
    found = []
    for length in range(len(choices)):
        later = choices[len(choices) - length :]
        rest = 1.0 - sum(share for share, _ in choices[len(choices) - length - 1])
        if rest > 1e-9:
            found += [rest * math.prod(share for share, _ in picks) for picks in product(*later)]
    return sorted([*found, *(math.prod(share for share, _ in picks) for picks in product(*choices))])


@given(seeds)
@settings(max_examples=40)
def test_weights_are_those_of_all_combinations(seed):
    text, choices = random_chain(seed)
    worlds = enumerate_worlds(qsr.parse_knowledge(text).graph, NAMES[len(choices) - 1])
    assert worlds.dropped == pytest.approx(0.0, abs=1e-8)
    np.testing.assert_allclose(sorted(world.weight for world in worlds), slow_weights(choices), atol=1e-9)
    for world in worlds:
        assert math.prod(share for share, _ in world.decided) == pytest.approx(world.weight)


@given(seeds, st.integers(1, 30))
@settings(max_examples=40)
def test_the_limit_is_honoured_and_what_is_dropped_is_told(seed, limit):
    text, choices = random_chain(seed)
    target = NAMES[len(choices) - 1]
    graph = qsr.parse_knowledge(text).graph
    whole, some = enumerate_worlds(graph, target), enumerate_worlds(graph, target, limit=limit)
    assert len(some) == min(limit, len(whole))
    assert sum(world.weight for world in some) + some.dropped == pytest.approx(1.0, abs=1e-8)
    assert [world.weight for world in some] == [world.weight for world in whole][: len(some)]


@given(st.lists(st.lists(st.integers(1, 50), min_size=2, max_size=4), min_size=1, max_size=4))
@settings(max_examples=40)
def test_best_first_where_all_worlds_make_the_same_choices(counts):
    said = [
        f"observe {count} × {side}({name}, {relatum})."
        for relatum, name, given in zip("M" + NAMES, NAMES, counts, strict=False)
        for count, side in zip(given, SIDES, strict=False)
    ]
    graph = qsr.parse_knowledge(HEAD + " ".join(said)).graph
    weights = [world.weight for world in enumerate_worlds(graph, NAMES[len(counts) - 1])]
    assert len(weights) == math.prod(map(len, counts))
    assert all(one >= other - 1e-12 for one, other in pairwise(weights))


@given(st.integers(1, 4), st.integers(1, 4))
@settings(max_examples=16)
def test_parts_of_components_are_worlds_of_equal_weight(first, second):
    relations = "".join(
        f"relation r{at}(a, b) {{ angle: normal(0 deg, 40 deg), components: {count} }}. "
        for at, count in enumerate((first, second))
    )
    graph = qsr.parse_knowledge(f"{relations}{HEAD} observe r0(A, M). observe r1(B, A).").graph
    worlds = enumerate_worlds(graph, "B", in_parts=True)
    assert [world.weight for world in worlds] == pytest.approx([1.0 / (first * second)] * (first * second))
    assert len({tuple(one.part for one in world.constraints) for world in worlds}) == first * second
    assert len(enumerate_worlds(graph, "B")) == 1


def test_what_the_target_does_not_depend_on_is_not_decided():
    text = f"{HEAD} observe left-of(A, M). believe 0.5 :: left-of(B, A) | 0.5 :: right-of(B, A)."
    assert len(enumerate_worlds(qsr.parse_knowledge(text).graph, "A")) == 1


SEEN = "landmark b : B at (1 m, 1 m) facing 0 deg. "
TELLING = [
    ("observe left-of(A, M). observe left-of(B, A).", ()),
    (f"observe left-of(A, M). observe left-of(B, A). {SEEN}", ("B",)),
    (f"observe left-of(A, M). observe left-of(B, C). observe left-of(C, M). {SEEN}", ()),
    (f"observe left-of(A, M). observe left-of(C, A). observe left-of(B, C). {SEEN}", ("B",)),
]


@pytest.mark.parametrize(("text", "expected"), TELLING)
def test_what_is_seen_tells_of_what_it_was_placed_by(text, expected):
    assert telling(qsr.parse_knowledge(HEAD + text).graph, ("A",)) == expected


def test_what_several_others_place_tells():
    graph = qsr.parse_knowledge(f"{HEAD} observe left-of(A, M). observe behind-of(A, N).").graph
    assert telling(graph, ("A",)) == ("A",)
    assert telling(qsr.parse_knowledge(f"{HEAD} observe left-of(A, M).").graph, ("A",)) == ()


def test_an_object_elsewhere_is_not_placed_but_what_is_seen_is():
    text = f"{HEAD} believe 0.4 :: left-of(A, M) | elsewhere. observe left-of(B, A)."
    known = qsr.parse_knowledge(text)
    absent = [world for world in enumerate_worlds(known.graph, "B") if world.absent]
    assert [(world.absent, world.weight) for world in absent] == [(("A",), pytest.approx(0.6))]
    assert known.where("B").elsewhere == pytest.approx(0.6)
    seen = known.with_landmarks("a : A at (1 m, 0 m) facing 0 deg")
    assert seen.where("B").elsewhere == 0.0
