"""From text to nodes: statement by statement, so that one mistake hides no other."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from lark import Lark, TextSlice
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken, VisitError

from qsrlang.language.diagnostics import Diagnostic, raise_errors
from qsrlang.language.quantities import Refused
from qsrlang.language.source import Source, Span
from qsrlang.language.syntax import Document, Landmark, Statement, Where
from qsrlang.language.transformer import build
from qsrlang.resources import resource_path

LANGUAGE_VERSION = 1
MAX_NESTING = 100
_MAX_EXPECTED = 14

_MARK = re.compile(r'"[^"\n]*"|#[^\n]*|\d+\.\d+|[().?]')
_WORDS = {
    "DOT": "'.'",
    "QMARK": "'?'",
    "COMMA": "','",
    "LPAR": "'('",
    "RPAR": "')'",
    "LBRACE": "'{'",
    "RBRACE": "'}'",
    "COLON": "':'",
    "COLONS": "'::'",
    "VBAR": "'|'",
    "TILDE": "'~'",
    "PERCENT": "'%'",
    "AND": "'∧'",
    "OR": "'∨'",
    "NOT": "'¬'",
    "IFF": "'⇔'",
    "TIMES": "'×'",
    "PLUSMINUS": "'±'",
    "NAME": "a name",
    "NUMBER": "a number",
    "INT": "a whole number",
    "SIGN": "a sign",
    "UNIT": "a unit",
    "STRING": "a name in quotes",
    "DECLARE": "'surface', 'static' or 'dynamic'",
    "FRAME": "'relative', 'intrinsic' or 'absolute'",
    "YESNO": "'yes' or 'no'",
    "ON_KEY": "'on'",
}


@dataclass(frozen=True, slots=True)
class Parsed:
    """A document with all that was found wrong in its text."""

    document: Document
    diagnostics: tuple[Diagnostic, ...]


def parse(text: str, name: str = "<text>") -> Parsed:
    """Parse a .qsr text; what cannot be read is left out and reported."""
    return parse_source(Source(name, text))


def parse_source(source: Source) -> Parsed:
    """Parse a .qsr source; what cannot be read is left out and reported."""
    statements: list[Statement] = []
    diagnostics: list[Diagnostic] = []
    for span, depth in _split(source):
        try:
            statements.append(_parse_span(source, span, depth, "statement"))
        except Refused as refusal:
            diagnostics.append(refusal.diagnostic)
    return Parsed(Document(tuple(statements)), tuple(diagnostics))


def parse_query(text: str) -> Where:
    """Parse one query, such as `where Cup?`; the question mark may be left out."""
    closed = text if text.rstrip().endswith("?") else text.rstrip() + "?"
    query: Where = _parse_alone(closed, "query", "<query>")
    return query


def parse_landmark(text: str) -> Landmark:
    """Parse one landmark, such as `monitor-1 : Monitor at (0 m, 0 m) facing -90 deg`."""
    landmark: Landmark = _parse_alone(text.strip().removesuffix("."), "landmark_body", "<landmark>")
    return landmark


def parse_place(text: str) -> tuple[float, float]:
    """Parse a place in the plane, such as `1.2 m, 0.5 m`: x, y [m]."""
    landmark = parse_landmark(f"here : Place at ({text.strip().strip('()')})")
    return landmark.position[0], landmark.position[1]


def _parse_alone(text: str, rule: str, name: str) -> Any:
    source = Source(name, text)
    try:
        return _parse_span(source, Span(source, 0, len(text)), text.count("("), rule)
    except Refused as refusal:
        raise_errors([refusal.diagnostic])


@cache
def _grammar() -> Lark:
    return Lark(
        resource_path("grammars", "qsr.lark").read_text(encoding="utf-8"),
        parser="lalr",
        lexer="contextual",
        start=["statement", "query", "landmark_body"],
        propagate_positions=True,
        maybe_placeholders=False,
    )


def _split(source: Source) -> Iterator[tuple[Span, int]]:
    """Yield each statement's place and how deep its parentheses nest."""
    start = depth = deepest = 0
    for mark in _MARK.finditer(source.text):
        word = mark.group()
        if word == "(":
            depth += 1
            deepest = max(deepest, depth)
        elif word == ")":
            depth -= 1
        elif word in ".?":
            yield _trimmed(source, start, mark.end()), deepest
            start, depth, deepest = mark.end(), 0, 0
    rest = _trimmed(source, start, len(source.text))
    if rest.start < rest.end:
        yield rest, deepest


_BLANK = re.compile(r"(?:\s+|#[^\n]*)*")


def _trimmed(source: Source, start: int, end: int) -> Span:
    blank = _BLANK.match(source.text, start, end)
    return Span(source, blank.end() if blank else start, end)


def _parse_span(source: Source, span: Span, depth: int, rule: str) -> Any:
    if depth > MAX_NESTING:
        message = f"parentheses nest {depth} deep"
        raise Refused(Diagnostic("Q102", message, span, f"at most {MAX_NESTING} are read"))
    try:
        tree = _grammar().parse(TextSlice(source.text, span.start, span.end), start=rule)
        return build(tree, source)
    except UnexpectedInput as error:
        raise Refused(_explain(source, span, error)) from error
    except VisitError as error:
        if isinstance(error.orig_exc, Refused):
            raise error.orig_exc from error
        raise


def _explain(source: Source, span: Span, error: UnexpectedInput) -> Diagnostic:
    if isinstance(error, UnexpectedCharacters):
        start, length, expected = error.pos_in_stream or span.start, 1, set(error.allowed or ())
        found = f"'{source.text[start]}'"
    elif isinstance(error, UnexpectedToken) and error.token.type != "$END":
        start, length, expected = (
            error.token.start_pos or span.start,
            len(error.token),
            set(error.accepts or ()),
        )
        found = f"'{error.token}'"
    else:
        start, length = _last_character(span), 1
        found, expected = "the end of the text", set(getattr(error, "accepts", None) or ())
    place = Span(source, start, min(start + length, max(span.end, start + 1)))
    words = sorted({_WORDS.get(name, f"'{name.lower()}'") for name in expected - {"$END"}})
    note = f"expected {', '.join(words)}" if 0 < len(words) <= _MAX_EXPECTED else ""
    return Diagnostic("Q101", f"unexpected {found}", place, note, _remedy(found, expected))


_WORD = re.compile(r'"[^"\n]*"|#[^\n]*|\S')


def _last_character(span: Span) -> int:
    """Return the place of a span's last character that is no blank and no comment."""
    words = _WORD.finditer(span.source.text, span.start, span.end)
    return max((word.end() - 1 for word in words if not word.group().startswith("#")), default=span.start)


def _remedy(found: str, expected: set[str]) -> str:
    if found in ("'?'", "'where'"):
        return (
            "a file states what is known and ends statements with '.'; ask queries with 'qsr ask FILE QUERY'"
        )
    if "DOT" in expected:
        return "a statement ends with '.'"
    return ""
