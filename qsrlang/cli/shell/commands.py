"""The colon commands of the REPL: what each is called, what it does, and the table of all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

from rich.markup import escape
from rich.table import Table

from qsrlang.cli.explain_error import page_of
from qsrlang.cli.shell import changing, looking
from qsrlang.cli.shell.shell import Shell
from qsrlang.errors import UnknownNameError
from qsrlang.language.codes import CODES


@dataclass(frozen=True, slots=True)
class Command:
    """A colon command: its name, its arguments as they are written, what it does, and the function that does it."""

    name: str
    arguments: str
    summary: str
    run: Callable[[Shell, str], None]

    @property
    def usage(self) -> str:
        """How it is written."""
        return f":{self.name} {self.arguments}".rstrip()


def run_command(shell: Shell, text: str) -> None:
    """Do what a command says; raises QSRError."""
    word, _, argument = text.strip().removeprefix(":").partition(" ")
    find_command(word).run(shell, argument.strip())


def find_command(word: str) -> Command:
    """Return the command of a name, or the only one whose name begins so; raises UnknownNameError."""
    if word in COMMANDS:
        return COMMANDS[word]
    begun, force = word.rstrip("!"), word.endswith("!")
    meant = [name for name in COMMANDS if begun and name.startswith(begun) and name.endswith("!") == force]
    if len(meant) != 1:
        raise UnknownNameError("command", f":{word}", [f":{name}" for name in COMMANDS])
    return COMMANDS[meant[0]]


def show_help(shell: Shell, argument: str) -> None:
    """Show what the commands do, one of them, or what a code means."""
    if argument.upper() in CODES:
        shell.note(page_of(argument.upper()).rstrip())
    elif argument:
        command = find_command(argument.removeprefix(":"))
        shell.note(f"{command.usage}\n    {command.summary}")
    else:
        shell.note("A statement ends with '.', a query with '?'; both may go over several lines.")
        shell.note("    dynamic Mug.    observe 3 × right-of(Mug, Keyboard).    where Mug?")
        shell.note("    explain Mug?   landmarks Mug?   sample 9?   prob close-to(Mug, Keyboard)?")
        shell.notes.print(_table())


def quit_asking(shell: Shell, argument: str) -> None:
    """Leave, or ask once where something is not saved."""
    shell.leave()


def quit_now(shell: Shell, argument: str) -> None:
    """Leave."""
    shell.has_left = True


def _table() -> Table:
    table = Table.grid(padding=(0, 2))
    for command in COMMANDS.values():
        table.add_row(escape(command.usage), escape(command.summary))
    return table


_LISTED = (
    Command("load", "FILE", "begin anew with a file, office/desk for instance", changing.load_file),
    Command("reload", "", "read the file again, and keep what was stated", changing.reload),
    Command("clear", "", "forget what was stated, and keep the file", changing.clear),
    Command("undo", "[N]", "take back the last change, or the last N", changing.undo),
    Command("redo", "[N]", "do again what was taken back", changing.redo),
    Command("list", "", "what was stated, with its lines; * is in no file", looking.list_stated),
    Command("save", "[FILE.qsr]", "write all that is known to a new file", changing.save_new),
    Command("save!", "[FILE.qsr]", "write it in the place of what the file holds", changing.save_over),
    Command("world", "[PARTS]", "room NAME, weekday, at HH:MM, viewer (x m, y m); none", looking.show_world),
    Command("map", "[SCENARIO]", "whose map 'views' is about, kitchen for instance", looking.show_map),
    Command("graph", "[NAME]", "what relates the objects, with shares and lines", looking.show_graph),
    Command("plot", "[QUERY] [FILE.png]", "draw an answer to 'where', the last by default", looking.plot),
    Command("time", "[QUERY]", "how long a query takes", looking.time_query),
    Command("lint", "", "all findings in what is known, as 'check?'", looking.show_findings),
    Command("help", "[COMMAND]", "this list, a command, or a code such as Q203", show_help),
    Command("quit", "", "leave, as Ctrl-D; asks once if something is not saved", quit_asking),
    Command("quit!", "", "leave; what is not saved is kept all the same", quit_now),
    Command("exit", "", "as :quit", quit_asking),
)
COMMANDS = MappingProxyType({command.name: command for command in _LISTED})
