"""The map of this folder: source -> library -> symbols -> layers -> graph."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from qsrlang.language.diagnostics import Diagnostic, Diagnostics
from qsrlang.language.parser import MAX_FINDINGS
from qsrlang.language.silencing import unsilenced
from qsrlang.language.source import Source
from qsrlang.relations.anchoring import report_unanchored
from qsrlang.relations.consistency.reporting import contradictions
from qsrlang.relations.contexts import Circumstances, circumstances_of
from qsrlang.relations.graph import RelationGraph
from qsrlang.relations.imports import NOTHING_OPENED, Library, read_library
from qsrlang.relations.layers import Layer, build_layers, in_force
from qsrlang.relations.symbols import Symbols

ANYWHERE = Circumstances()
MAX_CONTEXTS_CHECKED = 32


@dataclass(frozen=True, slots=True)
class Built:
    """A relation graph with all that was found wrong in its sources, and what it was built from."""

    graph: RelationGraph
    diagnostics: Diagnostics
    library: Library
    symbols: Symbols
    layers: tuple[Layer, ...]

    def under(self, circumstances: Circumstances) -> RelationGraph:
        """Return the relation graph that holds in other circumstances."""
        return _graph(self.layers, self.symbols, circumstances)


def build_graph(
    source: Source,
    circumstances: Circumstances | None = None,
    opened: Mapping[Path, Source] = NOTHING_OPENED,
) -> Built:
    """Return the relation graph of a source and all it imports; use it only if no diagnostic is an error.

    `opened` sources stand for the files at their resolved paths.
    """
    library = read_library(source, opened)
    statements = [statement for document in library.documents for statement in document.statements]
    symbols = Symbols(library.lost, max(0, len(library.documents) - 2), source)
    symbols.gather(statements)
    layers = build_layers(statements, symbols)
    report_unanchored(symbols)
    graph = _graph(layers, symbols, circumstances or ANYWHERE)
    _report_contradictions(graph, layers, symbols)
    found = unsilenced((*library.diagnostics, *symbols.diagnostics))
    return Built(graph, _ordered(found, source), library, symbols, layers)


def _report_contradictions(graph: RelationGraph, layers: tuple[Layer, ...], symbols: Symbols) -> None:
    """Report what cannot hold together in a graph, and in each context, the first MAX_CONTEXTS_CHECKED of them.

    Where there are errors, that may follow from them.
    """
    if any(finding.is_error for finding in symbols.diagnostics):
        return
    symbols.diagnostics += list(contradictions(graph, symbols.diagnostics))
    contexts = [layer.context for layer in layers if layer.context is not None]
    for context in contexts[:MAX_CONTEXTS_CHECKED]:
        circumstances = circumstances_of(context)
        if circumstances is not None:
            inside = _graph(layers, symbols, circumstances)
            symbols.diagnostics += list(contradictions(inside, symbols.diagnostics, context.span))


def _ordered(found: tuple[Diagnostic, ...], source: Source) -> Diagnostics:
    """Return the findings in the order of their places, those of the file itself first, up to MAX_FINDINGS of them.

    Of imported files, only errors, and what involves the file itself.
    """
    heard = [finding for finding in found if finding.is_error or _involves(finding, source)]
    ordered = sorted(heard, key=lambda finding: (finding.span.source.name != source.name, finding.span.start))
    if len(ordered) > MAX_FINDINGS:
        message = f"{len(ordered)} findings; the first {MAX_FINDINGS} are shown"
        ordered[MAX_FINDINGS:] = [Diagnostic("Q107", message, ordered[MAX_FINDINGS].span)]
    return Diagnostics(ordered)


def _involves(finding: Diagnostic, source: Source) -> bool:
    places = (finding.span, *(label.span for label in finding.labels))
    return any(place.source is source for place in places)


def _graph(layers: tuple[Layer, ...], symbols: Symbols, circumstances: Circumstances) -> RelationGraph:
    choices, requirements = in_force(layers, circumstances, symbols)
    return RelationGraph(
        MappingProxyType(symbols.classes),
        MappingProxyType(symbols.relations),
        tuple(symbols.landmarks.values()),
        choices,
        symbols.defaults.get("reach", 1.0),
        MappingProxyType(symbols.roles),
        requirements,
        MappingProxyType(
            {name: tuple(one.text for one in scene.members) for name, scene in symbols.scenes.items()}
        ),
    )
