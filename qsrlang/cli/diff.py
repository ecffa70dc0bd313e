"""`qsr diff OLD NEW`: what changed between two files of knowledge, in words and in bits."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from qsrlang.cli.options import Format, OutputFormat
from qsrlang.learning.differences import Change, differences
from qsrlang.mixtures.loading import load

MIN_WIDTH = 100

Old = Annotated[
    str, typer.Argument(metavar="OLD", help="A shipped name such as office/desk, or a .qsr file.")
]
New = Annotated[str, typer.Argument(metavar="NEW", help="The file to compare with it.")]


def diff(old: Old, new: New, form: OutputFormat = Format.TEXT) -> None:
    """Say what changed from one file of knowledge to another: pair by pair, in words and in bits."""
    changes = differences(load(old), load(new))
    if form is Format.JSON:
        typer.echo(json.dumps([asdict(change) for change in changes], ensure_ascii=False, indent=2))
        return
    if not changes:
        typer.echo("nothing changed")
        return
    console = Console()
    console = console if console.is_terminal else Console(width=MIN_WIDTH)
    console.print(_table(changes))


def _table(changes: list[Change]) -> Table:
    table = Table("pair", "bits", "what changed", box=None)
    for change in changes:
        bits = "" if change.bits is None else f"{change.bits:.2f} ± {change.error:.2f}"
        table.add_row(f"{change.pair[0]} from {change.pair[1]}", bits, change.words)
    return table
