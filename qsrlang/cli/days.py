"""`qsr search SCENARIO --learn FILE.qsr`: a search a day, one line for each, and what was learned."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import typer

from qsrlang.cli.options import Format
from qsrlang.experiments.days import Day, search_and_learn
from qsrlang.experiments.scenarios import Scenario

HEADING = f"{'day':>4s}  {'there':8s} {'knowledge':10s} {'found':5s} {'seconds':>8s} {'looks':>6s} {'seen':>5s}  change"


def tell_days(
    scenario: Scenario,
    file: Path,
    days: int,
    target: str | None,
    arm: str,
    seed: int,
    variant: str | None,
    form: Format,
) -> None:
    """Search and learn day after day, and tell each day as soon as it is over."""
    told = form is Format.TEXT
    if told:
        typer.echo(HEADING)
    watch = _tell if told else None
    done = search_and_learn(scenario, file, days, target, arm, seed, variant, watch)
    if not told:
        typer.echo(json.dumps([asdict(day) for day in done], ensure_ascii=False, indent=2))
        return
    kept = days - len(done)
    again = f"; days up to {kept} were done before, as {file.with_suffix('.sqlite')} tells" if kept else ""
    typer.echo(f"{file}: learned from what searches saw, up to day {days}{again}")


def _tell(day: Day) -> None:
    used, found = ("learned" if day.told else "scenario"), ("yes" if day.found else "no")
    figures = f"{found:5s} {day.seconds:8.1f} {day.poses:6d} {day.sightings:5d}"
    typer.echo(f"{day.number:4d}  {day.variant:8s} {used:10s} {figures}  {day.change}")
