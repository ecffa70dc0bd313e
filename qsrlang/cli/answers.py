"""Answers as tables."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table

import qsrlang as qsr


def print_answer(answer: qsr.Answer | qsr.RankedViews, console: Console, title: str) -> None:
    """Print an answer: as a table, with the numbers of the statements behind each component, or as a tree."""
    match answer:
        case qsr.Where():
            _print_where(answer, console, title)
        case qsr.Probability() | qsr.LandmarkRanking() | qsr.SceneSamples():
            console.print(title, markup=False, highlight=False, soft_wrap=True)
            console.print(table_of(answer))
        case _:
            console.print(str(answer), highlight=False, markup=False, soft_wrap=True)
    _print_axes(answer, console)
    if (
        isinstance(answer, qsr.Where | qsr.Probability | qsr.SceneSamples | qsr.Explanation)
        and answer.assumed
    ):
        assumed = f"assumed: {'; '.join(answer.assumed)}"
        good = "" if answer.draws is None else f" (as good as {answer.draws:.0f} independent draws)"
        console.print(assumed + good, highlight=False, markup=False, soft_wrap=True)


def table_of(answer: qsr.Probability | qsr.LandmarkRanking | qsr.SceneSamples) -> Table:
    """Return an answer as a table."""
    match answer:
        case qsr.Probability():
            return probability_table(answer)
        case qsr.LandmarkRanking():
            return ranking_table(answer)
        case qsr.SceneSamples():
            return scenes_table(answer)


def title_of(query: str) -> str:
    """Return a query as the title of its answer: on one line, without its question mark."""
    return " ".join(query.split()).removesuffix("?").rstrip()


def probability_table(answer: qsr.Probability) -> Table:
    """Return a probability and how it was found as a table."""
    error = f"{answer.standard_error:.1g}" if answer.method == "draws" else "none"
    rows = [(f"{answer.value:.4f}", error, answer.method)]
    return _table(("probability", "standard error", "found by"), rows, caption=_dropped(answer.dropped))


def ranking_table(answer: qsr.LandmarkRanking) -> Table:
    """Return landmarks by what they tell as a table."""
    rows = [
        (
            one.name,
            f"{one.information:.3f} ± {one.standard_error:.3f}",
            f"{one.through:.3f}",
            f"{one.entropy:.2f}",
            f"{one.ratio:.3f}",
        )
        for one in answer.landmarks
    ]
    headings = ("landmark", "information [bit]", "P(L|O)", "entropy [bit]", "P(L|O)/H")
    return _table(headings, rows, caption=answer.basis)


def scenes_table(answer: qsr.SceneSamples) -> Table:
    """Return where things are in joint scenes as a table; the scenes themselves come as JSON."""
    rows = [
        (
            name,
            f"{share:.3f}",
            *(f"{_metres(m)} ± {_metres(d)}" for m, d in zip(mean, deviation, strict=True)),
        )
        for name, share, mean, deviation in answer.summary()
    ]
    caption = f"{len(answer)} scene{'s' * (len(answer) != 1)} of {answer.drawn} drawn; --format json gives each of them"
    return _table(("thing", "in scenes", "x [m]", "y [m]"), rows, caption=caption)


def _table(headings: tuple[str, ...], rows: Sequence[tuple[str, ...]], caption: str | None = None) -> Table:
    table = Table(caption=caption and escape(caption), caption_justify="left")
    for heading in headings:
        table.add_column(escape(heading), justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*map(escape, row))
    return table


def _dropped(mass: float) -> str | None:
    return f"combinations left out: {mass:.2g} of the mass" if mass > 0.0 else None


def _print_where(answer: qsr.Where, console: Console, title: str) -> None:
    console.print(answer_table(answer, title))
    for number, statement in enumerate(reasons(answer), start=1):
        console.print(f"{number:3d}  {escape(statement)}", highlight=False, soft_wrap=True)
    console.print(frame_line(answer), highlight=False, soft_wrap=True)


def _print_axes(answer: qsr.Answer | qsr.RankedViews, console: Console) -> None:
    """Print the frame of an answer that does not tell it, or, where that is not the map's, how its axes lie."""
    match answer:
        case qsr.SceneSamples() as told:
            console.print(frame_line(told), highlight=False, soft_wrap=True)
        case qsr.Explanation(answer=qsr.Where() as told) if told.frame != "map":
            console.print(frame_line(told), highlight=False, soft_wrap=True)
        case _:
            pass


def answer_table(answer: qsr.Where, title: str) -> Table:
    """Return an answer as a table; its last column names statements by their numbers in `reasons`."""
    statements = reasons(answer)
    table = Table(title=escape(title), title_justify="left")
    for heading in ("weight", "x [m]", "y [m]", "sd [m]", "axis [deg]", "because of"):
        table.add_column(escape(heading), justify="right", no_wrap=True)
    for component in answer.components:
        (x, y), (major, minor, angle) = component.mean, component.ellipse
        numbers = " ".join(str(statements.index(one) + 1) for one in component.statements)
        table.add_row(
            f"{component.weight:.3f}",
            _metres(x),
            _metres(y),
            f"{major:.3f} × {minor:.3f}",
            f"{math.degrees(angle):.0f}",
            numbers or "its own landmark",
        )
    return table


def reasons(answer: qsr.Where) -> list[str]:
    """Return the statements behind an answer, each once."""
    return list(dict.fromkeys(one for component in answer.components for one in component.statements))


def frame_line(answer: qsr.Where | qsr.SceneSamples) -> str:
    """Return the frame of an answer, and what is left to places that no statement names."""
    if answer.frame == "map":
        frame = "frame: map"
    else:
        frame = f"frame: {answer.frame} at the origin, x away from the viewer, y to its left (no landmark is used)"
    if isinstance(answer, qsr.SceneSamples):
        return frame
    rest = f"; elsewhere: {answer.elsewhere:.3f}" if answer.elsewhere > 0.0 else ""
    left_out = _dropped(answer.dropped)
    return f"{frame}{rest}" + (f"; {left_out}" if left_out else "")


def _metres(value: float) -> str:
    """Return a coordinate to the millimetre; what rounds to zero has no sign."""
    return f"{round(value, 3) + 0.0:.3f}"
