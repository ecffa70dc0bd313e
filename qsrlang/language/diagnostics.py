"""What is wrong with a text, as data, and how it is shown."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from qsrlang.errors import QSRError
from qsrlang.language.source import Span


class Severity(Enum):
    """How grave a diagnostic is; only errors keep a file from being used."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


CODES = {
    "Q101": "unexpected text",
    "Q102": "a formula nested too deeply",
    "Q103": "too many alternatives in one formula",
    "Q201": "unknown class or landmark",
    "Q203": "unknown relation",
    "Q204": "unknown scene",
    "Q205": "class defined twice",
    "Q206": "landmark defined twice",
    "Q207": "relation defined twice",
    "Q208": "scene defined twice",
    "Q209": "a file that cannot be imported",
    "Q210": "unknown default",
    "Q211": "class not among the scene's arguments",
    "Q212": "a newer language",
    "Q301": "a missing unit",
    "Q302": "a unit of the wrong kind",
    "Q303": "a value out of range",
    "Q304": "a wrong number of values",
    "Q401": "shares above 1",
    "Q402": "shares given for some alternatives only",
    "Q403": "two beliefs on one pair",
    "Q404": "a wrong number of arguments",
    "Q405": "a negation without opposites",
    "Q406": "an intrinsic frame without a front",
    "Q407": "a relation of an object to itself",
    "Q408": "a metric fit on several pairs",
    "Q501": "dynamic class used as landmark",
    "Q502": "class never declared",
    "Q601": "a statement that another overrides",
}


@dataclass(frozen=True, slots=True)
class Label:
    """A further place that belongs to a diagnostic, and what it is there."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about a text: code, message, where, further places and what would help."""

    code: str
    message: str
    span: Span
    note: str = ""
    help: str = ""
    labels: tuple[Label, ...] = ()
    severity: Severity = Severity.ERROR

    @property
    def is_error(self) -> bool:
        """Whether the text cannot be used before this is mended."""
        return self.severity is Severity.ERROR

    def render(self) -> str:
        """Return the finding with file, line, column, the line itself and a caret under the place."""
        head = f"{self.severity.value}[{self.code}]: {self.message}"
        further = (label for label in self.labels)
        parts = [head, _excerpt(self.span, self.note, "-->")]
        parts += [_excerpt(label.span, label.text, ":::") for label in further]
        if self.help:
            parts.append(f"   = help: {self.help}")
        return "\n".join(parts)

    def to_json(self) -> dict[str, object]:
        """Return the finding as plain data."""
        return {
            "code": self.code,
            "severity": self.severity.value,
            "message": self.message,
            "note": self.note,
            "help": self.help,
            "file": self.span.source.name,
            "line": self.span.line,
            "column": self.span.column,
            "length": self.span.end - self.span.start,
            "labels": [{"place": str(label.span), "text": label.text} for label in self.labels],
        }


class LanguageError(QSRError):
    """A text that cannot be used, with all that was found in it."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n\n".join(diagnostic.render() for diagnostic in self.diagnostics))


def raise_errors(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise LanguageError with the errors among the diagnostics, if there are any."""
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.is_error]
    if errors:
        raise LanguageError(errors)


def _excerpt(span: Span, note: str, arrow: str) -> str:
    line_text = span.source.line_text(span.line).expandtabs(1)
    number = str(span.line)
    gutter = " " * len(number)
    width = max(1, min(span.end - span.start, len(line_text) - span.column + 1))
    caret = " " * (span.column - 1) + "^" * width
    return "\n".join(
        [
            f"{gutter} {arrow} {span}",
            f"{gutter} |",
            f"{number} | {line_text}",
            f"{gutter} | {caret} {note}".rstrip(),
        ]
    )
