"""How text is told apart for colouring: sections of patterns made from the vocabulary, shared by all highlighters.

The regular expressions mean the same to Python and to Oniguruma, which TextMate grammars are written for.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cache
from types import MappingProxyType

from qsrlang.editor.vocabulary import Kind, Vocabulary, builtin_relations, vocabulary, words_of
from qsrlang.language.grammar import reader

ROOT = "root"
ARGUMENTS = "arguments"


class Ink(Enum):
    """What is coloured alike; the values are the scopes of TextMate grammars."""

    COMMENT = "comment.line.number-sign"
    DOC = "comment.block.documentation"
    STRING = "string.quoted.double"
    NUMBER = "constant.numeric"
    UNIT = "keyword.other.unit"
    STATEMENT = "keyword.control"
    WORD = "keyword.other"
    CONSTANT = "constant.language"
    FIELD = "variable.other.property"
    DENSITY = "support.function.density"
    OPERATOR = "keyword.operator"
    SIGN = "punctuation"
    BUILTIN = "support.function.relation"
    RELATION = "entity.name.function.relation"
    CLASS = "entity.name.type.class"
    INSTANCE = "variable.other"
    ROLE = "variable.parameter.role"
    SCENE = "entity.name.section.scene"
    ROOM = "entity.name.namespace.room"
    PREFIX = "entity.name.namespace.prefix"


@dataclass(frozen=True, slots=True)
class Pattern:
    """What a regular expression matches: one ink for the whole, or one for each group, None where it stays plain.

    `section` is the section that begins after it.
    """

    regex: str
    inks: tuple[Ink | None, ...]
    section: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """A stretch of text with its own patterns, tried in order, and what ends it; nothing ends the root."""

    patterns: tuple[Pattern, ...]
    end: Pattern | None = None


_WORD_ENDS = r"(?![\w-])"
_WORD_BEGINS = r"(?<![\w.-])"
_LOWER = "a-zß-öø-ÿα-ωа-я"
_COMMENTS = (Pattern(r"##[^\n]*", (Ink.DOC,)), Pattern(r"#[^\n]*", (Ink.COMMENT,)))
_BARE = {
    "OBSERVE": Ink.SCENE,
    "RELATION": Ink.RELATION,
    "IMPORT": Ink.PREFIX,
    "DECLARE": Ink.CLASS,
}
_BEFORE_COLON = {"LANDMARK": Ink.INSTANCE, "DEFAULTS": Ink.FIELD}
_INKS = {
    Kind.CONSTANT: Ink.CONSTANT,
    Kind.STATEMENT: Ink.WORD,
    Kind.WORD: Ink.WORD,
}


@cache
def sections() -> MappingProxyType[str, Section]:
    """Return every section by its name: the root, one for each statement, and the arguments of an atom."""
    words = vocabulary()
    found = {ROOT: _root(words), ARGUMENTS: _arguments()}
    for head, inside in words.statements.items():
        found[head.lower()] = Section(tuple(_inside(head, inside, words)), _end(inside, words))
    return MappingProxyType(found)


@cache
def _terminal(name: str) -> str:
    """The regular expression of a terminal of the grammar, its groups uncounted."""
    text = next(one.pattern.value for one in reader().lark.terminals if one.name == name)
    return re.sub(r"(?<!\\)\((?!\?)", "(?:", text).replace("\n", r"\n")


def _one_of(words: tuple[str, ...]) -> str:
    return "(?:" + "|".join(re.escape(word) for word in words) + ")"


def _word(terminals: tuple[str, ...]) -> str:
    return _one_of(words_of(terminals)) + _WORD_ENDS


def _root(words: Vocabulary) -> Section:
    heads = tuple(_head(head) for head in words.statements)
    stray = Pattern(_terminal("NAME"), (None,))
    return Section((*_COMMENTS, *heads, Pattern(r"[.?{}]", (Ink.SIGN,)), stray))


def _head(head: str) -> Pattern:
    """The word a statement begins with; of a scene, its name too."""
    word = _WORD_BEGINS + f"({_word((head,))})"
    if head == "SCENE":
        return Pattern(
            rf"{word}(?:(\s+)({_terminal('NAME')})(?=\s*\())?", (Ink.STATEMENT, None, Ink.SCENE), "scene"
        )
    return Pattern(word, (Ink.STATEMENT,), head.lower())


def _end(inside: frozenset[str], words: Vocabulary) -> Pattern:
    """A full stop or a question mark; where one is missing, a closing brace or the next statement's line."""
    stops = "[.?{]" if "LBRACE" in inside and "ROOM" in inside else "[.?]"
    brace = "" if "RBRACE" in inside else r"|(?=\})"
    heads = [head for head in words.statements if head not in inside]
    plain = _word(tuple(head for head in heads if head not in words.before_parenthesis))
    opening = _word(tuple(head for head in heads if head in words.before_parenthesis))
    line = rf"^(?=[ \t]*(?:{plain}(?!\s*[:,).(])|{opening}(?!\s*[:,).])))"
    return Pattern(rf"({stops}){brace}|{line}", (Ink.SIGN,))


