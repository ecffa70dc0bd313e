"""Characters that a reader cannot see: what they are, and what is shown in their place."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator

from qsrlang.language.diagnostics import Diagnostic, Severity
from qsrlang.language.source import Source, Span

# Bidirectional marks, embeddings, overrides and isolates (Unicode standard annex 9, section 2).
_REORDERING = re.compile("[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]+")


def odd_characters(source: Source) -> Iterator[Diagnostic]:
    """Yield a warning for each run of characters that make a text look other than it reads."""
    if source.text.isascii():
        return
    for match in _REORDERING.finditer(source.text):
        names = ", ".join(dict.fromkeys(unicodedata.name(character) for character in match.group()))
        yield Diagnostic(
            "Q512",
            "this text is shown in another order than it is read in",
            Span(source, *match.span()),
            f"here stands {names}",
            "delete the invisible characters",
            severity=Severity.WARNING,
        )
