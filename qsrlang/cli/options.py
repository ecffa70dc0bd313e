"""Arguments that several verbs share."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer


class Format(StrEnum):
    """How an answer is printed."""

    TEXT = "text"
    JSON = "json"


KnowledgeFile = Annotated[
    str,
    typer.Argument(metavar="FILE", help="A shipped name such as office/desk, or a path that ends in .qsr."),
]
Query = Annotated[str, typer.Argument(metavar="QUERY", help="For instance: where Cup wrt Keyboard?")]
Landmarks = Annotated[
    list[str] | None,
    typer.Option(
        "--landmark", help="A further landmark: 'monitor-1 : Monitor at (0 m, 0 m) facing -90 deg'."
    ),
]
Viewer = Annotated[
    str | None,
    typer.Option(help="Where the viewer stands: '1.2 m, 0.5 m'; without it, before the landmark's front."),
]
OutputFormat = Annotated[Format, typer.Option("--format", help="How the answer is printed.")]
ScenarioName = Annotated[
    str, typer.Argument(metavar="SCENARIO", help="A shipped name, or a path that ends in .toml.")
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all random numbers; the arms share them.")]
Variant = Annotated[str | None, typer.Option(help="Which objects are there; the first variant by default.")]
CameraName = Annotated[str | None, typer.Option(help="A camera preset in place of the scenario's.")]
RobotName = Annotated[str | None, typer.Option(help="A robot preset in place of the scenario's.")]
KnowledgeName = Annotated[str | None, typer.Option(help="A .qsr file in place of the scenario's.")]
