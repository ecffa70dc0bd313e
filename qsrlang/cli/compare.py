"""`qsr compare SCENARIO`: arms times trials over processes, a table with intervals, and a CSV of every trial."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from qsrlang.cli.options import CameraName, KnowledgeName, RobotName, ScenarioName, Seed, Variant
from qsrlang.experiments import comparing
from qsrlang.experiments.recording import Experiment, read_trials
from qsrlang.experiments.scenarios import load_scenario
from qsrlang.experiments.summaries import Comparison
from qsrlang.experiments.tables import comparison_json, comparison_table
from qsrlang.planning.noise import Noise

INTERRUPTED = 130
RUNS = Path("runs")
MIN_WIDTH = 100


class TableFormat(StrEnum):
    """How a comparison is printed."""

    TABLE = "table"
    JSON = "json"


def compare(
    scenario: ScenarioName,
    arms: Annotated[
        str | None, typer.Option(help="Names of arms, with commas; all of them by default.")
    ] = None,
    trials: Annotated[int, typer.Option(min=1, help="Trials of each arm.")] = 200,
    seed: Seed = 0,
    variant: Variant = None,
    processes: Annotated[
        int | None, typer.Option(min=1, help="Processes; one for each core by default.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option(help="The per-trial CSV, under runs/ by default; resumed from.")
    ] = None,
    camera: CameraName = None,
    knowledge: KnowledgeName = None,
    robot: RobotName = None,
    detection_rate: Annotated[
        float, typer.Option(help="The share of things in view that the camera shows.")
    ] = 1.0,
    false_alarms: Annotated[
        float, typer.Option(help="The share of looks that report the target where it is not.")
    ] = 0.0,
    form: Annotated[
        TableFormat, typer.Option("--format", help="How the result is printed.")
    ] = TableFormat.TABLE,
) -> None:
    """Compare search methods over many trials that share their random numbers."""
    loaded = load_scenario(scenario, camera, robot, knowledge, Noise(detection_rate, false_alarms))
    names = None if arms is None else [name.strip() for name in arms.split(",") if name.strip()]
    made = comparing.experiment_of(loaded, seed, variant)
    path = output or _default_output(made, loaded.noise)
    told = Console(stderr=True)
    with _progress(told) as progress, _kept_when_interrupted(told, path, made):
        cores = processes or os.cpu_count() or 1
        result = comparing.compare(loaded, names, trials, seed, variant, cores, path, progress)
    told.print(f"every trial: {path}", highlight=False, soft_wrap=True, markup=False)
    _print(result, form)


def _default_output(made: Experiment, noise: Noise) -> Path:
    erring = "" if noise.is_none else f"-{noise.detection_rate:g}-{noise.false_alarms:g}"
    return RUNS / f"{made.scenario}-{made.variant}-{made.camera}-{made.robot}{erring}-seed-{made.seed}.csv"


@contextmanager
def _progress(told: Console) -> Iterator[comparing.Progress]:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=told, disable=not told.is_terminal, transient=True) as bar:
        task = bar.add_task("trials", total=None)

        def show(done: int, wanted: int) -> None:
            bar.update(task, completed=done, total=wanted)

        yield show


@contextmanager
def _kept_when_interrupted(told: Console, path: Path, made: Experiment) -> Iterator[None]:
    try:
        yield
    except KeyboardInterrupt:
        kept = len(read_trials(path, made)) if path.is_file() else 0
        text = f"interrupted: {kept} finished trials are kept in {path}; the same command goes on from there"
        told.print(text, highlight=False, soft_wrap=True, markup=False)
        raise typer.Exit(INTERRUPTED) from None


def _print(result: Comparison, form: TableFormat) -> None:
    if form is TableFormat.JSON:
        typer.echo(json.dumps(comparison_json(result), indent=2))
        return
    console = Console()
    console = console if console.is_terminal else Console(width=MIN_WIDTH)
    console.print(comparison_table(result))
