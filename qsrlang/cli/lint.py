"""`qsr lint FILE`: what is legal but probably not meant."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from qsrlang.cli.findings import findings_json, print_findings
from qsrlang.cli.options import Format, Landmarks, OutputFormat, Viewer
from qsrlang.errors import UnknownNameError
from qsrlang.language.codes import CODES
from qsrlang.language.diagnostics import Diagnostic, Severity
from qsrlang.language.parser import parse_landmark, parse_place
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import find_knowledge, read_source
from qsrlang.relations.linting.lint import RULES
from qsrlang.relations.linting.lint import lint as find_doubtful
from qsrlang.relations.values import landmark_value

WARNED, REFUSED = 1, 2
_EXITS = {Severity.ERROR: REFUSED, Severity.WARNING: WARNED}

LintedFile = Annotated[
    str | None,
    typer.Argument(metavar="FILE", help="A shipped name such as office/desk, or a path that ends in .qsr."),
]
Rules = Annotated[bool, typer.Option("--rules", help="List the rules instead.")]


def lint(
    file: LintedFile = None,
    viewer: Viewer = None,
    landmark: Landmarks = None,
    rules: Rules = False,
    output: OutputFormat = Format.TEXT,
) -> None:
    """Tell what 'qsr check' does, and what is legal but probably not meant; '# allow Q503' on a line silences it."""
    if rules:
        _print_rules(output)
        return
    if file is None:
        raise typer.BadParameter("name a file, or list the rules with --rules", param_hint="FILE")
    found = _findings(file, viewer, landmark or [])
    if output is Format.JSON:
        typer.echo(findings_json(found))
    else:
        print_findings(found, Console(highlight=False))
        typer.echo(_summary(file, found))
    code = max((_EXITS.get(finding.severity, 0) for finding in found), default=0)
    if code:
        raise typer.Exit(code)


def _findings(file: str, viewer: str | None, landmarks: list[str]) -> list[Diagnostic]:
    """Return what was found in building and in linting a file, its own findings first, in the order of the text."""
    source = read_source(find_knowledge(file))
    built = build_graph(source)
    further = tuple(landmark_value(parse_landmark(one)) for one in landmarks)
    for one in further:
        if one.kind not in built.graph.classes:
            raise UnknownNameError("class", one.kind, built.graph.classes)
    place = None if viewer is None else parse_place(viewer)
    found = [*built.diagnostics, *find_doubtful(built, source, place, further)]
    return sorted(found, key=lambda finding: (finding.span.source is not source, finding.span.start))


def _summary(file: str, found: list[Diagnostic]) -> str:
    counts = [(sum(one.severity is severity for one in found), severity) for severity in _EXITS]
    told = [f"{count} {severity.value}{'s' if count > 1 else ''}" for count, severity in counts if count]
    return f"{file}: {', '.join(told) or 'nothing to mend'}"


def _print_rules(output: Format) -> None:
    if output is Format.JSON:
        listed = [{"code": rule.code, "finds": CODES[rule.code], "reason": rule.reason} for rule in RULES]
        typer.echo(json.dumps(listed, ensure_ascii=True, indent=2))
        return
    table = Table("code", "finds", "because")
    for rule in RULES:
        table.add_row(rule.code, CODES[rule.code], rule.reason)
    Console().print(table)
