"""What a name stands for, in words with units, for hovers and completions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from qsrlang.language import statements as st
from qsrlang.language.printing.amounts import amount_text, quantity_text
from qsrlang.language.source import Span
from qsrlang.language.syntax import Anywhere, Density, Dimension, Mix, Name, Normal, Uniform
from qsrlang.relations.build import Built
from qsrlang.relations.calculus import Relation
from qsrlang.relations.graph import Landmark, ObjectClass
from qsrlang.relations.imports import Library
from qsrlang.relations.symbols import flat

MAX_SHOWN_LINES = 20
_DIRECTIONS = {0: "behind", 90: "to the left", 180: "in front", 270: "to the right"}
_HALF_SECTOR = 22.5


@dataclass(frozen=True, slots=True)
class Definition:
    """Where a name is defined: its own part of the text, as it would stand alone, and its doc comment."""

    text: str
    doc: str
    span: Span


def definition_of(kind: str, name: str, library: Library) -> Definition | None:
    """Return the first definition of a name, of a default the one that holds; None where no statement has one."""
    statements = [one for document in library.documents for one in flat(document.statements)]
    found = (one for statement in statements for one in _defined_in(statement, kind, name))
    if kind != "default":
        return next(found, None)
    *_, last = (None, *found)
    return last


def facts(kind: str, name: str, built: Built) -> tuple[str, ...]:
    """Return what is known of a name, the most telling first; nothing where it is unknown."""
    symbols = built.symbols
    match kind:
        case "relation" if name in symbols.relations:
            return tuple(_relation_facts(symbols.relations[name]))
        case "class" if name in symbols.classes:
            return tuple(_class_facts(symbols.classes[name], ("class", name) in symbols.places))
        case "landmark" if name in symbols.landmarks:
            return tuple(_landmark_facts(symbols.landmarks[name]))
        case "scene" if name in symbols.scenes:
            return (f"of {', '.join(member.text for member in symbols.scenes[name].members)}",)
        case "role" if name in symbols.roles:
            kind_name = symbols.roles[name]
            return (f"one of several {kind_name}", *facts("class", kind_name, built)[1:])
        case _:
            return ()


def hover_text(kind: str, name: str, built: Built) -> str:
    """Return what an editor shows of a name, in Markdown: definition, facts, doc comment and place."""
    definition = definition_of(kind, name, built.library)
    parts = [f"```qsr\n{definition.text if definition else name}\n```"]
    parts += ["  \n".join(facts(kind, name, built))]
    if definition is not None:
        parts += [definition.doc, f"*{_place(definition.span)}*"]
    return "\n\n".join(part for part in parts if part)


def _defined_in(statement: st.Statement, kind: str, name: str) -> Iterator[Definition]:
    match statement, kind:
        case st.Declaration(classes=classes), "class":
            for one in classes:
                if one.name.text == name:
                    yield Definition(f"{statement.kind} {one.span.text}", statement.doc, one.name.span)
        case st.Defaults(values=values), "default":
            for key, quantity in values:
                if key.text == name:
                    whole = Span(key.span.source, key.span.start, quantity.span.end)
                    yield Definition(whole.text, statement.doc, key.span)
        case (
            (st.Landmark(name=Name(text=text, span=span)), "landmark")
            | (st.Relation(name=Name(text=text, span=span)), "relation")
            | (st.Scene(name=Name(text=text, span=span)), "scene")
            | (st.Import(alias=Name(text=text, span=span)), "prefix")
        ) if text == name:
            yield Definition(_shown(statement.span.text), statement.doc, span)


def _place(span: Span) -> str:
    """The file by its own name, or of a shipped one by its place among them, and the line."""
    name = Path(span.source.name)
    return f"{name.name if name.is_absolute() else name.as_posix()}:{span.line}"


def _shown(text: str) -> str:
    lines = text.splitlines()
    return "\n".join([*lines[:MAX_SHOWN_LINES], "…"] if len(lines) > MAX_SHOWN_LINES else lines)


def _class_facts(known: ObjectClass, declared: bool) -> Iterator[str]:
    yield known.kind if declared else "never declared: taken as a point"
    if known.width > 0.0:
        sides = [known.width, known.depth, *([known.height] if known.height and not known.is_surface else [])]
        yield " × ".join(map(_length, sides)) + f" ({' × '.join(('width', 'depth', 'height')[: len(sides)])})"
    if known.is_surface and known.height:
        yield f"its top {_length(known.height)} above the floor"
    if known.on is not None:
        yield f"stands on {known.on}"
    if known.front:
        yield "has a front"


def _landmark_facts(known: Landmark) -> Iterator[str]:
    yield known.kind
    place = [known.x, known.y, *([] if known.z is None else [known.z])]
    yield f"at ({', '.join(f'{value:g} m' for value in place)})"
    yield "no heading" if known.heading is None else f"facing {_angle(known.heading)}"
    x, y, turn = known.deviation
    if any(known.deviation):
        yield f"± ({_length(x)}, {_length(y)}, {_angle(turn)})"


def _relation_facts(known: Relation) -> Iterator[str]:
    if known.region is not None:
        yield {"top": "on the top of the relatum", "inside": "inside the relatum"}[known.region]
    if known.region is None or known.angle is not None:
        yield f"angle: {_angle_words(known.angle, known.arity)}"
    if known.region is None or known.distance is not None:
        yield f"distance: {_distance_words(known.distance, known.arity)}"
    if known.converse is not None:
        yield f"converse: {known.converse}"
    if known.disjoint:
        yield f"excludes: {', '.join(known.disjoint)}"
    if known.symmetric:
        yield "symmetric"
    if known.components > 1:
        yield f"{known.components} components"


def _angle_words(density: Density | None, arity: int) -> str:
    match density:
        case Normal(mean=mean, deviation=deviation):
            return f"{_angle(mean.value)} ± {_angle(deviation.value)} ({_direction(mean.value, arity)})"
        case Uniform(low=low, high=high):
            return f"{_angle(low.value)} to {_angle(high.value)}, counter-clockwise, all alike"
        case Mix(parts=parts):
            return "either " + ", or ".join(_angle_words(part, arity) for part in parts)
        case _:
            return "any"


def _direction(angle: float, arity: int) -> str:
    """Where an angle points: 0 is behind the relatum as the viewer sees it, and angles grow counter-clockwise."""
    degrees = math.degrees(angle) % 360.0
    nearest = round(degrees / 90.0) * 90
    if arity > 2:
        return (
            "from the one relatum towards the other"
            if nearest % 360 == 0
            else "off the line between the relata"
        )
    if abs(degrees - nearest) < _HALF_SECTOR:
        return _DIRECTIONS[nearest % 360]
    return f"{_DIRECTIONS[int(degrees // 90) * 90]} and {_DIRECTIONS[(int(degrees // 90) * 90 + 90) % 360]}"


def _distance_words(density: Density | None, arity: int) -> str:
    match density:
        case Uniform(low=low, high=high) if high.dimension is Dimension.FRACTION:
            way = "the way between the relata" if arity > 2 else "the way to the edge of the support"
            return f"{quantity_text(low)} to {quantity_text(high)} of {way}"
        case Uniform(low=low, high=high):
            return f"{quantity_text(low)} to {quantity_text(high)}"
        case None | Anywhere():
            return "any"
        case _:
            return "as in the definition"


@lru_cache(maxsize=4096)
def _length(value: float) -> str:
    return amount_text(value, Dimension.LENGTH)


@lru_cache(maxsize=4096)
def _angle(value: float) -> str:
    return amount_text(value, Dimension.ANGLE)
