"""The world a session asks in: `room r133, weekday at 09:30 viewer (1.2 m, 0.5 m)`."""

from __future__ import annotations

import re
from dataclasses import replace

from qsrlang.cli.shell.session import Session
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.parser import parse_place
from qsrlang.language.statements import Context, Room
from qsrlang.relations.build import ANYWHERE, Built

_PART = re.compile(
    r"[\s,]*(?:(?:in\s+)?room\s+(?P<room>[^\W\d][\w-]*)|at\s+(?P<hours>\d{1,2}):(?P<minutes>\d{2})"
    r"|(?P<days>weekday|weekend)|viewer\s*\((?P<place>[^)]*)\)|(?P<none>none))(?![\w-])[\s,]*"
)
_EXPECTED = "room NAME, at HH:MM, weekday or weekend, viewer (x m, y m), or none"


def enter(session: Session, text: str) -> Session:
    """Return the session with the parts of the world that a text names; `none` takes all back."""
    position = 0
    while position < len(text):
        part = _PART.match(text, position)
        if part is None:
            raise ValueRangeError("a part of the world", f"'{text[position:]}'", _EXPECTED)
        session = _with_part(session, part)
        position = part.end()
    return session


def describe(session: Session) -> str:
    """Return the world in the words that `enter` reads; "" where nothing is said."""
    here = session.circumstances
    parts = [f"room {here.room}"] if here.room else []
    parts += [] if here.weekend is None else ["weekend" if here.weekend else "weekday"]
    parts += [] if here.minutes is None else [f"at {here.minutes // 60:02d}:{here.minutes % 60:02d}"]
    parts += [f"viewer ({session.viewer.x:g} m, {session.viewer.y:g} m)"] if session.viewer else []
    return " ".join(parts)


def rooms_of(built: Built) -> tuple[str, ...]:
    """Return the rooms that contexts speak of."""
    contexts = (
        one for document in built.library.documents for one in document.statements if isinstance(one, Context)
    )
    return tuple(
        sorted({one.name.text for context in contexts for one in context.conditions if isinstance(one, Room)})
    )


def _with_part(session: Session, part: re.Match[str]) -> Session:
    here = session.circumstances
    match part.lastgroup:
        case "room":
            return replace(session, circumstances=replace(here, room=part["room"]))
        case "days":
            return replace(session, circumstances=replace(here, weekend=part["days"] == "weekend"))
        case "minutes":
            minutes = _minutes(int(part["hours"]), int(part["minutes"]))
            return replace(session, circumstances=replace(here, minutes=minutes))
        case "place":
            return replace(session, viewer=Pose2(*parse_place(part["place"])))
    return replace(session, circumstances=ANYWHERE, viewer=None)


def _minutes(hours: int, minutes: int) -> int:
    if hours > 23 or minutes > 59:
        raise ValueRangeError("the time", f"{hours:02d}:{minutes:02d}", "00:00 to 23:59")
    return 60 * hours + minutes
