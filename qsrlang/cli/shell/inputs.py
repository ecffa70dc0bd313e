"""What is typed: from lines to inputs, and from inputs to passages, each of statements, a query or a colon command."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import get_args

from qsrlang.language.questions import Query
from qsrlang.language.source import MAX_SOURCE_BYTES, Source
from qsrlang.language.splitting import Kind, Piece, skip_blank, split

PLAIN_COMMANDS = ("help", "quit", "exit")
QUESTIONS = tuple(kind.__name__.lower() for kind in get_args(Query))


class Act(Enum):
    """What a passage does."""

    STATE = "state"
    ASK = "ask"
    COMMAND = "command"


@dataclass(frozen=True, slots=True)
class Passage:
    """Part of an input: statements, one query with its question mark, or one colon command."""

    act: Act
    text: str


def is_command(text: str) -> bool:
    """Return whether a text is a colon command, or one of the words that newcomers type in their place."""
    return text.lstrip().startswith(":") or text.strip() in PLAIN_COMMANDS


def is_question(text: str) -> bool:
    """Return whether a text begins as queries do."""
    return text.split(maxsplit=1)[:1] in [[word] for word in QUESTIONS]


def is_complete(text: str) -> bool:
    """Return whether every statement and query of a text has its end, so that it can be taken.

    An empty line, too, ends a query.
    """
    *_, rest = ("", *group_lines(text.splitlines(keepends=True)))
    return is_command(rest) or _is_closed(rest) or (rest.endswith("\n") and is_question(rest))


def group_lines(lines: Iterable[str]) -> Iterator[str]:
    """Yield the inputs that lines make up: a command is one line, an input ends at a line that ends a query.

    Statements wait for what follows them, so that all their mistakes are told at once.
    """
    waiting = ""
    for line in lines:
        if is_command(line) and _is_closed(waiting):
            yield from (waiting, line) if waiting.strip() else (line,)
            waiting = ""
            continue
        waiting += line
        if len(waiting) > MAX_SOURCE_BYTES or ("?" in line and _is_closed(waiting)):
            yield waiting
            waiting = ""
    if waiting.strip():
        yield waiting


def passages(text: str) -> Iterator[Passage]:
    """Yield the parts of an input in their order; neighbouring statements are one part, with their comments."""
    if is_command(text):
        yield Passage(Act.COMMAND, text.strip())
        return
    done = 0
    for piece, is_inside in _pieces(text):
        if piece.end == "?" and not is_inside:
            yield from _stated(text[done : piece.span.start])
            yield Passage(Act.ASK, f"{piece.span.text}?")
            done = _end(piece)
    rest = text[done:]
    if is_question(rest):
        yield Passage(Act.ASK, rest.strip())
    else:
        yield from _stated(rest)


def _stated(text: str) -> Iterator[Passage]:
    if skip_blank(text, 0) < len(text):
        yield Passage(Act.STATE, text.strip())


def count_statements(text: str) -> int:
    """Return how many statements a text holds; a context is one."""
    return sum(not is_inside and piece.kind is not Kind.CONTEXT_HEAD for piece, is_inside in _pieces(text))


def last_passage(text: str) -> int:
    """Return where the statement or query begins that the end of a text lies in, or that may begin there."""
    start = 0
    for piece, is_inside in _pieces(text):
        is_ended = bool(piece.end) or piece.kind is not Kind.STATEMENT
        if not is_inside:
            start = _end(piece) if is_ended else piece.span.start
    return skip_blank(text, start)


def _pieces(text: str) -> Iterator[tuple[Piece, bool]]:
    """Yield the pieces of a text, each with whether a context is still open after it."""
    is_inside = False
    for piece in split(Source("<input>", text)):
        if piece.kind is not Kind.STATEMENT:
            is_inside = piece.kind is Kind.CONTEXT_HEAD
        yield piece, is_inside


def _is_closed(text: str) -> bool:
    pieces = list(_pieces(text))
    if not pieces:
        return "##" not in text
    last, is_inside = pieces[-1]
    is_ended = bool(last.end) or last.kind is Kind.CONTEXT_END
    return is_ended and not is_inside and "##" not in text[_end(last) :]


def _end(piece: Piece) -> int:
    """Return the position after a piece and the mark that ends it."""
    return skip_blank(piece.span.source.text, piece.span.end) + 1 if piece.end else piece.span.end
