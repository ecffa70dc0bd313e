"""The grammar, loaded once, and the words it reserves."""

from __future__ import annotations

from functools import cache
from types import MappingProxyType
from typing import NamedTuple

from lark import Lark

from qsrlang.language.lexing import ExpectingLexer, fixed_spellings
from qsrlang.language.nodes.questions import NodeBuilder
from qsrlang.language.table import load_parser, make_parser
from qsrlang.resources import resource_path

_NAMES = {
    "NAME": "a name",
    "NUMBER": "a number",
    "SIGN": "a sign",
    "STRING": "a name in quotes",
    "TIME": "a time such as 09:30",
    "$END": "'.'",
}


class Reader(NamedTuple):
    """The parser and the builder of the nodes it calls back; it reads one source at a time."""

    lark: Lark
    builder: NodeBuilder


@cache
def reader() -> Reader:
    """Return the parser of the language."""
    builder, text = NodeBuilder(), grammar_text()
    options = {"transformer": builder, "_plugins": {"ContextualLexer": ExpectingLexer}}
    return Reader(load_parser(text, **options) or make_parser(text, **options), builder)


def grammar_text() -> str:
    """Return the grammar as it is written."""
    return resource_path("grammars", "qsr.lark").read_text(encoding="utf-8")


@cache
def spellings() -> MappingProxyType[str, tuple[str, ...]]:
    """Return how each fixed terminal may be written, the preferred spelling first: `{"AND": ("∧", "&", "and")}`."""
    found = {terminal.name: fixed_spellings(terminal) for terminal in reader().lark.terminals}
    return MappingProxyType({name: words for name, words in found.items() if words})


def keywords() -> frozenset[str]:
    """Return every word the language reserves somewhere."""
    return frozenset(word for words in spellings().values() for word in words if word[0].isalpha())


def describe(terminal: str) -> str:
    """Return a terminal in a reader's words, such as `'∧'` or `a name`."""
    words = spellings().get(terminal)
    if words is None:
        return _NAMES.get(terminal, terminal.lower())
    if terminal == "UNIT":
        return "a unit"
    return " or ".join(f"'{word}'" for word in _shown(words))


def _shown(words: tuple[str, ...]) -> tuple[str, ...]:
    """All words of a class of keywords, but of several spellings of one sign only the preferred."""
    return words if words[0][0].isalpha() else words[:1]
