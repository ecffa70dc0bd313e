"""What outlives a session: the history of what was typed, what was not saved, and the details of failures.

All of it is in the user's state folder, and none of it ever fails.
"""

from __future__ import annotations

import os
import tempfile
import traceback
from datetime import datetime
from pathlib import Path

from qsrlang.cli.shell.saving import imports_of_paths, typed_path
from qsrlang.cli.shell.session import Session
from qsrlang.errors import FileError
from qsrlang.files import write_whole

MAX_LOG_BYTES = 1024 * 1024


def state_folder() -> Path:
    """Return the folder qsr of $XDG_STATE_HOME, or of ~/.local/state."""
    given = Path(os.environ.get("XDG_STATE_HOME", ""))
    root = given if given.is_absolute() else Path(typed_path("~/.local/state"))
    return root / "qsr"


def history_path() -> Path:
    """Return the file of what was typed: $QSR_HISTORY, or `history` in the state folder."""
    return Path(os.environ.get("QSR_HISTORY") or state_folder() / "history")


def keep_session(session: Session) -> Path | None:
    """Write what is known to a new file of its own and return its path, or None where no place can be written."""
    now, source = datetime.now(), session.source()
    name = f"kept-{now:%Y%m%d-%H%M%S}-{os.getpid()}.qsr"
    folder = (source.path.parent if source.path else Path()).resolve()
    imports = f"; to be used in {folder}, where its imports are" if imports_of_paths(source.text) else ""
    text = f"# Kept from a session of qsr repl, {now:%Y-%m-%d %H:%M}{imports}.\n{source.text}"
    for place in (state_folder(), Path(tempfile.gettempdir())):
        try:
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_whole(place / name, text)
        except (OSError, FileError):
            continue
        return place / name
    return None


def log_failure(error: BaseException, typed: str) -> Path | None:
    """Add the details of an unexpected error to the log and return its path, or None where it cannot be written."""
    path = state_folder() / "log"
    details = "".join(traceback.format_exception(error))
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        is_full = path.exists() and path.stat().st_size > MAX_LOG_BYTES
        with path.open("w" if is_full else "a", encoding="utf-8", errors="replace") as log:
            log.write(f"{datetime.now():%Y-%m-%d %H:%M:%S}\n{typed}\n{details}\n")
    except OSError:
        return None
    return path
