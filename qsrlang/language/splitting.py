"""From a text to its statements' places, so that each can be parsed on its own and one mistake hides no other."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from qsrlang.language.source import Source, Span
from qsrlang.language.words import LETTER, MARKS

BEGINNING = (
    r"(?:language|import|defaults|surface|static|dynamic|landmark|relation"
    r"|scene|believe|observe|require|in)(?![\w-])"
)
# What must not mislead the scanner: strings, comments, and full stops inside numbers and qualified names. A full
# stop before a word that begins a statement ends one all the same.
_MARK = re.compile(
    rf'"[^"\n]*"|#[^\n]*|\d+\.\d+|(?<=[\w{MARKS}])\.(?={LETTER})(?!{BEGINNING}[\s(])|(?P<mark>[(){{}}.?])'
)
_BLANK = re.compile(r"(?:\s+|#[^\n]*)*")
_WORD = re.compile(r'"[^"\n]*"|#[^\n]*|\S')
_HEAD = re.compile(r"in(?![\w-])")


class Kind(Enum):
    """What a piece of a text is; the values of the first two are the rules that read them."""

    STATEMENT = "statement"
    CONTEXT_HEAD = "context_head"
    CONTEXT_END = "}"


@dataclass(frozen=True, slots=True)
class Piece:
    """One statement without its full stop, or the head or the end of a context.

    `end` is "." or "?" where one ends it, "" where it runs up to something else; `depth` is how deep its
    parentheses nest; `lead` is where the blanks and comments before it begin.
    """

    kind: Kind
    span: Span
    end: str
    depth: int
    lead: int

    @property
    def doc(self) -> str:
        """The doc comment before it, line by line."""
        text = self.span.source.text
        if text.find("##", self.lead, self.span.start) < 0:
            return ""
        lines = text[self.lead : self.span.start].split("\n")
        return "\n".join(line.strip()[2:].strip() for line in lines if line.lstrip().startswith("##"))


def split(source: Source) -> Iterator[Piece]:
    """Yield the pieces of a text in order; only blanks and comments lie between them."""
    text = source.text
    lead, start = 0, skip_blank(text, 0)
    depth = deepest = braces = 0
    for match in _MARK.finditer(text):
        mark = match["mark"]
        if mark == "(":
            depth += 1
            deepest = max(deepest, depth)
        elif mark == ")":
            depth -= 1
        elif mark == "{" and not _HEAD.match(text, start):
            braces += 1
        elif mark == "}" and braces:
            braces -= 1
        elif mark is not None and match.start() >= lead:
            at, after = match.span()
            if mark == "{":
                yield Piece(Kind.CONTEXT_HEAD, Span(source, start, after), "", deepest, lead)
            elif mark != "}" or start < at:
                span = Span(source, start, last_word_end(text, start, at))
                yield Piece(Kind.STATEMENT, span, mark.strip("}"), deepest, lead)
            if mark == "}":
                yield Piece(Kind.CONTEXT_END, Span(source, at, after), "", 0, at)
                after = _skip_stop(text, after)
            lead, start = after, skip_blank(text, after)
            depth = deepest = braces = 0
    if start < len(text):
        yield Piece(
            Kind.STATEMENT, Span(source, start, last_word_end(text, start, len(text))), "", deepest, lead
        )


def skip_blank(text: str, start: int) -> int:
    """Return the first position from `start` that is neither blank nor in a comment."""
    blank = _BLANK.match(text, start)
    return blank.end() if blank else start


def last_word_end(text: str, start: int, end: int) -> int:
    """Return where the last character of text[start:end] that is neither blank nor in a comment ends."""
    if text.find("#", start, end) < 0:
        return start + len(text[start:end].rstrip())
    words = (word for word in _WORD.finditer(text, start, end) if not word.group().startswith("#"))
    return max((word.end() for word in words), default=start)


def _skip_stop(text: str, position: int) -> int:
    """A full stop after the brace that closes a context is tolerated."""
    after = skip_blank(text, position)
    return after + 1 if text.startswith(".", after) else position
