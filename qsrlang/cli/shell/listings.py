"""What a session knows, as tables."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

from qsrlang.language.syntax import Frame
from qsrlang.relations.graph import Alternative, Choice, Constraint, Pair, RelationGraph, Requirement


def landmark_table(graph: RelationGraph) -> Table:
    """Return the landmarks: name, class, position [m], heading [deg] and deviations."""
    table = _table("landmark", "class", "x [m]", "y [m]", "z [m]", "facing [deg]", "±")
    for one in graph.landmarks:
        x, y, turn = one.deviation
        spread = f"{x:g} m, {y:g} m, {math.degrees(turn):.3g} deg" if any(one.deviation) else ""
        facing = None if one.heading is None else math.degrees(one.heading)
        numbers = (f"{one.x:.2f}", f"{one.y:.2f}", _number(one.z, ".2f"), _number(facing, ".0f"))
        table.add_row(escape(one.name), escape(one.kind), *numbers, spread)
    return table


def class_table(graph: RelationGraph) -> Table:
    """Return the classes: name, kind, size and height of the surface [cm], front and support."""
    table = _table("class", "kind", "size [cm]", "height [cm]", "front", "on")
    for one in graph.classes.values():
        size = f"{100 * one.width:g} × {100 * one.depth:g}" if one.width else ""
        height = f"{100 * one.height:g}" if one.height else ""
        table.add_row(
            escape(one.name), one.kind, size, height, "yes" if one.front else "", escape(one.on or "")
        )
    return table


def graph_table(graph: RelationGraph, name: str | None = None) -> Table:
    """Return the choices between constraints, those about one object or all: shares, relations and their lines."""
    table = _table("share", "what holds", "because of")
    for choice in graph.choices:
        if name is None or any(name in pair for pair in choice.governs):
            for row in _choice_rows(choice):
                table.add_row(*row)
            table.add_section()
    for requirement in graph.requirements:
        table.add_row(*_requirement_row(requirement))
    return table


def _choice_rows(choice: Choice) -> Iterator[tuple[str, str, str]]:
    for alternative in choice.alternatives:
        yield from _alternative_rows(alternative, choice.governs)
    rest = 1.0 - sum(one.share for one in choice.alternatives)
    if rest > 1e-9:
        yield f"{rest:.3f}", "elsewhere", ""


def _alternative_rows(alternative: Alternative, governed: frozenset[Pair]) -> Iterator[tuple[str, str, str]]:
    """Yield a row for each constraint on the pairs that are governed; the others have rows of their own."""
    shown = [one for one in alternative.constraints if (one.referent, one.relatum) in governed]
    for number, constraint in enumerate(shown):
        share = "" if number else f"{alternative.share:.3f}"
        place = f"{constraint.statement.file}:{constraint.statement.line}"
        yield share, escape(_constraint_text(constraint)), escape(place)


def _constraint_text(constraint: Constraint) -> str:
    arguments = ", ".join(filter(None, (constraint.referent, constraint.relatum, constraint.towards)))
    atoms = []
    for atom in constraint.atoms:
        frame = "" if atom.frame is Frame.RELATIVE else f" wrt {atom.frame.value}"
        atoms.append(f"{atom.relation.name}({arguments}){frame}")
    fit = " ~ normal(…)" if constraint.fit else ""
    return " ∧ ".join(atoms) + fit


def _requirement_row(requirement: Requirement) -> tuple[str, str, str]:
    share = "" if requirement.share is None else f"{requirement.share:.3f}"
    statement = requirement.statement
    return share, escape(statement.text), escape(f"{statement.file}:{statement.line}")


def _number(value: float | None, form: str) -> str:
    return "" if value is None else f"{value:{form}}"


def _table(*headings: str) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        numeric = "[" in heading or heading == "share"
        table.add_column(escape(heading), justify="right" if numeric else "left")
    return table
