"""What to say where the text is not what the grammar expects."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from lark.exceptions import UnexpectedInput

from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.grammar import describe
from qsrlang.language.remedies import remedy
from qsrlang.language.slips import Remedy, Slip
from qsrlang.language.source import Span
from qsrlang.language.splitting import BEGINNING, last_word_end
from qsrlang.language.words import WORD

_MAX_EXPECTED = 14
_WORD = re.compile(rf'{WORD}|\d+(?:\.\d+)?(?:-?[^\W\d][\w-]*)?|"[^"\n]*"|::|<?[-=]+>|==|:[=-]|\|\||\+-|\S')
_STATEMENT = re.compile(BEGINNING)


@dataclass(frozen=True, slots=True)
class Rest:
    """A second statement in what should be one: where the first ends, and where the second starts."""

    before: int
    start: int


def rest_after_missing_stop(error: UnexpectedInput, span: Span) -> Rest | None:
    """Return where a statement begins on a new line although none was ended before, or None."""
    text, at = span.source.text, _position(error, span)
    if at <= span.start or not _STATEMENT.match(text, at) or "$END" not in _accepted(error):
        return None
    before = last_word_end(text, span.start, at)
    return Rest(before, at) if "\n" in text[before:at] else None


def explain(error: UnexpectedInput, span: Span) -> Diagnostic:
    """Return what was found, what the grammar expects there, and what would help."""
    text, at = span.source.text, _position(error, span)
    word = _WORD.match(text, at, span.end)
    place = Span(span.source, at, word.end() if word else at + 1)
    if at >= len(text):
        place = Span(span.source, max(span.start, at - 1), at)
    slip = Slip(place, word.group() if word else "", frozenset(_accepted(error)), span)
    found = remedy(slip) or Remedy("")
    return Diagnostic(
        "Q101", _message(slip), place, _expected(slip), found.help, edits=found.edits, sure=found.sure
    )


def _position(error: UnexpectedInput, span: Span) -> int:
    token = getattr(error, "token", None)
    if token is not None:
        return span.end if token.type == "$END" else int(token.start_pos)
    position = error.pos_in_stream
    return span.end if position is None else position


def _accepted(error: UnexpectedInput) -> set[str]:
    parser = getattr(error, "interactive_parser", None)
    return set() if parser is None else set(parser.accepts())


def _message(slip: Slip) -> str:
    if not slip.word:
        return (
            "the text ends too soon"
            if slip.whole.end == len(slip.whole.source.text)
            else "the statement ends too soon"
        )
    if slip.word.isprintable():
        return f'unexpected "{slip.word}"' if "'" in slip.word else f"unexpected '{slip.word}'"
    name = unicodedata.name(slip.word, "") if len(slip.word) == 1 else ""
    return f"unexpected character U+{ord(slip.word[0]):04X} {name}".rstrip()


def _expected(slip: Slip) -> str:
    if slip.starts and "SCENE" in slip.accepted:
        return "no statement begins so"
    accepted = slip.accepted - {"SIGN"} if "NUMBER" in slip.accepted else slip.accepted
    words = sorted({word for terminal in accepted for word in describe(terminal).split(" or ")})
    if not 0 < len(words) <= _MAX_EXPECTED:
        return ""
    return f"expected {' or '.join(filter(None, [', '.join(words[:-1]), words[-1]]))}"
