"""What is wrong with knowledge, without using it."""

from __future__ import annotations

from pathlib import Path

from qsrlang.language.diagnostics import Diagnostics
from qsrlang.language.source import Source
from qsrlang.relations.build import build_graph
from qsrlang.relations.imports import find_knowledge, read_source


def check(name: str | Path) -> Diagnostics:
    """Return every finding of a shipped file such as `office/desk`, or of a path that ends in .qsr, in one run.

    Raises FileError where there is no such file.
    """
    return build_graph(read_source(find_knowledge(str(name)))).diagnostics


def check_text(text: str, name: str = "<text>") -> Diagnostics:
    """Return every finding of a text, names and meaning included, in one run."""
    return build_graph(Source(name, text)).diagnostics
