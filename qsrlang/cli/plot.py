"""`qsr plot FILE QUERY -o PICTURE`: an answer as a picture (Fig. 4 of the paper)."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import qsrlang as qsr
from qsrlang.cli.ask import viewer_pose
from qsrlang.cli.options import KnowledgeFile, Landmarks, Query, Viewer


def plot(
    file: KnowledgeFile,
    query: Query,
    picture: Annotated[Path, typer.Option("--output", "-o", help="A .png, .svg or .pdf file.")],
    landmark: Landmarks = None,
    viewer: Viewer = None,
) -> None:
    """Draw what a .qsr file says, such as 'where Cup wrt Keyboard?'."""
    known = qsr.load(file).with_landmarks(*(landmark or ()))
    answer = known.ask(query, viewer=viewer_pose(viewer))
    if not isinstance(answer, qsr.Where):
        raise qsr.ValueRangeError("the query to draw", query, "a 'where', such as 'where Cup wrt Keyboard?'")
    written = qsr.save_figure(qsr.draw_answer(answer, known), picture)
    typer.echo(
        f"{written}: where {answer.target}, {len(answer.components)} components, frame: {answer.frame}"
    )
