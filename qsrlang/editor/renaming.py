"""A new name for a thing, wherever it is written, or why it cannot have it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from qsrlang.editor.navigation import Thing
from qsrlang.editor.workbench import Reading, is_shipped
from qsrlang.errors import QSRError
from qsrlang.language.diagnostics import Edit
from qsrlang.language.grammar import keywords
from qsrlang.language.source import Source
from qsrlang.language.splitting import Kind, Piece, split
from qsrlang.language.words import WORD
from qsrlang.relations.symbols import flat

_NAME = re.compile(WORD)


class RenamingError(QSRError):
    """A thing that cannot be renamed, or not so, or not now."""


def check_renamable(thing: Thing) -> None:
    """Raise RenamingError where a thing is defined in a shipped file, or by the language itself."""
    for span in thing.definitions:
        if is_shipped(span.source):
            raise RenamingError(
                f"'{thing.name}' is defined in {span.source.name}, which came with qsrlang; "
                "define a name of your own instead"
            )


def rename(thing: Thing, new: str, readings: Iterable[Reading]) -> tuple[Edit, ...]:
    """Return the edits that give a thing a new name; raises RenamingError where that would break something."""
    readings = tuple(readings)
    check_renamable(thing)
    _check_name(new)
    _check_free(thing, new, readings)
    _check_readable(thing, readings)
    return tuple(Edit(one.span, new) for one in thing.places if not is_shipped(one.span.source))


def _check_name(new: str) -> None:
    if not _NAME.fullmatch(new):
        raise RenamingError(f"'{new}' is no name: use letters, digits, '_' and inner hyphens, a letter first")
    if new in keywords():
        raise RenamingError(f"'{new}' is a word of the language")


def _check_free(thing: Thing, new: str, readings: Iterable[Reading]) -> None:
    """Classes and landmarks share their names; other kinds keep to themselves."""
    alike = ("class", "landmark") if thing.kind in ("class", "landmark") else (thing.kind,)
    places = {one.span for one in thing.places}
    for reading in readings:
        wanted = {_renamed(one.name, one.span.text, new) for one in reading.names if one.span in places}
        for other in reading.names:
            if other.kind in alike and other.name in wanted and other.span not in places:
                raise RenamingError(f"'{new}' is used already ({other.span})")


def _renamed(name: str, old: str, new: str) -> str:
    """The whole name with its own part exchanged: the last part of `lab.Cup`, the first of `left: Cup`."""
    return new + name[len(old) :] if name.startswith(f"{old}:") else name.removesuffix(old) + new


def _check_readable(thing: Thing, readings: Iterable[Reading]) -> None:
    """Statements that cannot be read might speak of the thing: they must be mended first."""
    words = {one.span.text for one in thing.places}
    files = {one.span.source for one in thing.places}
    for reading in readings:
        for source in files.intersection(reading.built.library.sources):
            for piece in _unread(source, reading):
                if words & set(_NAME.findall(piece.span.text)):
                    raise RenamingError(
                        f"the statement at {piece.span} cannot be read and might speak of it; mend it first"
                    )


def _unread(source: Source, reading: Reading) -> Iterator[Piece]:
    documents = reading.built.library.documents
    statements = (one for document in documents for one in flat(document.statements))
    read = {one.span.start for one in statements if one.span.source == source}
    return (piece for piece in split(source) if piece.kind is Kind.STATEMENT and piece.span.start not in read)
