"""A session as a file: one that `qsr check` accepts, and the file that `:load` reads."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from qsrlang.cli.shell.session import Knowledge, Session
from qsrlang.errors import FileError
from qsrlang.files import write_whole
from qsrlang.language.diagnostics import Edit, raise_errors
from qsrlang.language.fixing import edited
from qsrlang.language.parser import parse_source
from qsrlang.language.source import Source, Span
from qsrlang.language.statements import Import
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import find_knowledge, read_source, shipped_knowledge

ENDING = ".qsr"


def typed_path(text: str) -> str:
    """Return a path as it was typed: perhaps in quotes, perhaps from the home folder."""
    is_quoted = len(text) > 1 and text[0] == text[-1] == '"'
    return os.path.expanduser(text[1:-1] if is_quoted else text)  # noqa: PTH111


def read_knowledge(name: str) -> Knowledge:
    """Return what a shipped file, or a path that ends in .qsr, holds; raises FileError."""
    source = read_source(find_knowledge(name))
    return Knowledge(source, is_shipped=name in shipped_knowledge())


def reload_file(session: Session) -> Session:
    """Return the session with its file read anew, and with the statements that no file holds yet."""
    name = str(session.knowledge.opening.path or "")
    if not name:
        raise FileError("this session", "has no file", ":load one, or :save to one")
    fresh = read_knowledge(session.knowledge.name if session.knowledge.is_shipped else name)
    stated = session.knowledge.stated if fresh.is_shipped else session.unsaved
    return session.become(replace(fresh, stated=stated))


def save(session: Session, path: Path, *, overwrite: bool = False) -> Session:
    """Write what is known to a file, whole or not at all, and return the session that goes on with that file.

    Imports of paths are turned to lead from the new folder. Raises FileError, and LanguageError where the file
    would have errors.
    """
    if path.suffix != ENDING:
        raise FileError(path, "knowledge is not written under this ending", f"end the name in {ENDING}")
    if os.path.lexists(path) and not overwrite:
        raise FileError(path, "is there already", f":save! {path} overwrites it")
    knowledge = _moved(session.knowledge, path)
    raise_errors(build_graph(knowledge.source).diagnostics)
    write_whole(path, knowledge.source.text)
    return session.saved_as(knowledge)


def _moved(knowledge: Knowledge, path: Path) -> Knowledge:
    """Return the knowledge as the file at a path holds it."""
    old = knowledge.opening.path
    start = Path() if old is None or knowledge.is_shipped else old.parent
    heading = _turned(knowledge.heading, start, path.parent)
    stated = tuple(replace(one, text=_turned(one.text, start, path.parent)) for one in knowledge.stated)
    return Knowledge(Source(str(path), heading, path), stated=stated)


def _turned(text: str, old: Path, new: Path) -> str:
    """Return a text with its imports of paths leading from the new folder to where they led from the old one."""
    if old.resolve() == new.resolve():
        return text
    edits = []
    for statement in imports_of_paths(text):
        written = f'"{statement.target}"'
        start = text.index(written, statement.span.start)
        leading = Path(os.path.relpath(old.resolve() / statement.target, new.resolve())).as_posix()
        edits.append(Edit(Span(statement.span.source, start, start + len(written)), f'"{leading}"'))
    return edited(text, edits)


def imports_of_paths(text: str) -> list[Import]:
    """Return the imports of a text that name a path, not a shipped file."""
    statements = parse_source(Source("", text)).document.statements
    return [one for one in statements if isinstance(one, Import) and one.target.endswith(ENDING)]
