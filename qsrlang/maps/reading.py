"""Reads whole files of bounded size, and turns the operating system's complaints into one-line errors."""

from __future__ import annotations

from pathlib import Path

from qsrlang.errors import FileError


def read_bounded(path: Path, limit: int, kind: str) -> bytes:
    """Return the bytes of a file of at most `limit` bytes; `kind` names what the file should be.

    Raises FileError where the file is missing, unreadable, not a file or larger than the limit.
    """
    try:
        size = path.stat().st_size
        if not path.is_file():
            raise FileError(path, "this is not a file", f"name {kind}")
        if size > limit:
            raise FileError(path, f"{size:,} bytes are more than the limit of {limit:,}", f"name {kind}")
        return path.read_bytes()
    except FileNotFoundError:
        raise FileError(path, "there is no such file", f"name {kind} that exists") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise FileError(path, f"it cannot be read ({reason})", "check its name and permissions") from None
