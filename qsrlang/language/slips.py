"""Slips people make: signs and words of other scripts, languages and programs, and what this language writes there."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

from qsrlang.language.diagnostics import Edit
from qsrlang.language.grammar import keywords
from qsrlang.language.source import Span
from qsrlang.language.words import WORD

# Signs that look like one of the language's, from typesetting and from keyboards of other scripts.
LOOK_ALIKES = {
    **dict.fromkeys("，、،", ","),
    **dict.fromkeys("。．｡", "."),
    **dict.fromkeys("：﹕", ":"),
    **dict.fromkeys("；", "."),
    **dict.fromkeys("（﹙", "("),
    **dict.fromkeys("）﹚", ")"),
    **dict.fromkeys("｛", "{"),
    **dict.fromkeys("｝", "}"),
    **dict.fromkeys("｜¦", "|"),
    **dict.fromkeys("〜～", "~"),
    **dict.fromkeys("％", "%"),
    **dict.fromkeys("？؟", "?"),
    **dict.fromkeys("＃", "#"),
    **dict.fromkeys("−–—﹣－", "-"),
    **dict.fromkeys("＋", "+"),
    **dict.fromkeys("“”„«»＂", '"'),
    **dict.fromkeys("✕✖⨯·", "×"),
    **dict.fromkeys("⋀＆", "∧"),
    **dict.fromkeys("⋁", "∨"),
    **dict.fromkeys("！", "¬"),
    **dict.fromkeys("↔⟺≡≔", "⇔"),
}

# A sign, the terminal that stands where it was written, and how that is written; longer signs first.
SIGNS = (
    *((sign, "IFF", "⇔") for sign in ("<->", "<==>", "==>", "<--", ":-", ":=", "==", "=>", "->", "=", ":")),
    *((sign, "OR", "∨") for sign in ("||", "\\/", "|")),
    *((sign, "AND", "∧") for sign in ("/\\",)),
    *((sign, "NOT", "¬") for sign in ("-", "~")),
    ("=", "COLON", ":"),
    ("::", "COLON", ":"),
    (":", "COLONS", "::"),
    ("[", "LPAR", "("),
    ("]", "RPAR", ")"),
    (";", "$END", "."),
    (".", "QMARK", "?"),
    ("°", "UNIT", " deg"),
)

WORDS = {
    **dict.fromkeys(("true", "True", "TRUE"), ("YESNO", "yes")),
    **dict.fromkeys(("false", "False", "FALSE"), ("YESNO", "no")),
    **dict.fromkeys(("metre", "metres", "meter", "meters"), ("UNIT", "m")),
    **dict.fromkeys(("centimetre", "centimetres", "centimeter", "centimeters", "cms"), ("UNIT", "cm")),
    **dict.fromkeys(("millimetre", "millimetres", "millimeter", "millimeters", "mms"), ("UNIT", "mm")),
    **dict.fromkeys(("degree", "degrees", "degs"), ("UNIT", "deg")),
    **dict.fromkeys(("radian", "radians", "rads"), ("UNIT", "rad")),
}

DIRECTIONS = frozenset({"north", "east", "south", "west", "left", "right", "forward", "backward"})

NAME = re.compile(WORD)
_LONGEST_WORD = 100
_LAST_WORD = re.compile(rf"({WORD}|[^\w\s])[^\S\n]*\Z")


class Remedy(NamedTuple):
    """What would help, the edits that do it, and whether they can only be what was meant."""

    help: str
    edits: tuple[Edit, ...] = ()
    sure: bool = True


@dataclass(frozen=True, slots=True)
class Slip:
    """A word that does not fit ("" at the end), what the grammar accepts in its place, and the statement around it."""

    place: Span
    word: str
    accepted: frozenset[str]
    whole: Span

    @property
    def starts(self) -> bool:
        """Whether it is the first word."""
        return self.place.start == self.whole.start

    @property
    def before(self) -> str:
        """The word before it on its line, or ""."""
        begin = max(self.whole.start, self.place.start - _LONGEST_WORD)
        found = _LAST_WORD.search(self.place.source.text[begin : self.place.start])
        return found[1] if found else ""

    @property
    def after(self) -> str:
        """The rest of the statement."""
        return self.place.source.text[self.place.end : self.whole.end]

    @property
    def is_applied(self) -> bool:
        """Whether it is a word with arguments after it, as relations are."""
        return bool(NAME.fullmatch(self.word)) and self.after.startswith("(")

    @property
    def is_name(self) -> bool:
        """Whether the word could be a name of the user's."""
        return bool(NAME.fullmatch(self.word)) and self.word not in keywords()

    def edit(self, text: str, length: int | None = None) -> tuple[Edit, ...]:
        """Return the edit that puts a text in place of the word, or of so many characters from its start."""
        end = self.place.end if length is None else self.place.start + length
        return (Edit(Span(self.place.source, self.place.start, end), text),)
