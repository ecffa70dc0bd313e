"""The layout engine: words, breaks and groups of them become lines, in time linear in their number.

A group whose words fit on the line stays on it; else each of its breaks becomes a line end, or, where it is filled,
each that must. A comment runs to the end of its line, so the break that carries it becomes a line end, and with it
the breaks of all groups around it (after D. C. Oppen, Prettyprinting, 1980).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from qsrlang.language.printing.sentence import Remark

WIDTH = 100
INDENT = 4


@dataclass(slots=True)
class Break:
    """A place where a line may end; on one line it is `flat`.

    `closing` is the break before a closing bracket, `tight` one that keeps no blank line.
    """

    flat: str = " "
    closing: bool = False
    tight: bool = False
    remarks: tuple[Remark, ...] = ()
    blank: bool = False


@dataclass(frozen=True, slots=True)
class Open:
    """Where a group begins: its indentation (None aligns it to here), whether it is filled, whether broken anyway."""

    indent: int | None = INDENT
    filled: bool = False
    broken: bool = False


class Close(Enum):
    """The end of a group."""

    GROUP = "end of group"


Part: TypeAlias = str | Break | Open | Close


class _Way(Enum):
    FLAT = "flat"
    BROKEN = "broken"
    FILLED = "filled"


@dataclass(frozen=True, slots=True)
class _Group:
    way: _Way
    outer: int
    inner: int


@dataclass(frozen=True, slots=True)
class _Widths:
    """Of each part: the width of all before it on one line, the breaks before it that must end lines, and the width
    from it up to the next break."""

    before: list[int]
    forced: list[int]
    run: list[int]
    ends: dict[int, int]


def lay_out(parts: Sequence[Part], indent: int = 0, width: int = WIDTH) -> str:
    """Return the text of parts, its first line without the indentation that further lines have."""
    widths = _measure(parts)
    groups = [_Group(_Way.BROKEN, indent, indent)]
    out: list[str] = []
    column = indent
    for at, part in enumerate(parts):
        group = groups[-1]
        if isinstance(part, str):
            out.append(part)
            column += len(part)
        elif isinstance(part, Open):
            groups.append(_group(part, group, column, _fits(at, part, widths, width - column)))
        elif isinstance(part, Close):
            groups.pop()
        elif _stays(part, group, width - column - len(part.flat) - widths.run[at + 1]):
            out.append(part.flat)
            column += len(part.flat)
        else:
            column = group.outer if part.closing else group.inner
            out.append(_line_end(part, group, column))
    return "".join(out)


def _measure(parts: Sequence[Part]) -> _Widths:
    before, forced, opened, ends = [0], [0], [], {}
    for at, part in enumerate(parts):
        flat = part if isinstance(part, str) else part.flat if isinstance(part, Break) else ""
        must = bool(part.remarks) if isinstance(part, Break) else isinstance(part, Open) and part.broken
        before.append(before[-1] + len(flat))
        forced.append(forced[-1] + must)
        if isinstance(part, Open):
            opened.append(at)
        elif isinstance(part, Close):
            ends[opened.pop()] = at
    run = [0] * (len(parts) + 1)
    for at in range(len(parts) - 1, -1, -1):
        part = parts[at]
        run[at] = 0 if isinstance(part, Break) else run[at + 1] + (len(part) if isinstance(part, str) else 0)
    return _Widths(before, forced, run, ends)


def _fits(at: int, part: Open, widths: _Widths, room: int) -> bool:
    end = widths.ends[at]
    needed = widths.before[end] - widths.before[at] + widths.run[end]
    return needed <= room and widths.forced[end] == widths.forced[at]


def _group(part: Open, around: _Group, column: int, fits: bool) -> _Group:
    inner = column if part.indent is None else around.inner + part.indent
    if around.way is _Way.FLAT or fits:
        return _Group(_Way.FLAT, around.inner, inner)
    return _Group(_Way.FILLED if part.filled else _Way.BROKEN, around.inner, inner)


def _stays(part: Break, group: _Group, room: int) -> bool:
    if part.remarks or group.way is _Way.BROKEN:
        return False
    return group.way is _Way.FLAT or (room >= 0 and not part.closing and not part.tight)


def _line_end(part: Break, group: _Group, column: int) -> str:
    """The comments of a break, then the end of the line, a blank line if one was there, and the indentation."""
    lines = [""]
    for number, remark in enumerate(part.remarks):
        if remark.behind and number == 0:
            lines[0] = f"  {remark.text}"
        else:
            blank = "\n" if remark.blank and not (part.tight and number == 0) else ""
            lines.append(f"{blank}{' ' * group.inner}{remark.text}")
    blank = "\n" if part.blank and not part.tight and not part.closing else ""
    return "\n".join([*lines, f"{blank}{' ' * column}"])
