"""TOML files checked field by field: whatever is wrong becomes one line with the file, the field and the remedy."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from qsrlang.errors import FileError

MAX_BYTES = 1_000_000


class Entry(BaseModel):
    """A table of a TOML file: unknown fields, infinities and silent conversions are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


EntryT = TypeVar("EntryT", bound=Entry)


def read_entry(path: Path, model: type[EntryT]) -> EntryT:
    """Return the file as a checked value of `model`; raises FileError with the first problem found."""
    table = _table(path)
    try:
        return model.model_validate(table)
    except ValidationError as error:
        raise _file_error(path, error, model) from None


def _table(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise FileError(
                path, f"larger than {MAX_BYTES} bytes", "such a file is not one of ours; give another"
            )
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, (error.strerror or "cannot be read").lower(), "check the path") from None
    except UnicodeDecodeError:
        raise FileError(path, "not a text file in UTF-8", "save it as UTF-8 TOML") from None
    except tomllib.TOMLDecodeError as error:
        raise FileError(path, f"not TOML: {_one_line(str(error))}", "mend that place") from None


def _file_error(path: Path, error: ValidationError, model: type[Entry]) -> FileError:
    problems = error.errors(include_url=False, include_context=False)
    first = next((one for one in problems if one["type"] == "extra_forbidden"), problems[0])
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    place = tuple(part for part in first["loc"] if not _is_union_branch(part))
    field = ".".join(str(part) for part in place) or "the whole file"
    if first["type"] == "extra_forbidden":
        return FileError(
            path, f"unknown field '{field}'{more}", f"remove it or use {_fields(model, first['loc'])}"
        )
    if first["type"] == "missing":
        return FileError(path, f"the field '{field}' is missing{more}", "add it")
    problem = _one_line(first["msg"]).removeprefix("Value error, ")
    return FileError(path, f"field '{field}': {problem[:1].lower()}{problem[1:]}{more}", "change it")


def _is_union_branch(part: int | str) -> bool:
    return isinstance(part, str) and part.endswith("Entry")


def _fields(model: type[Entry], place: tuple[int | str, ...]) -> str:
    for part in place[:-1]:
        model = _inner(model, part) or model
    return ", ".join(model.model_fields)


def _inner(model: type[Entry], part: int | str) -> type[Entry] | None:
    names = {kind.__name__: kind for kind in _entries(model)}
    if part in names:
        return names[str(part)]
    if part not in model.model_fields:
        return None
    kinds = _entries_of(model.model_fields[str(part)].annotation)
    return kinds[0] if len(kinds) == 1 else None


def _entries(model: type[Entry]) -> list[type[Entry]]:
    return [kind for field in model.model_fields.values() for kind in _entries_of(field.annotation)]


def _entries_of(annotation: Any) -> list[type[Entry]]:
    if isinstance(annotation, type) and issubclass(annotation, Entry):
        return [annotation]
    return [kind for inner in getattr(annotation, "__args__", ()) for kind in _entries_of(inner)]


def _one_line(text: str) -> str:
    return " ".join(text.split())
