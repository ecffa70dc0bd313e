"""Slips people make are mended as the help says."""

from pathlib import Path

import pytest

from qsrlang.language.fixing import edited
from qsrlang.language.parser import parse
from qsrlang.language.remedies import remedy
from qsrlang.language.slips import LOOK_ALIKES, SIGNS, WORDS, Slip
from qsrlang.language.source import Source, Span, read_source
from qsrlang.relations.build import build_graph

REJECTED = sorted((Path(__file__).parents[1] / "corpus" / "rejected").glob("*.qsr"))

MENDED = {
    "scene(A, B) == left-of(A, B).": "scene(A, B) ⇔ left-of(A, B).",
    "scene(A, B) :- left-of(A, B).": "scene(A, B) ⇔ left-of(A, B).",
    "scene(A, B): left-of(A, B).": "scene(A, B)⇔ left-of(A, B).",
    "observe -left-of(A, B).": "observe ¬left-of(A, B).",
    "observe left-of(A, B) && on(A, B).": "observe left-of(A, B) & on(A, B).",
    "observe left-of(A, B) || on(A, B).": "observe left-of(A, B) ∨ on(A, B).",
    "observe left-of(A, B) /\\ on(A, B).": "observe left-of(A, B) ∧ on(A, B).",
    "observe left-of(A, B), on(A, B).": "observe left-of(A, B) ∧ on(A, B).",
    "observe left-of(A, B) on(A, B).": "observe left-of(A, B) ∧ on(A, B).",
    "observe left-of(A, B)).": "observe left-of(A, B).",
    "observe 3 left-of(A, B).": "observe 3 × left-of(A, B).",
    "believe 0.3 : left-of(A, B).": "believe 0.3 :: left-of(A, B).",
    "believe left-of(A, B) || on(A, B).": "believe left-of(A, B) | on(A, B).",
    "static A { front: true }.": "static A { front: yes }.",
    "static A { front = no }.": "static A { front : no }.",
    "static A { size: 3 metres × 2 m }.": "static A { size: 3 m × 2 m }.",
    "static A { hieght: 3 m }.": "static A { height: 3 m }.",
    "Static A.": "static A.",
    "static A static B.": "static A . static B.",
    "landmark a : A at [1 m, 2 m).": "landmark a : A at (1 m, 2 m).",
    "landmark a : A at (1 m, 2 m) facing 90°.": "landmark a : A at (1 m, 2 m) facing 90 deg.",
    "import office/desk.": 'import "office/desk".',
    "// a note\nstatic A.": "# a note\nstatic A.",
    "in lab { believe on(A, B). }": "in room lab { believe on(A, B). }",
    "in from 8 to 12:00 { believe on(A, B). }": "in from 08:00 to 12:00 { believe on(A, B). }",
}


@pytest.mark.parametrize(("wrong", "right"), MENDED.items(), ids=MENDED)
def test_a_slip_is_mended(wrong, right):
    finding = parse(wrong).diagnostics[0]
    assert finding.code == "Q101"
    assert finding.help
    assert edited(wrong, finding.edits) == right
    assert parse(right).diagnostics == ()


ADVICE = {
    "left-of(A, B).": "say how it is known: 'observe left-of(…)' or 'believe left-of(…)'",
    "in(A, B).": "say how it is known: 'observe in(…)' or 'believe in(…)'",
    "observe A left-of B.": "the relation comes first: left-of(A, B)",
    "observe A on B.": "the relation comes first: on(A, B)",
    "believe A.": "a relation needs its arguments: A(referent, relatum)",
    "scene s ⇔ left-of(A, B).": "a scene lists its members: scene s(Plate, Cup) ⇔ …",
    "observe left-of(A, B) ∧ elsewhere.": "'elsewhere' can only be an alternative of 'believe'",
    "believe left-of(A, B), on(A, B).": "write '∧' between what holds together, '|' between alternatives",
    "believe left-of(A, B) :: 30 %.": "the share comes first: '30 % :: …'",
    "observe 30 % :: left-of(A, B).": "an observation is counted: 'observe 85 × …'; shares belong to 'believe'",
    "observe left-of(A, B) | on(A, B).": "write '∨'; '|' separates the alternatives of 'believe'",
    "observe left-of(A, B.": "close the parenthesis",
    "static A { height: 3 m.": "close the brace",
    "static A {}.": "leave the braces out",
    "static Coffee Machine.": "two names have ',' between them; one name is written together: 'Coffee-Machine'",
    "static 3D-Printer.": "a name begins with a letter and holds letters, digits, '_' and inner '-'",
    "static Chef's-Knife.": "a name begins with a letter and holds letters, digits, '_' and inner '-'",
    "landmark a : A at (1 m, 2 m) facing north.": (
        "a heading is an angle, counter-clockwise from the map's +x, such as 'facing 90 deg'"
    ),
    "landmark a : A at 1 m, 2 m.": "write all values in parentheses, such as (1.2 m, 3 m)",
    "observe left-of(A, B) wrt B.": "'wrt' names the frame of reference; the relatum is an argument of the relation",
    "in room lab believe left-of(A, B).": "a context has its statements in braces: in room kitchen { … }",
    'import "a.': "close the quotes on the same line",
}


@pytest.mark.parametrize(("wrong", "advice"), ADVICE.items(), ids=ADVICE)
def test_a_slip_that_only_its_writer_can_mend_is_advised_on(wrong, advice):
    finding = parse(wrong).diagnostics[0]
    assert (finding.code, finding.help) == ("Q101", advice)
    assert not finding.edits or not finding.sure


@pytest.mark.parametrize("hours", ["²", "25", "123", "8h", "-8"])
def test_what_is_no_hour_is_not_taken_for_one(hours):
    (finding, *_) = parse(f"in from {hours} to 12:00 {{ believe on(A, B). }}").diagnostics
    assert (finding.code, finding.edits) == ("Q101", ())


@pytest.mark.parametrize("path", REJECTED, ids=lambda path: path.stem)
def test_the_edits_of_a_finding_mend_it(path):
    source = read_source(path)
    for finding in build_graph(source).diagnostics:
        if finding.edits and finding.span.source is source:
            after = build_graph(
                Source(source.name, edited(source.text, finding.edits), source.path)
            ).diagnostics
            assert (finding.code, finding.message, finding.span.start) not in [
                (one.code, one.message, one.span.start) for one in after
            ], finding.render()


@pytest.mark.parametrize("sign", LOOK_ALIKES)
def test_signs_that_look_alike_are_named(sign):
    slip = slip_of(f"dynamic Cup {sign}", sign, frozenset())
    assert remedy(slip).help == f"write '{LOOK_ALIKES[sign]}'"


@pytest.mark.parametrize(("sign", "terminal", "right"), SIGNS)
def test_signs_of_other_languages_are_translated(sign, terminal, right):
    found = remedy(slip_of(f"dynamic Cup {sign} x", sign, frozenset({terminal})))
    assert right.strip() in found.help


@pytest.mark.parametrize("word", WORDS)
def test_words_of_other_languages_are_translated(word):
    terminal, right = WORDS[word]
    assert remedy(slip_of(f"dynamic Cup {word}", word, frozenset({terminal}))).edits[0].text == right


def slip_of(text, word, accepted):
    source = Source("<slip>", text)
    start = text.index(word, 12)
    return Slip(Span(source, start, start + len(word)), word, accepted, Span(source, 0, len(text)))
