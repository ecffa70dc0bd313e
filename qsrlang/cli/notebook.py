"""`%load_ext qsrlang`: knowledge in cells, questions in lines, and what comes of them as tables and pictures."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from keyword import iskeyword
from typing import Any, TypeAlias

import qsrlang as qsr
from qsrlang.cli.displays import (
    comparison_html,
    comparison_text,
    knowledge_html,
    probability_html,
    rows_html,
    story_html,
    story_text,
    summary,
    text_html,
    where_html,
)
from qsrlang.errors import QSRError, UnknownNameError, ValueRangeError

NAME = "kb"
"""The variable that holds the knowledge of a cell which names none."""

Display: TypeAlias = Callable[[Any], str]

_QUESTION = re.compile(r"^(\s*(?:\w+\s*=\s*)?%qsr\b.*?)\s*\?+\s*$")


class Notebook:
    """What the extension adds to one shell, and how it is taken away again."""

    def __init__(self, shell: Any) -> None:
        self._shell = shell
        self._name = NAME
        self._asked: tuple[qsr.Answer, qsr.KnowledgeBase] | None = None
        self._handled = shell.custom_exceptions, shell.CustomTB

    def install(self) -> None:
        """Add the magics, the displays, and the short words for mistakes."""
        self._shell.register_magic_function(self.magic, magic_kind="line_cell", magic_name="qsr")
        self._shell.input_transformers_cleanup.append(keep_question)
        self._shell.set_custom_exc((QSRError,), _tell)
        formatters = self._shell.display_formatter.formatters
        for (module, name), (plain, rich) in self._displays().items():
            formatters["text/plain"].for_type_by_name(module, name, _printing(plain))
            formatters["text/html"].for_type_by_name(module, name, rich)

    def uninstall(self) -> None:
        """Take away what was added."""
        self._shell.magics_manager.magics["line"].pop("qsr", None)
        self._shell.magics_manager.magics["cell"].pop("qsr", None)
        self._shell.input_transformers_cleanup.remove(keep_question)
        self._shell.custom_exceptions, self._shell.CustomTB = self._handled
        for kind in ("text/plain", "text/html"):
            for module, name in self._displays():
                self._shell.display_formatter.formatters[kind].pop(f"{module}.{name}", None)

    def magic(self, line: str, cell: str | None = None) -> qsr.Answer | None:
        """`%%qsr [NAME]`: knowledge, bound to NAME or else to kb. `%qsr where Cup?`: a question to it."""
        if cell is None:
            return self._ask(line)
        self._state(line.strip() or NAME, cell)
        return None

    def _state(self, name: str, cell: str) -> None:
        if not name.isidentifier() or iskeyword(name):
            raise ValueRangeError("the name after %%qsr", f"'{name}'", "a Python name")
        source = f"<{name}>"
        known = qsr.parse_knowledge(cell, source)
        self._shell.push({name: known})
        self._name = name
        for finding in known.diagnostics:
            if finding.span.source.name == source:
                print(f"{finding.render()}\n")
        print(f"{name}: {summary(known)}")

    def _ask(self, query: str) -> qsr.Answer:
        known = self._shell.user_ns.get(self._name)
        if not isinstance(known, qsr.KnowledgeBase):
            held = (
                name for name, value in self._shell.user_ns.items() if isinstance(value, qsr.KnowledgeBase)
            )
            raise UnknownNameError("knowledge", self._name, held)
        answer = known.ask(query)
        self._asked = answer, known
        return answer

    def _where_html(self, answer: qsr.Where) -> str:
        asked, known = self._asked or (None, None)
        return where_html(answer, known if asked is answer else None)

    def _displays(self) -> dict[tuple[str, str], tuple[Display, Display]]:
        """How values are shown in a terminal and in a notebook, by the module and the name of their class."""
        return {
            ("qsrlang.mixtures.queries", "KnowledgeBase"): (summary, knowledge_html),
            ("qsrlang.mixtures.answers", "Where"): (str, self._where_html),
            ("qsrlang.mixtures.probability", "Probability"): (str, probability_html),
            ("qsrlang.mixtures.explanation", "Explanation"): (str, text_html),
            ("qsrlang.relations.consistency.conflicts", "Consistency"): (str, text_html),
            ("qsrlang.mixtures.information", "LandmarkRanking"): (str, rows_html),
            ("qsrlang.mixtures.scenes", "SceneSamples"): (str, rows_html),
            ("qsrlang.experiments.stories", "SearchStory"): (story_text, story_html),
            ("qsrlang.experiments.summaries", "Comparison"): (comparison_text, comparison_html),
        }


def load_ipython_extension(ipython: Any) -> None:
    """Add to an IPython shell `%%qsr`, `%qsr`, displays of knowledge and results, and mistakes without tracebacks."""
    Notebook(ipython).install()


def unload_ipython_extension(ipython: Any) -> None:
    """Take away what `load_ipython_extension` added."""
    notebook = getattr(ipython.magics_manager.magics["line"].get("qsr"), "__self__", None)
    if isinstance(notebook, Notebook):
        notebook.uninstall()


def keep_question(lines: list[str]) -> list[str]:
    """Return a cell's lines with the question mark of `%qsr where Cup?` left out, which IPython takes for help."""
    return [_QUESTION.sub(r"\1\n", line) for line in lines]


def _printing(text: Display) -> Callable[[Any, Any, bool], None]:
    """A display as IPython's pretty printer calls it."""
    return lambda value, printer, cycle: printer.text(text(value))


def _tell(
    shell: Any, kind: type[BaseException], error: BaseException, trace: Any, tb_offset: int | None = None
) -> None:
    text = str(error)
    sys.stderr.write(f"{text}\n" if text.startswith("error[") else f"error: {text}\n")
