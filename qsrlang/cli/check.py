"""`qsr check FILE`: what is wrong with a file."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console

from qsrlang.cli.findings import findings_json, print_findings
from qsrlang.cli.options import Format, KnowledgeFile, OutputFormat
from qsrlang.errors import FileError
from qsrlang.files import write_whole
from qsrlang.language.fixing import edited, sure_edits
from qsrlang.language.source import Source
from qsrlang.relations.build import Built, build_graph
from qsrlang.relations.imports import find_knowledge, read_source

MAX_ROUNDS = 8

Fix = Annotated[
    bool, typer.Option("--fix", help="Make the edits that can only be what was meant, in the file itself.")
]


def check(file: KnowledgeFile, fix: Fix = False, output: OutputFormat = Format.TEXT) -> None:
    """Check a .qsr file and all it imports; every mistake is told at once."""
    source = read_source(find_knowledge(file))
    built = build_graph(source)
    if fix:
        built, made = _fixed(source, built)
        if output is Format.TEXT:
            typer.echo(f"{file}: {made} edit{'' if made == 1 else 's'} made")
    if output is Format.JSON:
        typer.echo(findings_json(built.diagnostics))
    else:
        told = [finding for finding in built.diagnostics if not finding.is_error]
        print_findings(told, Console(highlight=False))
        print_findings(
            [one for one in built.diagnostics if one.is_error], Console(stderr=True, highlight=False)
        )
        typer.echo(_summary(file, built))
    if any(finding.is_error for finding in built.diagnostics):
        raise typer.Exit(2)


def _fixed(source: Source, built: Built) -> tuple[Built, int]:
    """Make the sure edits of the errors, again as long as that brings new ones to light, and write the file once."""
    if source.path is None or source.name != str(source.path):
        raise FileError(
            source.name, "is shipped with the program", "copy it to a place of your own and fix that"
        )
    first, made = source, 0
    for _ in range(MAX_ROUNDS):
        edits = sure_edits(source, (finding for finding in built.diagnostics if finding.is_error))
        if not edits:
            break
        source = Source(source.name, edited(source.text, edits), source.path)
        built, made = build_graph(source), made + len(edits)
    if source is not first and source.path is not None:
        write_whole(source.path, source.text)
    return built, made


def _summary(file: str, built: Built) -> str:
    errors = sum(finding.is_error for finding in built.diagnostics)
    if errors:
        return f"{file}: {errors} error{'s' if errors > 1 else ''}"
    graph = built.graph
    pairs = {pair for choice in graph.choices for pair in choice.governs}
    return (
        f"{file}: no errors; {len(graph.classes)} classes, {len(graph.relations)} relations, "
        f"{len(graph.landmarks)} landmarks, {len(pairs)} related pairs"
    )
