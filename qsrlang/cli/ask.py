"""`qsr ask FILE QUERY`: an answer as a table or as JSON."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich.console import Console

import qsrlang as qsr
from qsrlang.cli.answers import print_answer, title_of
from qsrlang.cli.options import Format, KnowledgeFile, Landmarks, OutputFormat, Query, Viewer


def ask(
    file: KnowledgeFile,
    query: Query,
    landmark: Landmarks = None,
    viewer: Viewer = None,
    engine: Annotated[str, typer.Option(help="exact (moments), or sampling as in the paper.")] = "exact",
    samples: Annotated[
        int, typer.Option(min=2, help="Draws of the sampling engine, of 'prob', and under assumptions.")
    ] = 10_000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all draws.")] = 0,
    scenario: Annotated[
        str | None, typer.Option(help="For 'views': a scenario whose map, camera and robot they are of.")
    ] = None,
    output: OutputFormat = Format.TEXT,
) -> None:
    """Ask what a .qsr file says: 'where Cup?', 'explain Cup?', 'landmarks Cup?', 'sample 100?', 'check?', 'prob …?'."""
    known = qsr.load(file).with_landmarks(*(landmark or ()))
    seen_from = viewer_pose(viewer)
    answer: qsr.Answer | qsr.RankedViews
    if scenario is not None:
        answer = qsr.ask_views(known, query, scenario, viewer=seen_from, seed=seed)
    else:
        answer = known.ask(query, viewer=seen_from, engine=engine, samples=samples, seed=seed)
    if output is Format.JSON:
        typer.echo(json.dumps(answer.to_json(), ensure_ascii=False, indent=2))
    else:
        print_answer(answer, Console(), title_of(query))


def viewer_pose(text: str | None) -> qsr.Pose2 | None:
    """Return the viewer's place from text such as '1.2 m, 0.5 m'."""
    if text is None:
        return None
    return qsr.Pose2(*qsr.parse_place(text))
