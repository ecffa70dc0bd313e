"""From a name in a text to what it names: every place, in all that is open, where the same thing is written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from qsrlang.editor.workbench import Workbench
from qsrlang.errors import FileError
from qsrlang.language.source import Source, Span
from qsrlang.language.statements import Import
from qsrlang.relations.imports import find_knowledge, read_source
from qsrlang.relations.occurrences import Occurrence

Place: TypeAlias = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Thing:
    """What a name stands for: its kind, its name in the text it was asked for in, and all its places."""

    kind: str
    name: str
    places: tuple[Occurrence, ...]

    @property
    def definitions(self) -> tuple[Span, ...]:
        """Where it is defined."""
        return tuple(one.span for one in self.places if one.defines)


def occurrence_at(bench: Workbench, address: str, offset: int) -> Occurrence | None:
    """Return the name that an offset of an open text is in or at the end of."""
    source = bench.source(address)
    for one in bench.reading(address).names:
        if one.span.source is source and one.span.start <= offset <= one.span.end:
            return one
    return None


def thing_at(bench: Workbench, address: str, offset: int) -> Thing | None:
    """Return what the name at an offset stands for, with its places in all open texts and in what they import."""
    here = occurrence_at(bench, address, offset)
    if here is None:
        return None
    addresses = _Addresses(bench)
    groups = [group for reading in bench.readings() for group in _groups(reading.names, addresses)]
    known = {addresses.place(here)}
    found: dict[Place, Occurrence] = {}
    while waiting := [group for group in groups if not known.isdisjoint(group)]:
        groups = [group for group in groups if known.isdisjoint(group)]
        for group in waiting:
            known |= group.keys()
            found |= group
    ordered = sorted(found.items(), key=lambda item: item[0])
    return Thing(here.kind, here.name, tuple(one for _, one in ordered))


def imported_at(bench: Workbench, address: str, offset: int) -> Source | None:
    """Return the file that the import statement at an offset names."""
    source = bench.source(address)
    for document in bench.built(address).library.documents:
        for statement in document.statements:
            span = statement.span
            if isinstance(statement, Import) and span.source is source and span.start <= offset <= span.end:
                return _file(statement, span.source)
    return None


def _file(statement: Import, source: Source) -> Source | None:
    try:
        return read_source(find_knowledge(statement.target, source.path.parent if source.path else None))
    except FileError:
        return None


class _Addresses:
    """Finds the address of each source once."""

    def __init__(self, bench: Workbench) -> None:
        self._bench = bench
        self._found: dict[int, str] = {}

    def place(self, one: Occurrence) -> Place:
        """Return the place of an occurrence."""
        source = one.span.source
        address = self._found.get(id(source)) or self._bench.address_of(source)
        self._found[id(source)] = address
        return address, one.span.start


def _groups(names: Iterable[Occurrence], addresses: _Addresses) -> Iterator[dict[Place, Occurrence]]:
    """Yield the occurrences in a library that belong together, each group by places."""
    groups: dict[tuple[str, str], dict[Place, Occurrence]] = {}
    for one in names:
        groups.setdefault((one.kind, one.name), {})[addresses.place(one)] = one
    yield from groups.values()
