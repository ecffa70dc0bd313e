"""Texts and places in them."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from pathlib import Path

from qsrlang.errors import FileError

MAX_SOURCE_BYTES = 16 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class Source:
    """A text, the name it is shown under, and the file it came from if it came from one."""

    name: str
    text: str = field(repr=False)
    path: Path | None = None
    _line_starts: tuple[int, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        ends = re.finditer("\n", self.text)
        object.__setattr__(self, "_line_starts", (0, *(end.end() for end in ends)))

    def line_of(self, position: int) -> int:
        """Return the line, counted from 1, that holds the character at `position`."""
        return bisect_right(self._line_starts, position)

    def column_of(self, position: int) -> int:
        """Return the column, counted from 1, of the character at `position`."""
        return position - self._line_starts[self.line_of(position) - 1] + 1

    def line_text(self, line: int) -> str:
        """Return the text of a line counted from 1, without its end."""
        start = self._line_starts[line - 1]
        end = self._line_starts[line] if line < len(self._line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r\n")


@dataclass(frozen=True, slots=True)
class Span:
    """The characters from `start` up to `end` of a source."""

    source: Source
    start: int
    end: int

    @property
    def line(self) -> int:
        """The line of the first character, counted from 1."""
        return self.source.line_of(self.start)

    @property
    def column(self) -> int:
        """The column of the first character, counted from 1."""
        return self.source.column_of(self.start)

    @property
    def text(self) -> str:
        """The characters themselves."""
        return self.source.text[self.start : self.end]

    def __str__(self) -> str:
        return f"{self.source.name}:{self.line}:{self.column}"


def read_source(path: Path, name: str | None = None) -> Source:
    """Read a UTF-8 text file, shown under `name`; raises FileError where it is missing, too large or not text."""
    remedy = "give the path of a .qsr file, or the name of a shipped one such as office/desk"
    try:
        with path.open("rb") as file:
            content = file.read(MAX_SOURCE_BYTES + 1)
    except (OSError, ValueError) as error:
        raise FileError(path, getattr(error, "strerror", None) or "cannot be read", remedy) from error
    return decode_source(content, name or str(path), path)


def decode_source(content: bytes, name: str, path: Path | None = None) -> Source:
    """Return the source that bytes of UTF-8 hold; raises FileError where they are too many or no text."""
    shown = path or name
    if len(content) > MAX_SOURCE_BYTES:
        raise FileError(shown, f"is larger than {MAX_SOURCE_BYTES} bytes", "split it into several files")
    try:
        return Source(name, content.decode("utf-8-sig"), path)
    except UnicodeDecodeError as error:
        raise FileError(shown, f"is not UTF-8 text (byte {error.start})", "save it as UTF-8") from error
