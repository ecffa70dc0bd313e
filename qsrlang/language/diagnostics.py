"""What is wrong with a text, as data, and how it is shown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from qsrlang.errors import QSRError
from qsrlang.language.rendering import Mark, Row, rows
from qsrlang.language.source import Span


class Severity(Enum):
    """How grave a diagnostic is; only errors keep a file from being used."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True, slots=True)
class Label:
    """A further place that belongs to a diagnostic, and what it is there."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Edit:
    """A change that mends a finding: put `text` in place of the characters of `span`."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about a text: code, message, where, further places, what would help, and the edits that do so.

    The edits, if any, belong together: making all of them does what `help` says. `sure` tells whether they can only
    be what was meant, so that they may be made without asking.
    """

    code: str
    message: str
    span: Span
    note: str = ""
    help: str = ""
    labels: tuple[Label, ...] = ()
    severity: Severity = Severity.ERROR
    edits: tuple[Edit, ...] = ()
    sure: bool = True

    @property
    def is_error(self) -> bool:
        """Whether the text cannot be used before this is mended."""
        return self.severity is Severity.ERROR

    def rows(self) -> Iterator[Row]:
        """Yield the rows of the finding as it is shown: head, file, line and column, the lines themselves, help."""
        marks = [Mark(self.span, self.note, True), *(Mark(one.span, one.text, False) for one in self.labels)]
        return rows(f"{self.severity.value}[{self.code}]: {self.message}", marks, self.help)

    def render(self) -> str:
        """Return the finding with file, line, column, the lines themselves and marks under the places."""
        return "\n".join(row.text for row in self.rows())

    def to_json(self) -> dict[str, object]:
        """Return the finding as plain data."""
        return {
            "code": self.code,
            "severity": self.severity.value,
            "message": self.message,
            "note": self.note,
            "help": self.help,
            **_place(self.span),
            "labels": [{**_place(label.span), "text": label.text} for label in self.labels],
            "edits": [{**_place(edit.span), "text": edit.text} for edit in self.edits],
        }


class Diagnostics(tuple[Diagnostic, ...]):
    """Findings in order; printed, each is shown with its places."""

    __slots__ = ()

    @property
    def errors(self) -> Diagnostics:
        """Those that must be mended before the text can be used."""
        return Diagnostics(finding for finding in self if finding.is_error)

    def __str__(self) -> str:
        return "\n\n".join(finding.render() for finding in self)


class LanguageError(QSRError):
    """A text that cannot be used, with all that was found in it."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = Diagnostics(diagnostics)
        super().__init__(str(self.diagnostics))


def raise_errors(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise LanguageError with the errors among the diagnostics, if there are any."""
    errors = Diagnostics(diagnostics).errors
    if errors:
        raise LanguageError(errors)


def _place(span: Span) -> dict[str, object]:
    return {
        "file": span.source.name,
        "line": span.line,
        "column": span.column,
        "length": span.end - span.start,
    }
