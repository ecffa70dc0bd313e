"""`qsr fmt FILE...`: files in their canonical form."""

from __future__ import annotations

import re
import sys
from difflib import unified_diff
from typing import Annotated

import typer
from rich.console import Console

from qsrlang.cli.findings import print_findings
from qsrlang.errors import FileError, QSRError
from qsrlang.files import write_whole
from qsrlang.language.diagnostics import LanguageError, raise_errors
from qsrlang.language.parser import parse_source
from qsrlang.language.printing.formatter import format_source
from qsrlang.language.printing.spelling import Spelling
from qsrlang.language.source import MAX_SOURCE_BYTES, Source, decode_source
from qsrlang.relations.imports import find_knowledge, read_source

STDIN = "-"
WOULD_CHANGE, REFUSED = 1, 2
_LINE = re.compile(r"[^\n]*\n|[^\n]+")

Files = Annotated[
    list[str], typer.Argument(metavar="FILE...", help="Paths that end in .qsr; - is standard input.")
]
Check = Annotated[
    bool, typer.Option("--check", help="Write nothing; show what would change, with exit code 1.")
]
Ascii = Annotated[bool, typer.Option("--ascii/--unicode", help="Write the connectives as 'and' or as '∧'.")]


def fmt(files: Files, check: Check = False, ascii: Ascii = False) -> None:
    """Put .qsr files into their canonical form; comments, numbers and the meaning stay as they are."""
    code = max([_done(file, check, "ascii" if ascii else "unicode") for file in files])
    if code:
        raise typer.Exit(code)


def _done(name: str, check: bool, spelling: Spelling) -> int:
    """Format one file, and return its exit code; what is wrong with it is told and stops no other file."""
    try:
        source = _source(name, check)
        raise_errors(parse_source(source).diagnostics)
        formatted = format_source(source, spelling)
        return _show(source, formatted) if check else _write(source, formatted)
    except LanguageError as error:
        print_findings(error.diagnostics, Console(stderr=True, highlight=False))
        typer.echo(f"{name}: not formatted, because of the errors above", err=True)
    except QSRError as error:
        typer.echo(f"error: {error}", err=True)
    return REFUSED


def _source(name: str, check: bool) -> Source:
    if name == STDIN:
        return decode_source(sys.stdin.buffer.read(MAX_SOURCE_BYTES + 1), "<stdin>")
    path = find_knowledge(name)
    if not check and not name.endswith(".qsr"):
        raise FileError(name, "is shipped with the program", "copy it to a place of your own and format that")
    return read_source(path)


def _write(source: Source, formatted: str) -> int:
    if source.path is None:
        typer.echo(formatted, nl=False)
    elif formatted != source.text:
        write_whole(source.path, formatted)
        typer.echo(f"formatted {source.path}")
    return 0


def _show(source: Source, formatted: str) -> int:
    if formatted == source.text:
        return 0
    if formatted == source.text.replace("\r\n", "\n"):
        typer.echo(f"{source.name}: the lines would end in LF instead of CRLF")
        return WOULD_CHANGE
    before, after = (_LINE.findall(text) for text in (source.text, formatted))
    for line in unified_diff(before, after, source.name, source.name):
        typer.echo(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n", nl=False)
    return WOULD_CHANGE
