"""`qsr explain-error CODE`: what the code of a finding means."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich.console import Console
from rich.markdown import Markdown

from qsrlang.cli.options import Format, OutputFormat
from qsrlang.errors import UnknownNameError
from qsrlang.language.codes import CODES
from qsrlang.resources import resource_path


def explain_error(
    code: Annotated[
        str | None, typer.Argument(metavar="CODE", help="A code such as Q203; without one, all are listed.")
    ] = None,
    output: OutputFormat = Format.TEXT,
) -> None:
    """Explain what the code of a finding means, with a wrong example and the right one."""
    if code is None:
        _list(output)
        return
    page = page_of(code.strip().upper())
    console = Console()
    if output is Format.JSON:
        typer.echo(json.dumps({"code": code.strip().upper(), "page": page}, ensure_ascii=False, indent=2))
    elif console.is_terminal:
        console.print(Markdown(page))
    else:
        typer.echo(page.rstrip())


def page_of(code: str) -> str:
    """Return the page of a code, in Markdown; raises UnknownNameError."""
    if code not in CODES:
        raise UnknownNameError("code", code, CODES)
    return resource_path("codes", f"{code}.md").read_text(encoding="utf-8")


def _list(output: Format) -> None:
    if output is Format.JSON:
        typer.echo(json.dumps(CODES, ensure_ascii=False, indent=2))
        return
    for code, title in CODES.items():
        typer.echo(f"{code}  {title}")
