"""`qsr repl [FILE]`: statements and queries, one after another."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from io import TextIOWrapper
from typing import Annotated

import typer
from prompt_toolkit import PromptSession
from rich.console import Console
from rich.text import Text

from qsrlang.cli.options import Format, OutputFormat
from qsrlang.cli.shell.inputs import group_lines
from qsrlang.cli.shell.keeping import history_path, keep_session
from qsrlang.cli.shell.prompt import make_prompt
from qsrlang.cli.shell.saving import read_knowledge
from qsrlang.cli.shell.session import Session
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.signals import Signals
from qsrlang.cli.shell.turns import take, tell_failure
from qsrlang.cli.shell.waiting import keys_wait
from qsrlang.language.diagnostics import LanguageError
from qsrlang.language.source import MAX_SOURCE_BYTES

MISUSED = 2
HANGUP = 1
MAX_FAILURES = 3

File = Annotated[
    str | None,
    typer.Argument(metavar="[FILE]", help="A shipped name such as office/desk, or a path that ends in .qsr."),
]


def repl(file: File = None, output: OutputFormat = Format.TEXT) -> None:
    """Type statements and ask queries, one after another; from a pipe, answer what it holds."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
    if all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout)):
        _talk(file, output)
    else:
        _answer_pipe(file, output)


def _answer_pipe(file: str | None, output: Format) -> None:
    """Answer what the standard input asks; answers alone go to the standard output."""
    session = Session.begin(read_knowledge(file)) if file else Session.begin()
    answers = Console(highlight=False, no_color=True)
    errors = Console(stderr=True, highlight=False, no_color=True)
    notes = errors if output is Format.JSON else answers
    shell = Shell(session, answers, notes, errors, output, file=file)
    for text in group_lines(_standard_input()):
        take(shell, text)
        if shell.has_left:
            break
    if shell.has_failed:
        raise typer.Exit(MISUSED)


def _standard_input() -> Iterator[str]:
    while sys.stdin and (line := sys.stdin.buffer.readline(MAX_SOURCE_BYTES + 1)):
        yield line.decode("utf-8", "replace")


def _talk(file: str | None, output: Format) -> None:
    """Talk with a person at a terminal, and keep what that person did not save."""
    console = Console(highlight=False)
    shell = Shell(Session.begin(), console, console, console, output, is_interactive=True, file=file)
    prompt = make_prompt(shell, history_path())
    with Signals(prompt.app) as signals, keys_wait():
        try:
            _open(shell)
            _converse(shell, prompt, signals)
        except OSError:
            signals.ended = signals.ended or HANGUP
        finally:
            signals.ignore()
            _keep(shell)
    if signals.ended:
        raise SystemExit(128 + signals.ended)


def _open(shell: Shell) -> None:
    try:
        if shell.file:
            shell.session = Session.begin(read_knowledge(shell.file))
    except LanguageError as error:
        shell.tell_findings(error.diagnostics)
        shell.tell_error(f"{shell.file} is not loaded; mend it and type :reload")
    graph = shell.session.built.graph
    known = f"{len(graph.classes)} classes, {len(graph.landmarks)} landmarks"
    shell.answers.print(
        Text.assemble((f"qsr {_version()}", "bold"), f" · {shell.session.knowledge.name}: {known}")
    )
    shell.remark("A statement ends with . and a query with ?   :help, Tab completes, Ctrl-D leaves")
    shell.tell_warnings(shell.session.built.diagnostics)


def _converse(shell: Shell, prompt: PromptSession[str], signals: Signals) -> None:
    """Take one input after another until the person leaves, or until no prompt can be shown."""
    failures = 0
    while not (shell.has_left or signals.ended) and failures < MAX_FAILURES:
        try:
            text = prompt.prompt()
            failures = 0
            with signals.answering():
                take(shell, text.encode("utf-8", "replace").decode("utf-8"))
        except KeyboardInterrupt:
            shell.errors.print("interrupted")
        except EOFError:
            if not signals.ended:
                shell.leave()
        except OSError:
            raise
        except Exception as error:
            failures += 1
            tell_failure(shell, error, "")


def _keep(shell: Shell) -> None:
    """Write what is not saved to a file of its own, or at least to the screen."""
    if not shell.session.unsaved:
        return
    path = keep_session(shell.session)
    told = f"what was not saved is kept in {path}\n" if path else shell.session.source().text
    try:
        sys.stderr.write(told)
        sys.stderr.flush()
    except OSError:
        return


def _version() -> str:
    try:
        return version("qsrlang")
    except PackageNotFoundError:
        return "(not installed)"
