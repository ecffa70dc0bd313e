"""Where the lines of each statement may end: from the words of a statement to the parts of its layout."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from qsrlang.language.printing.layout import Break, Close, Open, Part, lay_out
from qsrlang.language.printing.sentence import Remark, Sentence, Token
from qsrlang.language.printing.spelling import Spelling, blank_between

MAX_GROUPS = 24


def arrange(tokens: Sequence[Token], spelling: Spelling, indent: int = 0) -> tuple[str, tuple[Remark, ...]]:
    """Return the lines of a statement with its full stop, or of a context's head, and the comments to put behind it."""
    arrangement = _Arrangement(tokens, spelling)
    arrangement.statement()
    rest = arrangement.finish()
    return lay_out(arrangement.parts, indent), rest


def on_one_line(tokens: Sequence[Token], spelling: Spelling) -> str:
    """Return the words of a statement on one line."""
    parts = [tokens[0].text]
    for left, right in pairwise(tokens):
        parts += (blank_between(left.kind, right.kind, spelling), right.text)
    return "".join(parts)


class _Arrangement:
    """The parts of one statement while they are put together.

    A comment goes to the next break from where it stands, and is handed back if there is none. Brackets that nest
    deeper than MAX_GROUPS stay on their line.
    """

    def __init__(self, tokens: Sequence[Token], spelling: Spelling) -> None:
        self.parts: list[Part] = []
        self._sentence, self._spelling = Sentence(tokens), spelling
        self._last = self._sentence.last
        self._depth = 0
        self._pending: list[Remark] = []
        self._break: Break | None = None
        self._before: Token | None = None

    def statement(self) -> None:
        """Put together all but the last word."""
        match self._sentence.tokens[0].kind:
            case "DECLARE" | "IN":
                self._listed(self._words, "COMMA")
            case "BELIEVE":
                self._listed(self._alternative, "VBAR")
            case "SCENE":
                self._scene()
            case "OBSERVE" | "REQUIRE":
                self._claim()
            case "LANDMARK":
                self._landmark()
            case _:
                self._words(0, self._last)

    def finish(self) -> tuple[Remark, ...]:
        """Put the last word, and return the comments that go behind it; a doc comment must stay before it."""
        token = self._sentence.tokens[self._last]
        self._pending += token.before.remarks
        if any(remark.documents for remark in self._pending):
            self._may_end()
        self.parts.append(f"{self._take_break(token)}{token.text}")
        return tuple(self._pending)

    def _listed(self, item: Callable[[int, int], None], separator: str) -> None:
        """A keyword, then items below each other if there are several and they were written so or do not fit."""
        self._words(0, 1)
        *ends, _ = (end for _, end in self._sentence.split(1, self._last, separator))
        if not ends:
            item(1, self._last)
            return
        new_line = self._sentence.line_ends_before
        broken = all(new_line(end) or new_line(end + 1) for end in ends)
        self._align(Open(None, broken=broken))
        self._items(1, self._last, separator, item)
        self._close()

    def _alternative(self, start: int, end: int) -> None:
        self._open(Open())
        fit = self._sentence.find(start, end, "TILDE")
        formula = self._sentence.behind("COLONS", start, fit)
        self._words(start, formula)
        self._formula(formula, fit)
        self._fit(fit, end)
        self._close()

    def _scene(self) -> None:
        formula = self._sentence.behind("IFF", 0, self._last)
        self._words(0, formula)
        self._open(Open(broken=self._sentence.line_ends_before(formula)))
        self._may_end(tight=True)
        self._formula(formula, self._last)
        self._close()

    def _claim(self) -> None:
        """`observe 3 × formula ~ fit` or `require 0.9 :: formula`: several atoms begin on a line of their own."""
        fit = self._sentence.find(0, self._last, "TILDE")
        formula = max(1, *(self._sentence.behind(kind, 0, fit) for kind in ("TIMES", "COLONS")))
        several = self._sentence.has(formula, fit, "AND", "OR") or bool(
            self._sentence.tokens[formula].before.remarks
        )
        self._words(0, formula if several else fit)
        self._open(Open())
        if several:
            self._may_end(tight=True)
            self._formula(formula, fit)
        self._fit(fit, self._last)
        self._close()

    def _landmark(self) -> None:
        self._open(Open())
        for at in self._sentence.units(0, self._last):
            if self._sentence.tokens[at].kind in ("AT", "FACING", "PLUSMINUS"):
                self._may_end()
            self._unit(at)
        self._close()

    def _fit(self, start: int, end: int) -> None:
        if start < end:
            self._may_end()
            self._words(start, end)

    def _formula(self, start: int, end: int) -> None:
        """A formula, with a break behind each connective of its lowest rank."""
        if self._sentence.has(start, end, "OR"):
            self._items(start, end, "OR", self._conjunction)
        else:
            self._items(start, end, "AND", self._words)

    def _conjunction(self, start: int, end: int) -> None:
        self._open(Open())
        self._items(start, end, "AND", self._words)
        self._close()

    def _items(self, start: int, end: int, separator: str, item: Callable[[int, int], None]) -> None:
        """Items with a separator behind each but the last, and a break behind each separator."""
        for first, last in self._sentence.split(start, end, separator):
            item(first, last)
            if last < end:
                self._word(last)
                self._may_end()

    def _words(self, start: int, end: int) -> None:
        for at in self._sentence.units(start, end):
            self._unit(at)

    def _unit(self, at: int) -> None:
        """One word, or brackets with all between them."""
        end = self._sentence.bracket_end(at)
        self._word(at)
        if end is None:
            return
        if self._depth < MAX_GROUPS:
            self._depth += 1
            self._bracketed(at + 1, end)
            self._depth -= 1
        else:
            for inner in range(at + 1, end):
                self._word(inner)
        self._word(end)

    def _bracketed(self, start: int, end: int) -> None:
        """What stands between brackets; plain items between round ones fill their lines."""
        sentence = self._sentence
        is_formula = sentence.has(start, end, "AND", "OR")
        is_plain = not is_formula and not sentence.has_brackets(start, end)
        self._open(Open(filled=is_plain and sentence.tokens[end].kind == "RPAR"))
        self._may_end(tight=True)
        if is_formula:
            self._formula(start, end)
        else:
            self._items(start, end, "COMMA", self._words)
        self._may_end(closing=True)
        self._close()

    def _word(self, at: int) -> None:
        token = self._sentence.tokens[at]
        self._pending += token.before.remarks
        if self._break is not None:
            self._break.blank = token.before.blank
        self.parts.append(f"{self._take_break(token)}{token.text}")

    def _take_break(self, token: Token) -> str:
        """Return the blank before a token; if a break is there, it takes the blank and the comments in its place."""
        blank = blank_between(self._before.kind, token.kind, self._spelling) if self._before else ""
        self._before = token
        if self._break is None:
            return blank
        self._break.flat, self._break.remarks = blank, tuple(self._pending)
        self._break = None
        self._pending = []
        return ""

    def _may_end(self, closing: bool = False, tight: bool = False) -> None:
        self._break = Break(closing=closing, tight=tight)
        self.parts.append(self._break)

    def _open(self, part: Open) -> None:
        self.parts.append(part)

    def _align(self, part: Open) -> None:
        self.parts += (" ", part)
        self._before = None

    def _close(self) -> None:
        self.parts.append(Close.GROUP)
