"""Which documents make up one piece of knowledge: the file itself, what it imports, and the core."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from pathlib import Path

from qsrlang.errors import FileError
from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.parser import LANGUAGE_VERSION, parse_source
from qsrlang.language.source import Source
from qsrlang.language.source import read_source as read_file
from qsrlang.language.syntax import Document, Import, Language
from qsrlang.resources import resource_path, resource_root

MAX_FILES = 256


@dataclass(frozen=True, slots=True)
class Library:
    """The documents of one piece of knowledge, the core first, their files, and all that was found wrong in them."""

    documents: tuple[Document, ...]
    files: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]


def read_library(source: Source) -> Library:
    """Read a source with all it imports, each file once, so cycles are fine."""
    core = read_source(resource_path("knowledge", "core.qsr"))
    is_core = (
        source.path is not None and source.path.resolve() == resource_path("knowledge", "core.qsr").resolve()
    )
    waiting = deque([source] if is_core else [core, source])
    seen = {one.path.resolve() for one in waiting if one.path}
    documents: list[Document] = []
    files: list[Path] = []
    diagnostics: list[Diagnostic] = []
    while waiting:
        current = waiting.popleft()
        parsed = parse_source(current)
        documents.append(parsed.document)
        files += [current.path] if current.path else []
        diagnostics.extend(parsed.diagnostics)
        diagnostics.extend(_versions(parsed.document))
        for statement in parsed.document.statements:
            if isinstance(statement, Import):
                _follow(statement, current, seen, waiting, diagnostics)
    return Library(tuple(documents), tuple(files), tuple(diagnostics))


def find_knowledge(name: str, beside: Path | None = None) -> Path:
    """Return the path of a shipped file named without its ending, or of a path that ends in .qsr.

    Raises FileError naming the shipped files where there is none.
    """
    if name.endswith(".qsr"):
        return Path(name) if beside is None else beside / name
    root = resource_root("knowledge")
    path = (root / f"{name}.qsr").resolve()
    if path.is_relative_to(root.resolve()) and path.is_file():
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


def _follow(
    statement: Import, current: Source, seen: set[Path], waiting: deque[Source], diagnostics: list[Diagnostic]
) -> None:
    try:
        path = find_knowledge(statement.target, current.path.parent if current.path else None)
        if path.resolve() in seen:
            return
        if len(seen) >= MAX_FILES:
            raise FileError(path, "is one import too many", f"at most {MAX_FILES} files are read")
        waiting.append(read_source(path))
        seen.add(path.resolve())
    except FileError as error:
        diagnostics.append(
            Diagnostic("Q209", f"'{statement.target}': {error.problem}", statement.span, help=error.remedy)
        )


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
