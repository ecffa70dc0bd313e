"""What a notebook shows of knowledge, answers and results: tables and pictures as HTML, or text in a terminal."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from html import escape
from io import BytesIO, StringIO

from rich.console import Console
from rich.table import Table
from rich.text import Text

import qsrlang as qsr
from qsrlang.cli.answers import answer_table, frame_line, probability_table, reasons, table_of
from qsrlang.cli.narration import outcome_table, steps_table
from qsrlang.cli.shell.listings import class_table, graph_table, landmark_table
from qsrlang.experiments.tables import comparison_table
from qsrlang.plotting.canvas import Figure

PICTURE_WIDTH = 520
"""The width of a picture [CSS pixels]."""
TEXT_WIDTH = 120
"""The width of what is shown in a terminal [columns]."""


def summary(known: qsr.KnowledgeBase) -> str:
    """Return in one line how much is known."""
    pairs = {pair for choice in known.graph.choices for pair in choice.governs}
    classes, landmarks = len(known.classes), len(known.landmarks)
    return ", ".join(
        (
            f"{classes} class{'es' * (classes != 1)}",
            f"{landmarks} landmark{'s' * (landmarks != 1)}",
            f"{len(pairs)} related pair{'s' * (len(pairs) != 1)}",
        )
    )


def knowledge_html(known: qsr.KnowledgeBase) -> str:
    """Return what is known: findings, classes, landmarks, and the choices with their lines."""
    findings = "\n\n".join(finding.render() for finding in known.diagnostics)
    tables = [class_table(known.graph)]
    tables += [landmark_table(known.graph)] if known.landmarks else []
    return _block(findings) + "".join(map(table_html, [*tables, graph_table(known.graph)]))


def where_html(answer: qsr.Where, known: qsr.KnowledgeBase | None = None) -> str:
    """Return an answer: its components, the statements behind them, and a picture among the landmarks if known."""
    statements = "".join(f"<li><code>{escape(one)}</code></li>" for one in reasons(answer))
    table = table_html(answer_table(answer, f"where {answer.target}"))
    lines = "".join(f"<p>{escape(line)}</p>" for line in (frame_line(answer), *_assumed(answer)))
    return f"{table}<ol>{statements}</ol>{lines}{_picture_of(answer, known)}"


def probability_html(answer: qsr.Probability) -> str:
    """Return a probability with its standard error."""
    lines = "".join(f"<p>{escape(line)}</p>" for line in _assumed(answer))
    return f"<p><b>prob {escape(answer.formula)}</b></p>{table_html(probability_table(answer))}{lines}"


def rows_html(answer: qsr.LandmarkRanking | qsr.SceneSamples) -> str:
    """Return a ranking of landmarks, or where things are in joint scenes, with their frame."""
    frame = f"<p>{escape(frame_line(answer))}</p>" if isinstance(answer, qsr.SceneSamples) else ""
    return table_html(table_of(answer)) + frame


def text_html(answer: qsr.Explanation | qsr.Consistency) -> str:
    """Return a proof tree, or what contradicts what, as it is printed in a terminal."""
    return _block(str(answer))


def story_html(story: qsr.SearchStory) -> str:
    """Return a search: how it ended, its steps, and a picture of the last one."""
    return (
        table_html(outcome_table(story))
        + table_html(steps_table(story))
        + picture_html(qsr.draw_story(story))
    )


def comparison_html(comparison: qsr.Comparison) -> str:
    """Return a comparison: one row an arm, with intervals."""
    return table_html(comparison_table(comparison))


def story_text(story: qsr.SearchStory) -> str:
    """Return a search as it is told in a terminal."""
    return _printed(outcome_table(story), steps_table(story))


def comparison_text(comparison: qsr.Comparison) -> str:
    """Return a comparison as it is printed in a terminal."""
    return _printed(comparison_table(comparison))


def table_html(table: Table) -> str:
    """Return a table of the terminal as one of HTML."""
    head = "".join(f"<th>{_plain(column.header)}</th>" for column in table.columns)
    sides = [column.justify for column in table.columns]
    rows = zip(*(column.cells for column in table.columns), strict=True)
    body = "".join(f"<tr>{_cells(row, sides)}</tr>" for row in rows)
    title = f"<caption><b>{_plain(table.title)}</b></caption>" if table.title else ""
    below = f"<p><small>{_plain(table.caption)}</small></p>" if table.caption else ""
    return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{below}"


def picture_html(figure: Figure) -> str:
    """Return a figure as an image."""
    drawn = BytesIO()
    figure.savefig(drawn, format="png")
    content = base64.b64encode(drawn.getvalue()).decode("ascii")
    return f'<img style="width: {PICTURE_WIDTH}px" src="data:image/png;base64,{content}">'


def _assumed(answer: qsr.Where | qsr.Probability | qsr.SceneSamples) -> list[str]:
    return [f"assumed: {'; '.join(answer.assumed)}"] if answer.assumed else []


def _picture_of(answer: qsr.Where, known: qsr.KnowledgeBase | None) -> str:
    try:
        if known is None and answer.frame == "map":
            return picture_html(qsr.draw_mixture(answer.mixture, title=f"where {answer.target}"))
        return picture_html(qsr.draw_answer(answer, known or qsr.parse_knowledge("")))
    except qsr.QSRError as error:
        return _block(f"no picture: {error}")


def _cells(row: Iterable[object], sides: Iterable[str]) -> str:
    return "".join(
        f'<td style="text-align: {side}">{_plain(cell)}</td>' for cell, side in zip(row, sides, strict=True)
    )


def _plain(content: object) -> str:
    text = content.plain if isinstance(content, Text) else Text.from_markup(str(content)).plain
    return escape(text.strip())


def _printed(*tables: Table) -> str:
    console = Console(file=StringIO(), width=TEXT_WIDTH)
    with console.capture() as capture:
        console.print(*tables, sep="\n")
    return capture.get().rstrip()


def _block(text: str) -> str:
    return f"<pre>{escape(text)}</pre>" if text else ""
