"""The canonical form of a text: blanks, line ends and signs, but no word, number or comment, are changed."""

from __future__ import annotations

import re
from collections.abc import Iterable

from qsrlang.language.lexing import Word
from qsrlang.language.parser import words_of
from qsrlang.language.printing.arrangement import arrange, on_one_line
from qsrlang.language.printing.layout import INDENT, WIDTH
from qsrlang.language.printing.sentence import NO_GAP, Gap, Remark, Token, read_gap
from qsrlang.language.printing.spelling import LANDMARK_COLON, SIGNS, Spelling
from qsrlang.language.source import Source
from qsrlang.language.splitting import Kind, Piece, skip_blank, split

_LINE_ENDS = re.compile(r"\r+\n")


def format_source(source: Source, spelling: Spelling = "unicode") -> str:
    """Return a text in its canonical form, with the same Document, the same comments and the same order of all.

    Numbers and units stay as they were typed, and so do statements that cannot be read.
    """
    clean = Source(source.name, _LINE_ENDS.sub("\n", source.text))
    page = _Page(clean, spelling)
    for piece in split(clean):
        page.take(piece)
    return page.finish()


class _Page:
    """A text while it is being formatted, up to `_at`."""

    def __init__(self, source: Source, spelling: Spelling) -> None:
        self._text, self._spelling = source.text, spelling
        self._at = self._depth = 0
        self._lines: list[str] = []
        self._remarked = self._opened = True
        self._unread = False

    def take(self, piece: Piece) -> None:
        """Add a piece with all that stands before it."""
        gap = self._text[self._at : piece.span.start]
        between = read_gap(gap)
        if piece.kind is Kind.CONTEXT_END:
            self._end_context(between, piece.span.end)
            return
        self._at = self._end_of(piece)
        formatted = self._formatted(piece)
        unread = formatted is None and piece.kind is Kind.STATEMENT
        if unread and self._unread:
            self._lines[-1] += gap + self._text[piece.span.start : self._at]
            return
        self._remark(between.remarks)
        lines, rest = formatted or (self._text[piece.span.start : self._at], ())
        self._put(lines, between.blank)
        self._unread = unread
        if piece.kind is Kind.CONTEXT_HEAD:
            self._depth += 1
            self._opened = True
        self._remark(rest)

    def finish(self) -> str:
        """Add the comments at the end, and return the text."""
        self._remark(read_gap(self._text[self._at :]).remarks)
        return "\n".join([*self._lines, ""]) if self._lines else ""

    def _end_of(self, piece: Piece) -> int:
        """Return where a piece ends, its full stop or question mark included."""
        return skip_blank(self._text, piece.span.end) + 1 if piece.end else piece.span.end

    def _formatted(self, piece: Piece) -> tuple[str, tuple[Remark, ...]] | None:
        """Return the lines of a piece and the comments to put behind it; None where it cannot be read."""
        typed = self._text[piece.span.start : self._at]
        words = None
        if piece.end == "." or piece.kind is Kind.CONTEXT_HEAD:
            words = words_of(piece.span, piece.depth, piece.kind.value)
        if not words:
            return None
        indent = INDENT * self._depth
        if "#" not in typed and "\n" not in typed:
            line = on_one_line(self._tokens(words, piece, plain=True), self._spelling)
            if len(line) <= WIDTH - indent:
                return line, ()
        return arrange(self._tokens(words, piece), self._spelling, indent)

    def _tokens(self, words: tuple[Word, ...], piece: Piece, plain: bool = False) -> list[Token]:
        """Return the words of a piece and its full stop as they are to be spelled, with what lies before each."""
        signs, text, at = SIGNS[self._spelling], self._text, piece.span.start
        tokens = []
        for word in words:
            before = NO_GAP if plain or word.start_pos == at else read_gap(text[at : word.start_pos])
            tokens.append(Token(word.type, signs.get(word.type, word.value), before))
            at = word.end_pos
        if words[0].type == "LANDMARK":
            tokens[2] = Token(LANDMARK_COLON, ":", tokens[2].before)
        if piece.end:
            tokens.append(Token("DOT", piece.end, read_gap(text[at : self._at - 1])))
        return tokens

    def _end_context(self, between: Gap, end: int) -> None:
        """Close a context; a full stop behind it is left out where nothing would be read differently without it."""
        empty = self._opened and not between.remarks and bool(self._lines) and not self._remarked
        self._remark(between.remarks)
        self._depth = max(0, self._depth - 1)
        if empty:
            self._lines[-1] += " }"
        else:
            self._put("}", blank=False)
        self._opened = False
        self._at = end
        stop = skip_blank(self._text, end)
        if not self._text.startswith(".", stop):
            return
        behind = read_gap(self._text[end:stop]).remarks
        self._remark(behind)
        self._at = stop + 1
        if self._text.startswith(".", skip_blank(self._text, self._at)) or any(
            one.documents for one in behind
        ):
            self._stop()

    def _stop(self) -> None:
        if self._remarked:
            self._put(".", blank=False)
        else:
            self._lines[-1] += "."

    def _put(self, lines: str, blank: bool) -> None:
        if blank and not self._opened:
            self._lines.append("")
        self._lines.append(" " * (INDENT * self._depth) + lines)
        self._remarked = self._opened = self._unread = False

    def _remark(self, remarks: Iterable[Remark]) -> None:
        """Add comments, the first behind the last line if it stood there and there is room for it."""
        for remark in remarks:
            if remark.behind and not self._remarked:
                self._lines[-1] += f"  {remark.text}"
            else:
                self._put(remark.text, remark.blank)
            self._remarked = True
