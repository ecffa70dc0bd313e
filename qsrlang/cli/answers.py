"""Answers as tables."""

from __future__ import annotations

import math

from rich.console import Console
from rich.markup import escape
from rich.table import Table

import qsrlang as qsr


def print_answer(answer: qsr.Where, console: Console, title: str) -> None:
    """Print an answer as a table: weight, mean, ellipse, and the numbers of the statements behind each component."""
    statements = list(dict.fromkeys(one for component in answer.components for one in component.statements))
    table = Table(title=escape(title), title_justify="left")
    for heading in ("weight", "x [m]", "y [m]", "sd [m]", "axis [deg]", "because of"):
        table.add_column(escape(heading), justify="right", no_wrap=True)
    for component in answer.components:
        (x, y), (major, minor, angle) = component.mean, component.ellipse
        reasons = " ".join(str(statements.index(one) + 1) for one in component.statements)
        table.add_row(
            f"{component.weight:.3f}",
            f"{x:.3f}",
            f"{y:.3f}",
            f"{major:.3f} × {minor:.3f}",
            f"{math.degrees(angle):.0f}",
            reasons or "its own landmark",
        )
    console.print(table)
    for number, statement in enumerate(statements, start=1):
        console.print(f"{number:3d}  {escape(statement)}", highlight=False, soft_wrap=True)
    console.print(_frame_line(answer), highlight=False, soft_wrap=True)


def _frame_line(answer: qsr.Where) -> str:
    if answer.frame == "map":
        frame = "frame: map"
    else:
        frame = f"frame: {answer.frame} at the origin, x away from the viewer, y to its left (no landmark is used)"
    rest = f"; elsewhere: {answer.elsewhere:.3f}" if answer.elsewhere > 0.0 else ""
    return f"{frame}{rest}"
