"""How words are spelled, and what separates them on a line."""

from __future__ import annotations

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
