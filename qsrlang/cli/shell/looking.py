"""The colon commands that show what is known, and the world it is asked in."""

from __future__ import annotations

import os
import re
import time
from dataclasses import replace
from pathlib import Path

import qsrlang as qsr
from qsrlang.cli.shell.listings import class_table, graph_table, landmark_table
from qsrlang.cli.shell.saving import typed_path
from qsrlang.cli.shell.shell import Shell
from qsrlang.cli.shell.world import describe, enter, rooms_of
from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.language.parser import parse_query

_PICTURES = (".png", ".svg", ".pdf")


def show_world(shell: Shell, argument: str) -> None:
    """Show the world that queries are asked in, or change it."""
    shell.session = enter(shell.session, argument)
    graph, rooms = shell.session.known.graph, rooms_of(shell.session.built)
    shell.note(describe(shell.session) or "no room, no time, and no viewer")
    if argument:
        here = shell.session.circumstances.room
        if here is not None and here not in rooms:
            shell.note(f"no context speaks of room {here}; rooms: {', '.join(rooms) or 'none'}")
        return
    if rooms:
        shell.note(f"rooms that contexts speak of: {', '.join(rooms)}")
    shell.notes.print(landmark_table(graph) if graph.landmarks else "no landmarks")
    shell.notes.print(class_table(graph) if graph.classes else "no classes")


def show_map(shell: Shell, argument: str) -> None:
    """Show the scenario whose map `views` is about, or take another."""
    if argument:
        qsr.load_scenario(argument)
        shell.session = replace(shell.session, scenario=argument)
    shell.note(shell.session.scenario or "no map; name a scenario, as in ':map kitchen'")


def plot(shell: Shell, argument: str) -> None:
    """Draw an answer to a file."""
    asked, file = _query_and_file(argument)
    query = asked or _last_query(shell)
    answer = shell.session.ask(query)
    if not isinstance(answer, qsr.Where):
        raise ValueRangeError("the query to draw", query, "a 'where', such as 'where Cup wrt Keyboard?'")
    shell.last_query = query
    path = Path(typed_path(file)) if file else _free_name(query)
    written = qsr.save_figure(qsr.draw_answer(answer, shell.session.known), path)
    shell.note(str(written))


def _query_and_file(argument: str) -> tuple[str, str]:
    query, mark, file = argument.rpartition("?")
    if mark:
        return query + mark, file.strip()
    words = argument.split()
    if words and words[-1].endswith(_PICTURES):
        return " ".join(words[:-1]), words[-1]
    return argument, ""


def _last_query(shell: Shell) -> str:
    if shell.last_query is None:
        raise ValueRangeError("the query", "missing", "one such as 'where Cup?', here or before")
    return shell.last_query


def _free_name(query: str) -> Path:
    stem = re.sub(r"[^\w-]+", "-", query).strip("-")[:60]
    names = (Path(f"{stem}{number}.png") for number in ("", *(f"-{count}" for count in range(2, 10_000))))
    return next(name for name in names if not os.path.lexists(name))


def show_graph(shell: Shell, argument: str) -> None:
    """Show what relates the objects."""
    graph = shell.session.known.graph
    objects = {name for choice in graph.choices for pair in choice.governs for name in pair}
    if argument and argument not in objects:
        raise UnknownNameError("object", argument, objects)
    is_empty = not graph.choices and not graph.requirements
    shell.notes.print("no relations" if is_empty else graph_table(graph, argument or None))


def time_query(shell: Shell, argument: str) -> None:
    """Tell how long a query takes."""
    query = argument or _last_query(shell)
    started = time.perf_counter()
    parse_query(query)
    parsed = time.perf_counter()
    shell.session.ask(query)
    answered = time.perf_counter()
    parts = f"parsed in {1e3 * (parsed - started):.2f} ms, answered in {1e3 * (answered - parsed):.2f} ms"
    shell.note(parts)


def list_stated(shell: Shell, argument: str) -> None:
    """Show what was stated."""
    knowledge = shell.session.knowledge
    saved = shell.session.saved
    width = len(str(knowledge.source.text.count("\n")))
    for line, one in knowledge.numbered():
        mark = " " if one.number in saved else "*"
        for offset, text in enumerate(one.text.split("\n")):
            shell.note(f"{line + offset:{width}d} {mark} {text}")
    shell.remark(
        f"beside {knowledge.name}" if knowledge.stated else f"nothing was stated beside {knowledge.name}"
    )


def show_findings(shell: Shell, argument: str) -> None:
    """Show all findings."""
    shell.tell_check(shell.findings())
