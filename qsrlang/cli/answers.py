"""Answers as tables."""

from __future__ import annotations

import math

from rich.console import Console
from rich.markup import escape
from rich.table import Table

import qsrlang as qsr


def print_answer(answer: qsr.Answer, console: Console, title: str) -> None:
    """Print an answer as a table: of `where`, with the numbers of the statements behind each component."""
    if isinstance(answer, qsr.Probability):
        console.print(title, markup=False, highlight=False, soft_wrap=True)
        console.print(probability_table(answer))
    else:
        _print_where(answer, console, title)
    if answer.assumed:
        assumed = f"assumed: {'; '.join(answer.assumed)} (as good as {answer.draws:.0f} independent draws)"
        console.print(assumed, highlight=False, markup=False, soft_wrap=True)


def title_of(query: str) -> str:
    """Return a query as the title of its answer: on one line, without its question mark."""
    return " ".join(query.split()).removesuffix("?").rstrip()


def probability_table(answer: qsr.Probability) -> Table:
    """Return a probability with its standard error as a table."""
    table = Table()
    for heading in ("probability", "standard error"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_row(f"{answer.value:.4f}", f"{answer.standard_error:.4f}")
    return table


def _print_where(answer: qsr.Where, console: Console, title: str) -> None:
    console.print(answer_table(answer, title))
    for number, statement in enumerate(reasons(answer), start=1):
        console.print(f"{number:3d}  {escape(statement)}", highlight=False, soft_wrap=True)
    console.print(frame_line(answer), highlight=False, soft_wrap=True)


def answer_table(answer: qsr.Where, title: str) -> Table:
    """Return an answer as a table; its last column names statements by their numbers in `reasons`."""
    statements = reasons(answer)
    table = Table(title=escape(title), title_justify="left")
    for heading in ("weight", "x [m]", "y [m]", "sd [m]", "axis [deg]", "because of"):
        table.add_column(escape(heading), justify="right", no_wrap=True)
    for component in answer.components:
        (x, y), (major, minor, angle) = component.mean, component.ellipse
        numbers = " ".join(str(statements.index(one) + 1) for one in component.statements)
        table.add_row(
            f"{component.weight:.3f}",
            _metres(x),
            _metres(y),
            f"{major:.3f} × {minor:.3f}",
            f"{math.degrees(angle):.0f}",
            numbers or "its own landmark",
        )
    return table


def reasons(answer: qsr.Where) -> list[str]:
    """Return the statements behind an answer, each once."""
    return list(dict.fromkeys(one for component in answer.components for one in component.statements))


def frame_line(answer: qsr.Where) -> str:
    """Return the frame of an answer, and what is left to places that no statement names."""
    if answer.frame == "map":
        frame = "frame: map"
    else:
        frame = f"frame: {answer.frame} at the origin, x away from the viewer, y to its left (no landmark is used)"
    rest = f"; elsewhere: {answer.elsewhere:.3f}" if answer.elsewhere > 0.0 else ""
    return f"{frame}{rest}"


def _metres(value: float) -> str:
    """Return a coordinate to the millimetre; what rounds to zero has no sign."""
    return f"{round(value, 3) + 0.0:.3f}"
