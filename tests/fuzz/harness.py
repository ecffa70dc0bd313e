"""What is tried with a text, what counts as a failure, and how a text that fails is made small."""

from __future__ import annotations

import random
import traceback
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path

from fuzz.mutations import mutate

from qsrlang.errors import QSRError
from qsrlang.language.diagnostics import Diagnostic
from qsrlang.language.parser import parse_query
from qsrlang.language.printing.formatter import format_source
from qsrlang.language.source import Source
from qsrlang.relations import imports
from qsrlang.relations.build import build_graph
from qsrlang.relations.linting.lint import lint

ROOT = Path(__file__).parents[2]
LONGEST_SEED = 1_500
LONGEST_TEXT = 6_000

Target = Callable[[str], None]


def build(text: str) -> None:
    """Take a text as a program, and show what is found."""
    show(build_graph(Source("<fuzz>", text)).diagnostics)


def look_over(text: str) -> None:
    """Take a text as a program, and lint it."""
    source = Source("<fuzz>", text)
    show(lint(build_graph(source), source))


def lay_out(text: str) -> None:
    """Format a text."""
    format_source(Source("<fuzz>", text))


def ask(text: str) -> None:
    """Take a text as a query."""
    parse_query(text)


def show(findings: Sequence[Diagnostic]) -> None:
    """Show every finding both ways."""
    for finding in findings:
        finding.render()
        finding.to_json()


TARGETS: tuple[Target, ...] = (build, look_over, lay_out, ask)
WEIGHTS = (60, 15, 15, 10)


def failure(target: Target, text: str) -> Exception | None:
    """Return what a text raises that it must not: anything but an error of the user's."""
    try:
        target(text)
    except QSRError:
        return None
    except Exception as error:
        return error
    return None


def shrunk(target: Target, text: str, kind: type[Exception]) -> str:
    """Return a smaller text that raises the same kind of exception."""
    size = max(1, len(text) // 2)
    while size:
        start = 0
        while start < len(text):
            shorter = text[:start] + text[start + size :]
            if isinstance(failure(target, shorter), kind):
                text = shorter
            else:
                start += size
        size //= 2
    return text


def report(target: Target, text: str) -> str:
    """Return a minimal text and what it raises."""
    error = failure(target, text)
    if error is None:
        return f"{target.__name__}({text!r}) does not fail again"
    small = shrunk(target, text, type(error))
    trace = "".join(traceback.format_exception(failure(target, small)))
    return f"{target.__name__}({small!r})\n{trace}"


def place(error: Exception) -> str:
    """Return the kind of an exception and the line that raised it."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} {frame.filename}:{frame.lineno}"


def parse_files_once() -> None:
    """Keep the documents of files, of which the core would be parsed anew for every text."""
    parse_source = imports.parse_source
    known = cache(parse_source)
    imports.parse_source = lambda source: known(source) if source.path else parse_source(source)


def seeds() -> dict[Target, list[str]]:
    """Return the small programs and the queries of the corpus and the shipped files."""
    corpus = ROOT / "tests" / "corpus"
    paths = sorted([*corpus.rglob("*.qsr"), *(ROOT / "knowledge").rglob("*.qsr")])
    programs = [path.read_text(encoding="utf-8") for path in paths]
    lines = (corpus / "queries.txt").read_text(encoding="utf-8").splitlines()
    asked = [
        line.partition(" ")[2].partition(" # ")[0]
        for line in lines
        if line.startswith(("accepted ", "rejected "))
    ]
    short = [text for text in programs if len(text) <= LONGEST_SEED]
    return {build: short, look_over: short, lay_out: short, ask: asked}


def cases(seed: int) -> Iterator[tuple[Target, str]]:
    """Yield changed programs and queries without end, and what is to be done with them."""
    chance, known = random.Random(seed), seeds()
    while True:
        (target,) = chance.choices(TARGETS, WEIGHTS)
        text = mutate(chance.choice(known[target]), chance, known[target])
        yield target, text[:LONGEST_TEXT]
