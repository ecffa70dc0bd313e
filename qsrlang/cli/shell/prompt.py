"""The line that is typed into: colours, completion, history and keys."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from prompt_toolkit import PromptSession
from prompt_toolkit.application import get_app, run_in_terminal
from prompt_toolkit.filters import Condition
from prompt_toolkit.history import History
from prompt_toolkit.input import Input
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.lexers import DynamicLexer, Lexer, PygmentsLexer, SimpleLexer
from prompt_toolkit.output import Output
from prompt_toolkit.styles import Style, merge_styles, style_from_pygments_dict
from pygments.token import Comment, Keyword, Name, Number, Operator, String

from qsrlang.cli.shell.completing import ShellCompleter
from qsrlang.cli.shell.inputs import is_command, is_complete
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.waiting import step_aside
from qsrlang.cli.shell.world import describe
from qsrlang.editor.highlighting import QSRLexer

PROMPT, CONTINUATION = "qsr> ", "...> "
MAX_HISTORY_BYTES = 1024 * 1024

_COLOURS = {
    Comment: "ansibrightblack",
    String: "ansigreen",
    String.Doc: "ansigreen italic",
    Number: "ansicyan",
    Keyword: "ansiblue",
    Keyword.Declaration: "ansimagenta bold",
    Keyword.Type: "ansicyan",
    Operator: "ansired",
    Name.Attribute: "ansiblue",
    Name.Builtin: "ansiyellow",
    Name.Function: "ansiyellow",
    Name.Class: "ansigreen",
    Name.Variable: "ansibrightblue",
    Name.Label: "ansibrightblue italic",
    Name.Entity: "ansiyellow",
}
_CHROME = {
    "prompt": "ansicyan bold",
    "continuation": "ansicyan",
    "command": "ansimagenta",
    "bottom-toolbar": "noreverse ansibrightblack",
}


class KeptHistory(History):
    """What was typed, in a file; without one that can be read and written, for this session only."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path

    def load_history_strings(self) -> Iterable[str]:
        """Return what was typed before, the latest first, as far as MAX_HISTORY_BYTES reach."""
        try:
            with self._path.open("rb") as file:
                size = file.seek(0, 2)
                file.seek(max(0, size - MAX_HISTORY_BYTES))
                text = file.read().decode("utf-8", "replace")
        except (OSError, ValueError):
            return []
        entries = text.split("\n\n")
        found = ["\n".join(line[1:] for line in entry.split("\n") if line[:1] == "+") for entry in entries]
        return [entry for entry in reversed(found) if entry]

    def store_string(self, string: str) -> None:
        """Add what was typed: each line after a plus, an empty line after the last."""
        lines = "".join(f"+{line}\n" for line in string.split("\n"))
        try:
            self._path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._path.touch(mode=0o600)
            with self._path.open("a", encoding="utf-8", errors="replace", newline="\n") as file:
                file.write(f"{lines}\n")
        except (OSError, ValueError):
            return


def make_prompt(
    shell: Shell, history: Path, keyboard: Input | None = None, screen: Output | None = None
) -> PromptSession[str]:
    """Return the prompt of a shell; `keyboard` and `screen` stand for those of the terminal."""
    return PromptSession(
        PROMPT,
        multiline=Condition(lambda: not is_complete(get_app().current_buffer.text)),
        prompt_continuation=[("class:continuation", CONTINUATION)],
        lexer=DynamicLexer(_lexer),
        style=merge_styles([style_from_pygments_dict(_COLOURS), Style.from_dict(_CHROME)]),
        include_default_pygments_style=False,
        history=KeptHistory(history),
        completer=ShellCompleter(shell),
        complete_while_typing=False,
        key_bindings=_keys(),
        bottom_toolbar=lambda: _toolbar(shell),
        enable_open_in_editor=True,
        tempfile_suffix=".qsr",
        input=keyboard,
        output=screen,
    )


def _lexer() -> Lexer:
    is_colon = is_command(get_app().current_buffer.text)
    return SimpleLexer("class:command") if is_colon else PygmentsLexer(QSRLexer)


def _toolbar(shell: Shell) -> str:
    unsaved = f"{shell.unsaved} not saved" if shell.unsaved else ""
    parts = [shell.session.knowledge.name, unsaved, describe(shell.session)]
    if not is_complete(get_app().current_buffer.text):
        parts.append("a statement ends with . and a query with ?")
    return " · ".join(filter(None, parts))


def _keys() -> KeyBindings:
    keys = KeyBindings()

    @keys.add("c-c")
    @keys.add("<sigint>")
    def _(event: KeyPressEvent) -> None:
        """Clear the input; the arrow keys bring it back."""
        event.current_buffer.reset(append_to_history=True)

    @keys.add("escape", "enter")
    def _(event: KeyPressEvent) -> None:
        """Begin a new line."""
        event.current_buffer.newline()

    @keys.add("c-z")
    def _(event: KeyPressEvent) -> None:
        """Let the shell around have the terminal, until `fg`."""
        run_in_terminal(step_aside)

    return keys
