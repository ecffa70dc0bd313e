"""The map of this folder: source -> library -> symbols -> choices -> graph."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.source import Source
from qsrlang.relations.choices import build_choices
from qsrlang.relations.graph import RelationGraph
from qsrlang.relations.imports import read_library
from qsrlang.relations.symbols import Symbols


@dataclass(frozen=True, slots=True)
class Built:
    """A relation graph with all that was found wrong in its sources."""

    graph: RelationGraph
    diagnostics: tuple[Diagnostic, ...]


def build_graph(source: Source) -> Built:
    """Return the relation graph of a source and all it imports; use it only if no diagnostic is an error."""
    library = read_library(source)
    statements = [statement for document in library.documents for statement in document.statements]
    symbols = Symbols()
    symbols.gather(statements)
    choices = build_choices(statements, symbols)
    graph = RelationGraph(
        MappingProxyType(symbols.classes),
        MappingProxyType(symbols.relations),
        tuple(symbols.landmarks.values()),
        choices,
        symbols.defaults["reach"],
    )
    found = (*library.diagnostics, *symbols.diagnostics)
    ordered = sorted(found, key=lambda finding: (finding.span.source.name != source.name, finding.span.start))
    return Built(graph, tuple(ordered))
