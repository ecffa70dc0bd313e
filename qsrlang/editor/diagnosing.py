"""Findings as an editor shows them, and what it offers to mend them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from lsprotocol import types

from qsrlang.editor.positions import ruler
from qsrlang.editor.workbench import Workbench
from qsrlang.language.diagnostics import Diagnostic, Edit, Severity
from qsrlang.language.fixing import sure_edits
from qsrlang.language.source import Source, Span
from qsrlang.relations.linting.lint import lint

MAX_SHOWN = 1000
"""More findings of one file are not sent."""

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
}
_FADED = ("Q508",)


@dataclass(frozen=True, slots=True)
class Translator:
    """From findings and edits to what the protocol sends, with the addresses of a workbench."""

    bench: Workbench
    encoding: types.PositionEncodingKind

    def location(self, span: Span) -> types.Location:
        """Return where a span is."""
        return types.Location(self.bench.address_of(span.source), self.range(span))

    def range(self, span: Span) -> types.Range:
        """Return the lines and columns of a span."""
        return ruler(span.source.text, self.encoding).range(span)

    def edits(self, edits: Iterable[Edit]) -> types.WorkspaceEdit:
        """Return edits of any number of files."""
        changes: dict[str, list[types.TextEdit]] = {}
        for edit in edits:
            change = types.TextEdit(self.range(edit.span), edit.text)
            changes.setdefault(self.bench.address_of(edit.span.source), []).append(change)
        return types.WorkspaceEdit(changes=changes)

    def finding(self, finding: Diagnostic) -> types.Diagnostic:
        """Return a finding with its note, its help and its further places."""
        help_text = f"help: {finding.help}" if finding.help else ""
        related = [
            types.DiagnosticRelatedInformation(self.location(label.span), label.text)
            for label in finding.labels
        ]
        return types.Diagnostic(
            self.range(finding.span),
            "\n".join(filter(None, (finding.message, finding.note, help_text))),
            severity=_SEVERITIES[finding.severity],
            code=finding.code,
            source="qsr",
            tags=[types.DiagnosticTag.Unnecessary] if finding.code in _FADED else None,
            related_information=related or None,
        )


def findings_of(bench: Workbench, address: str) -> tuple[Diagnostic, ...]:
    """Return all findings of an open text: those of the graph and those of the linter."""
    source = bench.source(address)
    built = bench.built(address)
    return (*built.diagnostics, *(lint(built, source) if source is not None else ()))


def findings_by_address(bench: Workbench) -> Mapping[str, list[Diagnostic]]:
    """Return what is to be shown at which address: every finding of the open texts, of other files the errors alone.

    A finding in a file that is not open is also shown where a further place of it is in an open one.
    """
    shown: dict[str, dict[Diagnostic, None]] = {address: {} for address in bench.open}
    for address in bench.open:
        for finding in findings_of(bench, address):
            where = bench.address_of(finding.span.source)
            if where in bench.open or finding.is_error:
                shown.setdefault(where, {})[finding] = None
            if where not in bench.open:
                shown[address] |= dict.fromkeys(_turned(finding, bench.source(address)))
    return {address: list(found)[:MAX_SHOWN] for address, found in shown.items()}


def actions(
    bench: Workbench, address: str, within: types.Range, encoding: types.PositionEncodingKind
) -> Iterator[types.CodeAction]:
    """Yield what mends the findings in part of an open text, then what mends all that is sure."""
    source = bench.source(address)
    if source is None:
        return
    translator = Translator(bench, encoding)
    measure = ruler(source.text, encoding)
    start, end = measure.offset(within.start), measure.offset(within.end)
    findings = findings_of(bench, address)
    for finding in findings:
        if finding.span.source is source and finding.span.start <= end and start <= finding.span.end:
            yield from _actions_for(finding, translator)
    sure = sure_edits(source, findings)
    if sure:
        yield types.CodeAction(
            "mend all that is sure", kind=types.CodeActionKind.SourceFixAll, edit=translator.edits(sure)
        )


def _actions_for(finding: Diagnostic, translator: Translator) -> Iterator[types.CodeAction]:
    shown = [translator.finding(finding)]
    if finding.edits:
        yield types.CodeAction(
            finding.help or finding.message,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=shown,
            is_preferred=finding.sure,
            edit=translator.edits(finding.edits),
        )
    if not finding.is_error:
        yield types.CodeAction(
            f"allow {finding.code} here",
            kind=types.CodeActionKind.QuickFix,
            diagnostics=shown,
            edit=translator.edits([_allowance(finding)]),
        )


def _allowance(finding: Diagnostic) -> Edit:
    """The comment before the line of a finding that silences it."""
    source = finding.span.source
    text = source.text
    begin = text.rfind("\n", 0, finding.span.start) + 1
    indent = text[begin : finding.span.start]
    blank = indent[: len(indent) - len(indent.lstrip())]
    return Edit(Span(source, begin, begin), f"{blank}# allow {finding.code}\n")


def _turned(finding: Diagnostic, source: Source | None) -> Iterator[Diagnostic]:
    """Yield a finding of another file as one at its first further place in a source."""
    for label in finding.labels:
        if label.span.source is source:
            note = f"{label.text}; {finding.note}" if finding.note else label.text
            yield Diagnostic(
                finding.code, finding.message, label.span, note, finding.help, (), finding.severity
            )
            return
