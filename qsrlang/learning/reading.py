"""Reading a file of observations, whatever its format."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from itertools import chain
from pathlib import Path

from qsrlang.errors import FileError
from qsrlang.learning.formats.ithor import is_ithor_table, read_ithor_table
from qsrlang.learning.formats.kth import is_kth_table, read_kth_table, read_kth_xml
from qsrlang.learning.formats.tables import Rows, read_csv, read_json_lines, read_parquet
from qsrlang.learning.screening import Reading, screened
from qsrlang.learning.store import ENDINGS, ObservationStore

MAX_BYTES = 1_000_000_000
Reader = Callable[[Path], Rows]
_BY_ENDING: dict[str, Reader] = {
    ".jsonl": read_json_lines,
    ".ndjson": read_json_lines,
    ".parquet": read_parquet,
    ".xml": read_kth_xml,
}
_OWN_COLUMNS = {"scene", "object", "class", "x", "y"}


def read_observations(*paths: Path | str) -> Reading:
    """Return the sound rows of files: CSV, JSON Lines, Parquet, a store (.sqlite), the KTH desk table or its raw XML,
    or the iTHOR/RoboTHOR table; the others are counted by what is wrong with them and set aside.

    Raises FileError where a file is missing or of no format that is read.
    """
    return screened(chain.from_iterable(_rows(Path(path)) for path in paths))


def _rows(path: Path) -> Rows:
    if not path.is_file():
        raise FileError(path, "is no file", "name a file of observations that exists")
    if path.stat().st_size > MAX_BYTES and path.suffix not in ENDINGS:
        raise FileError(
            path, f"is larger than {MAX_BYTES} bytes", "split it, and learn from one part after the other"
        )
    if path.suffix in ENDINGS:
        with ObservationStore(path) as store:
            yield from ((f"{path.name}:{number}", row) for number, row in enumerate(store.query().rows(), 1))
        return
    yield from (_csv_reader(path) if path.suffix == ".csv" else _known(path))(path)


def _known(path: Path) -> Reader:
    if path.suffix not in _BY_ENDING:
        known = ", ".join(sorted({".csv", *_BY_ENDING, *ENDINGS}))
        raise FileError(path, "is of no format that is read", f"give a file that ends in one of {known}")
    return _BY_ENDING[path.suffix]


def _csv_reader(path: Path) -> Reader:
    header = _header(path)
    if is_kth_table(header):
        return read_kth_table
    if is_ithor_table(header):
        return read_ithor_table
    lacking = _OWN_COLUMNS - set(header)
    if lacking:
        remedy = f"its first line must name at least {', '.join(sorted(_OWN_COLUMNS))}"
        raise FileError(path, f"has no column {' or '.join(sorted(lacking))}", remedy)
    return read_csv


def _header(path: Path) -> Iterable[str]:
    with path.open(encoding="utf-8", errors="replace", newline="") as file:
        return next(csv.reader([file.readline(100_000)]), [])
