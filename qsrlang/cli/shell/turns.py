"""One input after another: what each does, and what is told when that fails."""

from __future__ import annotations

from qsrlang.cli.shell.commands import run_command
from qsrlang.cli.shell.inputs import Act, Passage, passages
from qsrlang.cli.shell.keeping import log_failure
from qsrlang.cli.shell.shell import Shell
from qsrlang.errors import QSRError
from qsrlang.language.diagnostics import LanguageError

MAX_TOLD = 200


def take(shell: Shell, text: str) -> None:
    """Do what an input says, up to the first part that fails; what goes wrong is told, never raised."""
    was_warned = shell.is_warned
    try:
        _take_parts(shell, text)
    except LanguageError as error:
        shell.has_failed = True
        shell.tell_findings(error.diagnostics)
    except QSRError as error:
        shell.tell_error(str(error))
    except BrokenPipeError:
        raise
    except Exception as error:
        tell_failure(shell, error, text)
    finally:
        shell.is_warned = shell.is_warned and not was_warned


def _take_parts(shell: Shell, text: str) -> None:
    before = shell.session
    for passage in passages(text):
        if passage.act is Act.COMMAND:
            run_command(shell, passage.text)
            return
        _take_part(shell, passage)
        shell.session = shell.session.as_one_step_from(before)


def _take_part(shell: Shell, passage: Passage) -> None:
    if passage.act is Act.STATE:
        shell.state(passage.text)
    else:
        shell.ask(passage.text)


def tell_failure(shell: Shell, error: Exception, text: str) -> None:
    """Tell of an error that is no user's mistake, in one line; its details go to the log."""
    told = " ".join(f"{type(error).__name__}: {error}".split())[:MAX_TOLD]
    path = log_failure(error, text)
    details = f"the details are in {path}" if path else "the details could not be written"
    shell.tell_error(f"this should not have happened: {told} ({details})")
