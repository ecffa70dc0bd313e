"""`qsr search SCENARIO`: one search, told step by step, with a picture of each step; with `--learn` one a day."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from qsrlang.cli.days import tell_days
from qsrlang.cli.narration import narrate_end, narrate_opening, narrate_step, story_json
from qsrlang.cli.options import (
    CameraName,
    Format,
    KnowledgeName,
    OutputFormat,
    RobotName,
    ScenarioName,
    Seed,
    Variant,
)
from qsrlang.errors import FileError
from qsrlang.experiments.pictures import draw_steps
from qsrlang.experiments.scenarios import load_scenario
from qsrlang.experiments.stories import Opening, open_search
from qsrlang.planning.outcome import SearchStep
from qsrlang.plotting.canvas import save_figure

RUNS = Path("runs")


def search(
    scenario: ScenarioName,
    arm: Annotated[str, typer.Option(help="The search method, one of the scenario's arms.")] = "qsr",
    target: Annotated[
        list[str] | None,
        typer.Option(help="The class sought, the scenario's by default; again for one of each of several."),
    ] = None,
    seed: Seed = 0,
    trial: Annotated[
        int, typer.Option(min=0, help="Which trial of a comparison with this seed to replay.")
    ] = 0,
    variant: Variant = None,
    camera: CameraName = None,
    knowledge: KnowledgeName = None,
    robot: RobotName = None,
    output: Annotated[
        Path | None, typer.Option(help="Folder of the pictures, under runs/ by default.")
    ] = None,
    pictures: Annotated[bool, typer.Option(help="Draw a picture of every step.")] = True,
    explain: Annotated[
        bool, typer.Option(help="Tell what the best view and the runner-up were worth and cost.")
    ] = False,
    learn: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.qsr",
            help="Search once a day while things move, and learn into this file from each search.",
        ),
    ] = None,
    days: Annotated[int, typer.Option(min=1, help="With --learn: how many days; those done are kept.")] = 7,
    form: OutputFormat = Format.TEXT,
) -> None:
    """Search for an object, or for one of each of several classes, and tell every step.

    What is believed, where it looks, why, what it saw.
    """
    loaded = load_scenario(scenario, camera, robot, knowledge)
    if learn is not None:
        if explain or trial or output is not None or len(target or ()) > 1:
            raise typer.BadParameter(
                "tells a line a day of one target, without pictures: leave out --explain, --trial, --output and a "
                "second --target",
                param_hint="--learn",
            )
        tell_days(loaded, learn, days, target[0] if target else None, arm, seed, variant, form)
        return
    opening = open_search(loaded, target, arm, variant)
    folder = (
        _folder(output or RUNS / f"search-{opening.scenario.name}-{arm}-seed-{seed}") if pictures else None
    )
    console = Console(quiet=form is Format.JSON)
    narrate_opening(console, opening, seed)
    steps: list[SearchStep] = []
    drawn: list[Path] = []

    def watch(step: SearchStep) -> None:
        steps.append(step)
        if folder is not None:
            drawn.append(_picture(opening, steps, folder))
        narrate_step(console, opening, step, drawn[-1] if drawn else None, explain)

    story = opening.search(seed, trial, watch)
    narrate_end(console, story)
    if form is Format.JSON:
        typer.echo(json.dumps(story_json(story, drawn), indent=2, ensure_ascii=False))


def _folder(path: Path) -> Path:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be made a folder: {error.strerror}", "give another --output") from None
    return path


def _picture(opening: Opening, steps: list[SearchStep], folder: Path) -> Path:
    return save_figure(draw_steps(opening, steps), folder / f"step-{len(steps):02d}.png")
