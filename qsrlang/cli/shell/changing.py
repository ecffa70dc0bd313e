"""The colon commands that change what is known, or put it into a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from qsrlang.cli.shell.keeping import keep_session
from qsrlang.cli.shell.saving import read_knowledge, reload_file, save, typed_path
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.shell import Shell
from qsrlang.errors import FileError, ValueRangeError


def load_file(shell: Shell, argument: str) -> None:
    """Begin anew with a file."""
    shell.file = _named(argument, ":load FILE")
    _replace(shell, shell.session.become(read_knowledge(shell.file)))
    shell.remark(f"loaded {shell.session.knowledge.name}")


def reload(shell: Shell, argument: str) -> None:
    """Read the file again and keep what was stated."""
    if shell.file is not None and shell.session.knowledge.opening.path is None:
        load_file(shell, shell.file)
        return
    _replace(shell, reload_file(shell.session))
    shell.remark(f"loaded {shell.session.knowledge.name} again")


def clear(shell: Shell, argument: str) -> None:
    """Forget what was stated."""
    _replace(shell, shell.session.become(replace(shell.session.knowledge, stated=())))
    shell.remark("what was stated is forgotten; :undo brings it back")


def _replace(shell: Shell, session: Session) -> None:
    """Go on with another session; what it forgets and no file holds is kept in one."""
    before, shell.session = shell.session, session
    if set(before.unsaved) - set(session.knowledge.stated) and shell.is_interactive:
        path = keep_session(before)
        shell.remark(f"what was not saved is kept: :undo brings it back, and so does :load {path}")
    shell.tell_warnings(session.findings_since(before))


def undo(shell: Shell, argument: str) -> None:
    """Take back the last changes."""
    _step(shell, shell.session.undo(_count(argument)), "nothing to take back")


def redo(shell: Shell, argument: str) -> None:
    """Do again what was taken back."""
    _step(shell, shell.session.redo(_count(argument)), "nothing was taken back")


def _step(shell: Shell, session: Session, otherwise: str) -> None:
    before, shell.session = shell.session, session
    if before is session:
        shell.remark(otherwise)
        return
    old, new = before.knowledge, session.knowledge
    if old.opening != new.opening:
        shell.remark(f"back to {new.name}")
    gone = [one for one in old.stated if one not in new.stated]
    come = [one for one in new.stated if one not in old.stated]
    for sign, changed in (("-", gone), ("+", come)):
        for one in changed:
            shell.remark("\n".join(f"{sign} {line}" for line in one.text.splitlines()))


def save_new(shell: Shell, argument: str) -> None:
    """Write what is known to a new file."""
    _save_to(shell, argument, overwrite=False)


def save_over(shell: Shell, argument: str) -> None:
    """Write what is known to a file, whatever it holds."""
    _save_to(shell, argument, overwrite=True)


def _save_to(shell: Shell, argument: str, *, overwrite: bool) -> None:
    own = shell.session.knowledge.opening.path
    default = "" if own is None or shell.session.knowledge.is_shipped else str(own)
    path = Path(_named(argument or default, ":save FILE.qsr"))
    shell.session = save(shell.session, path, overwrite=overwrite)
    shell.file = str(path)
    shell.note(f"saved to {path}")


def _named(argument: str, usage: str) -> str:
    name = typed_path(argument)
    if not name or "\0" in name:
        raise FileError(name or "no file", "is no usable path" if name else "is named", usage)
    return name


def _count(argument: str) -> int:
    if argument and not (argument.isascii() and argument.isdigit() and int(argument[:9]) > 0):
        raise ValueRangeError("the number of inputs", f"'{argument}'", "a whole number above 0")
    return int(argument[:9] or 1)
