"""What may follow a text that is still being written."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from qsrlang.language.expecting import expected_after
from qsrlang.language.source import Source, Span
from qsrlang.language.splitting import Kind, split

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = sorted((CORPUS / "accepted").glob("*.qsr"))


def after(text, query=False):
    return expected_after(Span(Source("typed", text), 0, len(text)), query)


@pytest.mark.parametrize(
    ("text", "accepted"),
    [
        ("observe 12 ×", {"LPAR", "NAME", "NOT"}),
        ("scene(A, ", {"NAME"}),
        ("in room ", {"NAME"}),
        ("in room a, ", {"DAYS", "FROM", "ROOM"}),
        ("static A { size: 3", {"PERCENT", "TIMES", "UNIT"}),
        ("observe on(A, B) # comment", {"$END", "AND", "OR", "TILDE", "WRT"}),
        ("relation r(a, b) { region: ", {"PLACE"}),
    ],
)
def test_what_the_grammar_accepts(text, accepted):
    assert after(text).accepted == accepted


def test_at_the_beginning_statements_and_contexts():
    assert {"SCENE", "BELIEVE", "IMPORT", "IN"} <= after("").accepted
    assert "WHERE" not in after("").accepted
    assert {"WHERE", "CHECK"} <= after("", query=True).accepted
    assert "SCENE" not in after("", query=True).accepted


def test_queries():
    assert after("where Cup wrt ", query=True).accepted == {"NAME"}
    assert {"GIVEN", "IN", "AT", "QMARK"} <= after("where Cup ", query=True).accepted


def test_open_words_are_those_of_what_is_not_complete():
    last = after("scene(A, b: C) ⇔ on(A, C) ∧ left-of(A, ")
    assert [str(word) for word in last.open if word is not None][-4:] == ["left-of", "(", "A", ","]
    assert None in last.open


@pytest.mark.parametrize(
    "text",
    [
        "believe 0.3 :: on(Cup,\nobserve 3 × ",
        "scene(Cup, \n  observe 3 × ",
        "§ garbage ( 3 |\nobserve 3 × ",
    ],
)
def test_a_line_that_begins_like_a_statement_is_one(text):
    assert after(text).accepted == after("observe 3 × ").accepted


def test_words_that_do_not_fit_are_passed_over():
    assert after("observe § on(A 3, B) ").accepted == after("observe on(A, B) ").accepted


def test_an_atom_that_begins_a_line_does_not_begin_a_statement():
    assert "AND" in after("observe on(A, B) ∧\n  in(A, B) ").accepted


@pytest.mark.parametrize("path", PROGRAMS[::4], ids=lambda path: path.stem)
def test_after_each_word_of_a_program_the_next_is_expected(path):
    source = Source(path.name, path.read_text(encoding="utf-8-sig"))
    for piece in split(source):
        if piece.kind is Kind.CONTEXT_END:
            continue
        words = expected_after(piece.span).words
        for word in words[1:]:
            before = Span(source, piece.span.start, word.start_pos)
            assert word.type in expected_after(before).accepted, before.text


@given(
    st.text(st.sampled_from('scene(A, b: C) ⇔ .?{}|::0.3 cm\n"#é😀 in on observe\x00\ud800')), st.booleans()
)
def test_any_text_can_be_followed(text, query):
    assert isinstance(after(text, query).accepted, frozenset)
