"""What would help where a word does not fit: each rule knows one slip, and the first that applies is told."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable

from qsrlang.language.grammar import keywords, spellings
from qsrlang.language.slips import DIRECTIONS, LOOK_ALIKES, NAME, SIGNS, WORDS, Remedy, Slip

QUERIES_ELSEWHERE = "a file states what is known; ask queries with 'qsr ask FILE QUERY' or in 'qsr repl FILE'"
QUESTIONS = ("where", "prob", "explain", "views", "landmarks", "sample", "check")

_STATEMENTS = (
    "a statement begins with surface, static, dynamic, landmark, scene, believe, observe, require or relation"
)


def remedy(slip: Slip) -> Remedy | None:
    """Return what would help, or None."""
    return next(filter(None, (rule(slip) for rule in _RULES)), None)


def _question(slip: Slip) -> Remedy | None:
    return Remedy(QUERIES_ELSEWHERE) if slip.starts and slip.word in QUESTIONS else None


def _comment(slip: Slip) -> Remedy | None:
    text = slip.place.source.text[slip.place.start : slip.place.start + 2]
    if text not in ("//", "/*", "--", "%%", "<!"):
        return None
    return Remedy("a comment begins with '#'", slip.edit("#", 2), sure=text == "//")


def _look_alike(slip: Slip) -> Remedy | None:
    right = LOOK_ALIKES.get(slip.word[:1])
    return Remedy(f"write '{right}'", slip.edit(right, 1)) if right else None


def _doubled(slip: Slip) -> Remedy | None:
    twice = slip.word in ("&", "|", "~", ",", ":") and slip.before == slip.word
    return Remedy(f"write '{slip.word}' once", slip.edit("")) if twice else None


def _bar(slip: Slip) -> Remedy | None:
    if slip.word not in ("|", "||") or slip.whole.text.startswith("believe"):
        return None
    return Remedy(
        "write '∨'; '|' separates the alternatives of 'believe'", slip.edit("∨"), sure=slip.word == "||"
    )


def _share(slip: Slip) -> Remedy | None:
    number = re.match(r"\s*[\d.]+(?:\s*%)?", slip.after)
    late = slip.word in (":", "::") and slip.before == ")" and number
    return Remedy(f"the share comes first: '{number.group().strip()} :: …'") if number and late else None


def _no_connective(slip: Slip) -> Remedy | None:
    beside = slip.before == ")" and slip.is_applied
    if "AND" not in slip.accepted or not (slip.word == "," or beside):
        return None
    if "VBAR" in slip.accepted:
        return Remedy("write '∧' between what holds together, '|' between alternatives")
    return Remedy("write '∧' between what holds together", slip.edit("∧ ", 0) if beside else slip.edit(" ∧"))


def _sign(slip: Slip) -> Remedy | None:
    text = slip.place.source.text
    for sign, terminal, right in SIGNS:
        if terminal in slip.accepted and text.startswith(sign, slip.place.start):
            return Remedy(f"write '{right.strip()}'", slip.edit(right, len(sign)))
    return None


def _word(slip: Slip) -> Remedy | None:
    terminal, right = WORDS.get(slip.word, ("", ""))
    return Remedy(f"write '{right}'", slip.edit(right)) if terminal in slip.accepted else None


def _count(slip: Slip) -> Remedy | None:
    text = slip.place.source.text[slip.whole.start : slip.place.start]
    if "TIMES" not in slip.accepted or not text.startswith("observe"):
        return None
    if slip.word[:1] in ("%", ":"):
        return Remedy("an observation is counted: 'observe 85 × …'; shares belong to 'believe'")
    return Remedy("write a '×' after the count", slip.edit("× ", 0)) if NAME.match(slip.word) else None


def _fact(slip: Slip) -> Remedy | None:
    if not (slip.starts and slip.is_applied):
        return None
    return Remedy(f"say how it is known: 'observe {slip.word}(…)' or 'believe {slip.word}(…)'")


def _context(slip: Slip) -> Remedy | None:
    if slip.starts and slip.word == "in":
        return Remedy("a context has its statements in braces: in room kitchen { … }")
    if "ROOM" in slip.accepted and slip.is_name:
        return Remedy(f"write 'room {slip.word}'", slip.edit("room ", 0))
    return None


def _infix(slip: Slip) -> Remedy | None:
    relatum = NAME.match(slip.after.lstrip())
    if (
        "LPAR" not in slip.accepted
        or relatum is None
        or not (NAME.match(slip.word) and NAME.fullmatch(slip.before))
    ):
        return None
    return Remedy(f"the relation comes first: {slip.word}({slip.before}, {relatum.group()})")


def _bare_name(slip: Slip) -> Remedy | None:
    if not slip.accepted <= {"LPAR", "$END", "QMARK"} or "LPAR" not in slip.accepted:
        return None
    if slip.before == "elsewhere":
        return Remedy("'elsewhere' can only be an alternative of 'believe'")
    if re.match(r"scene\s+\S+\s*\Z", slip.place.source.text[slip.whole.start : slip.place.start]):
        return Remedy(f"a scene lists its members: scene {slip.before}(Plate, Cup) ⇔ …")
    if NAME.fullmatch(slip.before) and slip.before not in keywords():
        return Remedy(f"a relation needs its arguments: {slip.before}(referent, relatum)")
    if slip.before in ("at", "±") or slip.before == "-":
        return Remedy("write all values in parentheses, such as (1.2 m, 3 m)")
    return None


def _two_names(slip: Slip) -> Remedy | None:
    between = "COMMA" in slip.accepted and slip.is_name and NAME.fullmatch(slip.before)
    if not between or slip.before in keywords():
        return None
    return Remedy(
        f"two names have ',' between them; one name is written together: '{slip.before}-{slip.word}'"
    )


def _odd_name(slip: Slip) -> Remedy | None:
    text, at = slip.place.source.text, slip.place.start
    inside = re.match(r"\w", text[at - 1 : at]) and re.match(r"\w", text[at + 1 : at + 2])
    digit = (
        slip.accepted <= {"NAME", "RPAR", "LPAR", "NOT"}
        and "NAME" in slip.accepted
        and slip.word[:1].isdigit()
    )
    if digit or (inside and not slip.starts and re.fullmatch(r"[^\w\s.,:;()|]", slip.word)):
        return Remedy("a name begins with a letter and holds letters, digits, '_' and inner '-'")
    return None


def _quotes(slip: Slip) -> Remedy | None:
    if slip.accepted != {"STRING"}:
        return None
    if slip.word.startswith('"'):
        return Remedy("close the quotes on the same line")
    written = re.match(r"\S+", slip.place.source.text[slip.place.start : slip.whole.end])
    target = written.group() if written else slip.word
    return Remedy(f'write "{target}"', slip.edit(f'"{target}"', len(target)))


def _frame(slip: Slip) -> Remedy | None:
    if "FRAME" not in slip.accepted or not slip.is_name:
        return None
    return Remedy("'wrt' names the frame of reference; the relatum is an argument of the relation")


def _direction(slip: Slip) -> Remedy | None:
    if slip.before != "facing" or slip.word not in DIRECTIONS:
        return None
    return Remedy("a heading is an angle, counter-clockwise from the map's +x, such as 'facing 90 deg'")


def _time(slip: Slip) -> Remedy | None:
    if slip.accepted != {"TIME"} or not slip.word.isdecimal() or len(slip.word) > 2 or int(slip.word) > 24:
        return None
    time = f"{int(slip.word):02d}:00"
    return Remedy(f"write '{time}'", slip.edit(time))


def _closing(slip: Slip) -> Remedy | None:
    if slip.word == "}" and slip.before == "{":
        return Remedy("leave the braces out")
    if slip.word == ")" and "RPAR" not in slip.accepted and "$END" in slip.accepted:
        return Remedy("no parenthesis is open here", slip.edit(""))
    if not slip.word and "RPAR" in slip.accepted:
        return Remedy("close the parenthesis")
    return Remedy("close the brace") if not slip.word and "RBRACE" in slip.accepted else None


def _keyword(slip: Slip) -> Remedy | None:
    words = [word for terminal in slip.accepted for word in spellings().get(terminal, ()) if len(word) > 2]
    nearest = () if slip.word in keywords() else difflib.get_close_matches(slip.word, words, n=1)
    return Remedy(f"did you mean '{nearest[0]}'?", slip.edit(nearest[0])) if nearest else None


def _run_on(slip: Slip) -> Remedy | None:
    begins = {
        word for head in ("DECLARE", "SCENE", "BELIEVE", "OBSERVE", "REQUIRE") for word in spellings()[head]
    }
    if "$END" not in slip.accepted or slip.word not in begins:
        return None
    return Remedy("a statement ends with '.'", slip.edit(". ", 0))


def _no_statement(slip: Slip) -> Remedy | None:
    return Remedy(_STATEMENTS) if slip.starts and "SCENE" in slip.accepted else None


_RULES: tuple[Callable[[Slip], Remedy | None], ...] = (
    _question,
    _comment,
    _look_alike,
    _doubled,
    _bar,
    _share,
    _no_connective,
    _sign,
    _word,
    _count,
    _fact,
    _context,
    _infix,
    _bare_name,
    _odd_name,
    _quotes,
    _frame,
    _direction,
    _time,
    _closing,
    _keyword,
    _two_names,
    _run_on,
    _no_statement,
)