def _arguments() -> Section:
    """Between the parentheses of an atom."""
    role = Pattern(_terminal("NAME") + r"(?=\s*:)", (Ink.ROLE,))
    end = Pattern(r"(\))|(?=[.?{}|(])", (Ink.SIGN,))
    return Section((*_COMMENTS, role, *_objects(), Pattern("[,:]", (Ink.SIGN,))), end)


def _objects() -> tuple[Pattern, Pattern]:
    """Landmarks are told from classes by their small first letter, after the prefix of an import if there is one."""
    name = _terminal("NAME")
    small = rf"(?=(?:[\w-]+\.)*[{_LOWER}][\w-]*(?!\.?[\w-]))"
    return Pattern(small + name, (Ink.INSTANCE,)), Pattern(name, (Ink.CLASS,))


def _inside(head: str, inside: frozenset[str], words: Vocabulary) -> Iterator[Pattern]:
    yield from _COMMENTS
    yield from _literals(inside, words)
    for kind in (Kind.FIELD, Kind.DENSITY, Kind.OPERATOR, Kind.CONSTANT, Kind.STATEMENT, Kind.WORD):
        terminals = tuple(terminal for terminal in words.of(kind) if terminal in inside)
        if terminals:
            yield from _fixed(kind, terminals, words)
    yield from _names(head, inside)
    yield Pattern(r"::|[(){},:|~]", (Ink.SIGN,))


def _literals(inside: frozenset[str], words: Vocabulary) -> Iterator[Pattern]:
    for terminal, ink in (("STRING", Ink.STRING), ("TIME", Ink.NUMBER)):
        if terminal in inside:
            yield Pattern(_terminal(terminal), (ink,))
    number = _terminal("NUMBER")
    units = tuple(unit for unit in words.of(Kind.UNIT) if unit in inside)
    if units:
        yield Pattern(rf"({number})([ \t]*)({_word(units)})", (Ink.NUMBER, None, Ink.UNIT))
    yield Pattern(number, (Ink.NUMBER,))
    if "SIGN" in inside:
        yield Pattern(r"[+-](?=[ \t]*\d)", (Ink.OPERATOR,))


def _fixed(kind: Kind, terminals: tuple[str, ...], words: Vocabulary) -> Iterator[Pattern]:
    match kind:
        case Kind.FIELD:
            yield Pattern(_word(terminals) + r"(?=\s*:)", (Ink.FIELD,))
        case Kind.DENSITY:
            yield Pattern(_word(terminals) + r"(?=\s*\()", (Ink.DENSITY,))
        case Kind.OPERATOR:
            spelled = words_of(terminals)
            signs = tuple(word for word in spelled if not word[0].isalpha())
            letters = tuple(word for word in spelled if word[0].isalpha())
            yield Pattern(_one_of(signs), (Ink.OPERATOR,))
            if letters:
                yield Pattern(_one_of(letters) + _WORD_ENDS + r"(?!\s*[:,)])", (Ink.OPERATOR,))
        case _:
            if "ROOM" in terminals:
                room = rf"({_word(('ROOM',))})(\s+)({_terminal('NAME')})"
                yield Pattern(room, (Ink.WORD, None, Ink.ROOM))
            for terminal in terminals:
                after = ":" if terminal in words.before_parenthesis else ":("
                yield Pattern(rf"{_word((terminal,))}(?!\s*[{after}])", (_INKS[kind],))


def _names(head: str, inside: frozenset[str]) -> Iterator[Pattern]:
    name, builtin = _terminal("NAME"), _word_of_names(builtin_relations())
    if "LPAR" in inside and head != "LANDMARK":
        yield Pattern(rf"({builtin})(\s*)(\()", (Ink.BUILTIN, None, Ink.SIGN), ARGUMENTS)
        yield Pattern(rf"({name})(\s*)(\()", (Ink.RELATION, None, Ink.SIGN), ARGUMENTS)
    yield Pattern(rf"{name}(?=\s*:(?!:))", (_BEFORE_COLON.get(head, Ink.ROLE),))
    if head == "RELATION":
        yield Pattern(builtin, (Ink.BUILTIN,))
    if head in _BARE:
        yield Pattern(name, (_BARE[head],))
    else:
        yield from _objects()


def _word_of_names(names: tuple[str, ...]) -> str:
    return _one_of(names) + r"(?![\w.-])"
