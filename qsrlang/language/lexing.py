"""A lexer led by the parser: the shape of a word first, then what the parser expects decides what kind it is."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from lark import Token
from lark.exceptions import UnexpectedCharacters
from lark.lexer import Lexer

from qsrlang.language.source import Span

# Of two shapes that both fit, the first one is taken: 09:30 is a time before it is a number.
_SHAPES = ("NAME", "TIME", "NUMBER", "STRING")
_BLANK = r"(?:[ \t\r\n\f]+|#[^\n]*)*"


class Excerpt(str):
    """Part of a text that remembers where it begins, so that its tokens have their places in the whole.

    Lark's own TextSlice counts the lines before it, which takes time quadratic in the number of statements.
    """

    __slots__ = ("offset",)
    offset: int

    @classmethod
    def of(cls, span: Span) -> Excerpt:
        """Return the text of a span."""
        excerpt = cls(span.text)
        excerpt.offset = span.start
        return excerpt


class Word(Token):
    """A token with its place in the whole text, made without the detour of Token's own constructor."""

    __slots__ = ()
    start_pos: int
    end_pos: int

    def __new__(cls, kind: str, value: str, start: int, end: int) -> Word:
        """Return the token text[start:end]."""
        word = str.__new__(cls, value)
        word.type, word.value, word.start_pos, word.end_pos = kind, value, start, end
        word.line = word.column = word.end_line = word.end_column = None
        return word


class ExpectingLexer(Lexer):
    """Finds the next word by its shape; of the kinds it may be, the one that the parser accepts is it.

    So words are reserved only where the grammar expects them, as with lark's contextual lexer, but one regular
    expression serves all states of the parser, and lines are not counted.
    """

    def __init__(self, conf: Any, states: Mapping[int, Collection[str]], always_accept: object = ()) -> None:
        self._accepted = {state: frozenset(kinds) for state, kinds in states.items()}
        self._kinds = _kinds(conf.terminals)
        self._match = re.compile(_pattern(conf.terminals)).match

    def lex(self, lexer_state: Any, parser_state: Any) -> Iterator[Word]:
        """Yield the tokens that the parser accepts in its present state; raises UnexpectedCharacters."""
        text: Excerpt = lexer_state.text.text
        position, offset = 0, text.offset
        match, fixed, accepted = self._match, self._kinds, self._accepted
        while True:
            found = match(text, position)
            shape = found.lastgroup if found else None
            if found is None or shape is None:
                return
            value, start = found[shape], found.start(shape)
            allowed = accepted[parser_state.position]
            for kind in fixed.get(value, (shape,)):
                if kind in allowed:
                    break
            else:
                raise _unexpected(text, start)
            position = found.end()
            yield Word(kind, value, offset + start, offset + position)


def fixed_spellings(terminal: Any) -> tuple[str, ...]:
    """Return how a terminal of few words or signs may be written; nothing for one that is a shape, such as a number."""
    text = str(terminal.pattern.value)
    if terminal.pattern.type == "str":
        return (text,)
    bare = re.sub(r"\(\?!\[[^]]*\]\)", "", text).strip("()")
    words = tuple(re.sub(r"\\(.)", r"\1", word) for word in bare.split("|"))
    return words if all(re.fullmatch(r"\w+|[^\w\s\\\[\]]{1,3}", word) for word in words) else ()


def _kinds(terminals: Collection[Any]) -> dict[str, tuple[str, ...]]:
    """Return the kinds that each word or sign may be, those that reserve it before a name."""
    kinds: dict[str, list[str]] = defaultdict(list)
    for terminal in terminals:
        for spelling in fixed_spellings(terminal):
            kinds[spelling].append(terminal.name)
    return {
        spelling: (*names, *(["NAME"] if spelling[0].isalpha() else [])) for spelling, names in kinds.items()
    }


def _pattern(terminals: Collection[Any]) -> str:
    shapes = {terminal.name: terminal.pattern.to_regexp() for terminal in terminals}
    fixed = {spelling for terminal in terminals for spelling in fixed_spellings(terminal)}
    signs = sorted((re.escape(one) for one in fixed if not one[0].isalpha()), key=len, reverse=True)
    words = "|".join(f"(?P<{name}>{shapes[name]})" for name in _SHAPES)
    return rf"{_BLANK}(?:{words}|(?P<FIXED>{'|'.join(signs)})|(?P<SIGN>{shapes['SIGN']})|(?P<ODD>[^\s])|\Z)"


def _unexpected(text: Excerpt, position: int) -> UnexpectedCharacters:
    error = UnexpectedCharacters(text, position, 0, 0)  # type: ignore[no-untyped-call]
    error.pos_in_stream = text.offset + position  # type: ignore[assignment]
    return error
