"""From text to nodes: statement by statement, so that one mistake hides no other."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from threading import Lock
from typing import Any

from lark.exceptions import UnexpectedInput

from qsrlang.language.characters import odd_characters
from qsrlang.language.diagnostics import Diagnostic, Diagnostics, Edit, Label, raise_errors
from qsrlang.language.grammar import reader
from qsrlang.language.lexing import Excerpt, Word
from qsrlang.language.questions import Query
from qsrlang.language.remedies import QUERIES_ELSEWHERE
from qsrlang.language.source import Source, Span
from qsrlang.language.splitting import Kind, Piece, split
from qsrlang.language.statements import (
    Believe,
    Context,
    Document,
    Landmark,
    Observe,
    ObserveScene,
    Require,
    Scene,
    Statement,
)
from qsrlang.language.syntax import Formula
from qsrlang.language.unexpected import Rest, explain, rest_after_missing_stop
from qsrlang.language.words import WORD

LANGUAGE_VERSION = 1
MAX_NESTING = 100
MAX_FINDINGS = 10_000
CONTEXTUAL = (Scene, Believe, Observe, ObserveScene, Require)

_LOCK = Lock()
_NAME = re.compile(WORD)
_DEFINES = re.compile(r"(?:surface|static|dynamic|landmark|relation|scene)(?![\w-])")


@dataclass(frozen=True, slots=True)
class Parsed:
    """A document with all that was found wrong in its text, and the names that what was left out would define."""

    document: Document
    diagnostics: Diagnostics
    lost: frozenset[str] = frozenset()


@dataclass(slots=True)
class _Reading:
    """A document while it is being read; the open contexts stand with the statements read inside them."""

    diagnostics: list[Diagnostic]
    statements: list[Statement] = field(default_factory=list)
    lost: set[str] = field(default_factory=set)
    contexts: list[tuple[Context, list[Statement]]] = field(default_factory=list)

    def report(self, code: str, message: str, span: Span, **more: Any) -> None:
        """Add an error."""
        self.diagnostics.append(Diagnostic(code, message, span, **more))


def parse(text: str, name: str = "<text>") -> Parsed:
    """Parse a .qsr text; what cannot be read is left out and reported."""
    return parse_source(Source(name, text))


def parse_source(source: Source) -> Parsed:
    """Parse a .qsr source; what cannot be read is left out and reported, up to MAX_FINDINGS of it."""
    reading = _Reading(list(odd_characters(source)))
    for piece in split(source):
        _take(piece, reading)
        if len(reading.diagnostics) >= MAX_FINDINGS:
            message = f"{MAX_FINDINGS} findings; the text after this place is not read"
            reading.diagnostics.append(Diagnostic("Q107", message, piece.span))
            break
    while reading.contexts:
        _report_open(source, reading)
    return Parsed(
        Document(tuple(reading.statements)), Diagnostics(reading.diagnostics), frozenset(reading.lost)
    )


def parse_query(text: str) -> Query:
    """Parse one query, such as `where Cup?`; the question mark may be left out."""
    closed = text if text.rstrip().endswith("?") else text.rstrip() + ("\n?" if "#" in text else "?")
    query: Query = _parse_alone(closed, "query", "<query>")
    return query


def parse_formula(text: str) -> Formula:
    """Parse one formula, such as `left-of(Cup, Keyboard) ∧ ¬close-to(Cup, Keyboard)`."""
    formula: Formula = _parse_alone(f"prob {text}?", "query", "<formula>").formula
    return formula


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
    result = _parse_span(Span(source, 0, len(text)), text.count("("), rule)
    raise_errors(result.findings)
    return result.node


def _take(piece: Piece, reading: _Reading) -> None:
    if piece.kind is Kind.CONTEXT_END:
        _close_context(piece.span, reading)
        return
    if piece.span.start == piece.span.end:
        reading.report("Q101", f"unexpected '{piece.end}'", _after(piece.span))
        return
    result = _parse_span(piece.span, piece.depth, piece.kind.value)
    if result.rest is not None:
        before = Span(piece.span.source, piece.span.start, result.rest.before)
        _take(replace(piece, span=before, end=""), reading)
        _take(replace(piece, span=Span(before.source, result.rest.start, piece.span.end)), reading)
        return
    reading.diagnostics.extend(result.findings)
    if result.findings:
        names = _NAME.findall(piece.span.text) if _DEFINES.match(piece.span.text) else ()
        reading.lost.update(names)
    if piece.kind is Kind.CONTEXT_HEAD:
        _open_context(result.node or Context(piece.span, (), ()), piece, reading)
    elif not result.findings:
        _check_end(piece, reading)
        _add(result.node, piece.doc, reading)


def _check_end(piece: Piece, reading: _Reading) -> None:
    place = _after(piece.span)
    if piece.end == "":
        edits = (Edit(Span(place.source, place.start, place.start), "."),)
        reading.report("Q104", "a statement ends with '.'", place, help="add a full stop", edits=edits)
    elif piece.end == "?":
        reading.report("Q101", "unexpected '?'", place, help=QUERIES_ELSEWHERE)


def _add(statement: Statement, doc: str, reading: _Reading) -> None:
    documented = replace(statement, doc=doc) if doc else statement
    if not reading.contexts:
        reading.statements.append(documented)
        return
    head, inside = reading.contexts[-1]
    if isinstance(statement, CONTEXTUAL):
        inside.append(documented)
    else:
        labels = (Label(head.span, "the context begins here"),)
        reading.lost.update(_NAME.findall(statement.span.text))
        note = "only scene, believe, observe and require can"
        reading.report(
            "Q106", "this statement cannot stand in a context", statement.span, note=note, labels=labels
        )


def _open_context(head: Context, piece: Piece, reading: _Reading) -> None:
    if reading.contexts:
        labels = (Label(reading.contexts[-1][0].span, "inside this one"),)
        help_text = "write all conditions in one head, with commas between"
        reading.report("Q106", "contexts do not nest", head.span, help=help_text, labels=labels)
    reading.contexts.append((replace(head, doc=piece.doc), []))


def _close_context(span: Span, reading: _Reading) -> None:
    if not reading.contexts:
        reading.report("Q101", "unexpected '}'", span, note="nothing is open here")
        return
    head, inside = reading.contexts.pop()
    whole = Span(span.source, head.span.start, span.end)
    reading.statements.append(replace(head, span=whole, statements=tuple(inside)))


def _report_open(source: Source, reading: _Reading) -> None:
    head, _ = reading.contexts[-1]
    end = Span(source, len(source.text), len(source.text))
    reading.report(
        "Q105",
        "this context is not closed",
        head.span,
        help="add a '}' where it ends",
        edits=(Edit(end, "}\n"),),
    )
    _close_context(end, reading)


def _after(span: Span) -> Span:
    """Return the place just after a span: its full stop, or where that belongs."""
    return Span(span.source, span.end, span.end + 1)


@dataclass(frozen=True, slots=True)
class _Result:
    node: Any
    findings: tuple[Diagnostic, ...] = ()
    rest: Rest | None = None


def _parse_span(span: Span, depth: int, rule: str) -> _Result:
    """Parse part of a source by a start rule; None where it cannot be read."""
    if depth > MAX_NESTING:
        message = f"parentheses nest {depth} deep"
        return _Result(None, (Diagnostic("Q102", message, span, f"at most {MAX_NESTING} are read"),))
    with _LOCK:
        lark, builder = reader()
        builder.start(span.source)
        try:
            node = lark.parse(Excerpt.of(span), start=rule)
        except UnexpectedInput as error:
            rest = rest_after_missing_stop(error, span) if rule == "statement" else None
            return _Result(None, () if rest else (explain(error, span),), rest)
        return _Result(node, tuple(builder.findings))


def words_of(span: Span, depth: int, rule: str) -> tuple[Word, ...] | None:
    """Return the words of what a start rule reads, each with its kind; None where it cannot be read."""
    if depth > MAX_NESTING:
        return None
    with _LOCK:
        lark, builder = reader()
        builder.start(span.source)
        try:
            reading = lark.parse_interactive(Excerpt.of(span), start=rule)
            words = tuple(word for word in reading.iter_parse() if isinstance(word, Word))
            reading.feed_eof()  # type: ignore[no-untyped-call]
        except UnexpectedInput:
            return None
    return words
