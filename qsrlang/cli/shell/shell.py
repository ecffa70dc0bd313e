"""The state of a running REPL, and how it tells things: on a terminal with pictures, in a pipe without, or as JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass

from rich.console import Console
from rich.text import Text

import qsrlang as qsr
from qsrlang.cli.answers import print_answer, title_of
from qsrlang.cli.findings import print_findings
from qsrlang.cli.options import Format
from qsrlang.cli.shell.inputs import count_statements
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.sketch import draw_sketch
from qsrlang.language.diagnostics import Diagnostic, Severity
from qsrlang.language.parser import parse_query
from qsrlang.language.questions import Check
from qsrlang.language.rendering import visible
from qsrlang.relations.linting.lint import lint

FAINT = "bright_black"


@dataclass(slots=True)
class Shell:
    """What a REPL remembers between two inputs.

    Answers go to `answers`, all else that was asked for to `notes`, and what is wrong to `errors`.
    """

    session: Session
    answers: Console
    notes: Console
    errors: Console
    output: Format = Format.TEXT
    is_interactive: bool = False
    file: str | None = None
    last_query: str | None = None
    has_failed: bool = False
    has_left: bool = False
    is_warned: bool = False

    def state(self, text: str) -> None:
        """Take in statements; raises LanguageError, and takes in nothing, where they have errors."""
        before = self.session
        self.session = before.state(text)
        self.tell_findings(self.session.findings_since(before))
        *_, (line, stated) = self.session.knowledge.numbered()
        last = line + stated.text.count("\n")
        self.remark(f"added as line {line}" if last == line else f"added as lines {line} to {last}")

    def ask(self, query: str) -> None:
        """Answer a query; raises QSRError."""
        if isinstance(parse_query(query), Check):
            self.tell_check(self.findings())
            return
        answer = self.session.ask(query)
        self.last_query = query
        if self.output is Format.JSON:
            self._print_json(answer.to_json())
            return
        print_answer(answer, self.answers, title_of(query))
        if self.is_interactive and isinstance(answer, qsr.Where):
            self.answers.print(self._picture(answer))

    @property
    def unsaved(self) -> int:
        """How many statements are in no file."""
        return sum(count_statements(one.text) for one in self.session.unsaved)

    def leave(self) -> None:
        """Leave, or ask once where something is not saved."""
        unsaved = self.unsaved
        if self.is_warned or not unsaved:
            self.has_left = True
            return
        self.is_warned = True
        statements = "1 statement is" if unsaved == 1 else f"{unsaved} statements are"
        self.note(f"{statements} not saved; type :save FILE, or :quit! / Ctrl-D again")

    def findings(self) -> tuple[Diagnostic, ...]:
        """Return all that can be said of what is known: warnings, information and lint; what was typed comes first."""
        built, source = self.session.built, self.session.source()
        viewer = self.session.viewer
        place = None if viewer is None else (viewer.x, viewer.y)
        found = (*built.diagnostics, *lint(built, source, place))
        return tuple(sorted(found, key=lambda one: (one.span.source is not source, one.span.start)))

    def tell_check(self, findings: tuple[Diagnostic, ...]) -> None:
        """Tell findings as the answer to a question."""
        if self.output is Format.JSON:
            self._print_json([finding.to_json() for finding in findings])
        elif findings:
            print_findings(findings, self.answers)
        else:
            self.answers.print("nothing to complain of")

    def tell_findings(self, findings: tuple[Diagnostic, ...]) -> None:
        """Tell what was found in what was typed."""
        print_findings(findings, self.errors)

    def tell_warnings(self, findings: tuple[Diagnostic, ...]) -> None:
        """Tell what was found in what was loaded, but for mere information."""
        self.tell_findings(tuple(one for one in findings if one.severity is not Severity.INFO))

    def tell_error(self, message: str) -> None:
        """Tell in one line what went wrong."""
        self.has_failed = True
        self.errors.print(
            Text.assemble(("error: ", "bold red"), visible(message)), soft_wrap=not self.is_interactive
        )

    def remark(self, message: str) -> None:
        """Tell a person what happened; programs need not know."""
        if self.is_interactive:
            self.note(message, FAINT)

    def note(self, message: str, style: str = "") -> None:
        """Tell what was asked for, as it stands."""
        lines = (visible(line.expandtabs()) for line in message.split("\n"))
        self.notes.print(Text("\n".join(lines), style), soft_wrap=True)

    def _picture(self, answer: qsr.Where) -> Text:
        coloured = self.answers.color_system is not None and not self.answers.no_color
        return draw_sketch(answer, self.session.known.graph, self.answers.width, coloured=coloured)

    def _print_json(self, value: object) -> None:
        self.answers.out(json.dumps(value, ensure_ascii=False), highlight=False)
