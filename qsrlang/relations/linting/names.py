"""Rules about names: classes that nothing places or without a capital, imports that nothing uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from qsrlang.language.diagnostics import Diagnostic, Edit
from qsrlang.language.source import Source
from qsrlang.language.statements import (
    Declaration,
    DeclaredClass,
    Defaults,
    Document,
    Import,
    Language,
)
from qsrlang.language.syntax import Role, atoms_of
from qsrlang.relations.imports import Library, find_knowledge
from qsrlang.relations.linting.linted import Linted, warning, whole_statement, without_comments
from qsrlang.relations.occurrences import occurrences

_NAMED = ("class", "landmark", "relation", "scene")


def unplaced_classes(linted: Linted) -> Iterator[Diagnostic]:
    """Dynamic classes that no atom and no landmark speaks of, in a file that says where things are."""
    if linted.is_broken or not any(True for _ in linted.formulas()):
        return
    symbols = linted.symbols
    spoken_of = {landmark.kind for landmark in symbols.landmarks.values()}
    for document in linted.built.library.documents:
        for _, formula in Linted(linted.source, document, linted.built).formulas():
            for argument in (one for atom in atoms_of(formula) for one in atom.arguments):
                kind = argument.kind if isinstance(argument, Role) else argument
                spoken_of.add(symbols.class_of(kind.text))
    for declared in _declared(linted.document, "dynamic"):
        if declared.name.text not in spoken_of:
            name = declared.name
            yield warning(
                "Q503",
                f"'{name}' is never placed",
                name.span,
                "no relation and no landmark says where one is",
                f"say where it is, for instance 'believe on({name}, …).', or leave the class out",
            )


def uncapitalised_classes(linted: Linted) -> Iterator[Diagnostic]:
    """Classes whose names begin with a small letter, where they are declared or brought in by a scene."""
    own = [one for one in occurrences(linted.built.library) if one.span.source is linted.source]
    for one in own:
        initial = one.span.text[:1]
        # Georgian has capitals too, but no word begins with one: there title case is the letter itself.
        if one.kind == "class" and one.defines and initial.islower() and initial.title() != initial:
            capital = initial.title() + one.span.text[1:]
            clash = capital in linted.symbols.classes or capital in linted.symbols.landmarks
            places = [other.span for other in own if (other.kind, other.name) == ("class", one.name)]
            yield warning(
                "Q511",
                f"the class '{one.span.text}' begins with a small letter",
                one.span,
                "classes begin with a capital by convention",
                f"write '{capital}'" + (", or another name, for that one is taken" if clash else ""),
                edits=() if clash else tuple(Edit(place, capital) for place in places),
            )


def unused_imports(linted: Linted) -> Iterator[Diagnostic]:
    """Imports that share no name with a file; one without statements of its own passes all of them on."""
    statements = linted.document.statements
    imports = [one for one in statements if isinstance(one, Import)]
    passes_on = all(isinstance(one, Import | Language | Defaults) for one in statements)
    if linted.is_broken or passes_on or not imports:
        return
    named = _names_by_file(linted.built.library)
    own = named[_resolved(linted.source)] - named[_resolved(linted.built.library.sources[0])]
    for one in imports:
        if not _is_used(one, own, named, linted):
            shown = f'"{one.target}"' + (f" as {one.alias}" if one.alias else "")
            yield warning(
                "Q508",
                f"the import {shown} is not used",
                one.span,
                "no name of it, or of what it imports, is written in this file",
                "delete the import",
                edits=without_comments(Edit(whole_statement(one.span), "")),
            )


def _is_used(one: Import, own: set[str], named: Mapping[Path | None, set[str]], linted: Linted) -> bool:
    """Whether a file mentions a name of an import; defaults that it sets hold without being named."""
    if one.alias is not None:
        return any(name.startswith(f"{one.alias}.") for name in own)
    files = _imported(one, linted)
    defaults = (document for path, document in _documents(linted.built.library) if path in files)
    if any(isinstance(statement, Defaults) for document in defaults for statement in document.statements):
        return True
    return any(own & named[path] for path in files)


def _imported(one: Import, linted: Linted) -> set[Path | None]:
    """Return the files that an import brings in, by itself and by its own imports, without the file it stands in."""
    documents = _documents(linted.built.library)
    found: set[Path | None] = {_resolved(linted.source)}
    waiting = [(one, linted.source.path)]
    while waiting:
        statement, at = waiting.pop()
        path = find_knowledge(statement.target, at.parent if at else None).resolve()
        if path not in found:
            found.add(path)
            inner = [
                (other, path) for file, document in documents if file == path for other in document.statements
            ]
            waiting += [(other, file) for other, file in inner if isinstance(other, Import)]
    return found - {_resolved(linted.source)}


def _documents(library: Library) -> list[tuple[Path | None, Document]]:
    return [(_resolved(source), one) for source, one in zip(library.sources, library.documents, strict=True)]


def _names_by_file(library: Library) -> Mapping[Path | None, set[str]]:
    """Return the names of classes, landmarks, relations and scenes that each file writes."""
    names: dict[Path | None, set[str]] = {_resolved(source): set() for source in library.sources}
    for one in occurrences(library):
        if one.kind in _NAMED:
            names[_resolved(one.span.source)].add(one.name)
    return names


def _resolved(source: Source) -> Path | None:
    return source.path.resolve() if source.path else None


def _declared(document: Document, kind: str) -> Iterator[DeclaredClass]:
    for statement in document.statements:
        if isinstance(statement, Declaration) and statement.kind == kind:
            yield from statement.classes
