"""Which documents make up one piece of knowledge: the file itself, what it imports, and the core."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from qsrlang.errors import FileError
from qsrlang.language.diagnostics import Diagnostic, Label
from qsrlang.language.parser import LANGUAGE_VERSION, Parsed, parse_source
from qsrlang.language.source import Source
from qsrlang.language.source import read_source as read_file
from qsrlang.language.statements import Document, Import, Landmark, Language, Relation, Scene
from qsrlang.relations.prefixes import under_prefix
from qsrlang.resources import resource_path, resource_root

MAX_FILES = 256
NOTHING_OPENED: Mapping[Path, Source] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Library:
    """The documents of one piece of knowledge, the core first, their sources, and all that was found wrong in them.

    `lost` are the names that what could not be read would have defined.
    """

    documents: tuple[Document, ...]
    sources: tuple[Source, ...]
    diagnostics: tuple[Diagnostic, ...]
    lost: frozenset[str] = frozenset()

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that were read."""
        return tuple(source.path for source in self.sources if source.path)


@dataclass(frozen=True, slots=True)
class _Request:
    """A source to be read under a prefix; `chain` holds the files whose names the prefixes stand for."""

    source: Source
    prefix: str = ""
    chain: tuple[Path, ...] = ()


@dataclass(slots=True)
class _Reading:
    """A library while it is being read."""

    roots: tuple[Path, ...]
    opened: Mapping[Path, Source]
    waiting: deque[_Request]
    seen: set[tuple[Path, str]] = field(default_factory=set)
    built_in: frozenset[str] = frozenset()
    documents: list[Document] = field(default_factory=list)
    sources: list[Source] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    lost: set[str] = field(default_factory=set)


def read_library(source: Source, opened: Mapping[Path, Source] = NOTHING_OPENED) -> Library:
    """Read a source with all it imports, each file once, so cycles are fine; `opened` sources stand for their files."""
    core = _core().source
    is_core = source.path is not None and source.path.resolve() == (core.path or Path()).resolve()
    first = [_Request(one) for one in ([source] if is_core else [core, source])]
    reading = _Reading(_roots(source), opened, deque(first))
    reading.seen = {(one.source.path.resolve(), "") for one in reading.waiting if one.source.path}
    while reading.waiting:
        _read(reading.waiting.popleft(), reading)
    return Library(
        tuple(reading.documents), tuple(reading.sources), tuple(reading.diagnostics), frozenset(reading.lost)
    )


def find_knowledge(name: str, beside: Path | None = None) -> Path:
    """Return the path of a shipped file named without its ending, or of a path that ends in .qsr.

    Raises FileError naming the shipped files where there is none.
    """
    if name.endswith(".qsr"):
        return Path(name) if beside is None else beside / name
    root = resource_root("knowledge")
    path = _resolved(root / f"{name}.qsr")
    if path.is_relative_to(root.resolve()) and _is_file(path):
        return root / f"{name}.qsr"
    shipped = ", ".join(shipped_knowledge())
    raise FileError(name, "no such file is shipped", f"shipped are {shipped}; a path ends in .qsr")


def read_source(path: Path) -> Source:
    """Read a file; a shipped one is shown by its place among the shipped files."""
    root = resource_root("knowledge")
    return read_file(path, path.relative_to(root).as_posix() if path.is_relative_to(root) else None)


def shipped_knowledge() -> list[str]:
    """Return the names of all shipped knowledge files, such as office/desk."""
    root = resource_root("knowledge")
    return sorted(path.relative_to(root).with_suffix("").as_posix() for path in root.rglob("*.qsr"))


class _Core(NamedTuple):
    source: Source
    parsed: Parsed


@cache
def _core() -> _Core:
    """Return the built-in definitions, which do not change while the program runs."""
    source = read_source(resource_path("knowledge", "core.qsr"))
    return _Core(source, parse_source(source))


def _roots(source: Source) -> tuple[Path, ...]:
    """Return the folders that imports may lead into: the first file's, those of QSR_PATH, and the shipped one."""
    first = source.path.parent if source.path else Path()
    further = [Path(entry) for entry in os.environ.get("QSR_PATH", "").split(os.pathsep) if entry]
    return tuple(folder.resolve() for folder in (first, *further, resource_root("knowledge")))


def _read(request: _Request, reading: _Reading) -> None:
    parsed = _core().parsed if request.source is _core().source else parse_source(request.source)
    document = parsed.document
    if request.prefix:
        document = under_prefix(document, request.prefix, reading.built_in)
    elif not reading.documents:
        reading.built_in = frozenset(_defined(document))
    reading.documents.append(document)
    reading.sources.append(request.source)
    reading.diagnostics += [*parsed.diagnostics, *_versions(document), *_prefixes_twice(document)]
    reading.lost |= {f"{request.prefix}.{name}" if request.prefix else name for name in parsed.lost}
    for statement in document.statements:
        if isinstance(statement, Import):
            _follow(statement, request, reading)


def _follow(statement: Import, request: _Request, reading: _Reading) -> None:
    try:
        path = find_knowledge(statement.target, request.source.path.parent if request.source.path else None)
        _enqueue(path, statement, request, reading)
    except FileError as error:
        message = f"'{statement.target}': {error.problem}"
        reading.diagnostics.append(Diagnostic("Q209", message, statement.span, help=error.remedy))


def _enqueue(path: Path, statement: Import, request: _Request, reading: _Reading) -> None:
    where = _resolved(path)
    prefix, chain = request.prefix, request.chain
    if statement.alias is not None:
        own = (request.source.path.resolve(),) if request.source.path else ()
        if where in (*chain, *own):
            raise FileError(path, "imports itself under a prefix", "import it without 'as'")
        prefix = f"{prefix}.{statement.alias.text}" if prefix else statement.alias.text
        chain = (*chain, *own, where)
    if (where, prefix) in reading.seen:
        return
    if not any(where.is_relative_to(root) for root in reading.roots):
        remedy = "imports stay in the folder of the first file and below; add further folders to QSR_PATH"
        raise FileError(path, "lies outside the folders that may be imported from", remedy)
    if len(reading.seen) >= MAX_FILES:
        raise FileError(path, "is one import too many", f"at most {MAX_FILES} files are read")
    source = reading.opened.get(where) or read_source(path)
    reading.waiting.append(_Request(source, prefix, chain))
    reading.seen.add((where, prefix))


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise FileError(str(path), "is no usable path", "give the path of a .qsr file") from error


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        return False


def _defined(document: Document) -> list[str]:
    named = (one.name for one in document.statements if isinstance(one, Relation | Landmark | Scene))
    return [name.text for name in named if name is not None]


def _versions(document: Document) -> list[Diagnostic]:
    return [
        Diagnostic(
            "Q212",
            f"this file is written in language {statement.version}",
            statement.span,
            f"this program reads language {LANGUAGE_VERSION}",
            "install a newer qsrlang",
        )
        for statement in document.statements
        if isinstance(statement, Language) and statement.version > LANGUAGE_VERSION
    ]


def _prefixes_twice(document: Document) -> list[Diagnostic]:
    aliases = [one.alias for one in document.statements if isinstance(one, Import) and one.alias]
    first = {alias.text: alias for alias in reversed(aliases)}
    return [
        Diagnostic(
            "Q213",
            f"the prefix '{alias}' is used twice",
            alias.span,
            labels=(Label(first[alias.text].span, "first used here"),),
        )
        for alias in aliases
        if alias is not first[alias.text]
    ]
