"""Where and when statements hold: which contexts match, and which of two is the more specific."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace

from qsrlang.language.questions import Circumstances as Asked
from qsrlang.language.statements import Condition, Context, Days, Period, Room

MINUTES_A_DAY = 24 * 60


@dataclass(frozen=True, slots=True)
class Circumstances:
    """Where and when a question is asked; None is not known, and matches no condition.

    `minutes` are those after midnight.
    """

    room: str | None = None
    weekend: bool | None = None
    minutes: int | None = None

    @classmethod
    def of(cls, asked: Asked | None) -> Circumstances:
        """Return the circumstances that a query names."""
        if asked is None:
            return cls()
        weekend = None if asked.days is None else asked.days == "weekend"
        return cls(asked.room.text if asked.room else None, weekend, asked.time)

    def refined(self, asked: Asked | None) -> Circumstances:
        """Return these circumstances with what a query names in the place of what was."""
        said = {name: value for name, value in asdict(Circumstances.of(asked)).items() if value is not None}
        return replace(self, **said)


def circumstances_of(context: Context) -> Circumstances | None:
    """Return circumstances in which a context matches; None where its conditions exclude each other."""
    if not compatible(context.conditions):
        return None
    rooms = (one.name.text for one in context.conditions if isinstance(one, Room))
    days = (one.days == "weekend" for one in context.conditions if isinstance(one, Days))
    periods = [minutes_of(one) for one in context.conditions if isinstance(one, Period)]
    minutes = min(frozenset.intersection(*periods)) if periods else None
    return Circumstances(next(rooms, None), next(days, None), minutes)


def matches(context: Context, circumstances: Circumstances) -> bool:
    """Return whether all conditions of a context hold."""
    return all(_holds(condition, circumstances) for condition in context.conditions)


def _holds(condition: Condition, circumstances: Circumstances) -> bool:
    match condition:
        case Room(name=name):
            return circumstances.room == name.text
        case Days(days=days):
            return circumstances.weekend is not None and circumstances.weekend == (days == "weekend")
        case Period():
            return circumstances.minutes is not None and circumstances.minutes in minutes_of(condition)


def minutes_of(period: Period) -> frozenset[int]:
    """Return the minutes after midnight that a period covers."""
    length = (period.end - period.start) % MINUTES_A_DAY
    return frozenset((period.start + minute) % MINUTES_A_DAY for minute in range(length))


def compatible(conditions: Iterable[Condition]) -> bool:
    """Return whether conditions can hold together."""
    conditions = tuple(conditions)
    rooms = {one.name.text for one in conditions if isinstance(one, Room)}
    days = {one.days for one in conditions if isinstance(one, Days)}
    periods = [minutes_of(one) for one in conditions if isinstance(one, Period)]
    return len(rooms) <= 1 and len(days) <= 1 and (not periods or bool(frozenset.intersection(*periods)))


def rank(context: Context) -> int:
    """Return how specific a context is: how many kinds of conditions it has."""
    return len({type(condition) for condition in context.conditions})


def more_specific(one: Context, other: Context) -> bool:
    """Return whether a context wins over another: it has more kinds of conditions, or as many and implies them."""
    if rank(one) != rank(other):
        return rank(one) > rank(other)
    return implies(one, other) and not implies(other, one)


def implies(one: Context, other: Context) -> bool:
    """Return whether the other context holds wherever and whenever this one does."""
    return all(any(_covers(wide, narrow) for narrow in one.conditions) for wide in other.conditions)


def _covers(wide: Condition, narrow: Condition) -> bool:
    if isinstance(wide, Period) and isinstance(narrow, Period):
        return minutes_of(narrow) <= minutes_of(wide)
    return wide == narrow
