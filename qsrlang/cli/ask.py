"""`qsr ask FILE QUERY`: an answer as a table or as JSON."""

from __future__ import annotations

import json
import math

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from qsrlang.cli.options import Format, KnowledgeFile, Landmarks, OutputFormat, Query, Viewer
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.parser import parse_place
from qsrlang.mixtures.answers import Where
from qsrlang.mixtures.queries import ENGINES, load


def ask(
    file: KnowledgeFile,
    query: Query,
    landmark: Landmarks = None,
    viewer: Viewer = None,
    engine: str = typer.Option(ENGINES[0], help="exact moments, or the paper's sampling."),
    samples: int = typer.Option(10_000, help="Draws of the sampling engine."),
    seed: int = typer.Option(0, help="Seed of the sampling engine."),
    output: OutputFormat = Format.TEXT,
) -> None:
    """Ask what a .qsr file says, such as 'where Cup?'."""
    known = load(file).with_landmarks(*(landmark or ()))
    rng = np.random.default_rng(_non_negative(seed)) if engine == "sampling" else None
    answer = known.ask(query, viewer=viewer_pose(viewer), engine=engine, samples=samples, rng=rng)
    if output is Format.JSON:
        typer.echo(json.dumps(answer.to_json(), ensure_ascii=False, indent=2))
    else:
        print_answer(answer, Console())


def viewer_pose(text: str | None) -> Pose2 | None:
    """Return the viewer's place from text such as '1.2 m, 0.5 m'."""
    if text is None:
        return None
    x, y = parse_place(text)
    return Pose2(x, y)


def print_answer(answer: Where, console: Console) -> None:
    """Print an answer as a table: weight, mean, ellipse and the statements behind each component."""
    table = Table(title=f"where {answer.target}", title_justify="left")
    for heading in ("weight", "x [m]", "y [m]", "sd [m]", "axis [deg]"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("because of")
    for component in answer.components:
        (x, y), (major, minor, angle) = component.mean, component.ellipse
        table.add_row(
            f"{component.weight:.3f}",
            f"{x:.3f}",
            f"{y:.3f}",
            f"{major:.3f} × {minor:.3f}",
            f"{math.degrees(angle):.0f}",
            "\n".join(component.statements) or "its own landmark",
        )
    console.print(table)
    console.print(_frame_line(answer), highlight=False)


def _frame_line(answer: Where) -> str:
    if answer.frame == "map":
        frame = "frame: map"
    else:
        frame = f"frame: {answer.frame} at the origin, x away from the viewer, y to its left (no landmark is used)"
    rest = f"; elsewhere: {answer.elsewhere:.3f}" if answer.elsewhere > 0.0 else ""
    return f"{frame}{rest}"


def _non_negative(seed: int) -> int:
    if seed < 0:
        raise ValueRangeError("a seed", seed, "a whole number of at least 0")
    return seed
