"""The words of a statement as they are to be written, what lies between them, and where things are among them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

_COMMENT = re.compile(r"#[^\n]*")
_BRACKETS = {"LPAR": "RPAR", "LBRACE": "RBRACE"}


@dataclass(frozen=True, slots=True)
class Remark:
    """A comment: whether it stands behind something on its line, and whether a blank line is before it."""

    text: str
    behind: bool
    blank: bool

    @property
    def documents(self) -> bool:
        """Whether a statement after it would take it for its doc comment."""
        return any(line.lstrip().startswith("##") for line in self.text.splitlines())


@dataclass(frozen=True, slots=True)
class Gap:
    """What lies between two words: comments, then perhaps a line end, perhaps with a blank line."""

    remarks: tuple[Remark, ...] = ()
    line_end: bool = False
    blank: bool = False


NO_GAP = Gap()


def read_gap(text: str) -> Gap:
    """Return what a text of blanks and comments holds."""
    if not text.strip(" "):
        return NO_GAP
    remarks: list[Remark] = []
    at = 0
    for comment in _COMMENT.finditer(text):
        line_ends = text.count("\n", at, comment.start())
        remarks.append(Remark(comment.group().rstrip(), not line_ends and not remarks, line_ends > 1))
        at = comment.end()
    line_ends = text.count("\n", at)
    return Gap(tuple(remarks), line_ends > 0, line_ends > 1)


@dataclass(frozen=True, slots=True)
class Token:
    """A word of a terminal of the grammar, as it is to be spelled, with what lies before it."""

    kind: str
    text: str
    before: Gap = NO_GAP


class Sentence:
    """The words of one statement with its full stop, or of a context's head.

    What is looked for from a `start` up to an `end` is looked for outside the brackets that open there.
    """

    def __init__(self, tokens: Sequence[Token]) -> None:
        self.tokens = tokens
        self.last = len(tokens) - 1
        self._closed = _bracket_ends(tokens)

    def bracket_end(self, at: int) -> int | None:
        """Return where the bracket that opens at a place is closed; None where none opens."""
        return self._closed.get(at)

    def units(self, start: int, end: int) -> Iterator[int]:
        """Yield the places of words, brackets with all between them as one."""
        at = start
        while at < end:
            yield at
            at = self._closed.get(at, at) + 1

    def split(self, start: int, end: int, separator: str) -> Iterator[tuple[int, int]]:
        """Yield where each item that words of a kind separate starts and ends."""
        first = start
        for at in self.units(start, end):
            if self.tokens[at].kind == separator:
                yield first, at
                first = at + 1
        yield first, end

    def find(self, start: int, end: int, *kinds: str) -> int:
        """Return the first place of a word of these kinds; the end if there is none."""
        return next((at for at in self.units(start, end) if self.tokens[at].kind in kinds), end)

    def behind(self, kind: str, start: int, end: int) -> int:
        """Return the place behind the first word of a kind; the start if there is none."""
        at = self.find(start, end, kind)
        return at + 1 if at < end else start

    def has(self, start: int, end: int, *kinds: str) -> bool:
        """Whether there is a word of these kinds."""
        return self.find(start, end, *kinds) < end

    def has_brackets(self, start: int, end: int) -> bool:
        """Whether brackets open."""
        return self.has(start, end, *_BRACKETS)

    def line_ends_before(self, at: int) -> bool:
        """Whether a word was written on a new line."""
        return self.tokens[at].before.line_end


def _bracket_ends(tokens: Sequence[Token]) -> dict[int, int]:
    """Return where each opening bracket is closed; the brace that opens a context is not."""
    opened: list[int] = []
    ends = {}
    for at, token in enumerate(tokens):
        if token.kind in _BRACKETS:
            opened.append(at)
        elif token.kind in _BRACKETS.values():
            ends[opened.pop()] = at
    return ends
