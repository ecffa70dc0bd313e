"""What may be written at a place: words and signs the grammar accepts there, and the names that fit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from qsrlang.editor.candidates import candidates
from qsrlang.editor.cursor import Cursor, Surroundings, find_cursor
from qsrlang.editor.vocabulary import Kind, vocabulary, words_of
from qsrlang.language.codes import CODES
from qsrlang.language.expecting import Expectation, expected_after
from qsrlang.language.grammar import spellings
from qsrlang.language.parser import CONTEXTUAL
from qsrlang.language.quantities import UNITS
from qsrlang.language.syntax import Dimension
from qsrlang.relations.build import Built
from qsrlang.relations.imports import shipped_knowledge

MAX_STATEMENT = 20_000
"""Longer unfinished statements are not completed [characters]."""

_SILENCEABLE = ("Q5", "Q6")
_IN_CONTEXTS = frozenset(statement.__name__.upper() for statement in CONTEXTUAL)
_KINDS = {Kind.UNIT: "unit", Kind.OPERATOR: "sign", Kind.SIGN: "sign"}
_MEASURED = {
    "ANGLE": (Dimension.ANGLE,),
    "FACING": (Dimension.ANGLE,),
    "SIZE": (Dimension.LENGTH,),
    "HEIGHT": (Dimension.LENGTH,),
    "AT": (Dimension.LENGTH,),
    "TILDE": (Dimension.LENGTH,),
    "PLUSMINUS": (Dimension.LENGTH, Dimension.ANGLE),
    "DISTANCE": (Dimension.LENGTH, Dimension.FRACTION),
}


@dataclass(frozen=True, slots=True)
class Completion:
    """Something that may be written in place of what stands from `start` to the cursor.

    `kind` is keyword, sign, unit, class, landmark, relation, scene, role, default, room, file or code; `detail` says
    in a few words what it is.
    """

    text: str
    kind: str
    detail: str
    start: int


def complete(text: str, position: int, built: Built, query: bool = False) -> tuple[Completion, ...]:
    """Return what may be written at a position of a text, finished or not: of a file, or with `query` of a question.

    What was typed of a word already is kept: only what begins like it is returned, whatever its case.
    """
    cursor = find_cursor(text, position, query)
    if len(cursor.statement.text) > MAX_STATEMENT:
        return ()
    typed = cursor.word.text.casefold()
    fitting = (one for one in _all(cursor, built, query) if one.text.casefold().startswith(typed))
    return tuple(dict.fromkeys(fitting))


def _all(cursor: Cursor, built: Built, query: bool) -> Iterator[Completion]:
    start = cursor.word.start
    if cursor.surroundings is Surroundings.COMMENT:
        yield from _codes(cursor)
        return
    expectation = expected_after(cursor.statement, query)
    if "STRING" in expectation.accepted:
        yield from _files(cursor)
    if cursor.surroundings is Surroundings.STRING:
        return
    if "NAME" in expectation.accepted:
        for name in candidates(expectation, built):
            yield Completion(name.text, name.kind, name.detail, start)
    for terminal in _terminals(cursor, expectation):
        yield from _spelled(terminal, expectation, start)
    if "$END" in expectation.accepted:
        yield Completion(".", "sign", "ends the statement", start)
    if cursor.begins_line and not query:
        yield from (Completion(word, "keyword", "", start) for word in words_of(vocabulary().beginnings))


def _files(cursor: Cursor) -> Iterator[Completion]:
    """The shipped files an import may name, in quotes where none are open."""
    quote = "" if cursor.surroundings is Surroundings.STRING else '"'
    for name in shipped_knowledge():
        if name != "core":
            yield Completion(f"{quote}{name}{quote}", "file", "shipped knowledge", cursor.word.start)


def _codes(cursor: Cursor) -> Iterator[Completion]:
    """The codes that a comment `# allow Q503` may name."""
    source, start = cursor.word.source, cursor.word.start
    comment = source.text[source.text.rfind("#", 0, start) : start]
    if comment.lstrip("# ").startswith("allow "):
        for code, title in CODES.items():
            if code.startswith(_SILENCEABLE):
                yield Completion(code, "code", title, start)


def _terminals(cursor: Cursor, expectation: Expectation) -> Iterable[str]:
    """The fixed terminals that are accepted, in the order of the grammar, punctuation last."""
    accepted = set(expectation.accepted)
    if cursor.in_context and not expectation.words:
        accepted = (accepted & _IN_CONTEXTS) | {"RBRACE"}
    kinds = vocabulary().kinds
    order = [kind for kind in Kind if kind is not Kind.SIGN] + [Kind.SIGN]
    return [
        terminal for kind in order for terminal in kinds if kinds[terminal] is kind and terminal in accepted
    ]


def _spelled(terminal: str, expectation: Expectation, start: int) -> Iterator[Completion]:
    """A terminal as it may be written; of an operator its sign and its word."""
    words, kind = spellings()[terminal], vocabulary().kinds[terminal]
    if kind is Kind.OPERATOR:
        sign, letters = words[0], [word for word in words if word[0].isalpha()]
        yield from (Completion(word, "keyword", sign, start) for word in letters)
        yield Completion(sign, "sign", ", ".join(words[1:]), start)
    elif kind is Kind.UNIT:
        measured = _measured(expectation)
        units = ((word, UNITS[word][0]) for word in words)
        yield from (Completion(word, "unit", what.value, start) for word, what in units if what in measured)
    else:
        yield from (Completion(word, _KINDS.get(kind, "keyword"), "", start) for word in words)


def _measured(expectation: Expectation) -> tuple[Dimension, ...]:
    """What a quantity at this place can measure, told by the last open word that says so."""
    types = [word.type for word in expectation.open if word is not None]
    told = [_MEASURED[one] for one in types if one in _MEASURED]
    return told[-1] if told else tuple(Dimension)
