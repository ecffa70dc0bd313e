"""What each word of the language is, read off the rules of the grammar, so that no list of words can drift from it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from itertools import pairwise
from types import MappingProxyType
from typing import TypeAlias

from qsrlang.language.grammar import reader, spellings
from qsrlang.language.parser import parse_source
from qsrlang.language.source import read_source
from qsrlang.language.statements import Relation
from qsrlang.resources import resource_path

_Rules: TypeAlias = Mapping[str, Sequence[tuple[str, ...]]]

_STARTS = ("statement", "context_head", "query")


class Kind(Enum):
    """What a fixed terminal is to a reader; each is told by where the rules put it."""

    STATEMENT = "begins a statement, a context or a query"
    FIELD = "names a field, before a colon"
    DENSITY = "takes arguments, such as normal"
    OPERATOR = "has a sign and perhaps a word, such as ∧ and `and`"
    UNIT = "follows a number"
    CONSTANT = "is a value, such as yes or weekend"
    WORD = "joins parts of a statement, such as at or wrt"
    SIGN = "is punctuation"


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The fixed terminals by kind, those that each statement or query may hold, those that begin a statement or a
    context, and those that a parenthesis may follow.
    """

    kinds: MappingProxyType[str, Kind]
    statements: MappingProxyType[str, frozenset[str]]
    beginnings: frozenset[str]
    before_parenthesis: frozenset[str]

    def of(self, kind: Kind) -> tuple[str, ...]:
        """Return the terminals of a kind, in the order of the grammar."""
        return tuple(terminal for terminal, its in self.kinds.items() if its is kind)


def words_of(terminals: Iterable[str]) -> tuple[str, ...]:
    """Return every spelling of some terminals, the longest first, so that they can be tried in turn."""
    words = (word for terminal in terminals for word in spellings().get(terminal, ()))
    return tuple(sorted(words, key=lambda word: (-len(word), word)))


@cache
def vocabulary() -> Vocabulary:
    """Return what the words of the language are."""
    rules = _rules()
    statements: dict[str, frozenset[str]] = {}
    for head, inside in (found for start in _STARTS for found in _begun_by(rules, start)):
        statements[head] = statements.get(head, frozenset()) | inside
    neighbours = {pair for each in rules.values() for symbols in each for pair in pairwise(symbols)}
    kinds = {terminal: _kind(terminal, neighbours, statements) for terminal in spellings()}
    opening = {name for name in rules if "LPAR" in _closure(rules, (name,), first_only=True)} | {"LPAR"}
    return Vocabulary(
        MappingProxyType(kinds),
        MappingProxyType({head: statements[head] for head in kinds if head in statements}),
        frozenset(statements.keys() & _closure(rules, ("statement", "context_head"), first_only=True)),
        frozenset(before for before, after in neighbours if after in opening),
    )


@cache
def builtin_relations() -> tuple[str, ...]:
    """Return the names of the relations that every file sees."""
    core = parse_source(read_source(resource_path("knowledge", "core.qsr")))
    found = (one.name.text for one in core.document.statements if isinstance(one, Relation))
    return tuple(sorted(found, key=lambda name: (-len(name), name)))


def _kind(terminal: str, neighbours: set[tuple[str, str]], statements: Mapping[str, frozenset[str]]) -> Kind:
    words = spellings()[terminal]
    before = {first for first, second in neighbours if second == terminal}
    after = {second for first, second in neighbours if first == terminal}
    if terminal in statements:
        return Kind.STATEMENT
    if before == {"NUMBER"} and not after:
        return Kind.UNIT
    if not words[0][0].isalpha():
        return Kind.OPERATOR if len(words) > 1 else Kind.SIGN
    if not after:
        return Kind.CONSTANT
    return {frozenset({"COLON"}): Kind.FIELD, frozenset({"LPAR"}): Kind.DENSITY}.get(
        frozenset(after), Kind.WORD
    )


def _rules() -> _Rules:
    """The symbols that each rule may come to, without the rules that join statements to a text."""
    found: dict[str, list[tuple[str, ...]]] = {}
    for rule in reader().lark.rules:
        symbols = tuple(symbol.name for symbol in rule.expansion)
        if symbols and "statement" not in symbols:
            found.setdefault(rule.origin.name, []).append(symbols)
    return found


def _begun_by(rules: _Rules, name: str) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield each terminal that a rule may begin with, and all that may follow it within the rule."""
    for first, *rest in rules.get(name, ()):
        for head, inside in [(first, frozenset[str]())] if first not in rules else _begun_by(rules, first):
            yield head, inside | _closure(rules, rest)


def _closure(rules: _Rules, symbols: Iterable[str], first_only: bool = False) -> frozenset[str]:
    """Every symbol that the symbols come to, or only those they begin with."""
    found = set(symbols)
    waiting = list(found)
    while waiting:
        for expansion in rules.get(waiting.pop(), ()):
            fresh = set(expansion[:1] if first_only else expansion) - found
            found |= fresh
            waiting += fresh
    return frozenset(found)
