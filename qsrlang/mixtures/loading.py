"""From text to knowledge that can be asked."""

from __future__ import annotations

from pathlib import Path

from qsrlang.language.diagnostics import raise_errors
from qsrlang.language.source import Source
from qsrlang.mixtures.queries import KnowledgeBase
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import find_knowledge, read_source


def load(name: str | Path) -> KnowledgeBase:
    """Load knowledge: a shipped name such as `office/desk`, or a path that ends in .qsr.

    Raises FileError, and LanguageError with every error found in the text and in what it imports.
    """
    return _known(read_source(find_knowledge(str(name))))


def parse_knowledge(text: str, name: str = "<text>") -> KnowledgeBase:
    """Return the knowledge that a text states; raises LanguageError."""
    return _known(Source(name, text))


def _known(source: Source) -> KnowledgeBase:
    built = build_graph(source)
    raise_errors(built.diagnostics)
    return KnowledgeBase(built.graph, built.diagnostics, built)
