"""A robot's life of sightings in one SQLite file: appended as they come, asked by place and time."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType

from qsrlang.errors import FileError
from qsrlang.learning.observations import NUMBERS, TEXTS, Observations

ENDINGS = frozenset({".sqlite", ".db"})
COLUMNS = (*TEXTS, *NUMBERS)
_APPLICATION = 0x71737231
_SCHEMA = (
    f"CREATE TABLE IF NOT EXISTS sightings ({', '.join(f'{name} TEXT NOT NULL' for name in TEXTS)}, "
    f"{', '.join(f'{name} REAL' for name in NUMBERS)}) STRICT",
    "CREATE INDEX IF NOT EXISTS by_place ON sightings (place, time)",
    "CREATE INDEX IF NOT EXISTS by_time ON sightings (time)",
)


class ObservationStore:
    """Sightings in an SQLite file, made where there is none; use it as a context manager.

    A batch is stored whole or not at all, also where the process or the machine stops (write-ahead log, synchronised
    at every batch). Raises FileError where the file is something else.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        with self._told():
            self._connection = sqlite3.connect(self.path, isolation_level=None)
            self._open()

    def __enter__(self) -> ObservationStore:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connection.close()

    def __len__(self) -> int:
        return int(self._connection.execute("SELECT count(*) FROM sightings").fetchone()[0])

    def append(self, observations: Observations) -> None:
        """Store observations, all of them or none."""
        texts = [observations.text(name) for name in TEXTS]
        rows = zip(*texts, *observations.numbers.T.tolist(), strict=True)
        with self._told(), self._transaction():
            marks = ", ".join("?" for _ in COLUMNS)
            self._connection.executemany(f"INSERT INTO sightings VALUES ({marks})", rows)

    def query(
        self, place: str | None = None, start: float | None = None, end: float | None = None
    ) -> Observations:
        """Return what was seen at a place, or anywhere, from `start` up to before `end` [s], in time order."""
        asked = {"place = ?": place, "time >= ?": start, "time < ?": end}
        limits = {test: value for test, value in asked.items() if value is not None}
        where = f" WHERE {' AND '.join(limits)}" if limits else ""
        text = f"SELECT {', '.join(COLUMNS)} FROM sightings{where} ORDER BY time, rowid"
        with self._told():
            rows = self._connection.execute(text, tuple(limits.values()))
            return Observations.of(dict(zip(COLUMNS, map(_given, row), strict=True)) for row in rows)

    def places(self) -> tuple[str, ...]:
        """Return the places that something was seen at, by name."""
        rows = self._connection.execute("SELECT DISTINCT place FROM sightings ORDER BY place")
        return tuple(place for (place,) in rows)

    def _open(self) -> None:
        owner = self._connection.execute("PRAGMA application_id").fetchone()[0]
        filled = self._connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
        if filled and owner != _APPLICATION:
            raise FileError(self.path, "is a database of something else", "name a new file")
        self._connection.execute("PRAGMA journal_mode = WAL")
        self._connection.execute("PRAGMA synchronous = FULL")
        with self._transaction():
            self._connection.execute(f"PRAGMA application_id = {_APPLICATION}")
            for statement in _SCHEMA:
                self._connection.execute(statement)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._connection.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            self._connection.execute("ROLLBACK")
            raise
        self._connection.execute("COMMIT")

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            remedy = "name a store made by this program, or a new file in a folder that may be written"
            raise FileError(self.path, f"cannot be used as a store ({error})", remedy) from None


def _given(value: str | float | None) -> str | float:
    """SQLite keeps no nan, and gives None for it."""
    return float("nan") if value is None else value
