"""The TextMate grammar of the language, for VS Code and other editors; run this module to print it."""

from __future__ import annotations

import json
import sys
from typing import Any

from qsrlang.editor.patterns import ROOT, Ink, Pattern, sections

SCOPE = "source.qsr"


def textmate_grammar() -> dict[str, Any]:
    """Return the grammar as plain data."""
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "qsr",
        "scopeName": SCOPE,
        "fileTypes": ["qsr"],
        "patterns": [_include(ROOT)],
        "repository": {
            name: {"patterns": [_rule(pattern) for pattern in section.patterns]}
            for name, section in sections().items()
        },
    }


def textmate_text() -> str:
    """Return the grammar as the text of its file."""
    return json.dumps(textmate_grammar(), indent=2, ensure_ascii=False) + "\n"


def _rule(pattern: Pattern) -> dict[str, Any]:
    if not pattern.section:
        return {"match": pattern.regex, **_named(pattern.inks)}
    end = sections()[pattern.section].end
    assert end is not None, "only the root has no end"
    return {
        "begin": pattern.regex,
        "beginCaptures": _captures(pattern.inks),
        "end": end.regex,
        "endCaptures": _captures(end.inks),
        "patterns": [_include(pattern.section)],
    }


def _named(inks: tuple[Ink | None, ...]) -> dict[str, Any]:
    (ink, *more) = inks
    if more:
        return {"captures": _captures(inks)}
    return {} if ink is None else {"name": _scope(ink)}


def _captures(inks: tuple[Ink | None, ...]) -> dict[str, Any]:
    return {str(number): {"name": _scope(ink)} for number, ink in enumerate(inks, start=1) if ink is not None}


def _scope(ink: Ink) -> str:
    return f"{ink.value}.qsr"


def _include(section: str) -> dict[str, str]:
    return {"include": f"#{section}"}


if __name__ == "__main__":
    sys.stdout.write(textmate_text())
