"""Where in a text a cursor stands: the word before it, and the statement that is being written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from qsrlang.language.source import Source, Span
from qsrlang.language.splitting import Kind, split
from qsrlang.language.words import LETTER, MARKS

MAX_WORD = 200

_LINE = re.compile(r'"[^"]*"|(?P<comment>#.*)|(?P<string>"[^"]*$)')
_WORD = re.compile(rf"{LETTER}[\w{MARKS}.-]*$")


class Surroundings(Enum):
    """What a cursor stands in."""

    TEXT = "text"
    STRING = "string"
    COMMENT = "comment"


@dataclass(frozen=True, slots=True)
class Cursor:
    """A place where something is being written.

    `word` is what was typed of it, `statement` the unfinished statement before it, without the word (and without the
    quote of a string); `in_context` tells whether a context is open.
    """

    word: Span
    statement: Span
    surroundings: Surroundings
    in_context: bool

    @property
    def begins_line(self) -> bool:
        """Whether part of a word was typed, and nothing stands before it on its line."""
        text, start = self.word.source.text, self.word.start
        return bool(self.word.text) and not text[text.rfind("\n", 0, start) + 1 : start].strip()


def find_cursor(text: str, position: int, query: bool = False) -> Cursor:
    """Return where a cursor stands; a text of queries is one statement."""
    position = max(0, min(position, len(text)))
    line = text[text.rfind("\n", 0, position) + 1 : position]
    surroundings, typed = _surroundings(line)
    start = position - len(typed)
    source = Source("", text[: start - (surroundings is Surroundings.STRING)])
    begin, in_context = (0, False) if query else _unfinished(source)
    return Cursor(
        Span(Source("", text), start, position),
        Span(source, begin, len(source.text)),
        surroundings,
        in_context,
    )


def _surroundings(line: str) -> tuple[Surroundings, str]:
    """Return what the end of a line stands in, and what was typed there."""
    for match in _LINE.finditer(line):
        if match["comment"] is not None:
            return Surroundings.COMMENT, match["comment"].rpartition(" ")[2]
        if match["string"] is not None:
            return Surroundings.STRING, match["string"][1:]
    word = _WORD.search(line[-MAX_WORD:])
    return Surroundings.TEXT, word.group() if word else ""


def _unfinished(source: Source) -> tuple[int, bool]:
    """Return where the last statement begins if it is not ended, else the end; and whether a context is open."""
    opened, start = 0, len(source.text)
    for piece in split(source):
        opened += {Kind.CONTEXT_HEAD: 1, Kind.CONTEXT_END: -1}.get(piece.kind, 0)
        unfinished = piece.kind is Kind.STATEMENT and piece.end == ""
        start = piece.span.start if unfinished else len(source.text)
    return start, opened > 0
