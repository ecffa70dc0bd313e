"""`qsr ask FILE QUERY`: an answer as a table or as JSON."""

from __future__ import annotations

import json
import math
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

import qsrlang as qsr
from qsrlang.cli.options import Format, KnowledgeFile, Landmarks, OutputFormat, Query, Viewer


def ask(
    file: KnowledgeFile,
    query: Query,
    landmark: Landmarks = None,
    viewer: Viewer = None,
    engine: Annotated[str, typer.Option(help="exact (moments), or sampling as in the paper.")] = "exact",
    samples: Annotated[int, typer.Option(min=2, help="Draws of the sampling engine.")] = 10_000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the sampling engine.")] = 0,
    output: OutputFormat = Format.TEXT,
) -> None:
    """Ask what a .qsr file says, such as 'where Cup?'."""
    known = qsr.load(file).with_landmarks(*(landmark or ()))
    answer = known.ask(query, viewer=viewer_pose(viewer), engine=engine, samples=samples, seed=seed)
    if output is Format.JSON:
        typer.echo(json.dumps(answer.to_json(), ensure_ascii=False, indent=2))
    else:
        print_answer(answer, Console())


def viewer_pose(text: str | None) -> qsr.Pose2 | None:
    """Return the viewer's place from text such as '1.2 m, 0.5 m'."""
    if text is None:
        return None
    return qsr.Pose2(*qsr.parse_place(text))


def print_answer(answer: qsr.Where, console: Console) -> None:
    """Print an answer as a table: weight, mean, ellipse, and the numbers of the statements behind each component."""
    statements = list(dict.fromkeys(one for component in answer.components for one in component.statements))
    table = Table(title=f"where {answer.target}", title_justify="left")
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
