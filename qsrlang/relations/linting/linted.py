"""A file as its linter sees it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from qsrlang.language.diagnostics import Diagnostic, Edit, Severity
from qsrlang.language.source import Source, Span
from qsrlang.language.splitting import skip_blank
from qsrlang.language.statements import Believe, Document, Elsewhere, Observe, Require, Scene, Statement
from qsrlang.language.syntax import Formula, Role
from qsrlang.relations.build import Built
from qsrlang.relations.evidence import with_roles
from qsrlang.relations.graph import Landmark
from qsrlang.relations.symbols import Symbols, flat


@dataclass(frozen=True, slots=True)
class Linted:
    """A source with its document and all that was built from it, the viewer (x, y) [m] and further landmarks."""

    source: Source
    document: Document
    built: Built
    viewer: tuple[float, float] | None = None
    further: tuple[Landmark, ...] = ()

    @classmethod
    def of(
        cls,
        built: Built,
        source: Source,
        viewer: tuple[float, float] | None = None,
        further: tuple[Landmark, ...] = (),
    ) -> Linted:
        """Return a source of a library; of one that is not in it, nothing is seen."""
        documents = zip(built.library.sources, built.library.documents, strict=True)
        own = (document for one, document in documents if one is source)
        return cls(source, next(own, Document(())), built, viewer, further)

    @property
    def symbols(self) -> Symbols:
        """What the names of the library stand for."""
        return self.built.symbols

    @property
    def landmarks(self) -> Iterable[Landmark]:
        """The landmarks of the library and the further ones, which stand in the place of those of the same name."""
        return {**self.symbols.landmarks, **{one.name: one for one in self.further}}.values()

    @property
    def is_broken(self) -> bool:
        """Whether parts could not be read, so that what seems to be missing may be there."""
        return any(finding.is_error for finding in self.built.diagnostics)

    def statements(self) -> Iterable[Statement]:
        """Return the statements, those in contexts too."""
        return flat(self.document.statements)

    def formulas(self) -> Iterator[tuple[Statement, Formula]]:
        """Yield each formula with its statement, the roles of scenes in place of their bare names."""
        for statement in self.statements():
            match statement:
                case Scene(members=members, formula=formula):
                    roles = {one.role.text: one for one in members if isinstance(one, Role)}
                    yield statement, with_roles(formula, roles)
                case Observe(formula=formula) | Require(formula=formula):
                    yield statement, formula
                case Believe(alternatives=alternatives):
                    for one in alternatives:
                        if not isinstance(one.formula, Elsewhere):
                            yield statement, one.formula


def warning(code: str, message: str, span: Span, note: str, help_text: str, **more: Any) -> Diagnostic:
    """Return a warning whose edits, if it has any, are one way among others."""
    return Diagnostic(code, message, span, note, help_text, severity=Severity.WARNING, sure=False, **more)


def whole_statement(span: Span) -> Span:
    """Return the place of a statement with its full stop, or with its whole lines if nothing else is on them."""
    text = span.source.text
    end = skip_blank(text, span.end) + 1
    first, after = text.rfind("\n", 0, span.start) + 1, text.find("\n", end) + 1
    last = after or len(text)
    alone = not text[first : span.start].strip() and not text[end:last].strip()
    return Span(span.source, first, last) if alone else Span(span.source, span.start, end)


def without_comments(edit: Edit) -> tuple[Edit, ...]:
    """Return an edit, or none where it would delete a comment."""
    return () if "#" in edit.span.text else (edit,)
