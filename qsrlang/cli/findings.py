"""Findings in a terminal."""

from __future__ import annotations

import json
from collections.abc import Iterable

from rich.console import Console
from rich.text import Text

from qsrlang.language.diagnostics import Diagnostic, Severity
from qsrlang.language.rendering import Part, Row

_COLOURS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}
_STYLES = {Part.PLACE: "bright_black", Part.TEXT: "", Part.FURTHER_MARK: "cyan", Part.HELP: "green"}


def print_findings(diagnostics: Iterable[Diagnostic], console: Console) -> None:
    """Print findings with their places, in colour on a terminal, a blank line after each."""
    for finding in diagnostics:
        for row in finding.rows():
            console.print(_styled(row, _COLOURS[finding.severity]), soft_wrap=True)
        console.print()


def findings_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Return findings as JSON."""
    return json.dumps([finding.to_json() for finding in diagnostics], ensure_ascii=True, indent=2)


def _styled(row: Row, colour: str) -> Text:
    style = f"bold {colour}" if row.part in (Part.HEAD, Part.MARK) else _STYLES[row.part]
    return Text(row.text, style=style)
