"""What Tab offers: commands and what follows them, and what the language accepts at the cursor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from prompt_toolkit.completion import CompleteEvent, Completer, Completion, PathCompleter
from prompt_toolkit.document import Document

from qsrlang.cli.shell.commands import COMMANDS
from qsrlang.cli.shell.inputs import is_command, is_question, last_passage
from qsrlang.cli.shell.keeping import log_failure
from qsrlang.cli.shell.saving import ENDING
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.world import rooms_of
from qsrlang.editor.completion import complete
from qsrlang.relations.imports import shipped_knowledge

_PATHS = PathCompleter(file_filter=lambda name: Path(name).is_dir() or name.endswith(ENDING), expanduser=True)
_WORLD = ("room", "weekday", "weekend", "at", "viewer", "none")


class ShellCompleter(Completer):
    """Completes what is typed by what the shell knows at that moment."""

    def __init__(self, shell: Shell) -> None:
        self._shell = shell

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        """Return what may stand at the cursor; nothing where that cannot be told."""
        try:
            return list(self._offers(document.text_before_cursor, complete_event))
        except Exception as error:
            log_failure(error, document.text)
            return []

    def _offers(self, text: str, event: CompleteEvent) -> Iterator[Completion]:
        if not is_command(text):
            yield from self._words(text[last_passage(text) :])
            return
        word, space, argument = text.lstrip().removeprefix(":").partition(" ")
        if space:
            yield from self._arguments(word, argument, event)
        else:
            yield from _among(COMMANDS, word, {one.name: one.summary for one in COMMANDS.values()})

    def _arguments(self, word: str, argument: str, event: CompleteEvent) -> Iterator[Completion]:
        last = argument.rpartition(" ")[2]
        match word:
            case "load" | "save" | "save!":
                if word == "load":
                    yield from _among(shipped_knowledge(), argument)
                yield from _PATHS.get_completions(Document(argument), event)
            case "plot" | "time":
                yield from self._words(argument, query=True)
            case "world":
                yield from _among((*_WORLD, *rooms_of(self._shell.session.built)), last)
            case "graph":
                yield from _among(self._shell.session.built.graph.classes, last)
            case "help":
                yield from _among(COMMANDS, last)

    def _words(self, text: str, query: bool = False) -> Iterator[Completion]:
        """Offer what may follow a statement or a query that has begun; at its first word, either."""
        is_begun = len(text.split(maxsplit=1)) > 1 or text.endswith((" ", "\n"))
        kinds = (query or is_question(text),) if query or (is_begun and text.strip()) else (True, False)
        for kind in kinds:
            for one in complete(text, len(text), self._shell.session.built, query=kind):
                yield Completion(one.text, one.start - len(text), display_meta=one.detail)


def _among(words: Iterable[str], typed: str, details: dict[str, str] | None = None) -> Iterator[Completion]:
    for word in words:
        if word.startswith(typed):
            yield Completion(word, -len(typed), display_meta=(details or {}).get(word, ""))
