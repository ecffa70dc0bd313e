"""Places as the Language Server Protocol counts them: lines from 0, and units of its encoding along a line."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from functools import lru_cache

from lsprotocol.types import Position, PositionEncodingKind, Range

from qsrlang.language.source import Span

_LINE_END = re.compile(r"\r\n|\r|\n")
_BYTES = {
    PositionEncodingKind.Utf8: ("utf-8", 1),
    PositionEncodingKind.Utf16: ("utf-16-le", 2),
    PositionEncodingKind.Utf32: ("utf-32-le", 4),
}


@dataclass(frozen=True, slots=True)
class Ruler:
    """Measures places in a text; made by `ruler`, which keeps the last ones."""

    text: str
    encoding: PositionEncodingKind
    _starts: tuple[int, ...] = field(init=False)

    def __post_init__(self) -> None:
        starts = (0, *(end.end() for end in _LINE_END.finditer(self.text)))
        object.__setattr__(self, "_starts", starts)

    def position(self, offset: int) -> Position:
        """Return where the character at an offset stands."""
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(self._starts, offset) - 1
        return Position(line, self._units(self.text[self._starts[line] : offset]))

    def range(self, span: Span) -> Range:
        """Return where the characters of a span of this text stand."""
        return Range(self.position(span.start), self.position(span.end))

    def offset(self, position: Position) -> int:
        """Return the offset of the character at a position; beyond the end of its line, of that end."""
        if position.line >= len(self._starts):
            return len(self.text)
        start = self._starts[position.line]
        end = _LINE_END.search(self.text, start)
        line = self.text[start : end.start() if end else len(self.text)]
        if line.isascii():
            return start + min(position.character, len(line))
        units = 0
        for index, character in enumerate(line):
            if units >= position.character:
                return start + index
            units += self._units(character)
        return start + len(line)

    def _units(self, text: str) -> int:
        if text.isascii():
            return len(text)
        encoding, size = _BYTES[self.encoding]
        return len(text.encode(encoding, "surrogatepass")) // size


@lru_cache(maxsize=64)
def ruler(text: str, encoding: PositionEncodingKind = PositionEncodingKind.Utf16) -> Ruler:
    """Return the ruler of a text."""
    return Ruler(text, encoding)
