"""Edits of findings, made in a text."""

from __future__ import annotations

from collections.abc import Iterable

from qsrlang.language.diagnostics import Diagnostic, Edit
from qsrlang.language.source import Source


def sure_edits(source: Source, diagnostics: Iterable[Diagnostic]) -> tuple[Edit, ...]:
    """Return the edits of a source that can only be what was meant; of findings that overlap, the first one's."""
    taken: list[Edit] = []
    for finding in diagnostics:
        own = finding.sure and all(edit.span.source is source for edit in finding.edits)
        if own and not any(_overlap(one, other) for one in finding.edits for other in taken):
            taken += finding.edits
    return tuple(sorted(taken, key=lambda edit: edit.span.start))


def edited(text: str, edits: Iterable[Edit]) -> str:
    """Return a text with edits made that do not overlap."""
    parts, position = list[str](), 0
    for edit in sorted(edits, key=lambda edit: edit.span.start):
        parts += [text[position : edit.span.start], edit.text]
        position = edit.span.end
    return "".join([*parts, text[position:]])


def _overlap(one: Edit, other: Edit) -> bool:
    return one.span.start <= other.span.end and other.span.start <= one.span.end
