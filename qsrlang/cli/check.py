"""`qsr check FILE`: what is wrong with a file."""

from __future__ import annotations

import json

import typer

from qsrlang.cli.options import Format, KnowledgeFile, OutputFormat
from qsrlang.relations.build import Built, build_graph
from qsrlang.relations.imports import find_knowledge, read_source


def check(file: KnowledgeFile, output: OutputFormat = Format.TEXT) -> None:
    """Check a .qsr file and all it imports; every mistake is told at once."""
    built = build_graph(read_source(find_knowledge(file)))
    if output is Format.JSON:
        typer.echo(
            json.dumps([finding.to_json() for finding in built.diagnostics], ensure_ascii=False, indent=2)
        )
    else:
        for finding in built.diagnostics:
            typer.echo(finding.render() + "\n", err=finding.is_error)
        typer.echo(_summary(file, built))
    if any(finding.is_error for finding in built.diagnostics):
        raise typer.Exit(2)


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
