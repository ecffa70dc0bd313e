"""Questions in the language: what is answered, what is not, and where and when it is asked."""

import numpy as np
import pytest

import qsrlang as qsr
from qsrlang.errors import UnansweredQueryError
from qsrlang.relations.contexts import Circumstances

DAY = """
static M. dynamic Cup, Plate, Fork.
believe left-of(Cup, M).
believe left-of(Fork, M).
believe behind-of(Plate, Cup).
in room r133 { believe right-of(Cup, M). }
in room r133, from 22:00 to 06:00 { believe behind-of(Cup, M). }
in weekend { believe in-front-of(Fork, M). }
"""
KNOWN = qsr.parse_knowledge(DAY).with_landmarks("m : M at (0 m, 0 m) facing -90 deg")
LEFT, RIGHT, BEHIND, FRONT = (-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0)


def side(answer):
    """The direction, of four, in which the only component lies."""
    (mean,) = answer.means
    return tuple(np.sign(np.where(np.abs(mean) > 0.2, mean, 0.0)))


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("where Cup?", LEFT),
        ("where Cup in room r133?", RIGHT),
        ("where Cup in room r134?", LEFT),
        ("where Cup in room r133 at 23:30?", BEHIND),
        ("where Cup in room r133 at 05:59?", BEHIND),
        ("where Cup in room r133 at 06:00?", RIGHT),
        ("where Cup at 23:30?", LEFT),
        ("where Fork in weekend?", FRONT),
        ("where Fork in weekday?", LEFT),
        ("where Fork?", LEFT),
    ],
)
def test_a_query_names_its_circumstances(query, expected):
    assert side(KNOWN.ask(query)) == expected


def test_knowledge_under_circumstances_keeps_its_landmarks():
    there = KNOWN.under(Circumstances(room="r133"))
    assert side(there.where("Cup")) == RIGHT
    assert there.landmarks == KNOWN.landmarks
    assert side(there.under(Circumstances()).where("Cup")) == LEFT


def test_landmarks_that_are_added_later_hold_in_all_circumstances():
    night = Circumstances(room="r133", minutes=23 * 60)
    moved = KNOWN.under(night).with_landmarks("m : M at (9 m, 0 m) facing -90 deg")
    assert moved.under(Circumstances()).where("Cup").means[0][0] > 8.0


def test_a_query_refines_the_circumstances_of_its_knowledge():
    there = KNOWN.under(Circumstances(room="r133"))
    assert side(there.ask("where Cup?")) == RIGHT
    assert side(there.ask("where Cup at 23:00?")) == BEHIND
    assert side(there.ask("where Cup in room r134 at 23:00?")) == LEFT


def test_a_graph_without_its_text_holds_in_all_circumstances():
    bare = qsr.KnowledgeBase(KNOWN.graph)
    assert side(bare.ask("where Cup in room r133?")) == LEFT


def test_what_is_not_said_for_the_circumstances_is_as_it_is_elsewhere():
    answer = KNOWN.ask("where Plate in room r133?")
    assert answer.means[0][0] > 0.3
    assert answer.means[0][1] > 0.3


def test_a_query_answers_as_the_method_does():
    asked = KNOWN.ask("where Plate wrt Cup?")
    told = KNOWN.where("Plate", wrt="Cup")
    assert asked.frame == told.frame == "Cup"
    np.testing.assert_array_equal(asked.means, told.means)
    drawn = [KNOWN.ask("where Plate?", engine="sampling", samples=200, seed=4) for _ in range(2)]
    np.testing.assert_array_equal(drawn[0].means, drawn[1].means)


def test_views_are_of_a_map_which_knowledge_has_none_of():
    with pytest.raises(UnansweredQueryError, match=r"^'views'") as raised:
        KNOWN.ask("views Cup?")
    assert raised.value.verb == "views"
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("query", "message"),
    [
        ("where Cupp?", "unknown class 'Cupp'; did you mean 'Cup'"),
        ("where Cup wrt Plat?", "unknown class 'Plat'; did you mean 'Plate'"),
        ("where left: Cup?", "unknown role 'left: Cup'"),
        ("where Cup given left-of(Cup, m-1)?", "unknown class 'm-1'"),
        ("prob left-off(Cup, M)?", "unknown relation 'left-off'; did you mean 'left-of'"),
        ("prob left-of(Cup, M) and behind-of(Cop, M)?", "unknown class 'Cop'; did you mean 'Cup'"),
        ("explain Plates?", "did you mean 'Plate'"),
        ("explain left-of(Cup, Plates)?", "did you mean 'Plate'"),
        ("views Plates?", "did you mean 'Plate'"),
        ("landmarks Plates?", "did you mean 'Plate'"),
    ],
)
def test_names_in_queries_are_checked(query, message):
    with pytest.raises(qsr.UnknownNameError, match=message):
        KNOWN.ask(query)


@pytest.mark.parametrize(
    ("atom", "given", "expected"),
    [("left-of(Cup)", 1, 2), ("between(Cup, M)", 2, 3), ("on(Cup, M, M)", 3, 2)],
)
def test_atoms_in_queries_have_as_many_arguments_as_their_relation(atom, given, expected):
    with pytest.raises(qsr.ValueRangeError, match=f"is {given}; expected {expected}"):
        KNOWN.ask(f"prob {atom}?")


@pytest.mark.parametrize("query", ["landmarks Cup", "check"])
def test_what_cannot_be_given_is_refused(query):
    with pytest.raises(qsr.ValueRangeError, match=f"what is given to '{query.split()[0]}'"):
        KNOWN.ask(f"{query} given left-of(Plate, Cup)?")


def test_a_landmark_is_no_class():
    with pytest.raises(qsr.UnknownNameError, match="unknown class 'm'"):
        KNOWN.with_landmarks("n : m at (0 m, 0 m)")


def test_what_is_shown_of_knowledge_is_not_all_it_was_built_from():
    assert "Document" not in repr(KNOWN)


def test_scenes_are_drawn_of_what_is_known():
    named = qsr.parse_knowledge("dynamic A, B. scene pair(A, B) ⇔ left-of(A, B).")
    for query, names, count in (
        ("sample pair 3?", ("A", "B"), 3),
        ("sample A?", ("A", "B"), 1),
        ("sample?", ("A", "B"), 1),
    ):
        scenes = named.ask(query)
        assert scenes.names == names
        assert scenes.positions.shape == (count, 2, 2)
    with pytest.raises(qsr.UnknownNameError, match="unknown scene or class 'pear'; did you mean 'pair'"):
        named.ask("sample pear 3?")
