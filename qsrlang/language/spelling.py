"""Words as they are written: their spelling, what separates them, and the comments between them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Literal, TypeAlias

Spelling: TypeAlias = Literal["unicode", "ascii"]

SIGNS: MappingProxyType[Spelling, MappingProxyType[str, str]] = MappingProxyType(
    {
        "unicode": MappingProxyType(
            {"AND": "∧", "OR": "∨", "NOT": "¬", "IFF": "⇔", "TIMES": "×", "PLUSMINUS": "±"}
        ),
        "ascii": MappingProxyType(
            {"AND": "and", "OR": "or", "NOT": "not", "IFF": "<=>", "TIMES": "x", "PLUSMINUS": "+-"}
        ),
    }
)
# The colon between a landmark and its class stands alone; every other one clings to the word before it.
LANDMARK_COLON = "LANDMARK_COLON"

_NONE_BEFORE = frozenset({"COMMA", "RPAR", "COLON", "DOT", "QMARK"})
_NONE_AFTER = frozenset({"LPAR", "SIGN"})
_CALLED = frozenset({"NAME", "SCENE", "NORMAL", "UNIFORM", "MIX"})
_COMMENT = re.compile(r"#[^\n]*")


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
class Interval:
    """What lies between two words: comments, then perhaps a line end, perhaps with a blank line."""

    remarks: tuple[Remark, ...] = ()
    line_end: bool = False
    blank: bool = False


@dataclass(frozen=True, slots=True)
class Token:
    """A word of a terminal of the grammar, as it is to be spelled, with what lies before it."""

    kind: str
    text: str
    before: Interval = Interval()


_ADJACENT = Interval()


def interval(text: str) -> Interval:
    """Return what a text of blanks and comments holds."""
    if not text.strip(" "):
        return _ADJACENT
    remarks: list[Remark] = []
    at, line_end = 0, False
    for comment in _COMMENT.finditer(text):
        line_ends = text.count("\n", at, comment.start())
        remarks.append(Remark(comment.group().rstrip(), not line_ends and not remarks, line_ends > 1))
        at, line_end = comment.end(), True
    line_ends = text.count("\n", at)
    return Interval(tuple(remarks), line_end or line_ends > 0, line_ends > 1)


@cache
def blank_between(left: str, right: str, spelling: Spelling) -> str:
    """Return what separates words of two kinds on one line: a blank or nothing."""
    joined = (
        right in _NONE_BEFORE
        or left in _NONE_AFTER
        or (right == "LPAR" and left in _CALLED)
        or (left == "NOT" and spelling == "unicode")
    )
    return "" if joined else " "
