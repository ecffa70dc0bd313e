"""How a finding is shown: the lines it speaks of, with marks under the places."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator
from enum import Enum
from itertools import groupby
from typing import NamedTuple

from qsrlang.language.source import Source, Span

MAX_LINE = 200
_UNSEEN_CATEGORIES = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")
_UNSEEN = "\N{REPLACEMENT CHARACTER}"


class Part(Enum):
    """What a row of a shown finding is."""

    HEAD = "head"
    PLACE = "place"
    TEXT = "text"
    MARK = "mark"
    FURTHER_MARK = "further mark"
    HELP = "help"


class Row(NamedTuple):
    """One row of a shown finding."""

    part: Part
    text: str


class Mark(NamedTuple):
    """A place, what is said of it, and whether it is the finding's own."""

    span: Span
    text: str
    primary: bool


def rows(head: str, marks: Iterable[Mark], help_text: str) -> Iterator[Row]:
    """Yield the rows of a finding; neighbouring marks on one line share it."""
    yield Row(Part.HEAD, visible(head))
    marks = list(marks)
    gutter = " " * max(len(str(mark.span.line)) for mark in marks)
    for _, group in groupby(marks, key=lambda mark: (id(mark.span.source), mark.span.line)):
        yield from _excerpt(list(group), gutter)
    if help_text:
        yield Row(Part.HELP, f"{gutter}  = help: {visible(help_text)}")


def visible(text: str) -> str:
    """Return a text with a sign in place of every character that has no shape of its own."""
    return "".join(_UNSEEN if unicodedata.category(one) in _UNSEEN_CATEGORIES else one for one in text)


def _excerpt(marks: list[Mark], gutter: str) -> Iterator[Row]:
    first = marks[0]
    begin, text = _cut(first.span.source, first.span.line, first.span.column)
    yield Row(Part.PLACE, f"{gutter} {'-->' if first.primary else ':::'} {visible(str(first.span))}")
    yield Row(Part.PLACE, f"{gutter} |")
    yield Row(Part.TEXT, f"{first.span.line:>{len(gutter)}} | {visible(text)}")
    for mark in marks:
        start = mark.span.column - 1 - begin
        length = max(1, min(mark.span.end - mark.span.start, len(text) - start))
        signs = ("^" if mark.primary else "-") * max(1, _width(text[start : start + length]))
        row = f"{gutter} | {' ' * _width(text[:start])}{signs} {visible(mark.text)}"
        yield Row(Part.MARK if mark.primary else Part.FURTHER_MARK, row.rstrip())


def _cut(source: Source, line: int, column: int) -> tuple[int, str]:
    """Return where the shown part of a line begins, and that part; a long line is cut around the column."""
    text = source.line_text(line).expandtabs(1)
    if len(text) <= MAX_LINE:
        return 0, text
    begin = max(0, min(column - MAX_LINE // 2, len(text) - MAX_LINE))
    return begin, text[begin : begin + MAX_LINE]


def _width(text: str) -> int:
    """Return how many columns a terminal gives a text: wide characters take two, combining ones none."""
    if text.isascii():
        return len(text)
    return sum(
        0 if unicodedata.combining(one) else 2 if unicodedata.east_asian_width(one) in "WF" else 1
        for one in text
    )
