"""`qsr learn OBSERVATIONS --into FILE.qsr`: what was observed, as knowledge that can be read and edited."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from qsrlang.errors import FileError, UnknownNameError
from qsrlang.learning.experience import experience_of
from qsrlang.learning.merging import Lesson, learn_into
from qsrlang.learning.reading import read_observations
from qsrlang.learning.screening import Reading
from qsrlang.learning.selection import MIN_SEEN
from qsrlang.learning.writing import Contexts

CONTEXTS = ("room", "time")

Paths = Annotated[
    list[Path],
    typer.Argument(
        metavar="OBSERVATIONS...",
        help="CSV, JSON Lines, Parquet, a store (.sqlite), the KTH desk table or its XML, or the iTHOR table.",
    ),
]
Into = Annotated[
    Path, typer.Option(metavar="FILE.qsr", help="Where to write; what people wrote there stays.")
]
By = Annotated[str, typer.Option(help="Contexts to tell apart, with commas: room, time.")]
Aside = Annotated[Path | None, typer.Option(help="Write the rows that were set aside here, as JSON Lines.")]
Sums = Annotated[
    bool, typer.Option("--sums/--no-sums", help="Keep the sums beside the file, so that it can learn on.")
]


def learn(paths: Paths, into: Into, by: By = "", aside: Aside = None, sums: Sums = True) -> None:
    """Learn where things are from observations, and write it as .qsr: counts, metric fits, and where from."""
    if into.suffix != ".qsr":
        raise FileError(into, "does not end in .qsr", "name a file such as office.qsr")
    contexts = _contexts(by)
    reading = read_observations(*paths)
    typer.echo(reading.report())
    if aside is not None:
        reading.write_aside(aside)
    _tell_aside(reading, aside)
    _tell(learn_into(into, experience_of(reading.observations), contexts, sums))


def _contexts(by: str) -> Contexts:
    names = [name.strip() for name in by.split(",") if name.strip()]
    for name in names:
        if name not in CONTEXTS:
            raise UnknownNameError("context", name, CONTEXTS)
    return Contexts(room="room" in names, time="time" in names)


def _tell_aside(reading: Reading, aside: Path | None) -> None:
    for one in reading.aside[:3] if aside is None else ():
        typer.echo(f"  {one.where}: a row {one.reason}", err=True)


def _tell(lesson: Lesson) -> None:
    places = len(lesson.experience.placements.places())
    counts = lesson.text.count("\nobserve ") + lesson.text.count("\n    observe ")
    beliefs = lesson.text.count("\nbelieve ")
    total = sum(lesson.experience.sources.values())
    said = f"{counts} counts and {beliefs} beliefs in it now"
    typer.echo(f"{lesson.path}: {said}, learned from {total} sightings at {places} places")
    if counts + beliefs == 0:
        typer.echo(f"too little yet: a pair is told once it was seen {MIN_SEEN} times and tells something")
