"""Which rows can be used: the others are counted by what is wrong with them and set aside, never used."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from qsrlang.files import write_whole
from qsrlang.language.words import MARKS, WORD
from qsrlang.learning.observations import NOWHERE, NUMBERS, TEXTS, Observations, Row

MAX_METRES = 1000.0
MAX_SIZE = 20.0
MAX_TURNS = 100.0
MAX_SHOWN = 1000
_REQUIRED = ("scene", "object", "kind", "x", "y")
_DEFAULTS = {
    "place": NOWHERE,
    "support": NOWHERE,
    "source": NOWHERE,
    "time": 0.0,
    "z": 0.0,
    "confidence": 1.0,
}
_NAME = re.compile(WORD)
_SIZES = ("length", "width", "height")


class Unsound(Exception):
    """A row that cannot be used, with the reason in a few words."""


@dataclass(frozen=True, slots=True)
class SetAside:
    """A row that was not used: where it stood, why, and what it said."""

    where: str
    reason: str
    content: Mapping[str, object] = field(compare=False)


@dataclass(frozen=True, slots=True, eq=False)
class Reading:
    """Sound observations, how many rows were set aside for each reason, and the first of those rows."""

    observations: Observations
    reasons: Mapping[str, int]
    aside: tuple[SetAside, ...]

    @property
    def rejected(self) -> int:
        """How many rows were set aside."""
        return sum(self.reasons.values())

    def report(self) -> str:
        """Return one line on what was used and what was not."""
        told = "; ".join(f"{count} {reason}" for reason, count in sorted(self.reasons.items()))
        return f"{len(self.observations)} sightings used, {self.rejected} set aside" + (
            f": {told}" if told else ""
        )

    def write_aside(self, path: Path) -> None:
        """Write the rows that were set aside, with their reasons, as JSON Lines."""
        lines = [{"where": one.where, "reason": one.reason} | dict(one.content) for one in self.aside]
        write_whole(path, "".join(json.dumps(line, ensure_ascii=False, default=str) + "\n" for line in lines))


def screened(rows: Iterable[tuple[str, Row | Unsound]]) -> Reading:
    """Return what is sound among rows, each with the place where it stands; at most MAX_SHOWN others are kept."""
    reasons: Counter[str] = Counter()
    aside: list[SetAside] = []
    observations = Observations.of(_sound(rows, reasons, aside))
    return Reading(observations, dict(reasons), tuple(aside))


def _sound(
    rows: Iterable[tuple[str, Row | Unsound]], reasons: Counter[str], aside: list[SetAside]
) -> Iterator[Row]:
    for where, row in rows:
        try:
            if isinstance(row, Unsound):
                raise row
            yield sound(row)
        except Unsound as error:
            reasons[str(error)] += 1
            if len(aside) < MAX_SHOWN:
                aside.append(SetAside(where, str(error), {} if isinstance(row, Unsound) else row))


def sound(row: Row) -> Row:
    """Return a row of the schema with numbers as floats and gaps filled; raises Unsound."""
    missing = [name for name in _REQUIRED if row.get(name) in (None, "")]
    if missing:
        raise Unsound(f"without {missing[0]}")
    texts = {name: str(row.get(name) or _DEFAULTS.get(name, NOWHERE)) for name in TEXTS}
    texts |= {name: as_name(texts[name], name) for name in ("kind", "place") if texts[name]}
    numbers = {name: _number(name, row.get(name)) for name in NUMBERS}
    _check(numbers)
    return texts | numbers


def as_name(text: str, column: str) -> str:
    """Return a text as a name of the language: `coffee mug` is `coffee-mug`, and the place `133` is `place-133`."""
    if _NAME.fullmatch(text):
        return text
    joined = "-".join(re.findall(rf"[\w{MARKS}]+", text))
    return joined if _NAME.fullmatch(joined) else f"{'class' if column == 'kind' else column}-{joined or 'x'}"


def _number(name: str, value: object) -> float:
    if value is None or value == "":
        return float(_DEFAULTS.get(name, math.nan if name == "yaw" else 0.0))  # type: ignore[arg-type]
    if name == "time" and not isinstance(value, int | float):
        return seconds_of(str(value))
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise Unsound(f"with a {name} that is no number") from None


def seconds_of(text: str) -> float:
    """Return seconds since 1970 on the clock that an ISO 8601 text, or a number, tells; raises Unsound."""
    try:
        return float(text)
    except ValueError:
        pass
    try:
        return datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp()
    except ValueError:
        raise Unsound("with a time that is neither ISO 8601 nor seconds") from None


def _check(numbers: Mapping[str, float]) -> None:
    for name in ("x", "y", "z", "time", *_SIZES, "confidence"):
        if not math.isfinite(numbers[name]):
            raise Unsound(f"with a {name} that is not finite")
    if max(abs(numbers[name]) for name in ("x", "y", "z")) > MAX_METRES:
        raise Unsound(f"further away than {MAX_METRES:g} m")
    if not all(0.0 <= numbers[name] <= MAX_SIZE for name in _SIZES):
        raise Unsound(f"with a size below 0 or above {MAX_SIZE:g} m")
    if math.isinf(numbers["yaw"]) or abs(numbers["yaw"]) > MAX_TURNS:
        raise Unsound("with a bad yaw")
    if not 0.0 <= numbers["confidence"] <= 1.0:
        raise Unsound("with a confidence outside 0 to 1")
