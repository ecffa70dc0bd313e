"""What the grammar expects after a text that is still being written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

from lark.exceptions import UnexpectedCharacters, UnexpectedToken

from qsrlang.language.grammar import reader, spellings
from qsrlang.language.lexing import Excerpt, Word
from qsrlang.language.source import Span
from qsrlang.language.splitting import skip_blank

MAX_REPAIRS = 32

_WORD = re.compile(r"[\w-]+|\S")


@dataclass(frozen=True, slots=True)
class Expectation:
    """The terminals that may follow a text ("$END" where none need to), and the words that were read.

    `open` are the words of what is not complete yet, innermost last; what is complete among them stands as None.
    """

    accepted: frozenset[str]
    words: tuple[Word, ...]
    open: tuple[Word | None, ...]


def expected_after(span: Span, query: bool = False) -> Expectation:
    """Return what may follow part of a text that begins where a statement, a context or else a query begins.

    Words that do not fit are passed over, up to MAX_REPAIRS of them. Of a text without full stops, only what follows
    the last line that begins like a statement is read, for the stop before that line may be missing.
    """
    if query:
        return _expected(span, "query")
    last = _last_statement(span)
    first = _word_at(Span(last.source, skip_blank(last.source.text, last.start), last.end))
    if first.text:
        return _expected(last, "context_head" if first.text in _first_words("context_head") else "statement")
    statement, context = _expected(last, "statement"), _expected(last, "context_head")
    return Expectation(statement.accepted | context.accepted, (), ())


def _expected(span: Span, rule: str) -> Expectation:
    parser, words, start = _parser(rule), list[Word](), span.start
    for _ in range(MAX_REPAIRS):
        unfit = _read(parser, Span(span.source, start, span.end), words)
        if unfit is None:
            break
        start = unfit.end
    return Expectation(frozenset(parser.accepts()), tuple(words), _open(parser))


def _parser(rule: str) -> Any:
    """A parser at the beginning of a rule that builds no nodes, so that it may run beside the one that does."""
    parser: Any = reader().lark.parse_interactive("", start=rule)
    parser.parser_state.parse_conf.callbacks = {}
    return parser


def _read(parser: Any, span: Span, words: list[Word]) -> Span | None:
    """Read on to the first word that does not fit, and return its place."""
    lexer: Any = reader().lark.parse_interactive(Excerpt.of(span), start="statement").lexer_thread
    try:
        for word in lexer.lex(parser.parser_state):
            parser.feed_token(word)
            words.append(word)
    except UnexpectedToken as error:
        return _word_at(Span(span.source, error.token.start_pos or 0, span.end))
    except UnexpectedCharacters as error:
        return _word_at(Span(span.source, error.pos_in_stream or 0, span.end))
    return None


def _word_at(span: Span) -> Span:
    """Return the word or sign at the start of a span, empty at its end."""
    word = _WORD.match(span.source.text, span.start, max(span.start, span.end))
    return Span(span.source, span.start, word.end() if word else span.start)


def _last_statement(span: Span) -> Span:
    found = list(_beginning().finditer(span.source.text, span.start, span.end))
    return Span(span.source, found[-1].start("word"), span.end) if found else span


@cache
def _beginning() -> re.Pattern[str]:
    """A line that begins like a statement or a context, and not like an argument or an atom."""
    statement, context = ("|".join(_first_words(rule)) for rule in ("statement", "context_head"))
    word = rf"(?P<word>{statement}|(?:{context})(?!\s*\())"
    return re.compile(rf"^[ \t]*{word}(?![\w-])(?!\s*[:,).])", re.MULTILINE)


@cache
def _first_words(rule: str) -> tuple[str, ...]:
    return tuple(word for terminal in sorted(_parser(rule).accepts()) for word in spellings()[terminal])


def _open(parser: Any) -> tuple[Word | None, ...]:
    return tuple(value if isinstance(value, Word) else None for value in parser.parser_state.value_stack)
