import pytest

import qsrlang as qsr
from qsrlang.language.source import Source
from qsrlang.language.statements import Period
from qsrlang.relations.build import build_graph
from qsrlang.relations.contexts import Circumstances, compatible, matches, minutes_of, more_specific

DESK = "static Monitor { front: yes }. dynamic Keyboard, Cup. "
RIGHT = "believe right-of(Keyboard, Monitor)."
LEFT = "believe left-of(Keyboard, Monitor)."


def contexts(*conditions):
    text = "".join(f"in {condition} {{ believe a(B, C). }}\n" for condition in conditions)
    parsed = qsr.parse(text)
    assert parsed.diagnostics == ()
    return parsed.document.statements


def said(text, **circumstances):
    """Which relations between keyboard and monitor hold."""
    built = build_graph(Source("<text>", DESK + text), Circumstances(**circumstances))
    assert built.diagnostics.errors == ()
    constraints = [c for choice in built.graph.choices for a in choice.alternatives for c in a.constraints]
    return {c.atoms[0].relation.name for c in constraints if c.referent == "Keyboard"}


def codes(text):
    return [finding.code for finding in build_graph(Source("<text>", DESK + text)).diagnostics]


@pytest.mark.parametrize(
    ("condition", "circumstances", "holds"),
    [
        ("room a", {"room": "a"}, True),
        ("room a", {"room": "b"}, False),
        ("room a", {}, False),
        ("weekend", {"weekend": True}, True),
        ("weekday", {"weekend": True}, False),
        ("weekday", {}, False),
        ("from 08:00 to 12:00", {"minutes": 8 * 60}, True),
        ("from 08:00 to 12:00", {"minutes": 12 * 60}, False),
        ("from 22:00 to 06:00", {"minutes": 23 * 60}, True),
        ("from 22:00 to 06:00", {"minutes": 5 * 60 + 59}, True),
        ("from 22:00 to 06:00", {"minutes": 6 * 60}, False),
        ("from 20:00 to 24:00", {"minutes": 24 * 60 - 1}, True),
        ("from 08:00 to 12:00", {}, False),
        ("room a, weekday, from 08:00 to 12:00", {"room": "a", "weekend": False, "minutes": 540}, True),
        ("room a, weekday, from 08:00 to 12:00", {"room": "a", "weekend": True, "minutes": 540}, False),
    ],
)
def test_a_context_matches_where_all_its_conditions_are_known_to_hold(condition, circumstances, holds):
    (context,) = contexts(condition)
    assert matches(context, Circumstances(**circumstances)) == holds


def test_periods_are_half_open_and_may_wrap_midnight():
    (context,) = contexts("from 23:00 to 01:00")
    (period,) = context.conditions
    assert isinstance(period, Period)
    assert len(minutes_of(period)) == 120
    assert {0, 59, 23 * 60} <= minutes_of(period)
    assert 60 not in minutes_of(period)


def test_more_conditions_are_more_specific_and_a_shorter_period_is():
    room, both, short, long, other = contexts(
        "room a", "room a, weekday", "from 09:00 to 10:00", "from 08:00 to 12:00", "room b"
    )
    assert more_specific(both, room)
    assert not more_specific(room, both)
    assert more_specific(short, long)
    assert not more_specific(room, long)
    assert not more_specific(long, room)
    assert not compatible((*room.conditions, *other.conditions))
    assert compatible((*room.conditions, *long.conditions))


def test_the_most_specific_context_wins_and_the_rest_comes_from_the_less_specific():
    text = (
        f"{RIGHT} observe left-of(Cup, Keyboard). in room a {{ {LEFT} }} "
        "in room a, weekend { observe behind-of(Keyboard, Monitor). }"
    )
    assert said(text) == {"right-of"}
    assert said(text, room="b") == {"right-of"}
    assert said(text, room="a") == {"left-of"}
    assert said(text, room="a", weekend=True) == {"behind-of"}, (
        "counts win over a share that is less specific"
    )
    built = build_graph(Source("<text>", DESK + text), Circumstances(room="a"))
    assert ("Cup", "Keyboard") in {pair for choice in built.graph.choices for pair in choice.governs}
    assert {pair for choice in built.under(Circumstances()).choices for pair in choice.governs} == {
        ("Cup", "Keyboard"),
        ("Keyboard", "Monitor"),
    }


def test_equally_specific_contexts_on_one_pair_are_an_error_that_shows_both():
    text = f"in room a {{ {RIGHT} }}\nin from 08:00 to 12:00 {{ {LEFT} }}"
    findings = build_graph(Source("<text>", DESK + text)).diagnostics
    (finding,) = findings
    assert (finding.code, finding.span.text) == ("Q409", "in from 08:00 to 12:00")
    assert [label.span.text for label in finding.labels] == ["in room a"]
    assert codes(f"in room a {{ {RIGHT} }} in room a {{ {LEFT} }}") == ["Q409"]


def test_contexts_that_exclude_each_other_or_speak_of_other_pairs_are_no_rivals():
    assert codes(f"in room a {{ {RIGHT} }} in room b {{ {LEFT} }}") == []
    assert codes(f"in weekend {{ {RIGHT} }} in weekday {{ {LEFT} }}") == []
    assert codes(f"in from 08:00 to 12:00 {{ {RIGHT} }} in from 12:00 to 13:00 {{ {LEFT} }}") == []
    assert codes(f"in room a {{ {RIGHT} }} in weekend {{ believe left-of(Cup, Monitor). }}") == []


def test_a_context_with_the_conditions_of_both_settles_what_rivals_say():
    both = "in room a, from 08:00 to 12:00 { believe behind-of(Keyboard, Monitor). }"
    text = f"in room a {{ {RIGHT} }} in from 08:00 to 12:00 {{ {LEFT} }} {both}"
    assert codes(text) == []
    assert said(text, room="a", minutes=540) == {"behind-of"}
    assert said(text, room="a", minutes=0) == {"right-of"}


def test_statements_inside_a_context_are_checked_though_it_does_not_match():
    assert codes("in room a { believe left_of(Keyboard, Monitor). }") == ["Q203"]
    assert codes(f"in room a {{ {RIGHT} {LEFT} }}") == ["Q403"]


def test_a_scene_inside_a_context_may_be_observed_there():
    text = "in room a { scene s(Keyboard, Monitor) ⇔ left-of(Keyboard, Monitor). observe 3 × s. }"
    assert said(text, room="a") == {"left-of"}
    assert said(text) == set()


def test_requirements_hold_in_their_context():
    built = build_graph(
        Source(
            "<text>",
            DESK + "require ¬close-to(Cup, Keyboard). in room a { require 0.9 :: left-of(Cup, Monitor). }",
        )
    )
    assert [one.share for one in built.graph.requirements] == [None]
    assert [one.share for one in built.under(Circumstances(room="a")).requirements] == [None, 0.9]
