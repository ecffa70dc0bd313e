"""Comments that silence findings: `# allow Q503` on the line of the finding, or alone on the line before it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.source import Source

_NOTHING: Mapping[int, frozenset[str]] = MappingProxyType({})
_COMMENT = re.compile(r'"[^"\n]*"|(#.*)')
_ALLOWS = re.compile(r"#\s*allow\s+(Q\d{3}(?:\s*,\s*Q\d{3})*)(?!\w)")


def allowed(source: Source) -> Mapping[int, frozenset[str]]:
    """Return the codes that comments allow, by line counted from 1.

    What is allowed on a line without anything but comments is allowed on the next line too.
    """
    if "allow" not in source.text:
        return _NOTHING
    found: dict[int, frozenset[str]] = {}
    carried: frozenset[str] = frozenset()
    for number, line in enumerate(source.text.split("\n"), start=1):
        codes = carried | _codes(line)
        if codes:
            found[number] = codes
        carried = codes if line.lstrip().startswith("#") else frozenset()
    return MappingProxyType(found)


def unsilenced(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the findings that no comment silences; errors cannot be silenced."""
    by_source: dict[int, Mapping[int, frozenset[str]]] = {}
    heard = []
    for finding in diagnostics:
        source = finding.span.source
        if id(source) not in by_source:
            by_source[id(source)] = allowed(source)
        if finding.is_error or finding.code not in by_source[id(source)].get(finding.span.line, ()):
            heard.append(finding)
    return tuple(heard)


def _codes(line: str) -> frozenset[str]:
    comment = next((match[1] for match in _COMMENT.finditer(line) if match[1]), "")
    match = _ALLOWS.match(comment)
    return frozenset(re.findall(r"Q\d{3}", match[1])) if match else frozenset()
