"""Our own schema in CSV, JSON Lines and Parquet: the columns of Observations, `class` for `kind`."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from qsrlang.errors import FileError
from qsrlang.files import write_whole
from qsrlang.learning.observations import NUMBERS, Observations, Row
from qsrlang.learning.screening import Unsound

try:
    import pyarrow as arrow
    import pyarrow.parquet as arrow_parquet
except ImportError:  # the extra `qsrlang[parquet]` is not installed
    arrow = arrow_parquet = None

MAX_LINE = 100_000
COLUMNS = ("time", "place", "scene", "object", "class", *NUMBERS[1:-1], "support", "source", "confidence")
Rows = Iterator[tuple[str, Row | Unsound]]


def read_csv(path: Path) -> Rows:
    """Yield the rows of a CSV file with a header."""
    for where, row in csv_rows(path):
        uneven = None in row or None in row.values()
        yield where, Unsound("with too few or too many cells") if uneven else _named(row)


def csv_rows(path: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the rows of a CSV file by its header, each with its place; raises FileError where it cannot be read."""
    with path.open(encoding="utf-8", errors="replace", newline="") as file:
        reader = csv.DictReader(_lines(file))
        try:
            for row in reader:
                yield f"{path.name}:{reader.line_num}", row
        except csv.Error as error:
            problem = f"cannot be read from line {reader.line_num} on ({error})"
            raise FileError(path, problem, "mend that line, or export the table anew") from None


def or_unsound(make: Callable[[Row], Row], row: Row) -> Row | Unsound:
    """Return what is made of a row; Unsound where a number is missing or is none."""
    try:
        return make(row)
    except (KeyError, TypeError, ValueError):
        return Unsound("with cells that are no numbers")


def read_json_lines(path: Path) -> Rows:
    """Yield the rows of a file with one JSON object a line."""
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(_lines(file), 1):
            if line.strip():
                yield f"{path.name}:{number}", _json_row(line)


def read_parquet(path: Path) -> Rows:
    """Yield the rows of a Parquet file; raises FileError without the extra `qsrlang[parquet]`."""
    if arrow_parquet is None:
        remedy = "install it with: pip install 'qsrlang[parquet]', or save the table as CSV"
        raise FileError(path, "is a Parquet file, and pyarrow is not installed", remedy)
    try:
        file = arrow_parquet.ParquetFile(path)
        number = 0
        for batch in file.iter_batches():
            for row in batch.to_pylist():
                number += 1
                yield f"{path.name}:{number}", _named(row)
    except (arrow.ArrowInvalid, OSError) as error:
        raise FileError(path, f"is no Parquet file ({error})", "export it anew") from None


def csv_text(observations: Observations) -> str:
    """Return observations as CSV with the columns of COLUMNS."""
    out = io.StringIO()
    writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(_written(row) for row in observations.rows())
    return out.getvalue()


def json_lines_text(observations: Observations) -> str:
    """Return observations as JSON Lines."""
    rows = (json.dumps(_written(row), ensure_ascii=False) for row in observations.rows())
    return "".join(f"{row}\n" for row in rows)


def write_observations(observations: Observations, file: Path | str) -> None:
    """Write observations as CSV, JSON Lines or Parquet, by the ending of the file's name; raises FileError."""
    path = Path(file)
    if path.suffix == ".csv":
        write_whole(path, csv_text(observations))
    elif path.suffix == ".jsonl":
        write_whole(path, json_lines_text(observations))
    elif path.suffix == ".parquet" and arrow_parquet is not None:
        sink = arrow.BufferOutputStream()
        arrow_parquet.write_table(arrow.Table.from_pylist([_written(r) for r in observations.rows()]), sink)
        write_whole(path, sink.getvalue().to_pybytes())
    else:
        raise FileError(path, "cannot be written", "name a .csv or .jsonl file, or .parquet with pyarrow")


def _lines(file: Any) -> Iterator[str]:
    """Yield the lines of a file; a longer one than MAX_LINE is cut, and so no longer sound."""
    while line := file.readline(MAX_LINE):
        yield line


def _json_row(line: str) -> Row | Unsound:
    try:
        row = json.loads(line)
    except (ValueError, RecursionError):
        return Unsound("that are no JSON")
    return _named(row) if isinstance(row, dict) else Unsound("that are no JSON objects")


def _named(row: Row) -> Row:
    """Return a row with the column `class` under the name of the schema."""
    return {"kind" if name == "class" else name: value for name, value in row.items()}


def _written(row: Row) -> dict[str, Any]:
    """Return a row as it is written: `class`, and nothing where there is no yaw."""
    named = {name: row["kind" if name == "class" else name] for name in COLUMNS}
    return named | {"yaw": None if named["yaw"] != named["yaw"] else named["yaw"]}
