"""The command `qsr`."""

from __future__ import annotations

import sys

import typer

from qsrlang.cli.ask import ask
from qsrlang.cli.check import check
from qsrlang.cli.compare import compare
from qsrlang.cli.plot import plot
from qsrlang.cli.search import search
from qsrlang.errors import QSRError

MISUSED = 2
INTERRUPTED = 130

app = typer.Typer(
    name="qsr",
    help="Probabilistic reasoning with qualitative spatial relations, and object search by them.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
for verb in (check, ask, plot, search, compare):
    app.command()(verb)


def main() -> None:
    """Run the command; a user's mistake is told in its own words, with exit code 2 and no traceback."""
    try:
        app()
    except QSRError as error:
        sys.stderr.write(f"{error}\n" if str(error).startswith("error[") else f"error: {error}\n")
        raise SystemExit(MISUSED) from None
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        raise SystemExit(INTERRUPTED) from None
