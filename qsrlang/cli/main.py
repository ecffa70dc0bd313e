"""The command `qsr`."""

from __future__ import annotations

import sys
from importlib import import_module

import typer

from qsrlang.errors import QSRError

VERBS = (
    "check",
    "fmt",
    "lint",
    "ask",
    "repl",
    "plot",
    "search",
    "compare",
    "learn",
    "diff",
    "lsp",
    "explain-error",
)
MISUSED = 2
INTERRUPTED = 130


def main() -> None:
    """Run the command; a user's mistake is told in its own words, with exit code 2 and no traceback."""
    try:
        build_app(sys.argv[1:])()
    except QSRError as error:
        sys.stderr.write(f"{error}\n" if str(error).startswith("error[") else f"error: {error}\n")
        raise SystemExit(MISUSED) from None
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        raise SystemExit(INTERRUPTED) from None


def build_app(words: list[str]) -> typer.Typer:
    """Return the command with the verb that the words name, or with all; the imports of the others are spared."""
    app = typer.Typer(
        name="qsr",
        callback=_describe,
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
    )
    for verb in words[:1] if words[:1] and words[0] in VERBS else VERBS:
        name = verb.replace("-", "_")
        app.command(verb)(getattr(import_module(f"qsrlang.cli.{name}"), name))
    return app


def _describe() -> None:
    """Probabilistic reasoning with qualitative spatial relations, and object search by them."""
