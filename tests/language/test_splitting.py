import re

from hypothesis import given
from hypothesis import strategies as st

from qsrlang.language.grammar import reader, spellings
from qsrlang.language.source import Source
from qsrlang.language.splitting import BEGINNING, Kind, split

BETWEEN = re.compile(r"(?:\s|#[^\n]*|[.?])*")


def pieces(text):
    return [(piece.kind, piece.span.text, piece.end) for piece in split(Source("<text>", text))]


def statements(text):
    return [words for kind, words, _ in pieces(text) if kind is Kind.STATEMENT]


def test_a_full_stop_ends_a_statement_except_in_numbers_strings_comments_and_names():
    assert statements('a 1.5 m. import "b.qsr". # c. d.\nlab.Cup e.') == [
        "a 1.5 m",
        'import "b.qsr"',
        "lab.Cup e",
    ]
    assert statements("static lab.A.dynamic B, lab.in-side.") == ["static lab.A", "dynamic B, lab.in-side"]
    assert statements("static A.Static B.") == ["static A.Static B"], "as in Prolog"


def test_the_words_that_begin_statements_are_the_grammar_s():
    accepted = {
        word
        for rule in ("statement", "context_head")
        for terminal in reader().lark.parse_interactive("", start=rule).accepts()
        for word in spellings()[terminal]
    }
    assert set(re.findall(r"[a-z]+", BEGINNING.split("(?!")[0])) == accepted


def test_braces_of_fields_belong_to_their_statement_and_those_of_contexts_do_not():
    assert pieces("static A { size: 1 m × 2 m }.\nin room r { b. } in-side c.") == [
        (Kind.STATEMENT, "static A { size: 1 m × 2 m }", "."),
        (Kind.CONTEXT_HEAD, "in room r {", ""),
        (Kind.STATEMENT, "b", "."),
        (Kind.CONTEXT_END, "}", ""),
        (Kind.STATEMENT, "in-side c", "."),
    ]


def test_a_full_stop_after_a_context_is_passed_over():
    assert [kind for kind, *_ in pieces("in weekend { a. } .\nb.")] == [
        Kind.CONTEXT_HEAD,
        Kind.STATEMENT,
        Kind.CONTEXT_END,
        Kind.STATEMENT,
    ]


def test_doc_comments_belong_to_the_next_statement():
    first, second = split(Source("<text>", "## one\n# not this\n##two\na.\n\nb. ## after"))
    assert (first.doc, second.doc) == ("one\ntwo", "")


def test_a_statement_that_is_not_ended_says_so():
    assert pieces("a. b # c") == [(Kind.STATEMENT, "a", "."), (Kind.STATEMENT, "b", "")]
    assert pieces("in weekend { a }")[1] == (Kind.STATEMENT, "a", "")


@given(st.text(alphabet='ab.?{}()"#\n 1in', max_size=80))
def test_pieces_are_in_order_and_between_them_is_nothing_but_blanks_and_comments(text):
    position = 0
    for piece in split(Source("<text>", text)):
        assert BETWEEN.fullmatch(text, position, piece.span.start)
        assert piece.lead <= piece.span.start <= piece.span.end
        position = piece.span.end
    assert BETWEEN.fullmatch(text, position)
